/* labels: order slow long */
/* Measured orders are the claimed ones for every degree and problem, here with Gauss quadrature.
 * The judge works in quadruple precision. Orders up to 6 are measured at the end of a span, the
 * higher ones by the error of one step (support/order.c). */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

START_TEST(gauss_with_as_many_nodes_as_degrees_has_order_2s)
{
  const int which = sampled_case(_i), s = 1 + which % MOST_DEGREE;
  check_order(which / MOST_DEGREE,
              method_spec("galerkin:degree=%d,quadrature=gauss,nodes=%d", s, s), 2 * s);
}
END_TEST

SUITE(order)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, gauss_with_as_many_nodes_as_degrees_has_order_2s, 0,
                      sampled_count(ORDER_PLACES * MOST_DEGREE));
}
