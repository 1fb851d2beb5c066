/** The power of one quantity in another. */
#ifndef SAMPLES_H
#define SAMPLES_H

/** Fit the exponent a of y = c x^a by least squares of the logarithms. Points without finite
 * logarithms are left out. NaN if fewer than two different x remain. */
double samples_power(int count, const double *x, const double *y);
#endif
