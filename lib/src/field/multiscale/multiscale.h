/* Multiscale finite elements in two dimensions: functions of the cells of a box that solve
 * div (a grad phi) = 0 in each, on a grid of fine cells. */
#ifndef DVI_FIELD_MULTISCALE_MULTISCALE_H
#define DVI_FIELD_MULTISCALE_MULTISCALE_H
#include "field/multiscale/coefficient.h"
#include "field/multiscale/fine_axis.h"

/* Values of the local functions on the edges of a cell. */
typedef enum dvi__edges {
  DVI__EDGES_SOLVED,     /* those of the problem of one dimension along the edge */
  DVI__EDGES_LINEAR,     /* linear */
  DVI__EDGES_OVERSAMPLED /* combinations of solutions on a larger cell with linear edges */
} dvi__edges;

typedef struct dvi__multiscale_terms {
  const double *node[2]; /* [cells+1] ends of the coarse cells */
  int cells[2], is_periodic[2];
  int fine; /* fine cells along each edge of a coarse one */
  dvi__edges edges;
  int overlap; /* fine cells by which oversampling enlarges a cell on each side */
  int threads;
  dvi__coefficient coefficient;
} dvi__multiscale_terms;

enum { DVI__MULTISCALE_LOCALS = 4 };

typedef struct dvi__multiscale {
  dvi__fine_axis axis[2];
  /* [coarse cells][4][(fine+1)^2] local functions at the fine nodes. The second axis runs fastest
   * in all three */
  double *value;
  double defect; /* largest change of the means of a and 1/a over a cell with finer parts */
} dvi__multiscale;

/* Refuse functions with more values than an int can count. DVI_BAD_SIZE. */
dvi_status dvi__multiscale_check_size(const dvi__multiscale_terms *terms);

/* Find the functions. DVI_BAD_OPTION if the fine cells do not resolve the coefficient,
 * DVI_BAD_SIZE, DVI_CALLBACK_FAILED, DVI_NOT_FINITE, DVI_SINGULAR, DVI_NO_MEMORY. On failure
 * nothing is owned. */
dvi_status dvi__multiscale_create(const dvi__multiscale_terms *terms, dvi__multiscale *multiscale);
void dvi__multiscale_clear(dvi__multiscale *multiscale);

/* Give the functions that do not vanish at a place of a fine cell, ascending, and their derivatives
 * there, with `order` 0 or 1 along each axis. Return their number, at most 4. Functions are those
 * of the nodes of the coarse grid, the second axis running fastest. */
int dvi__multiscale_row(const dvi__multiscale *multiscale, const int *order, const int *part,
                        const double *place, int *column, double *value);

#endif
