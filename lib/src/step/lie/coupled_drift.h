/* Lie-Verlet drifts (lie_drift.h) of slots that the mass couples, by Newton's method in the natural
 * charts at q0. */
#ifndef DVI_STEP_LIE_COUPLED_DRIFT_H
#define DVI_STEP_LIE_COUPLED_DRIFT_H
#include "step/split/temporal_blocking.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__coupled_drift dvi__coupled_drift;

/* Create the drift of the slots with together [slots] not 0, which are coupled to no other
 * slots. */
dvi_status dvi__coupled_drift_create(const dvi_system *system, const int *together,
                                     dvi_counters *counters, dvi__coupled_drift **drift);
void dvi__coupled_drift_destroy(dvi__coupled_drift **drift);

/* Take the drift of dvi__lie_drift_drift for these slots. */
dvi_status dvi__coupled_drift_drift(dvi__coupled_drift *drift, double h, const dvi__phase *state,
                                    double *displacement);

/* Compute the velocities v [nv] of these slots with p = T^T M T v. They are the first
 * correction. */
dvi_status dvi__coupled_drift_velocity(dvi__coupled_drift *drift, const double *q, const double *p,
                                       double *v);

#endif
