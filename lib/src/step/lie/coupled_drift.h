/* Leaps (leaps.h) of slots that the mass couples: Newton's method in the natural charts at q0. */
#ifndef DVI_ACTION_COUPLED_LEAPS_H
#define DVI_ACTION_COUPLED_LEAPS_H
#include "step/split/temporal_blocking.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__coupled_drift dvi__coupled_drift;

/* Of the slots with together [slots] not 0, which are coupled to no others. */
dvi_status dvi__coupled_drift_create(const dvi_system *system, const int *together,
                                     dvi_counters *counters, dvi__coupled_drift **leaps);
void dvi__coupled_drift_destroy(dvi__coupled_drift **leaps);

/* As dvi__lie_drift_drift, for these slots. */
dvi_status dvi__coupled_drift_drift(dvi__coupled_drift *leaps, double h, const dvi__phase *state,
                                    double *leap);

/* The velocities v [nv] of these slots with p = T^T M T v: the first correction. */
dvi_status dvi__coupled_drift_velocity(dvi__coupled_drift *leaps, const double *q, const double *p,
                                       double *v);

#endif
