/* labels: order slow long */
/* Orders up to 16, over four and more step sizes, at the catalogue's own starts.
 *
 * The leading term of a high order's error rules only where the error is far below the roundoff of
 * a double. So the proof has two halves: the step's equations, solved by another program in
 * quadruple precision, have the claimed order against the independent judge, and the library's
 * trajectory is that program's to roundoff. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/accepted.h"
#include "support/quad/quad_galerkin.h"
#include "support/runs.h"
#include "support/suite.h"

/* A span, and the steps of the coarsest run. They are short enough for fixed-point iteration, and
 * for the leading term to dominate. */
typedef struct place {
  const char *problem, *setting;
  double t_end;
  int steps;
  double floor; /* errors above a hundred times the noise of both programs are measured */
} place;

static const place places[] = {
    {"kepler", NULL, 2.0, 20, 1e-27},      {"pendulum", NULL, 2.0, 5, 2e-28},
    {"henon-heiles", NULL, 1.5, 2, 1e-27}, {"double-pendulum", NULL, 0.5, 4, 1e-28},
    {"toda", "N=5", 2.0, 4, 2e-28},
};
enum { PLACES = sizeof places / sizeof *places, LEVELS = 16, FITTED = 5, DEGREES = 8 };

/* Quadrature and nodes for a degree, and the order that they give. */
typedef struct variant {
  const char *rule;
  int lobatto, more_nodes, order_lost;
} variant;

static const variant variants[] = {{"gauss", 0, 0, 0}, {"lobatto", 1, 1, 0}, {"lobatto", 1, 0, 2}};
enum { VARIANTS = sizeof variants / sizeof *variants, CASES = PLACES * VARIANTS * DEGREES };

typedef struct state {
  quad q[QUAD_N_MAX], p[QUAD_N_MAX];
} state;

static void make_field(const place *at, quad_field *field)
{
  ck_assert(quad_prepare(field, at->problem, at->setting != NULL, &at->setting));
}

static void run(const place *at, const quad_field *field, const quad_galerkin *method, int steps,
                state *z)
{
  quad y[2 * QUAD_N_MAX + 1] = {0};
  const int n = field->system.n;
  memcpy(y, field->system.q, (size_t)n * sizeof *y);
  memcpy(y + n, field->system.v, (size_t)n * sizeof *y);
  memcpy(z->q, y, (size_t)n * sizeof *y);
  quad_momentum(field, y, z->p);
  for (int i = 0; i < steps; i++)
    ck_assert(quad_galerkin_step(method, field, (quad)at->t_end / steps, z->q, z->p));
}

/* Gives the judge's result. Its own error must be far below all measured errors. */
static void advance_by_judge(const place *at, const quad_field *field, quad *y)
{
  const int n = field->system.n;
  memcpy(y, field->system.q, (size_t)n * sizeof *y);
  memcpy(y + n, field->system.v, (size_t)n * sizeof *y);
  const double error = (double)quad_march(field, (quad)at->t_end, y);
  ck_assert_msg(error < 1e-29, "%s: the judge's error is %g", at->problem, error);
}

/* Gives the length of the difference in q and p, each relative to its size. A component whose error
 * happens to vanish does no harm. */
static double error_of(const quad_field *field, const state *z, const quad *y)
{
  quad p[QUAD_N_MAX];
  double size_q = 0, size_p = 0, sum_q = 0, sum_p = 0;
  quad_momentum(field, y, p);
  for (int i = 0; i < field->system.n; i++) {
    size_q += pow((double)y[i], 2), sum_q += pow((double)(z->q[i] - y[i]), 2);
    size_p += pow((double)p[i], 2), sum_p += pow((double)(z->p[i] - p[i]), 2);
  }
  return sqrt(sum_q / size_q + sum_p / size_p);
}

/* The limit of the slopes between neighbouring levels as h goes to 0. For symmetric methods the
 * error is C h^p (1 + c h^2 + ..), so the slopes are p + 2 c h^2 / log(..): a straight line over
 * h^2, fitted by least squares. */
static double slope(int count, const double *steps, const double *error)
{
  double x = 0, y = 0, xx = 0, xy = 0;
  const int slopes = count - 1;
  for (int i = 0; i < slopes; i++) {
    const double local = log(error[i] / error[i + 1]) / log(steps[i + 1] / steps[i]),
                 h2 = steps[0] * steps[0] / (steps[i] * steps[i + 1]);
    x += h2, y += local, xx += h2 * h2, xy += h2 * local;
  }
  return (y * xx - x * xy) / (slopes * xx - x * x);
}

/* Level by level the steps get shorter by a factor of about 1.3, until the error comes near the
 * judge's. The five finest count. */
static void check_order(const place *at, const variant *chosen, int degree)
{
  const int order = 2 * degree - chosen->order_lost;
  double steps[LEVELS], error[LEVELS];
  int count = 0;
  quad_galerkin method;
  quad_field field;
  quad exact[2 * QUAD_N_MAX + 1] = {0};
  state z;
  make_field(at, &field);
  quad_galerkin_prepare(&method, degree, chosen->lobatto, degree + chosen->more_nodes);
  advance_by_judge(at, &field, exact);
  for (; count < LEVELS; count++) {
    steps[count] = count == 0 ? at->steps : ceil(1.25 * steps[count - 1]);
    run(at, &field, &method, (int)steps[count], &z);
    error[count] = error_of(&field, &z, exact);
    if (error[count] < at->floor) break;
  }
  ck_assert_msg(count >= FITTED, "%s, degree %d: %d errors above the judge's", at->problem, degree,
                count);
  const double found = slope(FITTED, steps + count - FITTED, error + count - FITTED);
  ck_assert_msg(fabs(found - order) <= 0.2,
                "%s, %s, degree %d, %d nodes: order %.2f, not %d (errors %.1e to %.1e)",
                at->problem, chosen->rule, degree, degree + chosen->more_nodes, found, order,
                error[count - FITTED], error[count - 1]);
}

/* There is no Lobatto rule of one node. */
static accepted_cases cases;

static int case_has_rule(int which)
{
  const variant *chosen = &variants[which / DEGREES % VARIANTS];
  return !chosen->lobatto || 1 + which % DEGREES + chosen->more_nodes >= 2;
}

START_TEST(the_equations_of_a_step_have_the_claimed_order)
{
  const int which = cases.which[sampled_case(_i)];
  check_order(&places[which / DEGREES / VARIANTS], &variants[which / DEGREES % VARIANTS],
              1 + which % DEGREES);
}
END_TEST

/* A few dozen steps make a few roundings each, relative to the largest coordinate, on solutions
 * that amplify little. */
static const double roundoff = 500 * DBL_EPSILON;

static void check_same(const place *at, const variant *chosen, int degree)
{
  quad_galerkin method;
  quad_field field;
  state z;
  problem *made = create_problem(at->problem, at->setting);
  dvi_integrator *integrator = start_integrator(
      made, method_spec("galerkin:degree=%d,quadrature=%s,nodes=%d", degree, chosen->rule,
                        degree + chosen->more_nodes));
  make_field(at, &field);
  quad_galerkin_prepare(&method, degree, chosen->lobatto, degree + chosen->more_nodes);
  run(at, &field, &method, at->steps, &z);
  advance(integrator, at->t_end / at->steps, at->steps);
  ck_assert_int_eq(dvi_integrator_order(integrator), 2 * degree - chosen->order_lost);
  double most = 0;
  for (int i = 0; i < made->nq; i++) {
    most = fmax(most, fabs((double)(z.q[i] - (quad)dvi_integrator_q(integrator)[i])) /
                          magnitude(made->nq, dvi_integrator_q(integrator)));
    most = fmax(most, fabs((double)(z.p[i] - (quad)dvi_integrator_p(integrator)[i])) /
                          magnitude(made->nq, dvi_integrator_p(integrator)));
  }
  ck_assert_msg(most <= roundoff, "%s, %s, degree %d: %g apart", at->problem, chosen->rule, degree,
                most);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&made);
}

START_TEST(the_librarys_trajectory_is_theirs_to_roundoff)
{
  const int which = cases.which[sampled_case(_i)];
  check_same(&places[which / DEGREES / VARIANTS], &variants[which / DEGREES % VARIANTS],
             1 + which % DEGREES);
}
END_TEST

SUITE(order_quad)
{
  tcase_set_timeout(tests, 120);
  find_accepted_cases(CASES, case_has_rule, &cases);
  tcase_add_loop_test(tests, the_equations_of_a_step_have_the_claimed_order, 0,
                      sampled_count(cases.count));
  tcase_add_loop_test(tests, the_librarys_trajectory_is_theirs_to_roundoff, 0,
                      sampled_count(cases.count));
}
