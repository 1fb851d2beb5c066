/* labels: order */
/* Verlet's method with holonomic constraints: two rods with bobs, in Cartesian coordinates. */
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N = 4 };

/* those of the catalogue's double-pendulum */
static const double gravity = 9.80665, l1 = 2, l2 = 3, m1 = 1, m2 = 2;

static int weight(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = gravity * (m1 * q[1] + m2 * q[3]);
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  V_q[0] = V_q[2] = 0;
  V_q[1] = gravity * m1;
  V_q[3] = gravity * m2;
  return 0;
}

static int rods(double t, const double *q, double *phi, void *user)
{
  const double x = q[2] - q[0], y = q[3] - q[1];
  (void)t, (void)user;
  phi[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - l1 * l1);
  phi[1] = 0.5 * (x * x + y * y - l2 * l2);
  return 0;
}

static int rods_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double x = q[2] - q[0], y = q[3] - q[1];
  (void)t, (void)user;
  memcpy(phi_q, (const double[]){q[0], q[1], -x, -y, x, y}, 6 * sizeof *phi_q);
  return 0;
}

/* A second declaration of the first rod. */
static int same_rod(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  phi[0] = q[0] * q[0] + q[1] * q[1] - l1 * l1;
  return 0;
}

static int same_rod_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  memcpy(phi_q, (const double[]){2 * q[0], 2 * q[1], 0, 0}, N * sizeof *phi_q);
  return 0;
}

static const int rods_start[] = {0, 2, 6}, rods_row[] = {0, 1, 0, 1, 2, 3};

static dvi_system *make_rods(dvi_mass mass, int terms)
{
  const dvi_potential V = {.name = "weight", .value = weight, .gradient = weight_gradient};
  const dvi_holonomic holonomics[] = {
      {.name = "rods",
       .count = 2,
       .value = rods,
       .gradient = rods_gradient,
       .gradients = {rods_start, rods_row}},
      {.name = "same rod", .count = 1, .value = same_rod, .gradient = same_rod_gradient}};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = N,
                                                         .mass = mass,
                                                         .potentials = &V,
                                                         .potential_count = 1,
                                                         .holonomics = holonomics,
                                                         .holonomic_count = terms},
                                     &system),
                   DVI_OK);
  return system;
}

/* Starts with both rods at the angles pi/4 and pi/2 from straight down. The momenta are those of
 * the masses m1 and m2 if the lower rod turns at pi/8, or 0. */
static dvi_integrator *start_rods(const dvi_system *system, const char *method, int turns)
{
  const double pi = acos(-1), x = l1 * sin(pi / 4), y = -l1 * cos(pi / 4);
  const double q[N] = {x, y, x + l2, y}, p[N] = {0, 0, 0, turns ? m2 * l2 * pi / 8 : 0};
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* All three forms of a mass, of which the full one couples all constraints. */
START_TEST(masses_of_every_form_give_the_states_of_trapezoidal)
{
  static const double diagonal[N] = {2, 2, 0.5, 0.5};
  static const double full[] = {2, 0.3, 0, 0.1, 0.3, 1, 0.2, 0, 0, 0.2, 1.5, 0.4, 0.1, 0, 0.4, 1};
  const dvi_mass masses[] = {{.scalar = 1.5}, {.diagonal = diagonal}, {.values = full}};
  for (int m = 0; m < 3; m++) {
    dvi_system *system = make_rods(masses[m], 1);
    dvi_integrator *one = start_rods(system, "verlet", 0),
                   *other = start_rods(system, "trapezoidal", 0);
    advance(one, 0.01, 40);
    advance(other, 0.01, 40);
    ck_assert_double_lt(distance(N, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-12);
    ck_assert_double_lt(distance(N, dvi_integrator_p(one), dvi_integrator_p(other)), 1e-11);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* The catalogue's digits at t = 1, in quadruple precision, are those of angles. */
START_TEST(rods_in_cartesian_coordinates_are_the_double_pendulum)
{
  static const double angles[] = {0.61490406957921587, 0.37981894693941085};
  static const double masses[N] = {1, 1, 2, 2};
  dvi_system *system = make_rods((dvi_mass){.diagonal = masses}, 1);
  dvi_integrator *integrator = start_rods(system, "composition:order=6,base=verlet", 1);
  advance(integrator, 0.0025, 400);
  const double *q = dvi_integrator_q(integrator);
  ck_assert_double_eq_tol(atan2(q[0], -q[1]), angles[0], 1e-11);
  ck_assert_double_eq_tol(atan2(q[2] - q[0], q[1] - q[3]), angles[1], 1e-11);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* Corrections of short steps are small from the first on, which does not make them roundings. The
 * bound is 10 roundings of a summand of phi. */
START_TEST(short_steps_stay_on_the_constraints_to_rounding)
{
  static const double h[] = {4e-3, 2e-3, 1e-3, 5e-4};
  dvi_system *system = make_rods((dvi_mass){.scalar = 1}, 1);
  for (int k = 0; k < 4; k++) {
    dvi_integrator *integrator = start_rods(system, "verlet", 0);
    double worst = 0;
    for (int step = 0; step < 400; step++) {
      double off;
      advance(integrator, h[k], 1);
      ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
      worst = fmax(worst, off);
    }
    ck_assert_double_lt(worst, 10 * 0x1p-52 * l2 * l2 / 2);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_restored_run_has_the_bits_of_one_that_goes_on)
{
  static char bytes[8192];
  size_t size;
  dvi_system *system = make_rods((dvi_mass){.scalar = 1}, 1);
  dvi_integrator *one = start_rods(system, "verlet", 0),
                 *other = create_integrator(system, "verlet");
  advance(one, 0.01, 20);
  ck_assert_int_eq(dvi_integrator_save_memory(one, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
  advance(one, 0.01, 20);
  advance(other, 0.01, 20);
  ck_assert_mem_eq(dvi_integrator_q(one), dvi_integrator_q(other), N * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(one), dvi_integrator_p(other), N * sizeof(double));
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&system);
}
END_TEST

/* All forms of a mass, with a rod that is declared twice. */
START_TEST(rows_that_follow_from_others_change_nothing)
{
  static const double diagonal[N] = {2, 2, 0.5, 0.5};
  static const double full[] = {2, 0.3, 0, 0.1, 0.3, 1, 0.2, 0, 0, 0.2, 1.5, 0.4, 0.1, 0, 0.4, 1};
  const dvi_mass masses[] = {{.scalar = 1.5}, {.diagonal = diagonal}, {.values = full}};
  for (int m = 0; m < 3; m++) {
    dvi_system *once = make_rods(masses[m], 1), *twice = make_rods(masses[m], 2);
    dvi_integrator *one = start_rods(once, "verlet", 0), *other = start_rods(twice, "verlet", 0);
    advance(one, 0.01, 40);
    advance(other, 0.01, 40);
    ck_assert_double_lt(distance(N, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-13);
    ck_assert_double_lt(distance(N, dvi_integrator_p(one), dvi_integrator_p(other)), 1e-12);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
    dvi_system_destroy(&once);
    dvi_system_destroy(&twice);
  }
}
END_TEST

SUITE(rattle)
{
  tcase_add_test(tests, masses_of_every_form_give_the_states_of_trapezoidal);
  tcase_add_test(tests, rods_in_cartesian_coordinates_are_the_double_pendulum);
  tcase_add_test(tests, short_steps_stay_on_the_constraints_to_rounding);
  tcase_add_test(tests, a_restored_run_has_the_bits_of_one_that_goes_on);
  tcase_add_test(tests, rows_that_follow_from_others_change_nothing);
}
