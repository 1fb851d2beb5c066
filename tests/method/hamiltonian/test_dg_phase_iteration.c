/* labels: unit */
/* Simplified Newton's method for steps of dg-phase with a Hamiltonian: when it serves, and what it
 * evaluates. */
#include <math.h>
#include <string.h>

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

/* ---- coordinates of different sizes ---- */

/* H = (p.p + 0.1 x^2 + y^2)/2, with z = p_z = 0. */
static int held_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = 0.5 * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + 0.1 * q[0] * q[0] + q[1] * q[1]);
  return 0;
}

static int held_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                         void *user)
{
  (void)t, (void)user;
  H_q[0] = 0.1 * q[0];
  H_q[1] = q[1];
  H_q[2] = 0;
  memcpy(H_p, p, 3 * sizeof *p);
  return 0;
}

static int held_constraint(const double *q, const double *p, double *value, void *user)
{
  (void)user;
  value[0] = q[2];
  value[1] = p[2];
  return 0;
}

static int held_constraint_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  (void)q, (void)p, (void)user;
  phi_z[0] = phi_z[1] = 1;
  return 0;
}

/* The iteration of a small oscillator does not stop where a large one beside it has settled. Each
 * step would then err by the same part of the small energy. */
START_TEST(small_coordinates_beside_constraints_keep_their_energy)
{
  static const int start[] = {0, 1, 2}, row[] = {2, 5};
  const dvi_hamiltonian H = {.value = held_value, .gradient = held_gradient};
  const dvi_constraint constraint = {.count = 2,
                                     .value = held_constraint,
                                     .gradient = held_constraint_gradient,
                                     .gradients = {start, row}};
  const dvi_system_terms terms = {
      .dimension = 3, .hamiltonian = &H, .constraint = &constraint, .autonomous = 1};
  const double q[3] = {1e3, 1e-3, 0}, p[3] = {1, 1e-3, 0};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *step = create_integrator(system, "dg-phase:degree=2");
  ck_assert_int_eq(dvi_integrator_start(step, 0, q, p), DVI_OK);
  advance(step, 0.3, 2048);
  const double y = dvi_integrator_q(step)[1], p_y = dvi_integrator_p(step)[1];
  ck_assert_double_le(fabs((y * y + p_y * p_y) / 2e-6 - 1), 1e-12);
  dvi_integrator_destroy(&step);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(dg_phase_iteration)
{
  tcase_add_test(tests, small_coordinates_beside_constraints_keep_their_energy);
  tcase_add_loop_test(tests, short_steps_take_one_set_of_second_derivatives_and_no_jacobian, 0, 6);
  tcase_add_test(tests, the_explanation_names_both_methods);
  tcase_add_test(tests, long_steps_take_newtons_method);
}
