/* The drift of Verlet's method on a configuration space with factors leads from q0 and the
 * half-kicked momentum p to q1 and the momentum p1.
 *
 *     p = T0^T M (q1 - q0)/h,     p1 = T1^T M (q1 - q0)/h,
 *     T = dy/dxi at q0 and q1, M the mass on the stored coordinates
 *
 * Slots that no mass couples are treated one by one. Lines, and by their chords directions and
 * angles, have closed forms. Bodies use group/moser_veselov.h, as rigid motions do after the
 * elimination of their place. The other slots share a Newton iteration (coupled_drift.h).
 *
 * The momentum is rotated with the slot, so that its size changes by the rounding of single steps
 * only, without a drift. */
#ifndef DVI_STEP_LIE_LIE_DRIFT_H
#define DVI_STEP_LIE_LIE_DRIFT_H
#include "step/split/temporal_blocking.h"
#include "group/moser_veselov.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__lie_drift dvi__lie_drift;

/* Create the drift of a system with factors. The system and the counters must outlive it. */
dvi_status dvi__lie_drift_create(const dvi_system *system, dvi__moser_veselov_map by,
                                 dvi_counters *counters, dvi__lie_drift **drift);
void dvi__lie_drift_destroy(dvi__lie_drift **drift);

/* Set p -= h times the covector V_q [nq] of the force, as projected for momenta at q. */
void dvi__lie_drift_kick(const dvi__lie_drift *drift, double h, const double *V_q,
                         const dvi__phase *state);

/* Set p += h F for forces F [nv] on the stored velocities, as projected for momenta at q. */
void dvi__lie_drift_push(const dvi__lie_drift *drift, double h, const double *F,
                         const dvi__phase *state);

/* Take the drift. displacement [nv] is the motion of each slot, for dvi__lie_drift_path.
 * DVI_STEP_TOO_LARGE if no q1 lies on the branch of shorter steps. */
dvi_status dvi__lie_drift_drift(dvi__lie_drift *drift, double h, const dvi__phase *state,
                                double *displacement);

/* Evaluate q and v at the part tau of a displacement from q0, at constant speed. Either may be
 * NULL. */
void dvi__lie_drift_path(const dvi__lie_drift *drift, const double *q0, const double *displacement,
                         double h, double tau, double *q, double *v);

/* Count the slots that drift alone and those that drift together. */
void dvi__lie_drift_count(const dvi__lie_drift *drift, int *alone, int *coupled);

#endif
