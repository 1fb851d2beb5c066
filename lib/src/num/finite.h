/* The size of numbers, and whether they are finite. */
#ifndef DVI_NUM_FINITE_H
#define DVI_NUM_FINITE_H
#include <stddef.h>

/* Index of the first NaN or Inf of x[count], or -1. */
ptrdiff_t dvi__first_not_finite(size_t count, const double *x);

/* The largest |x_i|, 0 if there are none; NaN if one is. */
double dvi__largest(size_t count, const double *x);

#endif
