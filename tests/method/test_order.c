/* labels: order */
/* Measured orders are the claimed ones, for every degree and problem. The judge works in quadruple precision. Orders up to 6 are measured at
 * the end of a span, the higher ones by the error of one step. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

START_TEST(gauss_with_as_many_nodes_as_degrees_has_order_2s)
{
  const int s = 1 + _i % MOST_DEGREE;
  check_order(_i / MOST_DEGREE, spec("galerkin:degree=%d,quadrature=gauss,nodes=%d", s, s), 2 * s);
}
END_TEST

/* The double pendulum has no constant mass, which verlet needs. */
START_TEST(compositions_of_verlet_have_their_order)
{
  const int order = 4 + 2 * (_i % 3), index = _i / 3;
  if (index != DOUBLE_PENDULUM) check_order(index, spec("composition:order=%d,base=verlet", order), order);
}
END_TEST

START_TEST(compositions_of_midpoint_have_their_order)
{
  const int order = 4 + 2 * (_i % 3);
  check_order(_i / 3, spec("composition:order=%d,base=midpoint", order), order);
}
END_TEST

START_TEST(the_explicit_and_the_two_point_rules_have_order_2)
{
  static const char *const methods[] = {"verlet", "midpoint", "trapezoidal"};
  check_order(0, methods[_i], 2);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, gauss_with_as_many_nodes_as_degrees_has_order_2s, 0, ORDER_PLACES * MOST_DEGREE);
  tcase_add_loop_test(tests, compositions_of_verlet_have_their_order, 0, ORDER_PLACES * 3);
  tcase_add_loop_test(tests, compositions_of_midpoint_have_their_order, 0, ORDER_PLACES * 3);
  tcase_add_loop_test(tests, the_explicit_and_the_two_point_rules_have_order_2, 0, 3);
  return run_tests("order", tests);
}
