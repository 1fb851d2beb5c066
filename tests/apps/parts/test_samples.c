#include "study/samples.h"

#include <math.h>

#include "support/suite.h"

static const double roundoff = 1e-13; /* some hundred ulp: sums of a few logarithms */

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
  tcase_add_test(tests, the_exponent_of_a_power_is_found);
  tcase_add_test(tests, points_without_a_logarithm_do_not_count_for_an_exponent);
  tcase_add_test(tests, one_size_tells_no_exponent);
}
