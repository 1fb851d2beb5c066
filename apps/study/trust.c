#include "study/trust.h"

#include <float.h>
#include <math.h>

/* Errors that fall slower than by an order of 1 follow no order. */
static const double slowest = 0.5;

/* A number below this fraction of numbers of its kind is a 0 with thousands of rounding errors. */
static const double rounding = 1e-12;

double trust_ratio(double coarse, double fine)
{
  return coarse > 0.0 ? fine / coarse : 1.0;
}

bool trust_falls(double ratio)
{
  return ratio <= slowest;
}

double trust_error(double first, double second, double third, double ratio)
{
  const double coarse = fabs(first - second), fine = fabs(second - third),
               whole = fabs(first - third);
  if (!trust_falls(ratio)) return 4.0 * fmax(whole, fmax(coarse, fine));
  return whole + ratio / (1.0 - ratio) * fmax(fine, ratio * coarse);
}

double trust_size(double size, double of_all)
{
  return size < rounding * of_all ? of_all : size;
}

double trust_momentum(double p, double q, double moved)
{
  return moved < rounding * q ? p * (q / fmax(moved, DBL_EPSILON * q)) : p;
}

/* Count the digits. A number that is 0 without an error has all digits. */
int trust_digits(double error, double size)
{
  if (!(error < size)) return error > 0.0 || isnan(error) ? 0 : TRUST_DIGITS_MOST;
  return error > 0.0 ? (int)fmin(floor(-log10(error / size)), TRUST_DIGITS_MOST)
                     : TRUST_DIGITS_MOST;
}
