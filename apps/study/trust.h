/** The number of trusted digits of a result, from results at a step, its half and its quarter. */
#ifndef TRUST_H
#define TRUST_H
#include <stdbool.h>

enum { TRUST_LEVELS = 3, TRUST_DIGITS_MOST = 15 };

/** Return the factor by which differences fall when the step is halved, from the distances of the
 * first level and the second, and of the second and the third. It is about 2^-order once the errors
 * follow their power of h, and 1 without a distance. */
double trust_ratio(double coarse, double fine);

/** Return whether errors that fall by this factor follow their power of h. */
bool trust_falls(double ratio);

/** Estimate the error of the first level's number.
 *
 * Where the errors fall, the estimate is the distance from the last level plus the remaining error
 * of the last level. Elsewhere (roundoff, chaos, or steps that do not resolve the motion) it is
 * four times the largest distance of any two levels. */
double trust_error(double first, double second, double third, double ratio);

/** Return the size that the digits of a number are relative to, from its largest magnitude during
 * the run and that of all numbers of its kind. The latter counts where the number is only
 * rounding. */
double trust_size(double size, double of_all);

/** Return the size of momenta up to p, which move coordinates of size q by `moved`. Where that is
 * only rounding, the momenta are, too, and the size is that of momenta which move the coordinates
 * by q in the same time. */
double trust_momentum(double p, double q, double moved);

/** Count the whole digits of a number of that size with such an error, from 0 to
 * TRUST_DIGITS_MOST. */
int trust_digits(double error, double size);
#endif
