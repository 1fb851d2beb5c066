/* Functions as their users see them: made, evaluated, counted. */
#include "expr/function/function.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "expr/function/function_parts.h"
#include "text/heap.h"
#include "expr/compile/lanes.h"

/* --- Creation. --- */

const int *dvi__strides(dvi__arena *arena, int elements, const int *list)
{
  const int units = (elements + DVI__UNIT - 1) / DVI__UNIT;
  int *stride_of = dvi__arena_take(arena, (size_t)units, sizeof *stride_of);
  for (int u = 0; stride_of != NULL && u < units; u++) {
    const int count = dvi__unit_size(elements, u * DVI__UNIT);
    const int *number = list + (ptrdiff_t)u * DVI__UNIT;
    stride_of[u] = count > 1 ? number[1] - number[0] : 0;
    for (int e = 2; e < count; e++)
      if (number[e] - number[e - 1] != stride_of[u]) stride_of[u] = DVI__IRREGULAR;
  }
  return stride_of;
}

/* Lists are shared by inputs that follow each other. */
static dvi_status find_places(dvi__function *function, int k)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__places *place = dvi__arena_take(&function->arena, (size_t)kernel->input_count,
                                       sizeof *place);
  if (place == NULL) return DVI_NO_MEMORY;
  const int *list = NULL, *stride_of = NULL;
  for (int i = 0; i < kernel->input_count; i++) {
    const dvi__kernel_input *input = &kernel->input[i];
    if (input->is_data) continue;
    if (input->number != NULL && input->number != list) {
      list = input->number;
      stride_of = dvi__strides(&function->arena, kernel->elements, list);
      if (stride_of == NULL) return DVI_NO_MEMORY;
    }
    place[i] = input->number != NULL
                   ? (dvi__places){input->number, stride_of, input->offset, 0}
                   : (dvi__places){NULL, NULL, input->base + input->offset, input->stride};
  }
  function->derivatives[k] = (dvi__derivatives){.place = place, .pair_count = -1};
  return DVI_OK;
}

static dvi_status fill(dvi__function *function, int kernel_count, const dvi__kernel *kernels)
{
  function->kernel = dvi__arena_take(&function->arena, (size_t)kernel_count, sizeof *kernels);
  function->derivatives = dvi__arena_take(&function->arena, (size_t)kernel_count,
                                          sizeof *function->derivatives);
  if (function->kernel == NULL || function->derivatives == NULL) return DVI_NO_MEMORY;
  if (kernel_count > 0) memcpy(function->kernel, kernels, (size_t)kernel_count * sizeof *kernels);
  function->kernel_count = kernel_count;
  dvi_status status = dvi__merge_kernels(&function->arena, &function->kernel_count,
                                         function->kernel);
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++)
    status = find_places(function, k);
  return status;
}

/* The ledger that is charged now. */
static dvi__ledger *current_ledger(void)
{
  dvi__ledger *ledger = dvi__heap_charge(NULL);
  (void)dvi__heap_charge(ledger);
  return ledger;
}

dvi_status dvi__function_create(int kernel_count, const dvi__kernel *kernels, const int *block_size,
                                dvi__function **function)
{
  *function = NULL;
  dvi__function *made = dvi__heap_take(1, sizeof *made);
  if (made == NULL) return DVI_NO_MEMORY;
  if (pthread_mutex_init(&made->lock, NULL) != 0) {
    dvi__heap_free(made);
    return DVI_NO_MEMORY;
  }
  made->ledger = current_ledger();
  made->counters = (dvi__function_counters){
      .value_operations = -1, .gradient_operations = -1, .second_operations = -1};
  memcpy(made->block_size, block_size, sizeof made->block_size);
  const dvi_status status = fill(made, kernel_count, kernels);
  if (status == DVI_OK)
    *function = made;
  else
    dvi__function_destroy(&made);
  return status;
}

void dvi__function_destroy(dvi__function **function)
{
  dvi__function *own = *function;
  if (own == NULL) return;
  *function = NULL;
  for (const dvi__sum *sum = own->last; sum != NULL; sum = sum->before)
    for (int k = 0; k < sum->part_count; k++) dvi__program_free(&sum->part[k].program);
  for (int k = 0; k < own->kernel_count; k++) dvi__graph_free(own->kernel[k].graph);
  dvi__arena_free(&own->arena);
  pthread_mutex_destroy(&own->lock);
  dvi__heap_free(own);
}

/* --- Evaluation. --- */

void dvi__function_enter(dvi__function *function)
{
  pthread_mutex_lock(&function->lock);
  function->other = dvi__heap_charge(function->ledger);
}

dvi_status dvi__function_leave(dvi__function *function, dvi_status status)
{
  if (status == DVI_NO_MEMORY) status = dvi__heap_refusal();
  for (int k = 0; k < function->kernel_count; k++) /* there may be memory the next time */
    if (function->kernel[k].graph->failed == DVI_NO_MEMORY)
      function->kernel[k].graph->failed = DVI_OK;
  (void)dvi__heap_charge(function->other);
  pthread_mutex_unlock(&function->lock);
  return status;
}

typedef dvi_status derivation(dvi__function *function, unsigned mask, dvi__sum **sum);

/* The sum in a slot, derived now if it is not there. */
static dvi_status ask(dvi__function *function, _Atomic(dvi__sum *) *slot, derivation *derive,
                      unsigned mask, const dvi__sum **sum)
{
  *sum = atomic_load_explicit(slot, memory_order_acquire);
  if (*sum != NULL) return DVI_OK;
  dvi__function_enter(function);
  dvi__sum *made = atomic_load_explicit(slot, memory_order_relaxed);
  const dvi_status status = made != NULL ? DVI_OK : derive(function, mask, &made);
  if (status == DVI_OK) atomic_store_explicit(slot, made, memory_order_release);
  *sum = made;
  return dvi__function_leave(function, status);
}

DVI__SCENE_LANES static int all_finite(size_t size, const double *restrict x)
{
  int beyond = 0;
  for (size_t i = 0; i < size; i++) beyond |= !(fabs(x[i]) <= 1.7976931348623157e308);
  return !beyond;
}

/* Evaluate to arrays of size[] numbers a point; NULL: not wanted. */
static int evaluate(const dvi__sum *sum, int count, const double *const *x, int arrays,
                    const int *size, double *const *result)
{
  int finite = 1;
  for (int i = 0; i < arrays; i++)
    if ((sum->clear >> i & 1U) != 0 && result[i] != NULL && size[i] > 0)
      memset(result[i], 0, (size_t)size[i] * (size_t)count * sizeof **result);
  dvi__sum_add(sum, count, x, result);
  for (int i = 0; i < arrays && finite; i++)
    if (result[i] != NULL) finite = all_finite((size_t)size[i] * (size_t)count, result[i]);
  return !finite;
}

static unsigned mask_of(int arrays, double *const *array)
{
  unsigned mask = 0;
  for (int i = 0; i < arrays; i++)
    if (array[i] != NULL) mask |= 1U << i;
  return mask;
}

static void count_points(atomic_long *points, int count)
{
  atomic_fetch_add_explicit(points, count, memory_order_relaxed);
}

/* The sums that are wanted, and the sizes of their arrays. */
static dvi_status ask_value(dvi__function *function, int count, const dvi__sum **sum)
{
  const dvi_status status = ask(function, &function->value, dvi__derive_value, 0, sum);
  if (status == DVI_OK) count_points(&function->value_points, count);
  return status;
}

static dvi_status ask_gradient(dvi__function *function, int count, double *const *gradient,
                               const dvi__sum **sum)
{
  const unsigned blocks = mask_of(DVI__BLOCKS, gradient);
  const dvi_status status = ask(function, &function->gradient[blocks], dvi__derive_gradient, blocks,
                                sum);
  if (status == DVI_OK) count_points(&function->gradient_points, count);
  return status;
}

static dvi_status ask_second(dvi__function *function, int count, double *const *values,
                             const dvi__sum **sum, int *size)
{
  const unsigned pairs = mask_of(DVI__PAIRS, values);
  const dvi_status status = ask(function, &function->second[pairs], dvi__derive_second, pairs, sum);
  if (status != DVI_OK) return status;
  for (int pair = 0; pair < DVI__PAIRS; pair++) size[pair] = function->pattern[pair].entries;
  count_points(&function->second_points, count);
  return DVI_OK;
}

int dvi__function_value(dvi__function *function, int count, const double *const *x, double *value)
{
  const dvi__sum *sum;
  const dvi_status status = ask_value(function, count, &sum);
  return status != DVI_OK ? (int)status : evaluate(sum, count, x, 1, &(int){1}, &value);
}

int dvi__function_gradient(dvi__function *function, int count, const double *const *x,
                           double *const *gradient)
{
  const dvi__sum *sum;
  const dvi_status status = ask_gradient(function, count, gradient, &sum);
  return status != DVI_OK ? (int)status
                          : evaluate(sum, count, x, DVI__BLOCKS, function->block_size, gradient);
}

int dvi__function_second(dvi__function *function, int count, const double *const *x,
                         double *const *values)
{
  const dvi__sum *sum;
  int size[DVI__PAIRS];
  const dvi_status status = ask_second(function, count, values, &sum, size);
  return status != DVI_OK ? (int)status : evaluate(sum, count, x, DVI__PAIRS, size, values);
}

/* --- Along a curve. --- */

/* As evaluate, of so many coefficients. */
static int expand(const dvi__function *function, const dvi__sum *sum, int count,
                  const double *const *x, int arrays, const int *size, double *const *result)
{
  int finite = 1;
  for (int i = 0; i < arrays; i++)
    if (result[i] != NULL && size[i] > 0)
      memset(result[i], 0, (size_t)size[i] * (size_t)count * sizeof **result);
  const dvi_status status = dvi__sum_add_series(sum, count, function->block_size, x, size, result);
  for (int i = 0; i < arrays && finite; i++)
    if (result[i] != NULL) finite = all_finite((size_t)size[i] * (size_t)count, result[i]);
  return status != DVI_OK ? (int)status : !finite;
}

int dvi__function_series(dvi__function *function, int degree, const double *const *x, double *value,
                         double *const *gradient, double *const *values)
{
  const int count = degree + 1;
  const dvi__sum *sum;
  int returned = 0;
  if (value != NULL) {
    returned = (int)ask_value(function, count, &sum);
    if (returned == 0) returned = expand(function, sum, count, x, 1, &(int){1}, &value);
  }
  if (returned == 0 && gradient != NULL && mask_of(DVI__BLOCKS, gradient) != 0) {
    returned = (int)ask_gradient(function, count, gradient, &sum);
    if (returned == 0)
      returned = expand(function, sum, count, x, DVI__BLOCKS, function->block_size, gradient);
  }
  if (returned == 0 && values != NULL && mask_of(DVI__PAIRS, values) != 0) {
    int size[DVI__PAIRS];
    returned = (int)ask_second(function, count, values, &sum, size);
    if (returned == 0) returned = expand(function, sum, count, x, DVI__PAIRS, size, values);
  }
  return returned;
}

dvi_status dvi__function_prepare(dvi__function *function, int value, unsigned blocks,
                                 unsigned pairs)
{
  const dvi__sum *sum;
  dvi_status status = DVI_OK;
  if (value) status = ask(function, &function->value, dvi__derive_value, 0, &sum);
  if (status == DVI_OK && blocks != 0)
    status = ask(function, &function->gradient[blocks], dvi__derive_gradient, blocks, &sum);
  if (status == DVI_OK && pairs != 0)
    status = ask(function, &function->second[pairs], dvi__derive_second, pairs, &sum);
  return status;
}

/* --- Questions. --- */

dvi_status dvi__function_pattern(dvi__function *function, dvi__pair pair, dvi_pattern *pattern,
                                 int *full)
{
  dvi__function_enter(function);
  const dvi_status status = dvi__find_pattern(function, pair);
  *pattern = function->pattern[pair].pattern;
  *full = function->pattern[pair].full;
  return dvi__function_leave(function, status);
}

void dvi__function_count(dvi__function *function, dvi__function_counters *counters)
{
  pthread_mutex_lock(&function->lock);
  *counters = function->counters;
  pthread_mutex_unlock(&function->lock);
  counters->value_points = atomic_load_explicit(&function->value_points, memory_order_relaxed);
  counters->gradient_points = atomic_load_explicit(&function->gradient_points,
                                                   memory_order_relaxed);
  counters->second_points = atomic_load_explicit(&function->second_points, memory_order_relaxed);
}

int dvi__function_kernel_count(const dvi__function *function)
{
  return function->kernel_count;
}

const dvi__kernel *dvi__function_kernel(const dvi__function *function, int k)
{
  return &function->kernel[k];
}
