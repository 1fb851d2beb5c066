/* Kinks. An expression may consist of two sides, as max(x, 0) does, and one of its derivatives then
 * jumps between them.
 *
 * The kink is searched for along lines from the start on, by the sign of the node that decides.
 * There the Taylor series of the whole kernel along the line are compared, one from just before and
 * one from just behind. For any two sides, the first coefficient that differs is that of the
 * derivative that jumps. */
#include <dvi/taylor.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"
#include "scene/elaborate/model.h"
#include "expr/compile/program.h"

/* Limit the nodes of all trials, which then take less than a second. */
static const double WORK_MAX = 3e7;
enum {
  LINES = 4,
  DECIDERS_MAX = 64,
  MARKS = 60,
  HALVINGS = 60,
  DEGREE = 8,
  JUMPS = 4,
  SMOOTH = JUMPS + 1
};

/* `apart` is half the distance of the two points. The others are the largest roundings, of numbers
 * and of the place. */
static const double apart = 1e-3, alike = 1e-8, rounding = 1e-13, displaced = 1e-14;

/* A kernel at one of its elements, along a line. Input i is base[i] + s direction[i]. */
typedef struct line {
  const dvi__kernel *kernel;
  dvi__node decides; /* a node ABS, SIGN, FLOOR or POSITIVE */
  double *base, *direction, *value;
  double *work; /* nodes evaluated so far, on all lines */
} line;

/* Return a number from -1 to 1 that looks random and is always the same. */
static double draw_number(uint64_t key)
{
  key = (key + 1) * UINT64_C(0x9e3779b97f4a7c15);
  key = (key ^ (key >> 29)) * UINT64_C(0xbf58476d1ce4e5b9);
  return (double)(int64_t)(key ^ (key >> 32)) / 9223372036854775808.0;
}

static double start_of(const dvi_scene *scene, int block, int number)
{
  if (block == DVI__COORDINATES) return scene->q[number];
  if (block != DVI__VELOCITIES || number >= scene->nv) return 0;
  return scene->terms.hamiltonian != NULL ? scene->p[number] : scene->v[number];
}

static void place_line(const dvi_scene *scene, line *l, int element, int which)
{
  for (int i = 0; i < l->kernel->input_count; i++) {
    const dvi__kernel_input *input = &l->kernel->input[i];
    const int number = input->is_data ? 0 : dvi__input_number(input, element);
    l->base[i] = input->is_data ? input->data[element] : start_of(scene, input->block, number);
    l->direction[i] = input->is_data
                          ? 0
                          : draw_number(((uint64_t)number * DVI__BLOCKS + (uint64_t)input->block) *
                                            LINES +
                                        (uint64_t)which);
  }
}

/* Return on which side of the kink a point of the line is, or NaN where there is no value. */
static double side_at(const line *l, double s)
{
  const dvi__graph_node *node = &l->kernel->graph->node[l->decides];
  dvi__node unused;
  double x;
  *l->work += l->decides;
  if (*l->work > WORK_MAX) return (double)NAN;
  for (int i = 0; i < l->kernel->input_count; i++) l->value[i] = l->base[i] + s * l->direction[i];
  if (dvi__evaluate(l->kernel->graph, l->value, 1, &node->a, &x, &unused) != DVI_OK || !isfinite(x))
    return (double)NAN;
  return node->op == DVI__OP_FLOOR ? floor(x) : (double)(x > 0);
}

static int numbers_differ(double a, double b)
{
  return a < b || a > b;
}

/* Find a place on the line where the side changes, at s > 0 or s < 0 by `sign`. */
static bool find_change(const line *l, double sign, double *s)
{
  double before = 0, behind = 0, side = side_at(l, 0);
  for (int k = 0; k < MARKS && !numbers_differ(side_at(l, behind), side); k++) {
    before = behind;
    behind = sign * 1e-3 * pow(1.3, k);
  }
  if (!numbers_differ(side_at(l, behind), side)) return false;
  for (int k = 0; k < HALVINGS; k++) {
    const double middle = (before + behind) / 2;
    if (numbers_differ(side_at(l, middle), side))
      behind = middle;
    else
      before = middle;
  }
  *s = behind;
  return true;
}

/* Compile the kernel's program, and list its inputs by number, node[input_count]. */
static bool compile_kernel(const dvi__kernel *kernel, int *count, int *number,
                           dvi__program *program)
{
  dvi__node *input = dvi__heap_take((size_t)kernel->input_count + 1, sizeof *input);
  *count = 0;
  if (input == NULL) return false;
  for (dvi__node n = 0; n <= kernel->root; n++)
    if (kernel->graph->node[n].op == DVI__OP_INPUT) {
      number[*count] = kernel->graph->node[n].a;
      input[(*count)++] = n;
    }
  const dvi_status status = dvi__program_make(kernel->graph, *count, input, 1, &kernel->root,
                                              program);
  dvi__heap_free(input);
  return status == DVI_OK;
}

/* Compute the series at s, moved to s + way, c [DEGREE + 1]. Returns how large its terms are. */
static double series_at(const line *l, const dvi__program *program, int count, const int *number,
                        double *rows, double s, double way, double *c)
{
  enum { WIDTH = DEGREE + 1 };
  double *registers = rows + (ptrdiff_t)count * WIDTH, size = 0;
  memset(rows, 0, (size_t)(count + program->row_count) * WIDTH * sizeof *rows);
  for (int i = 0; i < count; i++) {
    double *row = registers - (ptrdiff_t)(i + 1) * WIDTH;
    row[0] = l->base[number[i]] + s * l->direction[number[i]];
    row[1] = l->direction[number[i]];
  }
  dvi__program_run_series(program, DEGREE, registers);
  memcpy(c, registers + (ptrdiff_t)(program->row_count - 1) * WIDTH, WIDTH * sizeof *c);
  for (int k = 0; k <= DEGREE; k++) size += fabs(c[k]) * pow(fabs(way), k);
  for (int k = 0; k < DEGREE; k++) /* Horner's scheme, as for polynomials */
    for (int j = DEGREE - 1; j >= k; j--) c[j] += way * c[j + 1];
  return size;
}

/* Return the first derivative that jumps at s, from 0 on, or SMOOTH if none of those compared does.
 * The remainder of a series shrinks with the distance, and a jump does not. Roundings are those of
 * the terms, and of s. */
static int first_jump(const line *l, const dvi__program *program, int count, const int *number,
                      double *rows, double s)
{
  double before[2][DEGREE + 1], behind[2][DEGREE + 1], noise = 0;
  *l->work += 4.0 * DEGREE * DEGREE * program->instruction_count;
  for (int k = 0; k < 2; k++) {
    const double way = apart / (k + 1);
    noise += rounding * series_at(l, program, count, number, rows, s - way, way, before[k]);
    noise += rounding * series_at(l, program, count, number, rows, s + way, -way, behind[k]);
  }
  for (int m = 0; m <= JUMPS; m++, noise /= apart) {
    const double jump = behind[0][m] - before[0][m], again = behind[1][m] - before[1][m];
    const double size = fabs(before[0][m]) + fabs(behind[0][m]),
                 slope = (m + 1) * (fabs(before[0][m + 1]) + fabs(behind[0][m + 1]));
    if (fabs(jump) > alike * size + noise + displaced * (1 + fabs(s)) * slope &&
        fabs(again) > 0.9 * fabs(jump))
      return m;
  }
  return SMOOTH;
}

/* Try the lines at some elements. */
static int try_lines(const dvi_scene *scene, line *l, const dvi__program *program, int count,
                     const int *number, double *rows)
{
  const int last = l->kernel->elements - 1, element[] = {0, last / 2, last};
  int least = SMOOTH;
  for (int e = 0; e < 3; e++)
    for (int which = 0; which < 2 * LINES && (e == 0 || element[e] != element[e - 1]); which++) {
      double s;
      place_line(scene, l, element[e], which / 2);
      if (!find_change(l, which % 2 == 0 ? 1 : -1, &s)) continue;
      const int jump = first_jump(l, program, count, number, rows, s);
      least = jump < least ? jump : least;
    }
  return least;
}

/* The node that makes the lowest derivative jump. A node that time alone decides exerts no force by
 * itself. Forces are as smooth there as the functions that they are derivatives of. `order`, which
 * methods keep, is then one more than the derivative that jumps. */
typedef struct found {
  int jump, order, tried;
  double work;
  const dvi__kernel *kernel;
  dvi__node node;
} found;

static int node_decides(const dvi__graph *graph, const char *part, const char *moves, dvi__node n)
{
  const dvi__graph_node *node = &graph->node[n];
  return part[n] && (node->op == DVI__OP_ABS || dvi__is_step(node->op)) && moves[node->a];
}

/* Return 1 if time alone decides. */
static int by_time(const dvi__kernel *kernel, dvi__node n)
{
  char *used = dvi__heap_take((size_t)kernel->input_count + 1, 1);
  int alone = used != NULL;
  if (used != NULL)
    dvi__inputs_used(kernel->graph, 1, &kernel->graph->node[n].a, kernel->input_count, used);
  for (int i = 0; i < kernel->input_count && alone; i++)
    alone = !used[i] || kernel->input[i].is_data || kernel->input[i].block == DVI__TIME;
  dvi__heap_free(used);
  return alone;
}

static void try_deciders(const dvi_scene *scene, line *l, const char *part, const char *moves,
                         found *worst)
{
  const dvi__kernel *kernel = l->kernel;
  dvi__program program = {0};
  int count = 0, *number = dvi__heap_take((size_t)kernel->input_count + 1, sizeof *number);
  double *rows = NULL;
  if (number != NULL && compile_kernel(kernel, &count, number, &program))
    rows = dvi__heap_take((size_t)(count + program.row_count) * (DEGREE + 1), sizeof *rows);
  for (int n = 0; n <= kernel->root && rows != NULL && worst->tried < DECIDERS_MAX; n++) {
    if (!node_decides(kernel->graph, part, moves, n)) continue;
    worst->tried++;
    l->decides = n;
    const int jump = try_lines(scene, l, &program, count, number, rows),
              order = jump + by_time(kernel, n);
    if (jump < SMOOTH && order < worst->order)
      *worst = (found){.jump = jump,
                       .order = order,
                       .tried = worst->tried,
                       .work = worst->work,
                       .kernel = kernel,
                       .node = n};
  }
  dvi__program_free(&program);
  dvi__heap_free(number);
  dvi__heap_free(rows);
}

static void try_kernel(const dvi_scene *scene, const dvi__kernel *kernel, found *worst)
{
  int count;
  char *part = dvi__parts(kernel->graph, 1, &kernel->root, &count),
       *moves = dvi__heap_take((size_t)kernel->root + 1, 1);
  double *inputs = dvi__heap_take(3 * (size_t)kernel->input_count + 1, sizeof *inputs);
  if (part != NULL && moves != NULL && inputs != NULL) {
    int any = 0;
    dvi__mark_moving(kernel, count, moves);
    for (int n = 0; n < count && !any; n++) any = node_decides(kernel->graph, part, moves, n);
    line l = {.kernel = kernel,
              .decides = -1,
              .base = inputs,
              .direction = inputs + kernel->input_count,
              .value = inputs + (ptrdiff_t)2 * kernel->input_count,
              .work = &worst->work};
    if (any) try_deciders(scene, &l, part, moves, worst);
  }
  dvi__heap_free(part);
  dvi__heap_free(moves);
  dvi__heap_free(inputs);
}

static void write_kink(const dvi_scene *scene, const found *worst, char *text, size_t size)
{
  static const char *const ordinal[] = {"", "first", "second", "third", "fourth"};
  const dvi__span span = worst->kernel->graph->node[worst->node].span;
  const char *what = scene->terms.hamiltonian != NULL ? "Hamiltonian" : "Lagrangian";
  char part[DVI__PART_SIZE], place[DVI__PART_SIZE];
  int row = 0, column = 0;
  dvi__source_place(&scene->source, span.first, &row, &column);
  dvi__copy_part(&scene->source, span, part);
  (void)snprintf(place, sizeof place, ":%d:%d: ", row, column);
  const int used = snprintf(text, size, "%s%s%s", dvi__source_name(&scene->source, span.first),
                            place, part);
  if (used < 0 || (size_t)used >= size) return;
  text += used;
  size -= (size_t)used;
  if (worst->order == 0)
    (void)snprintf(text, size,
                   ": the %s itself jumps here, which methods do not see: where the motion crosses "
                   "it they have no order",
                   what);
  else if (worst->jump == 0)
    (void)snprintf(
        text, size,
        ": the %s itself jumps here: where the motion crosses it orders above %d are lost", what,
        worst->order);
  else
    (void)snprintf(text, size,
                   ": the %s derivative of the %s jumps here: where the motion crosses it orders "
                   "above %d are lost",
                   ordinal[worst->jump], what, worst->order);
}

int dvi_scene_kink(const dvi_scene *scene, char *text, size_t size)
{
  if (size > 0 && text != NULL) text[0] = '\0';
  if (scene == NULL || text == NULL || scene->density != NULL) return -1;
  found worst = {.order = SMOOTH + 1};
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next)
    for (int k = 0; (term->role == DVI__ROLE_MOTION || term == scene->kinetic) &&
                    k < dvi__function_kernel_count(term->function);
         k++)
      try_kernel(scene, dvi__function_kernel(term->function, k), &worst);
  if (worst.kernel == NULL) return -1;
  write_kink(scene, &worst, text, size);
  return worst.order;
}
