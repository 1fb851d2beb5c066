/** Maximum norms, which ignore NaN. */
#ifndef NORMS_H
#define NORMS_H

/** Return the largest |a_i - b_i|. */
double norm_distance(int n, const double *a, const double *b);

/** Return the largest |x_i|. */
double norm_largest(int n, const double *x);
#endif
