/* One element of the discontinuous Galerkin discretisation of a Hamiltonian with constraints phi(z)
 * = 0, z = (q,p), and the node at its end.
 *
 *     S = sum over elements of h sum_i b_i (P_i.Q'_i/h - H(Z_i) - Lambda(c_i).phi(Z_i)) + sum over nodes of [q].{p} - h lambda.phi({z})
 *
 * with polynomials q and p of degree d and Lambda of degree k-1 in each element, at d Gauss points.
 * With X_F = (F_p, -F_q), W = dz/dtau in the element, P_l Legendre's polynomials:
 *     W_i = h X_H(Z_i) + h X_phi(Z_i) Lambda(c_i),   Z_i = {z} + h X_phi({z}) lambda/2 + sum_j a_ij W_j,          i = 1..d,
 *     sum_i b_i P_l(c_i) phi(Z_i) = 0,                                                                           l = 0..k-1,
 *     {z'} = {z} + h X_phi({z}) lambda/2 + sum_j b_j W_j + h X_phi({z'}) lambda'/2,   phi({z'}) = 0.
 * The state is ({z}, lambda), the jump [z] = h X_phi({z}) lambda.
 *
 * Source: Kraus, Yoshimura and Peng (talk), with the halves of the multipliers (k = 0, d = 1);
 * degrees and moments are ours (docs/methods/dg_phase.md).
 *
 * Unknowns and rows are stored component by component of z, then constraint by constraint:
 * x[c*(d+1) + i] is component c of W_i, with i = d that of {z'} - {z}; behind them, 1+k numbers for
 * each constraint, h lambda' and the Legendre coefficients of h Lambda. */
#ifndef DVI_ACTION_PHASE_H
#define DVI_ACTION_PHASE_H
#include "system/evaluate/evaluator.h"

enum { DVI__PHASE_DEGREE_MOST = 8 };

typedef struct dvi__phase dvi__phase;

/* degree [1,8]; moments k [0,degree], even. For a system with a Hamiltonian. */
dvi_status dvi__phase_create(const dvi_system *system, int degree, int moments,
                             dvi_counters *counters, dvi__phase **phase);
void dvi__phase_destroy(dvi__phase **phase);

const dvi__pattern *dvi__phase_pattern(const dvi__phase *phase);
dvi__evaluator *dvi__phase_evaluator(const dvi__phase *phase);

/* Put the step at a state, with the multiplier lambda [m] of its node. The arrays q and p [n] must
 * stay as they are. */
dvi_status dvi__phase_place(dvi__phase *phase, double t0, double h, const double *q,
                            const double *p, const double *multiplier);

dvi_status dvi__phase_residual(dvi__phase *phase, const double *x, double *R);
dvi_status dvi__phase_jacobian(dvi__phase *phase, const double *x, double *values);
dvi_status dvi__phase_scale(dvi__phase *phase, double *scale);

/* Of a solution: the increments dq and dp [n], the end's multiplier [m]; the jump there [2n], of q
 * and of p, and what the multiplier's change in the step makes of it, h X_phi (lambda' - lambda)
 * [2n]. */
void dvi__phase_end(const dvi__phase *phase, const double *x, double *dq, double *dp,
                    double *multiplier);
dvi_status dvi__phase_jump(dvi__phase *phase, const double *x, double *jump, double *change);

/* After dvi__phase_jump: the sizes, of q and of p, to which roundings of the step are relative: of
 * the state and the kicks of all multipliers, and of what H's Hessian makes of the other one's. */
void dvi__phase_sizes(const dvi__phase *phase, const double *x, double size[2]);

/* x for a start with q' = v [n]; x by continuing the last step's, ratio = h_next / h_last. */
void dvi__phase_straight(const dvi__phase *phase, const double *v, double *x);
void dvi__phase_continue(const dvi__phase *phase, double ratio, const double *last, double *x);

#endif
