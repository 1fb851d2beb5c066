/* labels: reference */
/* Paths keep the energy of the motion that they follow. Paths that follow no motion are not
 * solved. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

typedef struct between {
  double from[2], to[2];
} between;

static const between arc = {{1, 0}, {-0.5, 1}}, swing = {{2.8, 1.5}, {-1, -1.5}};

static dvi_path *create_path(const problem *model, const char *method, int steps, double span,
                             const between *ends)
{
  const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                    .steps = steps,
                                    .span = span,
                                    .dimension = model->nq,
                                    .q0 = ends->from,
                                    .q1 = ends->to};
  dvi_path *path = NULL;
  const dvi_status status = dvi_path_create(model->system, method, &options, &path);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  return path;
}

static dvi_path_report solve_path(dvi_path *path)
{
  dvi_path_report report;
  ck_assert_msg(dvi_path_solve(path, &report) == DVI_OK, "%s", dvi_last_error());
  return report;
}

static double energy_at(const problem *model, const dvi_path *path, int k)
{
  double invariant[8];
  ck_assert_int_le(dvi_system_invariant_count(model->system), 8);
  const double t = dvi_path_time(path, k), *q = dvi_path_q(path, k), *p = dvi_path_p(path, k);
  ck_assert_int_eq(dvi_system_invariants(model->system, t, q, p, invariant), DVI_OK);
  return invariant[0];
}

/* With unit mass the kinetic energy is p.p/2. */
static double kinetic_at(const dvi_path *path, int k)
{
  const double *p = dvi_path_p(path, k);
  return 0.5 * (p[0] * p[0] + p[1] * p[1]);
}

START_TEST(the_spread_is_that_of_the_energies_at_the_nodes)
{
  enum { STEPS = 12 };
  problem *model = create_problem("kepler", NULL);
  dvi_path *path = create_path(model, "midpoint", STEPS, 3, &arc);
  const dvi_path_report report = solve_path(path);
  double least = HUGE_VAL, most = -HUGE_VAL, kinetic = 0, jump = 0;
  int step = -1;
  for (int k = 0; k <= STEPS; k++) {
    const double E = energy_at(model, path, k), K = kinetic_at(path, k);
    least = fmin(least, E);
    most = fmax(most, E);
    kinetic = fmax(kinetic, K);
    if (k == 0) continue;
    const double change = fabs(E - energy_at(model, path, k - 1)) /
                          fmax(K, kinetic_at(path, k - 1));
    if (change > jump) jump = change, step = k - 1;
  }
  /* Terms of size 1, of which 64 roundings are taken off. */
  ck_assert_double_eq_tol(report.energy_spread, most - least, 400 * DBL_EPSILON);
  ck_assert_double_eq_tol(report.kinetic, kinetic, 4 * DBL_EPSILON);
  ck_assert_double_eq_tol(report.energy_jump, jump, 400 * DBL_EPSILON);
  ck_assert_int_eq(report.jump_step, step);
  ck_assert_double_gt(report.energy_spread, 1e-4);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* Momenta at the nodes have the order of the method, 2s, and with them the energies. */
START_TEST(the_spread_falls_with_the_order_of_the_method)
{
  problem *model = create_problem("kepler", NULL);
  double spread[2];
  for (int s = 1; s <= 3; s++) {
    for (int k = 0; k < 2; k++) {
      dvi_path *path = create_path(model, method_spec("galerkin:degree=%d", s), 10 << k, 3, &arc);
      spread[k] = solve_path(path).energy_spread;
      dvi_path_destroy(&path);
    }
    const double order = log2(spread[0] / spread[1]);
    ck_assert_msg(fabs(order - 2 * s) < 0.3, "degree %d: %.2f", s, order);
  }
  problem_destroy(&model);
}
END_TEST

/* Four steps jump over the far swing of a double pendulum, and the last one changes its energy by
 * all of the kinetic energy. The path is there all the same, and as many steps as advised solve. */
START_TEST(a_path_that_follows_no_motion_is_not_solved)
{
  enum { STEPS = 4 };
  problem *model = create_problem("double-pendulum", NULL);
  dvi_path *path = create_path(model, "galerkin:degree=2", STEPS, 2, &swing);
  dvi_path_report report = {0};
  ck_assert_int_eq(dvi_path_solve(path, &report), DVI_STEP_TOO_LARGE);
  const char *said = dvi_last_error(), *advice = strstr(said, "; try about ");
  ck_assert_msg(strstr(said, "from node 3 to 4, t = 1.5 to 2, the energy changes") != NULL, "%s",
                said);
  ck_assert_ptr_nonnull(advice);
  const int steps = (int)strtol(advice + strlen("; try about "), NULL, 10);
  ck_assert_int_eq(report.jump_step, STEPS - 1);
  ck_assert_double_gt(report.energy_jump, 0.5);
  ck_assert_double_lt(report.gradient, 1e-12);
  const double change = fabs(energy_at(model, path, 4) - energy_at(model, path, 3));
  ck_assert_double_eq_tol(change, report.energy_jump * report.kinetic, 1e-9 * report.kinetic);
  dvi_path_destroy(&path);
  ck_assert_int_ge(steps, 2 * STEPS);
  path = create_path(model, "galerkin:degree=2", steps, 2, &swing);
  ck_assert_double_lt(solve_path(path).energy_jump, 0.1);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* Another path can be guessed from one that was refused, as from a solved one. */
START_TEST(a_refused_path_may_be_gone_on_from)
{
  problem *model = create_problem("double-pendulum", NULL);
  dvi_path *path = create_path(model, "galerkin:degree=2", 4, 2, &swing);
  dvi_path *next = create_path(model, "galerkin:degree=2", 4, 2, &swing);
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_STEP_TOO_LARGE);
  ck_assert_int_eq(dvi_path_guess_along(next, path, NULL, 1), DVI_OK);
  for (int k = 0; k <= 4; k++) {
    const double *given = dvi_path_q(path, k), *guessed = dvi_path_q(next, k);
    ck_assert_double_eq(distance(2, guessed, given), 0);
  }
  dvi_path_destroy(&next);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* So small a swing changes an energy of 1e2 by 1e-14, its roundings by as much. */
START_TEST(a_motion_below_the_roundings_of_its_energy_is_not_refused)
{
  const between ends = {{1e-8, 0}, {0, 1e-8}};
  problem *model = create_problem("double-pendulum", NULL);
  dvi_path *path = create_path(model, "galerkin:degree=3", 20, 1, &ends);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_lt(report.kinetic, 1e-13);
  ck_assert_double_eq(report.energy_spread, 0);
  ck_assert_double_eq(report.energy_jump, 0);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

START_TEST(what_depends_on_time_keeps_no_energy)
{
  const between ends = {{0}, {3}};
  problem *model = create_problem("driven-pendulum", NULL);
  dvi_path *path = create_path(model, "midpoint", 3, 4, &ends);
  const dvi_path_report report = solve_path(path);
  ck_assert(isnan(report.energy_spread) && isnan(report.kinetic) && isnan(report.energy_jump));
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

SUITE(energy)
{
  tcase_add_test(tests, the_spread_is_that_of_the_energies_at_the_nodes);
  tcase_add_test(tests, the_spread_falls_with_the_order_of_the_method);
  tcase_add_test(tests, a_path_that_follows_no_motion_is_not_solved);
  tcase_add_test(tests, a_refused_path_may_be_gone_on_from);
  tcase_add_test(tests, a_motion_below_the_roundings_of_its_energy_is_not_refused);
  tcase_add_test(tests, what_depends_on_time_keeps_no_energy);
}
