/* Scalar products, and the order and signs of modes. */
#ifndef DVI_FIELD_ALGEBRA_VECTORS_H
#define DVI_FIELD_ALGEBRA_VECTORS_H
#include <stdint.h>

/* Give x.y as four sums, which do not wait for each other. */
double dvi__dot(int64_t n, const double *x, const double *y);

/* Let the first entry that is at least half of the largest one be positive, so that equal problems
 * have equal modes. */
void dvi__choose_sign(int64_t n, double *x);

/* Sort eigenvalues, ascending, and their vectors [count][n], which may be NULL. */
void dvi__sort_modes(int64_t n, int count, double *eigenvalue, double *vector);

#endif
