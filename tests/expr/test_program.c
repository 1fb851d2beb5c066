#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expr/compile/program.h"
#include "support/suite.h"

enum { INPUTS = 2, ROWS = 64 };

/* Compile one root of inputs 0 and 1. */
static dvi__program compiled(const dvi__graph *graph, dvi__node root)
{
  dvi__program program;
  dvi__node input[INPUTS], count = 0;
  for (dvi__node n = 0; n < graph->count; n++)
    if (graph->node[n].op == DVI__OP_INPUT) input[count++] = n;
  ck_assert_int_eq(dvi__program_make(graph, count, input, 1, &root, &program), DVI_OK);
  return program;
}

/* Compares the program's output on lanes of a row and b row. Rows are full width. */
static void run(const dvi__program *program, int lanes, const double *const *input, double *result)
{
  double *registers = calloc((size_t)program->row_count * DVI__LANES_MAX, sizeof *registers);
  ck_assert_ptr_nonnull(registers);
  dvi__program_run(program, lanes, input, registers);
  memcpy(result,
         registers +
             (ptrdiff_t)(program->row_count - program->output_count) * dvi__row_width(lanes),
         (size_t)lanes * sizeof *result);
  free(registers);
}

/* Numbers in (least, most), all different. */
static void fill(double *row, double least, double most, int turn)
{
  for (int k = 0; k < DVI__LANES_MAX; k++)
    row[k] = least +
             (most - least) * fmod(0.5 + (k + 1) * (turn == 0 ? 0.6180339887 : 0.4142135624), 1.0);
}

/* All lanes are what the graph's own evaluation says. */
static void check_against_graph(const dvi__graph *graph, dvi__node root, double least, double most,
                                double ulps)
{
  double a[DVI__LANES_MAX], b[DVI__LANES_MAX], result[DVI__LANES_MAX];
  const double *const input[INPUTS] = {a, b};
  dvi__program program = compiled(graph, root);
  fill(a, least, most, 0);
  fill(b, least, most, 1);
  run(&program, DVI__LANES_MAX, input, result);
  for (int k = 0; k < DVI__LANES_MAX; k++) {
    double expected;
    dvi__node bad;
    ck_assert_int_eq(dvi__evaluate(graph, (double[]){a[k], b[k]}, 1, &root, &expected, &bad),
                     DVI_OK);
    ck_assert_double_le(fabs(result[k] - expected), ulps * DBL_EPSILON * fabs(expected));
  }
  dvi__program_free(&program);
}

/* Functions of the C library and single roundings give the same number, because the call is the
 * same. Sines and cosines are right to a unit in the last place (test_sines.c). */
START_TEST(every_operation_does_what_the_graph_says)
{
  for (int op = DVI__OP_NEGATE; op < DVI__OP_COUNT; op++) {
    if (op == DVI__OP_POWER) continue; /* see below */
    dvi__graph graph = {0};
    const dvi__node a = dvi__input(&graph, 0), b = dvi__input(&graph, 1);
    const double least = op == DVI__OP_ACOSH ? 1.5 : 0.1,
                 ulps = op == DVI__OP_SIN || op == DVI__OP_COS ? 1.0 : 0.0;
    check_against_graph(&graph, dvi__apply(&graph, (dvi__op)op, a, b), least, least + 0.8, ulps);
    dvi__graph_free(&graph);
  }
}
END_TEST

/* Evaluates on both sides of a jump, and at it. The branch that is not taken may be no number, and
 * a condition that is no number gives none. */
START_TEST(conditions_take_a_side_in_every_lane)
{
  dvi__graph graph = {0};
  const dvi__node a = dvi__input(&graph, 0), b = dvi__input(&graph, 1),
                  positive = dvi__apply(&graph, DVI__OP_POSITIVE, a, a);
  check_against_graph(&graph, dvi__apply(&graph, DVI__OP_FLOOR, a, a), -3, 3, 0.0);
  check_against_graph(&graph, positive, -1, 1, 0.0);
  check_against_graph(
      &graph, dvi__choice(&graph, positive, dvi__apply(&graph, DVI__OP_LOG, a, a), b), -1, 1, 0.0);
  const dvi__node root = dvi__choice(&graph, positive, a, dvi__constant(&graph, 7));
  dvi__program program = compiled(&graph, root);
  double row[DVI__LANES] = {(double)NAN, 0.0, -0.0, 2.0, -2.0, 1e-320, -1e-320, HUGE_VAL},
         result[DVI__LANES];
  static const double expected[DVI__LANES] = {0, 7, 7, 2, 7, 1e-320, 7, HUGE_VAL};
  run(&program, DVI__LANES, (const double *const[INPUTS]){row, row}, result);
  ck_assert(isnan(result[0]));
  for (int k = 1; k < DVI__LANES; k++)
    ck_assert_msg(!(result[k] < expected[k]) && !(result[k] > expected[k]), "lane %d", k);
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(constants_may_stand_on_either_side)
{
  static const dvi__op ops[] = {DVI__OP_ADD,    DVI__OP_SUBTRACT, DVI__OP_MULTIPLY,
                                DVI__OP_DIVIDE, DVI__OP_RAISE,    DVI__OP_ATAN2};
  for (size_t i = 0; i < sizeof ops / sizeof *ops; i++)
    for (int side = 0; side < 2; side++) {
      dvi__graph graph = {0};
      const dvi__node x = dvi__input(&graph, 0), c = dvi__constant(&graph, 0.3);
      (void)dvi__input(&graph, 1);
      check_against_graph(&graph, dvi__apply(&graph, ops[i], side == 0 ? x : c, side == 0 ? c : x),
                          0.2, 3.0, 2.0);
      dvi__graph_free(&graph);
    }
}
END_TEST

/* Joined operations round twice, as the single ones do. */
START_TEST(products_that_are_added_are_rounded_first)
{
  for (int shape = 0; shape < 6; shape++) {
    dvi__graph graph = {0};
    const dvi__node a = dvi__input(&graph, 0), b = dvi__input(&graph, 1);
    const dvi__node product = shape < 3 ? dvi__apply(&graph, DVI__OP_MULTIPLY, a, b)
                                        : dvi__apply(&graph, DVI__OP_SQUARE, a, a);
    const dvi__node root = shape % 3 == 0   ? dvi__apply(&graph, DVI__OP_ADD, product, b)
                           : shape % 3 == 1 ? dvi__apply(&graph, DVI__OP_SUBTRACT, product, b)
                                            : dvi__apply(&graph, DVI__OP_SUBTRACT, b, product);
    check_against_graph(&graph, root, -2.0, 3.0, 0.0);
    dvi__graph_free(&graph);
  }
}
END_TEST

START_TEST(a_sine_and_a_cosine_of_one_angle_take_one_instruction)
{
  dvi__graph graph = {0};
  const dvi__node a = dvi__input(&graph, 0), sine = dvi__apply(&graph, DVI__OP_SIN, a, a),
                  cosine = dvi__apply(&graph, DVI__OP_COS, a, a);
  const dvi__node root[2] = {cosine, sine};
  double angle[DVI__LANES_MAX], registers[4 * DVI__LANES_MAX];
  const double *const input[1] = {angle};
  dvi__program program;
  fill(angle, -20.0, 20.0, 0);
  ck_assert_int_eq(dvi__program_make(&graph, 1, &a, 2, root, &program), DVI_OK);
  ck_assert_int_eq(program.instruction_count, 1);
  dvi__program_run(&program, DVI__LANES_MAX, input, registers);
  const double *result = registers + (ptrdiff_t)(program.row_count - 2) * DVI__LANES_MAX;
  for (int k = 0; k < DVI__LANES_MAX; k++) {
    ck_assert_double_eq_tol(result[k], cos(angle[k]), DBL_EPSILON);
    ck_assert_double_eq_tol(result[DVI__LANES_MAX + k], sin(angle[k]), DBL_EPSILON);
  }
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

/* There are at most two roundings for each root in the product, and long double has 11 bits
 * more. */
START_TEST(powers_are_right_to_two_roundings_for_each_root)
{
  for (double exponent = -16.5; exponent <= 16.5; exponent += 0.5) {
    if (fabs(exponent) <= 1.0) continue;
    dvi__graph graph = {0};
    const dvi__node root = dvi__power(&graph, dvi__input(&graph, 0), exponent);
    dvi__program program = compiled(&graph, root);
    double x[DVI__LANES_MAX], result[DVI__LANES_MAX];
    const double *const input[1] = {x};
    fill(x, 0.01, 9.0, 0);
    run(&program, DVI__LANES_MAX, input, result);
    for (int k = 0; k < DVI__LANES_MAX; k++) {
      const long double expected = powl(x[k], exponent);
      ck_assert_double_le((double)fabsl((result[k] - expected) / expected),
                          4.0 * fabs(exponent) * DBL_EPSILON);
    }
    dvi__program_free(&program);
    dvi__graph_free(&graph);
  }
}
END_TEST

START_TEST(inverse_roots_are_right_at_the_ends_of_the_range)
{
  dvi__graph graph = {0};
  const dvi__node root = dvi__power(&graph, dvi__input(&graph, 0), -0.5);
  dvi__program program = compiled(&graph, root);
  const double x[8] = {DBL_TRUE_MIN, DBL_MIN, 0.0, INFINITY, DBL_MAX, 1e300, -1.0, NAN};
  double result[8];
  run(&program, 8, (const double *const[]){x}, result);
  for (int k = 0; k < 8; k++) {
    const double expected = 1.0 / sqrt(x[k]);
    if (isnan(expected))
      ck_assert(isnan(result[k]));
    else if (isinf(expected))
      ck_assert_double_infinite(result[k]);
    else
      ck_assert_double_le(fabs(result[k] - expected), 3.0 * DBL_EPSILON * expected);
  }
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

/* (sin x + y)^(-3/2) sqrt(1 + y^2)/x */
static dvi__node some_expression(dvi__graph *graph)
{
  const dvi__node x = dvi__input(graph, 0), y = dvi__input(graph, 1);
  const dvi__node sum = dvi__apply(graph, DVI__OP_ADD, dvi__apply(graph, DVI__OP_SIN, x, x), y);
  const dvi__node square = dvi__apply(graph, DVI__OP_ADD, dvi__constant(graph, 1.0),
                                      dvi__apply(graph, DVI__OP_SQUARE, y, y));
  const dvi__node product = dvi__apply(graph, DVI__OP_MULTIPLY, dvi__power(graph, sum, -1.5),
                                       dvi__apply(graph, DVI__OP_SQRT, square, square));
  return dvi__apply(graph, DVI__OP_DIVIDE, product, x);
}

START_TEST(bits_do_not_depend_on_the_number_of_lanes)
{
  dvi__graph graph = {0};
  dvi__program program = compiled(&graph, some_expression(&graph));
  double a[DVI__LANES_MAX], b[DVI__LANES_MAX], all[DVI__LANES_MAX], some[DVI__LANES_MAX];
  const double *const input[INPUTS] = {a, b};
  fill(a, 0.1, 3.0, 0);
  fill(b, 1.0, 2.0, 1);
  run(&program, DVI__LANES_MAX, input, all);
  for (int lanes = 1; lanes < DVI__LANES_MAX; lanes++) {
    run(&program, lanes, input, some);
    ck_assert_mem_eq(some, all, (size_t)lanes * sizeof *some);
  }
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(what_is_given_is_not_computed)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), e = dvi__apply(&graph, DVI__OP_EXP, x, x),
                  root = dvi__apply(&graph, DVI__OP_ADD, e, x);
  const dvi__node given[2] = {e, x};
  const double ones[8] = {1, 1, 1, 1, 1, 1, 1, 1}, twos[8] = {2, 2, 2, 2, 2, 2, 2, 2};
  dvi__program program;
  double result;
  ck_assert_int_eq(dvi__program_make(&graph, 2, given, 1, &root, &program), DVI_OK);
  ck_assert_int_eq(dvi__program_operations(&program), 1);
  run(&program, 1, (const double *const[]){ones, twos}, &result);
  ck_assert_double_eq(result, 3.0);
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(roots_may_be_inputs_constants_parts_of_others_and_equal)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0), square = dvi__apply(&graph, DVI__OP_SQUARE, x, x),
                  e = dvi__apply(&graph, DVI__OP_EXP, square, x);
  const dvi__node root[6] = {x, dvi__constant(&graph, 7.0), e, square, e, x};
  const double threes[8] = {3, 3, 3, 3, 3, 3, 3, 3},
               expected[6] = {3.0, 7.0, exp(9.0), 9.0, exp(9.0), 3.0};
  double registers[ROWS * DVI__LANES];
  dvi__program program;
  ck_assert_int_eq(dvi__program_make(&graph, 1, &x, 6, root, &program), DVI_OK);
  dvi__program_run(&program, 2, (const double *const[]){threes}, registers);
  for (int k = 0; k < 6; k++)
    ck_assert_double_eq(registers[(program.row_count - 6 + k) * DVI__LANES], expected[k]);
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(registers_are_taken_again)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0);
  dvi__node root = x;
  for (int i = 0; i < 1000; i++)
    root = dvi__apply(&graph, i % 2 == 0 ? DVI__OP_SIN : DVI__OP_EXP, root, root);
  dvi__program program = compiled(&graph, root);
  ck_assert_int_eq(program.instruction_count, 1000);
  ck_assert_int_le(program.row_count, 3);
  dvi__program_free(&program);
  dvi__graph_free(&graph);
}
END_TEST

START_TEST(an_input_that_is_not_given_is_refused)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0),
                  root = dvi__apply(&graph, DVI__OP_ADD, x, dvi__input(&graph, 1));
  dvi__program program;
  ck_assert_int_eq(dvi__program_make(&graph, 1, &x, 1, &root, &program), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(program.instruction);
  dvi__graph_free(&graph);
}
END_TEST

/* sin(x + i) for more i than there are rows, all of them wanted at once. */
START_TEST(more_rows_than_there_are_is_refused)
{
  dvi__graph graph = {0};
  const dvi__node x = dvi__input(&graph, 0);
  dvi__node *root = calloc(DVI__ROWS_MAX, sizeof *root);
  dvi__program program;
  ck_assert_ptr_nonnull(root);
  for (int i = 0; i < DVI__ROWS_MAX; i++)
    root[i] = dvi__apply(&graph, DVI__OP_SIN,
                         dvi__apply(&graph, DVI__OP_ADD, x, dvi__constant(&graph, 1.0 + i)), x);
  ck_assert_int_eq(dvi__program_make(&graph, 1, &x, DVI__ROWS_MAX, root, &program), DVI_BAD_SIZE);
  ck_assert_ptr_null(program.instruction);
  ck_assert_int_eq(dvi__program_make(&graph, 1, &x, DVI__ROWS_MAX - 16, root, &program), DVI_OK);
  dvi__program_free(&program);
  dvi__graph_free(&graph);
  free(root);
}
END_TEST

SUITE(program)
{
  tcase_add_test(tests, every_operation_does_what_the_graph_says);
  tcase_add_test(tests, conditions_take_a_side_in_every_lane);
  tcase_add_test(tests, constants_may_stand_on_either_side);
  tcase_add_test(tests, products_that_are_added_are_rounded_first);
  tcase_add_test(tests, a_sine_and_a_cosine_of_one_angle_take_one_instruction);
  tcase_add_test(tests, powers_are_right_to_two_roundings_for_each_root);
  tcase_add_test(tests, inverse_roots_are_right_at_the_ends_of_the_range);
  tcase_add_test(tests, bits_do_not_depend_on_the_number_of_lanes);
  tcase_add_test(tests, what_is_given_is_not_computed);
  tcase_add_test(tests, roots_may_be_inputs_constants_parts_of_others_and_equal);
  tcase_add_test(tests, registers_are_taken_again);
  tcase_add_test(tests, an_input_that_is_not_given_is_refused);
  tcase_add_test(tests, more_rows_than_there_are_is_refused);
}
