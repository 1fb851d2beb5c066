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

/* Newton's method begins without friction. Linear friction takes one correction, whose result is
 * tested with the forces of the kick. Where v is small beside its roundings, it takes another. */
START_TEST(a_step_with_linear_friction_evaluates_forces_three_times)
{
  problem *damped = create_problem("damped-driven", NULL);
  dvi_integrator *integrator = start_integrator(damped, "verlet");
  dvi_counters before, after;
  advance(integrator, 0.1, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.1, 200);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_ge(after.gradients - before.gradients, 4 * 200);
  ck_assert_int_le(after.gradients - before.gradients, 4 * 200 + 10);
  ck_assert_int_eq(after.jacobians - before.jacobians, 200);
  /* one coordinate needs no factor */
  ck_assert_int_eq(after.factorizations, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&damped);
}
END_TEST

/* A constant force a and a force F(v), which act from the end of the first step on. */
typedef struct kicks {
  double h, a;
  double (*F)(double v);
} kicks;

static int acts(const kicks *of, double t)
{
  return fabs(t) > fabs(of->h) / 2;
}

static int kick_value(double t, const double *q, double *V, void *user)
{
  const kicks *of = user;
  *V = acts(of, t) ? -of->a * q[0] : 0;
  return 0;
}

static int kick_gradient(double t, const double *q, double *V_q, void *user)
{
  const kicks *of = user;
  (void)q;
  V_q[0] = acts(of, t) ? -of->a : 0;
  return 0;
}

static int friction(double t, const double *q, const double *v, double *F, void *user)
{
  const kicks *of = user;
  (void)q;
  F[0] = acts(of, t) ? of->F(v[0]) : 0;
  return 0;
}

static double quadratic_drag(double v)
{
  return -fabs(v) * v;
}

/* v = 1 + F(v)/20 for v = 1.1 and v = 1.9. */
static double drive(double v)
{
  return 20 * (v - 1 + (v - 1.1) * (v - 1.9));
}

/* The equation of the second step's velocity has several solutions. That of short steps is the one
 * near M^-1 p. The velocity before the kick would lead to another one. */
static void check_second_velocity(kicks *of, double first, double second)
{
  const dvi_potential potential = {.value = kick_value, .gradient = kick_gradient, .user = of};
  const dvi_force force = {.value = friction, .user = of};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass.scalar = 1,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .forces = &force,
                                  .force_count = 1};
  const double q = 0;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "verlet");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &first), DVI_OK);
  advance(integrator, of->h, 1);
  const double q1 = dvi_integrator_q(integrator)[0];
  ck_assert_double_eq_tol(q1, of->h * first, 1e-14);
  advance(integrator, of->h, 1);
  ck_assert_double_eq_tol((dvi_integrator_q(integrator)[0] - q1) / of->h, second, 1e-12);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

/* Air drives a body back in time, v = g + v^2/20. */
START_TEST(friction_has_the_velocity_of_short_steps)
{
  const double first = 9.5, g = first + first * first / 20 - 14;
  kicks back = {-0.1, 140, quadratic_drag}, ahead = {0.1, -20.9, drive};
  check_second_velocity(&back, first, 10 * (1 - sqrt(1 - g / 5)));
  check_second_velocity(&ahead, 2, 1.1);
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
  tcase_add_test(tests, a_step_with_linear_friction_evaluates_forces_three_times);
  tcase_add_test(tests, friction_has_the_velocity_of_short_steps);
  tcase_add_test(tests, a_general_lagrangian_is_refused_by_name);
  tcase_add_loop_test(tests, what_it_cannot_do_is_refused_by_name, 0, 9);
  tcase_add_test(tests, no_hessian_is_made_for_it);
}
