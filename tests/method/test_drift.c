/* labels: invariant slow long */
/* In a million steps, or a tenth of them in a short run, the energy error stays bounded, without a
 * trend that the scatter of its block means could not explain. */
#include <check.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

static const struct {
  const char *problem, *method;
  double h, bound; /* on the oscillation, C h^order, twice the measured size */
} run[] = {
    {"pendulum", "midpoint", 0.1, 1.7e-3},
    {"pendulum", "midpoint:solver=newton", 0.1, 1.7e-3},
    {"pendulum", "midpoint:solver=kinsol", 0.1, 1.7e-3},
    {"pendulum", "verlet", 0.1, 4e-3},
    {"pendulum", "galerkin", 0.1, 5e-7},
    {"henon-heiles", "galerkin", 0.1, 1e-5},
    {"fpu", "galerkin:degree=5", 0.01, 3e-13}, /* of a lower degree slow exchanges would show */
    {"fpu", "verlet", 0.01, 1e-1},
    {"fpu", "midpoint", 0.01, 1e-1},
};
enum { RUNS = sizeof run / sizeof *run };

START_TEST(energy_does_not_drift_over_a_million_steps)
{
  const int steps = repeats(1000000);
  problem *model = create_problem(run[_i].problem, NULL);
  dvi_integrator *integrator = start_integrator(model, run[_i].method);
  double value[16];
  dvi_drift energy;
  dvi_drift_fit fit;
  dvi_drift_init(&energy);
  for (int step = 0; step <= steps; step += 20) {
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    dvi_drift_add(&energy, dvi_integrator_time(integrator), value[0]);
    advance(integrator, run[_i].h, 20);
  }
  dvi_drift_result(&energy, &fit);
  ck_assert_msg(fit.largest <= run[_i].bound, "%s, %s: energy error %g", run[_i].problem,
                run[_i].method, fit.largest);
  /* Significance 3 is the usual threshold. A trend of less than 1e-3 of the oscillation could hide,
   * which is 1e-9 of it a step over 1e6 steps. */
  ck_assert_msg(fit.significance < 3 || fabs(fit.change) < 1e-3 * fit.largest,
                "%s, %s: change %g, significance %g", run[_i].problem, run[_i].method, fit.change,
                fit.significance);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* L = |v|^2/2 + B (x v_y - y v_x)/2. A charge goes round in circles, and Gauss quadrature keeps
 * energy and angular momentum exactly. The solvers make the remaining errors. */
static int charge_value(double t, const double *q, const double *v, double *L, void *user)
{
  const double B = *(const double *)user;
  (void)t;
  *L = (v[0] * v[0] + v[1] * v[1]) / 2 + B / 2 * (q[0] * v[1] - q[1] * v[0]);
  return 0;
}

static int charge_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                           void *user)
{
  const double B = *(const double *)user;
  (void)t;
  L_q[0] = B / 2 * v[1];
  L_q[1] = -B / 2 * v[0];
  L_v[0] = v[0] - B / 2 * q[1];
  L_v[1] = v[1] + B / 2 * q[0];
  return 0;
}

/* Energy after so many steps of 0.1 must be what it was. Frees the system. */
static void check_energy(dvi_system *system, const char *method, const double *q, const double *v,
                         int steps, double tolerance)
{
  double first, last;
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  advance(integrator, 0.1, steps);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &last), DVI_OK);
  ck_assert_double_eq_tol(last, first, tolerance);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

/* Iterations that stop with forces of the point before the last err in one direction, 1.7e-12 in
 * these 1e5 steps. Random roundings of an energy of 0.2 make 1e-14. */
START_TEST(a_charge_in_a_magnetic_field_keeps_its_energy_at_roundoff)
{
  static const char *const methods[] = {"galerkin:degree=2", "galerkin:degree=2,solver=newton",
                                        "galerkin:degree=2,solver=fixed-point", "galerkin:degree=3",
                                        "midpoint"};
  double B = 1.3;
  const dvi_lagrangian l = {.value = charge_value, .gradient = charge_gradient, .user = &B};
  const dvi_system_terms terms = {.dimension = 2, .lagrangian = &l};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  check_energy(system, methods[_i], (double[]){0.3, 0.1}, (double[]){0.6, 0.2}, repeats(100000),
               5e-14);
}
END_TEST

/* ---- a stiff oscillator beside a slow one ---- */

static int pair_value(double t, const double *q, double *V, void *user)
{
  const double d = q[0] - q[1];
  (void)t;
  *V = (q[0] * q[0] + *(const double *)user * q[1] * q[1] + d * d) / 2;
  return 0;
}

static int pair_gradient(double t, const double *q, double *V_q, void *user)
{
  const double d = q[0] - q[1];
  (void)t;
  V_q[0] = q[0] + d;
  V_q[1] = *(const double *)user * q[1] - d;
  return 0;
}

/* Fixed-point iterations contract by modes that rotate at h omega = 1 to 2.7, and a correction may
 * be small by chance. Iterations that stopped there erred in one direction, 1e-12 in 65536 steps,
 * where roundings of an energy of 1 make 3e-14. */
START_TEST(a_stiff_oscillator_keeps_its_energy_at_roundoff)
{
  static const struct {
    const char *method;
    double stiffness;
  } pairs[] = {{"galerkin:degree=8", 324}, {"galerkin:degree=8", 400}, {"galerkin:degree=8", 600},
               {"galerkin:degree=8", 700}, {"galerkin:degree=4", 150}, {"galerkin:degree=3", 200},
               {"midpoint", 100}};
  double stiffness = pairs[_i].stiffness;
  const dvi_potential springs = {
      .value = pair_value, .gradient = pair_gradient, .user = &stiffness};
  const dvi_system_terms terms = {
      .dimension = 2, .mass.scalar = 1, .potentials = &springs, .potential_count = 1};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  const int steps = repeats(65536);
  check_energy(system, pairs[_i].method, (double[]){1, 1 / sqrt(stiffness)}, (double[]){0.5, 0.3},
               steps, 5e-13 * steps / 65536);
}
END_TEST

/* By Brouwer's law roundings without a common direction make an energy error that grows like the
 * square root of the steps. Averaged over orbits of different shape, the exponent is known to about
 * 0.1. With h/m p0 rounded, in stages and ends alike, it was 0.83 from 6.6e4 to 4.2e6 steps. */
START_TEST(the_energy_error_grows_like_the_square_root_of_the_steps)
{
  enum { ORBITS = 12, OCTAVES = 17, FIRST = 128 };
  const int octaves = is_short_run() ? OCTAVES - 4 : OCTAVES; /* 5.2e5 steps, or 8.4e6 */
  double error[OCTAVES] = {0}, x = 0, y = 0, xx = 0, xy = 0;
  for (int orbit = 0; orbit < ORBITS; orbit++) {
    double first[8], value[8];
    problem *model = create_problem("kepler", method_spec("e=%g", 0.3 + 0.03 * orbit));
    dvi_integrator *integrator = start_integrator(model, "galerkin:degree=8");
    ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
    for (int k = 0; k < octaves; k++) {
      advance(integrator, 0.1, k == 0 ? FIRST : FIRST << (k - 1));
      ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
      error[k] += fabs(value[0] - first[0]) / ORBITS;
    }
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
  for (int k = 0; k < octaves; k++)
    x += k, y += log2(error[k]), xx += k * k, xy += k * log2(error[k]);
  const double exponent = (octaves * xy - x * y) / (octaves * xx - x * x);
  ck_assert_double_le(exponent, 0.65);
  /* Roundings of an energy of 1/2 would make 1.6e-13 in 8.4e6 steps. */
  ck_assert_double_le(error[octaves - 1], is_short_run() ? 2.5e-14 : 1e-13);
}
END_TEST

SUITE(drift)
{
  tcase_set_timeout(tests, 200);
  tcase_add_loop_test(tests, energy_does_not_drift_over_a_million_steps, 0, RUNS);
  tcase_add_loop_test(tests, a_charge_in_a_magnetic_field_keeps_its_energy_at_roundoff, 0, 5);
  tcase_add_loop_test(tests, a_stiff_oscillator_keeps_its_energy_at_roundoff, 0, 7);
  tcase_add_test(tests, the_energy_error_grows_like_the_square_root_of_the_steps);
}
