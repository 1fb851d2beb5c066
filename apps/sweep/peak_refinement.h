/** Peak refinement: the peaks of a curve that is known at some points, and where it wants more of
 *  them. */
#ifndef PEAK_REFINEMENT_H
#define PEAK_REFINEMENT_H
#include <stdbool.h>

/** How far a peak's top stands above the higher one of the lowest points beside it, before higher
 *  ones or the range's end. What rises less is no peak. */
#define PEAK_RISE 0.3

/** A difference between neighbours that calls for a point between them. */
#define PEAK_STEEP 1.0

/** Find the tops, and mark the gaps to be halved: those beside a top, and steep ones, that are
 *  wider than `width`.
 *
 *  @param      x      [count] ascending
 *  @param      y      [count] finite
 *  @param[out] top    [count] the tops of peaks; of equal points the first. An end of the range may
 *                     be one
 *  @param[out] halve  [count - 1] gap i lies between points i and i + 1
 *  @return how many gaps */
int peak_gaps(int count, const double *x, const double *y, double width, bool *top, bool *halve);
#endif
