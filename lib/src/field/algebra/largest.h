/* The largest eigenvalue of a pencil. */
#ifndef DVI_FIELD_ALGEBRA_LARGEST_H
#define DVI_FIELD_ALGEBRA_LARGEST_H
#include "field/algebra/modes.h"
#include "num/accumulator.h"

/* The rows of a pencil among those of a larger one, which several processes hold together. M is
 * diagonal. */
typedef struct dvi__rows {
  int64_t total;         /* rows of the larger one */
  const int64_t *number; /* [rows] ascending, by which the start at random is the same on all */
  const char *is_own;    /* [rows] the others belong to other processes */
  /* Set x [rows] of the others' rows to theirs. */
  dvi_status (*refresh)(void *of, double *x);
  /* Give the sum, or the largest number, of all processes. */
  dvi_status (*sum)(const void *all, dvi__accumulator *sum, double *value);
  dvi_status (*largest)(const void *all, double *value);
  /* Agree whether all processes have succeeded so far. */
  dvi_status (*agree)(const void *all, dvi_status status);
  void *of;        /* the first argument of refresh, */
  const void *all; /* and that of the others */
} dvi__rows;

/* Bound the largest eigenvalue from above, by at most a thousandth of it. K is positive
 * semidefinite. `rows` is NULL if all rows are here. */
dvi_status dvi__largest_eigenvalue(const dvi__pencil *pencil, const dvi__rows *rows, double *bound);

#endif
