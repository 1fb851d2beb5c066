#include <math.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/systems.h"

static behaviour quiet;

/* The rotors' mass is at least 1/2 and at most 7/2, so a relative residual of a few roundings is an
 * error of a few tens of them. */
#define ROUNDING 1e-14

static dvi_system *rotor_system(void)
{
  const dvi_lagrangian l = rotors(&quiet, ONE_POINT);
  const dvi_potential p = springs(&quiet, ONE_POINT);
  return make_system(&(dvi_system_terms){
      .dimension = SITES, .lagrangian = &l, .potentials = &p, .potential_count = 1});
}

START_TEST(a_mass_that_depends_on_q_is_inverted_from_any_guess)
{
  const double guesses[] = {0, 1, -1e6};
  dvi_system *s = rotor_system();
  double p[SITES], v[SITES];
  ck_assert_int_eq(dvi_system_momentum(s, 0.5, generic_q, generic_v, p), DVI_OK);
  for (int i = 0; i < SITES; i++) v[i] = guesses[_i];
  ck_assert_msg(dvi_system_velocity(s, 0.5, generic_q, p, v) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(v[i], generic_v[i], ROUNDING);
  dvi_system_destroy(&s);
}
END_TEST

/* The momentum of a magnetic term does not vanish at v = 0, where v gives no size to measure
 * convergence by. */
START_TEST(a_body_at_rest_is_found_in_spite_of_a_magnetic_momentum)
{
  dvi_system *s = rotor_system();
  double p[SITES], v[SITES] = {0};
  ck_assert_int_eq(dvi_system_momentum(s, 0.5, generic_q, v, p), DVI_OK);
  ck_assert(fabs(p[1]) > 0.1);
  memcpy(v, generic_v, sizeof v);
  ck_assert_msg(dvi_system_velocity(s, 0.5, generic_q, p, v) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(v[i], 0, ROUNDING);
  dvi_system_destroy(&s);
}
END_TEST

/* Momenta a few roundings beside that of rest have velocities that are all roundoff. */
START_TEST(velocities_at_the_roundoff_of_the_momentum_are_found)
{
  dvi_system *s = rotor_system();
  for (int k = 0; k < 1000; k++) {
    double p[SITES], q[SITES], v[SITES] = {0};
    for (int i = 0; i < SITES; i++) q[i] = sin(1 + i + SITES * k);
    ck_assert_int_eq(dvi_system_momentum(s, 0.5, q, v, p), DVI_OK);
    for (int i = 0; i < SITES; i++) p[i] += (i * k % 5 - 2) * 1e-16;
    memcpy(v, generic_v, sizeof v);
    ck_assert_msg(dvi_system_velocity(s, 0.5, q, p, v) == DVI_OK, "%d: %s", k, dvi_last_error());
    for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(v[i], 0, ROUNDING);
  }
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(constant_masses_are_inverted_in_every_form)
{
  const double diagonal[SITES] = {1, 2, 3, 4, 5, -6};
  const dvi_mass masses[] = {
      {.scalar = 3}, {.diagonal = diagonal}, {.values = tridiagonal_mass, .pattern = tridiagonal}};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES, .mass = masses[_i]});
  double p[SITES], v[SITES] = {(double)NAN}; /* the guess is not read */
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, generic_v, p), DVI_OK);
  for (int i = 0; i < SITES; i++) {
    const double beside = (i > 0 ? generic_v[i - 1] : 0) + (i + 1 < SITES ? generic_v[i + 1] : 0);
    const double expected[] = {3 * generic_v[i], diagonal[i] * generic_v[i],
                               (2 + i) * generic_v[i] - 0.5 * beside};
    ck_assert_double_eq_tol(p[i], expected[_i], ROUNDING);
  }
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, p, v), DVI_OK);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(v[i], generic_v[i], ROUNDING);
  dvi_system_destroy(&s);
}
END_TEST

/* L = (v0 - v1)^2/2 is degenerate. */
static int difference_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  *L = (v[0] - v[1]) * (v[0] - v[1]) / 2;
  return 0;
}

static int difference_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                               void *user)
{
  (void)t, (void)q, (void)user;
  L_q[0] = L_q[1] = 0;
  L_v[0] = v[0] - v[1];
  L_v[1] = -L_v[0];
  return 0;
}

static int difference_hessian(double t, const double *q, const double *v, double *L_qq,
                              double *L_qv, double *L_vv, void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  memset(L_qq, 0, 4 * sizeof *L_qq);
  memset(L_qv, 0, 4 * sizeof *L_qv);
  L_vv[0] = L_vv[3] = 1;
  L_vv[1] = L_vv[2] = -1;
  return 0;
}

START_TEST(a_degenerate_lagrangian_has_a_momentum_but_no_velocity)
{
  const dvi_lagrangian l = {
      .value = difference_value, .gradient = difference_gradient, .hessian = difference_hessian};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 2, .lagrangian = &l});
  double p[2], v[2] = {3, 4};
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, v, p), DVI_OK);
  ck_assert_double_eq(p[0], -1);
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, p, v), DVI_SINGULAR);
  check_words("the Lagrangian is degenerate at t = 0: d2L/dv2 cannot be inverted");
  ck_assert(v[0] == 3 && v[1] == 4);
  dvi_system_destroy(&s);
}
END_TEST

/* With L = sqrt(1 + v^2) p = v / sqrt(1 + v^2) never reaches 1. */
static int bounded_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  *L = sqrt(1 + v[0] * v[0]);
  return 0;
}

static int bounded_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  (void)t, (void)q, (void)user;
  L_q[0] = 0;
  L_v[0] = v[0] / sqrt(1 + v[0] * v[0]);
  return 0;
}

START_TEST(a_momentum_that_no_velocity_has_is_reported_and_the_guess_stays)
{
  const dvi_lagrangian l = {.value = bounded_value, .gradient = bounded_gradient};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 1, .lagrangian = &l});
  double p = 2, v = 0.1;
  /* v runs off to where L_vv vanishes */
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, &p, &v), DVI_NOT_CONVERGED);
  ck_assert_double_eq(v, 0.1);
  p = 0.6;
  ck_assert_msg(dvi_system_velocity(s, 0, generic_q, &p, &v) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(v, 0.75, 1e-14);
  dvi_system_destroy(&s);
}
END_TEST

/* With L = v^4/4 - v^2 + 2 v and p = 0 Newton's method goes from v = 0 to 1 and back again, for
 * ever. */
static int cycling_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  *L = v[0] * v[0] * v[0] * v[0] / 4 - v[0] * v[0] + 2 * v[0];
  return 0;
}

static int cycling_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  (void)t, (void)q, (void)user;
  L_q[0] = 0;
  L_v[0] = v[0] * v[0] * v[0] - 2 * v[0] + 2;
  return 0;
}

static int cycling_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                           double *L_vv, void *user)
{
  (void)t, (void)q, (void)user;
  L_qq[0] = L_qv[0] = 0;
  L_vv[0] = 3 * v[0] * v[0] - 2;
  return 0;
}

START_TEST(a_guess_from_which_newton_does_not_settle_is_reported)
{
  const dvi_lagrangian l = {
      .value = cycling_value, .gradient = cycling_gradient, .hessian = cycling_hessian};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 1, .lagrangian = &l});
  double p = 0, v = 0;
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, &p, &v), DVI_NOT_CONVERGED);
  ck_assert_double_eq(v, 0);
  check_words("Newton's method did not settle");
  v = -2;
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, &p, &v), DVI_OK);
  ck_assert_double_eq_tol(v * v * v - 2 * v + 2, 0, 1e-14);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(a_failing_callback_keeps_its_status_and_the_guess)
{
  dvi_system *s = rotor_system();
  double p[SITES] = {1}, v[SITES] = {1, 2, 3, 4, 5, 6};
  quiet.answer = 7;
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, p, v), DVI_CALLBACK_RETRY);
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, v, p), DVI_CALLBACK_RETRY);
  quiet.answer = 0;
  for (int i = 0; i < SITES; i++) ck_assert_double_eq(v[i], 1 + i);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(results_that_overflow_are_not_finite)
{
  const double heavy[2] = {1e200, 1}, light[2] = {1e-200, 1}, large[2] = {1e200, 1};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 2, .mass.diagonal = heavy});
  double out[2] = {5, 5};
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, large, out), DVI_NOT_FINITE);
  dvi_system_destroy(&s);
  s = make_system(&(dvi_system_terms){.dimension = 2, .mass.diagonal = light});
  out[0] = out[1] = 5;
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, large, out), DVI_NOT_FINITE);
  ck_assert(out[0] == 5 && out[1] == 5);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(missing_and_not_finite_arguments_are_refused)
{
  const double bad[SITES] = {0, 0, (double)NAN};
  dvi_system *s = rotor_system();
  double v[SITES] = {0}, L = 3;
  ck_assert_int_eq(dvi_system_velocity(NULL, 0, generic_q, generic_v, v), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, NULL, v), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_momentum(s, 0, generic_q, generic_v, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_lagrangian(s, 0, NULL, generic_v, &L), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_lagrangian(s, HUGE_VAL, generic_q, generic_v, &L), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_system_lagrangian(s, 0, bad, generic_v, &L), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, bad, v), DVI_NOT_FINITE);
  v[3] = HUGE_VAL;
  ck_assert_int_eq(dvi_system_velocity(s, 0, generic_q, generic_v, v), DVI_NOT_FINITE);
  ck_assert_double_eq(L, 3);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(legendre)
{
  tcase_add_loop_test(tests, a_mass_that_depends_on_q_is_inverted_from_any_guess, 0, 3);
  tcase_add_test(tests, a_body_at_rest_is_found_in_spite_of_a_magnetic_momentum);
  tcase_add_test(tests, velocities_at_the_roundoff_of_the_momentum_are_found);
  tcase_add_loop_test(tests, constant_masses_are_inverted_in_every_form, 0, 3);
  tcase_add_test(tests, a_degenerate_lagrangian_has_a_momentum_but_no_velocity);
  tcase_add_test(tests, a_momentum_that_no_velocity_has_is_reported_and_the_guess_stays);
  tcase_add_test(tests, a_guess_from_which_newton_does_not_settle_is_reported);
  tcase_add_test(tests, a_failing_callback_keeps_its_status_and_the_guess);
  tcase_add_test(tests, results_that_overflow_are_not_finite);
  tcase_add_test(tests, missing_and_not_finite_arguments_are_refused);
}
