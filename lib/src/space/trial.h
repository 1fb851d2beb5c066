/* The reduced trial functions psi_k = phi_k - phi_k(0), k = 1..degree. In every basis they span the
 * polynomials of this degree that vanish at tau = 0. So a step's path is q(tau) = q0 + sum_k
 * psi_k(tau) Y_k.
 *
 * Arrays over k hold psi_1 at index 0. basis and degree must be valid. The work is done in long
 * double and rounded once. */
#ifndef DVI_SPACE_TRIAL_H
#define DVI_SPACE_TRIAL_H
#include "space/basis.h"

/* Compute psi[degree] = psi_k(tau), bar[degree] = phi_k(tau) - phi_k(1),
 * dpsi[degree] = phi_k'(tau). Each may be NULL. */
void dvi__trial_at(dvi_basis basis, int degree, double tau, double *psi, double *bar, double *dpsi);

/* Compute these at a tau that was not rounded to double, such as a node of dvi__quadrature_long. */
void dvi__trial_at_long(dvi_basis basis, int degree, long double tau, double *psi, double *bar,
                        double *dpsi);

/* Compute these from tables of dvi__space_init, for many tau. This costs about 3 degree operations
 * instead of degree^2. */
void dvi__trial_in(const dvi__space *space, long double tau, double *psi, double *bar,
                   double *dpsi);

/* Continue a step's polynomial into the next step by Y_next = shift Y, shift[degree*degree] by
 * rows.
 *
 * The best approximation of q' = sum_l psi_l' Y_l of degree keep-1 in L2(0,1), 1 <= keep <= degree,
 * is integrated from the end on. So sum_k psi_k(tau) Y_next_k = q(1 + ratio tau) - q(1), with ratio
 * = h_next / h. */
void dvi__trial_shift(dvi_basis basis, int degree, int keep, double ratio, double *shift);

/* Compute matrix[degree*points] by rows, with which Y = matrix (values - q0) for values at
 * tau[points]. The points are distinct and not 0, degree <= points <= DVI_QUADRATURE_MAX. The
 * result interpolates, or fits by least squares if there are more points than coefficients. */
void dvi__trial_fit(dvi_basis basis, int degree, int points, const double *tau, double *matrix);

#endif
