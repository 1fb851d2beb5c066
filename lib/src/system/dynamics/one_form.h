/* The two-form Omega(q) of a one-form alpha(q), Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j, at one
 * point. */
#ifndef DVI_SYSTEM_DYNAMICS_ONE_FORM_H
#define DVI_SYSTEM_DYNAMICS_ONE_FORM_H
#include "system/evaluate/dynamics.h"

/* Factor Omega(q); x [n] <- Omega^-1 x with that. DVI_SINGULAR. */
dvi_status dvi__two_form_factor(dvi__evaluator *e, const double *q);
void dvi__two_form_solve(dvi__evaluator *e, double *x);

/* F [n] = Omega(q) v - H_q(t,q), without a factorisation. */
dvi_status dvi__two_form_residual(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *F);

/* scale [n]: the largest gradient of alpha at q that has to do with a coordinate; 1 where all
 * vanish. */
dvi_status dvi__form_scale(dvi__evaluator *e, const double *q, double *scale);

/* DVI_SINGULAR unless the symmetric part S of alpha's gradients D at q is definite, and with it the
 * eigenvalues of sign D^-T D away from 1 on the unit circle; with sign = 1 S may be 0. The sentence
 * names a gauge that helps. A [4*n*n]: room. */
dvi_status dvi__form_definite(dvi__evaluator *e, const double *q, int sign, double *A);

#endif
