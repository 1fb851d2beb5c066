/* Checks of what holonomic and nonholonomic constraints, and contacts, declare about time. */
#ifndef DVI_SYSTEM_CHECK_CHECK_ROWS_H
#define DVI_SYSTEM_CHECK_CHECK_ROWS_H
#include "system/term/holonomic.h"

/* Compare the rates with differences of the values. In an autonomous system values and gradients
 * must be the same at two other times. */
dvi_status dvi__check_rows_in_time(const dvi_system *system, double t, const double *q,
                                   double tolerance, dvi_derivative_check *result);

#endif
