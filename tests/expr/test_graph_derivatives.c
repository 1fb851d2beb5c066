/* Gradients and second derivatives share parts and cost little, and their patterns are exact. */
#include <stdlib.h>

#include "expr/graph.h"
#include "support/suite.h"
#include "text/heap.h"
#include "nodes.h"

enum { INPUTS_MAX = 100 };

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

SUITE(graph_derivatives)
{
  tcase_add_checked_fixture(tests, setup, teardown);
  tcase_add_test(tests, the_pull_of_two_bodies_costs_one_power);
  tcase_add_test(tests, second_derivatives_of_two_bodies_share_their_parts);
  tcase_add_test(tests, gradients_cost_at_most_four_values);
  tcase_add_test(tests, quotients_are_divided_once);
  tcase_add_test(tests, a_gradient_ignores_inputs_that_are_parameters);
  tcase_add_test(tests, rates_follow_the_chain_rule);
  tcase_add_test(tests, patterns_are_exact);
  tcase_add_test(tests, the_pattern_of_a_chain_is_a_band);
  tcase_add_test(tests, any_limit_fails_in_peace);
}
