/** Peak refinement. It finds the peaks of a curve that is known at some points, and the gaps that
 * need more points. */
#ifndef PEAK_REFINEMENT_H
#define PEAK_REFINEMENT_H
#include <stdbool.h>

/** Least rise of a peak's top above the higher one of the lowest points beside it, before higher
 * ones or the range's end. A smaller rise is no peak. */
#define PEAK_RISE 0.3

/** A difference between neighbours that calls for a point between them. */
#define PEAK_STEEP 1.0

/** Find the tops, and mark the gaps to be halved. These are wider than `width`, and beside a top or
 * steep.
 *
 *  @param      x      [count] ascending
 *  @param      y      [count] finite
 *  @param[out] top    [count] the tops of peaks, the first one of equal points. An end of the range
 *                     may be a top
 *  @param[out] halve  [count - 1] gap i lies between points i and i + 1
 *  @return the number of gaps */
int peak_gaps(int count, const double *x, const double *y, double width, bool *top, bool *halve);
#endif
