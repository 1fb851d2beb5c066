/* Check of declarations about time. */
#ifndef DVI_SYSTEM_CHECK_CHECK_TIME_H
#define DVI_SYSTEM_CHECK_CHECK_TIME_H
#include "system/term/term.h"

/* Check that no term of an autonomous system depends on time. For other systems compare every rate
 * with differences of the value. Fill rate_error, depends_on_time and where. The system must be
 * prepared for Hessians. `differences` has room for one number or more. */
dvi_status dvi__check_time(const dvi_system *system, dvi__scratch *scratch,
                           dvi__differences *differences, double t, const double *q,
                           const double *v, double tolerance, dvi_derivative_check *result);

#endif
