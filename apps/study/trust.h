/** How many digits of a result can be trusted, from results at a step, its half and its quarter. */
#ifndef TRUST_H
#define TRUST_H
#include <stdbool.h>

enum { TRUST_LEVELS = 3, TRUST_DIGITS_MOST = 15 };

/** By which factor differences fall when the step is halved, from the distances of the first
 *  level and the second, and of the second and the third: about 2^-order once the errors follow
 *  their power of h. 1 without a distance. */
double trust_ratio(double coarse, double fine);

/** Whether errors that fall so follow their power of h. */
bool trust_falls(double ratio);

/** An estimate of the error of the first level's number.
 *
 *  Where the errors fall, it is the distance from the last level and what is left of that one's
 *  own error. Where they do not (roundoff, chaos, or steps that do not resolve the motion), it
 *  is the largest distance of any two of them, four times. */
double trust_error(double first, double second, double third, double ratio);

/** What the digits of a number are relative to, of its largest magnitude on the way and that of
 *  all numbers of its kind: the latter where the number is nothing but rounding. */
double trust_size(double size, double of_all);

/** Whole digits of a number of that size with such an error: at most TRUST_DIGITS_MOST, at least
 *  0. */
int trust_digits(double error, double size);
#endif
