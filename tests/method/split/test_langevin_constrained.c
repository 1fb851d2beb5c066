/* labels: unit invariant */
/* Noise beside holonomic constraints: the states stay on them, and averages are those on them. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N = 4, ROWS = 2 };
static const double kT = 3;
static const dvi_noise bath = {.temperature = 3, .friction = 2, .seed = 3};
static const char *const schemes[] = {"langevin", "langevin:scheme=obabo",
                                      "langevin:scheme=ovio,degree=1",
                                      "langevin:scheme=ovio,degree=2"};
enum { SCHEMES = 4 };

/* Two bobs in a plane, each on a rod of length 1. */
static int rods(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  for (int a = 0; a < ROWS; a++)
    phi[a] = (q[2 * a] * q[2 * a] + q[2 * a + 1] * q[2 * a + 1] - 1) / 2;
  return 0;
}

static int rods_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  memcpy(phi_q, q, N * sizeof *q);
  return 0;
}

static const double masses[N] = {1, 1, 2, 2}, force[N] = {0, 9.81, 0, 2 * 9.81};

static int weight(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i < N; i++) *V += force[i] * q[i];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memcpy(V_q, force, sizeof force);
  return 0;
}

/* The rods, and the first of them again. */
static int more_rods(double t, const double *q, double *phi, void *user)
{
  phi[2] = (q[0] * q[0] + q[1] * q[1] - 1) / 2;
  return rods(t, q, phi, user);
}

static int more_gradients(double t, const double *q, double *phi_q, void *user)
{
  memcpy(phi_q + N, q, 2 * sizeof *q);
  return rods_gradient(t, q, phi_q, user);
}

static dvi_system *make_bobs(const dvi_noise *noise, int again)
{
  static const int start[] = {0, 2, 4, 6}, row[] = {0, 1, 2, 3, 0, 1};
  const dvi_potential fall = {.name = "weight", .value = weight, .gradient = weight_gradient};
  const dvi_holonomic two = {.name = "rods",
                             .count = again ? ROWS + 1 : ROWS,
                             .value = again ? more_rods : rods,
                             .gradient = again ? more_gradients : rods_gradient,
                             .gradients = {start, row}};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass.diagonal = masses,
                                  .autonomous = 1,
                                  .potentials = &fall,
                                  .potential_count = 1,
                                  .holonomics = &two,
                                  .holonomic_count = 1,
                                  .noise = noise};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static const double q0[N] = {0, -1, 0.6, -0.8}, p0[N] = {0.5, 0, 0.8, 0.6};

static dvi_integrator *start_bobs(const dvi_system *system, const char *method)
{
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, q0, p0) == DVI_OK, "%s", dvi_last_error());
  return made;
}

/* The largest |phi|, and the largest rate of a rod. */
static double distance_of(const dvi_integrator *made)
{
  const double *q = dvi_integrator_q(made), *p = dvi_integrator_p(made);
  double phi[ROWS], largest = 0;
  (void)rods(0, q, phi, NULL);
  for (int a = 0; a < ROWS; a++)
    largest = fmax(largest,
                   fmax(fabs(phi[a]), fabs(q[2 * a] * p[2 * a] + q[2 * a + 1] * p[2 * a + 1])));
  return largest;
}

START_TEST(states_stay_on_the_constraints)
{
  dvi_system *system = make_bobs(&bath, 0);
  dvi_integrator *made = start_bobs(system, schemes[_i]);
  for (int k = 0; k < repeats(2000); k++) {
    advance(made, 0.05, 1);
    ck_assert_double_le(distance_of(made), 1e-14);
  }
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* The means of heights and of the temperature over each of 32 members are independent, and tell the
 * error of their mean. Each bound is 4 standard errors, and the bias of the step. */
START_TEST(averages_are_those_on_the_constraints)
{
  enum { COPIES = 32, STEPS = 2000 };
  static const double bessel[ROWS] = {0.82812183, 0.92000789}; /* I1/I0 of m g/kT */
  dvi_system *system = make_bobs(&bath, 0);
  double mean[3] = {0}, spread[3] = {0}, of[3][COPIES] = {{0}};
  dvi_ensemble *e = create_ensemble(system, schemes[_i],
                                    (dvi_ensemble_options){.members = COPIES, .threads = 1});
  double q[N * COPIES], p[N * COPIES];
  for (int i = 0; i < N * COPIES; i++) q[i] = q0[i / COPIES], p[i] = p0[i / COPIES];
  ck_assert_int_eq(dvi_ensemble_start(e, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.05, 100), DVI_OK);
  const int samples = repeats(STEPS) / 4;
  for (int k = 0; k < samples; k++) {
    ck_assert_int_eq(dvi_ensemble_advance(e, 0.05, 4), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, NULL), DVI_OK);
    for (int c = 0; c < COPIES; c++) {
      double T;
      ck_assert_int_eq(dvi_ensemble_temperature(e, c, &T), DVI_OK);
      of[0][c] += q[COPIES + c] / samples;
      of[1][c] += q[3 * COPIES + c] / samples;
      of[2][c] += T / samples;
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int c = 0; c < COPIES; c++) mean[i] += of[i][c] / COPIES;
    for (int c = 0; c < COPIES; c++) spread[i] += (of[i][c] - mean[i]) * (of[i][c] - mean[i]);
    const double error = sqrt(spread[i] / (COPIES - 1) / COPIES),
                 exact = i < ROWS ? -bessel[i] : kT;
    ck_assert_msg(fabs(mean[i] - exact) < 4 * error + 0.002 * fabs(exact), "%s: %g, not %g",
                  schemes[_i], mean[i], exact);
  }
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* A row that is there twice takes one degree of freedom, not two. */
START_TEST(redundant_rows_take_no_freedom)
{
  dvi_system *system = make_bobs(&bath, 0), *redundant = make_bobs(&bath, 1);
  dvi_integrator *one = start_bobs(system, schemes[_i]),
                 *other = start_bobs(redundant, schemes[_i]);
  for (int k = 0; k < 10; k++) {
    double here, there;
    ck_assert_int_eq(dvi_integrator_temperature(one, &here), DVI_OK);
    ck_assert_int_eq(dvi_integrator_temperature(other, &there), DVI_OK);
    ck_assert_double_eq_tol(here, there, 1e-11 * here);
    advance(one, 0.05, 1);
    advance(other, 0.05, 1);
  }
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&system);
  dvi_system_destroy(&redundant);
}
END_TEST

START_TEST(without_friction_steps_are_those_of_verlet_and_galerkin)
{
  static const char *const other[] = {NULL, "verlet", "galerkin:degree=1", "galerkin:degree=2"};
  const dvi_noise none = {.temperature = kT};
  dvi_system *system = make_bobs(&none, 0), *quiet = make_bobs(NULL, 0);
  dvi_integrator *noisy = start_bobs(system, schemes[_i]), *still = start_bobs(quiet, other[_i]);
  advance(noisy, 0.05, 40);
  advance(still, 0.05, 40);
  ck_assert_double_le(distance(N, dvi_integrator_q(noisy), dvi_integrator_q(still)), 1e-12);
  dvi_integrator_destroy(&noisy);
  dvi_integrator_destroy(&still);
  dvi_system_destroy(&system);
  dvi_system_destroy(&quiet);
}
END_TEST

SUITE(langevin_constrained)
{
  tcase_add_loop_test(tests, states_stay_on_the_constraints, 0, SCHEMES);
  tcase_add_loop_test(tests, averages_are_those_on_the_constraints, 0, SCHEMES);
  tcase_add_loop_test(tests, redundant_rows_take_no_freedom, 0, SCHEMES);
  tcase_add_loop_test(tests, without_friction_steps_are_those_of_verlet_and_galerkin, 1, SCHEMES);
}
