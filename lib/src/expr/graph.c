#include "expr/graph.h"

#include <stdint.h>
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"

enum { LIMIT = 2000000 };

void dvi__tangent_room_free(dvi__tangent_room *room)
{
  dvi__heap_free(room->part);
  dvi__heap_free(room->tangent);
  dvi__heap_free(room->list);
  *room = (dvi__tangent_room){0};
}

void dvi__graph_free(dvi__graph *graph)
{
  dvi__tangent_room_free(&graph->room);
  dvi__heap_free(graph->node);
  dvi__heap_free(graph->table);
  *graph = (dvi__graph){0};
}

int dvi__operands(dvi__op op)
{
#define OPERANDS(name, operands, spelling) operands,
  static const int count[] = {DVI__OP_LIST(OPERANDS)};
#undef OPERANDS
  return count[op];
}

static uint64_t bits_of(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* Return the slot where the search for an equal node begins. */
static unsigned node_slot(const dvi__graph_node *node, int table_size)
{
  uint64_t hash = bits_of(node->value) * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)node->op;
  hash = (hash ^ (hash >> 29)) * UINT64_C(0xbf58476d1ce4e5b9) + (uint64_t)node->a;
  hash = (hash ^ (hash >> 32)) * UINT64_C(0x94d049bb133111eb) + (uint64_t)node->b;
  hash = (hash ^ (hash >> 29)) * UINT64_C(0x9e3779b97f4a7c15);
  return (unsigned)(hash >> 32) & (unsigned)(table_size - 1);
}

static bool nodes_equal(const dvi__graph_node *x, const dvi__graph_node *y)
{
  return x->op == y->op && x->a == y->a && x->b == y->b && bits_of(x->value) == bits_of(y->value);
}

/* Find the slot of an equal node, or the free one where it belongs. Slots hold numbers from 1. */
static int *find_slot(const dvi__graph *graph, const dvi__graph_node *wanted)
{
  unsigned at = node_slot(wanted, graph->table_size);
  while (graph->table[at] != 0 && !nodes_equal(&graph->node[graph->table[at] - 1], wanted))
    at = (at + 1) & (unsigned)(graph->table_size - 1);
  return graph->table + at;
}

/* Double the room. The table stays at most half full. */
static dvi_status graph_grow(dvi__graph *graph)
{
  const int room = graph->count == 0 ? 1 : 2 * graph->count;
  dvi__graph_node *node = dvi__heap_grow(graph->node, (size_t)graph->count, sizeof *node);
  if (node == NULL) return DVI_NO_MEMORY;
  graph->node = node;
  int *table = dvi__heap_take(2 * (size_t)room, sizeof *table);
  if (table == NULL) return DVI_NO_MEMORY;
  dvi__heap_free(graph->table);
  graph->table = table;
  graph->table_size = 2 * room;
  for (int n = 0; n < graph->count; n++) *find_slot(graph, graph->node + n) = n + 1;
  return DVI_OK;
}

/* Return 1 if a value is never below zero. It may be a root's argument, or NaN. */
static int never_negative(const dvi__graph *graph, const dvi__graph_node *node)
{
  switch (node->op) {
  case DVI__OP_CONSTANT: return node->value >= 0;
  case DVI__OP_SQUARE:
  case DVI__OP_SQRT:
  case DVI__OP_EXP:
  case DVI__OP_COSH:
  case DVI__OP_ACOS:
  case DVI__OP_ACOSH:
  case DVI__OP_POSITIVE:
  case DVI__OP_ABS: return 1;
  case DVI__OP_WHERE: return graph->node[node->b].never_negative;
  case DVI__OP_POWER:
    return graph->node[node->a].never_negative || node->value / 2 == (int)(node->value / 2) ||
           node->value != (int)node->value;
  case DVI__OP_ADD:
  case DVI__OP_MULTIPLY:
  case DVI__OP_DIVIDE:
    return graph->node[node->a].never_negative && graph->node[node->b].never_negative;
  default: return 0;
  }
}

/* Return an equal node or -1. */
static dvi__node find_node(const dvi__graph *graph, const dvi__graph_node *wanted)
{
  return graph->table_size == 0 ? -1 : *find_slot(graph, wanted) - 1;
}

/* Make room for one more node. */
static dvi_status graph_make_room(dvi__graph *graph)
{
  if (graph->count >= (graph->limit == 0 ? LIMIT : graph->limit)) return DVI_BAD_SIZE;
  return 2 * graph->count < graph->table_size ? DVI_OK : graph_grow(graph);
}

dvi__node dvi__make(dvi__graph *graph, dvi__op op, dvi__node a, dvi__node b, double value)
{
  if (graph->failed != DVI_OK) return 0;
  dvi__graph_node wanted = {.op = op, .a = a, .b = b, .value = value, .span = graph->here};
  const dvi__node same = find_node(graph, &wanted);
  if (same >= 0) return same;
  graph->failed = graph_make_room(graph);
  if (graph->failed != DVI_OK) return 0;
  wanted.never_negative = never_negative(graph, &wanted);
  graph->node[graph->count] = wanted;
  *find_slot(graph, &wanted) = graph->count + 1;
  return graph->count++;
}

dvi__node dvi__constant(dvi__graph *graph, double value)
{
  return dvi__make(graph, DVI__OP_CONSTANT, 0, 0,
                   value == 0 ? 0.0 : value); /* one zero, without a sign */
}

dvi__node dvi__input(dvi__graph *graph, int number)
{
  return dvi__make(graph, DVI__OP_INPUT, number, 0, 0);
}

bool dvi__is_constant(const dvi__graph *graph, dvi__node node, double *value)
{
  if (graph->failed != DVI_OK || graph->node[node].op != DVI__OP_CONSTANT) return false;
  *value = graph->node[node].value;
  return true;
}
