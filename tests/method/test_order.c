/* labels: order */
/* Measured orders are the claimed ones, for every degree and problem. The judge works in quadruple precision. Low orders are measured at
 * the end of a span, all of them by the error of one step. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

/* Where a problem's orders show: the span, its steps in the coarsest run of a global study, and the longest step that a local one tries, a
 * little more than the distance of the nearest singularity in complex time. */
typedef struct place {
  span over;
  int first;
  double h;
} place;

static const place places[] = {
    {{"kepler", NULL, 6.0}, 40, 0.6},         {{"pendulum", NULL, 8.0}, 10, 1.6}, {{"henon-heiles", NULL, 6.0}, 10, 2.0},
    {{"double-pendulum", NULL, 1.0}, 10, 0.2}, {{"toda", "N=5", 5.0}, 10, 2.5},
};
enum { PLACES = sizeof places / sizeof *places, DEGREES = 8, GLOBAL_DEGREES = 3 };

/* The degree and the place of a looped test. */
static int degree_of(int i, int degrees)
{
  return 1 + i % degrees;
}

static void check_local(int index, const char *method, int order)
{
  check_local_order(&places[index].over, method, places[index].h, order);
}

static void check_global(int index, const char *method, int order)
{
  check_global_order(&places[index].over, method, places[index].first, order);
}

START_TEST(gauss_with_as_many_nodes_as_degrees_has_order_2s)
{
  const int s = degree_of(_i, DEGREES);
  check_local(_i / DEGREES, spec("galerkin:degree=%d,quadrature=gauss,nodes=%d", s, s), 2 * s);
}
END_TEST

START_TEST(lobatto_with_one_node_more_has_order_2s)
{
  const int s = degree_of(_i, DEGREES);
  check_local(_i / DEGREES, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1), 2 * s);
}
END_TEST

START_TEST(lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2)
{
  const int s = 1 + degree_of(_i, DEGREES - 1);
  check_local(_i / (DEGREES - 1), spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s), 2 * s - 2);
}
END_TEST

START_TEST(errors_at_the_end_of_a_span_have_the_order_2s_of_gauss)
{
  const int s = degree_of(_i, GLOBAL_DEGREES);
  check_global(_i / GLOBAL_DEGREES, spec("galerkin:degree=%d,quadrature=gauss,nodes=%d", s, s), 2 * s);
}
END_TEST

START_TEST(errors_at_the_end_of_a_span_have_the_order_2s_of_long_lobatto)
{
  const int s = degree_of(_i, GLOBAL_DEGREES);
  check_global(_i / GLOBAL_DEGREES, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1), 2 * s);
}
END_TEST

START_TEST(errors_at_the_end_of_a_span_have_the_order_2s_minus_2_of_short_lobatto)
{
  const int s = 1 + degree_of(_i, GLOBAL_DEGREES);
  check_global(_i / GLOBAL_DEGREES, spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s), 2 * s - 2);
}
END_TEST

/* The double pendulum has no constant mass, which verlet needs. */
START_TEST(compositions_of_verlet_have_their_order)
{
  const int order = 4 + 2 * (_i % 3), index = _i / 3;
  if (index != 3) check_local(index, spec("composition:order=%d,base=verlet", order), order);
}
END_TEST

START_TEST(compositions_of_midpoint_have_their_order)
{
  const int order = 4 + 2 * (_i % 3);
  check_local(_i / 3, spec("composition:order=%d,base=midpoint", order), order);
}
END_TEST

START_TEST(the_explicit_and_the_two_point_rules_have_order_2)
{
  static const char *const methods[] = {"verlet", "midpoint", "trapezoidal"};
  check_global(0, methods[_i], 2);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, gauss_with_as_many_nodes_as_degrees_has_order_2s, 0, PLACES * DEGREES);
  tcase_add_loop_test(tests, lobatto_with_one_node_more_has_order_2s, 0, PLACES * DEGREES);
  tcase_add_loop_test(tests, lobatto_with_as_many_nodes_as_degrees_has_order_2s_minus_2, 0, PLACES * (DEGREES - 1));
  tcase_add_loop_test(tests, errors_at_the_end_of_a_span_have_the_order_2s_of_gauss, 0, PLACES * GLOBAL_DEGREES);
  tcase_add_loop_test(tests, errors_at_the_end_of_a_span_have_the_order_2s_of_long_lobatto, 0, PLACES * GLOBAL_DEGREES);
  tcase_add_loop_test(tests, errors_at_the_end_of_a_span_have_the_order_2s_minus_2_of_short_lobatto, 0, PLACES * GLOBAL_DEGREES);
  tcase_add_loop_test(tests, compositions_of_verlet_have_their_order, 0, PLACES * 3);
  tcase_add_loop_test(tests, compositions_of_midpoint_have_their_order, 0, PLACES * 3);
  tcase_add_loop_test(tests, the_explicit_and_the_two_point_rules_have_order_2, 0, 3);
  return run_tests("order", tests);
}
