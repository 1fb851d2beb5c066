/* One element (time step) of the discrete action, in reduced trial functions.
 *
 *     q(tau) = q0 + sum_k psi_k(tau) Y_k,  psi_k(0) = 0,   k = 1..s
 *     S = h sum_j b_j L(t0 + c_j h, q(c_j), q'(c_j)/h)
 *
 * Varying Y_k with the momenta p0, p1 at the ends, and varying q0, gives
 *
 *     sum_j b_j ( h psi_k L_q + psi_k' L_v )_j = psi_k(1) p1,     p1 = p0 + h sum_j b_j L_q_j.
 *
 * With p1 eliminated the s n equations for the s n unknowns are
 *
 *     R_k = sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j - psi_k(1) p0 = 0.
 *
 * With damping, a force -gamma L_v, the action is that of e^{gamma (t - t0 - h/2)} L, whose momenta
 * at the ends are e^{-gamma h/2} p0 and e^{gamma h/2} p1 (method/damping.h). Then e^{gamma (c_j -
 * 1/2) h} b_j takes the place of b_j (Kanai 1948).
 *
 * Source: Marsden and West 2001, sec. 2.2.6; Leok 2004, sec. 5.2. The elimination is our own. It
 * keeps the unknowns free of the constraint at q0 in every basis, and leaves increments, which
 * round better than positions.
 *
 * Unknowns and rows are stored component by component. Y_k of coordinate i is Y[i*s + k]. */
#ifndef DVI_STEP_ELEMENT_ACTION_H
#define DVI_STEP_ELEMENT_ACTION_H
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

/* Create an action. The space's numbers must be valid (nodes >= degree). */
dvi_status dvi__action_create(const dvi_system *system, const dvi__action_space *space,
                              dvi_counters *counters, dvi__action **action);
void dvi__action_destroy(dvi__action **action);

/* Prepare the Jacobian's pattern and memory, unless that is done. Residuals and chords work without
 * them, Jacobians do not. After a failure it may be called again. */
dvi_status dvi__action_prepare_jacobian(dvi__action *action);

/* Add a term to the rows. The struct is copied, and its pointers must stay valid. An action with
 * terms has no fixed-point iteration over forces (fixed_point.h) and no energies. */
dvi_status dvi__action_add_term(dvi__action *action, const dvi__row_term *term);
int dvi__action_has_terms(const dvi__action *action);

/* Let the paths be those of a chart centred at their start. The struct is copied. Call it once. */
dvi_status dvi__action_centre(dvi__action *action, const dvi__centring *centring);

/* Let forces act on paths in charts, if the system has any. Call it after dvi__action_centre. */
dvi_status dvi__action_carry_forces(dvi__action *action);

/* Let the paths fulfil the system's holonomic constraints, if it has any. Call it once. */
dvi_status dvi__action_constrain(dvi__action *action);

/* Say whether rows of the constraints depend on others (dvi__rows_soften). */
void dvi__action_soften(dvi__action *action, int dependent);

/* Return DVI_SINGULAR if the rank of the constraints drops between the ends of the solved step. The
 * sign of the determinant of its Jacobian, 0 if not known, tells most steps that need no look. */
dvi_status dvi__action_stays_regular(dvi__action *action, int sign);

/* Set a guess of multipliers to 0 if rows depend on others, because what has no effect at one state
 * may have some at the next one. */
void dvi__action_begin_multipliers(const dvi__action *action, double *Y);

/* Where a step of degree 1 takes the rows A of nonholonomic constraints, at the middle of its path,
 * or as the mean of both ends. */
typedef enum dvi__velocity_rule { DVI__MIDDLE_ROWS, DVI__MEAN_ROWS } dvi__velocity_rule;

/* Let the velocities fulfil the system's nonholonomic constraints. Call it once. */
dvi_status dvi__action_constrain_velocities(dvi__action *action, dvi__velocity_rule rule);

/* Change dp [n], the change of the momentum over the path Y, so that the velocity at its end
 * fulfils the constraints, if there are any. */
dvi_status dvi__action_constrain_end(dvi__action *action, const double *Y, double *dp);

/* Give the space that the action was made with. */
dvi__action_space dvi__action_space_of(const dvi__action *action);

/* Give the number of unknowns, those of row terms included, the number of quadrature nodes, and the
 * Jacobian's pattern (after prepare). */
int dvi__action_unknowns(const dvi__action *action);
int dvi__action_nodes(const dvi__action *action);
/* Give node j, a part of the step, and its weight b_j. */
void dvi__action_node(const dvi__action *action, int j, double *tau, double *weight);
/* Give its weight in the action, which is another one with damping. */
double dvi__action_weight(const dvi__action *action, int j);
const dvi__pattern *dvi__action_pattern(const dvi__action *action);
dvi__evaluator *dvi__action_evaluator(const dvi__action *action);

/* Put the element at (t0, q0, p0) with step h. The arrays must stay as they are until the next
 * call. */
void dvi__action_place(dvi__action *action, double t0, double h, const double *q0,
                       const double *p0);

/* Evaluate R(Y). Keeps the forces at the nodes for dvi__action_ends. */
dvi_status dvi__action_residual(dvi__action *action, const double *Y, double *R);

/* Sum the magnitudes of the summands of each row of the last residual. */
void dvi__action_magnitudes(const dvi__action *action, double *magnitude);

/* Measure the largest turn from the coefficients of one path in a chart to those of another, in
 * radians, and the turn to a point [n] of the chart. For actions with charts. */
double dvi__action_turn(const dvi__action *action, const double *from, const double *Y);
double dvi__action_turned(const dvi__action *action, const double *xi);

/* Tell whether the sign of the Jacobian's determinant shows folds (system/chart/centring.h). */
int dvi__action_signs(const dvi__action *action);

/* Prepare the joint pattern of the Hessians and memory for them, unless that is done. */
dvi_status dvi__action_prepare_hessians(dvi__action *action);

/* Give the coupling of coordinates by L, the union [n x n] of the patterns of L_qq, L_qv, L_vq and
 * L_vv. */
const dvi__pattern *dvi__action_coupling(const dvi__action *action);

/* Evaluate the Hessians at the nodes of the path Y for the functions below. */
dvi_status dvi__action_hessians(dvi__action *action, const double *Y);

/* Multiply y [n*s] = dR/dY x by these Hessians, without the Jacobian. Call
 * dvi__action_prepare_product before, which prepares Hessians, too. Not with a centring. */
dvi_status dvi__action_prepare_product(dvi__action *action);
void dvi__action_times_jacobian(dvi__action *action, const double *x, double *y);

/* Evaluate dR/dY in the order of the pattern. */
dvi_status dvi__action_jacobian(dvi__action *action, const double *Y, double *values);

/* Prepare the matrix of fixed point iteration. It is the kinetic part of the Jacobian alone, (K (x)
 * L_vv)/h, frozen near the middle of the path Y. */
dvi_status dvi__action_prepare_chord(dvi__action *action, const double *Y);

/* Overwrite R by the correction (K (x) L_vv/h)^{-1} R. */
void dvi__action_chord(dvi__action *action, double *R);

/* Give the increments of q and p over the step, [n] each,
 *
 *     dq + dq_low = sum_k psi_k(1) Y_k,   dp = h sum_j b_j L_q_j,
 *
 * with the forces of the last residual. dq_low is the rounding error of dq. The same velocity
 * rounds dq in each step, and the error would add up (energy drift of 5e-20 a step of kepler). */
void dvi__action_ends(const dvi__action *action, const double *Y, double *dq, double *dq_low,
                      double *dp);

/* Add to dp [n] its change, to first order, by a change dY of the unknowns. Uses the Hessians of
 * the last Jacobian, and the batches as work. */
void dvi__action_move_ends(dvi__action *action, const double *dY, double *dp);

/* Compute what forces supply to the energy and the momenta of symmetries over the element with the
 * path Y, [1 + symmetries]. The gradients of the last residual are lost. */
dvi_status dvi__action_supplies(dvi__action *action, const double *Y, double *supply);

/* Compute what the Lagrangian's dependence on time supplies to the energy, as far as rates are
 * declared (dvi__system_has_rates). The gradients of the last residual are lost. */
dvi_status dvi__action_driving(dvi__action *action, const double *Y, double *work);

/* Give the time that passes over the element with the path Y. It is h, and h sum_j b_j g(Q_j) for a
 * time-transformed system. */
dvi_status dvi__action_duration(dvi__action *action, const double *Y, double *duration);

/* Evaluate the path at tau relative to q0, and its velocity for a step h. Either may be NULL. */
void dvi__action_path(const dvi__action *action, const double *Y, double h, double tau,
                      double *offset, double *v);

/* Set Y to the straight path along v [n]. */
void dvi__action_straight(const dvi__action *action, const double *v, double *Y);

/* Continue the polynomial of the last step to the Y of the next, with ratio = h_next / h_last. The
 * arrays may not alias. */
void dvi__action_continue(dvi__action *action, double ratio, const double *last, double *Y);

/* Give the s fitting points in (0,1], the last of which is 1. Evaluate offsets of the path there,
 * and fit Y to offsets q - q0 at them, stored as [i*s + point].
 * The arrays may alias. */
const double *dvi__action_fit_points(const dvi__action *action);
void dvi__action_at_fit_points(const dvi__action *action, const double *Y, double *offset);
void dvi__action_fit(const dvi__action *action, const double *offset, double *Y);

/* Give the typical size of each row per unit of an unknown, for scaling norms, which is
 * scale[i*s+k] = |L_vv|_ii / h > 0. Call it after prepare_chord. Returns 0 if the scale is still
 * that of the last call, and writes nothing then. */
int dvi__action_row_scale(dvi__action *action, double *scale);

/* Give the row scales of a system with a one-form, from the gradients of alpha at q0. */
dvi_status dvi__action_scale(dvi__action *action, double *scale);

#endif
