/* Derivatives of kernels, and the targets to which they are added. */
#include <limits.h>

#include "expr/function/function_parts.h"
#include "text/heap.h"

static int root_is_zero(const dvi__graph *graph, dvi__node n)
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

/* Take room for so many roots. The caller frees the nodes. */
static dvi_status roots_allocate(dvi__function *function, size_t most, roots *own)
{
  own->count = 0;
  own->target = dvi__arena_take(&function->arena, most, sizeof *own->target);
  own->node = dvi__heap_take(most + 1, sizeof *own->node);
  return own->target != NULL && own->node != NULL ? DVI_OK : DVI_NO_MEMORY;
}

static void roots_add(roots *own, dvi__node node, const dvi__destination *target)
{
  own->target[own->count] = *target;
  own->node[own->count++] = node;
}

/* Limit the roots of a part. The second derivatives of a large expression do not all fit into
 * one. */
enum { SLICE = 1024 };

/* Find the roots that kernel k adds to a sum. */
typedef dvi_status roots_finder(dvi__function *function, int k, const dvi__function_sum *sum,
                                roots *own);

static dvi_status sum_fill(dvi__function *function, roots_finder *find, dvi__function_sum *sum)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++) {
    roots own = {0};
    status = find(function, k, sum, &own);
    for (int first = 0; first < own.count && status == DVI_OK; first += SLICE) {
      const int count = own.count - first < SLICE ? own.count - first : SLICE;
      status = dvi__sum_extend(function, sum, k, count, own.node + first, own.target + first);
    }
    dvi__heap_free(own.node);
  }
  return status == DVI_OK ? dvi__sum_finish(sum) : status;
}

/* ---- the value ---- */

static dvi_status value_roots(dvi__function *function, int k, const dvi__function_sum *sum,
                              roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  (void)sum;
  const dvi_status status = roots_allocate(function, 1, own);
  if (status == DVI_OK && !root_is_zero(kernel->graph, kernel->root))
    roots_add(own, kernel->root, &(dvi__destination){0});
  return status;
}

/* ---- the gradient ---- */

/* Derive the gradient of kernel k as nodes. */
static dvi_status derive_first(dvi__function *function, int k)
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

static dvi_status gradient_roots(dvi__function *function, int k, const dvi__function_sum *sum,
                                 roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *known = &function->derivatives[k];
  dvi_status status = derive_first(function, k);
  if (status != DVI_OK) return status;
  status = roots_allocate(function, (size_t)kernel->input_count, own);
  if (status != DVI_OK) return status;
  for (int i = 0; i < kernel->input_count; i++) {
    const dvi__kernel_input *input = &kernel->input[i];
    if (input->is_data || !sum->wanted[input->block] ||
        root_is_zero(kernel->graph, known->gradient[i]))
      continue;
    roots_add(own, known->gradient[i],
              &(dvi__destination){.array = input->block, .entry = {.minor = known->place[i]}});
  }
  return DVI_OK;
}

/* ---- second derivatives ---- */

/* Return 1 if the second derivative by inputs i and j of a kernel belongs to a pair of blocks. */
static int pair_has_inputs(dvi__block_pair pair, const dvi__kernel *kernel, const int *input)
{
  const dvi__kernel_input *first = &kernel->input[input[0]], *second = &kernel->input[input[1]];
  return !first->is_data && !second->is_data && dvi__pair_has(pair, first->block, second->block);
}

/* Count the wanted pairs that the second derivative by these inputs belongs to. */
static int count_wanted(const dvi__function *function, const dvi__kernel *kernel, const int *input,
                        const char *wanted)
{
  int count = 0;
  for (int p = 0; p < function->blocks.pair_count; p++)
    count += wanted[p] && pair_has_inputs(function->blocks.pair[p], kernel, input);
  return count;
}

/* Derive what is wanted and missing in one column of the local pairs, first to last - 1. */
static dvi_status derive_column(const dvi__function *function, int k, const char *wanted, int first,
                                int last)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__derivatives *own = &function->derivatives[k];
  const size_t most = (size_t)(last - first);
  dvi__node *of = dvi__heap_take(2 * most, sizeof *of);
  int count = 0, *derived = dvi__heap_take(most, sizeof *derived);
  if (of == NULL || derived == NULL) {
    dvi__heap_free(of);
    dvi__heap_free(derived);
    return DVI_NO_MEMORY;
  }
  for (int e = first; e < last; e++) {
    if (own->second[e] >= 0 || count_wanted(function, kernel, own->pair[e], wanted) == 0) continue;
    derived[count] = e;
    of[count++] = own->gradient[own->pair[e][0]];
  }
  if (count > 0) dvi__tangents(kernel->graph, own->pair[first][1], count, of, of + most);
  for (int i = 0; i < count && kernel->graph->failed == DVI_OK; i++)
    own->second[derived[i]] = of[most + (size_t)i];
  dvi__heap_free(of);
  dvi__heap_free(derived);
  return kernel->graph->failed;
}

dvi_status dvi__derive_pairs(dvi__function *function, int k, const char *wanted)
{
  dvi__derivatives *own = &function->derivatives[k];
  dvi_status status = derive_first(function, k);
  if (status != DVI_OK) return status;
  status = dvi__find_pairs(function, k);
  if (status != DVI_OK) return status;
  if (own->second == NULL) {
    own->second = dvi__arena_take(&function->arena, (size_t)own->pair_count, sizeof *own->second);
    if (own->second == NULL) return DVI_NO_MEMORY;
    for (int e = 0; e < own->pair_count; e++) own->second[e] = -1;
  }
  for (int first = 0, last; first < own->pair_count && status == DVI_OK; first = last) {
    for (last = first + 1; last < own->pair_count && own->pair[last][1] == own->pair[first][1];)
      last++;
    status = derive_column(function, k, wanted, first, last);
  }
  return status;
}

/* Find for every element the entry of (row, column) in a pattern. */
static dvi_status map_entries(dvi__function *function, const dvi_pattern *pattern, int elements,
                              const dvi__element_places *row, const dvi__element_places *column,
                              dvi__element_places *entries)
{
  int *list = dvi__arena_take(&function->arena, (size_t)elements, sizeof *list);
  if (list == NULL) return DVI_NO_MEMORY;
  for (int e = 0; e < elements; e++)
    list[e] = dvi__pattern_entry(pattern, dvi__place_at(row, e), dvi__place_at(column, e));
  *entries = (dvi__element_places){.list = list,
                                   .stride_of = dvi__strides(&function->arena, elements, list)};
  return entries->stride_of != NULL ? DVI_OK : DVI_NO_MEMORY;
}

/* Find the target of a pair's derivative by two inputs of kernel k. The row is that of the input
 * which is of the pair's first block. */
static dvi_status find_target(dvi__function *function, int k, int pair, const int *input,
                              dvi__destination *target)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__block_pair blocks = function->blocks.pair[pair];
  const int in_order = kernel->input[input[0]].block == blocks.rows;
  const int mirrored = input[0] != input[1] && blocks.rows == blocks.columns;
  const dvi__element_places *row = &function->derivatives[k].place[input[in_order ? 0 : 1]];
  const dvi__element_places *column = &function->derivatives[k].place[input[in_order ? 1 : 0]];
  const dvi__pair_pattern *known = &function->pattern[pair];
  *target = (dvi__destination){.array = pair, .mirrored = mirrored};
  if (known->full) {
    const int rows = function->blocks.width[blocks.rows];
    target->entry = (dvi__entries){*row, *column, rows};
    target->mirror = (dvi__entries){*column, *row, rows};
    return DVI_OK;
  }
  dvi_status status = map_entries(function, &known->pattern, kernel->elements, row, column,
                                  &target->entry.minor);
  if (status == DVI_OK && mirrored)
    status = map_entries(function, &known->pattern, kernel->elements, column, row,
                         &target->mirror.minor);
  return status;
}

static dvi_status second_roots(dvi__function *function, int k, const dvi__function_sum *sum,
                               roots *own)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *known = &function->derivatives[k];
  dvi_status status = dvi__derive_pairs(function, k, sum->wanted);
  size_t most = 0;
  if (status != DVI_OK) return status;
  for (int e = 0; e < known->pair_count; e++)
    most += (size_t)count_wanted(function, kernel, known->pair[e], sum->wanted);
  status = roots_allocate(function, most, own);
  for (int e = 0; e < known->pair_count && status == DVI_OK; e++)
    for (int p = 0; p < sum->array_count && status == DVI_OK; p++) {
      dvi__destination target;
      if (!sum->wanted[p] || !pair_has_inputs(function->blocks.pair[p], kernel, known->pair[e]) ||
          root_is_zero(kernel->graph, known->second[e]))
        continue;
      status = find_target(function, k, p, known->pair[e], &target);
      roots_add(own, known->second[e], &target);
    }
  return status;
}

/* ---- all three ---- */

/* Return the operations of a sum at a point. */
static int operations_of(const dvi__function_sum *sum)
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

/* Find the size of each wanted array at one point. */
static dvi_status find_sizes(dvi__function *function, dvi__derived derived, dvi__function_sum *sum)
{
  dvi_status status = DVI_OK;
  for (int a = 0; a < sum->array_count && status == DVI_OK; a++) {
    if (!sum->wanted[a]) continue;
    if (derived == DVI__SECOND) status = dvi__find_pattern(function, a);
    sum->size[a] = derived == DVI__VALUE      ? 1
                   : derived == DVI__GRADIENT ? function->blocks.width[a]
                                              : function->pattern[a].entries;
  }
  return status;
}

static int count_entries(const dvi__function_sum *sum)
{
  int all = 0;
  for (int a = 0; a < sum->array_count; a++)
    all = sum->size[a] < INT_MAX - all ? all + sum->size[a] : INT_MAX;
  return all;
}

dvi_status dvi__derive(dvi__function *function, dvi__derived derived, dvi__function_sum *sum)
{
  static roots_finder *const find[DVI__DERIVED] = {value_roots, gradient_roots, second_roots};
  dvi__function_counters *counters = &function->counters;
  int *const operations[DVI__DERIVED] = {
      &counters->value_operations, &counters->gradient_operations, &counters->second_operations};
  dvi_status status = find_sizes(function, derived, sum);
  if (status != DVI_OK) return status;
  status = sum_fill(function, find[derived], sum);
  if (status != DVI_OK) return status;
  raise_to(operations[derived], operations_of(sum));
  if (derived == DVI__SECOND) raise_to(&counters->second_entries, count_entries(sum));
  return DVI_OK;
}

/* Return 1 if all second derivatives of kernel k in a pair are constants. They must be derived. */
static int are_constants(const dvi__function *function, int k, int pair)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *known = &function->derivatives[k];
  for (int e = 0; e < known->pair_count; e++)
    if (pair_has_inputs(function->blocks.pair[pair], kernel, known->pair[e]) &&
        kernel->graph->node[known->second[e]].op != DVI__OP_CONSTANT)
      return 0;
  return 1;
}

int dvi__function_second_constant(dvi__function *function, int pair)
{
  dvi__function_enter(function);
  char *wanted = dvi__heap_take((size_t)function->blocks.pair_count, 1);
  int constant = wanted != NULL ? 1 : -1;
  if (wanted != NULL) wanted[pair] = 1;
  for (int k = 0; k < function->kernel_count && constant == 1; k++)
    constant = dvi__derive_pairs(function, k, wanted) == DVI_OK ? are_constants(function, k, pair)
                                                                : -1;
  dvi__heap_free(wanted);
  (void)dvi__function_leave(function, DVI_OK);
  return constant;
}
