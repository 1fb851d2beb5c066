/* The drift of Verlet's method on a configuration space with factors: from q0 and the half-kicked
 * momentum p to q1 and the momentum there,
 *
 *     p = T0^T M (q1 - q0)/h,     p1 = T1^T M (q1 - q0)/h,     T = dy/dxi at q0 and q1, M the mass on the stored coordinates.
 *
 * Cells that no mass couples are taken one by one: lines and, by their chords, directions and
 * angles in closed form, bodies by group/moser_veselov.h, rigid motions after their place is
 * eliminated. The others have a common Newton iteration (coupled_leaps.h).
 *
 * The momentum is turned with the slot, so that its size keeps to the rounding of single steps,
 * without a drift. */
#ifndef DVI_ACTION_LEAPS_H
#define DVI_ACTION_LEAPS_H
#include "step/split/temporal_blocking.h"
#include "group/moser_veselov.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__lie_drift dvi__lie_drift;

/* Of a system with factors, which must outlive it, as must the counters. */
dvi_status dvi__lie_drift_create(const dvi_system *system, dvi__moser_veselov_map by,
                                 dvi_counters *counters, dvi__lie_drift **leaps);
void dvi__lie_drift_destroy(dvi__lie_drift **leaps);

/* p -= h times the force's covector V_q [nq], as momenta see it at q. */
void dvi__lie_drift_kick(const dvi__lie_drift *leaps, double h, const double *V_q,
                         const dvi__phase *state);

/* The drift; leap [nv]: what each slot does in it, for dvi__lie_drift_path. DVI_STEP_TOO_LARGE:
 * there is no q1 on the branch that shorter steps have. */
dvi_status dvi__lie_drift_drift(dvi__lie_drift *leaps, double h, const dvi__phase *state,
                                double *leap);

/* q and v at the part tau of a leap from q0, at constant speed; either may be NULL. */
void dvi__lie_drift_path(const dvi__lie_drift *leaps, const double *q0, const double *leap,
                         double h, double tau, double *q, double *v);

/* How many slots are taken one by one, and how many together. */
void dvi__lie_drift_count(const dvi__lie_drift *leaps, int *alone, int *coupled);

#endif
