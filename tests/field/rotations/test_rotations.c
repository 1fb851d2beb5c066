/* Fields of rotations: digits, orders, momenta, held ends, potentials, refusals. */
#include <dvi/group.h>
#include <dvi/integrator.h>
#include <dvi/rotations.h>
#include <math.h>
#include <string.h>

#include "support/suite.h"

enum { NODES = 16, MOST = 64 };

static const double pi = 3.14159265358979323846;

/* Jd = diag(.5,.7,.9) and Kd = diag(.4,.5,.6) as J = tr(Jd) I - Jd and K likewise. */
static const double J[9] = {1.6, 0, 0, 0, 1.4, 0, 0, 0, 1.2},
                    K[9] = {1.1, 0, 0, 0, 1.0, 0, 0, 0, 0.9};

static dvi_rotations *circle(int cells)
{
  const dvi_axis axis = {.from = 0, .to = 2 * pi, .periodic = 1};
  dvi_rotations *field = NULL;
  ck_assert_int_eq(dvi_rotations_create(&(dvi_rotations_terms){.size = sizeof(dvi_rotations_terms),
                                                               .axis = &axis,
                                                               .axes = 1,
                                                               .cells = &cells,
                                                               .inertia = J,
                                                               .stiffness = K},
                                        &field),
                   DVI_OK);
  return field;
}

/* R = exp(x e3) exp((.4 sin x, .3 cos x, 0)), Omega = (.3 cos x, .2, .1 sin 2x). */
static void start(const dvi_rotations *field, double *q, double *p)
{
  const double *x, *volume;
  const int64_t nodes = dvi_rotations_nodes(field, &x, &volume);
  for (int64_t a = 0; a < nodes; a++) {
    double turn[9], bend[9];
    const double Omega[3] = {0.3 * cos(x[a]), 0.2, 0.1 * sin(2 * x[a])};
    dvi_so3_exp((double[]){0, 0, x[a]}, turn);
    dvi_so3_exp((double[]){0.4 * sin(x[a]), 0.3 * cos(x[a]), 0}, bend);
    for (int i = 0; i < 9; i++)
      q[9 * a + i] = turn[i / 3 * 3] * bend[i % 3] + turn[i / 3 * 3 + 1] * bend[3 + i % 3] +
                     turn[i / 3 * 3 + 2] * bend[6 + i % 3];
    for (int i = 0; i < 3; i++) p[3 * a + i] = volume[a] * J[4 * i] * Omega[i];
  }
}

/* Run for T = 2. Returns the largest change of the energy, and of a momentum. */
static double run(double h, const char *method, double *momenta, double *energy, double *drift)
{
  dvi_rotations *field = circle(NODES);
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  double q[9 * NODES], p[3 * NODES], value[4], worst = 0;
  start(field, q, p);
  ck_assert_int_eq(dvi_rotations_system(field, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, method, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
  *energy = value[0];
  *drift = 0;
  memcpy(momenta, value + 1, 3 * sizeof *momenta);
  for (int n = 0; n < (int)lround(2 / h); n++) {
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    worst = fmax(worst, fabs(value[0] - *energy));
    for (int k = 0; k < 3; k++) *drift = fmax(*drift, fabs(value[1 + k] - momenta[k]));
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_rotations_destroy(&field);
  return worst;
}

/* The momentum and the energy were computed by a program of numpy, and so were the energy errors
 * 7.1e-5, 1.8e-5, 4.5e-6 of this scheme. */
START_TEST(a_chiral_field_keeps_its_momenta_and_its_energy_error_has_order_2)
{
  static const double momentum[3] = {1.43511553, -.01845935, -.44432863},
                      published[3] = {7.1e-5, 1.8e-5, 4.5e-6};
  double found[3], energy, drift, before = 0;
  for (int i = 0; i < 3; i++) {
    const double error = run(0.04 / (1 << i), "lie-verlet", found, &energy, &drift);
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(found[k], momentum[k], 5e-9);
    ck_assert_double_eq_tol(energy, 3.230177861, 5e-10);
    ck_assert_double_lt(drift, 2e-14);
    ck_assert_double_eq_tol(error, published[i], 0.05 * published[i]);
    if (i > 0) ck_assert_double_eq_tol(log2(before / error), 2, 0.05);
    before = error;
  }
}
END_TEST

START_TEST(lie_galerkin_steps_a_chiral_field_with_order_4)
{
  double found[3], energy, drift, before = 0;
  for (int i = 0; i < 3; i++) {
    const double error = run(0.2 / (1 << i), "lie-galerkin:degree=2", found, &energy, &drift);
    ck_assert_double_lt(drift, 1e-13);
    if (i > 0) ck_assert_double_gt(log2(before / error), 3.8);
    before = error;
  }
}
END_TEST

/* ---- callbacks ---- */

static const double field_of_force[3] = {0.3, -0.2, 0.9};

/* V = (1 + x) (R^T g)_3 + R_11 R_12. */
static int weight(const double *x, const double *R, double *V, double *V_R, double *V_RR,
                  void *user)
{
  (void)user;
  if (V != NULL) {
    *V = R[0] * R[1];
    for (int i = 0; i < 3; i++) *V += (1 + x[0]) * field_of_force[i] * R[3 * i + 2];
  }
  if (V_R != NULL) {
    memset(V_R, 0, 9 * sizeof *V_R);
    V_R[0] = R[1];
    V_R[1] = R[0];
    for (int i = 0; i < 3; i++) V_R[3 * i + 2] = (1 + x[0]) * field_of_force[i];
  }
  if (V_RR != NULL) {
    memset(V_RR, 0, 81 * sizeof *V_RR);
    V_RR[1] = V_RR[9] = 1;
  }
  return 0;
}

static int straight(const double *x, double *R, void *user)
{
  (void)user;
  dvi_so3_exp((double[]){0.1 * x[0], 0, 0.2}, R);
  return 0;
}

static int no_rotation(const double *x, double *R, void *user)
{
  (void)x, (void)user;
  for (int i = 0; i < 9; i++) R[i] = 1;
  return 0;
}

/* A plate of 4 x 3 cells, periodic along the second axis, with a held end. K is full. */
static dvi_rotations_terms plate(void)
{
  static const dvi_axis axes[2] = {{.from = -1, .to = 1}, {.from = 0, .to = 3, .periodic = 1}};
  static const int cells[2] = {4, 3}, clamped[4] = {1, 0, 0, 0};
  static const double stiffness[18] = {2, .1, .2, .1, 3, .3, .2, .3, 4,
                                       1, 0,  .5, 0,  2, 0,  .5, 0,  3};
  static const dvi_rotations_potential potential = {weight, NULL};
  return (dvi_rotations_terms){.size = sizeof(dvi_rotations_terms),
                               .axis = axes,
                               .axes = 2,
                               .cells = cells,
                               .inertia = J,
                               .stiffness = stiffness,
                               .is_clamped = clamped,
                               .held = straight,
                               .potential = &potential};
}

START_TEST(derivatives_of_a_held_plate_with_a_potential_are_right)
{
  const dvi_rotations_terms terms = plate();
  dvi_rotations *field = NULL;
  dvi_system *system = NULL;
  double q[9 * MOST], v[3 * MOST];
  const double *x;
  ck_assert_msg(dvi_rotations_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  const int64_t nodes = dvi_rotations_nodes(field, &x, NULL);
  ck_assert_int_eq(nodes, 12);
  for (int64_t a = 0; a < nodes; a++) {
    const double at = (double)a;
    dvi_so3_exp((double[]){sin(at + 1), cos(2 * at), 0.3 * at}, q + 9 * a);
    for (int i = 0; i < 3; i++) v[3 * a + i] = sin(3 * at + i);
  }
  ck_assert_msg(dvi_rotations_system(field, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_system_check(system, 0, q, v, 0, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_invariant_count(system), 1);
  dvi_system_destroy(&system);
  dvi_rotations_destroy(&field);
}
END_TEST

/* tr((I - G) Kd) of equal bends e along a line is (K_1 about its axis) 2 sin^2(e/2) each. */
START_TEST(the_energy_of_a_bent_line_is_that_of_its_bends)
{
  const dvi_axis axis = {.from = 0, .to = 2};
  const int cells = 8;
  dvi_rotations *field = NULL;
  dvi_system *system = NULL;
  double q[9 * MOST], v[3 * MOST] = {0}, L;
  const double *x, *volume;
  const dvi_rotations_terms terms = {.size = sizeof terms,
                                     .axis = &axis,
                                     .axes = 1,
                                     .cells = &cells,
                                     .inertia = J,
                                     .stiffness = K};
  ck_assert_int_eq(dvi_rotations_create(&terms, &field), DVI_OK);
  const int64_t nodes = dvi_rotations_nodes(field, &x, &volume);
  ck_assert_int_eq(nodes, 9);
  ck_assert_double_eq_tol(volume[0] + volume[8], 0.25, 1e-16);
  for (int64_t a = 0; a < nodes; a++) dvi_so3_exp((double[]){0, 1.2 * x[a], 0}, q + 9 * a);
  ck_assert_int_eq(dvi_rotations_system(field, &system), DVI_OK);
  ck_assert_int_eq(dvi_system_lagrangian(system, 0, q, v, &L), DVI_OK);
  const double bend = 1.2 * 0.25, expected = -8 / 0.25 * K[4] * 2 * pow(sin(bend / 2), 2);
  ck_assert_double_eq_tol(L, expected, 1e-13 * fabs(expected));
  dvi_system_destroy(&system);
  dvi_rotations_destroy(&field);
}
END_TEST

static void refuses(dvi_rotations_terms terms, const char *words)
{
  dvi_rotations *field = NULL;
  ck_assert_int_eq(dvi_rotations_create(&terms, &field), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(field);
  check_words(words);
}

START_TEST(what_makes_no_field_is_refused)
{
  static const dvi_axis backward[2] = {{.from = 1, .to = 1}, {.from = 0, .to = 1}},
                        around[2] = {{.from = 0, .to = 1, .periodic = 1}, {.from = 0, .to = 1}};
  static const int few[2] = {2, 2}, none[2] = {0, 3}, all[4] = {1, 1, 0, 0}, one[2] = {1, 3};
  static const double skew[9] = {1, 2, 0, 0, 1, 0, 0, 0, 1};
  dvi_rotations_terms terms = plate();
  terms.size = 1;
  refuses(terms, "terms.size");
  terms = plate(), terms.axis = backward;
  refuses(terms, "axis 0 goes from 1 to 1");
  terms = plate(), terms.axis = around;
  refuses(terms, "axis 0 is periodic, and its end is held");
  terms = plate(), terms.axis = around, terms.cells = few, terms.is_clamped = NULL;
  refuses(terms, "axis 0 has 2 cells; a periodic one needs 3");
  terms = plate(), terms.cells = none;
  refuses(terms, "axis 0 has 0 cells");
  terms = plate(), terms.is_clamped = all, terms.cells = one;
  refuses(terms, "every node is held");
  terms = plate(), terms.held = NULL;
  refuses(terms, "give what it is");
  terms = plate(), terms.held = no_rotation;
  refuses(terms, "is no rotation");
  terms = plate(), terms.inertia = skew;
  refuses(terms, "the inertia is not symmetric");
  terms = plate(), terms.stiffness = NULL;
  refuses(terms, "inertia and stiffness are needed");
}
END_TEST

SUITE(rotations)
{
  tcase_add_test(tests, a_chiral_field_keeps_its_momenta_and_its_energy_error_has_order_2);
  tcase_add_test(tests, lie_galerkin_steps_a_chiral_field_with_order_4);
  tcase_add_test(tests, derivatives_of_a_held_plate_with_a_potential_are_right);
  tcase_add_test(tests, the_energy_of_a_bent_line_is_that_of_its_bends);
  tcase_add_test(tests, what_makes_no_field_is_refused);
}
