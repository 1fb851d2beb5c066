/* labels: unit */
/* Simplified Newton's method for steps of dg-phase with a Hamiltonian: when it serves, and what it
 * evaluates. */
#include "support/systems/degenerate.h"
#include "support/suite.h"

/* One set of second derivatives a solve, of H at the stages, and of the constraints where they act.
 * The first step solves four times more, for its multiplier. The first ones are far from their
 * guesses, and take a second set. */
START_TEST(short_steps_take_one_set_of_second_derivatives_and_no_jacobian)
{
  enum { STEPS = 100, FIRST = 4, DEGREES_FROM = 3 };
  const char *const names[] = {"circle-dirac", "magnetic-pair"};
  const int degree = DEGREES_FROM + _i / 2, points = degree + degree - degree % 2;
  problem *model = create_problem(names[_i % 2], NULL);
  dvi_integrator *step = start_integrator(model, method_spec("dg-phase:degree=%d", degree));
  dvi_counters before, after;
  dvi_integrator_counters(step, &before);
  advance(step, 0.1, STEPS);
  dvi_integrator_counters(step, &after);
  ck_assert_int_eq(after.simplified, STEPS + FIRST);
  ck_assert_int_eq(after.fixed_points + after.newtons + after.jacobians + after.followed, 0);
  ck_assert_int_le(after.hessians - before.hessians, (2 * degree + 1) * (STEPS + 5 * FIRST));
  ck_assert_int_ge(after.hessians - before.hessians, points * (STEPS + FIRST));
  ck_assert_int_le(after.residuals, 7L * STEPS);
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

START_TEST(the_explanation_names_both_methods)
{
  char text[4096];
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *step = start_integrator(model, "dg-phase:degree=4");
  ck_assert_uint_lt(dvi_integrator_explain(step, text, sizeof text), sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "solver: simplified Newton's method, Newton's method, last"));
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

START_TEST(long_steps_take_newtons_method)
{
  enum { STEPS = 12 };
  problem *model = create_problem("magnetic-pair", NULL);
  dvi_integrator *step = start_integrator(model, "dg-phase:degree=4");
  dvi_counters count;
  advance(step, 2, STEPS);
  dvi_integrator_counters(step, &count);
  ck_assert_int_gt(count.newtons, 0);
  ck_assert_int_gt(count.jacobians, 0);
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

SUITE(dg_phase_iteration)
{
  tcase_add_loop_test(tests, short_steps_take_one_set_of_second_derivatives_and_no_jacobian, 0, 6);
  tcase_add_test(tests, the_explanation_names_both_methods);
  tcase_add_test(tests, long_steps_take_newtons_method);
}
