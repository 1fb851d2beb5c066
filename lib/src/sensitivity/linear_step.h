/* The derivatives of one element's map (q0, p0, theta) -> (q1, p1).
 *
 * In two-point form (step/element/two_point.h), with X = (q0, q1, Z) and rho_a the derivative of
 * the element's action by X_a, forces included, the map is
 *
 *     rho_0 + p0 = 0,     rho_Z = 0,     p1 = rho_1.
 *
 * With K = d rho/dX, U = (q1, Z), R = (0, Z) and B = K_RU the tangent of the map is
 *
 *     B dU = -K_R0 dq0 - e_0 dp0 - rho_R,theta dtheta,     dp1 = K_1X dX + rho_1,theta dtheta,
 *
 * and its transpose, with nu_1 = dJ/dp1 and costs c.dX of the element itself, is
 *
 *     B^T nu_R = -(dJ/dq1 e_1 + c_U + K_1U^T nu_1),
 *     dJ/dq0 = c_0 + K_X0^T nu,     dJ/dp0 = nu_0,     dJ/dtheta += nu.rho_theta.
 *
 * nu are the multipliers of the rows in optimal control. Source: Marsden and West 2001, sec. 2.2.6,
 * for the rows; Ober-Bloebaum, Junge and Marsden 2011, sec. 4, for the adjoint. */
#ifndef DVI_SENSITIVITY_LINEAR_STEP_H
#define DVI_SENSITIVITY_LINEAR_STEP_H
#include <dvi/sensitivity.h>

#include "step/element/two_point.h"

typedef struct dvi__linear_step dvi__linear_step;

/* The path of a step: Y [n*degree] (step/element/action.h) from q [n] at t. */
typedef struct dvi__step_path {
  double t, h;
  const double *q, *Y;
} dvi__step_path;

/* Create for a space. The dependence is copied, and is NULL without parameters. */
dvi_status dvi__linear_step_create(const dvi_system *system, const dvi__action_space *space,
                                   const dvi_dependence *dependence, dvi_counters *counters,
                                   dvi__linear_step **step);
void dvi__linear_step_destroy(dvi__linear_step **step);

/* Return the element, which dvi__linear_step_place puts on a path. */
dvi__action *dvi__linear_step_action(const dvi__linear_step *step);
void dvi__linear_step_place(dvi__linear_step *step, const dvi__step_path *path);

/* Evaluate the derivatives on a path, and factor B or with `transposed` its transpose.
 * DVI_SINGULAR. */
dvi_status dvi__linear_step_at(dvi__linear_step *step, const dvi__step_path *path, int transposed);

/* Replace a change (dq, dp) [n] of the start, with a unit change of parameter k unless k < 0, by
 * that of the end. */
dvi_status dvi__linear_step_push(dvi__linear_step *step, int k, double *dq, double *dp);

/* Replace the derivatives (by_q, by_p) [n] by the end by those by the start, and add to by_theta
 * [count]. cost [(degree+1)*n] is c above, or NULL. */
dvi_status dvi__linear_step_pull(dvi__linear_step *step, const double *cost, double *by_q,
                                 double *by_p, double *by_theta);

#endif
