/* Programs on truncated power series. The sum of the series is the value of the expression at the
 * point. */
#include <dvi/taylor.h>
#include <float.h>
#include <math.h>

#include "expr/graph_make.h"
#include "expr/compile/program.h"
#include "support/suite.h"

enum { DEGREE = 14, LENGTH = DEGREE + 1, ROWS = 64, INPUTS = 2 };

/* x(s) = 0.6 + .., y(s) = 1.7 + .. are inside of the domains of all operations but acosh, which
 * gets y. */
static const double curve[INPUTS][LENGTH] = {{0.6, 0.4, -0.3, 0.2}, {1.7, -0.5, 0.25, 0.1}};

static double sum_of(const double *series, double s)
{
  double sum = 0.0;
  for (int k = DEGREE; k >= 0; k--) sum = series[k] + s * sum;
  return sum;
}

/* Radii of convergence are 0.3 and more, so the remainder is below 1e-15 of numbers of size 1. */
static void compare_series(dvi__graph *graph, dvi__node root, const double curves[INPUTS][LENGTH])
{
  const double s = 0.025;
  const dvi__node inputs[INPUTS] = {dvi__input(graph, 0), dvi__input(graph, 1)};
  const double x[INPUTS] = {sum_of(curves[0], s), sum_of(curves[1], s)};
  double memory[ROWS * LENGTH], expected;
  double *registers = memory + (ptrdiff_t)INPUTS * LENGTH;
  dvi__program program;
  dvi__node not_finite;
  ck_assert_int_eq(dvi__program_make(graph, INPUTS, inputs, 1, &root, &program), DVI_OK);
  ck_assert_int_le(program.row_count + INPUTS, ROWS);
  for (int i = 0; i < INPUTS; i++)
    for (int k = 0; k < LENGTH; k++) registers[-(i + 1) * LENGTH + k] = curves[i][k];
  dvi__program_run_series(&program, DEGREE, registers);
  ck_assert_int_eq(dvi__evaluate(graph, x, 1, &root, &expected, &not_finite), DVI_OK);
  const double found = sum_of(registers + (ptrdiff_t)(program.row_count - 1) * LENGTH, s);
  ck_assert_double_eq_tol(found, expected, 100 * DBL_EPSILON * (1 + fabs(expected)));
  dvi__program_free(&program);
}

START_TEST(every_operation_of_one_number_is_known)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), y = dvi__input(&graph, 1);
  for (dvi__op op = DVI__OP_NEGATE; op <= DVI__OP_SIGN; op++) {
    if (op == DVI__OP_POWER) continue;
    compare_series(&graph, dvi__apply(&graph, op, op == DVI__OP_ACOSH ? y : x, x), curve);
  }
  compare_series(&graph, dvi__apply(&graph, DVI__OP_FLOOR, dvi__scale(&graph, 5, y), x), curve);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_POSITIVE, x, x), curve);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_POSITIVE, dvi__negate(&graph, x), x), curve);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(every_operation_of_two_numbers_is_known)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), y = dvi__input(&graph, 1),
                  two = dvi__constant(&graph, 2.5);
  for (dvi__op op = DVI__OP_ADD; op <= DVI__OP_ATAN2; op++) {
    compare_series(&graph, dvi__apply(&graph, op, x, y), curve);
    compare_series(&graph, dvi__apply(&graph, op, x, two), curve);
    compare_series(&graph, dvi__apply(&graph, op, two, y), curve);
  }
  const dvi__node yes = dvi__greater(&graph, x, dvi__constant(&graph, -9)),
                  log = dvi__apply(&graph, DVI__OP_LOG, dvi__negate(&graph, y), y);
  compare_series(&graph, dvi__choice(&graph, yes, y, log),
                 curve); /* the series of the logarithm is none */
  dvi__graph_free(&graph);
}
END_TEST

/* A function with a jump or a kink at 0 has no series there, unless its argument is constant. */
START_TEST(at_a_kink_there_is_a_series_of_what_stays_alone)
{
  static const dvi__op ops[] = {DVI__OP_ABS, DVI__OP_SIGN, DVI__OP_FLOOR, DVI__OP_POSITIVE};
  for (size_t i = 0; i < sizeof ops / sizeof *ops; i++)
    for (int moves = 0; moves < 2; moves++) {
      dvi__graph graph = {0};
      const dvi__node x = dvi__input(&graph, 0), root = dvi__apply(&graph, ops[i], x, x);
      double memory[2 * ROWS] = {0}, *registers = memory + 2;
      dvi__program program;
      ck_assert_int_eq(dvi__program_make(&graph, 1, &x, 1, &root, &program), DVI_OK);
      registers[-1] = moves;
      dvi__program_run_series(&program, 1, registers);
      const double *c = registers + (ptrdiff_t)2 * (program.row_count - 1);
      ck_assert_int_eq(isfinite(c[0]) && isfinite(c[1]), !moves);
      dvi__program_free(&program);
      dvi__graph_free(&graph);
    }
}
END_TEST

START_TEST(powers_and_operations_in_one_are_known)
{
  static const double exponents[] = {3, 4, 7, -2, -3, 1.5, 2.5, -0.5, -1.5, -2.5};
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), y = dvi__input(&graph, 1),
                  product = dvi__apply(&graph, DVI__OP_MULTIPLY, x, y);
  for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++)
    compare_series(&graph, dvi__power(&graph, x, exponents[i]), curve);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_ADD, product, x), curve);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_SUBTRACT, product, y), curve);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_SUBTRACT, y, product), curve);
  const dvi__node sine = dvi__apply(&graph, DVI__OP_SIN, x, x),
                  cosine = dvi__apply(&graph, DVI__OP_COS, x, x);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_DIVIDE, sine, cosine), curve);
  compare_series(&graph, dvi__constant(&graph, 3.25), curve);
  dvi__graph_free(&graph);
}
END_TEST

/* Whole powers, products and even roots of squares of what begins with 0. */
START_TEST(polynomials_have_series_at_zero)
{
  static const double zero[INPUTS][LENGTH] = {{0.0, 1.0, 0.5}, {-1.7, 1.0}};
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), y = dvi__input(&graph, 1);
  compare_series(&graph, dvi__power(&graph, x, 3), zero);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_MULTIPLY, x, dvi__power(&graph, x, 5)), zero);
  compare_series(&graph, dvi__power(&graph, y, -3), zero);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_ABS, y, y), zero);
  compare_series(&graph, dvi__apply(&graph, DVI__OP_ATAN2, x, y), zero);
  dvi__graph_free(&graph);
}
END_TEST

SUITE(program_series)
{
  tcase_add_test(tests, every_operation_of_one_number_is_known);
  tcase_add_test(tests, every_operation_of_two_numbers_is_known);
  tcase_add_test(tests, at_a_kink_there_is_a_series_of_what_stays_alone);
  tcase_add_test(tests, powers_and_operations_in_one_are_known);
  tcase_add_test(tests, polynomials_have_series_at_zero);
}
