/* The drift of Verlet's method on a configuration space with factors: from q0 and the half-kicked momentum p to q1 and the momentum there,
 *
 *     p = T0^T M (q1 - q0)/h,     p1 = T1^T M (q1 - q0)/h,     T = dy/dxi at q0 and q1, M the mass on the stored coordinates.
 *
 * Cells that no mass couples are taken one by one: lines and, by their chords, directions and angles in closed form, bodies by group/leap.h, rigid motions after their place is
 * eliminated. The others have a common Newton iteration (coupled_leaps.h).
 *
 * The momentum is turned with the cell, so that its size keeps to the rounding of single steps, without a drift. */
#ifndef DVI_ACTION_LEAPS_H
#define DVI_ACTION_LEAPS_H
#include "step/split/wave.h"
#include "group/leap.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__leaps dvi__leaps;

/* Of a system with factors, which must outlive it, as must the counters. */
dvi_status dvi__leaps_create(const dvi_system *system, dvi__leap_by by, dvi_counters *counters, dvi__leaps **leaps);
void dvi__leaps_destroy(dvi__leaps **leaps);

/* p -= h times the force's covector V_q [nq], as momenta see it at q. */
void dvi__leaps_kick(const dvi__leaps *leaps, double h, const double *V_q, const dvi__phase *state);

/* The drift; leap [nv]: what each cell does in it, for dvi__leaps_path. DVI_STEP_TOO_LARGE: there is no q1 on the branch that shorter steps have. */
dvi_status dvi__leaps_drift(dvi__leaps *leaps, double h, const dvi__phase *state, double *leap);

/* q and v at the part tau of a leap from q0, at constant speed; either may be NULL. */
void dvi__leaps_path(const dvi__leaps *leaps, const double *q0, const double *leap, double h, double tau, double *q, double *v);

/* How many cells are taken one by one, and how many together. */
void dvi__leaps_count(const dvi__leaps *leaps, int *alone, int *coupled);

#endif
