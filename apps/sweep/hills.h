/** The hills of a curve that is known at some points, and where it wants more of them. */
#ifndef HILLS_H
#define HILLS_H
#include <stdbool.h>

/** How far a hill's top stands above the higher one of the lowest grounds beside it, before higher ground or the range ends; what rises less is no hill. */
#define HILLS_RISE 0.3

/** A difference between neighbours that calls for a point between them. */
#define HILLS_STEEP 1.0

/** Find the tops, and mark the gaps to be halved: those beside a top, and steep ones, that are wider than `width`.
 *
 *  @param      x      [count] ascending
 *  @param      y      [count] finite
 *  @param[out] top    [count] the tops of hills; of equal points the first. An end of the range may be one
 *  @param[out] halve  [count - 1] gap i lies between points i and i + 1
 *  @return how many gaps */
int hills_gaps(int count, const double *x, const double *y, double width, bool *top, bool *halve);
#endif
