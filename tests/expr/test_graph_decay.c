/* Derivatives of functions that decay are finite and precise wherever the functions are finite. */
#include <math.h>

#include "expr/graph.h"
#include "support/suite.h"
#include "nodes.h"

enum { ORDERS = 4, SHAPES = 9 };

static dvi__node exponential(double sign)
{
  return apply(DVI__OP_EXP, multiply(constant(sign), input(0)), 0);
}

static dvi__node shape(int number)
{
  const dvi__node x = input(0), one = constant(1), cosh_x = apply(DVI__OP_COSH, x, 0);
  switch (number) {
  case 0: return apply(DVI__OP_TANH, x, 0);
  case 1: return power(cosh_x, -1);
  case 2: return multiply(x, power(cosh_x, -2));
  case 3: return power(add(one, exponential(1)), -1);
  case 4: return power(add(one, exponential(-1)), -1.5);
  case 5: return divide(x, add(one, exponential(1)));
  case 6: return power(add(constant(2), multiply(constant(3), cosh_x)), -1);
  case 7: return power(subtract(constant(5), multiply(constant(-2), exponential(1))), -2);
  default: return apply(DVI__OP_ATAN, x, 0);
  }
}

/* Evaluate a shape and its derivatives. Orders change between the two modes. */
static void derivatives(int number, double x, double *value)
{
  dvi__node root[ORDERS], not_finite;
  root[0] = shape(number);
  for (int k = 1; k < ORDERS; k++)
    if (k % 2 == 1)
      dvi__gradient(&graph, root[k - 1], 1, root + k);
    else
      dvi__tangents(&graph, 0, 1, root + k - 1, root + k);
  ck_assert_int_eq(dvi__evaluate(&graph, &x, ORDERS, root, value, &not_finite), DVI_OK);
}

START_TEST(derivatives_are_finite_far_beyond_the_range_of_exp)
{
  const double far[] = {-1e300, -1e4, -711, 0, 711, 1e4, 1e300};
  for (int number = 0; number < SHAPES; number++)
    for (int i = 0; i < 7; i++) {
      double value[ORDERS];
      derivatives(number, far[i], value);
      for (int k = 0; k < ORDERS; k++)
        ck_assert_msg(isfinite(value[k]), "shape %d, x = %g, order %d", number, far[i], k);
    }
}
END_TEST

/* Orders 1 and 2 of 1/cosh, of 1/(1+exp) and of 1/(2+3 cosh), in forms that do not cancel. */
START_TEST(derivatives_keep_their_relative_precision)
{
  for (double x = -600; x <= 600; x += 37.5) {
    double value[ORDERS];
    const double s = 1 / cosh(x), t = tanh(x), down = 1 / (1 + exp(x)), up = 1 / (1 + exp(-x));
    derivatives(1, x, value);
    ck_assert_double_eq_tol(value[1], -s * t, 1e-14 * s);
    ck_assert_double_eq_tol(value[2], s * (t * t - s * s), 1e-14 * s);
    derivatives(3, x, value);
    ck_assert_double_eq_tol(value[1], -down * up, 1e-14 * down * up);
    ck_assert_double_eq_tol(value[2], down * up * (up - down), 1e-14 * down * up);
    derivatives(6, x, value);
    const double r = 1 / (2 + 3 * cosh(x)), slope = 3 * sinh(x) * r;
    ck_assert_double_eq_tol(value[1], -slope * r, 1e-14 * r);
    ck_assert_double_eq_tol(value[2], r * (2 * slope * slope - 3 * cosh(x) * r), 1e-14 * r);
  }
}
END_TEST

SUITE(graph_decay)
{
  tcase_add_checked_fixture(tests, setup, teardown);
  tcase_add_test(tests, derivatives_are_finite_far_beyond_the_range_of_exp);
  tcase_add_test(tests, derivatives_keep_their_relative_precision);
}
