/** Maximum norms; NaN is not seen. */
#ifndef NORMS_H
#define NORMS_H

/** The largest |a_i - b_i|. */
double norm_distance(int n, const double *a, const double *b);

/** The largest |x_i|. */
double norm_largest(int n, const double *x);
#endif
