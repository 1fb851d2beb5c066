/* What a function is made of; shared by function*.c.
 *
 * Elements go through programs in tiles: some units of elements times some points are the lanes of
 * a row, the points of an element side by side. Results are added up unit by unit, in a unit output
 * by output, and in an output by the elements' order, or, where all elements of a unit add to one
 * entry, by halves: the order is a matter of the elements alone. */
#ifndef DVI_EXPR_FUNCTION_PARTS_H
#define DVI_EXPR_FUNCTION_PARTS_H
#include <pthread.h>
#include <stdatomic.h>

#include "expr/compile/program.h"
#include "expr/function/function.h"
#include "text/heap.h"

enum {
  DVI__UNIT = 32,                  /* elements */
  DVI__BLOCK_ROWS = 512,           /* rows of one block of lanes that stay in the nearest cache */
  DVI__IRREGULAR = -2147483647 - 1 /* a stride of numbers that have none */
};

/* A place for each element: start + stride*e, or start + list[e]. */
typedef struct dvi__element_places {
  const int *list;      /* NULL: none */
  const int *stride_of; /* [units] with a list: its stride within a unit, or DVI__IRREGULAR */
  int start, stride;
} dvi__element_places;

/* Entries of a result: minor + scale * major. With scale 0 there is no major. */
typedef struct dvi__entries {
  dvi__element_places minor, major;
  int scale;
} dvi__entries;

/* Where an output is added, or subtracted: to entries of an array of the result, and, if it stands
 * for both triangles, to their mirror images. */
typedef struct dvi__destination {
  int output, negative;
  int group; /* so many targets, from this one on, are added side by side: 1, 2 or 3 */
  int array, mirrored;
  int sets; /* 1: the first and only thing that is added so far to where it goes: it is stored */
  dvi__entries entry, mirror;
  ptrdiff_t single, single_mirror; /* these entries, of the only element */
} dvi__destination;

/* A kernel's share in a sum, or some of it. Its program reads a row for each of the variables
 * (inputs of the kernel), then one for each column. */
typedef struct dvi__part {
  const dvi__kernel *kernel;
  dvi__program program;
  int variable_count, column_count, target_count;
  int unit, lanes;               /* elements of a unit; most lanes of a tile */
  int large;                     /* 1: not in the nearest cache */
  int *block;                    /* [variable_count] */
  dvi__element_places *variable; /* [variable_count] */
  const double **column;         /* [column_count], [elements] each: what depends on no variable */
  dvi__destination *target;      /* [target_count] */
} dvi__part;

/* What is derived: the value, the gradient by some blocks, the second derivatives of some pairs. */
typedef enum dvi__derived { DVI__VALUE, DVI__GRADIENT, DVI__SECOND, DVI__DERIVED } dvi__derived;

/* The programs that compute what one call asks for. Results are arrays, numbered as blocks or pairs
 * are; the value is one array. */
typedef struct dvi__function_sum {
  int part_count;
  dvi__part *part; /* [part_count] */
  int array_count;
  char *wanted;                     /* [array_count] 1: the array is among the results */
  int result_count, *result;        /* [array_count] the numbers of those that are */
  char *clear;                      /* [array_count] 1: must be zero before anything is added */
  int *size;                        /* [array_count] numbers of a point; 0: not wanted */
  struct dvi__function_sum *before; /* the sum that was made before this one */
  struct dvi__function_sum *next;   /* another one of this kind that is ready */
} dvi__function_sum;

/* A column that was computed, for whatever else needs it. */
typedef struct dvi__column {
  dvi__node node;
  const double *value; /* [elements] */
  struct dvi__column *before;
} dvi__column;

/* What is known of a kernel beyond the kernel. */
typedef struct dvi__derivatives {
  dvi__element_places *place; /* [input_count], of variables */
  dvi__node *gradient;        /* [input_count], or NULL: not derived yet */
  int pair_count;             /* of inputs; -1: not found yet */
  int (*pair)[2];
  dvi__node *second;   /* [pair_count], or -1: not derived yet; or NULL */
  dvi__column *column; /* the last one */
} dvi__derivatives;

typedef struct dvi__pair_pattern {
  int found, full, entries;
  dvi_pattern pattern;
} dvi__pair_pattern;

struct dvi__function {
  dvi__blocks blocks;
  int kernel_count;
  dvi__kernel *kernel;
  dvi__derivatives *derivatives; /* of each kernel */
  dvi__ledger *ledger;           /* that was charged for it */
  pthread_mutex_t lock;          /* of all below, and of the kernels' graphs */
  dvi__ledger *other;            /* what the holder of the lock else charges */
  dvi__arena arena;
  dvi__function_sum *last;         /* that was made */
  dvi__pair_pattern *pattern;      /* [blocks.pair_count] */
  dvi__function_counters counters; /* of operations and entries */
  /* Sums that are ready, the last one first; they are read without the lock. */
  _Atomic(dvi__function_sum *) ready[DVI__DERIVED];
  atomic_long points[DVI__DERIVED];
};

/* Elements of the unit that starts at `first`. */
static inline int dvi__unit_size(int elements, int first)
{
  return elements - first < DVI__UNIT ? elements - first : DVI__UNIT;
}

/* A unit's places: start + stride*i for i = 0, 1, .., or start + list[i]. */
typedef struct dvi__track {
  const int *list;
  int start, stride;
} dvi__track;

static inline dvi__track dvi__track_of(const dvi__element_places *places, int first)
{
  if (places->list == NULL)
    return (dvi__track){NULL, places->start + places->stride * first, places->stride};
  const int stride = places->stride_of[first / DVI__UNIT];
  if (stride == DVI__IRREGULAR) return (dvi__track){places->list + first, places->start, 0};
  return (dvi__track){NULL, places->start + places->list[first], stride};
}

/* The place of element e. */
static inline int dvi__place_at(const dvi__element_places *places, int e)
{
  return places->start + (places->list != NULL ? places->list[e] : places->stride * e);
}

/* The entry of element e. */
static inline ptrdiff_t dvi__entry_at(const dvi__entries *entries, int e)
{
  return dvi__place_at(&entries->minor, e) +
         (ptrdiff_t)entries->scale * dvi__place_at(&entries->major, e);
}

/* Choose the size of a part's tiles; DVI_BAD_SIZE: its rows leave no room for a unit. */
dvi_status dvi__part_plan(dvi__part *part);

/* Write short kernels out into one, which takes their place; inputs are the arena's. */
dvi_status dvi__merge_kernels(dvi__arena *arena, int *kernel_count, dvi__kernel *kernels);

/* The strides of a list of numbers, unit by unit, from the arena; NULL: no memory. */
const int *dvi__strides(dvi__arena *arena, int elements, const int *list);

/* Add the sum at `count` points to result[array], [size * count]. */
void dvi__sum_add(const dvi__function_sum *sum, int count, const double *const *x,
                  double *const *result);

/* Add its Taylor coefficients, `count` of them, along a curve: coefficient k of a block's variable
 * i is at x[block][k*width[block] + i], that of entry e of an array at
 * result[array][k*size[array] + e]. DVI_BAD_SIZE: the rows of a program do not fit. */
dvi_status dvi__sum_add_series(const dvi__function_sum *sum, int count, const int *width,
                               const double *const *x, double *const *result);

/* The sum that is ready for the arrays a with wanted[a]; NULL: none. */
const dvi__function_sum *dvi__function_sum_of(const dvi__function *function, dvi__derived derived,
                                              const char *wanted);

/* Take the lock, and charge the function's ledger; the reverse, which tells memory that ran out
 * from a full ledger: returns the status. */
void dvi__function_enter(dvi__function *function);
dvi_status dvi__function_leave(dvi__function *function, dvi_status status);

/* The same for a part of one element, not large, at DVI__LANES points or fewer. */
void dvi__part_run_block(const dvi__part *part, int points, const double *const *x,
                         double *const *result);

/* The following want the lock. */

/* An empty sum of so many arrays, none of them wanted; NULL: no memory. */
dvi__function_sum *dvi__sum_new(dvi__function *function, int array_count);

/* Add a part of kernel k: root[i] goes to target[i], which are kept; roots that are equal, but for
 * the sign, become one output. */
dvi_status dvi__sum_extend(dvi__function *function, dvi__function_sum *sum, int k, int root_count,
                           dvi__node *root, dvi__destination *target);

/* Find what need not be zero before the sum is added, since it is stored there first. */
dvi_status dvi__sum_finish(dvi__function_sum *sum);

/* Find which second derivatives of kernel k there are; and the pattern of a pair. */
dvi_status dvi__find_pairs(dvi__function *function, int k);
dvi_status dvi__find_pattern(dvi__function *function, int pair);
/* The index of an entry that is in the pattern. */
int dvi__pattern_entry(const dvi_pattern *pattern, int row, int column);

/* Whether the derivative by two variables of these blocks belongs to a pair. */
static inline int dvi__pair_has(dvi__block_pair pair, int a, int b)
{
  return (pair.rows == a && pair.columns == b) || (pair.rows == b && pair.columns == a);
}

/* Derive what the sum wants, of which it is the first: compute sizes, derivatives, programs. */
dvi_status dvi__derive(dvi__function *function, dvi__derived derived, dvi__function_sum *sum);

/* Derive the second derivatives of kernel k as nodes, of the pairs with wanted[pair]. */
dvi_status dvi__derive_pairs(dvi__function *function, int k, const char *wanted);

#endif
