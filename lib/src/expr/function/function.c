/* The functions of function.h that create, evaluate and count. */
#include "expr/function/function.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "expr/compile/lanes.h"
#include "expr/function/function_parts.h"
#include "text/heap.h"

/* ---- creation ---- */

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

/* Find the places of kernel k's variables. Inputs that follow each other share lists. */
static dvi_status find_places(dvi__function *function, int k)
{
  const dvi__kernel *kernel = &function->kernel[k];
  dvi__element_places *place = dvi__arena_take(&function->arena, (size_t)kernel->input_count,
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
    place[i] = input->number != NULL ? (dvi__element_places){.list = input->number,
                                                             .stride_of = stride_of,
                                                             .start = input->offset}
                                     : (dvi__element_places){.start = input->base + input->offset,
                                                             .stride = input->stride};
  }
  function->derivatives[k] = (dvi__derivatives){.place = place, .pair_count = -1};
  return DVI_OK;
}

static dvi_status function_copy_blocks(dvi__function *function, const dvi__blocks *blocks)
{
  const size_t count = (size_t)blocks->count, pairs = (size_t)blocks->pair_count;
  int *width = dvi__arena_take(&function->arena, count, sizeof *width);
  dvi__block_pair *pair = dvi__arena_take(&function->arena, pairs, sizeof *pair);
  function->pattern = dvi__arena_take(&function->arena, pairs, sizeof *function->pattern);
  if (width == NULL || pair == NULL || function->pattern == NULL) return DVI_NO_MEMORY;
  if (count > 0) memcpy(width, blocks->width, count * sizeof *width);
  if (pairs > 0) memcpy(pair, blocks->pair, pairs * sizeof *pair);
  function->blocks = (dvi__blocks){blocks->count, width, blocks->pair_count, pair};
  return DVI_OK;
}

static dvi_status function_take_kernels(dvi__function *function, int kernel_count,
                                        const dvi__kernel *kernels)
{
  const size_t count = (size_t)kernel_count;
  function->kernel = dvi__arena_take(&function->arena, count, sizeof *kernels);
  function->derivatives = dvi__arena_take(&function->arena, count, sizeof *function->derivatives);
  if (function->kernel == NULL || function->derivatives == NULL) return DVI_NO_MEMORY;
  if (kernel_count > 0) memcpy(function->kernel, kernels, count * sizeof *kernels);
  function->kernel_count = kernel_count;
  dvi_status status = dvi__merge_kernels(&function->arena, &function->kernel_count,
                                         function->kernel);
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++)
    status = find_places(function, k);
  return status;
}

/* Return the ledger that is charged now. */
static dvi__ledger *current_ledger(void)
{
  dvi__ledger *ledger = dvi__heap_charge(NULL);
  (void)dvi__heap_charge(ledger);
  return ledger;
}

dvi_status dvi__function_create(int kernel_count, const dvi__kernel *kernels,
                                const dvi__blocks *blocks, dvi__function **function)
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
  dvi_status status = function_take_kernels(made, kernel_count, kernels);
  if (status == DVI_OK) status = function_copy_blocks(made, blocks);
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
  for (const dvi__function_sum *sum = own->last; sum != NULL; sum = sum->before)
    for (int k = 0; k < sum->part_count; k++) dvi__program_free(&sum->part[k].program);
  for (int k = 0; k < own->kernel_count; k++) dvi__graph_free(own->kernel[k].graph);
  dvi__arena_free(&own->arena);
  pthread_mutex_destroy(&own->lock);
  dvi__heap_free(own);
}

/* ---- sums ---- */

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

/* A request for arrays. It names the arrays that are not NULL, or those that have a flag. */
typedef struct request {
  dvi__derived derived;
  double *const *array;
  const char *flag;
} request;

static inline int request_wants(const request *r, int a)
{
  return r->array != NULL ? r->array[a] != NULL : r->flag[a] != 0;
}

/* Return the sum that is ready for exactly this request, or NULL. */
static dvi__function_sum *request_find(const dvi__function *function, const request *r)
{
  dvi__function_sum *sum = atomic_load_explicit(&function->ready[r->derived], memory_order_acquire);
  for (; sum != NULL; sum = sum->next) {
    int a = 0;
    while (a < sum->array_count && sum->wanted[a] == request_wants(r, a)) a++;
    if (a == sum->array_count) break;
  }
  return sum;
}

static int function_array_count(const dvi__function *function, dvi__derived derived)
{
  if (derived == DVI__VALUE) return 1;
  return derived == DVI__GRADIENT ? function->blocks.count : function->blocks.pair_count;
}

/* Derive a sum and make it ready. */
static dvi_status request_derive(dvi__function *function, const request *r,
                                 const dvi__function_sum **sum)
{
  dvi__function_sum *made = dvi__sum_new(function, function_array_count(function, r->derived));
  if (made == NULL) return DVI_NO_MEMORY;
  for (int a = 0; a < made->array_count; a++) {
    made->wanted[a] = (char)request_wants(r, a);
    if (made->wanted[a]) made->result[made->result_count++] = a;
  }
  const dvi_status status = dvi__derive(function, r->derived, made);
  if (status != DVI_OK) return status;
  made->next = atomic_load_explicit(&function->ready[r->derived], memory_order_relaxed);
  atomic_store_explicit(&function->ready[r->derived], made, memory_order_release);
  *sum = made;
  return DVI_OK;
}

/* Return the sum for a request. It is derived now if it is not ready. */
static dvi_status request_sum(dvi__function *function, const request *r,
                              const dvi__function_sum **sum)
{
  *sum = request_find(function, r);
  if (*sum != NULL) return DVI_OK;
  dvi__function_enter(function);
  *sum = request_find(function, r);
  return dvi__function_leave(function, *sum != NULL ? DVI_OK : request_derive(function, r, sum));
}

dvi_status dvi__function_prepare(dvi__function *function, int value, const char *blocks,
                                 const char *pairs)
{
  const char one = 1, *const flag[DVI__DERIVED] = {value ? &one : NULL, blocks, pairs};
  const dvi__function_sum *sum;
  dvi_status status = DVI_OK;
  for (int k = 0; k < DVI__DERIVED && status == DVI_OK; k++)
    if (flag[k] != NULL)
      status = request_sum(function, &(request){(dvi__derived)k, NULL, flag[k]}, &sum);
  return status;
}

const dvi__function_sum *dvi__function_sum_of(const dvi__function *function, dvi__derived derived,
                                              const char *wanted)
{
  return request_find(function, &(request){.derived = derived, .flag = wanted});
}

/* ---- evaluation ---- */

DVI__EXPR_INLINE void look_for_infinity_body(size_t size, const double *restrict x, int *beyond)
{
  for (size_t i = 0; i < size; i++) *beyond |= !(fabs(x[i]) <= 1.7976931348623157e308);
}

DVI__EXPR_VERSIONS(look_for_infinity, (size_t size, const double *restrict x, int *beyond),
                   (size, x, beyond))

static int array_is_finite(size_t size, const double *x)
{
  int beyond = 0;
  look_for_infinity(size, x, &beyond);
  return !beyond;
}

static int sum_is_finite(const dvi__function_sum *sum, int count, double *const *result)
{
  int finite = 1;
  for (int i = 0; i < sum->result_count && finite; i++) {
    const int a = sum->result[i];
    finite = array_is_finite((size_t)sum->size[a] * (size_t)count, result[a]);
  }
  return finite;
}

/* Evaluate one kind of result at points, where its arrays are wanted. If none is wanted, nothing is
 * derived. */
static int function_evaluate(dvi__function *function, dvi__derived derived, int count,
                             const double *const *x, double *const *result)
{
  const dvi__function_sum *sum;
  const dvi_status status = request_sum(function, &(request){.derived = derived, .array = result},
                                        &sum);
  if (status != DVI_OK) return (int)status;
  atomic_fetch_add_explicit(&function->points[derived], count, memory_order_relaxed);
  for (int i = 0; i < sum->result_count; i++) {
    const int a = sum->result[i];
    if (sum->clear[a] && sum->size[a] > 0)
      memset(result[a], 0, (size_t)sum->size[a] * (size_t)count * sizeof **result);
  }
  dvi__sum_add(sum, count, x, result);
  return !sum_is_finite(sum, count, result);
}

int dvi__function_value(dvi__function *function, int count, const double *const *x, double *value)
{
  return function_evaluate(function, DVI__VALUE, count, x, &value);
}

int dvi__function_gradient(dvi__function *function, int count, const double *const *x,
                           double *const *gradient)
{
  return function_evaluate(function, DVI__GRADIENT, count, x, gradient);
}

int dvi__function_second(dvi__function *function, int count, const double *const *x,
                         double *const *values)
{
  return function_evaluate(function, DVI__SECOND, count, x, values);
}

/* ---- Taylor series ---- */

/* Compute `count` Taylor coefficients of one kind of result. */
static int function_expand(dvi__function *function, dvi__derived derived, int count,
                           const double *const *x, double *const *result)
{
  const dvi__function_sum *sum;
  dvi_status status = request_sum(function, &(request){.derived = derived, .array = result}, &sum);
  if (status != DVI_OK) return (int)status;
  atomic_fetch_add_explicit(&function->points[derived], count, memory_order_relaxed);
  for (int a = 0; a < sum->array_count; a++)
    if (sum->size[a] > 0)
      memset(result[a], 0, (size_t)sum->size[a] * (size_t)count * sizeof **result);
  status = dvi__sum_add_series(sum, count, function->blocks.width, x, result);
  const int finite = sum_is_finite(sum, count, result);
  return status != DVI_OK ? (int)status : !finite;
}

static int request_wants_any(int count, double *const *array)
{
  int a = 0;
  while (a < count && array[a] == NULL) a++;
  return a < count;
}

int dvi__function_series(dvi__function *function, int degree, const double *const *x, double *value,
                         double *const *gradient, double *const *values)
{
  double *const *const result[DVI__DERIVED] = {&value, gradient, values};
  int returned = 0;
  for (int k = 0; k < DVI__DERIVED && returned == 0; k++)
    if (result[k] != NULL &&
        request_wants_any(function_array_count(function, (dvi__derived)k), result[k]))
      returned = function_expand(function, (dvi__derived)k, degree + 1, x, result[k]);
  return returned;
}

/* ---- patterns and counters ---- */

dvi_status dvi__function_pattern(dvi__function *function, int pair, dvi_pattern *pattern, int *full)
{
  dvi__function_enter(function);
  const dvi_status status = dvi__find_pattern(function, pair);
  *pattern = function->pattern[pair].pattern;
  *full = function->pattern[pair].full;
  return dvi__function_leave(function, status);
}

void dvi__function_count(dvi__function *function, dvi__function_counters *counters)
{
  long points[DVI__DERIVED];
  pthread_mutex_lock(&function->lock);
  *counters = function->counters;
  pthread_mutex_unlock(&function->lock);
  for (int k = 0; k < DVI__DERIVED; k++)
    points[k] = atomic_load_explicit(&function->points[k], memory_order_relaxed);
  counters->value_points = points[DVI__VALUE];
  counters->gradient_points = points[DVI__GRADIENT];
  counters->second_points = points[DVI__SECOND];
}

int dvi__function_kernel_count(const dvi__function *function)
{
  return function->kernel_count;
}

const dvi__kernel *dvi__function_kernel(const dvi__function *function, int k)
{
  return &function->kernel[k];
}
