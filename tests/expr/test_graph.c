#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "expr/graph.h"
#include "text/heap.h"
#include "support/suite.h"

enum { INPUTS_MAX = 100 };

static dvi__graph graph;

static void setup(void)
{
  graph = (dvi__graph){0};
}

static void teardown(void)
{
  dvi__graph_free(&graph);
}

static dvi__node apply(dvi__op op, dvi__node a, dvi__node b)
{
  return dvi__apply(&graph, op, a, b);
}

static dvi__node constant(double value)
{
  return dvi__constant(&graph, value);
}

static dvi__node input(int i)
{
  return dvi__input(&graph, i);
}

static dvi__node add(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_ADD, a, b);
}

static dvi__node subtract(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_SUBTRACT, a, b);
}

static dvi__node multiply(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_MULTIPLY, a, b);
}

static dvi__node divide(dvi__node a, dvi__node b)
{
  return apply(DVI__OP_DIVIDE, a, b);
}

static dvi__node negate(dvi__node a)
{
  return apply(DVI__OP_NEGATE, a, 0);
}

static dvi__node power(dvi__node a, double exponent)
{
  return dvi__power(&graph, a, exponent);
}

static dvi__node rate_of(dvi__node root, int count, const dvi__node *rate)
{
  dvi__node result;
  dvi__rates(&graph, 1, &root, count, rate, &result);
  return result;
}

/* How many operations the roots take, equal parts counted once. */
static int operations(int count, const dvi__node *root)
{
  char *part = calloc((size_t)graph.count, 1);
  int result = 0;
  for (int k = 0; k < count; k++) part[root[k]] = 1;
  for (int n = graph.count - 1; n >= 0; n--) {
    const dvi__graph_node *node = graph.node + n;
    if (!part[n] || node->op == DVI__OP_CONSTANT || node->op == DVI__OP_INPUT) continue;
    part[node->a] = 1;
    if (node->op >= DVI__OP_ADD) part[node->b] = 1;
    result++;
  }
  free(part);
  return result;
}

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

/* -w_0 w_1 / |a - b|, weights and bodies in space. */
static dvi__node gravity(void)
{
  dvi__node r2 = constant(0);
  for (int i = 0; i < 3; i++) r2 = add(r2, power(subtract(input(i), input(3 + i)), 2));
  return divide(negate(multiply(input(6), input(7))), apply(DVI__OP_SQRT, r2, 0));
}

/* There are one power -3/2, the products w_0 w_1, times it, and three components of the pull, which
 * are negated for the other body. */
START_TEST(the_pull_of_two_bodies_costs_one_power)
{
  const dvi__node root = gravity();
  dvi__node gradient[6];
  dvi__gradient(&graph, root, 6, gradient);
  ck_assert_int_eq(operations(6, gradient), 3 + 3 + 2 + 1 + 2 + 3 + 3);
  int powers = 0;
  for (int n = 0; n < graph.count; n++) powers += graph.node[n].op == DVI__OP_POWER;
  ck_assert_int_eq(powers, 2);
}
END_TEST

START_TEST(second_derivatives_of_two_bodies_share_their_parts)
{
  const dvi__node root = gravity();
  dvi__node gradient[6], second[36];
  dvi__gradient(&graph, root, 6, gradient);
  for (int j = 0; j < 6; j++) dvi__tangents(&graph, j, 6, gradient, second + (size_t)6 * (size_t)j);
  ck_assert_int_le(operations(36, second), 41);
}
END_TEST

/* The links of a chain of pendulums in the plane. Angles are inputs 0 .., and their rates
 * follow. */
static dvi__node pendulum(int links)
{
  dvi__node rate[INPUTS_MAX], x = constant(0), y = x, lagrangian = x;
  for (int i = 0; i < links; i++) rate[i] = input(links + i);
  for (int i = 0; i < links; i++) {
    x = add(x, multiply(constant(0.3), apply(DVI__OP_SIN, input(i), 0)));
    y = subtract(y, multiply(constant(0.3), apply(DVI__OP_COS, input(i), 0)));
    const dvi__node u = rate_of(x, links, rate), v = rate_of(y, links, rate);
    const dvi__node kinetic = multiply(constant(0.25), add(power(u, 2), power(v, 2)));
    lagrangian = add(lagrangian, subtract(kinetic, multiply(constant(4.905), y)));
  }
  return lagrangian;
}

/* The soft springs of the chain of Fermi, Pasta and Ulam, d^4/4. */
static dvi__node springs(int count)
{
  dvi__node sum = constant(0);
  for (int i = 0; i + 1 < count; i++)
    sum = add(sum, multiply(constant(0.25), power(subtract(input(i + 1), input(i)), 4)));
  return sum;
}

static void check_gradient_cost(dvi__node root, int count)
{
  dvi__node gradient[INPUTS_MAX];
  dvi__gradient(&graph, root, count, gradient);
  ck_assert_int_le(operations(count, gradient), 4 * operations(1, &root));
}

/* Griewank & Walther 2008, sec. 3.3. */
START_TEST(gradients_cost_at_most_four_values)
{
  check_gradient_cost(pendulum(40), 80);
  check_gradient_cost(springs(32), 32);
  check_gradient_cost(gravity(), 6);
}
END_TEST

/* sum_i w_i/(sum_j w_j) has 40 quotients, and no rule divides more than once. */
START_TEST(quotients_are_divided_once)
{
  dvi__node sum = constant(0), root = sum;
  for (int i = 0; i < 40; i++) sum = add(sum, input(i));
  for (int i = 0; i < 40; i++) root = add(root, power(divide(input(i), add(sum, input(i))), 2));
  check_gradient_cost(root, 40);
}
END_TEST

START_TEST(a_gradient_ignores_inputs_that_are_parameters)
{
  const dvi__node root = multiply(input(0), apply(DVI__OP_LOG, input(1), 0));
  dvi__node gradient[1];
  dvi__gradient(&graph, root, 1, gradient);
  const int before = graph.count;
  ck_assert_int_eq(gradient[0], apply(DVI__OP_LOG, input(1), 0));
  ck_assert_int_eq(graph.count, before);
  for (int n = 0; n < graph.count; n++) ck_assert_int_ne(graph.node[n].op, DVI__OP_DIVIDE);
}
END_TEST

START_TEST(rates_follow_the_chain_rule)
{
  const dvi__node rate[2] = {input(2), constant(0)};
  const dvi__node root = multiply(input(1), apply(DVI__OP_SIN, input(0), 0));
  ck_assert_int_eq(rate_of(root, 2, rate),
                   multiply(input(1), multiply(apply(DVI__OP_COS, input(0), 0), input(2))));
  ck_assert_int_eq(rate_of(input(1), 2, rate), constant(0));
}
END_TEST

/* The pattern must hold exactly these pairs, "ij ij ..". */
static void check_pattern(dvi__node root, int count, const char *expected)
{
  int(*pair)[2], found;
  char text[100] = "";
  ck_assert_int_eq(dvi__second_pattern(&graph, root, count, &pair, &found), DVI_OK);
  for (int k = 0; k < found; k++) {
    text[3 * k] = (char)('0' + pair[k][0]);
    text[3 * k + 1] = (char)('0' + pair[k][1]);
    text[3 * k + 2] = ' ';
    text[3 * k + 3] = '\0';
  }
  ck_assert_str_eq(text, expected);
  dvi__heap_free(pair);
}

START_TEST(patterns_are_exact)
{
  const dvi__node x = input(0), y = input(1), z = input(2), w = input(3),
                  sine = apply(DVI__OP_SIN, x, 0);
  check_pattern(add(multiply(constant(2), x), subtract(y, z)), 4, "");
  check_pattern(add(multiply(x, y), power(z, 2)), 4, "10 22 ");
  check_pattern(multiply(add(x, y), z), 4, "20 21 ");
  check_pattern(multiply(sine, w), 4, "00 30 ");
  check_pattern(multiply(sine, w), 3, "00 ");
  check_pattern(divide(x, y), 4, "10 11 ");
  check_pattern(apply(DVI__OP_ATAN2, y, x), 4, "00 10 11 ");
  check_pattern(power(add(x, subtract(y, w)), -0.5), 4, "00 10 30 11 31 33 ");
  check_pattern(multiply(x, apply(DVI__OP_ABS, y, 0)), 4, "10 ");
  check_pattern(multiply(x, apply(DVI__OP_SIGN, multiply(y, z), 0)), 4, "");
  check_pattern(constant(3), 4, "");
}
END_TEST

/* A long chain, whose sets stay small because only its bonds interact. */
START_TEST(the_pattern_of_a_chain_is_a_band)
{
  enum { LONG = 3000 };
  const dvi__node root = springs(LONG);
  int(*pair)[2], found;
  ck_assert_int_eq(dvi__second_pattern(&graph, root, LONG, &pair, &found), DVI_OK);
  ck_assert_int_eq(found, 2 * LONG - 1);
  for (int k = 0; k < found; k++) {
    ck_assert_int_eq(pair[k][1], k / 2);
    ck_assert_int_eq(pair[k][0], (k + 1) / 2);
  }
  dvi__heap_free(pair);
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

/* At whichever node the limit falls, in values and in derivatives. */
START_TEST(any_limit_fails_in_peace)
{
  for (int limit = 1; limit < 200; limit++) {
    dvi__graph_free(&graph);
    graph.limit = limit;
    const dvi__node root = pendulum(3);
    dvi__node gradient[6], second[6];
    dvi__gradient(&graph, root, 6, gradient);
    for (int j = 0; j < 6; j++) dvi__tangents(&graph, j, 6, gradient, second);
    ck_assert_int_le(graph.count, limit);
  }
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
  tcase_add_test(tests, the_pull_of_two_bodies_costs_one_power);
  tcase_add_test(tests, second_derivatives_of_two_bodies_share_their_parts);
  tcase_add_test(tests, gradients_cost_at_most_four_values);
  tcase_add_test(tests, quotients_are_divided_once);
  tcase_add_test(tests, a_gradient_ignores_inputs_that_are_parameters);
  tcase_add_test(tests, rates_follow_the_chain_rule);
  tcase_add_test(tests, patterns_are_exact);
  tcase_add_test(tests, the_pattern_of_a_chain_is_a_band);
  tcase_add_test(tests, second_derivatives_of_a_long_sum_are_found_one_by_one);
  tcase_add_test(tests, expressions_may_be_a_hundred_thousand_levels_deep);
  tcase_add_test(tests, the_first_part_that_is_not_finite_is_told);
  tcase_add_test(tests, inputs_of_roots_are_known);
  tcase_add_test(tests, new_nodes_have_the_span_of_their_source);
  tcase_add_test(tests, beyond_the_limit_everything_is_node_0);
  tcase_add_test(tests, any_limit_fails_in_peace);
}
