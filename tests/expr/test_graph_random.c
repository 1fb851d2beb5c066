/* labels: jacobian slow */
/* Random expressions against an independent judge, which evaluates the expression as it was drawn
 * in quadruple precision without any simplification, and its central differences. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "expr/graph.h"
#include "expr/graph_make.h"
#include "text/heap.h"
#include "support/quad/quad_graph.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH

enum { EXPRESSIONS = 10000, INPUTS = 3, DEPTH = 6, PARTS_MAX = 128 };

/* Values stay between these in size, so that no expression is ill conditioned by itself. */
static const double SMALLEST = 0.05, LARGEST = 50;

/* A part as it was drawn. `error` bounds the effect of rounding to double on its value. */
typedef struct part {
  dvi__op op;
  int a, b;
  double number; /* of a constant, a power */
  quad value, error;
} part;

typedef struct expression {
  int count;
  part part[PARTS_MAX];
  quad x[INPUTS];
} expression;

static uint64_t random_bits(uint64_t *seed)
{
  *seed += UINT64_C(0x9e3779b97f4a7c15); /* splitmix64 */
  uint64_t z = *seed;
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

static int random_below(uint64_t *seed, int count)
{
  return (int)(random_bits(seed) % (uint64_t)count);
}

/* Returns 1 if an operation is smooth at its operands, with room around them. */
static int is_inside(dvi__op op, double number, quad a, quad b)
{
  switch (op) {
  case DVI__OP_SQRT:
  case DVI__OP_LOG:
  case DVI__OP_RAISE: return a > (quad)SMALLEST;
  case DVI__OP_POWER: return a > (quad)SMALLEST || (number == floor(number) && a < -(quad)SMALLEST);
  case DVI__OP_ASIN:
  case DVI__OP_ACOS:
  case DVI__OP_ATANH: return fabsq(a) < (quad)0.9;
  case DVI__OP_ACOSH: return a > (quad)1.1;
  case DVI__OP_ABS:
  case DVI__OP_POSITIVE:
  case DVI__OP_WHERE:
  case DVI__OP_SIGN: return fabsq(a) > (quad)SMALLEST;
  case DVI__OP_FLOOR: return a - floorq(a) > (quad)SMALLEST && floorq(a) + 1 - a > (quad)SMALLEST;
  case DVI__OP_DIVIDE: return fabsq(b) > (quad)SMALLEST;
  case DVI__OP_ATAN2: return b > (quad)SMALLEST || fabsq(a) > (quad)SMALLEST;
  case DVI__OP_HYPOT: return fabsq(a) > (quad)SMALLEST || fabsq(b) > (quad)SMALLEST;
  default: return 1;
  }
}

/* Bounds the effect of the operands' errors on the value, with room for libm. */
static quad error_of(const part *all, const part *own)
{
  const part *a = all + own->a, *b = all + own->b;
  return dvi__operands(own->op) == 0 ? 0
                                     : quad_error(own->op, own->number, a->value, a->error,
                                                  b->value, b->error, 2 * (quad)DBL_EPSILON);
}

/* Draws an operation for these operands until one is inside of its domain with a value of a
 * moderate size. Sums and sines always are. */
static part draw(uint64_t *seed, const expression *e, int a, int b)
{
  static const double exponents[] = {-3, -2.5, -2, -1.5, -1, -0.5, 0.5, 1.5, 2, 2.5, 3, 4, 5, 7};
  for (int tries = 0; tries < 20; tries++) {
    part own = {
        .op = (dvi__op)(DVI__OP_NEGATE + random_below(seed, DVI__OP_COUNT - DVI__OP_NEGATE)),
        .a = a,
        .b = b};
    if (own.op == DVI__OP_POWER)
      own.number = exponents[random_below(seed, (int)(sizeof exponents / sizeof *exponents))];
    const quad x = e->part[a].value, y = e->part[b].value;
    if (!is_inside(own.op, own.number, x, y)) continue;
    own.value = quad_operate(own.op, own.number, x, y);
    if (fabsq(own.value) < (quad)LARGEST) return own;
  }
  return (part){.op = DVI__OP_SIN, .a = a, .b = a, .value = sinq(e->part[a].value)};
}

/* Draws a leaf, mostly an input. Small whole numbers are common, so that rules for them are
 * used. */
static part draw_leaf(uint64_t *seed, const expression *e)
{
  const int kind = random_below(seed, 6), number = random_below(seed, INPUTS);
  if (kind > 1) return (part){.op = DVI__OP_INPUT, .a = number, .value = e->x[number]};
  const double value = kind == 0 ? random_below(seed, 6) - 2 : 0.1 * (random_below(seed, 41) - 20);
  return (part){.op = DVI__OP_CONSTANT, .number = value, .value = (quad)value};
}

/* Fills a random tree. Parts are joined from the leaves on, and now and then one is used twice. */
static void draw_expression(uint64_t *seed, expression *e)
{
  const int depth = random_below(seed, DEPTH + 1);
  int open[1 << DEPTH];
  e->count = 0;
  for (int i = 0; i < INPUTS; i++) e->x[i] = (quad)(0.001 * (random_below(seed, 4000) - 2000));
  for (int i = 0; i < 1 << depth; i++) {
    open[i] = e->count;
    e->part[e->count++] = draw_leaf(seed, e);
  }
  for (int width = 1 << depth; width > 1; width /= 2)
    for (int i = 0; i < width / 2; i++) {
      const int a = open[2 * i], b = random_below(seed, 8) == 0 ? a : open[2 * i + 1];
      part own = draw(seed, e, a, b);
      own.error = error_of(e->part, &own);
      open[i] = e->count;
      e->part[e->count++] = own;
    }
}

static dvi__node build_expression(dvi__graph *graph, const expression *e)
{
  dvi__node node[PARTS_MAX] = {0};
  for (int i = 0; i < e->count; i++) {
    const part *own = e->part + i;
    if (own->op == DVI__OP_CONSTANT)
      node[i] = dvi__constant(graph, own->number);
    else if (own->op == DVI__OP_INPUT)
      node[i] = dvi__input(graph, own->a);
    else if (own->op == DVI__OP_POWER)
      node[i] = dvi__power(graph, node[own->a], own->number);
    else
      node[i] = dvi__apply(graph, own->op, node[own->a], node[own->b]);
  }
  return node[e->count - 1];
}

/* The value of the expression as it was drawn. */
static quad value_at(const expression *e, const quad *x)
{
  quad value[PARTS_MAX];
  for (int i = 0; i < e->count; i++) {
    const part *own = e->part + i;
    const int operands = dvi__operands(own->op);
    if (own->op == DVI__OP_INPUT)
      value[i] = x[own->a];
    else
      value[i] = quad_operate(own->op, own->number, operands > 0 ? value[own->a] : 0,
                              operands > 1 ? value[own->b] : 0);
  }
  return value[e->count - 1];
}

/* With this step central differences of moderate functions are right to 1e-18 at least. */
static const quad STEP = (quad)1e-10;

static quad first_difference(const expression *e, int i)
{
  quad x[INPUTS];
  for (int k = 0; k < INPUTS; k++) x[k] = e->x[k];
  x[i] = e->x[i] + STEP;
  const quad after = value_at(e, x);
  x[i] = e->x[i] - STEP;
  return (after - value_at(e, x)) / (2 * STEP);
}

static quad second_difference_of(const expression *e, int i, int j, quad h)
{
  quad sum = 0;
  for (int corner = 0; corner < 4; corner++) {
    quad x[INPUTS];
    for (int k = 0; k < INPUTS; k++) x[k] = e->x[k];
    x[i] += corner & 1 ? h : -h;
    x[j] += corner & 2 ? h : -h;
    sum += (corner == 0 || corner == 3 ? 1 : -1) * value_at(e, x);
  }
  return sum / (4 * h * h);
}

/* Takes a second difference from values. The step is longer, because the difference is divided by
 * its square, and the result is extrapolated, because the step is long for functions of large
 * derivatives. */
static quad second_difference(const expression *e, int i, int j)
{
  const quad h = (quad)1e-9;
  return (4 * second_difference_of(e, i, j, h / 2) - second_difference_of(e, i, j, h)) / 3;
}

static double largest(int count, const quad *x)
{
  quad result = 0;
  for (int i = 0; i < count; i++) result = fmaxq(result, fabsq(x[i]));
  return (double)result;
}

/* Entries against the judge's, relative to the largest. Constants are folded in double precision,
 * hence not 1e-16. */
static void check_close(int count, const quad *entry, const quad *judge, uint64_t seed)
{
  const double scale = largest(count, judge);
  for (int i = 0; i < count; i++)
    ck_assert_msg(fabsq(entry[i] - judge[i]) <= (quad)(1e-10 * scale + 1e-14),
                  "seed %llu, entry %d: %.17g, by differences %.17g", (unsigned long long)seed, i,
                  (double)entry[i], (double)judge[i]);
}

START_TEST(simplified_values_are_those_of_what_was_written)
{
  double worst = 0;
  for (uint64_t seed = 0; seed < EXPRESSIONS; seed++) {
    uint64_t state = seed;
    expression e;
    draw_expression(&state, &e);
    dvi__graph graph = {0};
    const dvi__node root = build_expression(&graph, &e);
    double x[INPUTS], value;
    for (int i = 0; i < INPUTS; i++) x[i] = (double)e.x[i];
    dvi__node not_finite;
    ck_assert_int_eq(dvi__evaluate(&graph, x, 1, &root, &value, &not_finite), DVI_OK);
    const part *last = e.part + e.count - 1;
    const double allowed = (double)(2 * last->error + 8 * (quad)DBL_EPSILON * fabsq(last->value));
    const double error = (double)fabsq((quad)value - last->value);
    ck_assert_msg(error <= allowed, "seed %llu: %.17g for %.17g, error %.2g > %.2g",
                  (unsigned long long)seed, value, (double)last->value, error, allowed);
    ck_assert_int_eq(not_finite, -1);
    if (allowed > 0) worst = fmax(worst, error / allowed);
    dvi__graph_free(&graph);
  }
  printf("simplified values: %.2f of what is allowed\n", worst);
}
END_TEST

/* First and second derivatives of the graph at the point, evaluated in quadruple precision. */
static void differentiate(dvi__graph *graph, const expression *e, dvi__node root, quad *first,
                          quad *second)
{
  dvi__node gradient[INPUTS], hessian[INPUTS][INPUTS];
  dvi__gradient(graph, root, INPUTS, gradient);
  for (int j = 0; j < INPUTS; j++) dvi__tangents(graph, j, INPUTS, gradient, hessian[j]);
  ck_assert_int_eq(graph->failed, DVI_OK);
  quad *value = calloc((size_t)graph->count, sizeof *value);
  ck_assert_ptr_nonnull(value);
  quad_evaluate(graph, graph->count, e->x, value, NULL, 0);
  for (int i = 0; i < INPUTS; i++) {
    first[i] = value[gradient[i]];
    for (int j = 0; j < INPUTS; j++) second[INPUTS * j + i] = value[hessian[j][i]];
  }
  free(value);
}

START_TEST(derivatives_are_those_of_differences)
{
  for (uint64_t seed = 0; seed < EXPRESSIONS; seed++) {
    uint64_t state = seed;
    expression e;
    draw_expression(&state, &e);
    dvi__graph graph = {0};
    const dvi__node root = build_expression(&graph, &e);
    quad first[INPUTS], second[INPUTS * INPUTS], judge[INPUTS * INPUTS];
    differentiate(&graph, &e, root, first, second);
    for (int i = 0; i < INPUTS; i++) judge[i] = first_difference(&e, i);
    check_close(INPUTS, first, judge, seed);
    for (int i = 0; i < INPUTS * INPUTS; i++)
      judge[i] = second_difference(&e, i % INPUTS, i / INPUTS);
    check_close(INPUTS * INPUTS, second, judge, seed);
    dvi__graph_free(&graph);
  }
}
END_TEST

START_TEST(patterns_hold_all_second_derivatives_but_zeros)
{
  for (uint64_t seed = 0; seed < EXPRESSIONS; seed++) {
    uint64_t state = seed;
    expression e;
    draw_expression(&state, &e);
    dvi__graph graph = {0};
    const dvi__node root = build_expression(&graph, &e);
    int(*pair)[2], count, inside[INPUTS][INPUTS] = {{0}};
    ck_assert_int_eq(dvi__second_pattern(&graph, root, INPUTS, &pair, &count), DVI_OK);
    for (int k = 0; k < count; k++)
      inside[pair[k][0]][pair[k][1]] = inside[pair[k][1]][pair[k][0]] = 1;
    dvi__heap_free(pair);
    quad first[INPUTS], second[INPUTS * INPUTS];
    differentiate(&graph, &e, root, first, second);
    for (int i = 0; i < INPUTS; i++)
      for (int j = 0; j < INPUTS; j++) ck_assert(inside[i][j] || second[INPUTS * j + i] == 0);
    dvi__graph_free(&graph);
  }
}
END_TEST
#endif

SUITE(graph_random)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, simplified_values_are_those_of_what_was_written);
  tcase_add_test(tests, derivatives_are_those_of_differences);
  tcase_add_test(tests, patterns_hold_all_second_derivatives_but_zeros);
#else
  (void)tests;
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
}
