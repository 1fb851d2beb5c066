#include "study/samples.h"

#include <math.h>

#include "support/suite.h"

static const double roundoff = 1e-13; /* some hundred ulp: sums of a few logarithms */

START_TEST(median_and_quartiles_of_an_odd_number)
{
  double sample[] = {5, 1, 4, 2, 3};
  const spread s = samples_spread(5, sample);
  ck_assert_double_eq(s.lower, 2);
  ck_assert_double_eq(s.median, 3);
  ck_assert_double_eq(s.upper, 4);
}
END_TEST

START_TEST(between_two_measurements_they_are_interpolated)
{
  double sample[] = {40, 10, 30, 20};
  const spread s = samples_spread(4, sample);
  ck_assert_double_eq(s.least, 10);
  ck_assert_double_eq(s.lower, 17.5);
  ck_assert_double_eq(s.median, 25);
  ck_assert_double_eq(s.upper, 32.5);
}
END_TEST

START_TEST(one_measurement_is_all_of_them)
{
  double sample[] = {7};
  const spread s = samples_spread(1, sample);
  ck_assert_double_eq(s.lower, 7);
  ck_assert_double_eq(s.median, 7);
  ck_assert_double_eq(s.upper, 7);
}
END_TEST

START_TEST(an_outlier_moves_neither_median_nor_quartiles)
{
  double sample[] = {1, 2, 3, 4, 1e9};
  const spread s = samples_spread(5, sample);
  ck_assert_double_eq(s.median, 3);
  ck_assert_double_eq(s.upper, 4);
}
END_TEST

START_TEST(the_exponent_of_a_power_is_found)
{
  const double x[] = {100, 1000, 10000, 7};
  double y[4];
  for (int power = -2; power <= 3; power++) {
    for (int i = 0; i < 4; i++) y[i] = 0.3 * pow(x[i], 0.5 * power);
    ck_assert_double_le(fabs(samples_power(4, x, y) - 0.5 * power), roundoff);
  }
}
END_TEST

START_TEST(points_without_a_logarithm_do_not_count_for_an_exponent)
{
  const double x[] = {10, 0, 100, -3, 1000};
  const double y[] = {100, 5, 10000, 6, (double)NAN};
  ck_assert_double_le(fabs(samples_power(5, x, y) - 2.0), roundoff);
}
END_TEST

START_TEST(one_size_tells_no_exponent)
{
  const double x[] = {10, 10, 10};
  const double y[] = {1, 2, 3};
  ck_assert(isnan(samples_power(3, x, y)));
  ck_assert(isnan(samples_power(1, x, y)));
  ck_assert(isnan(samples_power(0, x, y)));
}
END_TEST

SUITE(samples)
{
  tcase_add_test(tests, median_and_quartiles_of_an_odd_number);
  tcase_add_test(tests, between_two_measurements_they_are_interpolated);
  tcase_add_test(tests, one_measurement_is_all_of_them);
  tcase_add_test(tests, an_outlier_moves_neither_median_nor_quartiles);
  tcase_add_test(tests, the_exponent_of_a_power_is_found);
  tcase_add_test(tests, points_without_a_logarithm_do_not_count_for_an_exponent);
  tcase_add_test(tests, one_size_tells_no_exponent);
}
