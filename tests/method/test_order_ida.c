/* labels: order reference */
/* IDA, which shares no solver with the methods, finds the same orders as the judge of
 * test_order.c. */
#include <check.h>

#include "support/order.h"
#include "support/suite.h"

START_TEST(ida_finds_the_order_2_of_the_midpoint_rule)
{
  check_order_by_ida(_i, "midpoint", 2);
}
END_TEST

START_TEST(ida_finds_the_order_4_of_gauss_with_two_nodes)
{
  check_order_by_ida(_i, "galerkin", 4);
}
END_TEST

START_TEST(ida_finds_the_order_4_of_lobatto_with_three_nodes_for_degree_3)
{
  check_order_by_ida(_i, "galerkin:degree=3,quadrature=lobatto,nodes=3", 4);
}
END_TEST

SUITE(order_ida)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, ida_finds_the_order_2_of_the_midpoint_rule, 0, ORDER_PLACES);
  tcase_add_loop_test(tests, ida_finds_the_order_4_of_gauss_with_two_nodes, 0, ORDER_PLACES);
  tcase_add_loop_test(tests, ida_finds_the_order_4_of_lobatto_with_three_nodes_for_degree_3, 0,
                      ORDER_PLACES);
}
