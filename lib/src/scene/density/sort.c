/* The structure of a density, found on its graph.
 *
 * The density is taken apart into summands, through +, -, and factors without fields. Each summand
 * belongs to one class by its degrees in the rates and in the fields:
 *
 *     kinetic    of degree 2 in the rates, with coefficients of the position alone
 *     one-form   of degree 1 in the rates
 *     quadratic  without rates, of degree 2 at most, with second derivatives in the position alone
 *     potential  without rates
 *     general    all others
 *
 * Beside a general summand, and beside both of the first two, all summands with rates are general.
 * A part of the density is the sum of a class. */
#include <limits.h>
#include <string.h>

#include "expr/graph_make.h"
#include "scene/density/scene_density.h"
#include "text/heap.h"

enum { SUMMANDS_MAX = 10000, LEVELS_MAX = 2000 };

typedef struct factor {
  dvi__node is;
  bool divides;
  const struct factor *next;
} factor;

typedef struct sorting {
  dvi__context *c;
  const char *has_field; /* of the nodes that there were at first */
  dvi__kernel kernel;    /* with positions as data, for degrees */
  dvi__node total[DVI__DENSITY_CLASSES];
  int summands[DVI__DENSITY_CLASSES], all, level;
} sorting;

/* ---- degrees ---- */

static bool is_position(const dvi_scene *scene, const dvi__kernel_input *input)
{
  return !input->is_data && input->block == DVI__COORDINATES &&
         dvi__input_number(input, 0) < scene->jets->dimension;
}

static bool is_of_field(const dvi_scene *scene, const dvi__kernel_input *input)
{
  return !input->is_data && (input->block == DVI__COORDINATES || input->block == DVI__VELOCITIES) &&
         !is_position(scene, input);
}

static int degree_sum(int a, int b)
{
  return a == INT_MAX || b == INT_MAX ? INT_MAX : a + b;
}

static int degree_of_power(int a, double exponent)
{
  if (a == 0) return 0;
  return a == INT_MAX || exponent < 0 || (double)(int)exponent < exponent ? INT_MAX
                                                                          : a * (int)exponent;
}

/* Find the degree of a node as a polynomial in the fields and their rates, from those of the nodes
 * before. INT_MAX stands for all other functions. */
static int degree_of(const dvi_scene *scene, const dvi__kernel *kernel, const int *known, int i)
{
  const dvi__graph_node *node = &kernel->graph->node[i];
  const int operands = dvi__operands(node->op), a = operands > 0 ? known[node->a] : 0,
            b = operands > 1 ? known[node->b] : 0;
  switch (node->op) {
  case DVI__OP_CONSTANT: return 0;
  case DVI__OP_INPUT: return is_of_field(scene, &kernel->input[node->a]);
  case DVI__OP_NEGATE: return a;
  case DVI__OP_SQUARE: return degree_sum(a, a);
  case DVI__OP_POWER: return degree_of_power(a, node->value);
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT: return a > b ? a : b;
  case DVI__OP_MULTIPLY: return degree_sum(a, b);
  case DVI__OP_DIVIDE: return b == 0 ? a : INT_MAX;
  case DVI__OP_WHERE: return a == 0 ? b : INT_MAX;
  default: return a == 0 && b == 0 ? 0 : INT_MAX;
  }
}

/* ---- summands ---- */

/* Make a summand with its factors. */
static dvi__node with_factors(sorting *s, dvi__node node, const factor *by)
{
  for (; by != NULL; by = by->next)
    node = by->divides ? dvi__divide(s->c->graph, node, by->is)
                       : dvi__multiply(s->c->graph, by->is, node);
  return node;
}

/* Tell if a node is of some degree in the rates without parts of other degrees, that is, zero at
 * rest, and of degree 2 also without a linear part. */
static bool is_homogeneous(dvi_scene *scene, const dvi__kernel *kernel, int degree, bool *is)
{
  const dvi__kernels one = {.kernel = (dvi__kernel *)kernel, .count = 1};
  dvi__kernels rest = {0};
  const bool good = dvi__kernels_at_rest(scene, &one, DVI__VELOCITIES, 0, &rest) &&
                    (degree == 1 ||
                     dvi__kernels_linear(scene, &one, DVI__VELOCITIES, DVI__VELOCITIES, &rest));
  *is = rest.count == 0;
  dvi__kernels_free(&rest);
  return good;
}

static bool classify(sorting *s, dvi__node node, int *class)
{
  dvi_scene *scene = s->c->scene;
  dvi__degree rates, fields;
  dvi__kernel kernel = s->kernel;
  bool is = true;
  kernel.root = node;
  if (!dvi__kernel_degree(scene, &kernel, DVI__VELOCITIES, &rates) ||
      !dvi__kernel_degree(scene, &kernel, DVI__COORDINATES, &fields))
    return false;
  if (rates.degree == 0) {
    *class = fields.degree <= 2 && fields.squares ? DVI_DENSITY_QUADRATIC : DVI_DENSITY_POTENTIAL;
    return true;
  }
  *class = rates.degree == 1                 ? DVI_DENSITY_ONE_FORM
           : rates.degree == 2 && rates.pure ? DVI_DENSITY_KINETIC
                                             : DVI_DENSITY_GENERAL;
  if (*class != DVI_DENSITY_GENERAL && !is_homogeneous(scene, &kernel, rates.degree, &is))
    return false;
  if (!is) *class = DVI_DENSITY_GENERAL;
  return true;
}

static bool add_summand(sorting *s, dvi__node node, const factor *by, bool is_negative)
{
  int class;
  const dvi__node whole = with_factors(s, node, by);
  if (s->c->graph->failed != DVI_OK) return dvi__scene_no_memory(s->c->scene);
  if (!classify(s, whole, &class)) return false;
  s->total[class] = is_negative ? dvi__subtract(s->c->graph, s->total[class], whole)
                                : dvi__add(s->c->graph, s->total[class], whole);
  s->summands[class]++;
  s->all++;
  return true;
}

static bool gather(sorting *s, dvi__node node, const factor *by, bool is_negative);

static bool gather_parts(sorting *s, dvi__node node, const factor *by, bool is_negative)
{
  const dvi__graph_node n = s->c->graph->node[node];
  switch (n.op) {
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT:
    return gather(s, n.a, by, is_negative) &&
           gather(s, n.b, by, (n.op == DVI__OP_SUBTRACT) != is_negative);
  case DVI__OP_NEGATE: return gather(s, n.a, by, !is_negative);
  case DVI__OP_MULTIPLY:
    if (!s->has_field[n.a]) return gather(s, n.b, &(factor){n.a, false, by}, is_negative);
    if (!s->has_field[n.b]) return gather(s, n.a, &(factor){n.b, false, by}, is_negative);
    break;
  case DVI__OP_DIVIDE:
    if (!s->has_field[n.b]) return gather(s, n.a, &(factor){n.b, true, by}, is_negative);
    break;
  default: break;
  }
  return add_summand(s, node, by, is_negative);
}

/* Take a node apart. A density of very many summands, or levels of them, is left together. */
static bool gather(sorting *s, dvi__node node, const factor *by, bool is_negative)
{
  if (s->all >= SUMMANDS_MAX || s->level == LEVELS_MAX)
    return add_summand(s, node, by, is_negative);
  s->level++;
  const bool good = gather_parts(s, node, by, is_negative);
  s->level--;
  return good;
}

/* ---- parts ---- */

/* Move the summands of a class to the general ones. */
static void make_general(sorting *s, int class)
{
  dvi__node *general = &s->total[DVI_DENSITY_GENERAL];
  *general = dvi__add(s->c->graph, *general, s->total[class]);
  s->summands[DVI_DENSITY_GENERAL] += s->summands[class];
  s->total[class] = dvi__constant(s->c->graph, 0);
  s->summands[class] = 0;
}

static void join_classes(sorting *s)
{
  const int *have = s->summands;
  if (have[DVI_DENSITY_GENERAL] == 0 &&
      (have[DVI_DENSITY_KINETIC] == 0 || have[DVI_DENSITY_ONE_FORM] == 0))
    return;
  make_general(s, DVI_DENSITY_KINETIC);
  make_general(s, DVI_DENSITY_ONE_FORM);
}

static bool make_part(sorting *s, int class)
{
  dvi_scene *scene = s->c->scene;
  struct dvi__scene_density *density = scene->density;
  dvi__kernels list = {0};
  dvi__local *local;
  density->summands[class] = s->summands[class];
  if (!dvi__kernels_add_node(s->c, s->total[class], &list) ||
      !dvi__local_make(scene, &list, &local))
    return false;
  if (local->term == NULL) return true;
  density->part[class] = local;
  density->placed_axes |= local->axes;
  return class != DVI_DENSITY_ONE_FORM || !local->has_time ||
         dvi__scene_refuse(scene, density->section->span,
                           "of first degree in the rates a density is linear in them, with "
                           "coefficients without the time");
}

/* Refuse fields of which no rate occurs, if others have some. */
static bool check_rates(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const dvi__local *kinetic = s->part[DVI_DENSITY_KINETIC];
  for (int i = 0; i < s->fields && kinetic != NULL; i++)
    for (int k = s->field[i].first; k < s->field[i].first + s->field[i].components; k++) {
      bool found = false;
      for (int j = 0; j < kinetic->variables; j++)
        found = found || kinetic->variable[j].component == k;
      if (!found)
        return dvi__scene_refuse(scene, s->section->span,
                                 "no rate of %s stands in the density, so that its mass is "
                                 "singular; give all fields a kinetic energy",
                                 s->field[i].name);
    }
  return true;
}

/* Find what is known of the nodes, and make the kernel whose positions are data. */
static void prepare(sorting *s, dvi__node root, char *has_field, int *degree,
                    dvi__kernel_input *input)
{
  dvi_scene *scene = s->c->scene;
  const dvi__kernel kernel = {.graph = s->c->graph,
                              .root = root,
                              .elements = 1,
                              .input_count = s->c->input_count,
                              .input = s->c->input};
  for (int i = 0; i <= root; i++) {
    degree[i] = degree_of(scene, &kernel, degree, i);
    has_field[i] = degree[i] > 0;
  }
  scene->density->degree = degree[root] == INT_MAX ? -1 : degree[root];
  for (int i = 0; i < kernel.input_count; i++) {
    input[i] = kernel.input[i];
    if (is_position(scene, input + i)) input[i] = (dvi__kernel_input){.is_data = 1};
  }
  s->has_field = has_field;
  s->kernel = kernel;
  s->kernel.input = input;
}

bool dvi__density_sort(dvi__context *c, dvi__node root)
{
  dvi_scene *scene = c->scene;
  struct dvi__scene_density *density = scene->density;
  const size_t nodes = (size_t)root + 1;
  sorting s = {.c = c};
  char *has_field = dvi__heap_take(nodes, 1);
  int *degree = dvi__heap_take(nodes, sizeof *degree);
  dvi__kernel_input *input = dvi__heap_take((size_t)c->input_count + 1, sizeof *input);
  bool good = (has_field != NULL && degree != NULL && input != NULL) || dvi__scene_no_memory(scene);
  for (int k = 0; k < DVI__DENSITY_CLASSES; k++) s.total[k] = dvi__constant(c->graph, 0);
  if (good) prepare(&s, root, has_field, degree, input);
  good = good && gather(&s, root, NULL, false);
  join_classes(&s);
  density->placed_axes = 0;
  for (int k = 0; k < DVI__DENSITY_CLASSES && good; k++) good = make_part(&s, k);
  density->is_static = density->part[DVI_DENSITY_KINETIC] == NULL &&
                       density->part[DVI_DENSITY_ONE_FORM] == NULL &&
                       density->part[DVI_DENSITY_GENERAL] == NULL;
  dvi__heap_free(has_field);
  dvi__heap_free(degree);
  dvi__heap_free(input);
  return good && check_rates(scene);
}
