/* labels: order */
/* Measured orders are the claimed ones, for every degree and problem. The judge works in quadruple precision; errors are followed down to a
 * floor, and the slope is taken over the finest steps above it.
 *
 * Neighbouring step sizes are chosen so that errors fall by 16 from one to the next: high orders get large steps close together. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/suite.h"

/* Where each problem's orders show. The span is short where errors grow fast. */
typedef struct setup {
  const char *problem, *setting;
  double t_end;
  int first;    /* steps of the coarsest run of order 2 */
} setup;

static const setup setups[] = {
    {"kepler", NULL, 40.0, 15},
    {"pendulum", NULL, 100.0, 15},
    {"henon-heiles", NULL, 60.0, 8},
    {"double-pendulum", NULL, 4.0, 3},
    {"toda", NULL, 40.0, 4},
};
enum { SETUPS = sizeof setups / sizeof *setups, DEGREES = 8 };

static void check(int index, const char *method, int order)
{
  const setup *s = &setups[index];
  problem *of = made_problem(s->problem, s->setting);
  judged solution;
  judge_by_quad(of, s->setting, s->t_end, &solution);
  const order_study study = {.method = method, .first = s->first, .levels = 16, .ratio = fmin(2, pow(2, 4.0 / order)), .floor = 2e-13};
  check_order(&solution, &study, order);
  problem_destroy(&of);
}

START_TEST(gauss_with_as_many_nodes_as_degrees_has_order_2s)
{
  const int s = 1 + _i % DEGREES;
  check(_i / DEGREES, spec("galerkin:degree=%d,quadrature=gauss,nodes=%d", s, s), 2 * s);
}
END_TEST

START_TEST(lobatto_with_one_node_more_has_order_2s)
{
  const int s = 1 + _i % DEGREES;
  check(_i / DEGREES, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1), 2 * s);
}
END_TEST

START_TEST(lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2)
{
  const int s = 1 + _i % DEGREES;
  if (s > 1) check(_i / DEGREES, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s), 2 * s - 2);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, gauss_with_as_many_nodes_as_degrees_has_order_2s, 0, SETUPS * DEGREES);
  tcase_add_loop_test(tests, lobatto_with_one_node_more_has_order_2s, 0, SETUPS * DEGREES);
  tcase_add_loop_test(tests, lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2, 0, SETUPS * DEGREES);
  return run_tests("order", tests);
}
