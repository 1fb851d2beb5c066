/* One element of the discrete action as a function of both its ends, for paths of many elements.
 *
 *     q(tau) = (1-tau) q0 + tau q1 + sum_m beta_m(tau) Z_m,   m = 1..s-1,
 *     beta_m(tau) = integral of P_m(2x-1) from 0 to tau,
 *
 * where the bubbles beta_m vanish at both ends and their derivatives are orthogonal to each other
 * and to 1. With chi_0 = 1 - tau, chi_1 = tau and chi_(m+1) = beta_m, and with X = (q0, q1, Z),
 *
 *     dS/dX_a = sum_j b_j ( h chi_a L_q + chi_a' L_v )_j,     dS/dq0 = -p0,   dS/dq1 = p1.
 *
 * Source: Marsden and West 2001, sec. 1.3 and 2.2.6. The bubbles are the integrated Legendre
 * functions of the finite element method.
 *
 * Bubbles are stored component by component. Z_m of coordinate i is Z[i*(s-1) + m-1]. */
#ifndef DVI_STEP_ELEMENT_TWO_POINT_H
#define DVI_STEP_ELEMENT_TWO_POINT_H
#include "step/element/action.h"

/* Prepare the functions below, once, after dvi__action_prepare_jacobian. */
dvi_status dvi__action_prepare_two_point(dvi__action *action);

/* Give the unknowns Y (action.h) of the path from the element's q0 to q1 [n] with bubbles Z
 * [n*(s-1)]. */
void dvi__action_two_point(const dvi__action *action, const double *q1, const double *Z, double *Y);

/* Evaluate the derivatives of S by q0 and q1 [n] and by Z [n*(s-1)], for the Y of
 * dvi__action_two_point. The element must be placed with p0 = 0. */
dvi_status dvi__action_two_point_gradient(dvi__action *action, const double *Y, double *in_q0,
                                          double *in_q1, double *in_Z);

/* Give the derivatives of any function of q0 and Y by q0, q1 and Z, from those by Y [n*s] and by q0
 * with Y fixed [n]. */
void dvi__action_two_point_ends(const dvi__action *action, const double *by_Y, const double *by_q0,
                                double *in_q0, double *in_q1, double *in_Z);

/* Give the rows of any function whose derivatives by q and v at the nodes are f and g [n*r], in
 * batches,
 *
 *     rows[a*n + i] = sum_j b_j ( h chi_a f_i + chi_a' g_i )_j,     a = 0..s.
 *
 * With f = L_q and g = L_v they are dS/dX_a. */
void dvi__action_two_point_rows(const dvi__action *action, const double *f, const double *g,
                                double *rows);

/* The nodes of the quadrature on the path Y, valid until the next call. Q and V are batches. */
typedef struct dvi__path_points {
  int count;
  const double *t, *Q, *V, *weight;
} dvi__path_points;
dvi__path_points dvi__action_two_point_points(const dvi__action *action, const double *Y);

/* Evaluate the second derivatives of S, or with forces the derivatives of the rows with L_q + F in
 * the place of L_q. Each entry e = (i,j) of dvi__action_coupling has a block of
 * (s+1)^2 numbers. That of X_a of coordinate i and X_b of coordinate j is
 * values[(e*(s+1) + b)*(s+1) + a]. */
dvi_status dvi__action_two_point_hessian(dvi__action *action, const double *Y, double *values);

/* Evaluate the discrete action S. `seen` is the largest |L| at a node of the quadrature. */
dvi_status dvi__action_value(dvi__action *action, const double *Y, double *S, double *seen);

/* Give the largest |L| at both ends and in the middle, where the quadrature may have no node.
 * DVI_NOT_FINITE if it is not finite there. */
dvi_status dvi__action_unseen(dvi__action *action, const double *Y, double *unseen);

#endif
