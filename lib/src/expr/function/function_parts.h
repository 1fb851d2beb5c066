/* The parts of a function, shared by function*.c.
 *
 * Elements go through programs in tiles. The lanes of a row are some units of elements times some
 * points, with the points of an element side by side. Results are added up unit by unit, and in a
 * unit output by output. An output is added by the elements' order, or by halves where all elements
 * of a unit add to one entry. The order is a matter of the elements alone. */
#ifndef DVI_EXPR_FUNCTION_FUNCTION_PARTS_H
#define DVI_EXPR_FUNCTION_FUNCTION_PARTS_H
#include <pthread.h>
#include <stdatomic.h>

#include "expr/compile/program.h"
#include "expr/function/function.h"
#include "text/heap.h"

enum {
  DVI__UNIT = 32,                  /* elements of a unit */
  DVI__BLOCK_ROWS = 512,           /* rows of one block of lanes that fit into the nearest cache */
  DVI__IRREGULAR = -2147483647 - 1 /* marks numbers that have no stride */
};

/* The places of the elements, start + stride*e or start + list[e]. */
typedef struct dvi__element_places {
  const int *list;      /* NULL if places have a stride */
  const int *stride_of; /* [units] stride of a list within a unit, or DVI__IRREGULAR */
  int start, stride;
} dvi__element_places;

/* Entries of a result, minor + scale * major. With scale 0 there is no major. */
typedef struct dvi__entries {
  dvi__element_places minor, major;
  int scale;
} dvi__entries;

/* The target of an output, which is added or subtracted. It consists of entries of an array of the
 * result. For an output of both triangles their mirror images belong to it, too. */
typedef struct dvi__destination {
  int output, negative;
  int group; /* 1, 2 or 3 targets from this one on are added side by side */
  int array, mirrored;
  int sets; /* 1 if the output is stored, as the first thing there and alone in its kernel */
  dvi__entries entry, mirror;
  ptrdiff_t single, single_mirror; /* these entries of the only element */
} dvi__destination;

/* A kernel's share in a sum, or some of it. Its program reads a row for each of the variables
 * (inputs of the kernel), then one for each column. */
typedef struct dvi__part {
  const dvi__kernel *kernel;
  dvi__program program;
  int variable_count, column_count, target_count;
  int unit, lanes;               /* elements of a unit, most lanes of a tile */
  int large;                     /* 1 if tiles do not fit into the nearest cache */
  int *block;                    /* [variable_count] */
  dvi__element_places *variable; /* [variable_count] */
  const double **column;         /* [column_count], [elements], depend on no variable */
  dvi__destination *target;      /* [target_count] */
} dvi__part;

/* Kinds of results. They are the value, the gradient by some blocks, and the second derivatives of
 * some pairs. */
typedef enum dvi__derived { DVI__VALUE, DVI__GRADIENT, DVI__SECOND, DVI__DERIVED } dvi__derived;

/* The programs that compute the results of one call. Results are arrays, numbered as blocks or
 * pairs are. The value is one array. */
typedef struct dvi__function_sum {
  int part_count;
  dvi__part *part; /* [part_count] */
  int array_count;
  char *wanted;                     /* [array_count] 1 if the array is among the results */
  int result_count, *result;        /* [array_count] the numbers of these arrays */
  char *clear;                      /* [array_count] 1 if it must be zero before additions */
  int *size;                        /* [array_count] numbers of a point, 0 if not wanted */
  struct dvi__function_sum *before; /* the sum that was made before this one */
  struct dvi__function_sum *next;   /* another ready sum of this kind */
} dvi__function_sum;

/* A column that was computed, for all parts that need it. */
typedef struct dvi__column {
  dvi__node node;
  const double *value; /* [elements] */
  struct dvi__column *before;
} dvi__column;

/* Derivatives and columns of a kernel that are known. */
typedef struct dvi__derivatives {
  dvi__element_places *place; /* [input_count], for variables alone */
  dvi__node *gradient;        /* [input_count], NULL if not derived yet */
  int pair_count;             /* pairs of inputs, -1 if not found yet */
  int (*pair)[2];
  dvi__node *second;   /* [pair_count] -1 for those not derived yet, or NULL */
  dvi__column *column; /* the last column */
} dvi__derivatives;

typedef struct dvi__pair_pattern {
  int found, full, entries;
  dvi_pattern pattern;
} dvi__pair_pattern;

struct dvi__function {
  dvi__blocks blocks;
  int kernel_count;
  dvi__kernel *kernel;
  dvi__derivatives *derivatives; /* [kernel_count] */
  dvi__ledger *ledger;           /* the ledger charged for this function */
  pthread_mutex_t lock;          /* guards all below, and the kernels' graphs */
  dvi__ledger *other;            /* the ledger that the lock's holder charges otherwise */
  dvi__arena arena;
  dvi__function_sum *last;         /* the last sum made */
  dvi__pair_pattern *pattern;      /* [blocks.pair_count] */
  dvi__function_counters counters; /* operations and entries alone */
  /* Sums that are ready, the last one first. They are read without the lock. */
  _Atomic(dvi__function_sum *) ready[DVI__DERIVED];
  atomic_long points[DVI__DERIVED];
};

/* Return the elements of the unit that starts at `first`. */
static inline int dvi__unit_size(int elements, int first)
{
  return elements - first < DVI__UNIT ? elements - first : DVI__UNIT;
}

/* The places of a unit, start + stride*i for i = 0, 1, .., or start + list[i]. */
typedef struct dvi__track {
  const int *list;
  int start, stride;
} dvi__track;

static inline dvi__track dvi__track_of(const dvi__element_places *places, int first)
{
  if (places->list == NULL)
    return (dvi__track){.start = places->start + places->stride * first, .stride = places->stride};
  const int stride = places->stride_of[first / DVI__UNIT];
  if (stride == DVI__IRREGULAR)
    return (dvi__track){.list = places->list + first, .start = places->start};
  return (dvi__track){.start = places->start + places->list[first], .stride = stride};
}

/* Return the place of element e. */
static inline int dvi__place_at(const dvi__element_places *places, int e)
{
  return places->start + (places->list != NULL ? places->list[e] : places->stride * e);
}

/* Return the entry of element e. */
static inline ptrdiff_t dvi__entry_at(const dvi__entries *entries, int e)
{
  return dvi__place_at(&entries->minor, e) +
         (ptrdiff_t)entries->scale * dvi__place_at(&entries->major, e);
}

/* Choose the size of a part's tiles. DVI_BAD_SIZE if its rows leave no room for a unit. */
dvi_status dvi__part_plan(dvi__part *part);

/* Write short kernels out into one, which takes their place. The arena owns its inputs. */
dvi_status dvi__merge_kernels(dvi__arena *arena, int *kernel_count, dvi__kernel *kernels);

/* Find the strides of a list of numbers, unit by unit, in the arena. NULL if there is no memory. */
const int *dvi__strides(dvi__arena *arena, int elements, const int *list);

/* Add the sum at `count` points to result[array], [size * count]. */
void dvi__sum_add(const dvi__function_sum *sum, int count, const double *const *x,
                  double *const *result);

/* Add `count` Taylor coefficients of the sum along a curve. Coefficient k of a block's variable i
 * is at x[block][k*width[block] + i], and coefficient k of entry e of an array is at
 * result[array][k*size[array] + e]. DVI_BAD_SIZE if the rows of a program do not fit. */
dvi_status dvi__sum_add_series(const dvi__function_sum *sum, int count, const int *width,
                               const double *const *x, double *const *result);

/* Return the sum that is ready for the arrays a with wanted[a], or NULL. */
const dvi__function_sum *dvi__function_sum_of(const dvi__function *function, dvi__derived derived,
                                              const char *wanted);

/* Take the lock and charge the function's ledger, or undo both. dvi__function_leave returns the
 * status, and tells memory that ran out from a full ledger. */
void dvi__function_enter(dvi__function *function);
dvi_status dvi__function_leave(dvi__function *function, dvi_status status);

/* Add a part, not large, whose elements go through its program one by one, at as many of the first
 * points as serve as lanes of whole blocks. Returns how many those are, which is 0 where points are
 * few. */
int dvi__part_run_points(const dvi__part *part, int count, const double *const *x,
                         double *const *result);

/* Add a part of one element, not large, at DVI__LANES points or fewer. */
void dvi__part_run_block(const dvi__part *part, int points, const double *const *x,
                         double *const *result);

/* The following functions need the lock. */

/* Make an empty sum of so many arrays, none of them wanted. NULL if there is no memory. */
dvi__function_sum *dvi__sum_new(dvi__function *function, int array_count);

/* Add a part of kernel k. root[i] goes to target[i], which are kept. Roots that are equal, but for
 * the sign, become one output. */
dvi_status dvi__sum_extend(dvi__function *function, dvi__function_sum *sum, int k, int root_count,
                           dvi__node *root, dvi__destination *target);

/* Find the arrays that need not be zero before the sum is added, since they are stored first. */
dvi_status dvi__sum_finish(dvi__function_sum *sum);

/* Find which second derivatives of kernel k there are. dvi__find_pattern finds the pattern of a
 * pair. */
dvi_status dvi__find_pairs(dvi__function *function, int k);
dvi_status dvi__find_pattern(dvi__function *function, int pair);
/* Return the index of an entry that is in the pattern. */
int dvi__pattern_entry(const dvi_pattern *pattern, int row, int column);

/* Return 1 if the derivative by two variables of these blocks belongs to a pair. */
static inline int dvi__pair_has(dvi__block_pair pair, int a, int b)
{
  return (pair.rows == a && pair.columns == b) || (pair.rows == b && pair.columns == a);
}

/* Derive what an empty sum wants. Computes sizes, derivatives and programs. */
dvi_status dvi__derive(dvi__function *function, dvi__derived derived, dvi__function_sum *sum);

/* Derive the second derivatives of kernel k as nodes, for the pairs with wanted[pair]. */
dvi_status dvi__derive_pairs(dvi__function *function, int k, const char *wanted);

#endif
