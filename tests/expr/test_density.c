/* labels: jacobian */
/* Functions of many blocks, as densities of fields are: the value, the gradient and all blocks of
 * second derivatives of a density of two fields, against quadruple precision and differences. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expr/function/function_quad.h"
#include "support/quad/quad_real.h"
#include "support/suite.h"

/* The place, parameters, a field u of two components and a field w, and their derivatives. */
enum { X, PAR, U, U_T, U_X, U_Y, W, W_T, W_X, W_Y, BLOCKS };
enum { PAIRS = BLOCKS * BLOCKS, VARIABLES = 17, POINTS = 5 };
static const int width[BLOCKS] = {2, 3, 2, 2, 2, 2, 1, 1, 1, 1};

/* Block b begins with this one of all variables. */
static int first_of(int b)
{
  int first = 0;
  for (int k = 0; k < b; k++) first += width[k];
  return first;
}

/* --- The density, on paper. --- */

static quad density(const quad *z)
{
  static const double weight[2] = {1.0, 3.0};
  const quad *x = z + first_of(X), *par = z + first_of(PAR), *u = z + first_of(U);
  const quad *u_t = z + first_of(U_T), *u_x = z + first_of(U_X), *u_y = z + first_of(U_Y);
  const quad w = z[first_of(W)], w_t = z[first_of(W_T)];
  const quad w_x = z[first_of(W_X)], w_y = z[first_of(W_Y)];
  const quad div = u_x[0] + u_y[1], c = par[0], kappa = par[1], mu = par[2];
  quad L = -div * div / 4;
  for (int i = 0; i < 2; i++) {
    L += weight[i] * (1 + x[0] * x[1] / 4) * u_t[i] * u_t[i] / 2;
    L -= mu * (u_x[i] * u_x[i] + u_y[i] * u_y[i]) / 2;
  }
  L += w_t * w_t / 2 - c * c * quad_sqrt(1 + w_x * w_x + w_y * w_y);
  return L - kappa * w * (u[0] * u[0] + u[1] * u[1]) * quad_sin(x[0] + 2 * x[1]) - quad_exp(-w * w);
}

/* Gives the derivative by variable i of the density, or of its derivative by variable `of` (-1 for
 * the density itself), by differences of order 4. Their own error is at most 1e-20 at this step. */
static quad derivative(const quad *at, int of, int i)
{
  static const int place[4] = {-2, -1, 1, 2};
  static const double factor[4] = {1, -8, 8, -1};
  const quad step = (quad)1 / 131072;
  quad z[VARIABLES], sum = 0;
  memcpy(z, at, sizeof z);
  for (int k = 0; k < 4; k++) {
    z[i] = at[i] + place[k] * step;
    sum += factor[k] * (of < 0 ? density(z) : derivative(z, -1, of));
  }
  return sum / (12 * step);
}

/* --- The density, as kernels. --- */

typedef struct drawing {
  dvi__graph graph[2];
  dvi__kernel_input input[2][VARIABLES];
  int count[2];
} drawing;

/* The node of variable i of a block, `stride` further on for each element. */
static dvi__node variable(drawing *d, int k, int block, int i, int stride)
{
  const int n = d->count[k]++;
  d->input[k][n] = (dvi__kernel_input){.block = block, .base = i, .stride = stride};
  return dvi__input(&d->graph[k], n);
}

static dvi__node add(drawing *d, int k, dvi__node a, dvi__node b)
{
  return dvi__apply(&d->graph[k], DVI__OP_ADD, a, b);
}

static dvi__node times(drawing *d, int k, dvi__node a, dvi__node b)
{
  return dvi__apply(&d->graph[k], DVI__OP_MULTIPLY, a, b);
}

static dvi__node square(drawing *d, int k, dvi__node a)
{
  return dvi__apply(&d->graph[k], DVI__OP_SQUARE, a, 0);
}

static dvi__node scaled(drawing *d, int k, double factor, dvi__node a)
{
  return times(d, k, dvi__constant(&d->graph[k], factor), a);
}

/* weight (1 + x y/4) u_t^2/2 - mu (u_x^2 + u_y^2)/2, summed over the components of u. */
static dvi__node draw_components(drawing *d, const double *weight)
{
  const dvi__node x = variable(d, 0, X, 0, 0), y = variable(d, 0, X, 1, 0);
  const dvi__node mu = variable(d, 0, PAR, 2, 0), u_t = variable(d, 0, U_T, 0, 1);
  const dvi__node u_x = variable(d, 0, U_X, 0, 1), u_y = variable(d, 0, U_Y, 0, 1);
  const dvi__node one = dvi__constant(&d->graph[0], 1.0);
  const int n = d->count[0]++;
  d->input[0][n] = (dvi__kernel_input){.is_data = 1, .data = weight};
  const dvi__node mass = times(d, 0, dvi__input(&d->graph[0], n),
                               add(d, 0, one, scaled(d, 0, 0.25, times(d, 0, x, y))));
  const dvi__node strain = add(d, 0, square(d, 0, u_x), square(d, 0, u_y));
  return add(d, 0, scaled(d, 0, 0.5, times(d, 0, mass, square(d, 0, u_t))),
             scaled(d, 0, -0.5, times(d, 0, mu, strain)));
}

static dvi__node draw_rest(drawing *d)
{
  dvi__graph *graph = &d->graph[1];
  const dvi__node x = variable(d, 1, X, 0, 0), y = variable(d, 1, X, 1, 0);
  const dvi__node c = variable(d, 1, PAR, 0, 0), kappa = variable(d, 1, PAR, 1, 0);
  const dvi__node u0 = variable(d, 1, U, 0, 0), u1 = variable(d, 1, U, 1, 0);
  const dvi__node div = add(d, 1, variable(d, 1, U_X, 0, 0), variable(d, 1, U_Y, 1, 0));
  const dvi__node w = variable(d, 1, W, 0, 0), w_t = variable(d, 1, W_T, 0, 0);
  const dvi__node w_x = variable(d, 1, W_X, 0, 0), w_y = variable(d, 1, W_Y, 0, 0);
  const dvi__node slope = add(d, 1, square(d, 1, w_x), square(d, 1, w_y));
  const dvi__node area = dvi__apply(graph, DVI__OP_SQRT,
                                    add(d, 1, dvi__constant(graph, 1.0), slope), 0);
  const dvi__node u_u = add(d, 1, square(d, 1, u0), square(d, 1, u1));
  const dvi__node phase = dvi__apply(graph, DVI__OP_SIN, add(d, 1, x, scaled(d, 1, 2.0, y)), 0);
  const dvi__node coupling = times(d, 1, times(d, 1, kappa, w), times(d, 1, u_u, phase));
  const dvi__node well = dvi__apply(graph, DVI__OP_EXP, scaled(d, 1, -1.0, square(d, 1, w)), 0);
  dvi__node L = add(d, 1, scaled(d, 1, -0.25, square(d, 1, div)),
                    scaled(d, 1, 0.5, square(d, 1, w_t)));
  L = dvi__apply(graph, DVI__OP_SUBTRACT, L, times(d, 1, square(d, 1, c), area));
  L = dvi__apply(graph, DVI__OP_SUBTRACT, L, coupling);
  return dvi__apply(graph, DVI__OP_SUBTRACT, L, well);
}

/* Makes a density with second derivatives of all ordered pairs. Pair BLOCKS*b + c has the rows of
 * block b. */
static dvi__function *draw(drawing *d)
{
  static const double weight[2] = {1.0, 3.0};
  dvi__block_pair pair[PAIRS];
  const dvi__blocks blocks = {BLOCKS, width, PAIRS, pair};
  dvi__function *function = NULL;
  memset(d, 0, sizeof *d);
  for (int p = 0; p < PAIRS; p++) pair[p] = (dvi__block_pair){p / BLOCKS, p % BLOCKS};
  const dvi__node root[2] = {draw_components(d, weight), draw_rest(d)};
  const dvi__kernel kernel[2] = {{&d->graph[0], root[0], 2, d->count[0], d->input[0]},
                                 {&d->graph[1], root[1], 1, d->count[1], d->input[1]}};
  ck_assert_int_eq(dvi__function_create(2, kernel, &blocks, &function), DVI_OK);
  return function;
}

/* --- Points. --- */

/* Variable i at point k. */
static double coordinate(int i, int k)
{
  return sin(1.3 * i + 0.7 * k * k + 0.2) + 0.1 * k;
}

/* Blocks of a batch, in `room` [VARIABLES * POINTS]. */
static void lay_out(double *room, const double **x)
{
  for (int b = 0; b < BLOCKS; b++) {
    double *block = room + first_of(b) * POINTS;
    x[b] = block;
    for (int i = 0; i < width[b]; i++)
      for (int k = 0; k < POINTS; k++) block[i * POINTS + k] = coordinate(first_of(b) + i, k);
  }
}

static void point_at(int k, quad *z)
{
  for (int i = 0; i < VARIABLES; i++) z[i] = coordinate(i, k);
}

/* Some thirty operations on terms of size 10 and less, each rounded once. */
static void check_near(double found, quad expected)
{
  ck_assert_double_le(fabs((double)(found - expected)), 1e-14 * (1 + fabs((double)expected)));
}

/* --- Tests. --- */

START_TEST(the_value_and_the_gradient_have_the_digits_of_a_double)
{
  drawing d;
  dvi__function *function = draw(&d);
  double room[VARIABLES * POINTS], value[POINTS], by[VARIABLES * POINTS], *gradient[BLOCKS];
  const double *x[BLOCKS];
  lay_out(room, x);
  for (int b = 0; b < BLOCKS; b++) gradient[b] = by + first_of(b) * POINTS;
  ck_assert_int_eq(dvi__function_value(function, POINTS, x, value), 0);
  ck_assert_int_eq(dvi__function_gradient(function, POINTS, x, gradient), 0);
  for (int k = 0; k < POINTS; k++) {
    quad z[VARIABLES];
    point_at(k, z);
    check_near(value[k], density(z));
    for (int i = 0; i < VARIABLES; i++) check_near(by[i * POINTS + k], derivative(z, -1, i));
  }
  dvi__function_destroy(&function);
}
END_TEST

/* Gives entry (row, column) of a pair at point k, or 0 where there is none. */
static double entry_at(const dvi_pattern *pattern, int full, const double *values, int rows,
                       int row, int column, int k)
{
  if (full) return values[(column * rows + row) * POINTS + k];
  for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
    if (pattern->row[e] == row) return values[e * POINTS + k];
  return 0;
}

/* Returns 1 if the density has second derivatives by variables i and j. */
static int depends(int i, int j)
{
  quad most = 0;
  for (int k = 0; k < POINTS; k++) {
    quad z[VARIABLES];
    point_at(k, z);
    const quad second = derivative(z, i, j);
    most = quad_abs(second) > most ? quad_abs(second) : most;
  }
  return most > 1e-15;
}

START_TEST(every_block_of_second_derivatives_is_right_and_has_a_pattern)
{
  drawing d;
  dvi__function *function = draw(&d);
  const int rows_of = _i / BLOCKS, columns_of = _i % BLOCKS, rows = width[rows_of];
  double room[VARIABLES * POINTS], entry[9 * POINTS], *values[PAIRS] = {[0] = NULL};
  const double *x[BLOCKS];
  dvi_pattern pattern;
  int full;
  lay_out(room, x);
  values[_i] = entry;
  ck_assert_int_eq(dvi__function_pattern(function, _i, &pattern, &full), DVI_OK);
  ck_assert_int_eq(dvi__function_second(function, POINTS, x, values), 0);
  int entries = 0;
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < width[columns_of]; column++) {
      const int i = first_of(rows_of) + row, j = first_of(columns_of) + column;
      entries += depends(i, j);
      for (int k = 0; k < POINTS; k++) {
        quad z[VARIABLES];
        point_at(k, z);
        check_near(entry_at(&pattern, full, entry, rows, row, column, k), derivative(z, i, j));
      }
    }
  if (!full) ck_assert_int_eq(pattern.start[width[columns_of]], entries);
  if (full) ck_assert_int_gt(2 * entries, rows * width[columns_of]);
  dvi__function_destroy(&function);
}
END_TEST

START_TEST(what_is_asked_for_alone_has_the_same_bits)
{
  static const int asked[3] = {W_X * BLOCKS + W_Y, U * BLOCKS + X, PAR * BLOCKS + W};
  drawing d;
  dvi__function *function = draw(&d);
  double room[VARIABLES * POINTS], all[VARIABLES * POINTS], alone[VARIABLES * POINTS];
  double together[3][9 * POINTS] = {{0}}, single[9 * POINTS] = {0};
  const double *x[BLOCKS];
  double *gradient[BLOCKS], *values[PAIRS] = {[0] = NULL};
  lay_out(room, x);
  for (int b = 0; b < BLOCKS; b++) gradient[b] = all + first_of(b) * POINTS;
  ck_assert_int_eq(dvi__function_gradient(function, POINTS, x, gradient), 0);
  for (int a = 0; a < 3; a++) values[asked[a]] = together[a];
  ck_assert_int_eq(dvi__function_second(function, POINTS, x, values), 0);
  for (int b = 0; b < BLOCKS; b++) {
    double *only[BLOCKS] = {[0] = NULL};
    only[b] = alone;
    ck_assert_int_eq(dvi__function_gradient(function, POINTS, x, only), 0);
    ck_assert_mem_eq(alone, gradient[b], (size_t)(width[b] * POINTS) * sizeof *alone);
  }
  for (int a = 0; a < 3; a++) {
    double *only[PAIRS] = {[0] = NULL};
    only[asked[a]] = single;
    memset(single, 0, sizeof single);
    ck_assert_int_eq(dvi__function_second(function, POINTS, x, only), 0);
    ck_assert_mem_eq(single, together[a], sizeof single);
  }
  dvi__function_destroy(&function);
}
END_TEST

START_TEST(constant_second_derivatives_are_known)
{
  drawing d;
  dvi__function *function = draw(&d);
  ck_assert_int_eq(dvi__function_second_constant(function, U_X * BLOCKS + U_Y), 1); /* -1/2 */
  ck_assert_int_eq(dvi__function_second_constant(function, W_T * BLOCKS + W_T), 1);
  ck_assert_int_eq(dvi__function_second_constant(function, U_T * BLOCKS + W), 1); /* none */
  ck_assert_int_eq(dvi__function_second_constant(function, U_T * BLOCKS + U_T), 0);
  ck_assert_int_eq(dvi__function_second_constant(function, W_X * BLOCKS + W_Y), 0);
  dvi__function_destroy(&function);
}
END_TEST

START_TEST(quadruple_precision_has_its_own_digits)
{
  drawing d;
  dvi__function *function = draw(&d);
  quad z[VARIABLES], by[VARIABLES] = {0}, value = 0, *x[BLOCKS], *gradient[BLOCKS];
  point_at(1, z);
  for (int b = 0; b < BLOCKS; b++) {
    x[b] = z + first_of(b);
    gradient[b] = by + first_of(b);
  }
  gradient[PAR] = NULL; /* not wanted */
  ck_assert_int_eq(dvi__function_quad_add(function, 2, x, &value, gradient), DVI_OK);
  ck_assert_double_le((double)quad_abs(value - 2 * density(z)), 1e-31);
  for (int i = 0; i < VARIABLES; i++) {
    const quad expected = i >= first_of(PAR) && i < first_of(U) ? 0 : 2 * derivative(z, -1, i);
    ck_assert_double_le((double)quad_abs(by[i] - expected), 1e-19);
  }
  dvi__function_destroy(&function);
}
END_TEST

/* Along a line the first coefficient is the gradient times the direction. */
START_TEST(series_of_all_blocks_begin_with_the_value_and_the_slope)
{
  enum { DEGREE = 2, COUNT = DEGREE + 1 };
  drawing d;
  dvi__function *function = draw(&d);
  double curve[VARIABLES * COUNT] = {0}, value[COUNT];
  const double *x[BLOCKS];
  quad z[VARIABLES], slope = 0;
  point_at(2, z);
  for (int b = 0; b < BLOCKS; b++) {
    x[b] = curve + first_of(b) * COUNT;
    for (int i = 0; i < width[b]; i++) {
      const int v = first_of(b) + i;
      curve[first_of(b) * COUNT + i] = coordinate(v, 2);
      curve[first_of(b) * COUNT + width[b] + i] = 0.5 - 0.1 * v;
      slope += (0.5 - 0.1 * v) * derivative(z, -1, v);
    }
  }
  ck_assert_int_eq(dvi__function_series(function, DEGREE, x, value, NULL, NULL), 0);
  check_near(value[0], density(z));
  check_near(value[1], slope);
  dvi__function_destroy(&function);
}
END_TEST

/* More blocks and pairs than a word has bits, in the sum over b of (b + 1) x_b x_(b+1). */
enum { MANY = 70 };

static dvi__function *chain_of_blocks(dvi__graph *graph, dvi__kernel_input *input)
{
  static int one[MANY];
  static dvi__block_pair pair[MANY - 1];
  const dvi__blocks blocks = {MANY, one, MANY - 1, pair};
  dvi__function *function = NULL;
  dvi__node root = dvi__constant(graph, 0.0);
  for (int b = 0; b < MANY; b++) {
    one[b] = 1;
    input[b] = (dvi__kernel_input){.block = b};
    if (b == 0) continue;
    pair[b - 1] = (dvi__block_pair){b, b - 1};
    const dvi__node product = dvi__apply(graph, DVI__OP_MULTIPLY, dvi__input(graph, b - 1),
                                         dvi__input(graph, b));
    root = dvi__apply(
        graph, DVI__OP_ADD, root,
        dvi__apply(graph, DVI__OP_MULTIPLY, dvi__constant(graph, (double)b), product));
  }
  const dvi__kernel kernel = {graph, root, 1, MANY, input};
  ck_assert_int_eq(dvi__function_create(1, &kernel, &blocks, &function), DVI_OK);
  return function;
}

START_TEST(blocks_may_be_more_than_a_word_has_bits)
{
  dvi__graph graph = {0};
  dvi__kernel_input input[MANY];
  dvi__function *function = chain_of_blocks(&graph, input);
  double at[MANY], by = 0.0, second = 0.0;
  const double *x[MANY];
  for (int b = 0; b < MANY; b++) {
    at[b] = 1.0 + b;
    x[b] = &at[b];
  }
  for (int b = 1; b < MANY - 1; b++) {
    double *gradient[MANY] = {[0] = NULL}, *values[MANY - 1] = {[0] = NULL};
    gradient[b] = &by;
    values[b - 1] = &second;
    ck_assert_int_eq(dvi__function_gradient(function, 1, x, gradient), 0);
    ck_assert_int_eq(dvi__function_second(function, 1, x, values), 0);
    ck_assert_double_eq(by, b * at[b - 1] + (b + 1) * at[b + 1]);
    ck_assert_double_eq(second, b);
  }
  dvi__function_destroy(&function);
}
END_TEST

SUITE(density)
{
  tcase_add_test(tests, the_value_and_the_gradient_have_the_digits_of_a_double);
  tcase_add_loop_test(tests, every_block_of_second_derivatives_is_right_and_has_a_pattern, 0,
                      PAIRS);
  tcase_add_test(tests, what_is_asked_for_alone_has_the_same_bits);
  tcase_add_test(tests, constant_second_derivatives_are_known);
  tcase_add_test(tests, quadruple_precision_has_its_own_digits);
  tcase_add_test(tests, series_of_all_blocks_begin_with_the_value_and_the_slope);
  tcase_add_test(tests, blocks_may_be_more_than_a_word_has_bits);
}
