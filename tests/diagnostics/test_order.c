#include <math.h>

#include <dvi/diagnostics.h>

#include "support/suite.h"

static void halve(int count, double *h)
{
  h[0] = 0.5;
  for (int i = 1; i < count; i++) h[i] = h[i - 1] / 2;
}

START_TEST(a_power_law_gives_its_exponent)
{
  double h[6], error[6];
  dvi_order_fit fit;
  halve(6, h);
  for (int order = 1; order <= 16; order++) {
    for (int i = 0; i < 6; i++) error[i] = 3 * pow(h[i], order);
    ck_assert_int_eq(dvi_order(6, h, error, 0, 0, &fit), DVI_OK);
    /* logarithms of numbers up to 1e-29, 70 ulp over a span of 3.5 */
    ck_assert_double_eq_tol(fit.slope, order, 1e-13);
    ck_assert_int_eq(fit.first, 0);
    ck_assert_int_eq(fit.last, 5);
  }
}
END_TEST

START_TEST(the_floor_and_the_ceiling_are_left_out)
{
  double h[8], error[8];
  dvi_order_fit fit;
  halve(8, h);
  for (int i = 0; i < 8; i++) error[i] = fmax(pow(h[i], 4), 1e-7);
  error[0] = 10;
  ck_assert_int_eq(dvi_order(8, h, error, 1.5e-7, 1, &fit), DVI_OK);
  ck_assert_double_eq_tol(fit.slope, 4, 1e-12);
  ck_assert_int_eq(fit.first, 1);
  ck_assert_int_eq(fit.last, 4); /* (1/2)^(4*6) is 6e-8 */
}
END_TEST

START_TEST(an_error_equal_to_the_floor_is_left_out)
{
  const double h[] = {0.4, 0.2, 0.1}, error[] = {1e-2, 1e-3, 1e-4};
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(3, h, error, 1e-4, 0, &fit), DVI_OK);
  ck_assert_int_eq(fit.last, 1);
}
END_TEST

START_TEST(the_longest_window_is_taken_and_the_last_of_equal_ones)
{
  const double h[] = {0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1}, nan = (double)NAN;
  const double longest[] = {1, 2, nan, 3, 4, 5, 0}, equal[] = {1, 2, 0, 3, 4, (double)INFINITY, 5};
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(7, h, longest, 0, 0, &fit), DVI_OK);
  ck_assert(fit.first == 3 && fit.last == 5);
  ck_assert_int_eq(dvi_order(7, h, equal, 0, 0, &fit), DVI_OK);
  ck_assert(fit.first == 3 && fit.last == 4);
}
END_TEST

START_TEST(no_window_of_two_errors_is_reported)
{
  const double h[] = {0.4, 0.2, 0.1}, error[] = {1e-2, 1e-9, 1e-2};
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(3, h, error, 1e-6, 0, &fit), DVI_BAD_SIZE);
  ck_assert(isnan(fit.slope) && fit.first == -1 && fit.last == -1);
  ck_assert_int_eq(dvi_order(0, h, error, 0, 0, &fit), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_order(1, h, error, 0, 0, &fit), DVI_BAD_SIZE);
}
END_TEST

START_TEST(steps_that_do_not_descend_and_missing_arrays_are_refused)
{
  const double rising[] = {0.1, 0.2}, equal[] = {0.1, 0.1}, negative[] = {0.1, -0.1},
               error[] = {1e-2, 1e-3};
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(2, rising, error, 0, 0, &fit), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_order(2, equal, error, 0, 0, &fit), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_order(2, negative, error, 0, 0, &fit), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_order(2, NULL, error, 0, 0, &fit), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_order(2, rising, NULL, 0, 0, &fit), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_order(2, rising, error, 0, 0, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(order)
{
  tcase_add_test(tests, a_power_law_gives_its_exponent);
  tcase_add_test(tests, the_floor_and_the_ceiling_are_left_out);
  tcase_add_test(tests, an_error_equal_to_the_floor_is_left_out);
  tcase_add_test(tests, the_longest_window_is_taken_and_the_last_of_equal_ones);
  tcase_add_test(tests, no_window_of_two_errors_is_reported);
  tcase_add_test(tests, steps_that_do_not_descend_and_missing_arrays_are_refused);
}
