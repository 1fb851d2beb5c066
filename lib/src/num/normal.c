#include "num/normal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "num/philox.h"

/* Adding this constant to a small number rounds it to a whole number, in the last bits. */
static const double rounding = 0x1.8p52;

static uint64_t bits_of(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

static double number_of(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* With u = 2^k m, m in [sqrt(1/2), sqrt(2)), and s = (m - 1)/(m + 1),
 *     log u = k log 2 + 2 (s + s^3/3 + s^5/5 + ...),   s^2 < 0.0295. */
double dvi__log(double u)
{
  static const double log2_high = 0x1.62e42fefa38p-1, log2_low = 0x1.ef35793c7673p-45;
  static const uint64_t least = UINT64_C(0x3fe6a09e667f3bcd); /* of sqrt(1/2) */
  const uint64_t bits = bits_of(u);
  const int64_t exponent = (int64_t)(bits - least) >> 52;
  const double m = number_of(bits - ((uint64_t)exponent << 52)), k = (double)exponent;
  const double s = (m - 1) / (m + 1), z = s * s;
  double rest = 1.0 / 23;
  for (int odd = 21; odd >= 3; odd -= 2) rest = rest * z + 1.0 / odd;
  return k * log2_high + (2 * s + (2 * s * z * rest + k * log2_low));
}

/* The sum of the series, from the term x^2/2 or x^3/6 on, in z = x^2 <= (pi/4)^2. */
static double series(const double coefficient[9], double z)
{
  double sum = coefficient[8];
  for (int k = 7; k >= 0; k--) sum = sum * z + coefficient[k];
  return sum * z;
}

/* The quarters of a circle are taken out without an error. */
void dvi__circle(double turns, double *cosine, double *sine)
{
  static const double half_pi = 0x1.921fb54442d18p+0;
  static const double even[9] = {-1.0 / 2,
                                 1.0 / 24,
                                 -1.0 / 720,
                                 1.0 / 40320,
                                 -1.0 / 3628800,
                                 1.0 / 479001600,
                                 -1.0 / 87178291200,
                                 1.0 / 2.0922789888e13,
                                 -1.0 / 6.402373705728e15};
  static const double odd[9] = {-1.0 / 6,
                                1.0 / 120,
                                -1.0 / 5040,
                                1.0 / 362880,
                                -1.0 / 39916800,
                                1.0 / 6227020800,
                                -1.0 / 1307674368000,
                                1.0 / 3.55687428096e14,
                                -1.0 / 1.21645100408832e17};
  const double quarters = 4 * turns, shifted = quarters + rounding;
  const double x = (quarters - (shifted - rounding)) * half_pi, z = x * x;
  const double c = 1 + series(even, z), s = x + x * series(odd, z);
  const uint64_t quarter = bits_of(shifted) & 3;
  const double first = quarter & 1 ? s : c, other = quarter & 1 ? c : s;
  *cosine = quarter == 1 || quarter == 2 ? -first : first;
  *sine = quarter >= 2 ? -other : other;
}

/* With y = x/2^k, |y| <= 1/4, e^x - 1 comes from e^y - 1 by k times (1 + d)^2 - 1 = d (2 + d). */
double dvi__decay(double x)
{
  int halvings = 0;
  if (!(x > -800)) return x <= -800 ? -1 : x;
  while (x < -0.25) x *= 0.5, halvings++;
  double d = 0;
  for (int k = 14; k > 1; k--) d = (1 + d) * x / k;
  d = x + x * d;
  for (int k = 0; k < halvings; k++) d *= 2 + d;
  return d;
}

/* Give the odd multiple of 2^-53 in (0,1) that the highest 52 of 64 bits choose. */
static double uniform(uint32_t high, uint32_t low)
{
  const uint64_t bits = (uint64_t)high << 32 | low;
  return (number_of(UINT64_C(0x3ff0000000000000) | bits >> 12) - 1) + 0x1p-53;
}

void dvi__normals(int count, uint64_t seed, uint32_t pair, const double *draw, const double *stream,
                  double *first, double *second)
{
  for (int k = 0; k < count; k++) {
    const uint64_t step = (uint64_t)draw[k];
    uint32_t x[4] = {(uint32_t)step, (uint32_t)(step >> 32), pair, (uint32_t)stream[k]};
    double cosine, sine;
    dvi__philox(x, seed);
    const double radius = sqrt(-2 * dvi__log(uniform(x[1], x[0])));
    dvi__circle(uniform(x[3], x[2]), &cosine, &sine);
    first[k] = radius * cosine;
    if (second != NULL) second[k] = radius * sine;
  }
}
