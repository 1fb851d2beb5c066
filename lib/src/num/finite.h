/* Largest magnitude and finiteness of numbers. */
#ifndef DVI_NUM_FINITE_H
#define DVI_NUM_FINITE_H
#include <stddef.h>

/* Give the index of the first NaN or Inf of x[count], or -1. */
ptrdiff_t dvi__first_not_finite(size_t count, const double *x);

/* Give the largest |x_i|, 0 if there are none, and NaN if one is. */
double dvi__largest(size_t count, const double *x);

#endif
