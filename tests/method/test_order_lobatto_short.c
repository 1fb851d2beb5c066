/* labels: order slow */
/* The order of Lobatto quadrature with as many nodes as degrees, two less than with one node more. Measured as in
 * support/order.c. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

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
  tcase_add_loop_test(tests, lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2, 0, ORDER_PLACES * (MOST_DEGREE - 1));
  return run_tests("order_lobatto_short", tests);
}
