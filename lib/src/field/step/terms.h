/* What the steps of leapfrog take from a field: the matrix on their left side, the coefficients
 * that it is with diagonal stars, and the integrals of the currents' signals; and what they must
 * not give to it. */
#ifndef DVI_FIELD_STEP_TERMS_H
#define DVI_FIELD_STEP_TERMS_H
#include "field/model/field.h"

/* Fill in, of diagonal stars, the coefficients keep = (1 - s)/(1 + s) and gain = dt/(M (1 + s))
 * [cells], and inverse = 1/(M (1 + s)) [unknowns], with s = dt S/(2 M). `keep` is NULL for 1. */
void dvi__fill_coefficients(const dvi_field *field, double dt, double *keep, double *gain,
                            double *inverse);

/* Make M + dt/2 S. */
dvi_status dvi__make_left(const dvi_field *field, double dt, dvi__csr *left);

/* Give the integrals [currents] of the signals from t - half to t + half. */
dvi_status dvi__find_impulses(const dvi_field *field, double t, double half, double *impulse);

/* Give the currents [currents] at the start: the means over the half step, so that nothing acts
 * that came before, or the signals at the start if they have no integrals. */
dvi_status dvi__find_first_currents(const dvi_field *field, double t, double half, double *J);

/* Refuse values [cells] of a form, by its letter, of which some are not finite at t. */
dvi_status dvi__check_finite(const dvi_field *field, const char *form, const double *values,
                             double t);

#endif
