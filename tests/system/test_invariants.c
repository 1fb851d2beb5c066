#include <math.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/systems.h"

static behaviour quiet;

static int translation(const double *q, double *xi, void *user)
{
  (void)q;
  for (int i = 0; i < SITES; i++) xi[i] = 1;
  return *(const int *)user;
}

static int turn(const double *q, double *xi, void *user)
{
  (void)user;
  memset(xi, 0, SITES * sizeof *xi);
  xi[0] = -q[1];
  xi[1] = q[0];
  return 0;
}

static int action(double t, const double *q, const double *p, double *I, void *user)
{
  (void)user;
  *I = t + q[0] * p[0];
  return 0;
}

static int infinite(double t, const double *q, const double *p, double *I, void *user)
{
  (void)t, (void)q, (void)p, (void)user;
  *I = HUGE_VAL;
  return 0;
}

static dvi_system *create_watched_system(const dvi_lagrangian *l, int *answer,
                                         const dvi_invariant *last)
{
  const dvi_potential p = springs(&quiet, BATCH);
  const dvi_symmetry symmetries[] = {{"momentum", translation, answer}, {NULL, turn, NULL}};
  const dvi_invariant invariants[] = {{"action", action, NULL}, *last};
  return make_system(&(dvi_system_terms){.dimension = SITES,
                                         .mass.scalar = l == NULL ? 2 : 0,
                                         .lagrangian = l,
                                         .potentials = &p,
                                         .potential_count = 1,
                                         .symmetries = symmetries,
                                         .symmetry_count = 2,
                                         .invariants = invariants,
                                         .invariant_count = 2});
}

static const dvi_invariant again = {"again", action, NULL};

START_TEST(energy_momenta_and_declared_invariants_come_in_this_order)
{
  int answer = 0;
  dvi_system *s = create_watched_system(NULL, &answer, &again);
  const char *const names[] = {"energy", "momentum", "unnamed", "action", "again"};
  ck_assert_int_eq(dvi_system_invariant_count(s), 5);
  for (int i = 0; i < 5; i++) ck_assert_str_eq(dvi_system_invariant_name(s, i), names[i]);
  ck_assert_ptr_null(dvi_system_invariant_name(s, 5));
  ck_assert_ptr_null(dvi_system_invariant_name(s, -1));
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(the_values_are_those_of_their_definitions)
{
  int answer = 0;
  dvi_system *s = create_watched_system(NULL, &answer, &again);
  const double *q = generic_q, *p = generic_v, t = 0.5;
  const dvi_potential potential = springs(&quiet, ONE_POINT);
  double value[5], energy, momentum = 0;
  potential.value(t, q, &energy, &quiet);
  for (int i = 0; i < SITES; i++) {
    energy += p[i] * p[i] / 4;
    momentum += p[i];
  }
  ck_assert_int_eq(dvi_system_invariants(s, t, q, p, value), DVI_OK);
  /* sums of six terms in another order */
  ck_assert_double_eq_tol(value[0], energy, 1e-14 * energy);
  ck_assert_double_eq_tol(value[1], momentum, 1e-15);
  ck_assert_double_eq_tol(value[2], q[0] * p[1] - q[1] * p[0], 1e-15);
  ck_assert_double_eq(value[3], t + q[0] * p[0]);
  ck_assert_double_eq(value[4], value[3]);
  dvi_system_destroy(&s);
}
END_TEST

/* For the rotors the magnetic term drops out, and E = (T with both v) + q^2 (1+t)/2 + springs. */
START_TEST(the_energy_of_a_general_lagrangian_uses_the_inverse_legendre_map)
{
  int answer = 0;
  const dvi_lagrangian l = rotors(&quiet, BATCH);
  const dvi_potential springs_alone = springs(&quiet, ONE_POINT);
  dvi_system *s = create_watched_system(&l, &answer, &again);
  const double *q = generic_q, *v = generic_v, t = 0.5;
  double p[SITES], value[5], energy;
  springs_alone.value(t, q, &energy, &quiet);
  for (int i = 0; i < SITES; i++)
    energy += (2 + cos(q[i])) * v[i] * v[i] / 2 + (1 + t) * q[i] * q[i] / 2;
  for (int i = 0; i + 1 < SITES; i++) energy += v[i] * v[i + 1] / 4;
  ck_assert_int_eq(dvi_system_momentum(s, t, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_system_invariants(s, t, q, p, value), DVI_OK);
  ck_assert_double_eq_tol(value[0], energy, 1e-14 * energy);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(a_generator_that_fails_is_named)
{
  const int answers[] = {4, -4};
  int answer = answers[_i];
  dvi_system *s = create_watched_system(NULL, &answer, &again);
  double value[5];
  ck_assert_int_eq(dvi_system_invariants(s, 0, generic_q, generic_v, value),
                   _i == 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED);
  check_words("invariant 'momentum': the callback returned");
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(an_invariant_that_is_not_finite_is_named)
{
  int answer = 0;
  dvi_system *s = create_watched_system(NULL, &answer,
                                        &(dvi_invariant){"helicity", infinite, NULL});
  double value[5];
  ck_assert_int_eq(dvi_system_invariants(s, 0, generic_q, generic_v, value), DVI_NOT_FINITE);
  check_words("invariant 'helicity' is inf at t = 0");
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(missing_arguments_are_refused)
{
  int answer = 0;
  dvi_system *s = create_watched_system(NULL, &answer, &again);
  double value[5];
  ck_assert_int_eq(dvi_system_invariants(NULL, 0, generic_q, generic_v, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_invariants(s, 0, NULL, generic_v, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_invariants(s, 0, generic_q, NULL, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_invariants(s, 0, generic_q, generic_v, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_invariants(s, (double)NAN, generic_q, generic_v, value),
                   DVI_NOT_FINITE);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(invariants)
{
  tcase_add_test(tests, energy_momenta_and_declared_invariants_come_in_this_order);
  tcase_add_test(tests, the_values_are_those_of_their_definitions);
  tcase_add_test(tests, the_energy_of_a_general_lagrangian_uses_the_inverse_legendre_map);
  tcase_add_loop_test(tests, a_generator_that_fails_is_named, 0, 2);
  tcase_add_test(tests, an_invariant_that_is_not_finite_is_named);
  tcase_add_test(tests, missing_arguments_are_refused);
}
