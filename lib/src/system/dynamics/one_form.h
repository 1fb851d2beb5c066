/* The two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j of a one-form alpha(q), at one point. */
#ifndef DVI_SYSTEM_DYNAMICS_ONE_FORM_H
#define DVI_SYSTEM_DYNAMICS_ONE_FORM_H
#include "system/evaluate/dynamics.h"

/* Factor Omega(q), and compute x [n] <- Omega^-1 x with the factors. The first may return
 * DVI_SINGULAR. */
dvi_status dvi__two_form_factor(dvi__evaluator *e, const double *q);
void dvi__two_form_solve(dvi__evaluator *e, double *x);

/* Compute F [n] = Omega(q) v - H_q(t,q), without a factorisation. */
dvi_status dvi__two_form_residual(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *F);

/* Compute scale [n], the largest gradient of alpha at q that involves a coordinate. It is 1 where
 * all vanish. */
dvi_status dvi__form_scale(dvi__evaluator *e, const double *q, double *scale);

/* Return DVI_SINGULAR unless the symmetric part S of alpha's gradients D at q is definite, and the
 * eigenvalues of sign D^-T D on the unit circle keep away from 1. With sign = 1 S may be 0. The
 * sentence names a gauge that helps. A [4*n*n] is work. */
dvi_status dvi__form_definite(dvi__evaluator *e, const double *q, int sign, double *A);

#endif
