/* Copies of kernels. They hold the nodes that the root needs, or the parts by degree in a block of
 * variables.
 *
 * A node f is split into Z, where the block's variables are zero, and P = f - Z, by f's own rule.
 * For a product (Z_a + P_a)(Z_b + P_b) this gives P = P_a Z_b + Z_a P_b + P_a P_b. Without the last
 * product, P is the part of degree 1. */
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"
#include "scene/elaborate/kernels.h"

typedef struct copy {
  const dvi__kernel *from;
  dvi__graph *graph;
  dvi__kernel_input *input; /* [input_count of `from`] */
  int input_count;
  int *of_input;            /* new number + 1 of an old input */
  dvi__node *rest, *moving; /* Z and P of old nodes. `moving` is NULL if only Z is wanted. */
  int block, as;            /* with block DVI__BLOCKS nothing moves */
  int linear;               /* P is the part of degree 1 alone */
} copy;

static dvi__node copy_apply(copy *c, dvi__op op, dvi__node a, dvi__node b)
{
  return dvi__apply(c->graph, op, a, b);
}

static dvi__node copy_zero(copy *c)
{
  return dvi__constant(c->graph, 0);
}

static int copy_is_zero(const copy *c, dvi__node node)
{
  double value;
  return dvi__is_constant(c->graph, node, &value) && !(value < 0) && !(value > 0);
}

/* Copy an input, from the block `as` if it moves. */
static dvi__node copy_input(copy *c, int number, int moves)
{
  if (c->of_input[number] == 0) {
    c->input[c->input_count] = c->from->input[number];
    if (moves) c->input[c->input_count].block = c->as;
    c->of_input[number] = ++c->input_count;
  }
  return dvi__input(c->graph, c->of_input[number] - 1);
}

static void copy_rest(copy *c, int i)
{
  const dvi__graph_node *node = &c->from->graph->node[i];
  if (node->op == DVI__OP_CONSTANT) {
    c->rest[i] = dvi__constant(c->graph, node->value);
  } else if (node->op == DVI__OP_INPUT) {
    const dvi__kernel_input *input = &c->from->input[node->a];
    const int moves = !input->is_data && input->block == c->block;
    c->rest[i] = moves ? copy_zero(c) : copy_input(c, node->a, 0);
  } else if (node->op == DVI__OP_POWER) {
    c->rest[i] = dvi__power(c->graph, c->rest[node->a], node->value);
  } else
    c->rest[i] = copy_apply(c, node->op, c->rest[node->a], c->rest[node->b]);
}

/* Return P of a product, (Z_a + P_a)(Z_b + P_b). */
static dvi__node moving_product(copy *c, int a, int b)
{
  const dvi__node mixed = copy_apply(c, DVI__OP_ADD,
                                     copy_apply(c, DVI__OP_MULTIPLY, c->moving[a], c->rest[b]),
                                     copy_apply(c, DVI__OP_MULTIPLY, c->rest[a], c->moving[b]));
  if (c->linear) return mixed;
  return copy_apply(c, DVI__OP_ADD, mixed,
                    copy_apply(c, DVI__OP_MULTIPLY, c->moving[a], c->moving[b]));
}

static void copy_moving(copy *c, int i)
{
  const dvi__graph_node *node = &c->from->graph->node[i];
  const int a = node->a, b = node->b;
  switch (node->op) {
  case DVI__OP_INPUT: {
    const dvi__kernel_input *input = &c->from->input[a];
    c->moving[i] = !input->is_data && input->block == c->block ? copy_input(c, a, 1) : copy_zero(c);
    break;
  }
  case DVI__OP_NEGATE: c->moving[i] = copy_apply(c, DVI__OP_NEGATE, c->moving[a], 0); break;
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT: c->moving[i] = copy_apply(c, node->op, c->moving[a], c->moving[b]); break;
  case DVI__OP_DIVIDE:
    c->moving[i] = copy_apply(c, DVI__OP_DIVIDE, c->moving[a], c->rest[b]);
    break;
  case DVI__OP_WHERE: c->moving[i] = copy_apply(c, DVI__OP_WHERE, c->rest[a], c->moving[b]); break;
  case DVI__OP_MULTIPLY: c->moving[i] = moving_product(c, a, b); break;
  case DVI__OP_SQUARE:
    c->moving[i] = !c->linear && copy_is_zero(c, c->rest[a])
                       ? copy_apply(c, DVI__OP_SQUARE, c->moving[a], 0)
                       : moving_product(c, a, a);
    break;
  default: c->moving[i] = copy_zero(c); /* of degree 0, or not split */
  }
}

/* Mark the nodes that a root needs. */
static void mark_needed(const dvi__graph *graph, dvi__node root, char *needed)
{
  needed[root] = 1;
  for (int i = root; i >= 0; i--) {
    if (!needed[i]) continue;
    if (dvi__operands(graph->node[i].op) > 0) needed[graph->node[i].a] = 1;
    if (dvi__operands(graph->node[i].op) > 1) needed[graph->node[i].b] = 1;
  }
}

static void copy_nodes(copy *c, const char *needed)
{
  for (int i = 0; i <= c->from->root; i++) {
    if (!needed[i]) continue;
    c->graph->here = c->from->graph->node[i].span;
    copy_rest(c, i);
    if (c->moving != NULL) copy_moving(c, i);
  }
}

static void free_work(copy *c, char *needed)
{
  dvi__heap_free(c->of_input);
  dvi__heap_free(c->rest);
  dvi__heap_free(c->moving);
  dvi__heap_free(needed);
}

typedef enum part { AT_REST, MOVING, LINEAR } part;

/* Copy Z of a kernel, or P, or the linear part of P, into a kernel of its own. The arena owns it,
 * but for the nodes of its graph. */
static bool copy_part(dvi_scene *scene, const dvi__kernel *from, int block, int as, part which,
                      dvi__kernel *to)
{
  const size_t nodes = (size_t)from->root + 1, inputs = (size_t)from->input_count + 1;
  const int moving = which != AT_REST;
  char *needed = dvi__heap_take(nodes, 1);
  copy c = {.from = from, .block = block, .as = as, .linear = which == LINEAR};
  c.graph = dvi__arena_take(&scene->arena, 1, sizeof *c.graph);
  c.input = dvi__arena_take(&scene->arena, inputs, sizeof *c.input);
  c.of_input = dvi__heap_take(inputs, sizeof *c.of_input);
  c.rest = dvi__heap_take(nodes, sizeof *c.rest);
  if (moving) c.moving = dvi__heap_take(nodes, sizeof *c.moving);
  const int made = needed != NULL && c.graph != NULL && c.input != NULL && c.of_input != NULL &&
                   c.rest != NULL && (!moving || c.moving != NULL);
  if (made) {
    mark_needed(from->graph, from->root, needed);
    copy_nodes(&c, needed);
    *to = (dvi__kernel){.graph = c.graph,
                        .root = moving ? c.moving[from->root] : c.rest[from->root],
                        .elements = from->elements,
                        .input_count = c.input_count,
                        .input = c.input};
  }
  const bool good = made && c.graph->failed == DVI_OK;
  free_work(&c, needed);
  if (!good && c.graph != NULL) dvi__graph_free(c.graph);
  return good || dvi__scene_no_memory(scene);
}

void dvi__kernels_free(dvi__kernels *list)
{
  for (int k = 0; k < list->count; k++) dvi__graph_free(list->kernel[k].graph);
  dvi__heap_free(list->kernel);
  *list = (dvi__kernels){0};
}

/* Put a kernel at the end of a list, which takes it over. A kernel that is zero is dropped. */
static bool append_kernel(dvi_scene *scene, dvi__kernels *list, const dvi__kernel *kernel)
{
  double value;
  if (dvi__is_constant(kernel->graph, kernel->root, &value) && !(value < 0) && !(value > 0)) {
    dvi__graph_free(kernel->graph);
    return true;
  }
  dvi__kernel *longer = dvi__heap_grow(list->kernel, (size_t)list->count, sizeof *longer);
  if (longer == NULL) {
    dvi__graph_free(kernel->graph);
    return dvi__scene_no_memory(scene);
  }
  list->kernel = longer;
  list->kernel[list->count++] = *kernel;
  return true;
}

/* Append a copy of the nodes that a kernel's root needs. */
static bool append_needed(dvi_scene *scene, dvi__kernels *list, const dvi__kernel *kernel)
{
  dvi__kernel needed;
  if (!copy_part(scene, kernel, DVI__BLOCKS, DVI__BLOCKS, AT_REST, &needed)) return false;
  return append_kernel(scene, list, &needed);
}

bool dvi__kernels_add_node(dvi__context *c, dvi__node root, dvi__kernels *list)
{
  if (c->graph->failed == DVI_BAD_SIZE)
    return dvi__complain(c->scene->complaint, DVI_BAD_SIZE, DVI__NOWHERE,
                         "more than 2000000 parts, with all sums written out");
  if (c->graph->failed != DVI_OK) return dvi__scene_no_memory(c->scene);
  if (c->scene->complaint->status != DVI_OK) return false;
  const dvi__kernel all = {.graph = c->graph,
                           .root = root,
                           .elements = c->elements,
                           .input_count = c->input_count,
                           .input = c->input};
  return append_needed(c->scene, list, &all);
}

bool dvi__kernels_at_rest(dvi_scene *scene, const dvi__kernels *of, int block, int negative,
                          dvi__kernels *list)
{
  for (int k = 0; k < of->count; k++) {
    dvi__kernel one;
    if (!copy_part(scene, &of->kernel[k], block, block, AT_REST, &one)) return false;
    if (negative) one.root = dvi__apply(one.graph, DVI__OP_NEGATE, one.root, 0);
    const bool added = append_needed(scene, list, &one);
    dvi__graph_free(one.graph);
    if (!added) return false;
  }
  return true;
}

static bool append_parts(dvi_scene *scene, const dvi__kernels *of, int block, int as, part which,
                         dvi__kernels *list)
{
  for (int k = 0; k < of->count; k++) {
    dvi__kernel one;
    if (!copy_part(scene, &of->kernel[k], block, as, which, &one)) return false;
    const bool added = append_needed(scene, list, &one);
    dvi__graph_free(one.graph);
    if (!added) return false;
  }
  return true;
}

bool dvi__kernels_moving(dvi_scene *scene, const dvi__kernels *of, int block, int as,
                         dvi__kernels *list)
{
  return append_parts(scene, of, block, as, MOVING, list);
}

bool dvi__kernels_linear(dvi_scene *scene, const dvi__kernels *of, int block, int as,
                         dvi__kernels *list)
{
  return append_parts(scene, of, block, as, LINEAR, list);
}

/* ---- degrees ---- */

static dvi__degree degree_of_product(dvi__degree a, dvi__degree b)
{
  const int degree = a.degree + b.degree;
  const int pure = (a.degree == 0 || (a.pure && !b.moves)) &&
                   (b.degree == 0 || (b.pure && !a.moves));
  const int squares = (a.degree < 2 || (a.squares && !b.moves)) &&
                      (b.degree < 2 || (b.squares && !a.moves)) &&
                      (a.degree == 0 || b.degree == 0 || (a.pure && b.pure));
  return (dvi__degree){degree > 3 ? 3 : degree, pure, a.moves || b.moves, squares};
}

static dvi__degree degree_of_input(const dvi__kernel_input *input, int block)
{
  if (input->is_data) return (dvi__degree){.pure = 1, .squares = 1};
  return input->block == block ? (dvi__degree){.degree = 1, .pure = 1, .squares = 1}
                               : (dvi__degree){.pure = 1, .moves = 1, .squares = 1};
}

static dvi__degree degree_of_other(dvi__degree a, dvi__degree b)
{
  if (a.degree > 0 || b.degree > 0) return (dvi__degree){.degree = 3, .moves = 1};
  return (dvi__degree){.pure = 1, .moves = a.moves || b.moves, .squares = 1};
}

static dvi__degree degree_of_node(const dvi__kernel *kernel, int block, const dvi__degree *known,
                                  int i)
{
  static const dvi__degree none = {.pure = 1, .squares = 1};
  const dvi__graph_node *node = &kernel->graph->node[i];
  switch (node->op) {
  case DVI__OP_CONSTANT: return none;
  case DVI__OP_INPUT: return degree_of_input(&kernel->input[node->a], block);
  case DVI__OP_NEGATE: return known[node->a];
  case DVI__OP_SQUARE: return degree_of_product(known[node->a], known[node->a]);
  case DVI__OP_MULTIPLY: return degree_of_product(known[node->a], known[node->b]);
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT: {
    const dvi__degree a = known[node->a], b = known[node->b];
    return (dvi__degree){a.degree > b.degree ? a.degree : b.degree, a.pure && b.pure,
                         a.moves || b.moves, a.squares && b.squares};
  }
  case DVI__OP_DIVIDE:
    return known[node->b].degree > 0 ? degree_of_other(known[node->a], known[node->b])
                                     : degree_of_product(known[node->a], known[node->b]);
  case DVI__OP_WHERE:
    return known[node->a].degree > 0 ? degree_of_other(known[node->a], known[node->b])
                                     : degree_of_product(known[node->a], known[node->b]);
  case DVI__OP_RAISE:
  case DVI__OP_ATAN2: return degree_of_other(known[node->a], known[node->b]);
  default: return degree_of_other(known[node->a], none);
  }
}

static int is_sum(dvi__op op)
{
  return op == DVI__OP_ADD || op == DVI__OP_SUBTRACT;
}

/* Set fits[i] to 1 if a node is of degree 0, or of degree 2 and pure. All terms of a sum must
 * be. */
static void find_fits(const dvi__kernel *kernel, int block, dvi__degree *known, char *fits)
{
  for (int i = 0; i <= kernel->root; i++) {
    const dvi__graph_node *node = &kernel->graph->node[i];
    known[i] = degree_of_node(kernel, block, known, i);
    fits[i] = is_sum(node->op) ? fits[node->a] && fits[node->b]
                               : known[i].degree == 0 || (known[i].degree == 2 && known[i].pure);
  }
}

bool dvi__kernel_other_term(dvi_scene *scene, const dvi__kernel *kernel, int block, dvi__span *span,
                            int *found)
{
  const dvi__graph_node *node = kernel->graph->node;
  dvi__degree *known = dvi__heap_take((size_t)kernel->root + 1, sizeof *known);
  char *fits = dvi__heap_take((size_t)kernel->root + 1, 1);
  const bool good = (known != NULL && fits != NULL) || dvi__scene_no_memory(scene);
  if (good) {
    int at = kernel->root, sum = at;
    find_fits(kernel, block, known, fits);
    *found = !fits[at];
    for (; is_sum(node[at].op); at = fits[node[at].a] ? node[at].b : node[at].a) sum = at;
    *span =
        /* an input has the span of its first use */
        node[node[at].op == DVI__OP_INPUT ? sum : at].span;
  }
  dvi__heap_free(known);
  dvi__heap_free(fits);
  return good;
}

bool dvi__kernel_degree(dvi_scene *scene, const dvi__kernel *kernel, int block, dvi__degree *degree)
{
  dvi__degree *known = dvi__heap_take((size_t)kernel->root + 1, sizeof *known);
  if (known == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i <= kernel->root; i++) known[i] = degree_of_node(kernel, block, known, i);
  *degree = known[kernel->root];
  dvi__heap_free(known);
  return true;
}

bool dvi__kernels_degree(dvi_scene *scene, const dvi__kernels *list, int block, dvi__degree *whole)
{
  *whole = (dvi__degree){.pure = 1, .squares = 1};
  for (int k = 0; k < list->count; k++) {
    dvi__degree one = {0};
    if (!dvi__kernel_degree(scene, &list->kernel[k], block, &one)) return false;
    if (one.degree > whole->degree) whole->degree = one.degree;
    whole->pure = whole->pure && one.pure;
    whole->squares = whole->squares && one.squares;
  }
  return true;
}
