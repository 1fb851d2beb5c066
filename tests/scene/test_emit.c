/* labels: unit slow */
/* Functions as C against their byte code. The compiler of the build compiles the text, with a main
 * function that prints all results, which must be the same numbers to the last bit. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/emit/emit.h"
#include "support/files.h"
#include "support/suite.h"

enum { INPUTS_MAX = 8, ELEMENTS_MAX = 100, N = 120, POINTS_MAX = 13, RESULTS_MAX = 80000 };

static int n; /* coordinates, N but for some */
static int list[3][ELEMENTS_MAX];
static double row[2][ELEMENTS_MAX];

/* Kernels of at most INPUTS_MAX inputs, with their graphs. */
static dvi__graph graph[2];
static dvi__kernel kernel[2];
static dvi__kernel_input input[2][INPUTS_MAX];

static dvi__node apply(int k, dvi__op op, dvi__node a, dvi__node b)
{
  return dvi__apply(&graph[k], op, a, b);
}

static dvi__node sum(int k, dvi__node a, dvi__node b)
{
  return apply(k, DVI__OP_ADD, a, b);
}

static dvi__node variable(int k, int i)
{
  return dvi__input(&graph[k], i);
}

static dvi__node difference(int k, int i, int j)
{
  return apply(k, DVI__OP_SUBTRACT, variable(k, i), variable(k, j));
}

static void make_kernel(int k, dvi__node root, int elements, int input_count)
{
  ck_assert_int_eq(graph[k].failed, DVI_OK);
  kernel[k] = (dvi__kernel){&graph[k], root, elements, input_count, input[k]};
}

static dvi__function *make_function(int kernel_count)
{
  const int width[DVI__BLOCKS] = {1, n, n, 0};
  const dvi__blocks blocks = {DVI__BLOCKS, width, DVI__PAIRS, dvi__scene_pairs};
  dvi__function *function = NULL;
  ck_assert_int_eq(dvi__function_create(kernel_count, kernel, &blocks, &function), DVI_OK);
  return function;
}

static dvi__kernel_input from(const int *numbers, int offset)
{
  return (dvi__kernel_input){.block = DVI__COORDINATES, .number = numbers, .offset = offset};
}

static dvi__kernel_input along(int block, int base, int stride)
{
  return (dvi__kernel_input){.block = block, .base = base, .stride = stride};
}

static void setup(void)
{
  make_folder();
  memset(graph, 0, sizeof graph);
  n = N;
  for (int e = 0; e < ELEMENTS_MAX; e++) {
    row[0][e] = 1 + 0.1 * e;
    row[1][e] = sin(e);
  }
}

static void teardown(void)
{
  remove_folder();
}

/* --- The results of the byte code. --- */

static const char BLOCKS[DVI__BLOCKS] = {[DVI__COORDINATES] = 1, [DVI__VELOCITIES] = 1};
static const char PAIRS[DVI__PAIRS] = {[DVI__PAIR_QQ] = 1, [DVI__PAIR_QV] = 1, [DVI__PAIR_VV] = 1};

enum { KINDS = 3 }; /* value, gradient, second derivatives */

/* Numbers of points at a time: one alone, some that are no whole row, a row and more. */
static const int counts[] = {1, 6, 13};
enum { COUNTS = sizeof counts / sizeof *counts };

typedef struct results {
  int count, size[KINDS][DVI__PAIRS]; /* entries of each array (default 0, it is not wanted) */
  double number[RESULTS_MAX];
} results;

static void find_sizes(dvi__function *function, results *all)
{
  memset(all, 0, sizeof *all);
  all->size[0][0] = 1;
  for (int b = 0; b < DVI__BLOCKS; b++) all->size[1][b] = BLOCKS[b] ? n : 0;
  for (int pair = 0; pair < DVI__PAIRS; pair++) {
    if (!PAIRS[pair]) continue;
    dvi_pattern pattern;
    int full;
    ck_assert_int_eq(dvi__function_pattern(function, pair, &pattern, &full), DVI_OK);
    all->size[2][pair] = full ? n * n : pattern.start[n];
  }
}

/* Point array[] at room for the next results of `kind`. */
static void take_arrays(results *all, int kind, int count, double **array)
{
  for (int a = 0; a < DVI__PAIRS; a++) {
    array[a] = all->size[kind][a] > 0 ? all->number + all->count : NULL;
    all->count += all->size[kind][a] * count;
    ck_assert_int_le(all->count, RESULTS_MAX);
  }
}

static void evaluate(dvi__function *function, const double *const *x, results *all)
{
  double *array[DVI__PAIRS];
  find_sizes(function, all);
  for (int i = 0; i < COUNTS; i++) {
    take_arrays(all, 0, counts[i], array);
    ck_assert_int_eq(dvi__function_value(function, counts[i], x, array[0]), 0);
    take_arrays(all, 1, counts[i], array);
    ck_assert_int_eq(dvi__function_gradient(function, counts[i], x, array), 0);
    take_arrays(all, 2, counts[i], array);
    ck_assert_int_eq(dvi__function_second(function, counts[i], x, array), 0);
  }
}

/* --- The program. --- */

static const char *const names[KINDS] = {"value", "gradient", "second"};

static int write_text(const char *text, size_t size, void *user)
{
  return fwrite(text, 1, size, user) != size;
}

static void emit_call(dvi__emitter *out, const results *all, int kind, int count)
{
  int at = 0;
  dvi__emit(out, "  %s(%d, 0, x[0], x[1], 0", names[kind], count);
  for (int a = 0; a < DVI__PAIRS; a++) {
    if (kind == 0 ? a == 0 : kind == 1 ? a < DVI__BLOCKS && BLOCKS[a] : PAIRS[a])
      dvi__emit(out, all->size[kind][a] > 0 ? ", at + %d" : ", 0", at);
    at += all->size[kind][a] * count;
  }
  dvi__emit(out, ");\n  at += %d;\n", at);
}

static void emit_main(dvi__emitter *out, const results *all, const double *const *x)
{
  const int coordinates = dvi__emit_doubles(out, N * POINTS_MAX, x[1]),
            velocities = dvi__emit_doubles(out, N * POINTS_MAX, x[2]);
  dvi__emit(out,
            "#include <stdio.h>\nint main(void)\n{\n  static double number[%d];\n  double *at = "
            "number;\n",
            all->count + 1);
  dvi__emit(out, "  const double *const x[] = {dvi_row_%d, dvi_row_%d};\n", coordinates,
            velocities);
  for (int i = 0; i < COUNTS; i++)
    for (int kind = 0; kind < KINDS; kind++) emit_call(out, all, kind, counts[i]);
  dvi__emit(
      out,
      "  for (const double *y = number; y < at; y++) printf(\"%%a\\n\", *y);\n  return 0;\n}\n");
}

static void write_program(dvi__function *function, const results *all, const double *const *x)
{
  FILE *file = fopen(path_in_folder("emitted.c"), "w");
  ck_assert_ptr_nonnull(file);
  dvi__emitter out = {.write = write_text, .user = file};
  dvi__emit_begin(&out);
  ck_assert_int_eq(dvi__emit_value(&out, function, names[0]), DVI_OK);
  ck_assert_int_eq(dvi__emit_gradient(&out, function, BLOCKS, 1, names[1]), DVI_OK);
  ck_assert_int_eq(dvi__emit_second(&out, function, PAIRS, 1, names[2]), DVI_OK);
  emit_main(&out, all, x);
  ck_assert_int_eq(dvi__emit_end(&out), DVI_OK);
  ck_assert_int_eq(fclose(file), 0);
}

/* Compile and run the program and compare. */
static void check_output(const results *all)
{
  char command[1000];
  (void)snprintf(command, sizeof command,
                 "%s -std=c11 -O2 -Wall -Wextra -Wconversion -Wpedantic -Wno-unknown-pragmas "
                 "-Werror -I %s %s -o %s -lm && %s >%s",
                 DVI_C_COMPILER, DVI_HEADERS, path_in_folder("emitted.c"),
                 path_in_folder("emitted"), path_in_folder("emitted"), path_in_folder("numbers"));
  ck_assert_int_eq(system(command), 0); /* NOLINT(cert-env33-c): the compiler of the build */
  FILE *file = fopen(path_in_folder("numbers"), "r");
  ck_assert_ptr_nonnull(file);
  char line[80];
  for (int i = 0; i < all->count; i++) {
    ck_assert_ptr_nonnull(fgets(line, sizeof line, file));
    ck_assert_msg(strtod(line, NULL) == all->number[i], "number %d of %d: %s for %a", i, all->count,
                  line, all->number[i]);
  }
  (void)fclose(file);
}

/* Compares at points of this scale. The function is destroyed. */
static void check_emitted(dvi__function *function, double scale)
{
  static double q[N * POINTS_MAX], v[N * POINTS_MAX];
  static results all;
  for (int i = 0; i < N * POINTS_MAX; i++) {
    q[i] = scale * (0.5 + sin(0.7 * i));
    v[i] = cos(0.3 * i);
  }
  const double *const x[DVI__BLOCKS] = {NULL, q, v, NULL};
  evaluate(function, x, &all);
  write_program(function, &all, x);
  check_output(&all);
  dvi__function_destroy(&function);
}

/* --- Cases. --- */

/* Every operation once, at points inside of all domains. */
START_TEST(straight_lines_have_the_digits_of_the_byte_code)
{
  for (int i = 0; i < 4; i++)
    input[0][i] = along(i < 2 ? DVI__COORDINATES : DVI__VELOCITIES, 3 * i, 0);
  dvi__node x = apply(0, DVI__OP_SIN, variable(0, 0), 0), root = variable(0, 2);
  x = apply(0, DVI__OP_MULTIPLY, dvi__constant(&graph[0], 0.4), x); /* |x| < 1/2 */
  const dvi__node above = sum(0, dvi__constant(&graph[0], 1.5), x),
                  y = apply(0, DVI__OP_COS, variable(0, 3), 0);
  for (int op = DVI__OP_NEGATE; op < DVI__OP_COUNT; op++) {
    const int from_1 = op == DVI__OP_ACOSH || op == DVI__OP_LOG || op == DVI__OP_SQRT ||
                       op == DVI__OP_RAISE || op == DVI__OP_ATAN2;
    if (op != DVI__OP_POWER)
      root = sum(0, root,
                 apply(0, (dvi__op)op, from_1 ? above : x, op == DVI__OP_DIVIDE ? above : y));
  }
  for (double exponent = -3.5; exponent < 8; exponent += 0.5)
    root = sum(0, root, dvi__power(&graph[0], above, exponent));
  make_kernel(0, root, 1, 4);
  input[1][0] = along(DVI__COORDINATES, 0, 0);
  input[1][1] = along(DVI__VELOCITIES, 9, 0);
  make_kernel(1,
              apply(1, DVI__OP_MULTIPLY, dvi__power(&graph[1], variable(1, 0), 2),
                    apply(1, DVI__OP_EXP, variable(1, 1), 0)),
              1, 2);
  check_emitted(make_function(2), 1);
}
END_TEST

/* `count` bodies in the plane, with w / distance. */
static dvi__function *attraction(int count)
{
  int pairs = 0;
  for (int i = 0; i < count; i++)
    for (int j = i + 1; j < count; j++, pairs++) list[0][pairs] = 2 * i, list[1][pairs] = 2 * j;
  for (int i = 0; i < 2; i++) {
    input[0][i] = from(list[0], i);
    input[0][2 + i] = from(list[1], i);
  }
  input[0][4] = (dvi__kernel_input){.is_data = 1, .data = row[0]};
  const dvi__node r2 = sum(0, dvi__power(&graph[0], difference(0, 0, 2), 2),
                           dvi__power(&graph[0], difference(0, 1, 3), 2));
  make_kernel(0, apply(0, DVI__OP_DIVIDE, variable(0, 4), apply(0, DVI__OP_SQRT, r2, 0)), pairs, 5);
  return make_function(1);
}

/* 6 pairs are written out. 45 go by lists of entries of a pattern, or of rows and columns of a full
 * matrix. */
START_TEST(pairs_have_the_digits_of_the_byte_code)
{
  check_emitted(attraction(4), 1);
  memset(graph, 0, sizeof graph);
  check_emitted(attraction(10), 1);
  memset(graph, 0, sizeof graph);
  n = 20;
  check_emitted(attraction(10), 1);
}
END_TEST

/* Squares of such distances have fewer digits, or are beyond what the quick root takes. */
START_TEST(numbers_at_the_ends_of_the_range_are_taken_with_care)
{
  check_emitted(attraction(4), 1e153);
  memset(graph, 0, sizeof graph);
  input[0][0] = along(DVI__COORDINATES, 0, 1);
  make_kernel(0, dvi__power(&graph[0], apply(0, DVI__OP_ABS, variable(0, 0), 0), -0.5), 40, 1);
  input[1][0] = along(DVI__COORDINATES, 0, 0);
  make_kernel(1, variable(1, 0), 1, 1);
  check_emitted(make_function(2), 1e-100);
}
END_TEST

/* Springs between neighbours, whose rows follow each other, and dashpots between every other. */
START_TEST(chains_have_the_digits_of_the_byte_code)
{
  for (int i = 0; i < 2; i++) input[0][i] = along(DVI__COORDINATES, i, 1);
  make_kernel(0, dvi__power(&graph[0], difference(0, 1, 0), 4), 100, 2);
  for (int i = 0; i < 4; i++)
    input[1][i] = along(i < 2 ? DVI__COORDINATES : DVI__VELOCITIES, i % 2, 2);
  const dvi__node work = apply(1, DVI__OP_MULTIPLY, difference(1, 2, 3),
                               dvi__power(&graph[1], difference(1, 0, 1), 2));
  make_kernel(1, work, 50, 4);
  check_emitted(make_function(2), 1);
}
END_TEST

/* All elements add to one entry, always in the first kernel, and in the second one in some
 * units. */
START_TEST(sums_into_one_entry_have_the_digits_of_the_byte_code)
{
  input[0][0] = along(DVI__COORDINATES, 7, 0);
  input[0][1] = along(DVI__COORDINATES, 10, 1);
  input[0][2] = (dvi__kernel_input){.is_data = 1, .data = row[1]};
  const dvi__node sine = apply(0, DVI__OP_SIN,
                               apply(0, DVI__OP_MULTIPLY, variable(0, 0), variable(0, 1)), 0);
  make_kernel(0, apply(0, DVI__OP_MULTIPLY, variable(0, 2), sine), 70, 3);
  for (int e = 0; e < ELEMENTS_MAX; e++) list[2][e] = e < 64 ? 5 : e * 7 % N;
  input[1][0] = from(list[2], 0);
  input[1][1] = along(DVI__VELOCITIES, 0, 1);
  make_kernel(1,
              apply(1, DVI__OP_MULTIPLY, dvi__power(&graph[1], variable(1, 0), 3), variable(1, 1)),
              100, 2);
  check_emitted(make_function(2), 1);
}
END_TEST

static int refuse(const char *text, size_t size, void *user)
{
  (void)text, (void)size;
  return --*(int *)user < 0;
}

START_TEST(a_writer_that_refuses_ends_it)
{
  dvi__function *function = attraction(4);
  int left = 20;
  dvi__emitter out = {.write = refuse, .user = &left};
  dvi__emit_begin(&out);
  ck_assert_int_eq(dvi__emit_second(&out, function, PAIRS, 1, "second"), DVI_IO_ERROR);
  ck_assert_int_eq(left, -1);
  ck_assert_int_eq(dvi__emit_end(&out), DVI_IO_ERROR);
  dvi__function_destroy(&function);
}
END_TEST

SUITE(emit)
{
  tcase_add_checked_fixture(tests, setup, teardown);
  tcase_add_test(tests, straight_lines_have_the_digits_of_the_byte_code);
  tcase_add_test(tests, pairs_have_the_digits_of_the_byte_code);
  tcase_add_test(tests, numbers_at_the_ends_of_the_range_are_taken_with_care);
  tcase_add_test(tests, chains_have_the_digits_of_the_byte_code);
  tcase_add_test(tests, sums_into_one_entry_have_the_digits_of_the_byte_code);
  tcase_add_test(tests, a_writer_that_refuses_ends_it);
}
