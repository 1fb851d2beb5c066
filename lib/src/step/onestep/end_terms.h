/* A quadrature by Taylor coefficients (space/osculation.h) adds end terms to a trapezoid. With the
 * coefficients L_j of the Lagrangian along the motion through a point these are
 *
 *     h sum_{j >= 1} w_j h^j L_j  at the start,     h sum_{j >= 1} w_j (-h)^j L_j  at the end. */
#ifndef DVI_STEP_ONESTEP_END_TERMS_H
#define DVI_STEP_ONESTEP_END_TERMS_H
#include "step/onestep/vector_field.h"

typedef struct dvi__end_terms dvi__end_terms;

/* weight [count] belongs to the coefficients 0 to count - 1. The first weight is not used here. */
dvi_status dvi__end_terms_create(const dvi_system *system, int count, const double *weight,
                                 dvi_counters *counters, dvi__end_terms **ends);
void dvi__end_terms_destroy(dvi__end_terms **ends);

/* Compute the gradient [2n] of the end term in z at the selected point, without the factor h in
 * front. Pass -h for h at the end. */
dvi_status dvi__end_terms_gradient(dvi__end_terms *ends, dvi__vector_field *field, double h,
                                   double *gradient);

#endif
