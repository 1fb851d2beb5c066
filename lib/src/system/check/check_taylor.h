/* The part of the derivative check that is about Taylor coefficients. */
#ifndef DVI_SYSTEM_CHECK_TAYLOR_H
#define DVI_SYSTEM_CHECK_TAYLOR_H
#include "system/term/term.h"

/* Of every term with a taylor callback, along a curve through the point: coefficient 0 against the
 * one-point callbacks, each other one against differences of the one below it as the curve is
 * followed. Fills taylor_error and where. Hessians must be prepared for. */
dvi_status dvi__check_taylor(const dvi_system *system, dvi__scratch *scratch, double t,
                             const double *q, const double *v, double tolerance,
                             dvi_derivative_check *result);

#endif
