/* labels: order slow */
/* The orders of Lobatto quadrature, measured as in test_order.c. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

START_TEST(lobatto_with_one_node_more_has_order_2s)
{
  const int s = 1 + _i % MOST_DEGREE;
  check_order(_i / MOST_DEGREE, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1), 2 * s);
}
END_TEST

START_TEST(lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2)
{
  const int s = 2 + _i % (MOST_DEGREE - 1);
  check_order(_i / (MOST_DEGREE - 1), spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s), 2 * s - 2);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, lobatto_with_one_node_more_has_order_2s, 0, ORDER_PLACES * MOST_DEGREE);
  tcase_add_loop_test(tests, lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2, 0, ORDER_PLACES * (MOST_DEGREE - 1));
  return run_tests("order_lobatto", tests);
}
