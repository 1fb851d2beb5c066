/* The highest frequency of small oscillations of some coordinates about a state, the others held as
 * they are: the largest lambda = omega^2 of K x = lambda M x, K = -L_qq and M = L_vv there. What
 * velocities couple (L_qv) is default: it changes lambda by squares of slow rates. */
#ifndef DVI_ACTION_FASTEST_H
#define DVI_ACTION_FASTEST_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__fastest dvi__fastest;

enum { DVI__FASTEST_MOST = 16 };

/* fast [n]: which coordinates, 1 to DVI__FASTEST_MOST of them; copied. The system and the counters
 * must outlive it. */
dvi_status dvi__fastest_create(const dvi_system *system, const char *fast, dvi_counters *counters,
                               dvi__fastest **fastest);
void dvi__fastest_destroy(dvi__fastest **fastest);

/* By the Hessians of one point; nothing is allocated. DVI_BAD_STATE: they do not oscillate
 * there. */
dvi_status dvi__fastest_frequency(dvi__fastest *fastest, double t, const double *q, const double *v,
                                  double *omega);

#endif
