/* The functions of cells of an interval, which solve (a phi')' = 0 in each. */
#ifndef DVI_FIELD_MULTISCALE_RISE_H
#define DVI_FIELD_MULTISCALE_RISE_H
#include "field/multiscale/coefficient.h"
#include "field/multiscale/fine_axis.h"

enum { DVI__RISE_POINTS_MAX = 16 /* Gauss points of a part */ };

/* The function s of a cell that rises from 0 to 1. In a part, from its start to its end,
 *     s = start + moment_0 y + sum_k>0 moment_k (P_k+1 - P_k-1)(2y-1)/2,  0 <= y <= 1,
 * with Legendre's polynomials P_k. The functions of the cell's ends are 1 - s and s. */
typedef struct dvi__rise {
  int points;     /* of a part, and moments */
  double *start;  /* [parts] */
  double *moment; /* [parts][points] */
  double *whole;  /* [cells] integrals of 1/a */
  double defect;  /* the largest change of one when there are twice as many parts */
} dvi__rise;

/* Find the functions. DVI_BAD_OPTION if `fine` parts do not resolve the coefficient,
 * DVI_CALLBACK_FAILED, DVI_NOT_FINITE, DVI_NO_MEMORY. On failure nothing is owned. */
dvi_status dvi__rise_create(const dvi__fine_axis *axis, const dvi__coefficient *coefficient,
                            int points, dvi__rise *rise);
void dvi__rise_clear(dvi__rise *rise);

/* Return s (order 0) or s' (order 1) at a place of a part. */
double dvi__rise_value(const dvi__rise *rise, const dvi__fine_axis *axis, int order, int part,
                       double place);

#endif
