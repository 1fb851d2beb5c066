/* labels: order slow long */
/* The orders of quadratures with few nodes: Lobatto with as many as degrees, two less than with one
 * node more; Clenshaw-Curtis, whose order u is as low as its number of nodes, min(2s, u, 2(u-s+1)).
 * Measured as in support/order.c. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST_DEGREE = 8 };

START_TEST(lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2)
{
  const int which = sampled_case(_i), s = 2 + which % (MOST_DEGREE - 1);
  check_order(which / (MOST_DEGREE - 1),
              method_spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s), 2 * s - 2);
}
END_TEST

/* Orders by s and r. u is r, or r+1 for odd r. */
static const struct {
  int s, r, order;
} few[] = {{3, 3, 4}, {4, 4, 2}, {5, 5, 4}, {5, 6, 4}, {6, 6, 2}, {5, 7, 8}, {6, 7, 6}, {7, 7, 4}};
enum { FEW = sizeof few / sizeof *few };

START_TEST(clenshaw_curtis_with_few_nodes_has_the_order_that_its_own_allows)
{
  /* pendulum, henon-heiles and toda, because elsewhere the last term is small beside the next
   * ones */
  static const int places[] = {1, 2, 4};
  const int which = sampled_case(_i), place = places[which / FEW];
  const int s = few[which % FEW].s, r = few[which % FEW].r, order = few[which % FEW].order;
  const char *method = method_spec("galerkin:degree=%d,quadrature=clenshaw-curtis,nodes=%d", s, r);
  problem *model = create_problem("oscillator", NULL);
  dvi_integrator *integrator = create_integrator(model->system, method);
  ck_assert_int_eq(dvi_integrator_order(integrator), order);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  check_order(place, method, order);
}
END_TEST

SUITE(order_lobatto_short)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2, 0,
                      sampled_count(ORDER_PLACES * (MOST_DEGREE - 1)));
  tcase_add_loop_test(tests, clenshaw_curtis_with_few_nodes_has_the_order_that_its_own_allows, 0,
                      sampled_count(3 * FEW));
}
