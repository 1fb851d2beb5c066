/* labels: invariant */
/* Any expression has derivatives that are those of differences, in quadruple precision, and a
 * program that computes them up to rounding.
 *
 * A text is an expression behind its operands, letter by letter: xyz are inputs, digits constants;
 * letters that want more operands than there are do nothing. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "expr/function/function.h"
#include "expr/graph_make.h"
#include "text/heap.h"
#include "support/scene/fuzz.h"
#include "support/quad/quad_graph.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH
enum { INPUTS = 3, POINTS = 3, JUDGED = 2, NODES_MAX = 6000, LETTERS_MAX = 200, OPEN_MAX = 32 };

static const char *const corpus[] = {"xx*yy*+r1~/",      "xyz**e xS+", "x2-a yC l* zT/",
                                     "xy@ xyh+",         "xsys+p3",    "x1+l y^ zt*",
                                     "xi yo- znN+ zI*",  "x?xr:",      "y?yl: x2-?yr:+ xf*",
                                     "xy-dd?:~1x?-:+p3", NULL};
static const char *const tokens[] = {
    "x", "y", "z", "_", "xs", "xsys+", "1x/", "p0", "p1",   "p5", "r", "e", "l", "S", "C", "T",
    "i", "o", "t", "k", "H",  "n",     "I",   "O",  "N",    "a",  "g", "+", "-", "*", "/", "^",
    "@", "h", "d", "~", "f",  "?",     ":",   "x?", "xy-?", "0",  "1", "2", "3", "8", "9", NULL};

/* At the last point only the end is checked, because numbers there are zero, or at the end of their
 * range. */
static const double point[POINTS][INPUTS] = {
    {0.7, -1.3, 0.4}, {2.25, 0.31, -0.6}, {0, 1e-200, 1e200}};

/* An expression with its derivatives as nodes: value, gradient, Hessian by columns. */
enum { ROOTS = 1 + INPUTS + INPUTS * INPUTS, GRADIENT = 1, HESSIAN = 1 + INPUTS };
static dvi__graph graph;
static dvi__node root[ROOTS];

/* --- Reading. --- */

static dvi__op op_of(char letter)
{
  static const char letters[] =
      ".._s.relSCTiotkHnIONag+-*/^@hf?:"; /* in the order of the operations */
  const char *found = letter == '.' || letter == '\0' ? NULL : strchr(letters, letter);
  return found == NULL ? DVI__OP_COUNT : (dvi__op)(found - letters);
}

/* Makes a condition, 0 or 1, of a node, unless it is one: only these stand before WHERE. */
static dvi__node condition(dvi__node a)
{
  const dvi__graph_node *node = graph.node + a;
  const int is_not = node->op == DVI__OP_SUBTRACT && graph.node[node->a].op == DVI__OP_CONSTANT &&
                     !(graph.node[node->a].value < 1 || graph.node[node->a].value > 1) &&
                     graph.node[node->b].op == DVI__OP_POSITIVE;
  return node->op == DVI__OP_POSITIVE || is_not ? a : dvi__apply(&graph, DVI__OP_POSITIVE, a, 0);
}

/* Takes a letter, and returns the number of open nodes. */
static int take_operation(char letter, char next, dvi__node *open, int count)
{
  static const double constants[] = {0, 1, 2, 0.5, -1, 3, -2.5, 1e-3, 1e150, 1e-310};
  static const double exponents[] = {-2, 1.5, -0.5, -1.5, 3, 7, -3, 0.3, 33, 2.5};
  const dvi__op op = op_of(letter);
  if (letter >= 'x' && letter <= 'z') open[count++] = dvi__input(&graph, letter - 'x');
  if (letter >= '0' && letter <= '9')
    open[count++] = dvi__constant(&graph, constants[letter - '0']);
  if (letter == 'd' && count > 0) {
    open[count] = open[count - 1];
    count++;
  }
  if (letter == 'p' && count > 0)
    open[count - 1] = dvi__power(&graph, open[count - 1], exponents[(unsigned char)next % 10]);
  if (letter == '~' && count > 1) {
    const dvi__node last = open[count - 1];
    open[count - 1] = open[count - 2];
    open[count - 2] = last;
  }
  if (op == DVI__OP_COUNT || count < dvi__operands(op)) return count;
  if (dvi__operands(op) == 2) count--;
  if (op == DVI__OP_WHERE) open[count - 1] = condition(open[count - 1]);
  open[count - 1] = dvi__apply(&graph, op, open[count - 1], open[count]);
  return count;
}

/* Open nodes are added. */
static dvi__node read_expression(const char *text, size_t size)
{
  dvi__node open[OPEN_MAX + 2] = {0};
  int count = 0;
  for (size_t k = 0; k < size && k < LETTERS_MAX; k++) {
    count = take_operation(text[k], k + 1 < size ? text[k + 1] : '0', open, count);
    if (count > OPEN_MAX) count = OPEN_MAX;
  }
  dvi__node sum = dvi__constant(&graph, 0);
  for (int k = 0; k < count; k++) sum = dvi__apply(&graph, DVI__OP_ADD, sum, open[k]);
  return sum;
}

/* --- Judging. --- */

static quad value[NODES_MAX], error[NODES_MAX], finer[NODES_MAX];

/* The judge's results for the roots at a point: values, the roundings of double and of quadruple
 * precision, and the derivatives by each input of value and gradient, with the disagreement of
 * their two differences. Nodes at the end of the range of double get infinite errors, and are not
 * judged. */
typedef struct verdict {
  quad value[ROOTS], error[ROOTS], finer[ROOTS];
  quad difference[INPUTS][HESSIAN], doubt[INPUTS][HESSIAN];
} verdict;

/* Returns 1 if a node, or one below it, leaves the range of double, or is more rounding than
 * number. Bounds are those of small errors. */
static void mark_unusual(void)
{
  for (int n = 0; n < graph.count; n++) {
    const dvi__graph_node *node = graph.node + n;
    const int operands = dvi__operands(node->op);
    const quad size = fabsq(value[n]);
    const int usual = (size == 0 && error[n] == 0) ||
                      (size > (quad)1e-290 && size < (quad)1e290 && error[n] < (quad)1e-4 * size);
    if (!usual) error[n] = (quad)HUGE_VAL;
    if (operands > 0 && !finiteq(error[node->a])) error[n] = (quad)HUGE_VAL;
    const int off = node->op == DVI__OP_WHERE &&
                    value[node->a] <= 0; /* then the other operand need not exist */
    if (operands > 1 && !off && !finiteq(error[node->b])) error[n] = (quad)HUGE_VAL;
    if (off && finiteq(error[node->a])) error[n] = 0;
  }
}

static void shifted(const quad *x, int i, quad step, quad *result)
{
  quad at[INPUTS];
  int last = 0;
  for (int k = 0; k < INPUTS; k++) at[k] = k == i ? x[k] + step : x[k];
  for (int r = 0; r < HESSIAN; r++) last = root[r] > last ? root[r] : last;
  quad_evaluate(&graph, last + 1, at, value, NULL, 0);
  for (int r = 0; r < HESSIAN; r++) result[r] = value[root[r]];
}

/* Returns 1 if something jumps on the way. These differences are then no derivatives. */
static int differences(const quad *x, int i, quad step, quad *result)
{
  static quad above[NODES_MAX];
  quad below[HESSIAN];
  int jumps = 0;
  shifted(x, i, step, result);
  memcpy(above, value, (size_t)graph.count * sizeof *above);
  shifted(x, i, -step, below);
  for (int n = 0; n < graph.count; n++)
    jumps |= dvi__is_step(graph.node[n].op) && (above[n] < value[n] || above[n] > value[n]);
  for (int r = 0; r < HESSIAN; r++) result[r] = (result[r] - below[r]) / (2 * step);
  return jumps;
}

static void judge_derivatives(const quad *x, verdict *v)
{
  const quad step = (quad)1e-11;
  quad_evaluate(&graph, graph.count, x, value, finer, (quad)1e-33);
  quad_evaluate(&graph, graph.count, x, value, error, 4 * (quad)DBL_EPSILON);
  mark_unusual();
  for (int r = 0; r < ROOTS; r++) {
    v->value[r] = value[root[r]];
    v->error[r] = error[root[r]];
    v->finer[r] = finer[root[r]];
  }
  for (int i = 0; i < INPUTS; i++) {
    quad longer[HESSIAN];
    (void)differences(x, i, step, v->difference[i]);
    const int jumps = differences(x, i, 3 * step, longer);
    for (int r = 0; r < HESSIAN; r++)
      v->doubt[i][r] = jumps ? (quad)HUGE_VAL
                             : 10 * fabsq(longer[r] - v->difference[i][r]) +
                                   10 * v->finer[r] / step + v->error[r] * step;
  }
}

static int agree(quad a, quad b, quad room)
{
  return !finiteq(room) || fabsq(a - b) <= room + (quad)1e-280;
}

/* The derivatives of a root by an input, as a node and as differences. */
static void check_derivative(const verdict *v, int derivative, int i, int of)
{
  const quad room = 4 * v->error[derivative] + v->doubt[i][of];
  if (!agree(v->value[derivative], v->difference[i][of], room))
    ck_abort_msg("root %d by input %d: %.17g, by differences %.17g, room %.3g", of, i,
                 (double)v->value[derivative], (double)v->difference[i][of], (double)room);
}

static void check_derivatives(const verdict *v)
{
  for (int j = 0; j < INPUTS; j++) {
    check_derivative(v, GRADIENT + j, j, 0);
    for (int i = 0; i < INPUTS; i++) check_derivative(v, HESSIAN + INPUTS * j + i, j, GRADIENT + i);
  }
}

/* Second derivatives that are not in the pattern are zero. */
static void check_pattern(const verdict *v)
{
  int(*pair)[2], count, inside[INPUTS][INPUTS] = {{0}};
  ck_assert_int_eq(dvi__second_pattern(&graph, root[0], INPUTS, &pair, &count), DVI_OK);
  for (int k = 0; k < count; k++)
    inside[pair[k][0]][pair[k][1]] = inside[pair[k][1]][pair[k][0]] = 1;
  dvi__heap_free(pair);
  for (int i = 0; i < INPUTS; i++)
    for (int j = 0; j < INPUTS; j++)
      fuzz_requires(inside[i][j] || agree(v->value[HESSIAN + INPUTS * j + i], 0,
                                          v->error[HESSIAN + INPUTS * j + i]));
}

/* --- Programs. --- */

/* Results of a program against the judge's, if there are any. */
static void check_results(const verdict *v, int code, int count, const double *result, int first)
{
  int known = v != NULL;
  for (int k = 0; k < count && known; k++) known = finiteq(v->error[first + k]);
  if (known) fuzz_requires(code == 0);
  for (int k = 0; k < count && code == 0; k++) {
    fuzz_requires(isfinite(result[k]));
    if (known && !agree((quad)result[k], v->value[first + k], 4 * v->error[first + k]))
      ck_abort_msg("result %d: %.17g for %.17g, error %.3g", first + k, result[k],
                   (double)v->value[first + k], (double)v->error[first + k]);
  }
}

/* All entries from those of the pattern. */
static void spread(const dvi_pattern *pattern, int full, const double *entry, double *all)
{
  for (int k = 0; k < INPUTS * INPUTS; k++) all[k] = full ? entry[k] : 0;
  for (int j = 0; j < INPUTS && !full; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      all[INPUTS * j + pattern->row[e]] = entry[e];
}

static unsigned run_at(dvi__function *function, const double *x, const verdict *v)
{
  double result[ROOTS] = {0}, entry[INPUTS * INPUTS] = {0};
  double *const gradient = result + GRADIENT, *const second = entry;
  dvi_pattern pattern;
  int full;
  ck_assert_int_eq(dvi__function_pattern(function, 0, &pattern, &full), DVI_OK);
  const int code[] = {dvi__function_value(function, 1, &x, result),
                      dvi__function_gradient(function, 1, &x, &gradient),
                      dvi__function_second(function, 1, &x, &second)};
  for (int k = 0; k < 3; k++) fuzz_requires(code[k] >= 0);
  spread(&pattern, full, entry, result + HESSIAN);
  check_results(v, code[0], 1, result, 0);
  check_results(v, code[1], INPUTS, result + GRADIENT, GRADIENT);
  check_results(v, code[2], INPUTS * INPUTS, result + HESSIAN, HESSIAN);
  return (unsigned)code[0] + 2U * (unsigned)code[1] + 4U * (unsigned)code[2];
}

/* The graph becomes the function's, and is freed with it. */
static unsigned run(const verdict *v)
{
  static const dvi__kernel_input input[INPUTS] = {{.base = 0}, {.base = 1}, {.base = 2}};
  static const int width = INPUTS;
  static const dvi__block_pair pair = {0, 0};
  static const dvi__blocks blocks = {1, &width, 1, &pair};
  const dvi__kernel kernel = {
      .graph = &graph, .root = root[0], .elements = 1, .input_count = INPUTS, .input = input};
  dvi__function *function = NULL;
  unsigned codes = 0;
  ck_assert_int_eq(dvi__function_create(1, &kernel, &blocks, &function), DVI_OK);
  for (int p = 0; p < POINTS; p++)
    codes = 8 * codes + run_at(function, point[p], p < JUDGED ? &v[p] : NULL);
  dvi__function_destroy(&function);
  return codes;
}

/* Gives a number for the set of derivatives. A text with a new number joins the corpus. */
static unsigned kinds(void)
{
  unsigned seen = 0;
  for (int n = 0; n < graph.count; n++) seen |= 1U << graph.node[n].op;
  return seen;
}

static unsigned try_derivatives(const char *text, size_t size)
{
  static verdict v[JUDGED];
  graph = (dvi__graph){.limit = NODES_MAX};
  root[0] = read_expression(text, size);
  dvi__gradient(&graph, root[0], INPUTS, root + GRADIENT);
  for (int j = 0; j < INPUTS; j++)
    dvi__tangents(&graph, j, INPUTS, root + GRADIENT, root + HESSIAN + (ptrdiff_t)INPUTS * j);
  if (graph.failed != DVI_OK) {
    fuzz_requires(graph.failed == DVI_BAD_SIZE);
    dvi__graph_free(&graph);
    return 0;
  }
  for (int p = 0; p < JUDGED; p++) {
    const quad x[INPUTS] = {(quad)point[p][0], (quad)point[p][1], (quad)point[p][2]};
    judge_derivatives(x, &v[p]);
    check_derivatives(&v[p]);
    check_pattern(&v[p]);
  }
  const unsigned seen = kinds();
  return (seen * 2654435761U >> 20) * 8 + run(v) % 8;
}

START_TEST(derivatives_are_those_of_differences)
{
  ck_assert_int_gt(fuzz(&(fuzz_target){"derivatives", corpus, tokens, try_derivatives, NULL}), 0);
}
END_TEST
#endif

SUITE(fuzz_derivatives)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_test(tests, derivatives_are_those_of_differences);
#else
  (void)tests;
  puts("no libquadmath: nothing to compare with");
#endif
}
