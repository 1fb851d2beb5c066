/* The growth of fields under a schedule. */
#ifndef DVI_FIELD_AVI_MONODROMY_H
#define DVI_FIELD_AVI_MONODROMY_H
#include <dvi/march.h>

#include "field/avi/engine.h"

/* Find the growth under steps, as dvi_field_stability does. Currents of the terms take no part. */
dvi_status dvi__avi_stability(const dvi__avi_terms *terms, double span, dvi_stability *report);

/* Run from (A, D) right after the events of the time 0 to the time `t`, at which all faces act or
 * will act next. */
dvi_status dvi__avi_carry(dvi__avi *avi, double t);

/* Give the largest size of an eigenvalue of the monodromy matrix of a period, or of some power of
 * it, whose time is *span, by all modes of the field. */
dvi_status dvi__avi_all_multipliers(dvi__avi *avi, double period, dvi_stability *report);

/* The same by Arnoldi's method. */
dvi_status dvi__avi_largest_multipliers(dvi__avi *avi, double period, double span,
                                        dvi_stability *report);

/* Without a period. */
dvi_status dvi__avi_follow(dvi__avi *avi, double span, dvi_stability *report);

/* Refuse a size that has grown beyond all numbers within some time. */
dvi_status dvi__avi_check_size(double size, double time);

/* Set A and D to a random field without a static part, of energy 1. */
void dvi__avi_scatter(dvi__avi *avi, double *impulse);

#endif
