/* Functions of one place: of time, position, and some derivatives of the fields and their rates.
 *
 * The kernels of an expression have the numbers of all derivatives that there may be. Here they get
 * blocks of their own, the time, the position, and the variables that occur, so that evaluations
 * work on no more than these. */
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/elaborate/elaborate.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"

/* The first block and its number are those of all functions of scenes. There is no other one by
 * which messages about faults look up a name. */
enum { TIME = DVI__TIME, NONE, PLACE, VARIABLES, BLOCKS };
enum { BY_VARIABLES, BY_TIME, PAIRS };
static const dvi__block_pair pairs[PAIRS] = {{VARIABLES, VARIABLES}, {TIME, TIME}};

/* Limits of the points that are evaluated at a time, and of the numbers of these. */
enum { POINTS = 256, ROOM = DVI_JETS_MAX * DVI_JETS_MAX };

/* ---- making ---- */

static bool same_variable(const dvi_jet *a, const dvi_jet *b)
{
  return a->component == b->component && a->rate == b->rate &&
         memcmp(a->order, b->order, sizeof a->order) == 0;
}

/* Find a variable, or add it. Returns its number, or -1 after a complaint. */
static int find_variable(dvi_scene *scene, dvi__local *local, const dvi_jet *jet, dvi__span span)
{
  for (int k = 0; k < local->variables; k++)
    if (same_variable(local->variable + k, jet)) return k;
  if (local->variables == DVI_JETS_MAX) {
    (void)dvi__complain(scene->complaint, DVI_BAD_SIZE, span,
                        "more than %d derivatives of the fields in one density", (int)DVI_JETS_MAX);
    return -1;
  }
  local->variable[local->variables] = *jet;
  local->span[local->variables] = span;
  return local->variables++;
}

/* Return where an input stands, at its first use. */
static dvi__span span_of_input(const dvi__kernel *kernel, int input)
{
  for (int i = 0; i <= kernel->root; i++)
    if (kernel->graph->node[i].op == DVI__OP_INPUT && kernel->graph->node[i].a == input)
      return kernel->graph->node[i].span;
  return DVI__NOWHERE;
}

static bool convert_input(dvi_scene *scene, dvi__local *local, const dvi__kernel *kernel, int i,
                          dvi__kernel_input *to)
{
  const dvi__kernel_input *from = kernel->input + i;
  const int number = dvi__input_number(from, 0);
  dvi_jet jet = {.component = -1, .rate = from->block == DVI__VELOCITIES};
  *to = *from;
  if (from->is_data) return true;
  *to = (dvi__kernel_input){.block = TIME};
  if (from->block == DVI__TIME) {
    local->has_time = true;
  } else if (!dvi__jet_at(scene->jets, number, &jet.component, jet.order) && !local->is_placed) {
    local->axes |= 1U << number;
    *to = (dvi__kernel_input){.block = PLACE, .base = number};
  } else {
    if (number < local->dimension) jet.component = -1 - number;
    *to = (dvi__kernel_input){.block = VARIABLES,
                              .base = find_variable(scene, local, &jet, span_of_input(kernel, i))};
    return to->base >= 0;
  }
  return true;
}

static bool convert_kernel(dvi_scene *scene, dvi__local *local, dvi__kernel *kernel)
{
  dvi__kernel_input *input = dvi__arena_take(&scene->arena, (size_t)kernel->input_count + 1,
                                             sizeof *input);
  if (input == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < kernel->input_count; i++)
    if (!convert_input(scene, local, kernel, i, input + i)) return false;
  kernel->input = input;
  return true;
}

/* Find the pairs by which there are second derivatives. */
static bool find_pairs(dvi_scene *scene, dvi__local *local)
{
  dvi_pattern pattern;
  int full;
  const int n = local->variables;
  const dvi_status status = dvi__function_pattern(local->term->function, BY_VARIABLES, &pattern,
                                                  &full);
  if (status != DVI_OK)
    return dvi__scene_too_large(scene, "the pattern of the second derivatives", status);
  local->entries = full ? n * n : pattern.start[n];
  local->pair = dvi__arena_take(&scene->arena, (size_t)local->entries + 1, sizeof *local->pair);
  local->entry = dvi__arena_take(&scene->arena, (size_t)local->entries + 1, sizeof *local->entry);
  if (local->pair == NULL || local->entry == NULL) return dvi__scene_no_memory(scene);
  for (int b = 0; b < n; b++)
    for (int e = full ? b * n : pattern.start[b]; e < (full ? (b + 1) * n : pattern.start[b + 1]);
         e++) {
      const int a = full ? e % n : pattern.row[e];
      if (a < b) continue;
      local->pair[local->pairs][0] = a;
      local->pair[local->pairs][1] = b;
      local->entry[local->pairs++] = e;
    }
  return true;
}

static bool make_function(dvi_scene *scene, dvi__local *local, dvi__kernels *list)
{
  const int width[BLOCKS] = {1, 0, local->dimension, local->variables};
  const dvi__blocks blocks = {BLOCKS, width, PAIRS, pairs};
  dvi__scene_term *term = dvi__arena_take(&scene->arena, 1, sizeof *term);
  if (term == NULL) return dvi__scene_no_memory(scene);
  const dvi_status status = dvi__function_create(list->count, list->kernel, &blocks,
                                                 &term->function);
  if (status != DVI_OK) return dvi__scene_no_memory(scene);
  list->count = 0; /* the kernels were moved */
  term->scene = scene;
  term->next = scene->functions;
  scene->functions = local->term = term;
  return find_pairs(scene, local);
}

static bool make_local(dvi_scene *scene, dvi__kernels *list, bool is_placed, dvi__local **local)
{
  dvi__local *made = *local = dvi__arena_take(&scene->arena, 1, sizeof *made);
  bool good = made != NULL;
  if (good) {
    made->dimension = scene->jets->dimension;
    made->is_placed = is_placed;
    made->variable = dvi__arena_take(&scene->arena, DVI_JETS_MAX, sizeof *made->variable);
    made->span = dvi__arena_take(&scene->arena, DVI_JETS_MAX, sizeof *made->span);
    good = made->variable != NULL && made->span != NULL;
  }
  if (!good) (void)dvi__scene_no_memory(scene);
  for (int k = 0; k < list->count && good; k++)
    good = convert_kernel(scene, made, list->kernel + k);
  good = good && (list->count == 0 || make_function(scene, made, list));
  dvi__kernels_free(list);
  return good;
}

bool dvi__local_make(dvi_scene *scene, dvi__kernels *list, dvi__local **local)
{
  return make_local(scene, list, false, local);
}

bool dvi__local_make_placed(dvi_scene *scene, dvi__kernels *list, dvi__local **local)
{
  return make_local(scene, list, true, local);
}

/* ---- reading ---- */

static bool read_component(dvi__context *c, dvi__node node, unsigned may, dvi__local **local)
{
  dvi__kernels list = {0};
  dvi_scene *scene = c->scene;
  if (!dvi__kernels_add_node(c, node, &list) || !dvi__local_make(scene, &list, local)) return false;
  if ((*local)->term != NULL) (*local)->term->role = DVI__ROLE_AUXILIARY;
  return (*local)->variables == 0 || (may & DVI__OF_FIELD) != 0 ||
         dvi__scene_refuse(scene, (*local)->span[0],
                           "%s is a function of position, without the fields", c->where);
}

/* Read a function, or its derivative along an axis from 0 on. */
static bool read_function(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                          int axis, dvi__shape shape, dvi__local **local)
{
  const dvi__expression *e;
  dvi__context c;
  if (!dvi__tree_expression(scene, tree, &e) ||
      !dvi__context_make(&c, scene, DVI__MENTIONS_Q | may, where))
    return false;
  dvi__value value = dvi__elaborate(&c, e);
  if (!dvi__failed(value) && axis >= 0) value = dvi__derivative_along(&c, value, axis, e->span);
  bool good = value.shape.rank >= 0 && dvi__want_shape(&c, tree->span, value.shape, shape);
  const int count = good ? dvi__value_size(value) : 0;
  for (int k = 0; k < count && good; k++)
    good = read_component(&c, value.node == NULL ? value.one : value.node[k], may, local + k);
  dvi__context_free(&c);
  return good;
}

/* Return the shape of a number, or of a vector of `count`. */
static dvi__shape shape_of(int count)
{
  return (dvi__shape){count > 1, count, 1};
}

bool dvi__local_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                     int count, dvi__local **local)
{
  return read_function(scene, tree, may, where, -1, shape_of(count), local);
}

bool dvi__local_read_slope(dvi_scene *scene, const dvi__tree *tree, int axis, const char *where,
                           int count, dvi__local **local)
{
  return read_function(scene, tree, DVI__MENTIONS_T, where, axis, shape_of(count), local);
}

bool dvi__local_read_matrix(dvi_scene *scene, const dvi__tree *tree, const char *where,
                            dvi__local **local)
{
  return read_function(scene, tree, 0, where, -1, (dvi__shape){2, 3, 3}, local);
}

/* ---- evaluation ---- */

/* What is evaluated, l, l_z and l_zz, or l_t and l_tt. */
typedef struct results {
  double *l, *l_z, *l_zz, *l_t, *l_tt;
} results;

static int limit_points(const dvi__local *local)
{
  const int numbers = local->variables + local->dimension,
            most = local->entries > numbers ? local->entries : numbers;
  return most > ROOM / POINTS ? ROOM / most : POINTS;
}

/* Evaluate second derivatives, of which the pattern has both triangles. */
static int evaluate_second(const dvi__local *local, int count, const double *const *in, results to)
{
  double seconds[ROOM];
  const bool is_direct = local->pairs == local->entries;
  double *const second[PAIRS] = {
      [BY_VARIABLES] = to.l_zz == NULL || is_direct ? to.l_zz : seconds, [BY_TIME] = to.l_tt};
  const int failed = dvi__function_second(local->term->function, count, in, second);
  for (int k = 0; k < local->pairs && to.l_zz != NULL && !is_direct; k++)
    memcpy(to.l_zz + k * count, seconds + local->entry[k] * count, (size_t)count * sizeof *seconds);
  return failed;
}

static void repeat(double t, int count, double *time)
{
  for (int k = 0; k < count; k++) time[k] = t;
}

/* Evaluate at so few points that there is room for them. */
static int evaluate(const dvi__local *local, int count, double t, const double *x, const double *z,
                    results to)
{
  double time[POINTS];
  const double *const in[BLOCKS] = {time, NULL, x, z};
  double *const first[BLOCKS] = {[VARIABLES] = to.l_z, [TIME] = to.l_t};
  dvi__function *f = local->term->function;
  int failed = 0;
  repeat(t, count, time);
  if (to.l != NULL) failed = dvi__function_value(f, count, in, to.l);
  if (failed == 0 && (to.l_z != NULL || to.l_t != NULL))
    failed = dvi__function_gradient(f, count, in, first);
  if (failed == 0 && (to.l_zz != NULL || to.l_tt != NULL))
    failed = evaluate_second(local, count, in, to);
  return dvi__fault_check(local->term, count, in, 0, failed);
}

/* Copy some points of rows, variable by variable. */
static void copy_points(int rows, int64_t all, int64_t from, int count, const double *of,
                        double *part)
{
  for (int k = 0; k < rows && of != NULL; k++)
    memcpy(part + (ptrdiff_t)k * count, of + k * all + from, (size_t)count * sizeof *part);
}

static void put_points(int rows, int64_t all, int64_t to, int count, const double *part, double *of)
{
  for (int k = 0; k < rows && of != NULL; k++)
    memcpy(of + k * all + to, part + (ptrdiff_t)k * count, (size_t)count * sizeof *part);
}

/* Evaluate a part of the points, from `from` on. */
static int evaluate_part(const dvi__local *local, int64_t all, int64_t from, int count, double t,
                         const double *x, const double *z, results to)
{
  double place[ROOM], variable[ROOM], first[ROOM], second[ROOM];
  if (local->axes != 0) copy_points(local->dimension, all, from, count, x, place);
  copy_points(local->variables, all, from, count, z, variable);
  const results part = {to.l != NULL ? to.l + from : NULL, to.l_z != NULL ? first : NULL,
                        to.l_zz != NULL ? second : NULL, to.l_t != NULL ? to.l_t + from : NULL,
                        to.l_tt != NULL ? to.l_tt + from : NULL};
  const int failed = evaluate(local, count, t, place, variable, part);
  if (failed == 0) {
    put_points(local->variables, all, from, count, first, to.l_z);
    put_points(local->pairs, all, from, count, second, to.l_zz);
  }
  return failed;
}

static int evaluate_all(const dvi__local *local, int64_t count, double t, const double *x,
                        const double *z, results to)
{
  const int most = limit_points(local);
  int failed = 0;
  if (count == 0) return 0;
  if (count <= most) return evaluate(local, (int)count, t, x, z, to);
  for (int64_t from = 0; from < count && failed == 0; from += most) {
    const int some = (int)(count - from < most ? count - from : most);
    failed = evaluate_part(local, count, from, some, t, x, z, to);
  }
  return failed;
}

int dvi__local_density(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  const results to = {.l = l, .l_z = l_z, .l_zz = l_zz};
  return evaluate_all(user, count, t, x, z, to);
}

int dvi__local_time(int count, double t, const double *x, const double *z, double *l_t, void *user)
{
  const results to = {.l_t = l_t};
  return evaluate_all(user, count, t, x, z, to);
}

int dvi__local_value(const dvi__local *local, int64_t count, double t, const double *x, double *f)
{
  const results to = {.l = f};
  if (local != NULL && local->term != NULL) return evaluate_all(local, count, t, x, NULL, to);
  memset(f, 0, (size_t)count * sizeof *f);
  return 0;
}

int dvi__local_rates(const dvi__local *local, int64_t count, double t, const double *x, double *f_t,
                     double *f_tt)
{
  const results to = {.l_t = f_t, .l_tt = f_tt};
  if (local != NULL && local->term != NULL) return evaluate_all(local, count, t, x, NULL, to);
  memset(f_t, 0, (size_t)count * sizeof *f_t);
  if (f_tt != NULL) memset(f_tt, 0, (size_t)count * sizeof *f_tt);
  return 0;
}
