/* The part of the derivative check that is about potentials declared quadratic. */
#ifndef DVI_SYSTEM_CHECK_QUADRATIC_H
#define DVI_SYSTEM_CHECK_QUADRATIC_H
#include "system/term/term.h"

/* Of a potential that is declared quadratic: the gradient must be linear in q far from the point,
 * too, and its slope the same at other times. Fills not_quadratic and where. */
dvi_status dvi__check_quadratic(const dvi_system *system, dvi__scratch *scratch, double t,
                                const double *q, double tolerance, dvi_derivative_check *result);

#endif
