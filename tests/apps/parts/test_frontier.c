#include "study/frontier.h"

#include <math.h>

#include "support/suite.h"

enum { COUNT = 5 };

/* cost = error^(-1/4), a method of order 4, in no order. */
static const double error[COUNT] = {1e-4, 1e-12, 1e-8, 1.0, 1e-16};
static const double cost[COUNT] = {1e1, 1e3, 1e2, 1e0, 1e4};

static const double roundoff =
    1e-13; /* some hundred ulp, for a power of a quotient of logarithms */

START_TEST(a_straight_line_in_logarithms_is_met_between_its_points)
{
  for (double asked = 2e-16; asked < 1.0; asked *= 3.0) {
    double least;
    ck_assert_int_eq(frontier_cost(COUNT, error, cost, asked, &least), FRONTIER_BETWEEN);
    ck_assert_double_le(fabs(least * pow(asked, 0.25) - 1.0), roundoff);
  }
}
END_TEST

START_TEST(a_setting_itself_costs_what_was_measured)
{
  for (int i = 0; i < COUNT; i++) {
    double least;
    ck_assert_int_eq(frontier_cost(COUNT, error, cost, error[i], &least), FRONTIER_BETWEEN);
    ck_assert_double_eq(least, cost[i]);
  }
}
END_TEST

START_TEST(only_the_two_neighbours_count)
{
  /* the curve of above between 1e-4 and 1e-8 only */
  const double bent[COUNT] = {1e1, 1e9, 1e2, 1e-3, 1e12};
  double least;
  ck_assert_int_eq(frontier_cost(COUNT, error, bent, 1e-6, &least), FRONTIER_BETWEEN);
  ck_assert_double_le(fabs(least / pow(10.0, 1.5) - 1.0), roundoff);
}
END_TEST

START_TEST(beyond_the_smallest_error_nothing_is_reached)
{
  double least = 1.0;
  ck_assert_int_eq(frontier_cost(COUNT, error, cost, 0.99e-16, &least), FRONTIER_NOT_REACHED);
  ck_assert(isnan(least));
  ck_assert_int_eq(frontier_cost(0, error, cost, 1.0, &least), FRONTIER_NOT_REACHED);
}
END_TEST

START_TEST(above_the_largest_error_the_cheapest_setting_is_a_bound)
{
  double least;
  ck_assert_int_eq(frontier_cost(COUNT, error, cost, 2.0, &least), FRONTIER_AT_MOST);
  ck_assert_double_eq(least, 1.0);
}
END_TEST

START_TEST(a_setting_that_another_one_beats_is_left_out)
{
  /* The second one costs more than the third, which is better, so the line leads from the first to
   * the third. */
  const double errors[] = {1e-2, 1e-3, 1e-6};
  const double costs[] = {1.0, 1e3, 1e2};
  double least;
  ck_assert_int_eq(frontier_cost(3, errors, costs, 1e-4, &least), FRONTIER_BETWEEN);
  ck_assert_double_le(fabs(least / 10.0 - 1.0), roundoff);
  ck_assert_int_eq(frontier_cost(3, errors, costs, 1e-3, &least), FRONTIER_BETWEEN);
  ck_assert_double_le(fabs(least / pow(10.0, 0.5) - 1.0), roundoff);
}
END_TEST

START_TEST(a_roundoff_floor_that_gets_worse_with_cost_is_left_out)
{
  const double errors[] = {1e-8, 1e-13, 3e-13, 9e-13};
  const double costs[] = {1.0, 2.0, 4.0, 8.0};
  double least;
  ck_assert_int_eq(frontier_cost(4, errors, costs, 9e-13, &least), FRONTIER_BETWEEN);
  ck_assert_double_lt(least, 2.0);
  ck_assert_double_gt(least, 1.0);
}
END_TEST

START_TEST(a_setting_that_stands_twice_counts_once)
{
  const double errors[] = {1e-2, 1e-2, 1e-4, 1e-4};
  const double costs[] = {1.0, 1.0, 100.0, 100.0};
  double least;
  ck_assert_int_eq(frontier_cost(4, errors, costs, 1e-2, &least), FRONTIER_BETWEEN);
  ck_assert_double_eq(least, 1.0);
  ck_assert_int_eq(frontier_cost(4, errors, costs, 1e-3, &least), FRONTIER_BETWEEN);
  ck_assert_double_le(fabs(least / 10.0 - 1.0), roundoff);
}
END_TEST

START_TEST(points_without_a_logarithm_are_left_out)
{
  const double errors[] = {(double)NAN, 0.0, 1e-2, HUGE_VAL, 1e-4, -1.0, 1e-9};
  const double costs[] = {1e-9, 1e-9, 1.0, 1e-9, 100.0, 1e-9, 0.0};
  double least;
  ck_assert_int_eq(frontier_cost(7, errors, costs, 1e-3, &least), FRONTIER_BETWEEN);
  ck_assert_double_le(fabs(least / 10.0 - 1.0), roundoff);
  ck_assert_int_eq(frontier_cost(7, errors, costs, 1e-5, &least), FRONTIER_NOT_REACHED);
}
END_TEST

SUITE(frontier)
{
  tcase_add_test(tests, a_straight_line_in_logarithms_is_met_between_its_points);
  tcase_add_test(tests, a_setting_itself_costs_what_was_measured);
  tcase_add_test(tests, only_the_two_neighbours_count);
  tcase_add_test(tests, beyond_the_smallest_error_nothing_is_reached);
  tcase_add_test(tests, above_the_largest_error_the_cheapest_setting_is_a_bound);
  tcase_add_test(tests, a_setting_that_another_one_beats_is_left_out);
  tcase_add_test(tests, a_roundoff_floor_that_gets_worse_with_cost_is_left_out);
  tcase_add_test(tests, a_setting_that_stands_twice_counts_once);
  tcase_add_test(tests, points_without_a_logarithm_are_left_out);
}
