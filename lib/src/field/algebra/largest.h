/* The largest eigenvalue of a pencil. */
#ifndef DVI_FIELD_ALGEBRA_LARGEST_H
#define DVI_FIELD_ALGEBRA_LARGEST_H
#include "field/algebra/modes.h"

/* Bound the largest eigenvalue from above, by at most a thousandth of it. K is positive
 * semidefinite. */
dvi_status dvi__largest_eigenvalue(const dvi__pencil *pencil, double *bound);

#endif
