/* The highest frequency of small oscillations of some coordinates about a state, with the others
 * held. This is the largest lambda = omega^2 of K x = lambda M x, with K = -L_qq and M = L_vv
 * there. The coupling by velocities (L_qv) is neglected, because it changes lambda by squares of
 * slow rates. */
#ifndef DVI_STEP_SPLIT_FASTEST_H
#define DVI_STEP_SPLIT_FASTEST_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__fastest dvi__fastest;

enum { DVI__FASTEST_MOST = 16 };

/* fast [n] marks 1 to DVI__FASTEST_MOST coordinates, and is copied. The system and the counters
 * must outlive this. */
dvi_status dvi__fastest_create(const dvi_system *system, const char *fast, dvi_counters *counters,
                               dvi__fastest **fastest);
void dvi__fastest_destroy(dvi__fastest **fastest);

/* Compute the frequency by the Hessians of one point. Nothing is allocated. DVI_BAD_STATE if the
 * coordinates do not oscillate there. */
dvi_status dvi__fastest_frequency(dvi__fastest *fastest, double t, const double *q, const double *v,
                                  double *omega);

#endif
