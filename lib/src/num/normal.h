/* Normally distributed numbers, and the elementary functions that make them.
 *
 * The functions of the C library differ in their last bits from machine to machine. These consist
 * of additions, multiplications, divisions and square roots, which IEEE 754 rounds in one way, so
 * that a path has the same bits everywhere. */
#ifndef DVI_NUM_NORMAL_H
#define DVI_NUM_NORMAL_H
#include <stdint.h>

/* Give log u for a normal u > 0, to a few roundings. */
double dvi__log(double u);

/* Give the cosine and the sine of `turns` full circles, |turns| <= 2^40, to a few roundings of
 * 1. */
void dvi__circle(double turns, double *cosine, double *sine);

/* Give e^x - 1 for x <= 0, to a few roundings. */
double dvi__decay(double x);

/* Draw independent standard normal numbers for the coordinates 2*pair and 2*pair + 1 of `count`
 * members, by the method of Box and Muller (1958). Member k gets the numbers of the counter
 * (draw[k], pair, stream[k]) under the key `seed`. Draws are whole numbers below 2^53, streams
 * below 2^32. second may be NULL.
 *
 *     first = sqrt(-2 log u) cos(2 pi w),   second = sqrt(-2 log u) sin(2 pi w)
 * with u and w uniform among the odd multiples of 2^-53 in (0,1). */
void dvi__normals(int count, uint64_t seed, uint32_t pair, const double *draw, const double *stream,
                  double *first, double *second);

#endif
