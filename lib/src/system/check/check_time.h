/* The part of the derivative check that is about time. */
#ifndef DVI_SYSTEM_CHECK_TIME_H
#define DVI_SYSTEM_CHECK_TIME_H
#include "system/term/term.h"

/* Of an autonomous system: no term may give other numbers at another time. Of another one: every
 * rate against differences of the value. Fills rate_error, depends_on_time and where. Hessians must
 * be prepared for; `differences` has room for one number or more. */
dvi_status dvi__check_time(const dvi_system *system, dvi__scratch *scratch,
                           dvi__differences *differences, double t, const double *q,
                           const double *v, double tolerance, dvi_derivative_check *result);

#endif
