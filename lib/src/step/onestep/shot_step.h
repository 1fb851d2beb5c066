/* The step whose discrete Lagrangian, or Hamiltonian, is the sum along a shot
 * (step/onestep/shot.h).
 *
 * Type 1, the shot from q0 to q1:
 *     Ld(q0,q1) = S(q0,pi0)  with the pi0 for which the shot ends at q1 = Q(q0,pi0),
 *     p1 = D2 Ld = S_pi Q_pi^-1,     p0 = -D1 Ld = -S_q + p1.Q_q
 * With G = S - p1.Q these are G_pi = 0 and G_q = -p0, which the costates give without an inverse.
 * Near a solution, with the end's momentum Pi(q0,pi0) of the shot, S_z = Pi.Q_z - (pi0,0) to the
 * order of the step, and that is what Newton's method goes by: G_pi = Q_pi^T (Pi - p1), G_q + pi0 =
 * Q_q^T (Pi - p1). Type 2, the shot from q0 to the momentum p1 = Pi(q0,pi0), and type 3, from
 * (k0,p0) to q1 = Q(k0,p0):
 *     H+(q0,p1) = p1.Q - S,   q1 = D2 H+ = Q + mu,    G = S - p1.Q + mu.Pi with p1 held,    G_pi = 0,          G_q = -p0
 *     H-(p0,q1) = -p0.k0 - S, q0 = -D1 H- = k0 + G_p, G = S - p1.Q,                         G_p + k0 = q0,     G_k = -p0
 * They need Pi_pi, or Q_q, to be regular, which are near the identity, where type 1 needs Q_pi,
 * which is of the size of h H_pp.
 *
 * Source: Marsden and West 2001, sec. 1.6; Leok and Shingel 2012, sec. 3; Leok and Zhang 2011, sec.
 * 2.
 *
 * Unknowns, in units of q: of type 1 pi0, then p1; of type 2 pi0, then mu; of type 3 k0 - q0, then
 * p1. Rows: G_pi, then G_q + p0. */
#ifndef DVI_ACTION_SHOT_STEP_H
#define DVI_ACTION_SHOT_STEP_H
#include "step/onestep/shot.h"

typedef struct dvi__shot_step dvi__shot_step;

/* Type 1 is for systems that have a Lagrangian. */
dvi_status dvi__shot_step_create(const dvi_system *system, int type, const dvi__runge_kutta *method,
                                 const dvi__course *course, dvi_counters *counters,
                                 dvi__shot_step **step);
void dvi__shot_step_destroy(dvi__shot_step **step);

const dvi__pattern *dvi__shot_step_pattern(const dvi__shot_step *step);

/* Put the step at (t0, q0, p0), and x at the shot from the inverse Legendre map; v [n], a guess,
 * becomes the velocity there. The arrays must stay as they are. Units are those of a step of length
 * `whole`. */
dvi_status dvi__shot_step_place(dvi__shot_step *step, double t0, double h, double whole,
                                const double *q0, const double *p0, double *v, double *x);

dvi_status dvi__shot_step_residual(void *step, const double *x, double *R);
dvi_status dvi__shot_step_jacobian(void *step, const double *x, double *values);

/* Increments of q and p, [n] each, at x: from the point of the last residual to first order, by the
 * last Jacobian. */
void dvi__shot_step_ends(const dvi__shot_step *step, const double *x, double *dq, double *dp);

/* Of a time-transformed system: how much time passes in the step with the solution x. After the
 * ends are taken. */
dvi_status dvi__shot_step_duration(dvi__shot_step *step, const double *x, double *duration);

#endif
