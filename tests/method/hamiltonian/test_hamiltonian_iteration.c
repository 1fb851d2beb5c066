/* labels: unit */
/* Fixed point iteration of steps on phase space: when it serves, and that nothing is evaluated in
 * vain. */
#include "support/systems/hamiltonians.h"
#include "support/suite.h"

/* Momenta of the elastica are small beside its growing length, and their errors look large in the
 * one unit while those of coordinates look small. The iteration contracts all the same. */
START_TEST(short_steps_on_a_degenerate_hamiltonian_factor_nothing)
{
  enum { STEPS = 67, SWEEPS = 2 };
  problem *model = create_problem("elastica", NULL);
  dvi_integrator *step = start_integrator(model, method_spec("hamiltonian:degree=%d", _i));
  dvi_counters before, after;
  dvi_integrator_counters(step, &before);
  advance(step, 0.3, STEPS);
  dvi_integrator_counters(step, &after);
  ck_assert_int_eq(after.fixed_points, STEPS);
  ck_assert_int_eq(after.newtons + after.factorizations + after.jacobians, 0);
  ck_assert_int_eq(after.gradients - before.gradients, SWEEPS * _i * after.residuals);
  ck_assert_int_le(after.residuals, 8L * STEPS);
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

/* Steps over which the iteration hardly contracts go to Newton's method, more and more of them at
 * once, and the iteration is tried again. */
START_TEST(long_steps_take_newtons_method_and_try_again)
{
  enum { STEPS = 40 };
  problem *model = create_problem("elastica", NULL);
  dvi_integrator *step = start_integrator(model, "hamiltonian:degree=4");
  dvi_counters of_long, of_all;
  advance(step, 3, STEPS);
  dvi_integrator_counters(step, &of_long);
  ck_assert_int_gt(of_long.newtons, STEPS / 2);
  advance(step, 0.1, 2 * STEPS);
  dvi_integrator_counters(step, &of_all);
  ck_assert_int_gt(of_all.fixed_points - of_long.fixed_points, STEPS / 4);
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

SUITE(hamiltonian_iteration)
{
  tcase_add_loop_test(tests, short_steps_on_a_degenerate_hamiltonian_factor_nothing, 3, 9);
  tcase_add_test(tests, long_steps_take_newtons_method_and_try_again);
}
