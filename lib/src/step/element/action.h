/* One element (time step) of the discrete action, in reduced trial functions.
 *
 *     q(tau) = q0 + sum_k psi_k(tau) Y_k,  psi_k(0) = 0,   k = 1..s
 *     S = h sum_j b_j L(t0 + c_j h, q(c_j), q'(c_j)/h)
 *
 * Varying Y_k with the momenta p0, p1 at the ends gives sum_j b_j ( h psi_k L_q + psi_k' L_v )_j =
 * psi_k(1) p1, varying q0 gives p1 = p0 + h sum_j b_j L_q_j. With p1 eliminated the s n equations
 * for the s n unknowns are
 *
 *     R_k = sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j - psi_k(1) p0 = 0.
 *
 * Source: Marsden and West 2001, sec. 2.2.6; Leok 2004, sec. 5.2. The elimination is ours: it keeps
 * the unknowns free of the constraint at q0 in every basis, and leaves increments, which round
 * better than positions.
 *
 * Unknowns and rows are stored component by component: Y_k of coordinate i is Y[i*s + k]. */
#ifndef DVI_ACTION_ACTION_H
#define DVI_ACTION_ACTION_H
#include <dvi/basis.h>
#include <dvi/quadrature.h>

#include "step/element/row_term.h"
#include "system/chart/centring.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__action dvi__action;

typedef struct dvi__action_space {
  dvi_basis basis;
  int degree;
  dvi_rule rule;
  int nodes;
} dvi__action_space;

/* The space's numbers must be valid (nodes >= degree). */
dvi_status dvi__action_create(const dvi_system *system, const dvi__action_space *space,
                              dvi_counters *counters, dvi__action **action);
void dvi__action_destroy(dvi__action **action);

/* Prepare the Jacobian's pattern and memory, if they are not there; without them residuals and
 * chords work, Jacobians do not. After a failure it may be called again. */
dvi_status dvi__action_prepare_jacobian(dvi__action *action);

/* Add a term to its rows; the struct is copied, and what it points to must stay. An action with
 * terms takes no fixed-point iteration over forces (sweep.h), and has no energies. */
dvi_status dvi__action_add_term(dvi__action *action, const dvi__row_term *term);
int dvi__action_has_terms(const dvi__action *action);

/* Let its paths be those of a chart centred at their start; the struct is copied. Once. */
dvi_status dvi__action_centre(dvi__action *action, const dvi__centring *centring);

/* What it was made with. */
dvi__action_space dvi__action_space_of(const dvi__action *action);

/* Number of unknowns, those of row terms included; of quadrature nodes; the Jacobian's pattern
 * (after prepare). */
int dvi__action_unknowns(const dvi__action *action);
int dvi__action_nodes(const dvi__action *action);
const dvi__pattern *dvi__action_pattern(const dvi__action *action);
dvi__evaluator *dvi__action_evaluator(const dvi__action *action);

/* Put the element at (t0, q0, p0) with step h; the arrays must stay as they are until the next
 * call. */
void dvi__action_place(dvi__action *action, double t0, double h, const double *q0,
                       const double *p0);

/* R(Y). Keeps the forces at the nodes for dvi__action_ends. */
dvi_status dvi__action_residual(dvi__action *action, const double *Y, double *R);

/* Sums of the magnitudes of what was summed in each row of the last residual. */
void dvi__action_magnitudes(const dvi__action *action, double *magnitude);

/* The largest turn from the coefficients of one path in a chart to those of another, in radians,
 * and that to a point [n] of it; of actions with charts. */
double dvi__action_turn(const dvi__action *action, const double *from, const double *Y);
double dvi__action_turned(const dvi__action *action, const double *xi);

/* Whether the sign of its Jacobian's determinant tells of folds (system/chart/centring.h). */
int dvi__action_signs(const dvi__action *action);

/* Prepare the joint pattern of the Hessians and memory for them, if they are not there. */
dvi_status dvi__action_prepare_hessians(dvi__action *action);

/* Which coordinates L couples: the union of the patterns of L_qq, L_qv, L_vq and L_vv, [n x n]. */
const dvi__pattern *dvi__action_coupling(const dvi__action *action);

/* The Hessians at the nodes of the path Y, for what follows. */
dvi_status dvi__action_hessians(dvi__action *action, const double *Y);

/* y [n*s] = dR/dY x by these Hessians, without the Jacobian; after dvi__action_prepare_product,
 * which prepares Hessians, too. Not with a centring. */
dvi_status dvi__action_prepare_product(dvi__action *action);
void dvi__action_times_jacobian(dvi__action *action, const double *x, double *y);

/* dR/dY in the order of the pattern. */
dvi_status dvi__action_jacobian(dvi__action *action, const double *Y, double *values);

/* The kinetic part of the Jacobian alone, (K (x) L_vv)/h, frozen near the middle of the path Y:
 * what fixed point iteration inverts. */
dvi_status dvi__action_prepare_chord(dvi__action *action, const double *Y);

/* Overwrite R by the correction (K (x) L_vv/h)^{-1} R. */
void dvi__action_chord(dvi__action *action, double *R);

/* Increments of q and p over the step, [n] each: dq + dq_low = sum_k psi_k(1) Y_k and dp = h sum_j
 * b_j L_q_j with the forces of the last residual. dq_low is what dq alone would lack: rounded in
 * each step by the same velocity, it adds up (energy drift of 5e-20 a step of kepler). */
void dvi__action_ends(const dvi__action *action, const double *Y, double *dq, double *dq_low,
                      double *dp);

/* dp [n] += what it changes by, to first order, where the unknowns change by dY: with the Hessians
 * of the last Jacobian, and the batches as work. */
void dvi__action_move_ends(dvi__action *action, const double *dY, double *dp);

/* How much time passes over the element with the path Y: h; of a time-transformed system h sum_j
 * b_j g(Q_j). */
dvi_status dvi__action_duration(dvi__action *action, const double *Y, double *duration);

/* The path at tau relative to q0, and its velocity for a step h; either may be NULL. */
void dvi__action_path(const dvi__action *action, const double *Y, double h, double tau,
                      double *offset, double *v);

/* Y of the straight path along v [n]. */
void dvi__action_straight(const dvi__action *action, const double *v, double *Y);

/* Y of the next step from the last one's, by continuing its polynomial; ratio = h_next / h_last.
 * May not alias. */
void dvi__action_continue(dvi__action *action, double ratio, const double *last, double *Y);

/* The s fitting points in (0,1], and Y from offsets q - q0 at them, stored as [i*s + point]; may
 * alias. */
const double *dvi__action_fit_points(const dvi__action *action);
void dvi__action_fit(const dvi__action *action, const double *offset, double *Y);

/* Typical size of each row per unit of an unknown, for scaling norms: scale[i*s+k] = |L_vv|_ii / h
 * > 0. After prepare_chord. 0: it is still what it was at the last call, and nothing is written. */
int dvi__action_row_scale(dvi__action *action, double *scale);

/* The same for a system with a one-form: of the gradients of alpha at q0. */
dvi_status dvi__action_scale(dvi__action *action, double *scale);

#endif
