/* One step of a variational partitioned Runge-Kutta method, for a degenerate Lagrangian
 * alpha(q).v - H(q) with a projection onto p = alpha(q).
 *
 * The stages i = 1..s have increments W_i = h V_i and impulses h F_i = h L_q(Q_i, V_i).
 *     Q_i = q0 + k0 + sum_j a_ij W_j,     alpha(Q_i) = p0 + K(k0) + h sum_j abar_ij F_j,
 *     q1  = q0 + k0 + sum_j b_j W_j + k1,
 *     p1  = p0 + K(k0) + h sum_j b_j F_j + K(k1) = alpha(q1),
 *     b_i abar_ij + b_j a_ji = b_i b_j.
 * The kicks k0 and k1 are multiples of the multiplier lambda, along Omega^-1 grad phi of the
 * constraint phi = p - alpha(q). They move q by k and p by K(k) = grad alpha.k, taken at q0 and q1,
 * or at their mean. Without a projection any Lagrangian is possible, with L_v(Q_i, V_i) for
 * alpha(Q_i).
 *
 * Source: Kraus 2017, arXiv:1708.07356; Marsden and West 2001, sec. 2.6 (the tableaux). The
 * increments, which round better than velocities, are ours.
 *
 * Unknowns and rows are stored component by component. Number k of component i is x[i*m + k], with
 * m = s without a multiplier, and m = s + 1 with the multiplier as the last. */
#ifndef DVI_STEP_DEGENERATE_PARTITIONED_H
#define DVI_STEP_DEGENERATE_PARTITIONED_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__partitioned dvi__partitioned;

/* IIIB_A is Lobatto IIIB for q and IIIA for p. */
typedef enum dvi__tableau { DVI__GAUSS, DVI__LOBATTO_IIIE, DVI__LOBATTO_IIIB_A } dvi__tableau;

typedef enum dvi__projection {
  DVI__SYMMETRIC,
  DVI__MIDPOINT_PROJECTION,
  DVI__SYMPLECTIC_PROJECTION,
  DVI__POST_PROJECTION,
  DVI__NO_PROJECTION
} dvi__projection;

/* The number of stages must suit the tableau. A projection needs a system with a one-form. */
dvi_status dvi__partitioned_create(const dvi_system *system, dvi__tableau tableau, int stages,
                                   dvi__projection projection, dvi_counters *counters,
                                   dvi__partitioned **partitioned);
void dvi__partitioned_destroy(dvi__partitioned **partitioned);

const dvi__pattern *dvi__partitioned_pattern(const dvi__partitioned *partitioned);
dvi__evaluator *dvi__partitioned_evaluator(const dvi__partitioned *partitioned);

/* Put the step at (t0, q0, p0). `carried` [n] is the multiplier of the last step. The caller keeps
 * the arrays unchanged. */
void dvi__partitioned_place(dvi__partitioned *partitioned, double t0, double h, const double *q0,
                            const double *p0, const double *carried);

dvi_status dvi__partitioned_residual(dvi__partitioned *partitioned, const double *x, double *R);
dvi_status dvi__partitioned_jacobian(dvi__partitioned *partitioned, const double *x,
                                     double *values);

/* The same in parts. dvi__partitioned_invert evaluates the second derivatives at x, and tells
 * whether dvi__partitioned_correct can replace r by J^-1 r. If it cannot, dvi__partitioned_fill
 * writes the Jacobian. */
dvi_status dvi__partitioned_invert(dvi__partitioned *partitioned, const double *x, int *inverted);
void dvi__partitioned_correct(dvi__partitioned *partitioned, double *r);
void dvi__partitioned_fill(dvi__partitioned *partitioned, double *values);

/* Write the size of the rows per unit of an unknown, from the gradients of alpha at q0, or
 * L_vv/h. */
dvi_status dvi__partitioned_scale(dvi__partitioned *partitioned, double *scale);

/* Write the increments of q at x, and those of p of the last residual, [n] each. */
void dvi__partitioned_ends(dvi__partitioned *partitioned, const double *x, double *dq, double *dp);

/* Write x for increments along v [n]. dvi__partitioned_continue continues the stages' velocities of
 * the last step, with ratio = h_next / h_last. The multiplier starts from 0. */
void dvi__partitioned_straight(const dvi__partitioned *partitioned, const double *v, double *x);
void dvi__partitioned_continue(dvi__partitioned *partitioned, double ratio, const double *last,
                               double *x);

#endif
