#include "plot/thin.h"

#include <math.h>

#include "support/suite.h"

enum { MANY = 2000 };

static double x[MANY], y[MANY];
static bool keep[MANY];

static int thin(int count, double tolerance)
{
  int kept = 0;
  thin_curve(count, x, y, tolerance, keep);
  for (int i = 0; i < count; i++) kept += keep[i];
  return kept;
}

static void draw_wave(void)
{
  for (int i = 0; i < MANY; i++) {
    x[i] = 0.4 * i;
    y[i] = 200 * sin(0.01 * i);
    keep[i] = true;
  }
}

/* How far point i is from the segment between the kept points around it. */
static double away(int i)
{
  int a = i, b = i;
  while (!keep[a]) a--;
  while (!keep[b]) b++;
  if (a == b) return 0;
  const double ux = x[b] - x[a], uy = y[b] - y[a];
  return fabs((x[i] - x[a]) * uy - (y[i] - y[a]) * ux) / hypot(ux, uy);
}

START_TEST(a_straight_line_keeps_its_ends)
{
  for (int i = 0; i < MANY; i++) {
    x[i] = 3.0 * i;
    y[i] = 1.0 - 2.0 * i;
    keep[i] = true;
  }
  ck_assert_int_eq(thin(MANY, 0.1), 2);
  ck_assert(keep[0] && keep[MANY - 1]);
}
END_TEST

/* The cone lets a segment pass each point at no more than the tolerance, as seen from its first
 * end: no more than twice that for the whole. */
START_TEST(no_point_is_farther_from_the_thinned_curve_than_can_be_seen)
{
  draw_wave();
  ck_assert_int_lt(thin(MANY, 0.2), MANY / 5);
  for (int i = 0; i < MANY; i++) ck_assert_double_le(away(i), 0.4);
}
END_TEST

START_TEST(a_line_that_turns_back_keeps_its_turning_points)
{
  for (int i = 0; i < 100; i++) {
    x[i] = 50 - fabs(50.0 - i);
    y[i] = 0;
    keep[i] = true;
  }
  ck_assert_int_le(thin(100, 0.1), 4);
  ck_assert(keep[50]);
}
END_TEST

START_TEST(gaps_stay_gaps)
{
  draw_wave();
  for (int i = 700; i < 800; i++) keep[i] = false;
  thin(MANY, 0.2);
  ck_assert(keep[699] && keep[800]);
  for (int i = 700; i < 800; i++) ck_assert(!keep[i]);
}
END_TEST

SUITE(thin)
{
  tcase_add_test(tests, a_straight_line_keeps_its_ends);
  tcase_add_test(tests, no_point_is_farther_from_the_thinned_curve_than_can_be_seen);
  tcase_add_test(tests, a_line_that_turns_back_keeps_its_turning_points);
  tcase_add_test(tests, gaps_stay_gaps);
}
