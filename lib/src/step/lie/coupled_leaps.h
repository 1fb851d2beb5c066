/* Leaps (leaps.h) of cells that the mass couples: Newton's method in the natural charts at q0. */
#ifndef DVI_ACTION_COUPLED_LEAPS_H
#define DVI_ACTION_COUPLED_LEAPS_H
#include "step/split/wave.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__coupled_leaps dvi__coupled_leaps;

/* Of the cells with together [cells] not 0, which are coupled to no others. */
dvi_status dvi__coupled_leaps_create(const dvi_system *system, const int *together, dvi_counters *counters,
                                     dvi__coupled_leaps **leaps);
void dvi__coupled_leaps_destroy(dvi__coupled_leaps **leaps);

/* As dvi__leaps_drift, for these cells. */
dvi_status dvi__coupled_leaps_drift(dvi__coupled_leaps *leaps, double h, const dvi__phase *state, double *leap);

/* The velocities v [nv] of these cells with p = T^T M T v: the first correction. */
dvi_status dvi__coupled_leaps_velocity(dvi__coupled_leaps *leaps, const double *q, const double *p, double *v);

#endif
