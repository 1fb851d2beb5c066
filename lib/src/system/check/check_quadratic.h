/* Check of potentials that are declared quadratic. */
#ifndef DVI_SYSTEM_CHECK_CHECK_QUADRATIC_H
#define DVI_SYSTEM_CHECK_CHECK_QUADRATIC_H
#include "system/term/term.h"

/* Check that the gradient of a potential declared quadratic is linear in q far from the point, too,
 * and has the same slope at other times. Fill not_quadratic and where. */
dvi_status dvi__check_quadratic(const dvi_system *system, dvi__scratch *scratch, double t,
                                const double *q, double tolerance, dvi_derivative_check *result);

#endif
