/* Functions f(t, x, w, ..) that are sums of kernels: a kernel is one expression, summed over
 * elements (one, or the pairs of bodies, or the springs of a chain) that read different variables
 * and data.
 *
 *     f(x) = sum over kernels, sum over elements e:  g(x[variable_1(e)], .., x[variable_m(e)],
 * data_1(e), ..)
 *
 * Derivatives are those of the expression g, added up as finite elements are. Variables come in
 * blocks (time, coordinates, velocities or momenta, multipliers), each stored in the shape of a
 * batch: variable i of point k is x[i*count + k]. The order of every sum is fixed when a function
 * is made: digits depend neither on the number of points nor on threads. Evaluations allocate
 * nothing and may run on several threads at a time. */
#ifndef DVI_SCENE_FUNCTION_H
#define DVI_SCENE_FUNCTION_H
#include <dvi/system.h>

#include "expr/graph.h"

typedef enum dvi__block {
  DVI__TIME,
  DVI__COORDINATES,
  DVI__VELOCITIES,
  DVI__MULTIPLIERS,
  DVI__BLOCKS
} dvi__block;

/* Where an input of a kernel comes from, for element e: variable number[e] + offset of the block,
 * or base + stride * e + offset if number is NULL; or data[e], if they are not all the same:
 * constants are folded by whoever made the kernel. */
typedef struct dvi__kernel_input {
  int is_data;
  dvi__block block;
  const int *number; /* [elements] of the kernel, shared by inputs; owned by who made the kernel */
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
 * it. block_size[b]: how many variables a block has. Nothing is derived yet. */
dvi_status dvi__function_create(int kernel_count, const dvi__kernel *kernels, const int *block_size,
                                dvi__function **function);
void dvi__function_destroy(dvi__function **function);

/* x[b] are the blocks' variables, [block_size[b] * count]; blocks that do not occur may be NULL.
 * All return 0, 1 if a result is not finite (then dvi__function_blame tells where), or a status
 * below zero if the program could not be made, as dvi__function_prepare says. Each is derived for
 * the blocks or pairs that are asked for, at the first call or by _prepare. */
int dvi__function_value(dvi__function *function, int count, const double *const *x, double *value);
/* The derivatives by all variables of the blocks for which gradient[b] is not NULL, [block_size[b]
 * * count]. */
int dvi__function_gradient(dvi__function *function, int count, const double *const *x,
                           double *const *gradient);
/* Second derivatives by (row, column) variables of the block pairs for which values[pair] is not
 * NULL, in the order of the patterns. */
typedef enum dvi__pair {
  DVI__PAIR_QQ,
  DVI__PAIR_QV,
  DVI__PAIR_VV,
  DVI__PAIR_QW,
  DVI__PAIR_VW,
  DVI__PAIR_TQ,
  DVI__PAIR_TV,
  DVI__PAIRS
} dvi__pair;
int dvi__function_second(dvi__function *function, int count, const double *const *x,
                         double *const *values);

/* The same along a curve: Taylor coefficients 0 to `degree`, at most DVI_TAYLOR_MAX, of what is
 * NULL in none of value, gradient[] and values[]; the latter two may be NULL themselves.
 * Coefficient k of variable i of a block is x[block][k*block_size + i], and results are stored
 * likewise. DVI_BAD_SIZE: too large for that. */
int dvi__function_series(dvi__function *function, int degree, const double *const *x, double *value,
                         double *const *gradient, double *const *values);

/* The pattern of a pair of blocks, whose first one has the rows (tq is one row): sorted columns,
 * both triangles of qq and vv; *full = 1 and no pattern if it would hold more than half of all
 * entries. Found without deriving; owned by the function. DVI_BAD_SIZE if an int cannot count the
 * entries. */
dvi_status dvi__function_pattern(dvi__function *function, dvi__pair pair, dvi_pattern *pattern,
                                 int *full);

/* Derive now what else would be derived at a first call (thread-safe either way): the value's
 * program, the gradient by the blocks in `blocks`, bits 1 << b, and the second derivatives of
 * `pairs`, bits 1 << pair; 0: none. DVI_BAD_SIZE: more intermediate results, or entries, than there
 * is room for; DVI_NO_MEMORY. */
dvi_status dvi__function_prepare(dvi__function *function, int value, unsigned blocks,
                                 unsigned pairs);

/* 1 if all second derivatives of a pair are constants, which no variable changes (also if there are
 * none); 0; or -1 if they could not be derived. */
int dvi__function_second_constant(dvi__function *function, dvi__pair pair);

/* Where a part stands, and the variables that it depends on, those that its sentence shows left
 * out. */
enum { DVI__FAULT_VARIABLES = 4 };
typedef struct dvi__fault {
  dvi__span span;
  int count; /* of variables, the first ones alone */
  struct {
    dvi__block block;
    int number;
    double value;
  } variable[DVI__FAULT_VARIABLES];
} dvi__fault;

/* The first part that is not finite at point k of x, or, `of_series`, has no series: writes
 * "log(x - 1), x - 1 = -0.2 is not finite" to text [size]; "" if there is none. Allocates; for
 * messages. */
void dvi__function_blame(dvi__function *function, const dvi__source *source, int count,
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
