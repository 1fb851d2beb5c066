/* What a quadrature by Taylor coefficients (space/osculation.h) adds to a trapezoid: with the
 * coefficients L_j of the Lagrangian along the motion through a point,
 *
 *     h sum_{j >= 1} w_j h^j L_j  at the start,     h sum_{j >= 1} w_j (-h)^j L_j  at the end. */
#ifndef DVI_ACTION_ENDS_H
#define DVI_ACTION_ENDS_H
#include "step/onestep/vector_field.h"

typedef struct dvi__ends dvi__ends;

/* weight [count] of coefficients 0 to count - 1; the first does not count here. */
dvi_status dvi__ends_create(const dvi_system *system, int count, const double *weight,
                            dvi_counters *counters, dvi__ends **ends);
void dvi__ends_destroy(dvi__ends **ends);

/* The gradient [2n] of that in z at the point that is selected, with -h for h at the end; the
 * factor h in front is left out. */
dvi_status dvi__ends_gradient(dvi__ends *ends, dvi__vector_field *field, double h,
                              double *gradient);

#endif
