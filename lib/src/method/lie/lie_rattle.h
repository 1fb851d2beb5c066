/* The forces of holonomic constraints phi(t,q) = 0 in a step of Verlet's method on a configuration
 * space with factors.
 *
 * With D = d phi/dq along the motions of the factors (turns in the body's frame, shifts, tangents),
 * the multipliers lambda at the start and mu at the end of a step solve
 *
 *     p_half = p0 - h/2 (dV(q0) + D(q0)^T lambda),   drift to q1 (step/lie/lie_drift.h),
 *     phi(t1,q1) = 0,
 *     p1 = p_half - h/2 dV(q1) - D(q1)^T mu,         D(q1) v(q1,p1) + phi_t(t1,q1) = 0,
 *
 * where the drift carries p_half along. Simplified Newton's method for lambda keeps the matrix
 * D M^-1 D^T of the start, which is that of mu of the step before. Source: Andersen 1983 (RATTLE),
 * with the drift of Moser and Veselov 1991; Hairer, Lubich and Wanner 2006, sec. VII.1.4, VII.5. */
#ifndef DVI_METHOD_LIE_LIE_RATTLE_H
#define DVI_METHOD_LIE_LIE_RATTLE_H
#include "step/lie/lie_drift.h"

typedef struct dvi__lie_rattle dvi__lie_rattle;

dvi_status dvi__lie_rattle_create(const dvi_system *system, dvi__lie_drift *drift,
                                  dvi_counters *counters, dvi__lie_rattle **rattle);
void dvi__lie_rattle_destroy(dvi__lie_rattle **rattle);

/* Take the drift of a state at (t,q), after its first kick, so that it ends on the constraints.
 * lambda [rows] is a guess, and becomes the solution. displacement is that of dvi__lie_drift_drift.
 * DVI_NOT_CONVERGED, DVI_SINGULAR, DVI_NOT_FINITE, those of the drift, and of callbacks. */
dvi_status dvi__lie_rattle_drift(dvi__lie_rattle *rattle, double t, double h,
                                 const dvi__phase *state, double *lambda, double *displacement);

/* Subtract D^T mu from the momentum of a state at (t,q), after its last kick. */
dvi_status dvi__lie_rattle_end(dvi__lie_rattle *rattle, double t, const dvi__phase *state);

#endif
