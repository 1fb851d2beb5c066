/* Patterns of second derivatives that can differ from zero.
 *
 * A node f(a, b) adds to the second derivatives of the root products with f_aa, f_ab and f_bb.
 * Their pairs of inputs are those on which a and a, a and b, b and b depend. So the pattern is the
 * union, over all nodes that are not linear, of products of the sets of inputs of their operands
 * (Walther 2008). Sets are sorted lists, equal ones mostly shared. They are made only below nodes
 * that are not linear. */
#include <stdint.h>
#include <string.h>

#include "text/arena.h"
#include "expr/graph_make.h"
#include "text/heap.h"

typedef struct set {
  int count;
  const int *input; /* [count], ascending, owned by the arena */
} set;

/* Pairs (i,j), i >= j, as keys j << 32 | i, in a table at most half full. A free slot is FREE. */
typedef struct pairs {
  uint64_t *key;
  size_t room, count;
} pairs;

static const uint64_t FREE = UINT64_MAX;
static const size_t PAIRS_MAX = 20000000;

enum { CURVED_AA = 1, CURVED_AB = 2, CURVED_BB = 4 };
enum { REACHED = 1, SET_NEEDED = 2 };

/* Return flags of the second derivatives of an operation by its operands that differ from zero. */
static int node_curvature(const dvi__graph *graph, const dvi__graph_node *node)
{
  switch (node->op) {
  case DVI__OP_CONSTANT:
  case DVI__OP_INPUT:
  case DVI__OP_NEGATE:
  case DVI__OP_ABS:
  case DVI__OP_SIGN:
  case DVI__OP_FLOOR:
  case DVI__OP_POSITIVE:
  case DVI__OP_WHERE:
  case DVI__OP_ADD:
  case DVI__OP_SUBTRACT: return 0;
  case DVI__OP_MULTIPLY:
    return graph->node[node->a].op == DVI__OP_CONSTANT ||
                   graph->node[node->b].op == DVI__OP_CONSTANT
               ? 0
               : CURVED_AB;
  case DVI__OP_DIVIDE:
    return graph->node[node->b].op == DVI__OP_CONSTANT ? 0 : CURVED_AB | CURVED_BB;
  case DVI__OP_RAISE:
  case DVI__OP_ATAN2: return CURVED_AA | CURVED_AB | CURVED_BB;
  default: return CURVED_AA;
  }
}

/* Mark nodes with a derivative that reaches the root, and nodes below one that is not linear. */
static void mark_parts(const dvi__graph *graph, dvi__node root, char *mark)
{
  mark[root] = REACHED;
  for (int n = root; n >= 0; n--) {
    const dvi__graph_node *node = graph->node + n;
    if (!mark[n] || dvi__is_step(node->op)) continue;
    const char below = (char)(mark[n] | (node_curvature(graph, node) ? SET_NEEDED : 0));
    const int operands = dvi__operands(node->op);
    if (operands > 0 && node->op != DVI__OP_WHERE) mark[node->a] |= below;
    if (operands > 1) mark[node->b] |= below;
  }
}

/* Merge the inputs of two sets, ascending, into `both`, which has room for all. */
static int merge_inputs(set a, set b, int *both)
{
  int count = 0, i = 0, j = 0;
  while (i < a.count && j < b.count) {
    const int x = a.input[i], y = b.input[j];
    both[count++] = x < y ? x : y;
    i += x <= y;
    j += y <= x;
  }
  while (i < a.count) both[count++] = a.input[i++];
  while (j < b.count) both[count++] = b.input[j++];
  return count;
}

/* Join two sets. If one holds the other, it is returned. */
static set join_sets(dvi__arena *arena, set a, set b, int *work)
{
  if (a.input == b.input || b.count == 0) return a;
  if (a.count == 0) return b;
  const int count = merge_inputs(a, b, work);
  if (count == a.count) return a;
  if (count == b.count) return b;
  int *input = dvi__arena_take(arena, (size_t)count, sizeof *input);
  if (input == NULL) return a;
  memcpy(input, work, (size_t)count * sizeof *input);
  return (set){count, input};
}

/* Return the set of inputs on which a node depends by its derivatives. */
static set set_of(const dvi__graph_node *node, int count, const set *sets, dvi__arena *arena,
                  int *work)
{
  const int operands = dvi__operands(node->op);
  if (node->op == DVI__OP_INPUT && node->a < count) {
    int *input = dvi__arena_take(arena, 1, sizeof *input);
    if (input != NULL) *input = node->a;
    return (set){input != NULL, input};
  }
  if (operands == 0 || dvi__is_step(node->op)) return (set){0};
  if (node->op == DVI__OP_WHERE) return sets[node->b];
  return operands == 1 ? sets[node->a] : join_sets(arena, sets[node->a], sets[node->b], work);
}

static size_t pair_slot(const pairs *p, uint64_t key)
{
  const uint64_t hash = (key ^ (key >> 32)) * UINT64_C(0x9e3779b97f4a7c15);
  size_t at = (size_t)(hash >> 20) & (p->room - 1);
  while (p->key[at] != FREE && p->key[at] != key) at = (at + 1) & (p->room - 1);
  return at;
}

/* Make room for `more` pairs. */
static dvi_status pairs_make_room(pairs *p, size_t more)
{
  size_t room = p->room == 0 ? 64 : p->room;
  if (p->count > PAIRS_MAX) return DVI_BAD_SIZE;
  while (room < 2 * (p->count + more)) room *= 2;
  if (room == p->room) return DVI_OK;
  pairs grown = {.key = dvi__heap_take(room, sizeof *grown.key), .room = room, .count = p->count};
  if (grown.key == NULL) return DVI_NO_MEMORY;
  for (size_t k = 0; k < room; k++) grown.key[k] = FREE;
  for (size_t k = 0; k < p->room; k++)
    if (p->key[k] != FREE) grown.key[pair_slot(&grown, p->key[k])] = p->key[k];
  dvi__heap_free(p->key);
  *p = grown;
  return DVI_OK;
}

static void put_pair(pairs *p, int i, int j)
{
  const uint64_t key = i > j ? (uint64_t)j << 32 | (uint64_t)i : (uint64_t)i << 32 | (uint64_t)j;
  const size_t at = pair_slot(p, key);
  if (p->key[at] == key) return;
  p->key[at] = key;
  p->count++;
}

/* Put all pairs of an input of one set and one of the other. */
static dvi_status put_pairs(pairs *p, set a, set b)
{
  dvi_status status = DVI_OK;
  for (int i = 0; i < a.count && status == DVI_OK; i++) {
    status = pairs_make_room(p, (size_t)b.count);
    for (int j = 0; j < b.count && status == DVI_OK; j++) put_pair(p, a.input[i], b.input[j]);
  }
  return status;
}

/* Put the pairs that a node adds by its second derivatives. */
static dvi_status put_node(const dvi__graph *graph, const dvi__graph_node *node, const set *sets,
                           pairs *found)
{
  const int curved = node_curvature(graph, node);
  dvi_status status = DVI_OK;
  if (curved & CURVED_AA) status = put_pairs(found, sets[node->a], sets[node->a]);
  if (status != DVI_OK) return status;
  if (curved & CURVED_AB) status = put_pairs(found, sets[node->a], sets[node->b]);
  if (status != DVI_OK) return status;
  return curved & CURVED_BB ? put_pairs(found, sets[node->b], sets[node->b]) : DVI_OK;
}

/* Find the pairs of all parts. */
static dvi_status find_pairs(const dvi__graph *graph, dvi__node root, int count, const char *mark,
                             set *sets, dvi__arena *arena, int *work, pairs *found)
{
  for (int n = 0; n <= root; n++) {
    const dvi__graph_node *node = graph->node + n;
    if (!mark[n]) continue;
    if (mark[n] & SET_NEEDED) sets[n] = set_of(node, count, sets, arena, work);
    const dvi_status status = put_node(graph, node, sets, found);
    if (status != DVI_OK) return status;
  }
  return arena->failed ? DVI_NO_MEMORY : DVI_OK;
}

/* Sort keys by the 32 bits from `shift` on, which are below `count`. Equal ones keep their order.
 * start [count + 1]. */
static void sort_by(int shift, int count, size_t size, const uint64_t *key, uint64_t *sorted,
                    size_t *start)
{
  memset(start, 0, ((size_t)count + 1) * sizeof *start);
  for (size_t k = 0; k < size; k++) start[(uint32_t)(key[k] >> shift) + 1]++;
  for (int i = 0; i < count; i++) start[i + 1] += start[i];
  for (size_t k = 0; k < size; k++) sorted[start[(uint32_t)(key[k] >> shift)]++] = key[k];
}

/* List the pairs in their order. */
static dvi_status list_pairs(pairs *found, int count, int (**list)[2])
{
  const size_t size = found->count;
  uint64_t *by_row = dvi__heap_take(size + 1, sizeof *by_row);
  size_t *start = dvi__heap_take((size_t)count + 2, sizeof *start);
  *list = dvi__heap_take(size + 1, sizeof **list);
  const int failed = by_row == NULL || start == NULL || *list == NULL;
  if (!failed) {
    size_t used = 0;
    for (size_t k = 0; k < found->room; k++)
      if (found->key[k] != FREE) found->key[used++] = found->key[k];
    sort_by(0, count, size, found->key, by_row, start);
    sort_by(32, count, size, by_row, found->key, start);
    for (size_t k = 0; k < size; k++)
      (*list)[k][0] = (int)(uint32_t)found->key[k], (*list)[k][1] = (int)(found->key[k] >> 32);
  }
  dvi__heap_free(by_row);
  dvi__heap_free(start);
  return failed ? DVI_NO_MEMORY : DVI_OK;
}

dvi_status dvi__second_pattern(const dvi__graph *graph, dvi__node root, int count, int (**list)[2],
                               int *pair_count)
{
  *list = NULL;
  *pair_count = 0;
  if (graph->failed != DVI_OK) return graph->failed;
  dvi__arena arena = {0};
  pairs found = {0};
  char *mark = dvi__heap_take((size_t)root + 1, 1);
  set *sets = dvi__heap_take((size_t)root + 1, sizeof *sets);
  int *work = dvi__heap_take((size_t)count + 1, sizeof *work);
  dvi_status status = mark == NULL || sets == NULL || work == NULL ? DVI_NO_MEMORY : DVI_OK;
  if (status == DVI_OK) {
    mark_parts(graph, root, mark);
    status = find_pairs(graph, root, count, mark, sets, &arena, work, &found);
  }
  if (status == DVI_OK) status = list_pairs(&found, count, list);
  if (status != DVI_OK) {
    dvi__heap_free(*list);
    *list = NULL;
  }
  *pair_count = status == DVI_OK ? (int)found.count : 0;
  dvi__heap_free(mark);
  dvi__heap_free(sets);
  dvi__heap_free(work);
  dvi__heap_free(found.key);
  dvi__arena_free(&arena);
  return status;
}
