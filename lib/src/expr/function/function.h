/* Functions f(x_0, .., x_m) of blocks of variables that are sums of kernels. A kernel is one
 * expression, summed over elements (one, or the pairs of bodies, or the springs of a chain) that
 * read different variables and data:
 *
 *     f(x) = sum over kernels, sum over elements e:
 *            g(x[variable_1(e)], .., x[variable_m(e)], data_1(e), ..)
 *
 * Variables come in blocks, each of some width, and a block is named by its number: for a
 * Lagrangian these are time, coordinates and velocities, for the density of a field u, u_t, u_x and
 * so on. Second derivatives come in pairs of blocks, which are named by their numbers, too.
 *
 * Derivatives are those of the expression g, added up as finite elements are. Blocks are stored in
 * the shape of a batch: variable i of point k is x[i*count + k]. The order of every sum is fixed
 * when a function is made. Digits depend neither on the number of points nor on threads.
 * Evaluations allocate nothing and may run on several threads at a time. */
#ifndef DVI_EXPR_FUNCTION_H
#define DVI_EXPR_FUNCTION_H
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

/* Where an input of a kernel comes from. For element e it is variable number[e] + offset of the
 * block, or base + stride * e + offset if number is NULL. If is_data it is data[e]; constants are
 * folded by whoever made the kernel. */
typedef struct dvi__kernel_input {
  int is_data;
  int block;
  const int *number; /* [elements] of the kernel, shared by inputs */
  int base, stride, offset;
  const double *data; /* [elements] */
} dvi__kernel_input;

/* The variable that an input is for element e. */
static inline int dvi__input_number(const dvi__kernel_input *input, int e)
{
  return input->offset +
         (input->number != NULL ? input->number[e] : input->base + input->stride * e);
}

typedef struct dvi__kernel {
  dvi__graph *graph; /* its inputs 0 .. input_count-1 are `input` */
  dvi__node root;
  int elements, input_count;
  const dvi__kernel_input *input;
} dvi__kernel;

typedef struct dvi__function dvi__function;

/* What the evaluations of a function have cost so far, and what was made for them. */
typedef struct dvi__function_counters {
  long value_points, gradient_points, second_points;            /* points evaluated */
  int value_operations, gradient_operations, second_operations; /* a point; -1: not derived */
  int second_entries;
} dvi__function_counters;

/* Make a function of its kernels (none: zero). They are moved into it, even if it fails: graphs are
 * freed with it, short ones at once; index lists and data stay with their owner and must outlive
 * it. Blocks are copied. Nothing is derived yet.
 * DVI_NO_MEMORY. */
dvi_status dvi__function_create(int kernel_count, const dvi__kernel *kernels,
                                const dvi__blocks *blocks, dvi__function **function);
void dvi__function_destroy(dvi__function **function);

/* Evaluate at `count` points. x[b] are the variables of block b, [width[b] * count]; blocks that do
 * not occur may be NULL. All return 0; 1 if a result is not finite (dvi__function_fault tells
 * where); or a status below zero if the program could not be made, as dvi__function_prepare says.
 * What is wanted for the first time is derived in that call. */
int dvi__function_value(dvi__function *function, int count, const double *const *x, double *value);

/* The derivatives by all variables of the blocks b for which gradient[b] is not NULL,
 * [width[b] * count]. */
int dvi__function_gradient(dvi__function *function, int count, const double *const *x,
                           double *const *gradient);

/* The second derivatives of the pairs for which values[pair] is not NULL, in the order of the
 * patterns. */
int dvi__function_second(dvi__function *function, int count, const double *const *x,
                         double *const *values);

/* The same along a curve: Taylor coefficients 0 to `degree`, at most DVI_TAYLOR_MAX, of what is
 * NULL in none of value, gradient[] and values[]; the latter two may be NULL themselves.
 * Coefficient k of variable i of a block is x[block][k*width + i], and results are stored likewise.
 * DVI_BAD_SIZE: too large for that. */
int dvi__function_series(dvi__function *function, int degree, const double *const *x, double *value,
                         double *const *gradient, double *const *values);

/* The pattern of a pair: sorted columns, and both triangles if rows and columns are of one block.
 * *full = 1 and no pattern if it would hold more than half of all entries. Found without deriving;
 * owned by the function. DVI_BAD_SIZE if an int cannot count the entries. */
dvi_status dvi__function_pattern(dvi__function *function, int pair, dvi_pattern *pattern,
                                 int *full);

/* Derive now what else would be derived at a first call (thread-safe either way): the value's
 * program if `value`; the gradient by the blocks b with blocks[b], and the second derivatives of
 * the pairs with pairs[pair], each together as one call would ask for them; NULL: none.
 * DVI_BAD_SIZE: more intermediate results, or entries, than there is room for; DVI_NO_MEMORY. */
dvi_status dvi__function_prepare(dvi__function *function, int value, const char *blocks,
                                 const char *pairs);

/* 1 if all second derivatives of a pair are constants, which no variable changes (also if there are
 * none); 0; or -1 if they could not be derived. */
int dvi__function_second_constant(dvi__function *function, int pair);

/* Where a part stands, and the variables that it depends on, those that its sentence shows left
 * out. */
enum { DVI__FAULT_VARIABLES = 4 };
typedef struct dvi__fault {
  dvi__span span;
  int count; /* of variables, the first ones alone */
  struct {
    int block, number;
    double value;
  } variable[DVI__FAULT_VARIABLES];
} dvi__fault;

/* Locate the first part that is not finite at point k of x, or, `of_series`, has no series: writes
 * "log(x - 1), x - 1 = -0.2 is not finite" to text [size]; "" if there is none. Allocates; for
 * messages. */
void dvi__function_fault(dvi__function *function, const dvi__source *source, int count,
                         const double *const *x, int k, int of_series, char *text, size_t size,
                         dvi__fault *fault);

/* A part of the source on one line, cut if it is long; "" if it is nowhere. text
 * [DVI__PART_SIZE] */
enum { DVI__PART_SIZE = 64 };
void dvi__copy_part(const dvi__source *source, dvi__span span, char *text);

/* Mark, 1, which of the first `count` nodes of a kernel depend on a variable. */
void dvi__mark_moving(const dvi__kernel *kernel, int count, char *moves);

void dvi__function_count(dvi__function *function, dvi__function_counters *counters);

/* What kernels have in common, for whoever looks for structure. */
int dvi__function_kernel_count(const dvi__function *function);
const dvi__kernel *dvi__function_kernel(const dvi__function *function, int k);

#endif
