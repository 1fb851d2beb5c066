/* labels: order */
/* The orders of compositions and of what they are made of, measured as in support/order.c. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

/* The double pendulum has no constant mass, which verlet needs. */
START_TEST(compositions_of_verlet_have_their_order)
{
  const int order = 4 + 2 * (_i % 3), index = _i / 3;
  if (index != DOUBLE_PENDULUM)
    check_order(index, method_spec("composition:order=%d,base=verlet", order), order);
}
END_TEST

START_TEST(compositions_of_midpoint_have_their_order)
{
  const int order = 4 + 2 * (_i % 3);
  check_order(_i / 3, method_spec("composition:order=%d,base=midpoint", order), order);
}
END_TEST

START_TEST(the_explicit_and_the_two_point_rules_have_order_2)
{
  static const char *const methods[] = {"verlet", "midpoint", "trapezoidal"};
  check_order(0, methods[_i], 2);
}
END_TEST

SUITE(order_composition)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, compositions_of_verlet_have_their_order, 0, ORDER_PLACES * 3);
  tcase_add_loop_test(tests, compositions_of_midpoint_have_their_order, 0, ORDER_PLACES * 3);
  tcase_add_loop_test(tests, the_explicit_and_the_two_point_rules_have_order_2, 0, 3);
}
