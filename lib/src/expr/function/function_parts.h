/* What a function is made of; shared by function*.c.
 *
 * Elements go through programs in tiles: some units of elements times some points are the lanes of
 * a row, the points of an element side by side. Results are added up unit by unit, in a unit output
 * by output, and in an output by the elements' order, or, where all elements of a unit add to one
 * entry, by halves: the order is a matter of the elements alone. */
#ifndef DVI_SCENE_FUNCTION_PARTS_H
#define DVI_SCENE_FUNCTION_PARTS_H
#include <pthread.h>
#include <stdatomic.h>

#include "expr/function/function.h"
#include "text/heap.h"
#include "expr/compile/program.h"

enum {
  DVI__UNIT = 32,                  /* elements */
  DVI__BLOCK_ROWS = 512,           /* rows of one block of lanes that stay in the nearest cache */
  DVI__IRREGULAR = -2147483647 - 1 /* a stride of numbers that have none */
};

/* A place for each element: start + stride*e, or start + list[e]. */
typedef struct dvi__places {
  const int *list;      /* NULL: none */
  const int *stride_of; /* [units] with a list: its stride within a unit, or DVI__IRREGULAR */
  int start, stride;
} dvi__places;

/* Entries of a result: minor + scale * major. With scale 0 there is no major. */
typedef struct dvi__entries {
  dvi__places minor, major;
  int scale;
} dvi__entries;

/* Where an output is added, or subtracted: to entries of an array of the result, and, if it stands
 * for both triangles, to their mirror images. */
typedef struct dvi__destination {
  int output, negative;
  int group; /* so many targets, from this one on, are added side by side: the coordinates of a
                point; 1, 2 or 3 */
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
  int unit, lanes;          /* elements of a unit; most lanes of a tile */
  int large;                /* 1: not in the nearest cache */
  dvi__block *block;        /* [variable_count] */
  dvi__places *variable;    /* [variable_count] */
  const double **column;    /* [column_count], [elements] each: what depends on no variable */
  dvi__destination *target; /* [target_count] */
} dvi__part;

/* A value, a gradient by some blocks, or second derivatives by some pairs. */
typedef struct dvi__sum {
  int part_count;
  dvi__part *part;         /* [part_count] */
  unsigned clear;          /* bits 1 << array: those that are to be zero before anything is added */
  struct dvi__sum *before; /* made before this one */
} dvi__sum;

/* A column that was computed, for whatever else needs it. */
typedef struct dvi__column {
  dvi__node node;
  const double *value; /* [elements] */
  struct dvi__column *before;
} dvi__column;

/* What is known of a kernel beyond the kernel. */
typedef struct dvi__derivatives {
  dvi__places *place;  /* [input_count], of variables */
  dvi__node *gradient; /* [input_count], or NULL: not derived yet */
  int pair_count;      /* of inputs; -1: not found yet */
  int (*pair)[2];
  dvi__node *second;   /* [pair_count], or -1: not derived yet; or NULL */
  dvi__column *column; /* the last one */
} dvi__derivatives;

typedef struct dvi__pair_pattern {
  int found, full, entries;
  dvi_pattern pattern;
} dvi__pair_pattern;

struct dvi__function {
  int kernel_count, block_size[DVI__BLOCKS];
  dvi__kernel *kernel;
  dvi__derivatives *derivatives; /* of each kernel */
  dvi__ledger *ledger;           /* that was charged for it */
  pthread_mutex_t lock;          /* of all below, and of the kernels' graphs */
  dvi__ledger *other;            /* what the holder of the lock else charges */
  dvi__arena arena;
  dvi__sum *last; /* that was made */
  dvi__pair_pattern pattern[DVI__PAIRS];
  dvi__function_counters counters; /* of operations and entries */
  _Atomic(dvi__sum *) value, gradient[1 << DVI__BLOCKS], second[1 << DVI__PAIRS];
  atomic_long value_points, gradient_points, second_points;
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

static inline dvi__track dvi__track_of(const dvi__places *places, int first)
{
  if (places->list == NULL)
    return (dvi__track){NULL, places->start + places->stride * first, places->stride};
  const int stride = places->stride_of[first / DVI__UNIT];
  if (stride == DVI__IRREGULAR) return (dvi__track){places->list + first, places->start, 0};
  return (dvi__track){NULL, places->start + places->list[first], stride};
}

/* The place of element e. */
static inline int dvi__place_at(const dvi__places *places, int e)
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

/* The blocks of a pair: of its rows and of its columns. */
void dvi__pair_blocks(dvi__pair pair, dvi__block *rows, dvi__block *columns);
/* The pair of two blocks, in either order; DVI__PAIRS: there is none. */
dvi__pair dvi__pair_of(dvi__block a, dvi__block b);

/* Write short kernels out into one, which takes their place; inputs are the arena's. */
dvi_status dvi__merge_kernels(dvi__arena *arena, int *kernel_count, dvi__kernel *kernels);

/* The strides of a list of numbers, unit by unit, from the arena; NULL: no memory. */
const int *dvi__strides(dvi__arena *arena, int elements, const int *list);

/* Add the sum at `count` points to result[array], [entries * count]. */
void dvi__sum_add(const dvi__sum *sum, int count, const double *const *x, double *const *result);

/* Add its Taylor coefficients, `count` of them, along a curve: coefficient k of a block's variable
 * i is at x[block][k*block_size[block] + i], that of entry e of an array at
 * result[array][k*size[array] + e]. DVI_BAD_SIZE: the rows of a program do not fit. */
dvi_status dvi__sum_add_series(const dvi__sum *sum, int count, const int *block_size,
                               const double *const *x, const int *size, double *const *result);

/* Take the lock, and charge the function's ledger; the reverse, which tells memory that ran out
 * from a full ledger: returns the status. */
void dvi__function_enter(dvi__function *function);
dvi_status dvi__function_leave(dvi__function *function, dvi_status status);

/* The same for a part of one element, not large, at DVI__LANES points or fewer. */
void dvi__part_run_block(const dvi__part *part, int points, const double *const *x,
                         double *const *result);

/* The following want the lock. */

/* An empty sum; NULL: no memory. */
dvi__sum *dvi__sum_new(dvi__function *function);
/* Add a part of kernel k: root[i] goes to target[i], which are kept; roots that are equal, but for
 * the sign, become one output. */
dvi_status dvi__sum_extend(dvi__function *function, dvi__sum *sum, int k, int root_count,
                           dvi__node *root, dvi__destination *target);

/* Find what need not be zero before the sum is added to arrays of so many entries a point, since it
 * is stored there first. */
dvi_status dvi__sum_finish(dvi__sum *sum, int arrays, const int *entries);

/* Find which second derivatives of kernel k there are; and the pattern of a pair. */
dvi_status dvi__find_pairs(dvi__function *function, int k);
dvi_status dvi__find_pattern(dvi__function *function, dvi__pair pair);
/* The index of an entry that is in the pattern. */
int dvi__pattern_entry(const dvi_pattern *pattern, int row, int column);

/* Derivatives as nodes: gradient[], and second[] of the pairs in the mask. */
dvi_status dvi__derive_first(dvi__function *function, int k);
dvi_status dvi__derive_pairs(dvi__function *function, int k, unsigned pairs);

/* `mask`: of blocks, or of pairs. */
dvi_status dvi__derive_value(dvi__function *function, unsigned mask, dvi__sum **sum);
dvi_status dvi__derive_gradient(dvi__function *function, unsigned mask, dvi__sum **sum);
dvi_status dvi__derive_second(dvi__function *function, unsigned mask, dvi__sum **sum);

#endif
