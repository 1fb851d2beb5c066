/* Digits from three step sizes are never more than the right ones. */
#include "study/trust.h"

#include <math.h>

#include "support/suite.h"

/* y(h) = 1 + c h^order at h = 1, 1/2, 1/4. */
static double level(double c, int order, int k)
{
  return 1.0 + c * ldexp(1.0, -order * k);
}

START_TEST(an_error_that_follows_its_power_is_found)
{
  static const double c = 1e-3;
  for (int order = 1; order <= 12; order++) {
    const double first = level(c, order, 0), second = level(c, order, 1),
                 third = level(c, order, 2);
    const double ratio = trust_ratio(fabs(first - second), fabs(second - third));
    ck_assert_double_eq_tol(ratio, ldexp(1.0, -order), 1e-9);
    /* an order of 1 lies at the border, and either estimate is safe */
    ck_assert(trust_falls(ratio) || order == 1);
    ck_assert_double_ge(trust_error(first, second, third, ratio), c * (1.0 - 1e-9));
    ck_assert_double_le(trust_error(first, second, third, ratio), 4.0 * c);
  }
}
END_TEST

/* Errors of roundoff put each level off by any amount up to `off`. */
START_TEST(errors_that_do_not_fall_are_not_made_small)
{
  static const double off = 1e-12;
  static const double signs[][TRUST_LEVELS] = {
      {1, -1, 1}, {1, -1, -1}, {1, 0.5, 0}, {-1, 0, 0.9}, {0.5, -1, 0.7}};
  for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
    const double first = off * signs[k][0], second = off * signs[k][1], third = off * signs[k][2];
    const double ratio = trust_ratio(fabs(first - second), fabs(second - third));
    ck_assert_double_ge(trust_error(first, second, third, ratio), fabs(first));
  }
}
END_TEST

START_TEST(digits_are_whole_and_within_their_range)
{
  ck_assert_int_eq(trust_digits(0.99e-6, 1.0), 6);
  ck_assert_int_eq(trust_digits(1.01e-6, 1.0), 5);
  ck_assert_int_eq(trust_digits(1e-3, 100.0), 5);
  ck_assert_int_eq(trust_digits(2.0, 1.0), 0);
  ck_assert_int_eq(trust_digits(0.0, 1.0), TRUST_DIGITS_MOST);
  ck_assert_int_eq(trust_digits(0.0, 0.0), TRUST_DIGITS_MOST);
  ck_assert_int_eq(trust_digits(1e-30, 1.0), TRUST_DIGITS_MOST);
  ck_assert_int_eq(trust_digits(1e-30, 0.0), 0);
  ck_assert_int_eq(trust_digits((double)NAN, 1.0), 0);
}
END_TEST

START_TEST(what_roundings_leave_of_zero_has_the_size_of_its_kind)
{
  ck_assert_double_eq(trust_size(1e-16, 2.0), 2.0);
  ck_assert_double_eq(trust_size(1e-9, 2.0), 1e-9);
  ck_assert_double_eq(trust_size(0.0, 0.0), 0.0);
}
END_TEST

START_TEST(momenta_of_a_system_at_rest_have_the_size_of_those_that_would_move_it)
{
  ck_assert_double_eq(trust_momentum(3.0, 2.0, 1e-6), 3.0);
  ck_assert_double_eq_tol(trust_momentum(3e-15, 2.0, 1e-15), 6.0, 1e-12);
  ck_assert_double_lt(trust_momentum(3e-15, 2.0, 0.0), 100.0);
  ck_assert_double_eq(trust_momentum(0.0, 2.0, 0.0), 0.0);
  ck_assert_double_eq(trust_momentum(3.0, 0.0, 0.0), 3.0);
}
END_TEST

SUITE(trust)
{
  tcase_add_test(tests, an_error_that_follows_its_power_is_found);
  tcase_add_test(tests, errors_that_do_not_fall_are_not_made_small);
  tcase_add_test(tests, digits_are_whole_and_within_their_range);
  tcase_add_test(tests, what_roundings_leave_of_zero_has_the_size_of_its_kind);
  tcase_add_test(tests, momenta_of_a_system_at_rest_have_the_size_of_those_that_would_move_it);
}
