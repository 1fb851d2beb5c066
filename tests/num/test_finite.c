#include <float.h>
#include <math.h>

#include "num/finite.h"
#include "support/suite.h"

START_TEST(finite_numbers_pass_however_large_or_small)
{
  const double x[] = {0, -0.0, DBL_MAX, -DBL_MAX, DBL_TRUE_MIN, -DBL_MIN, 1};
  ck_assert_int_eq(dvi__first_not_finite(sizeof x / sizeof *x, x), -1);
  ck_assert_int_eq(dvi__first_not_finite(0, x), -1);
}
END_TEST

START_TEST(the_first_of_several_is_named)
{
  const double bad[] = {(double)NAN, -(double)NAN, HUGE_VAL, -HUGE_VAL};
  double x[9] = {0};
  x[8] = (double)NAN;
  for (int at = 8; at >= 0; at--) {
    x[at] = bad[at % 4];
    ck_assert_int_eq(dvi__first_not_finite(9, x), at);
  }
}
END_TEST

START_TEST(numbers_behind_the_count_do_not_matter)
{
  const double x[] = {1, 2, (double)NAN};
  ck_assert_int_eq(dvi__first_not_finite(2, x), -1);
}
END_TEST

SUITE(finite)
{
  tcase_add_test(tests, finite_numbers_pass_however_large_or_small);
  tcase_add_test(tests, the_first_of_several_is_named);
  tcase_add_test(tests, numbers_behind_the_count_do_not_matter);
}
