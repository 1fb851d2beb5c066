/* labels: order slow long */
/* The order of Lobatto quadrature with one node more than degrees, measured as in
 * support/order.c. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

START_TEST(lobatto_with_one_node_more_has_order_2s)
{
  const int which = sampled_case(_i), s = 1 + which % MOST_DEGREE;
  check_order(which / MOST_DEGREE,
              method_spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1), 2 * s);
}
END_TEST

SUITE(order_lobatto)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, lobatto_with_one_node_more_has_order_2s, 0,
                      sampled_count(ORDER_PLACES * MOST_DEGREE));
}
