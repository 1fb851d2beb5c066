/* labels: jacobian */
/* Tests the Jacobian of a whole path, with symmetry, free span and multipliers, against differences
 * of its residual, and its pattern. */
#include <math.h>
#include <string.h>

#include "boundary/path_struct.h"
#include "solve/solver_struct.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST = 200 };

static const double turn[] = {0.6, 0.8, -0.8, 0.6}, ends[] = {1, 0.1, 0.2, 1.1};

static const struct {
  dvi_path_options options;
  const char *method;
} kinds[] = {
    {{.ends = DVI_ENDS_FIXED, .steps = 3, .span = 1, .dimension = 2, .q0 = ends, .q1 = ends + 2},
     "galerkin:degree=3"},
    {{.ends = DVI_ENDS_FIXED, .steps = 1, .span = 1, .dimension = 2, .q0 = ends, .q1 = ends + 2},
     "galerkin:degree=2"},
    {{.ends = DVI_ENDS_FIXED, .steps = 6, .span = 1, .dimension = 2, .q0 = ends, .q1 = ends + 2},
     "trapezoidal"},
    {{.ends = DVI_ENDS_INITIAL, .steps = 4, .span = 1, .dimension = 2, .q0 = ends, .p0 = ends + 2},
     "galerkin:degree=2"},
    {{.ends = DVI_ENDS_INITIAL, .steps = 4, .span = 1, .dimension = 2, .q0 = ends, .p0 = ends + 2},
     "midpoint"},
    {{.ends = DVI_ENDS_PERIODIC, .steps = 4, .span = 2}, "galerkin:degree=3"},
    {{.ends = DVI_ENDS_PERIODIC, .steps = 1, .span = 2}, "galerkin:degree=4"},
    {{.ends = DVI_ENDS_PERIODIC, .steps = 2, .span = 2}, "midpoint"},
    {{.ends = DVI_ENDS_PERIODIC,
      .steps = 5,
      .span = 2,
      .dimension = 2,
      .symmetry = turn,
      .free_span = 1,
      .energy = -0.3},
     "galerkin:degree=2,quadrature=lobatto,nodes=3"},
    {{.ends = DVI_ENDS_PERIODIC, .steps = 5, .span = 2, .free_span = 1, .energy = -0.3},
     "midpoint"},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* A path of kepler or of the double pendulum in no special place, with multipliers that do not
 * vanish. */
static dvi_path *make(const problem *model, int kind)
{
  dvi_path *path = NULL;
  ck_assert_msg(dvi_path_create(model->system, kinds[kind].method, &kinds[kind].options, &path) ==
                    DVI_OK,
                "%s", dvi_last_error());
  for (int c = 0; c < path->core; c++) path->x[c] = 1 + 0.3 * cos(2 * c + 1);
  ck_assert_int_eq(dvi__path_scale(path, path->x), DVI_OK);
  ck_assert_int_eq(dvi__path_fix_gauge(path, path->x, 1e-6), DVI_OK);
  for (int c = 0; c < path->core; c++) path->x[c] += 0.05 * sin(3 * c);
  for (int c = path->core; c < path->unknowns; c++) path->x[c] = 1.1 + 0.1 * c;
  return path;
}

static const double moved[3] = {0.003, 0.006, 0.009}, share[3] = {1.5, -0.6, 0.1};

/* Takes differences of order 6. With d = 0.003 they err by d^6/140 of the seventh derivative, and
 * by roundings of 1e-15 over d. */
static void check_jacobian(dvi_path *path)
{
  const dvi__equations *equations = &path->solver->equations;
  double plus[MOST], minus[MOST], values[MOST * MOST];
  ck_assert(path->unknowns <= MOST);
  ck_assert_int_eq(equations->jacobian(path, path->x, values), DVI_OK);
  for (int column = 0; column < path->unknowns; column++) {
    const double at = path->x[column];
    double differences[MOST] = {0};
    for (int m = 0; m < 3; m++) {
      path->x[column] = at + moved[m];
      ck_assert_int_eq(equations->residual(path, path->x, plus), DVI_OK);
      path->x[column] = at - moved[m];
      ck_assert_int_eq(equations->residual(path, path->x, minus), DVI_OK);
      for (int row = 0; row < path->unknowns; row++)
        differences[row] += share[m] * (plus[row] - minus[row]) / (2 * moved[m]);
    }
    path->x[column] = at;
    for (int row = 0; row < path->unknowns; row++) {
      const int entry = dvi__pattern_find(&path->pattern, row, column);
      ck_assert_double_eq_tol(entry >= 0 ? values[entry] : 0, differences[row],
                              1e-7 * fmax(1, fabs(differences[row])));
    }
  }
}

START_TEST(the_jacobian_is_the_derivative_of_the_residual)
{
  static const char *const names[] = {"kepler", "double-pendulum"};
  problem *model = create_problem(names[_i / KINDS], NULL);
  dvi_path *path = make(model, _i % KINDS);
  check_jacobian(path);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* Hessians are symmetric, but for initial ends, whose rows stand with the next node. */
START_TEST(the_jacobian_is_a_hessian)
{
  problem *model = create_problem("kepler", NULL);
  dvi_path *path = make(model, _i);
  double values[MOST * MOST];
  ck_assert_int_eq(dvi__path_jacobian(path, path->x, values), DVI_OK);
  for (int column = 0; column < path->unknowns && kinds[_i].options.ends != DVI_ENDS_INITIAL;
       column++)
    for (int e = path->pattern.start[column]; e < path->pattern.start[column + 1]; e++) {
      const int other = dvi__pattern_find(&path->pattern, column, path->pattern.row[e]);
      ck_assert_int_ge(other, 0);
      ck_assert_double_eq_tol(values[e], values[other], 1e-12 * fmax(1, fabs(values[e])));
    }
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

SUITE(equations)
{
  tcase_add_loop_test(tests, the_jacobian_is_the_derivative_of_the_residual, 0, 2 * KINDS);
  tcase_add_loop_test(tests, the_jacobian_is_a_hessian, 0, KINDS);
}
