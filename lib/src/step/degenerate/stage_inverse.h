/* The inverse of the linearised equations of the stages of a one-form.
 *
 * The stages are lanes. Unknowns y move them by X = G y. The rows of a component are
 *
 *     R_i = sum_j ( A_ij X_j - G (B_ij y_j + K_ij X_j) )
 *
 * with numbers A_ij, B_ij, K_ij at each stage, of which K is O(h). On a smooth path, where A and
 * B = A^T change by O(h) in a step,
 *
 *     G^-1 R = -Omega y + O(h),    Omega = A^T - A.
 *
 * Hence -Omega^-1 G^-1 R, with the mean Omega of the stages, is 1 + O(h). It needs no exchanges of
 * rows and no scales, and its determinant is positive.
 *
 * The last stage may be the end, and its unknown a multiplier. Its row has the sign -1. The number
 * B y + K X of the end stands in that row alone, and each row has a number a y + c X of the end
 * besides, subtracted before the sign. */
#ifndef DVI_STEP_DEGENERATE_STAGE_INVERSE_H
#define DVI_STEP_DEGENERATE_STAGE_INVERSE_H
#include <dvi/status.h>

enum { DVI__STAGE_LANES = 8 }; /* most stages */

typedef struct dvi__stage_inverse dvi__stage_inverse;

typedef struct dvi__stage_tableau {
  int stages, has_end;
  double moved[DVI__STAGE_LANES][DVI__STAGE_LANES]; /* G by columns */
} dvi__stage_tableau;

/* Create an inverse for n components. *inverse stays NULL if G is singular, or where a factor costs
 * less. DVI_NO_MEMORY. */
dvi_status dvi__stage_inverse_create(int n, const dvi__stage_tableau *tableau,
                                     dvi__stage_inverse **inverse);
void dvi__stage_inverse_destroy(dvi__stage_inverse **inverse);

/* The numbers of an entry, for the stages. Those of other lanes stay 0. */
typedef struct dvi__stage_entry {
  double A[DVI__STAGE_LANES], B[DVI__STAGE_LANES], K[DVI__STAGE_LANES];
  double a, c;
} dvi__stage_entry;

/* Give the place of entry (i,j), which the caller fills. */
dvi__stage_entry *dvi__stage_inverse_entry(dvi__stage_inverse *inverse, int i, int j);

/* Invert. Omega is the mean over the first `count` stages with these weights. Returns 0 if the
 * matrix is far from 1. */
int dvi__stage_inverse_begin(dvi__stage_inverse *inverse, int count, const double *weight);

/* Replace r [n*stages], component by component, by y. */
void dvi__stage_inverse_solve(dvi__stage_inverse *inverse, double *r);

#endif
