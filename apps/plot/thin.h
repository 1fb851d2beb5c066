/** Curves with fewer points that look the same. */
#ifndef THIN_H
#define THIN_H
#include <stdbool.h>

/** Mark the points [count] that a line must pass through to stay within `tolerance` of all points.
 * These are the first and the last one of each run of drawable points, and the points between where
 * it bends.
 *
 *  @param x,y   [count] in units of the picture
 *  @param keep  [count] in, whether a point is drawable, and out, whether it is needed */
void thin_curve(int count, const double *x, const double *y, double tolerance, bool *keep);
#endif
