#include "sweep/peak_refinement.h"

#include <math.h>

#include "support/suite.h"

enum { MOST = 400 };

static double x[MOST], y[MOST];
static bool top[MOST], halve[MOST];

START_TEST(a_top_rises_from_the_higher_one_of_two_valleys)
{
  static const double heights[] = {0.0, 1.0, 0.8, 0.9, -1.0, 2.0, 1.5, 1.75, 1.3, 1.35};
  static const bool tops[] = {false, true, false, false, false, true, false, false, false, false};
  const int count = (int)(sizeof heights / sizeof *heights);
  for (int i = 0; i < count; i++) x[i] = i;
  (void)peak_gaps(count, x, heights, 0.5, top, halve);
  for (int i = 0; i < count; i++) ck_assert_int_eq(top[i], tops[i]);
}
END_TEST

START_TEST(of_equal_points_the_first_is_the_top)
{
  static const double heights[] = {0.0, 1.0, 1.0, 1.0, 0.0};
  for (int i = 0; i < 5; i++) x[i] = i;
  ck_assert_int_eq(peak_gaps(5, x, heights, 0.5, top, halve), 2);
  for (int i = 0; i < 5; i++) ck_assert_int_eq(top[i], i == 1);
  ck_assert(halve[0] && halve[1] && !halve[2] && !halve[3]);
}
END_TEST

START_TEST(an_end_of_the_range_may_be_a_top_and_level_ground_has_none)
{
  static const double rising[] = {0.0, 0.1, 0.3, 0.6}, level[] = {0.0, 0.2, 0.1, 0.0};
  for (int i = 0; i < 4; i++) x[i] = i;
  ck_assert_int_eq(peak_gaps(4, x, rising, 0.5, top, halve), 1);
  ck_assert(top[3] && halve[2]);
  ck_assert_int_eq(peak_gaps(4, x, level, 0.5, top, halve), 0);
}
END_TEST

START_TEST(steep_gaps_are_halved_down_to_the_width)
{
  static const double place[] = {0.0, 1.0, 1.5, 3.0}, step[] = {0.0, 0.0, 5.0, 10.0};
  ck_assert_int_eq(peak_gaps(4, place, step, 0.5, top, halve), 1);
  ck_assert(!halve[0] && !halve[1] && halve[2]);
}
END_TEST

/* Two resonances of width 1e-6 with tails of the inverse distance, from 9 points. Each is found to
 * 1e-6, with some hundred points. */
static double tails(double at)
{
  return log10(1.0 / (fabs(at - 0.3123456) + 1e-6) + 1.0 / (fabs(at - 0.7654321) + 1e-6));
}

START_TEST(narrow_peaks_with_tails_are_found)
{
  int count = 9;
  for (int i = 0; i < count; i++) x[i] = i / 8.0;
  for (int marked = 1; marked > 0;) {
    for (int i = 0; i < count; i++) y[i] = tails(x[i]);
    marked = peak_gaps(count, x, y, 1e-6, top, halve);
    ck_assert_int_le(count + marked, MOST);
    for (int i = count - 1, to = count + marked - 1; i > 0; i--) {
      x[to--] = x[i];
      if (halve[i - 1]) x[to--] = 0.5 * (x[i - 1] + x[i]);
    }
    count += marked;
  }
  int found = 0;
  for (int i = 0; i < count; i++) {
    if (!top[i]) continue;
    ck_assert_double_le(fmin(fabs(x[i] - 0.3123456), fabs(x[i] - 0.7654321)), 1e-6);
    found++;
  }
  ck_assert_int_eq(found, 2);
}
END_TEST

SUITE(peak_refinement)
{
  tcase_add_test(tests, a_top_rises_from_the_higher_one_of_two_valleys);
  tcase_add_test(tests, of_equal_points_the_first_is_the_top);
  tcase_add_test(tests, an_end_of_the_range_may_be_a_top_and_level_ground_has_none);
  tcase_add_test(tests, steep_gaps_are_halved_down_to_the_width);
  tcase_add_test(tests, narrow_peaks_with_tails_are_found);
}
