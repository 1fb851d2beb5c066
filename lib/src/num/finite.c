#include "num/finite.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* The exponent bits are all set in NaN and Inf alone; an integer maximum vectorises where a test of each number would not. */
static int all_finite(size_t count, const double *x)
{
  const uint64_t exponent = UINT64_C(0x7ff0000000000000);
  uint64_t largest = 0;
  for (size_t i = 0; i < count; i++) {
    uint64_t bits;
    memcpy(&bits, x + i, sizeof bits);
    bits &= exponent;
    largest = bits > largest ? bits : largest;
  }
  return largest != exponent;
}

ptrdiff_t dvi__first_not_finite(size_t count, const double *x)
{
  if (all_finite(count, x)) return -1;
  size_t i = 0;
  while (isfinite(x[i])) i++;
  return (ptrdiff_t)i;
}
