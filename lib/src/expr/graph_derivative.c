/* Derivatives, by the reverse mode (of one number by everything) and by the forward mode (of
 * everything by one number). Both take a node's derivatives by its operands from one table. They do
 * not visit parts that do not depend on the inputs. */
#include <stdlib.h>

#include "expr/graph_decay.h"
#include "expr/graph_make.h"
#include "text/heap.h"

enum { NONE = -1 }; /* no node, a derivative that is zero */

/* Return 1 + n^2. */
static dvi__node one_and_square(dvi__graph *graph, dvi__node n)
{
  return dvi__add(graph, dvi__constant(graph, 1), dvi__square(graph, n));
}

/* Return (n - 1)(n + 1), which is exact near 1. */
static dvi__node square_less_one(dvi__graph *graph, dvi__node n)
{
  const dvi__node one = dvi__constant(graph, 1);
  return dvi__multiply(graph, dvi__subtract(graph, n, one), dvi__add(graph, n, one));
}

/* Return (1 - n^2)^(-1/2). */
static dvi__node inverse_root(dvi__graph *graph, dvi__node n)
{
  return dvi__power(graph, dvi__negate(graph, square_less_one(graph, n)), -0.5);
}

/* Return 1/n where n is positive, and no number elsewhere. A function that ends at 0 must not go on
 * in its derivative. */
static dvi__node inverse_inside(dvi__graph *graph, dvi__node n)
{
  return dvi__power(graph, dvi__power(graph, n, -0.5), 2);
}

/* Return ((n - 1)(n + 1))^(-1/2) for n > 1 alone. */
static dvi__node inverse_roots(dvi__graph *graph, dvi__node n)
{
  const dvi__node one = dvi__constant(graph, 1);
  return dvi__multiply(graph, dvi__power(graph, dvi__subtract(graph, n, one), -0.5),
                       dvi__power(graph, dvi__add(graph, n, one), -0.5));
}

/* Derive node n of one operand by that operand. */
static dvi__node slope_of_unary(dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node node = graph->node[n];
  const dvi__node a = node.a;
  switch (node.op) {
  case DVI__OP_NEGATE: return dvi__constant(graph, -1);
  case DVI__OP_SQUARE: return dvi__scale(graph, 2, a);
  case DVI__OP_SQRT: return dvi__scale(graph, 0.5, dvi__power(graph, a, -0.5));
  case DVI__OP_POWER: return dvi__scale(graph, node.value, dvi__power(graph, a, node.value - 1));
  case DVI__OP_EXP: return n;
  case DVI__OP_LOG: return inverse_inside(graph, a);
  case DVI__OP_SIN: return dvi__apply(graph, DVI__OP_COS, a, 0);
  case DVI__OP_COS: return dvi__negate(graph, dvi__apply(graph, DVI__OP_SIN, a, 0));
  case DVI__OP_TAN: return one_and_square(graph, n);
  case DVI__OP_ASIN: return inverse_root(graph, a);
  case DVI__OP_ACOS: return dvi__negate(graph, inverse_root(graph, a));
  case DVI__OP_ATAN: return dvi__power(graph, one_and_square(graph, a), -1);
  case DVI__OP_SINH: return dvi__apply(graph, DVI__OP_COSH, a, 0);
  case DVI__OP_COSH: return dvi__apply(graph, DVI__OP_SINH, a, 0);
  case DVI__OP_TANH: return dvi__power(graph, dvi__apply(graph, DVI__OP_COSH, a, 0), -2);
  case DVI__OP_ASINH: return dvi__power(graph, one_and_square(graph, a), -0.5);
  case DVI__OP_ACOSH: return inverse_roots(graph, a);
  case DVI__OP_ATANH: return inverse_inside(graph, dvi__negate(graph, square_less_one(graph, a)));
  case DVI__OP_ABS: return dvi__apply(graph, DVI__OP_SIGN, a, 0);
  default: return dvi__constant(graph, 0); /* of SIGN, FLOOR, POSITIVE */
  }
}

/* Derive node n of two operands by the first of them. */
static dvi__node slope_by_first(dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node node = graph->node[n];
  const dvi__node one = dvi__constant(graph, 1);
  switch (node.op) {
  case DVI__OP_MULTIPLY: return node.b;
  case DVI__OP_DIVIDE: return dvi__power(graph, node.b, -1);
  case DVI__OP_RAISE:
    return dvi__multiply(
        graph, node.b, dvi__apply(graph, DVI__OP_RAISE, node.a, dvi__subtract(graph, node.b, one)));
  case DVI__OP_ATAN2:
    return dvi__divide(graph, node.b,
                       dvi__add(graph, dvi__square(graph, node.a), dvi__square(graph, node.b)));
  case DVI__OP_WHERE: return dvi__constant(graph, 0);
  default: return one; /* of ADD and SUBTRACT */
  }
}

static dvi__node slope_by_second(dvi__graph *graph, dvi__node n)
{
  const dvi__graph_node node = graph->node[n];
  switch (node.op) {
  case DVI__OP_SUBTRACT: return dvi__constant(graph, -1);
  case DVI__OP_MULTIPLY: return node.a;
  case DVI__OP_DIVIDE: return dvi__negate(graph, dvi__divide(graph, n, node.b));
  case DVI__OP_RAISE: return dvi__multiply(graph, n, dvi__apply(graph, DVI__OP_LOG, node.a, 0));
  case DVI__OP_ATAN2:
    return dvi__negate(graph, dvi__divide(graph, node.a,
                                          dvi__add(graph, dvi__square(graph, node.a),
                                                   dvi__square(graph, node.b))));
  case DVI__OP_WHERE: return dvi__where(graph, node.a, dvi__constant(graph, 1));
  default: return dvi__constant(graph, 1); /* of ADD */
  }
}

/* Return 1 for a quotient whose numerator is not a constant. Both modes divide once for it. */
static int is_quotient(const dvi__graph *graph, dvi__node n)
{
  return graph->node[n].op == DVI__OP_DIVIDE &&
         graph->node[graph->node[n].a].op != DVI__OP_CONSTANT;
}

/* Return 1 if a node depends on inputs below `count`, or on input `only` if that is not NONE. It
 * must be known of its operands. */
static int node_depends(const dvi__graph *graph, int count, int only, const char *part, dvi__node n)
{
  const dvi__graph_node *node = graph->node + n;
  const int operands = dvi__operands(node->op);
  if (node->op == DVI__OP_INPUT) return only == NONE ? node->a < count : node->a == only;
  return (operands > 0 && part[node->a] != 0) || (operands > 1 && part[node->b] != 0);
}

static void fail_without_memory(dvi__graph *graph)
{
  if (graph->failed == DVI_OK) graph->failed = DVI_NO_MEMORY;
}

/* Take [size] nodes, filled with NONE. */
static dvi__node *new_derivatives(int size)
{
  dvi__node *derivative = dvi__heap_take((size_t)size + 1, sizeof *derivative);
  for (int n = 0; n < size && derivative != NULL; n++) derivative[n] = NONE;
  return derivative;
}

static int derivative_is_zero(const dvi__graph *graph, dvi__node n)
{
  double value;
  return n == NONE || (dvi__is_constant(graph, n, &value) && value == 0);
}

/* Return true if a condition guards a derivative. */
static bool is_guarded(const dvi__graph *graph, dvi__node n)
{
  return graph->failed == DVI_OK && graph->node[n].op == DVI__OP_WHERE;
}

/* Add two shares in the derivative by a node. The node's derivatives need not exist where no
 * condition takes it. Guards that all shares have guard their sum. */
static dvi__node add_shares(dvi__graph *graph, dvi__node to, dvi__node a, dvi__node b)
{
  const dvi__node sum = dvi__add(graph, a, b);
  if (graph->node[to].op == DVI__OP_INPUT || !is_guarded(graph, a) || !is_guarded(graph, b))
    return sum;
  const dvi__node c = graph->node[a].a, d = graph->node[b].a, always = dvi__constant(graph, 1);
  if (c == d || d == dvi__complement(graph, c)) return sum;
  return dvi__where(graph, dvi__choice(graph, c, always, d), sum);
}

/* Add a share to the derivative of the root by a node. */
static void give_share(dvi__graph *graph, const char *part, dvi__node *adjoint, dvi__node to,
                       dvi__node share)
{
  if (part[to])
    adjoint[to] = adjoint[to] == NONE ? share : add_shares(graph, to, adjoint[to], share);
}

/* Hand the derivative of the root by node n on to its operands. */
static void pull_back(dvi__graph *graph, const char *part, dvi__node *adjoint, dvi__node n)
{
  const dvi__graph_node node = graph->node[n];
  const int operands = dvi__operands(node.op);
  dvi__decay decay;
  if (dvi__decays(graph, n, &decay)) {
    if (is_quotient(graph, n))
      give_share(graph, part, adjoint, node.a, dvi__divide(graph, adjoint[n], node.b));
    give_share(graph, part, adjoint, decay.inner,
               dvi__multiply(graph, dvi__multiply(graph, adjoint[n], n), decay.slope));
    return;
  }
  if (is_quotient(graph, n)) {
    const dvi__node share = dvi__divide(graph, adjoint[n], node.b);
    give_share(graph, part, adjoint, node.a, share);
    if (part[node.b])
      give_share(graph, part, adjoint, node.b, dvi__negate(graph, dvi__multiply(graph, share, n)));
    return;
  }
  if (operands == 1)
    give_share(graph, part, adjoint, node.a,
               dvi__multiply(graph, adjoint[n], slope_of_unary(graph, n)));
  if (operands < 2) return;
  if (part[node.a])
    give_share(graph, part, adjoint, node.a,
               dvi__multiply(graph, adjoint[n], slope_by_first(graph, n)));
  if (part[node.b])
    give_share(graph, part, adjoint, node.b,
               dvi__multiply(graph, adjoint[n], slope_by_second(graph, n)));
}

static void pull_back_all(dvi__graph *graph, dvi__node root, int count, const char *part,
                          dvi__node *adjoint, dvi__node *gradient)
{
  const dvi__span here = graph->here;
  adjoint[root] = dvi__constant(graph, 1);
  for (int n = root; n >= 0 && graph->failed == DVI_OK; n--) {
    if (!part[n] || derivative_is_zero(graph, adjoint[n])) continue;
    graph->here = graph->node[n].span;
    if (graph->node[n].op != DVI__OP_INPUT)
      pull_back(graph, part, adjoint, n);
    else if (graph->node[n].a < count)
      gradient[graph->node[n].a] = adjoint[n];
  }
  graph->here = here;
}

void dvi__gradient(dvi__graph *graph, dvi__node root, int count, dvi__node *gradient)
{
  const dvi__node zero = dvi__constant(graph, 0);
  for (int i = 0; i < count; i++) gradient[i] = zero;
  if (graph->failed != DVI_OK) return;
  int size;
  char *part = dvi__parts(graph, 1, &root, &size);
  dvi__node *adjoint = new_derivatives(size);
  if (part == NULL || adjoint == NULL) {
    fail_without_memory(graph);
  } else {
    for (int n = 0; n < size; n++) part[n] = part[n] && node_depends(graph, count, NONE, part, n);
    pull_back_all(graph, root, count, part, adjoint, gradient);
  }
  dvi__heap_free(part);
  dvi__heap_free(adjoint);
}

/* Derive node n, whose operands are derived. */
static dvi__node push_forward(dvi__graph *graph, const dvi__node *tangent, dvi__node n)
{
  const dvi__graph_node node = graph->node[n];
  const int operands = dvi__operands(node.op);
  const dvi__node zero = dvi__constant(graph, 0);
  const dvi__node a = derivative_is_zero(graph, tangent[node.a]) ? zero : tangent[node.a];
  dvi__decay decay;
  if (dvi__decays(graph, n, &decay)) {
    const dvi__node first = is_quotient(graph, n) ? dvi__divide(graph, a, node.b) : zero;
    return derivative_is_zero(graph, tangent[decay.inner])
               ? first
               : dvi__add(graph, first,
                          dvi__multiply(graph, dvi__multiply(graph, n, decay.slope),
                                        tangent[decay.inner]));
  }
  if (operands == 1) return dvi__multiply(graph, slope_of_unary(graph, n), a);
  const dvi__node b = derivative_is_zero(graph, tangent[node.b]) ? zero : tangent[node.b];
  if (is_quotient(graph, n))
    return dvi__divide(graph, dvi__subtract(graph, a, dvi__multiply(graph, n, b)), node.b);
  const dvi__node first = a == zero ? zero : dvi__multiply(graph, slope_by_first(graph, n), a);
  return b == zero ? first
                   : dvi__add(graph, first, dvi__multiply(graph, slope_by_second(graph, n), b));
}

/* Derive all parts from the derivatives of the inputs. Parts that do not depend on these get
 * NONE. */
static void push_forward_all(dvi__graph *graph, int count, const dvi__node *rate)
{
  const dvi__span here = graph->here;
  const dvi__tangent_room *room = &graph->room;
  for (int k = 0; k < count && graph->failed == DVI_OK; k++) {
    const dvi__node n = room->list[k];
    if (!room->part[n]) continue;
    graph->here = graph->node[n].span;
    room->tangent[n] = graph->node[n].op != DVI__OP_INPUT ? push_forward(graph, room->tangent, n)
                       : rate == NULL                     ? dvi__constant(graph, 1)
                                                          : rate[graph->node[n].a];
  }
  graph->here = here;
}

/* ---- the parts of some nodes ---- */

/* Make room for all nodes of the graph. */
static bool tangents_make_room(dvi__graph *graph, int size)
{
  dvi__tangent_room *room = &graph->room;
  if (size <= room->size) return true;
  dvi__tangent_room_free(room);
  room->part = dvi__heap_take((size_t)graph->count, 1);
  room->tangent = new_derivatives(graph->count);
  room->list = dvi__heap_take((size_t)graph->count, sizeof *room->list);
  if (room->part == NULL || room->tangent == NULL || room->list == NULL) return false;
  room->size = graph->count;
  return true;
}

static void reach_node(const dvi__tangent_room *room, dvi__node n, int *count)
{
  if (room->part[n]) return;
  room->part[n] = 1;
  room->list[(*count)++] = n;
}

static int compare_nodes(const void *a, const void *b)
{
  return *(const dvi__node *)a - *(const dvi__node *)b;
}

/* List and mark the parts of the roots, operands first. If the roots are a small part of the graph,
 * the list is sorted instead of passing over the whole graph. A long sum has as many roots as
 * inputs. */
static int list_parts(const dvi__graph *graph, int root_count, const dvi__node *root, int size)
{
  enum { SMALL = 32 };
  const dvi__tangent_room *room = &graph->room;
  int count = 0, listed = 0;
  for (int k = 0; k < root_count; k++) reach_node(room, root[k], &count);
  for (int k = 0; k < count; k++) {
    const dvi__graph_node *node = graph->node + room->list[k];
    const int operands = dvi__operands(node->op);
    if (operands > 0) reach_node(room, node->a, &count);
    if (operands > 1) reach_node(room, node->b, &count);
  }
  if (count < size / SMALL) {
    qsort(room->list, (size_t)count, sizeof *room->list, compare_nodes);
    return count;
  }
  for (int n = 0; n < size; n++)
    if (room->part[n]) room->list[listed++] = n;
  return count;
}

/* Derive nodes by one input, or along the rates of inputs 0 .. count-1. */
static void derive_forward(dvi__graph *graph, int only, int count, const dvi__node *rate,
                           int root_count, const dvi__node *root, dvi__node *result)
{
  const dvi__node zero = dvi__constant(graph, 0);
  int size = 0;
  for (int k = 0; k < root_count; k++) result[k] = zero;
  for (int k = 0; k < root_count; k++) size = root[k] < size ? size : root[k] + 1;
  if (graph->failed != DVI_OK) return;
  if (!tangents_make_room(graph, size)) {
    fail_without_memory(graph);
    return;
  }
  const dvi__tangent_room *room = &graph->room;
  const int parts = list_parts(graph, root_count, root, size);
  for (int k = 0; k < parts; k++)
    room->part[room->list[k]] = (char)node_depends(graph, count, only, room->part, room->list[k]);
  push_forward_all(graph, parts, rate);
  for (int k = 0; k < root_count; k++)
    result[k] = derivative_is_zero(graph, room->tangent[root[k]]) ? zero : room->tangent[root[k]];
  for (int k = 0; k < parts; k++) {
    room->part[room->list[k]] = 0;
    room->tangent[room->list[k]] = NONE;
  }
}

void dvi__tangents(dvi__graph *graph, int input, int count, const dvi__node *of, dvi__node *tangent)
{
  derive_forward(graph, input, 0, NULL, count, of, tangent);
}

void dvi__rates(dvi__graph *graph, int root_count, const dvi__node *root, int count,
                const dvi__node *rate, dvi__node *result)
{
  derive_forward(graph, NONE, count, rate, root_count, root, result);
}
