/* Functions f(x_0, .., x_m) of blocks of variables that are sums of kernels. A kernel is one
 * expression, summed over elements (one, or the pairs of bodies, or the springs of a chain) that
 * read different variables and data.
 *
 *     f(x) = sum over kernels, sum over elements e:
 *            g(x[variable_1(e)], .., x[variable_m(e)], data_1(e), ..)
 *
 * Variables come in blocks, each of some width, and a block is named by its number. For a
 * Lagrangian these are time, coordinates and velocities, for the density of a field u, u_t, u_x and
 * so on. Second derivatives come in pairs of blocks, which are named by their numbers, too.
 *
 * Derivatives are those of the expression g, added up as finite elements are. Blocks are stored in
 * the shape of a batch, in which variable i of point k is x[i*count + k]. The order of every sum is
 * fixed when a function is made. Digits depend neither on the number of points nor on threads.
 * Evaluations allocate nothing and may run on several threads at a time. */
#ifndef DVI_EXPR_FUNCTION_FUNCTION_H
#define DVI_EXPR_FUNCTION_FUNCTION_H
#include <dvi/system.h>

#include "expr/graph.h"

/* The blocks whose variables are the rows and the columns of a matrix of second derivatives. */
typedef struct dvi__block_pair {
  int rows, columns;
} dvi__block_pair;

/* The blocks of a function, and the pairs for which there may be second derivatives. */
typedef struct dvi__blocks {
  int count;
  const int *width; /* [count] variables of each */
  int pair_count;
  const dvi__block_pair *pair; /* [pair_count], all different */
} dvi__blocks;

/* The source of an input of a kernel. For element e it is variable number[e] + offset of the block,
 * or base + stride * e + offset if number is NULL. If is_data it is data[e]. Constants are folded
 * before a kernel is made. */
typedef struct dvi__kernel_input {
  int is_data;
  int block;
  const int *number; /* [elements] of the kernel, shared by inputs */
  int base, stride, offset;
  const double *data; /* [elements] */
} dvi__kernel_input;

/* Return the variable that an input is for element e. */
static inline int dvi__input_number(const dvi__kernel_input *input, int e)
{
  return input->offset +
         (input->number != NULL ? input->number[e] : input->base + input->stride * e);
}

typedef struct dvi__kernel {
  dvi__graph *graph; /* `input` describes its inputs 0 .. input_count-1 */
  dvi__node root;
  int elements, input_count;
  const dvi__kernel_input *input;
} dvi__kernel;

typedef struct dvi__function dvi__function;

/* The cost of a function's evaluations so far, and the size of its programs. */
typedef struct dvi__function_counters {
  long value_points, gradient_points, second_points; /* points evaluated */
  /* operations at a point, -1 if not derived */
  int value_operations, gradient_operations, second_operations;
  int second_entries;
} dvi__function_counters;

/* Make a function of its kernels. Without kernels it is zero. Kernels are moved into it, even if it
 * fails. Graphs are freed with it, short ones at once. Index lists and data stay with their owner
 * and must outlive it. Blocks are copied. Nothing is derived yet. DVI_NO_MEMORY. */
dvi_status dvi__function_create(int kernel_count, const dvi__kernel *kernels,
                                const dvi__blocks *blocks, dvi__function **function);
void dvi__function_destroy(dvi__function **function);

/* Evaluate at `count` points. x[b] are the variables of block b, [width[b] * count]. Blocks that do
 * not occur may be NULL. All evaluations return 0, or 1 if a result is not finite
 * (dvi__function_fault tells where). If the program could not be made, they return a status below
 * zero, as dvi__function_prepare does. A result that is wanted for the first time is derived in
 * that call. */
int dvi__function_value(dvi__function *function, int count, const double *const *x, double *value);

/* Compute the derivatives by all variables of the blocks b for which gradient[b] is not NULL,
 * [width[b] * count]. */
int dvi__function_gradient(dvi__function *function, int count, const double *const *x,
                           double *const *gradient);

/* Compute the second derivatives of the pairs for which values[pair] is not NULL, in the order of
 * the patterns. */
int dvi__function_second(dvi__function *function, int count, const double *const *x,
                         double *const *values);

/* Compute Taylor coefficients 0 to `degree`, at most DVI_TAYLOR_MAX, along a curve. Results are
 * those of value, gradient[] and values[] that are not NULL. gradient and values may be NULL
 * themselves. Coefficient k of variable i of a block is x[block][k*width + i], and results are
 * stored likewise. DVI_BAD_SIZE if the rows of a program are too many. */
int dvi__function_series(dvi__function *function, int degree, const double *const *x, double *value,
                         double *const *gradient, double *const *values);

/* Find the pattern of a pair, without deriving. Its columns are sorted, and it has both
 * triangles if rows and columns are of one block. If it would hold more than half of all
 * entries, *full = 1 and there is no pattern. The function owns it. DVI_BAD_SIZE if an int
 * cannot count the entries. */
dvi_status dvi__function_pattern(dvi__function *function, int pair, dvi_pattern *pattern,
                                 int *full);

/* Derive now what a first call would derive, which is thread-safe, too. `value` asks for the value,
 * blocks[b] for the gradient by block b, and pairs[pair] for the second derivatives of a pair.
 * Blocks, and pairs, are derived together, as for one call. NULL asks for none. DVI_BAD_SIZE if
 * there is no room for so many intermediate results or entries, DVI_NO_MEMORY. */
dvi_status dvi__function_prepare(dvi__function *function, int value, const char *blocks,
                                 const char *pairs);

/* Return 1 if all second derivatives of a pair are constants, or if there are none, else 0. Return
 * -1 if they could not be derived. */
int dvi__function_second_constant(dvi__function *function, int pair);

/* The place of a fault in the source, and variables that the faulty part depends on. Variables that
 * the sentence shows are not listed. */
enum { DVI__FAULT_VARIABLES = 4 };
typedef struct dvi__fault {
  dvi__span span;
  int count; /* variables in the list */
  struct {
    int block, number;
    double value;
  } variable[DVI__FAULT_VARIABLES];
} dvi__fault;

/* Locate the first part that is not finite at point k of x, or with `of_series` has no Taylor
 * series. Writes "log(x - 1), x - 1 = -0.2 is not finite" to text [size], or "" if there is none.
 * Allocates, since it serves messages alone. */
void dvi__function_fault(dvi__function *function, const dvi__source *source, int count,
                         const double *const *x, int k, int of_series, char *text, size_t size,
                         dvi__fault *fault);

/* Copy a part of the source as one line to text [DVI__PART_SIZE]. A long part is cut. A part
 * without a place gives "". */
enum { DVI__PART_SIZE = 64 };
void dvi__copy_part(const dvi__source *source, dvi__span span, char *text);

/* Mark by 1 which of the first `count` nodes of a kernel depend on a variable. */
void dvi__mark_moving(const dvi__kernel *kernel, int count, char *moves);

void dvi__function_count(dvi__function *function, dvi__function_counters *counters);

/* Return the kernels, for searches for structure. */
int dvi__function_kernel_count(const dvi__function *function);
const dvi__kernel *dvi__function_kernel(const dvi__function *function, int k);

#endif
