/* What tableaux of stages are made from. */
#ifndef DVI_ACTION_COLLOCATION_H
#define DVI_ACTION_COLLOCATION_H
#include <dvi/status.h>

enum { DVI__STAGES_MOST = 8 };

/* a_ij of collocation at the s distinct nodes c: the integral of the j-th Lagrange polynomial from
 * 0 to c_i. */
dvi_status dvi__collocate(int s, const double *c, double a[DVI__STAGES_MOST][DVI__STAGES_MOST]);

/* weight [s]: the polynomial through values at the nodes c has at tau the value sum_j weight_j
 * times value_j. */
void dvi__lagrange_weights(int s, const double *c, double tau, double *weight);

#endif
