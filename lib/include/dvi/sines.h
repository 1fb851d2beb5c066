/** Sines and cosines by one sequence of operations, so that scenes, the C that is made of them, and
 *  programs have the same digits on every machine, whatever C library it has, and so that loops
 *  become vectors.
 *
 *  x = n pi/2 + r, |r| <= pi/4, with pi/2 in parts of 33 bits, whose products with n are exact
 *  (Cody and Waite 1980, ch. 8). r is kept as a sum of two numbers. Sine and cosine of r are
 *  minimax polynomials of degree 13 and 14, with the coefficients of Sun's fdlibm (1993). Results
 *  are right to 0.85 units in the last place. Compile without contraction of products and sums. */
#ifndef DVI_SINES_H
#define DVI_SINES_H
#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An angle without its quarter turns. */
typedef struct dvi_reduced_angle {
  double r, tail;    /**< r + tail */
  uint64_t quarters; /**< quarter turns in the two lowest bits */
} dvi_reduced_angle;

/** Take the quarter turns from a plain angle. */
static inline dvi_reduced_angle dvi_reduce_angle(double x)
{
  /* 1.5 2^52, 2/pi, and pi/2 in parts of 33, 33 and 53 bits */
  static const double round = 6755399441055744.0, quarters = 6.36619772367581382433e-01,
                      part[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                                2.02226624879595063154e-21};
  const double counted = x * quarters + round, n = counted - round, first = x - n * part[0],
               second = n * part[1], upper = first - second,
               third = n * part[2] - ((first - upper) - second);
  dvi_reduced_angle angle;
  angle.r = upper - third;
  angle.tail = (upper - angle.r) - third;
  memcpy(&angle.quarters, &counted, sizeof angle.quarters);
  return angle;
}

/** Return 1 if the reduction is right: n has at most 19 bits, so that its products with the first
 *  two parts are exact, and the error of r, below 2^-100, is small beside it. NaN is not plain. */
static inline int dvi_angle_is_plain(double x)
{
  const double r = fabs(dvi_reduce_angle(x).r);
  return (fabs(x) <= 524288.0) & ((r >= 1e-12) | (fabs(x) < 0.5));
}

/** Compute the sine of r + tail, |r| up to pi/4. */
static inline double dvi_sine_polynomial(double r, double tail)
{
  const double z = r * r, cube = z * r,
               higher =
                   8.33333333332248946124e-03 +
                   z * (-1.98412698298579493134e-04 +
                        z * (2.75573137070700676789e-06 +
                             z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return r - ((z * (0.5 * tail - cube * higher) - tail) - cube * -1.66666666666666324348e-01);
}

/** Compute the cosine of r + tail, |r| up to pi/4. */
static inline double dvi_cosine_polynomial(double r, double tail)
{
  const double z = r * r,
               higher = 4.16666666666666019037e-02 +
                        z * (-1.38888888888741095749e-03 +
                             z * (2.48015872894767294178e-05 +
                                  z * (-2.75573143513906633035e-07 +
                                       z * (2.08757232129817482790e-09 +
                                            z * -1.13596475577881948265e-11)))),
               half = 0.5 * z, upper = 1.0 - half;
  return upper + (((1.0 - upper) - half) + (z * (z * higher) - r * tail));
}

/** Return `sine` after an even number of quarter turns and `cosine` after an odd one, with the sign
 *  turned after two and three. */
static inline double dvi_turned_sine(uint64_t quarters, double sine, double cosine)
{
  const uint64_t odd = 0 - (quarters & 1), negative = (quarters & 2) << 62;
  uint64_t s, c;
  double turned;
  memcpy(&s, &sine, sizeof s);
  memcpy(&c, &cosine, sizeof c);
  s = ((s & ~odd) | (c & odd)) ^ negative;
  memcpy(&turned, &s, sizeof turned);
  return turned;
}

/** Return sin(x). Angles that are not plain go to the C library. */
static inline double dvi_sin(double x)
{
  const dvi_reduced_angle angle = dvi_reduce_angle(x);
  if (!dvi_angle_is_plain(x)) return sin(x);
  return dvi_turned_sine(angle.quarters, dvi_sine_polynomial(angle.r, angle.tail),
                         dvi_cosine_polynomial(angle.r, angle.tail));
}

/** Return cos(x). Angles that are not plain go to the C library. */
static inline double dvi_cos(double x)
{
  const dvi_reduced_angle angle = dvi_reduce_angle(x);
  if (!dvi_angle_is_plain(x)) return cos(x);
  return dvi_turned_sine(angle.quarters + 1, dvi_sine_polynomial(angle.r, angle.tail),
                         dvi_cosine_polynomial(angle.r, angle.tail));
}

#ifdef __cplusplus
}
#endif
#endif
