/* Derivatives of kernels, and where they are added. */
#include <limits.h>

#include "expr/function/function_parts.h"
#include "text/heap.h"

static const dvi__block pair_blocks[DVI__PAIRS][2] = {
    [DVI__PAIR_QQ] = {DVI__COORDINATES, DVI__COORDINATES},
    [DVI__PAIR_QV] = {DVI__COORDINATES, DVI__VELOCITIES},
    [DVI__PAIR_VV] = {DVI__VELOCITIES, DVI__VELOCITIES},
    [DVI__PAIR_QW] = {DVI__COORDINATES, DVI__MULTIPLIERS},
    [DVI__PAIR_VW] = {DVI__VELOCITIES, DVI__MULTIPLIERS},
    [DVI__PAIR_TQ] = {DVI__TIME, DVI__COORDINATES},
    [DVI__PAIR_TV] = {DVI__TIME, DVI__VELOCITIES},
};

void dvi__pair_blocks(dvi__pair pair, dvi__block *rows, dvi__block *columns)
{
  *rows = pair_blocks[pair][0];
  *columns = pair_blocks[pair][1];
}

dvi__pair dvi__pair_of(dvi__block a, dvi__block b)
{
  int pair = 0;
  while (pair < DVI__PAIRS && !((pair_blocks[pair][0] == a && pair_blocks[pair][1] == b) ||
                                (pair_blocks[pair][0] == b && pair_blocks[pair][1] == a)))
    pair++;
  return (dvi__pair)pair;
}

static int is_zero(const dvi__graph *graph, dvi__node n)
{
  double value = 1.0;
  return dvi__is_constant(graph, n, &value) && value == 0.0;
}

/* Roots of a kernel and their targets. */
typedef struct roots {
  int count;
  dvi__node *node;
  dvi__destination *target;
} roots;

/* Room for so many; the nodes are to be freed. */
static dvi_status make_room(dvi__function *function, int most, roots *own)
{
  own->count = 0;
  own->target = dvi__arena_take(&function->arena, (size_t)most, sizeof *own->target);
  own->node = dvi__heap_take((size_t)most + 1, sizeof *own->node);
  return own->target != NULL && own->node != NULL ? DVI_OK : DVI_NO_MEMORY;
}

/* Most roots of a part: the second derivatives of a large expression do not all fit into one. */
enum { SLICE = 1024 };

/* A sum to which every kernel gives its roots. */
typedef dvi_status part_roots(dvi__function *function, int k, unsigned mask, roots *own);

static dvi_status make_sum(dvi__function *function, part_roots *roots_of, unsigned mask, int arrays,
                           const int *entries, dvi__sum **sum)
{
  dvi__sum *made = dvi__sum_new(function);
  dvi_status status = made != NULL ? DVI_OK : DVI_NO_MEMORY;
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++) {
    roots own = {0};
    status = roots_of(function, k, mask, &own);
    for (int first = 0; first < own.count && status == DVI_OK; first += SLICE) {
      const int count = own.count - first < SLICE ? own.count - first : SLICE;
      status = dvi__sum_extend(function, made, k, count, own.node + first, own.target + first);
    }
    dvi__heap_free(own.node);
  }
  if (status == DVI_OK) status = dvi__sum_finish(made, arrays, entries);
  if (status == DVI_OK) *sum = made;
  return status;
}

/* Operations a point. */
static int operations_of(const dvi__sum *sum)
{
  long long all = 0;
  for (int k = 0; k < sum->part_count; k++)
    all += (long long)dvi__program_operations(&sum->part[k].program) *
           sum->part[k].kernel->elements;
  return all < INT_MAX ? (int)all : INT_MAX;
}

static void raise_to(int *most, int value)
{
  if (value > *most) *most = value;
}

/* --- The value. --- */

static dvi_status value_roots(dvi__function *function, int k, unsigned mask, roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  (void)mask;
  const dvi_status status = make_room(function, 1, own);
  if (status == DVI_OK && !is_zero(kernel->graph, kernel->root))
    own->node[own->count++] = kernel->root;
  return status;
}

dvi_status dvi__derive_value(dvi__function *function, unsigned mask, dvi__sum **sum)
{
  const dvi_status status = make_sum(function, value_roots, mask, 1, &(int){1}, sum);
  if (status == DVI_OK) raise_to(&function->counters.value_operations, operations_of(*sum));
  return status;
}

/* --- The gradient. --- */

dvi_status dvi__derive_first(dvi__function *function, int k)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__derivatives *own = &function->derivatives[k];
  if (own->gradient != NULL) return DVI_OK;
  dvi__node *gradient = dvi__arena_take(&function->arena, (size_t)kernel->input_count,
                                        sizeof *gradient);
  if (gradient == NULL) return DVI_NO_MEMORY;
  dvi__gradient(kernel->graph, kernel->root, kernel->input_count, gradient);
  if (kernel->graph->failed == DVI_OK) own->gradient = gradient;
  return kernel->graph->failed;
}

static dvi_status gradient_roots(dvi__function *function, int k, unsigned blocks, roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *known = &function->derivatives[k];
  dvi_status status = dvi__derive_first(function, k);
  if (status == DVI_OK) status = make_room(function, kernel->input_count, own);
  for (int i = 0; i < kernel->input_count && status == DVI_OK; i++) {
    const dvi__kernel_input *input = &kernel->input[i];
    if (input->is_data || (blocks >> input->block & 1U) == 0 ||
        is_zero(kernel->graph, known->gradient[i]))
      continue;
    own->target[own->count] = (dvi__destination){.array = (int)input->block,
                                                 .entry = {.minor = known->place[i]}};
    own->node[own->count++] = known->gradient[i];
  }
  return status;
}

dvi_status dvi__derive_gradient(dvi__function *function, unsigned mask, dvi__sum **sum)
{
  const dvi_status status = make_sum(function, gradient_roots, mask, DVI__BLOCKS,
                                     function->block_size, sum);
  if (status == DVI_OK) raise_to(&function->counters.gradient_operations, operations_of(*sum));
  return status;
}

/* --- Second derivatives. --- */

/* The pair that inputs i and j of a kernel belong to, DVI__PAIRS for none, and which of them has
 * the row. */
static dvi__pair pair_of_inputs(const dvi__kernel *kernel, const int *input, int *row, int *column)
{
  const dvi__kernel_input *first = &kernel->input[input[0]], *second = &kernel->input[input[1]];
  if (first->is_data || second->is_data) return DVI__PAIRS;
  const dvi__pair pair = dvi__pair_of(first->block, second->block);
  const int in_order = pair == DVI__PAIRS || pair_blocks[pair][0] == first->block;
  *row = input[in_order ? 0 : 1];
  *column = input[in_order ? 1 : 0];
  return pair;
}

static int is_wanted(const dvi__kernel *kernel, const int *input, unsigned pairs)
{
  int row, column;
  const dvi__pair pair = pair_of_inputs(kernel, input, &row, &column);
  return pair != DVI__PAIRS && (pairs >> pair & 1U) != 0;
}

/* The second derivatives in one column of the local pairs, first to last - 1, that are wanted and
 * not there. */
static dvi_status derive_column(const dvi__kernel *kernel, dvi__derivatives *own, unsigned pairs,
                                int first, int last)
{
  const size_t most = (size_t)(last - first);
  dvi__node *of = dvi__heap_take(2 * most, sizeof *of);
  int count = 0;
  if (of == NULL) return DVI_NO_MEMORY;
  dvi__node *tangent = of + most;
  for (int e = first; e < last; e++)
    if (own->second[e] < 0 && is_wanted(kernel, own->pair[e], pairs))
      of[count++] = own->gradient[own->pair[e][0]];
  if (count > 0) dvi__tangents(kernel->graph, own->pair[first][1], count, of, tangent);
  count = 0;
  for (int e = first; e < last && kernel->graph->failed == DVI_OK; e++)
    if (own->second[e] < 0 && is_wanted(kernel, own->pair[e], pairs))
      own->second[e] = tangent[count++];
  dvi__heap_free(of);
  return kernel->graph->failed;
}

dvi_status dvi__derive_pairs(dvi__function *function, int k, unsigned pairs)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__derivatives *own = &function->derivatives[k];
  dvi_status status = dvi__derive_first(function, k);
  if (status == DVI_OK) status = dvi__find_pairs(function, k);
  if (status != DVI_OK) return status;
  if (own->second == NULL) {
    own->second = dvi__arena_take(&function->arena, (size_t)own->pair_count, sizeof *own->second);
    if (own->second == NULL) return DVI_NO_MEMORY;
    for (int e = 0; e < own->pair_count; e++) own->second[e] = -1;
  }
  for (int first = 0, last; first < own->pair_count && status == DVI_OK; first = last) {
    for (last = first + 1; last < own->pair_count && own->pair[last][1] == own->pair[first][1];)
      last++;
    status = derive_column(kernel, own, pairs, first, last);
  }
  return status;
}

/* For every element the entry of (row, column) in a pattern. */
static dvi_status map_entries(dvi__function *function, const dvi_pattern *pattern, int elements,
                              const dvi__places *row, const dvi__places *column,
                              dvi__places *entries)
{
  int *list = dvi__arena_take(&function->arena, (size_t)elements, sizeof *list);
  if (list == NULL) return DVI_NO_MEMORY;
  for (int e = 0; e < elements; e++)
    list[e] = dvi__pattern_entry(pattern, dvi__place_at(row, e), dvi__place_at(column, e));
  *entries = (dvi__places){.list = list,
                           .stride_of = dvi__strides(&function->arena, elements, list)};
  return entries->stride_of != NULL ? DVI_OK : DVI_NO_MEMORY;
}

/* Where a pair's derivative by inputs `row` and `column` of kernel k is added. */
static dvi_status find_target(dvi__function *function, int k, dvi__pair pair, int row, int column,
                              dvi__destination *target)
{
  const dvi__places *place = function->derivatives[k].place;
  const dvi__pair_pattern *known = &function->pattern[pair];
  const int elements = function->kernel[k].elements,
            mirrored = row != column && pair_blocks[pair][0] == pair_blocks[pair][1];
  *target = (dvi__destination){.array = (int)pair, .mirrored = mirrored};
  if (known->full) {
    const int rows = function->block_size[pair_blocks[pair][0]];
    target->entry = (dvi__entries){place[row], place[column], rows};
    target->mirror = (dvi__entries){place[column], place[row], rows};
    return DVI_OK;
  }
  dvi_status status = map_entries(function, &known->pattern, elements, &place[row], &place[column],
                                  &target->entry.minor);
  if (status == DVI_OK && mirrored)
    status = map_entries(function, &known->pattern, elements, &place[column], &place[row],
                         &target->mirror.minor);
  return status;
}

static dvi_status second_roots(dvi__function *function, int k, unsigned pairs, roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *known = &function->derivatives[k];
  dvi_status status = dvi__derive_pairs(function, k, pairs);
  if (status == DVI_OK) status = make_room(function, known->pair_count, own);
  for (int e = 0; e < known->pair_count && status == DVI_OK; e++) {
    int row, column;
    const dvi__pair pair = pair_of_inputs(kernel, known->pair[e], &row, &column);
    if (pair == DVI__PAIRS || (pairs >> pair & 1U) == 0 || is_zero(kernel->graph, known->second[e]))
      continue;
    status = find_target(function, k, pair, row, column, &own->target[own->count]);
    own->node[own->count++] = known->second[e];
  }
  return status;
}

dvi_status dvi__derive_second(dvi__function *function, unsigned mask, dvi__sum **sum)
{
  dvi_status status = DVI_OK;
  int entries[DVI__PAIRS] = {0}, all = 0;
  for (int pair = 0; pair < DVI__PAIRS && status == DVI_OK; pair++) {
    if ((mask >> pair & 1U) == 0) continue;
    status = dvi__find_pattern(function, (dvi__pair)pair);
    entries[pair] = function->pattern[pair].entries;
    all = entries[pair] < INT_MAX - all ? all + entries[pair] : INT_MAX;
  }
  if (status == DVI_OK) status = make_sum(function, second_roots, mask, DVI__PAIRS, entries, sum);
  if (status != DVI_OK) return status;
  raise_to(&function->counters.second_operations, operations_of(*sum));
  raise_to(&function->counters.second_entries, all);
  return DVI_OK;
}

/* Whether all second derivatives of kernel k in a pair are constants. */
static int are_constants(const dvi__kernel *kernel, const dvi__derivatives *known, dvi__pair pair)
{
  for (int e = 0; e < known->pair_count; e++)
    if (is_wanted(kernel, known->pair[e], 1U << pair) &&
        kernel->graph->node[known->second[e]].op != DVI__OP_CONSTANT)
      return 0;
  return 1;
}

int dvi__function_second_constant(dvi__function *function, dvi__pair pair)
{
  int constant = 1;
  dvi__function_enter(function);
  for (int k = 0; k < function->kernel_count && constant == 1; k++)
    constant = dvi__derive_pairs(function, k, 1U << pair) == DVI_OK
                   ? are_constants(&function->kernel[k], &function->derivatives[k], pair)
                   : -1;
  (void)dvi__function_leave(function, DVI_OK);
  return constant;
}
