/* One element of the discontinuous Galerkin discretisation of a degenerate Lagrangian
 * alpha(q).v - H(q), with the node at its end.
 *
 * The trajectory is a polynomial of degree d in each element and jumps at the nodes. A jump
 * [q] = q+ - q- contributes two terms. The numerical flux is the integral of alpha along the
 * straight path from q- to q+, by points s_g in [-1/2,1/2] of weight w_g. The stiffness is
 * [q].c[q]/2 with diagonal c.
 *     S = sum over elements of h sum_i b_i L(Q_i, V_i) + sum over nodes of N(q-, q+),
 *     N = sum_g w_g [q].alpha(y_g) + [q].c[q]/2,    y_g = q- + (1/2 + s_g) [q].
 * Stationarity with respect to the S = d+1 coefficients X_j of an element, with the traces
 * q+ = X(0) and q'- = X(1), gives for j = 0..S-1
 *     h sum_i b_i (phi_j(c_i) L_q + phi_j'(c_i) L_v / h)
 *       + phi_j(0) dN/dq+ (q-, q+) + phi_j(1) dN/dq- (q'-, q'+) = 0.
 * The state before the step is (q-, q+). In the nodal basis on Lobatto's points q+ is X_0.
 * Therefore X_1..X_{S-1} and the jump [q'] at the end are unknown, in as many equations.
 *
 * The state q at a node is q* = {q} - Omega^-1 C [q], with {q} = (q- + q+)/2 and C the symmetric
 * part of the coefficients of [q] in the node's terms. Where alpha is linear, Omega q* changes by h
 * sum_i b_i H_q(Q_i), while {q} of a stiff node oscillates with the jump.
 *
 * Source: Kraus, Yoshimura and Peng, talk (elements, jump, average flux; the signs of the flux
 * corrected). The stiffness and q* are ours (docs/methods/dg.md).
 *
 * Unknowns and rows are stored component by component. x[i*S + k-1] is component i of X_k - q*, and
 * x[i*S + S-1] that of the jump at the end. */
#ifndef DVI_STEP_DEGENERATE_DISCONTINUOUS_H
#define DVI_STEP_DEGENERATE_DISCONTINUOUS_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__discontinuous dvi__discontinuous;

typedef enum dvi__flux {
  DVI__AVERAGE_FLUX,
  DVI__LEFT_FLUX,
  DVI__RIGHT_FLUX,
  DVI__PATH_FLUX
} dvi__flux;

enum { DVI__DG_POINTS_MOST = 8 };

typedef struct dvi__dg_space {
  int degree, nodes; /* degree of the polynomials, nodes of Gauss's rule in an element */
  dvi__flux flux;
  int points;              /* points of Gauss's rule on a path; 1 for the other fluxes */
  int stiffness_count;     /* 0 without stiffness, 1 for one stiffness of all coordinates, or n */
  const double *stiffness; /* [stiffness_count] > 0, the diagonal of c */
} dvi__dg_space;

/* Create an element for a system with a one-form. */
dvi_status dvi__discontinuous_create(const dvi_system *system, const dvi__dg_space *space,
                                     dvi_counters *counters, dvi__discontinuous **element);
void dvi__discontinuous_destroy(dvi__discontinuous **element);

const dvi__pattern *dvi__discontinuous_pattern(const dvi__discontinuous *element);
dvi__evaluator *dvi__discontinuous_evaluator(const dvi__discontinuous *element);

/* The state between two elements is q* [n], p = alpha(q*) [n], the jump [n], and {q} - q* [n]. */
typedef struct dvi__dg_node {
  const double *q, *p, *jump, *offset;
} dvi__dg_node;

/* Put the element of length h behind a node at t0. The caller keeps the arrays unchanged. */
dvi_status dvi__discontinuous_place(dvi__discontinuous *element, double t0, double h,
                                    const dvi__dg_node *node);

dvi_status dvi__discontinuous_residual(dvi__discontinuous *element, const double *x, double *R);
dvi_status dvi__discontinuous_jacobian(dvi__discontinuous *element, const double *x,
                                       double *values);

/* The same in parts. dvi__discontinuous_invert evaluates the second derivatives at x, and tells
 * whether dvi__discontinuous_correct can replace r by J^-1 r. If it cannot,
 * dvi__discontinuous_fill writes the Jacobian. */
dvi_status dvi__discontinuous_invert(dvi__discontinuous *element, const double *x, int *inverted);
void dvi__discontinuous_correct(dvi__discontinuous *element, double *r);
void dvi__discontinuous_fill(dvi__discontinuous *element, double *values);

/* Write the size of the rows per unit of an unknown, from the gradients of alpha at q* and the
 * stiffness. */
dvi_status dvi__discontinuous_scale(dvi__discontinuous *element, double *scale);

/* Write the node at the end of the element x. The results are the change of q* [n], the jump [n],
 * {q} - q* [n], and the coefficients X_k - q'* [n*S], component by component. */
dvi_status dvi__discontinuous_end(dvi__discontinuous *element, const double *x, double *dq,
                                  double *jump, double *offset, double *coefficients);

/* Find the smooth branch at a start, which gives q* alone. On the smooth branch the jump changes
 * little from node to node, while the parasite's part of the jump is multiplied by
 *     M = (-1)^S (Omega/2 - C)^-1 (Omega/2 + C)
 * in each element. From the first element x, dvi__discontinuous_settle finds the jump and {q} - q*
 * at the start for which the jump at the end would be the same, up to O(h) of their change. This is
 * not possible for even S without a stiffness, where M is 1. */
int dvi__discontinuous_can_settle(const dvi__discontinuous *element);
dvi_status dvi__discontinuous_settle(dvi__discontinuous *element, const double *x, double *jump,
                                     double *offset);

/* Write x for the velocity v [n]. dvi__discontinuous_continue continues the coefficients of the
 * last element, relative to its end, with ratio = h_next / h_last. */
void dvi__discontinuous_straight(const dvi__discontinuous *element, const double *v, double *x);
void dvi__discontinuous_continue(dvi__discontinuous *element, double ratio,
                                 const double *coefficients, double *x);

#endif
