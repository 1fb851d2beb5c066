#include <math.h>
#include <stdlib.h>

#include "expr/graph.h"
#include "support/suite.h"
#include "text/heap.h"
#include "nodes.h"

START_TEST(equal_parts_are_one_node)
{
  const dvi__node x = input(0), y = input(1);
  ck_assert_int_eq(input(0), x);
  ck_assert_int_eq(add(x, y), add(y, x));
  ck_assert_int_eq(multiply(x, y), multiply(y, x));
  ck_assert_int_ne(subtract(x, y), subtract(y, x));
  ck_assert_int_eq(apply(DVI__OP_SIN, add(x, y), 0), apply(DVI__OP_SIN, add(y, x), 0));
}
END_TEST

START_TEST(zeros_ones_and_signs_vanish)
{
  const dvi__node x = input(0), y = input(1), zero = constant(0), one = constant(1);
  ck_assert_int_eq(constant(-0.0), zero);
  ck_assert_int_eq(add(x, zero), x);
  ck_assert_int_eq(subtract(x, zero), x);
  ck_assert_int_eq(subtract(zero, x), negate(x));
  ck_assert_int_eq(multiply(x, one), x);
  ck_assert_int_eq(multiply(x, zero), zero);
  ck_assert_int_eq(divide(x, one), x);
  ck_assert_int_eq(divide(x, constant(-1)), negate(x));
  ck_assert_int_eq(subtract(x, x), zero);
  ck_assert_int_eq(negate(negate(x)), x);
  ck_assert_int_eq(negate(subtract(x, y)), subtract(y, x));
  ck_assert_int_eq(add(x, negate(y)), subtract(x, y));
  ck_assert_int_eq(subtract(x, negate(y)), add(x, y));
  ck_assert_int_eq(multiply(negate(x), negate(y)), multiply(x, y));
  ck_assert_int_eq(multiply(negate(x), y), negate(multiply(x, y)));
  ck_assert_int_eq(divide(negate(x), y), negate(divide(x, y)));
  ck_assert_int_eq(apply(DVI__OP_SIN, negate(x), 0), negate(apply(DVI__OP_SIN, x, 0)));
  ck_assert_int_eq(apply(DVI__OP_COS, negate(x), 0), apply(DVI__OP_COS, x, 0));
}
END_TEST

START_TEST(constants_are_folded_and_gathered)
{
  const dvi__node x = input(0), y = input(1);
  double value;
  ck_assert(dvi__is_constant(&graph, apply(DVI__OP_SIN, constant(0.7), 0), &value));
  ck_assert_double_eq(value, sin(0.7));
  ck_assert_int_eq(multiply(constant(3), multiply(constant(2), x)), multiply(constant(6), x));
  ck_assert_int_eq(add(multiply(constant(3), x), multiply(constant(2), x)),
                   multiply(constant(5), x));
  ck_assert_int_eq(subtract(multiply(constant(3), x), x), multiply(constant(2), x));
  ck_assert_int_eq(divide(x, constant(4)), multiply(constant(0.25), x));
  ck_assert_int_eq(graph.node[divide(x, constant(3))].op, DVI__OP_DIVIDE);
  ck_assert_int_eq(multiply(multiply(constant(3), x), multiply(constant(2), y)),
                   multiply(multiply(constant(6), x), y));
}
END_TEST

/* A result that is not finite is left to run time, and products of constants that would overflow
 * are not formed. */
START_TEST(folding_makes_no_infinities)
{
  const dvi__node x = input(0);
  double value;
  ck_assert(!dvi__is_constant(&graph, apply(DVI__OP_LOG, constant(0), 0), &value));
  ck_assert(!dvi__is_constant(&graph, divide(constant(1), constant(0)), &value));
  ck_assert(!dvi__is_constant(&graph, power(constant(0), -1.5), &value));
  ck_assert(!dvi__is_constant(&graph, multiply(constant(1e300), constant(1e300)), &value));
  const dvi__node root = multiply(constant(1e300),
                                  multiply(constant(1e300), multiply(constant(1e-300), x)));
  const double one = 1;
  dvi__node not_finite;
  ck_assert_int_eq(dvi__evaluate(&graph, &one, 1, &root, &value, &not_finite), DVI_OK);
  ck_assert_double_eq_tol(value, 1e300, 1e286);
  ck_assert_int_eq(not_finite, -1);
}
END_TEST

/* Factors near the ends of the range stay where they were written. */
START_TEST(gathering_factors_makes_no_infinities)
{
  const dvi__node x = input(0), y = input(1), large = multiply(constant(1e308), x);
  const dvi__node roots[2] = {multiply(multiply(constant(1e150), x), multiply(constant(1e150), y)),
                              add(large, large)};
  const double at[2] = {1e10, 1e-300}, at_small[2] = {1e-10, 0};
  double value[2];
  dvi__node not_finite;
  ck_assert_int_eq(dvi__evaluate(&graph, at, 1, roots, value, &not_finite), DVI_OK);
  ck_assert_double_eq_tol(value[0], 1e10, 1e-4);
  ck_assert_int_eq(dvi__evaluate(&graph, at_small, 2, roots, value, &not_finite), DVI_OK);
  ck_assert_double_eq_tol(value[1], 2e298, 1e284);
}
END_TEST

START_TEST(powers_of_one_base_are_one_power)
{
  const dvi__node x = input(0), y = input(1);
  const dvi__node r2 = add(power(x, 2), power(y, 2)), norm = apply(DVI__OP_SQRT, r2, 0);
  ck_assert_int_eq(multiply(x, x), power(x, 2));
  ck_assert_int_eq(multiply(multiply(x, x), x), power(x, 3));
  ck_assert_int_eq(power(power(x, 2), 3), power(x, 6));
  ck_assert_int_eq(power(norm, 2), r2);
  ck_assert_int_eq(divide(constant(1), norm), power(r2, -0.5));
  ck_assert_int_eq(divide(y, power(norm, 3)), multiply(y, power(r2, -1.5)));
  ck_assert_int_eq(divide(r2, power(norm, 5)), power(r2, -1.5));
  ck_assert_int_eq(power(divide(constant(2), norm), 12), multiply(constant(4096), power(r2, -6)));
  ck_assert_int_eq(apply(DVI__OP_SQRT, power(x, 2), 0), apply(DVI__OP_ABS, x, 0));
}
END_TEST

/* The root of x does not exist for x < 0, nor 1/x for 0. A rule that would extend the domain is not
 * applied. */
START_TEST(domains_are_kept)
{
  const dvi__node x = input(0);
  ck_assert_int_ne(power(apply(DVI__OP_SQRT, x, 0), 2), x);
  ck_assert_int_eq(graph.node[divide(x, x)].op, DVI__OP_DIVIDE);
  ck_assert_int_ne(multiply(power(x, 3), power(x, -1)), power(x, 2));
  ck_assert_int_eq(graph.node[power(x, 0.3)].op, DVI__OP_RAISE);
  ck_assert_int_eq(graph.node[power(x, 1000)].op, DVI__OP_RAISE);
}
END_TEST

/* Nodes are visited in loops, so no depth overflows the stack. */
START_TEST(expressions_may_be_a_hundred_thousand_levels_deep)
{
  dvi__node root = input(0), gradient, rate = constant(1);
  for (int i = 0; i < 100000; i++) root = apply(DVI__OP_SIN, root, 0);
  dvi__gradient(&graph, root, 1, &gradient);
  const dvi__node along = rate_of(root, 1, &rate);
  const dvi__node roots[2] = {gradient, along};
  const double x = 0.5;
  double value[2];
  dvi__node not_finite;
  int(*pair)[2], found;
  ck_assert_int_eq(dvi__evaluate(&graph, &x, 2, roots, value, &not_finite), DVI_OK);
  ck_assert_double_eq_tol(value[0], value[1], 1e-9 * fabs(value[1]));
  ck_assert_int_eq(dvi__second_pattern(&graph, root, 1, &pair, &found), DVI_OK);
  ck_assert_int_eq(found, 1);
  dvi__heap_free(pair);
}
END_TEST

START_TEST(the_first_part_that_is_not_finite_is_told)
{
  const dvi__node less = subtract(input(0), constant(1)), logarithm = apply(DVI__OP_LOG, less, 0);
  const dvi__node root = add(multiply(logarithm, constant(2)), input(1));
  const double x[2] = {0.8, 1};
  double value;
  dvi__node not_finite;
  ck_assert_int_eq(dvi__evaluate(&graph, x, 1, &root, &value, &not_finite), DVI_OK);
  ck_assert_int_eq(not_finite, logarithm);
  ck_assert(isnan(value));
}
END_TEST

/* Each takes as long as its own parts. If each went through all of the graph, they would take
 * minutes. */
START_TEST(second_derivatives_of_a_long_sum_are_found_one_by_one)
{
  enum { TERMS = 100000 };
  dvi__node *gradient = calloc(TERMS, sizeof *gradient), second, root = constant(0);
  ck_assert_ptr_nonnull(gradient);
  for (int i = 0; i < TERMS; i++) root = add(root, apply(DVI__OP_SIN, input(i), 0));
  dvi__gradient(&graph, root, TERMS, gradient);
  for (int i = 0; i < TERMS; i++) {
    dvi__tangents(&graph, i, 1, &gradient[i], &second);
    ck_assert_int_eq(second, negate(apply(DVI__OP_SIN, input(i), 0)));
  }
  free(gradient);
}
END_TEST

START_TEST(inputs_of_roots_are_known)
{
  const dvi__node roots[2] = {add(input(3), input(1)), apply(DVI__OP_EXP, input(4), 0)};
  char used[4];
  input(0);
  dvi__inputs_used(&graph, 2, roots, 4, used);
  ck_assert(!used[0] && used[1] && !used[2] && used[3]);
}
END_TEST

/* Derivatives point to the part of the source that they are derivatives of. */
START_TEST(new_nodes_have_the_span_of_their_source)
{
  graph.here = (dvi__span){10, 3};
  const dvi__node sine = apply(DVI__OP_SIN, input(0), 0);
  graph.here = (dvi__span){20, 5};
  const dvi__node root = multiply(sine, input(1));
  dvi__node gradient[2];
  dvi__gradient(&graph, root, 2, gradient);
  ck_assert_uint_eq(graph.node[apply(DVI__OP_COS, input(0), 0)].span.first, 10);
  ck_assert_uint_eq(graph.node[gradient[0]].span.first, 10);
  ck_assert_uint_eq(graph.node[root].span.first, 20);
  ck_assert_uint_eq(graph.here.first, 20);
}
END_TEST

START_TEST(beyond_the_limit_everything_is_node_0)
{
  graph.limit = 50;
  dvi__node root = input(0), gradient[1];
  for (int i = 0; i < 100; i++) root = apply(DVI__OP_SIN, root, 0);
  ck_assert_int_eq(graph.failed, DVI_BAD_SIZE);
  ck_assert_int_eq(graph.count, 50);
  ck_assert_int_eq(root, 0);
  ck_assert_int_eq(input(7), 0);
  ck_assert_int_eq(power(root, 3), 0);
  dvi__gradient(&graph, root, 1, gradient);
  ck_assert_int_eq(gradient[0], 0);
  dvi__tangents(&graph, 0, 1, &root, gradient);
  int(*pair)[2], found;
  ck_assert_int_eq(dvi__second_pattern(&graph, root, 1, &pair, &found), DVI_BAD_SIZE);
  double value;
  ck_assert_int_eq(dvi__evaluate(&graph, NULL, 1, &root, &value, gradient), DVI_BAD_SIZE);
  ck_assert(!dvi__is_constant(&graph, root, &value));
}
END_TEST

SUITE(graph)
{
  tcase_add_checked_fixture(tests, setup, teardown);
  tcase_add_test(tests, equal_parts_are_one_node);
  tcase_add_test(tests, zeros_ones_and_signs_vanish);
  tcase_add_test(tests, constants_are_folded_and_gathered);
  tcase_add_test(tests, folding_makes_no_infinities);
  tcase_add_test(tests, gathering_factors_makes_no_infinities);
  tcase_add_test(tests, powers_of_one_base_are_one_power);
  tcase_add_test(tests, domains_are_kept);
  tcase_add_test(tests, second_derivatives_of_a_long_sum_are_found_one_by_one);
  tcase_add_test(tests, expressions_may_be_a_hundred_thousand_levels_deep);
  tcase_add_test(tests, the_first_part_that_is_not_finite_is_told);
  tcase_add_test(tests, inputs_of_roots_are_known);
  tcase_add_test(tests, new_nodes_have_the_span_of_their_source);
  tcase_add_test(tests, beyond_the_limit_everything_is_node_0);
}
