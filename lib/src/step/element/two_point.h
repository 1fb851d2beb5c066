/* One element of the discrete action as a function of both its ends, for paths of many elements.
 *
 *     q(tau) = (1-tau) q0 + tau q1 + sum_m beta_m(tau) Z_m,   m = 1..s-1,
 *     beta_m(tau) = integral of P_m(2x-1) from 0 to tau,
 *
 * where the bubbles beta_m vanish at both ends and their derivatives are orthogonal to each other
 * and to 1. With chi_0 = 1 - tau, chi_1 = tau and chi_(m+1) = beta_m, and with X = (q0, q1, Z),
 *
 *     dS/dX_a = sum_j b_j ( h chi_a L_q + chi_a' L_v )_j,
 *     so that dS/dq0 = -p0 and dS/dq1 = p1.
 *
 * Source: Marsden and West 2001, sec. 1.3 and 2.2.6. The bubbles are the integrated Legendre
 * functions of the finite element method.
 *
 * Bubbles are stored component by component: Z_m of coordinate i is Z[i*(s-1) + m-1]. */
#ifndef DVI_ACTION_BETWEEN_H
#define DVI_ACTION_BETWEEN_H
#include "step/element/action.h"

/* Prepare what follows; after dvi__action_prepare_jacobian. Once. */
dvi_status dvi__action_prepare_two_point(dvi__action *action);

/* The unknowns Y (action.h) of the path from the element's q0 to q1 [n] with bubbles Z
 * [n*(s-1)]. */
void dvi__action_two_point(const dvi__action *action, const double *q1, const double *Z, double *Y);

/* The derivatives of S: in q0 and q1 [n] and in Z [n*(s-1)], for the Y of dvi__action_two_point.
 * The element must be placed with p0 = 0. */
dvi_status dvi__action_two_point_gradient(dvi__action *action, const double *Y, double *in_q0,
                                          double *in_q1, double *in_Z);

/* The derivatives of any function of q0 and Y in q0, q1 and Z, from those in Y [n*s] and in q0 with
 * Y fixed [n]. */
void dvi__action_two_point_ends(const dvi__action *action, const double *by_Y, const double *by_q0,
                                double *in_q0, double *in_q1, double *in_Z);

/* The second derivatives of S. For each entry e = (i,j) of dvi__action_coupling a block of (s+1)^2
 * numbers: that of X_a of coordinate i and X_b of coordinate j is values[(e*(s+1) + b)*(s+1) +
 * a]. */
dvi_status dvi__action_two_point_hessian(dvi__action *action, const double *Y, double *values);

/* The discrete action S itself; `seen`: the largest |L| at a node of the quadrature. */
dvi_status dvi__action_value(dvi__action *action, const double *Y, double *S, double *seen);

/* The largest |L| at both ends and in the middle, where the quadrature need not look;
 * DVI_NOT_FINITE if it is not finite there. */
dvi_status dvi__action_unseen(dvi__action *action, const double *Y, double *unseen);

#endif
