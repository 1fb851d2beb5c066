/* labels: unit */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/suite.h"

START_TEST(a_step_is_kick_drift_kick)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator, "verlet");
  const double h = 0.25, k = 0.5, q0 = oscillator->q[0], p0 = oscillator->p[0];
  const double p_half = p0 - h / 2 * k * q0, q1 = q0 + h * p_half, p1 = p_half - h / 2 * k * q1;
  advance(integrator, h, 1);
  /* the same operations, at most a rounding apart */
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q1, 1e-16);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], p1, 1e-16);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

START_TEST(a_step_costs_one_gradient_and_nothing_else)
{
  problem *solar = create_problem("outer-solar", NULL);
  dvi_integrator *integrator = start_integrator(solar, "verlet");
  dvi_counters before, after;
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 10, 1);
  dvi_integrator_counters(integrator, &after);
  /* the first step needs the start's forces, too */
  ck_assert_int_eq(after.gradients - before.gradients, 2);
  advance(integrator, 10, 100);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - before.gradients, 102);
  ck_assert_int_eq(after.hessians + after.jacobians + after.factorizations + after.residuals, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&solar);
}
END_TEST

/* Newton's method begins with the forces at the end of the last step. Linear friction takes one
 * correction, whose result is tested with the forces of the kick. Where v is small beside its
 * roundings, it takes another. */
START_TEST(a_step_with_linear_friction_evaluates_forces_twice)
{
  problem *damped = create_problem("damped-driven", NULL);
  dvi_integrator *integrator = start_integrator(damped, "verlet");
  dvi_counters before, after;
  advance(integrator, 0.1, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.1, 200);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_ge(after.gradients - before.gradients, 3 * 200);
  ck_assert_int_le(after.gradients - before.gradients, 3 * 200 + 10);
  ck_assert_int_eq(after.jacobians - before.jacobians, 200);
  /* one coordinate needs no factor */
  ck_assert_int_eq(after.factorizations, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&damped);
}
END_TEST

/* Air that drives a body backward in time, and a kick in the second step. */
static int kick_value(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = t < -0.05 ? -140 * q[0] : 0;
  return 0;
}

static int kick_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)q, (void)user;
  V_q[0] = t < -0.05 ? -140 : 0;
  return 0;
}

static int drag(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  F[0] = -fabs(v[0]) * v[0];
  return 0;
}

/* v = g + |v|v/20 has three solutions. That of short steps is the one near g. The velocity before
 * the kick is nearly where the equation's slope vanishes. */
START_TEST(friction_has_the_velocity_of_short_steps)
{
  const dvi_potential potential = {.value = kick_value, .gradient = kick_gradient};
  const dvi_force force = {.value = drag};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass.scalar = 1,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .forces = &force,
                                  .force_count = 1};
  const double h = -0.1, before = 9.5, q = 0, p = before - before * before / 20;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "verlet");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
  advance(integrator, h, 1);
  const double q1 = dvi_integrator_q(integrator)[0];
  ck_assert_double_eq_tol(q1, h * before, 1e-14);
  const double g = dvi_integrator_p(integrator)[0] - h / 2 * -140;
  advance(integrator, h, 1);
  ck_assert_double_eq_tol((dvi_integrator_q(integrator)[0] - q1) / h, 10 * (1 - sqrt(1 - g / 5)),
                          1e-12);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_general_lagrangian_is_refused_by_name)
{
  problem *pendula = create_problem("double-pendulum", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(pendula->system, "verlet", &integrator), DVI_UNSUPPORTED);
  ck_assert_ptr_null(integrator);
  check_words("general Lagrangian");
  problem_destroy(&pendula);
}
END_TEST

static int spring_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] * q[0] / 2;
  return 0;
}

static int spring_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  for (int i = 0; i < *(const int *)user; i++) V_q[i] = i == 0 ? q[0] : 0;
  return 0;
}

/* The missing Hessian would have 2.5e9 entries, and a method that needs it says so. */
START_TEST(no_hessian_is_made_for_it)
{
  int n = 50000;
  const dvi_potential potential = {.value = spring_value, .gradient = spring_gradient, .user = &n};
  const dvi_system_terms terms = {
      .dimension = n, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *system = NULL;
  double *zeros = calloc((size_t)n, sizeof *zeros);
  ck_assert_ptr_nonnull(zeros);
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "verlet"), *implicit = integrator;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, zeros, zeros), DVI_OK);
  advance(integrator, 0.1, 3);
  ck_assert_int_eq(dvi_integrator_create(system, "midpoint", &implicit), DVI_BAD_SIZE);
  ck_assert_ptr_null(implicit);
  check_words("declare a sparse pattern");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  free(zeros);
}
END_TEST

START_TEST(what_it_cannot_do_is_refused_by_name)
{
  static const struct {
    const char *method;
    dvi_status status;
    const char *words;
  } cases[] = {
      {"verlet:degree=2", DVI_BAD_OPTION, "degree"},
      {"verlet:blocking=tidal", DVI_BAD_OPTION, "auto, temporal, none"},
      {"verlet:threads=0", DVI_BAD_OPTION, "1 to 64"},
      {"verlet:threads=65", DVI_BAD_OPTION, "1 to 64"},
      {"verlet:threads=-1", DVI_BAD_OPTION, "plain digits"},
      {"verlet:blocking=temporal", DVI_UNSUPPORTED, "no gradient_range"},
      {"verlet:threads=2", DVI_UNSUPPORTED, "no gradient_range"},
      {"verlet:threads=2,blocking=none", DVI_UNSUPPORTED, "blocking=none"},
      {"composition:order=4,threads=2", DVI_UNSUPPORTED, "no gradient_range"},
  };
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(oscillator->system, cases[_i].method, &integrator),
                   cases[_i].status);
  ck_assert_ptr_null(integrator);
  check_words(cases[_i].words);
  problem_destroy(&oscillator);
}
END_TEST

SUITE(verlet)
{
  tcase_add_test(tests, a_step_is_kick_drift_kick);
  tcase_add_test(tests, a_step_costs_one_gradient_and_nothing_else);
  tcase_add_test(tests, a_step_with_linear_friction_evaluates_forces_twice);
  tcase_add_test(tests, friction_has_the_velocity_of_short_steps);
  tcase_add_test(tests, a_general_lagrangian_is_refused_by_name);
  tcase_add_loop_test(tests, what_it_cannot_do_is_refused_by_name, 0, 9);
  tcase_add_test(tests, no_hessian_is_made_for_it);
}
