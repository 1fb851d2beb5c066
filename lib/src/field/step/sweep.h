/* The two loops of a leapfrog step on a mesh with diagonal stars, and their threads. */
#ifndef DVI_FIELD_STEP_SWEEP_H
#define DVI_FIELD_STEP_SWEEP_H
#include "field/model/field.h"
#include "num/team.h"

/* The cells and (k+1)-cells of a field, their neighbours, and coefficients of a step.
 *
 * The state of a (k+1)-cell is H = M_{k+1} B, so that the loop over k-cells reads one number of it.
 * Where M_{k+1} is zero it is B itself, which no k-cell reads. Stars that are not diagonal have B
 * everywhere. */
typedef struct dvi__sweep {
  int64_t cells, faces; /* of degree k and k+1 */
  int width;            /* k-cells of a (k+1)-cell */
  const int *facet;     /* [faces*width] rows of d_k */
  const int8_t *sign;   /* [faces*width] */
  int has_pattern;      /* the signs are the same in all rows */
  unsigned *start;      /* [cells+1] columns of d_k */
  unsigned *around;     /* [start[cells]] 2 f, or 2 f + 1 for the sign -1 */
  double *weight;       /* [faces] M_{k+1}, or 1 where it is zero or not diagonal */
  int is_diagonal;
  dvi__team *team;
  int threads;
} dvi__sweep;

/* Prepare. DVI_BAD_SIZE if 31 bits cannot number the (k+1)-cells, or 32 the
 * neighbours. On failure nothing is owned. */
dvi_status dvi__sweep_create(const dvi_field *field, int threads, dvi__sweep *sweep);
void dvi__sweep_clear(dvi__sweep *sweep);

/* H -= dt weight d E. */
void dvi__sweep_H(const dvi__sweep *sweep, double dt, const double *E, double *H);

/* E = keep E + gain d^T H cell by cell. `keep` is NULL for 1. */
void dvi__sweep_E(const dvi__sweep *sweep, const double *keep, const double *gain, const double *H,
                  double *E);

/* Give one row of d^T H, or of d E. */
double dvi__sweep_curl(const dvi__sweep *sweep, int64_t cell, const double *H);
double dvi__sweep_d(const dvi__sweep *sweep, int64_t face, const double *E);

#endif
