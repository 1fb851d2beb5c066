/* labels: unit */
/* Fixed point iteration of steps on phase space: when it serves, and that nothing is evaluated in
 * vain. */
#include <math.h>
#include <string.h>

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
  advance(step, 5, STEPS);
  dvi_integrator_counters(step, &of_long);
  ck_assert_int_gt(of_long.newtons, STEPS / 2);
  advance(step, 0.1, 2 * STEPS);
  dvi_integrator_counters(step, &of_all);
  ck_assert_int_gt(of_all.fixed_points - of_long.fixed_points, STEPS / 4);
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

/* ---- coordinates of different sizes ---- */

/* H = (p.p + 0.1 x^2 + y^2)/2. */
static int pair_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = 0.5 * (p[0] * p[0] + p[1] * p[1] + 0.1 * q[0] * q[0] + q[1] * q[1]);
  return 0;
}

static int pair_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                         void *user)
{
  (void)t, (void)user;
  H_q[0] = 0.1 * q[0];
  H_q[1] = q[1];
  memcpy(H_p, p, 2 * sizeof *p);
  return 0;
}

/* The iteration of a small oscillator does not stop where a large one beside it has settled. Each
 * step would then err by the same part of the small energy. */
START_TEST(small_coordinates_keep_their_energy)
{
  const dvi_hamiltonian H = {.value = pair_value, .gradient = pair_gradient};
  const dvi_system_terms terms = {.dimension = 2, .hamiltonian = &H, .autonomous = 1};
  const double q[2] = {1e5, 1e-4}, p[2] = {1, 1e-4};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *step = create_integrator(system, "hamiltonian");
  ck_assert_int_eq(dvi_integrator_start(step, 0, q, p), DVI_OK);
  advance(step, 0.3, 4096);
  const double y = dvi_integrator_q(step)[1], p_y = dvi_integrator_p(step)[1];
  ck_assert_double_le(fabs((y * y + p_y * p_y) / 2e-8 - 1), 1e-12);
  dvi_integrator_destroy(&step);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(hamiltonian_iteration)
{
  tcase_add_test(tests, small_coordinates_keep_their_energy);
  tcase_add_loop_test(tests, short_steps_on_a_degenerate_hamiltonian_factor_nothing, 3, 9);
  tcase_add_test(tests, long_steps_take_newtons_method_and_try_again);
}
