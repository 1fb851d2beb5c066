/* Complex numbers in quadruple precision. They are structs, because not every compiler has complex
 * numbers of 128-bit parts. */
#ifndef SUPPORT_WAVES_QUAD_COMPLEX_H
#define SUPPORT_WAVES_QUAD_COMPLEX_H
#include "support/quad/quad_real.h"

typedef struct quad_complex {
  quad re, im;
} quad_complex;

static inline quad_complex qc(quad re, quad im)
{
  return (quad_complex){re, im};
}

static inline quad_complex qc_add(quad_complex a, quad_complex b)
{
  return qc(a.re + b.re, a.im + b.im);
}

static inline quad_complex qc_subtract(quad_complex a, quad_complex b)
{
  return qc(a.re - b.re, a.im - b.im);
}

static inline quad_complex qc_multiply(quad_complex a, quad_complex b)
{
  return qc(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
}

static inline quad_complex qc_scale(quad factor, quad_complex a)
{
  return qc(factor * a.re, factor * a.im);
}

/* |a|^2. */
static inline quad qc_square(quad_complex a)
{
  return a.re * a.re + a.im * a.im;
}

static inline quad qc_size(quad_complex a)
{
  return quad_sqrt(qc_square(a));
}

static inline quad_complex qc_divide(quad_complex a, quad_complex b)
{
  return qc_scale(1 / qc_square(b), qc_multiply(a, qc(b.re, -b.im)));
}

static inline quad_complex qc_exp(quad_complex a)
{
  return qc_scale(quad_exp(a.re), qc(quad_cos(a.im), quad_sin(a.im)));
}

/* (exp(ia) + exp(-ia)) / 2. */
static inline quad_complex qc_cos(quad_complex a)
{
  return qc_scale(0.5, qc_add(qc_exp(qc(-a.im, a.re)), qc_exp(qc(a.im, -a.re))));
}

/* (exp(ia) - exp(-ia)) / 2i. */
static inline quad_complex qc_sin(quad_complex a)
{
  const quad_complex d = qc_subtract(qc_exp(qc(-a.im, a.re)), qc_exp(qc(a.im, -a.re)));
  return qc(d.im / 2, -d.re / 2);
}

/* The logarithm, with an imaginary part in [-pi, pi]. */
static inline quad_complex qc_log(quad_complex a)
{
  const quad size = qc_size(a), angle = quad_acos(a.re / size);
  return qc(quad_log(size), a.im < 0 ? -angle : angle);
}

/* The root with a real part that is not negative. */
static inline quad_complex qc_sqrt(quad_complex a)
{
  const quad size = qc_size(a), re = quad_sqrt((size + quad_abs(a.re)) / 2);
  if (size == 0) return a;
  if (a.re >= 0) return qc(re, a.im / (2 * re));
  return qc(quad_abs(a.im) / (2 * re), a.im < 0 ? -re : re);
}

#endif
