/* Collocation coefficients, from which tableaux of stages are made. */
#ifndef DVI_STEP_ONESTEP_COLLOCATION_H
#define DVI_STEP_ONESTEP_COLLOCATION_H
#include <dvi/status.h>

enum { DVI__STAGES_MOST = 8 };

/* Compute a_ij of collocation at the s distinct nodes c. This is the integral of the j-th Lagrange
 * polynomial from 0 to c_i. */
dvi_status dvi__collocate(int s, const double *c, double a[DVI__STAGES_MOST][DVI__STAGES_MOST]);

/* The same by the nodes and weights of Gauss's rule with s nodes, where the caller has them. */
void dvi__collocate_by(int s, const double *c, const double *node, const double *gauss,
                       double a[DVI__STAGES_MOST][DVI__STAGES_MOST]);

/* Compute weight [s]. The polynomial through values at the nodes c has the value sum_j weight_j
 * value_j at tau. */
void dvi__lagrange_weights(int s, const double *c, double tau, double *weight);

#endif
