/* Check of Taylor coefficients. */
#ifndef DVI_SYSTEM_CHECK_CHECK_TAYLOR_H
#define DVI_SYSTEM_CHECK_CHECK_TAYLOR_H
#include "system/term/term.h"

/* Check every term with a taylor callback along a curve through the point. Coefficient 0 is
 * compared with the one-point callbacks, each other coefficient with differences along the curve of
 * the one below. Fill taylor_error and where. The system must be prepared for Hessians. */
dvi_status dvi__check_taylor(const dvi_system *system, dvi__scratch *scratch, double t,
                             const double *q, const double *v, double tolerance,
                             dvi_derivative_check *result);

#endif
