/* One element of the discontinuous Galerkin discretisation of a degenerate Lagrangian alpha(q).v -
 * H(q), and the node at its end.
 *
 * The trajectory is a polynomial of degree d in each element and jumps between two. The jump [q] =
 * q+ - q- costs the integral of alpha along the straight path from q- to q+, by points s_g in
 * [-1/2,1/2] of weight w_g (the numerical flux), and [q].c[q]/2 (the stiffness, c diagonal):
 *     S = sum over elements of h sum_i b_i L(Q_i, V_i) + sum over nodes of N(q-, q+),
 *     N = sum_g w_g [q].alpha(y_g) + [q].c[q]/2,    y_g = q- + (1/2 + s_g) [q].
 * Stationary against the S = d+1 coefficients X_j of an element, with the traces q+ = X(0) and q'-
 * = X(1):
 *     h sum_i b_i (phi_j(c_i) L_q + phi_j'(c_i) L_v / h) + phi_j(0) dN/dq+ (q-, q+) + phi_j(1) dN/dq- (q'-, q'+) = 0,    j = 0..S-1.
 * The state before the step is (q-, q+): q+ is X_0 in the nodal basis on Lobatto's points, so that
 * X_1..X_{S-1} and the jump [q'] at the end are unknown, in as many equations.
 *
 * What stands for q at a node is q* = {q} - Omega^-1 C [q], {q} = (q- + q+)/2, C the symmetric part
 * of what the node's terms have for [q]: where alpha is linear Omega q* changes by h sum_i b_i
 * H_q(Q_i), while {q} of a stiff node oscillates with the jump.
 *
 * Source: Kraus, Yoshimura and Peng, talk (elements, jump, average flux; the signs of the flux
 * corrected); the stiffness and q* are ours (docs/methods/dg.md).
 *
 * Unknowns and rows are stored component by component: x[i*S + k-1] is component i of X_k - q*,
 * x[i*S + S-1] that of the jump at the end. */
#ifndef DVI_ACTION_DISCONTINUOUS_H
#define DVI_ACTION_DISCONTINUOUS_H
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
  int degree, nodes; /* of the polynomials, of Gauss's rule in an element */
  dvi__flux flux;
  int points;              /* of Gauss's rule on a path; 1 for the other fluxes */
  int stiffness_count;     /* 0: no stiffness; 1: one for all coordinates; n */
  const double *stiffness; /* [stiffness_count] > 0, the diagonal of c */
} dvi__dg_space;

/* For a system with a one-form. */
dvi_status dvi__discontinuous_create(const dvi_system *system, const dvi__dg_space *space,
                                     dvi_counters *counters, dvi__discontinuous **element);
void dvi__discontinuous_destroy(dvi__discontinuous **element);

const dvi__pattern *dvi__discontinuous_pattern(const dvi__discontinuous *element);
dvi__evaluator *dvi__discontinuous_evaluator(const dvi__discontinuous *element);

/* A state between two elements: q* [n], p = alpha(q*) [n], the jump [n], {q} - q* [n]. */
typedef struct dvi__dg_node {
  const double *q, *p, *jump, *offset;
} dvi__dg_node;

/* Put the element of length h behind a node at t0. The arrays must stay as they are. */
dvi_status dvi__discontinuous_place(dvi__discontinuous *element, double t0, double h,
                                    const dvi__dg_node *node);

dvi_status dvi__discontinuous_residual(dvi__discontinuous *element, const double *x, double *R);
dvi_status dvi__discontinuous_jacobian(dvi__discontinuous *element, const double *x,
                                       double *values);

/* Size of the rows per unit of an unknown: of the gradients of alpha at q*, and of the
 * stiffness. */
dvi_status dvi__discontinuous_scale(dvi__discontinuous *element, double *scale);

/* The node at the end of the element x: the change of q* [n], the jump [n], {q} - q* [n]; and the
 * coefficients X_k - q'* [n*S], component by component. */
dvi_status dvi__discontinuous_end(dvi__discontinuous *element, const double *x, double *dq,
                                  double *jump, double *offset, double *coefficients);

/* A start gives q* alone. On the smooth branch the jump changes little from node to node, while the
 * parasite's part of it is multiplied by
 *     M = (-1)^S (Omega/2 - C)^-1 (Omega/2 + C)
 * in each element. From the first element x: the jump and {q} - q* at its start for which the jump
 * at its end would be the same, up to O(h) of their change. Not for even S without a stiffness,
 * where M is 1. */
int dvi__discontinuous_can_settle(const dvi__discontinuous *element);
dvi_status dvi__discontinuous_settle(dvi__discontinuous *element, const double *x, double *jump,
                                     double *offset);

/* x for the velocity v [n]; x by continuing the last element's coefficients, relative to its end;
 * ratio = h_next / h_last. */
void dvi__discontinuous_straight(const dvi__discontinuous *element, const double *v, double *x);
void dvi__discontinuous_continue(const dvi__discontinuous *element, double ratio,
                                 const double *coefficients, double *x);

#endif
