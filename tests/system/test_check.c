#include <math.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/systems.h"

/* Rotors, springs and wells, each with its own behaviour. */
typedef struct scene {
  behaviour rotors, springs, wells;
  dvi_lagrangian lagrangian;
  dvi_potential potentials[2];
  dvi_derivative_check found;
} scene;

static void build_scene(scene *c)
{
  *c = (scene){.rotors = {0}};
  c->lagrangian = rotors(&c->rotors, ONE_POINT);
  c->potentials[0] = springs(&c->springs, BATCH);
  c->potentials[1] = wells(&c->wells, ONE_POINT);
}

static dvi_status check_at(scene *c, const double *q, const double *v)
{
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES,
                                                  .lagrangian = &c->lagrangian,
                                                  .potentials = c->potentials,
                                                  .potential_count = 2});
  const dvi_status status = dvi_system_check(s, 0.3, q, v, 0, &c->found);
  dvi_system_destroy(&s);
  return status;
}

static dvi_status check_scene(scene *c)
{
  return check_at(c, generic_q, generic_v);
}

static void check_contains(const char *text, const char *words)
{
  ck_assert_msg(strstr(text, words) != NULL, "\"%s\" is not in \"%s\"", words, text);
}

START_TEST(right_derivatives_pass)
{
  scene c;
  build_scene(&c);
  ck_assert_msg(check_scene(&c) == DVI_OK, "%s", dvi_last_error());
  /* 6th order differences over lengths of 1 lose about three digits. */
  ck_assert_double_le(c.found.gradient_error, 1e-11);
  ck_assert_double_le(c.found.hessian_error, 1e-11);
  ck_assert_double_le(c.found.outside, 1e-11);
  ck_assert_str_eq(c.found.where, "");
}
END_TEST

START_TEST(a_wrong_gradient_entry_of_a_potential_is_named_with_both_numbers)
{
  scene c;
  build_scene(&c);
  c.springs.gradient_lie = 1e-4;
  c.springs.at = 3;
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "system check: potential 'springs': dV/dq (3) is ");
  check_contains(dvi_last_error(), "from the callback, ");
  ck_assert_str_eq(c.found.where, "potential 'springs': dV/dq (3) is wrong");
  double V_q[SITES];
  c.springs.gradient_lie = 0;
  const double t = 0.3;
  c.potentials[0].gradient_batch(1, &t, generic_q, V_q, &c.springs);
  double largest = 0;
  for (int i = 0; i < SITES; i++) largest = fmax(largest, fabs(V_q[i]));
  /* the lie, relative to the largest entry */
  ck_assert_double_eq_tol(c.found.gradient_error, 1e-4 / largest, 1e-3 * 1e-4);
}
END_TEST

START_TEST(a_wrong_gradient_entry_of_the_lagrangian_is_named)
{
  const char *const words[] = {"Lagrangian: dL/dq (2) is ", "Lagrangian: dL/dv (2) is "};
  scene c;
  build_scene(&c);
  c.rotors = (behaviour){.gradient_lie = -1e-3, .at = 2, .block = _i};
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), words[_i]);
}
END_TEST

START_TEST(a_wrong_hessian_entry_of_a_potential_is_named)
{
  scene c;
  build_scene(&c);
  c.springs.hessian_lie = 1e-3;
  c.springs.at = 6; /* row 2, column 2 */
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "system check: potential 'springs': d2V/dq2 (2,2) is ");
  ck_assert_int_eq(c.found.row, 2);
  ck_assert_int_eq(c.found.column, 2);
  ck_assert_double_gt(c.found.hessian_error, 1e-5);
  ck_assert_double_le(c.found.gradient_error, 1e-11);
}
END_TEST

START_TEST(a_wrong_hessian_entry_of_each_block_of_the_lagrangian_is_named)
{
  const char *const words[] = {"Lagrangian: d2L/dq2 (5,5) is ", "Lagrangian: d2L/dqdv (2,3) is ",
                               "Lagrangian: d2L/dv2 (1,2) is "};
  scene c;
  build_scene(&c);
  c.rotors = (behaviour){.hessian_lie = 1e-3, .at = 5, .block = _i};
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), words[_i]);
}
END_TEST

START_TEST(an_entry_that_a_pattern_misses_is_named)
{
  /* tridiagonal without (3,2) and (2,3) */
  const int start[] = {0, 2, 5, 7, 9, 12, 14}, row[] = {0, 1, 0, 1, 2, 1, 2, 3, 4, 3, 4, 5, 4, 5};
  scene c;
  build_scene(&c);
  c.potentials[0].qq = (dvi_pattern){start, row};
  c.potentials[0].hessian_batch = NULL; /* a missing callback is not checked, but its pattern is */
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(
      dvi_last_error(),
      "potential 'springs': d2V/dq2 (3,2) is not in the pattern, but differences give -");
  ck_assert_str_eq(c.found.where, "potential 'springs': d2V/dq2 (3,2) is not in the pattern");
  ck_assert(c.found.row == 3 && c.found.column == 2);
  ck_assert_double_gt(c.found.outside, 0.01);
}
END_TEST

START_TEST(an_entry_that_a_pattern_of_the_lagrangian_misses_is_named)
{
  static const int none[SITES + 1] = {0};
  const char *const words[] = {"Lagrangian: d2L/dq2 (", "Lagrangian: d2L/dqdv (",
                               "Lagrangian: d2L/dv2 ("};
  scene c;
  build_scene(&c);
  dvi_pattern *const patterns[] = {&c.lagrangian.qq, &c.lagrangian.qv, &c.lagrangian.vv};
  *patterns[_i] = (dvi_pattern){none, NULL};
  c.lagrangian.hessian = NULL;
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), words[_i]);
  check_contains(dvi_last_error(), "is not in the pattern");
}
END_TEST

START_TEST(missing_callbacks_are_not_checked)
{
  scene c;
  build_scene(&c);
  c.springs.gradient_lie = c.springs.hessian_lie = 1;
  c.potentials[0].gradient_batch = NULL;
  c.potentials[0].hessian_batch = NULL;
  ck_assert_msg(check_scene(&c) == DVI_OK, "%s", dvi_last_error());
}
END_TEST

START_TEST(a_hessian_without_a_gradient_is_checked_against_the_values)
{
  scene c;
  build_scene(&c);
  c.potentials[0].gradient_batch = NULL;
  ck_assert_msg(check_scene(&c) == DVI_OK, "%s", dvi_last_error());
  c.springs.hessian_lie = 1e-3;
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "potential 'springs': d2V/dq2 (0,0) is ");
}
END_TEST

START_TEST(a_wrong_gradient_is_blamed_before_the_hessian_that_disagrees_with_it)
{
  scene c;
  build_scene(&c);
  c.wells.gradient_lie = 1e-3;
  c.springs.hessian_lie = 1;
  ck_assert_int_eq(check_scene(&c), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "potential 'wells': dV/dq (0)");
}
END_TEST

/* At the origin nearly all derivatives vanish, and differences give roundoff, which is no reason to
 * complain. */
START_TEST(roundoff_in_vanishing_derivatives_is_no_error)
{
  const double zero[SITES] = {0}, tiny[SITES] = {1e-9, -2e-9, 3e-9, 1e-20, 0, 1e-9};
  scene c;
  build_scene(&c);
  ck_assert_msg(check_at(&c, zero, zero) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(check_at(&c, tiny, tiny) == DVI_OK, "%s", dvi_last_error());
}
END_TEST

/* The constant is much larger than the varying part. Its roundoff, over the step, is larger than
 * 1e-6 of the gradient. */
START_TEST(roundoff_of_a_large_constant_is_no_error)
{
  scene c;
  build_scene(&c);
  c.springs.value_lie = 1e9;
  ck_assert_msg(check_scene(&c) == DVI_OK, "%s", dvi_last_error());
}
END_TEST

/* The spring q_0^2/2 as what is left of large terms, as a Fourier field's potential beside its
 * matrix is. */
static int difference_value(double t, const double *q, double *V, void *user)
{
  volatile double large = 0.5 * q[0] * q[0] + 1e8;
  (void)t, (void)user;
  *V = large - 1e8;
  return 0;
}

static int difference_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  memset(V_q, 0, SITES * sizeof *V_q);
  V_q[0] = q[0] * (1 + *(const double *)user);
  return 0;
}

static dvi_status check_difference(double lie)
{
  static const int start[SITES + 1] = {0, 1, 1, 1, 1, 1, 1}, row[] = {0};
  const dvi_potential spring = {.value = difference_value,
                                .gradient = difference_gradient,
                                .qq = {.start = start, .row = row},
                                .user = &lie};
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &spring, .potential_count = 1});
  const double q[SITES] = {0.01};
  const dvi_status status = dvi_system_check(s, 0, q, q, 0, NULL);
  dvi_system_destroy(&s);
  return status;
}

START_TEST(roundoff_of_terms_that_cancel_in_a_value_is_no_error)
{
  ck_assert_msg(check_difference(0) == DVI_OK, "%s", dvi_last_error());
  /* roundoff of 1e-8 over a step of 1e-4 is 1e-4, and the gradient is 1e-2 */
  ck_assert_int_eq(check_difference(0.5), DVI_BAD_ARGUMENT);
}
END_TEST

/* Gravity is a linear potential with an empty pattern, and a constant whose roundoff shows in
 * second differences of the value. */
static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 9.81 * q[1] + 1e3;
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, SITES * sizeof *V_q);
  V_q[1] = 9.81;
  return 0;
}

START_TEST(an_empty_pattern_is_right_for_a_linear_potential)
{
  static const int none[SITES + 1] = {0};
  for (int given = 0; given < 2; given++) {
    const dvi_potential p = {
        .value = weight_value, .gradient = given ? weight_gradient : NULL, .qq = {none, NULL}};
    dvi_system *s = make_system(&(dvi_system_terms){
        .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
    ck_assert_msg(dvi_system_check(s, 0, generic_q, generic_v, 0, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    dvi_system_destroy(&s);
  }
}
END_TEST

START_TEST(a_callback_that_fails_ends_the_check_with_its_status)
{
  scene c;
  build_scene(&c);
  c.wells.answer = 1;
  ck_assert_int_eq(check_scene(&c), DVI_CALLBACK_RETRY);
  c.wells.answer = -1;
  ck_assert_int_eq(check_scene(&c), DVI_CALLBACK_FAILED);
  c.wells.answer = 0;
  c.wells.gradient_lie = (double)NAN;
  ck_assert_int_eq(check_scene(&c), DVI_NOT_FINITE);
}
END_TEST

START_TEST(the_tolerance_decides)
{
  scene c;
  build_scene(&c);
  c.springs.gradient_lie = 1e-4;
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES,
                                                  .lagrangian = &c.lagrangian,
                                                  .potentials = c.potentials,
                                                  .potential_count = 2});
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, generic_v, 1e-3, NULL), DVI_OK);
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, generic_v, 1e-9, NULL), DVI_BAD_ARGUMENT);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(bad_arguments_are_refused)
{
  const double bad[SITES] = {0, HUGE_VAL};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES, .mass.scalar = 1});
  ck_assert_int_eq(dvi_system_check(NULL, 0, generic_q, generic_v, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_check(s, 0, NULL, generic_v, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, NULL, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, generic_v, -1, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, generic_v, (double)NAN, NULL),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_system_check(s, (double)NAN, generic_q, generic_v, 0, NULL), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_system_check(s, 0, bad, generic_v, 0, NULL), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_system_check(s, 0, generic_q, generic_v, 0, NULL), DVI_OK);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(check)
{
  tcase_add_test(tests, right_derivatives_pass);
  tcase_add_test(tests, a_wrong_gradient_entry_of_a_potential_is_named_with_both_numbers);
  tcase_add_loop_test(tests, a_wrong_gradient_entry_of_the_lagrangian_is_named, 0, 2);
  tcase_add_test(tests, a_wrong_hessian_entry_of_a_potential_is_named);
  tcase_add_loop_test(tests, a_wrong_hessian_entry_of_each_block_of_the_lagrangian_is_named, 0, 3);
  tcase_add_test(tests, an_entry_that_a_pattern_misses_is_named);
  tcase_add_loop_test(tests, an_entry_that_a_pattern_of_the_lagrangian_misses_is_named, 0, 3);
  tcase_add_test(tests, missing_callbacks_are_not_checked);
  tcase_add_test(tests, a_hessian_without_a_gradient_is_checked_against_the_values);
  tcase_add_test(tests, a_wrong_gradient_is_blamed_before_the_hessian_that_disagrees_with_it);
  tcase_add_test(tests, roundoff_in_vanishing_derivatives_is_no_error);
  tcase_add_test(tests, roundoff_of_a_large_constant_is_no_error);
  tcase_add_test(tests, roundoff_of_terms_that_cancel_in_a_value_is_no_error);
  tcase_add_test(tests, an_empty_pattern_is_right_for_a_linear_potential);
  tcase_add_test(tests, a_callback_that_fails_ends_the_check_with_its_status);
  tcase_add_test(tests, the_tolerance_decides);
  tcase_add_test(tests, bad_arguments_are_refused);
}
