/* The step with the sum along a shot (step/onestep/shot.h) as discrete Lagrangian or Hamiltonian.
 *
 * Type 1 is the shot from q0 to q1.
 *     Ld(q0,q1) = S(q0,pi0)  with the pi0 for which the shot ends at q1 = Q(q0,pi0),
 *     p1 = D2 Ld = S_pi Q_pi^-1,     p0 = -D1 Ld = -S_q + p1.Q_q
 * With G = S - p1.Q these are G_pi = 0 and G_q = -p0, which the costates give without an inverse.
 * Near a solution S_z = Pi.Q_z - (pi0,0) to the order of the step, where Pi(q0,pi0) is the momentum
 * at the end of the shot. Newton's method uses this in the Jacobian, with G_pi = Q_pi^T (Pi - p1)
 * and G_q + pi0 = Q_q^T (Pi - p1). Type 2 is the shot from q0 to the momentum p1 = Pi(q0,pi0), and
 * type 3 that from (k0,p0) to q1 = Q(k0,p0).
 *     H+(q0,p1) = p1.Q - S,   q1 = D2 H+ = Q + mu,
 *                 G = S - p1.Q + mu.Pi with p1 held,   G_pi = 0,         G_q = -p0
 *     H-(p0,q1) = -p0.k0 - S, q0 = -D1 H- = k0 + G_p,
 *                 G = S - p1.Q,                        G_p + k0 = q0,    G_k = -p0
 * Types 2 and 3 need a regular Pi_pi, or Q_q, which are near the identity. Type 1 needs a regular
 * Q_pi, which has the size of h H_pp.
 *
 * Source: Marsden and West 2001, sec. 1.6; Leok and Shingel 2012, sec. 3; Leok and Zhang 2011, sec.
 * 2.
 *
 * The unknowns are in units of q. Type 1 has pi0, then p1. Type 2 has pi0, then mu. Type 3 has
 * k0 - q0, then p1. The rows are G_pi, then G_q + p0. */
#ifndef DVI_STEP_ONESTEP_SHOT_STEP_H
#define DVI_STEP_ONESTEP_SHOT_STEP_H
#include "step/onestep/shot.h"

typedef struct dvi__shot_step dvi__shot_step;

/* Type 1 needs a system with a Lagrangian. */
dvi_status dvi__shot_step_create(const dvi_system *system, int type, const dvi__runge_kutta *method,
                                 const dvi__course *course, dvi_counters *counters,
                                 dvi__shot_step **step);
void dvi__shot_step_destroy(dvi__shot_step **step);

const dvi__pattern *dvi__shot_step_pattern(const dvi__shot_step *step);

/* Put the step at (t0, q0, p0), and x at the shot from the inverse Legendre map. v [n] is a guess,
 * and becomes the velocity there. The caller keeps the arrays unchanged. The units are those of a
 * step of length `whole`. */
dvi_status dvi__shot_step_place(dvi__shot_step *step, double t0, double h, double whole,
                                const double *q0, const double *p0, double *v, double *x);

dvi_status dvi__shot_step_residual(void *step, const double *x, double *R);
dvi_status dvi__shot_step_jacobian(void *step, const double *x, double *values);

/* Compute the increments of q and p, [n] each, at x, from the point of the last residual to first
 * order by the last Jacobian. */
void dvi__shot_step_ends(const dvi__shot_step *step, const double *x, double *dq, double *dp);

/* Compute the time that passes in the step with the solution x of a time-transformed system. To be
 * called after dvi__shot_step_ends. */
dvi_status dvi__shot_step_duration(dvi__shot_step *step, const double *x, double *duration);

#endif
