/** Repeated measurements in a few numbers, and the power of one quantity in another. */
#ifndef SAMPLES_H
#define SAMPLES_H

enum { ROUNDS_MAX = 99 };

/** Repeated measurements of one quantity. Half of them lie between the quartiles. */
typedef struct spread {
  double least, lower, median, upper;
} spread;

/** Compute the least value, quartiles and median of sample [count], count >= 1, interpolated
 * linearly between neighbours (Hyndman and Fan's type 7). Sorts the sample. */
spread samples_spread(int count, double *sample);

/** Fit the exponent a of y = c x^a by least squares of the logarithms. Points without finite
 * logarithms are left out. NaN if fewer than two different x remain. */
double samples_power(int count, const double *x, const double *y);
#endif
