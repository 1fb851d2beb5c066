/* One element of the discontinuous Galerkin discretisation of a Hamiltonian with constraints
 * phi(z) = 0, z = (q,p), with the node at its end.
 *
 *     S = sum over elements of h sum_i b_i (P_i.Q'_i/h - H(Z_i) - Lambda(c_i).phi(Z_i))
 *         + sum over nodes of [q].{p} - h lambda.phi({z})
 *
 * In each element q and p have degree d and Lambda has degree k-1, at d Gauss points. Let
 * X_F = (F_p, -F_q), let W = dz/dtau in the element, and let P_l be Legendre's polynomials.
 *     W_i = h X_H(Z_i) + h X_phi(Z_i) Lambda(c_i),
 *     Z_i = {z} + h X_phi({z}) lambda/2 + sum_j a_ij W_j,          i = 1..d,
 *     sum_i b_i P_l(c_i) phi(Z_i) = 0,                             l = 0..k-1,
 *     {z'} = {z} + h X_phi({z}) lambda/2 + sum_j b_j W_j + h X_phi({z'}) lambda'/2,
 *     phi({z'}) = 0.
 * The state is ({z}, lambda), and the jump is [z] = h X_phi({z}) lambda.
 *
 * Source: Kraus, Yoshimura and Peng (talk), with the halves of the multipliers (k = 0, d = 1).
 * Other degrees, and the moments, are ours (docs/methods/dg_phase.md).
 *
 * Unknowns and rows are stored component by component of z, then constraint by constraint.
 * x[c*(d+1) + i] is component c of W_i, or for i = d that of {z'} - {z}. Behind them stand 1+k
 * numbers for each constraint, h lambda' and the Legendre coefficients of h Lambda. */
#ifndef DVI_STEP_HAMILTONIAN_PHASE_ELEMENT_H
#define DVI_STEP_HAMILTONIAN_PHASE_ELEMENT_H
#include "system/evaluate/evaluator.h"

enum { DVI__PHASE_DEGREE_MOST = 8 };

typedef struct dvi__phase_element dvi__phase_element;

/* The degree is in [1,8]. The moments k are even and in [0,degree]. The system must have a
 * constrained Hamiltonian. */
dvi_status dvi__phase_element_create(const dvi_system *system, int degree, int moments,
                                     dvi_counters *counters, dvi__phase_element **phase);
void dvi__phase_element_destroy(dvi__phase_element **phase);

const dvi__pattern *dvi__phase_element_pattern(const dvi__phase_element *phase);
dvi__evaluator *dvi__phase_element_evaluator(const dvi__phase_element *phase);

/* Put the step at a state, with the multiplier lambda [m] of its node. The caller keeps the arrays
 * q and p [n] unchanged. */
dvi_status dvi__phase_element_place(dvi__phase_element *phase, double t0, double h, const double *q,
                                    const double *p, const double *multiplier);

dvi_status dvi__phase_element_residual(dvi__phase_element *phase, const double *x, double *R);
dvi_status dvi__phase_element_jacobian(dvi__phase_element *phase, const double *x, double *values);
dvi_status dvi__phase_element_scale(dvi__phase_element *phase, double *scale);

/* Simplified Newton's method in variables of its own (phase_iteration.c), for small systems. Begin
 * at x, iterate, and write x at the end. An iteration gives the largest correction and the largest
 * of the unknowns of z. */
int dvi__phase_element_has_iteration(const dvi__phase_element *phase);
void dvi__phase_element_begin(dvi__phase_element *phase, const double *x);
dvi_status dvi__phase_element_iterate(dvi__phase_element *phase, double *change, double *whole);
void dvi__phase_element_finish(const dvi__phase_element *phase, double *x);

/* Write the end of a solution. dvi__phase_element_end gives the increments dq and dp [n] and the
 * multiplier [m]. dvi__phase_element_jump gives the jump [2n] of q and of p, and its change by the
 * multiplier in the step, h X_phi (lambda' - lambda) [2n]. */
void dvi__phase_element_end(const dvi__phase_element *phase, const double *x, double *dq,
                            double *dp, double *multiplier);
dvi_status dvi__phase_element_jump(dvi__phase_element *phase, const double *x, double *jump,
                                   double *change);

/* Write the sizes of q and of p to which roundings of the step are relative. They include the
 * state, the kicks of all multipliers, and the product of H's Hessian with the other size. To be
 * called after dvi__phase_element_jump. */
void dvi__phase_element_sizes(const dvi__phase_element *phase, const double *x, double size[2]);

/* Write x for a start with q' = v [n]. dvi__phase_element_continue continues the x of the last
 * step, with ratio = h_next / h_last. */
void dvi__phase_element_straight(const dvi__phase_element *phase, const double *v, double *x);
void dvi__phase_element_continue(dvi__phase_element *phase, double ratio, const double *last,
                                 double *x);

#endif
