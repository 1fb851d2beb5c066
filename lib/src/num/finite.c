#include "num/finite.h"

#include <math.h>

#include "num/simd/lanes.h"

ptrdiff_t dvi__first_not_finite(size_t count, const double *x)
{
  if (dvi__lanes_all_finite(count, x)) return -1;
  size_t i = 0;
  while (isfinite(x[i])) i++;
  return (ptrdiff_t)i;
}

double dvi__largest(size_t count, const double *x)
{
  return dvi__lanes_largest(count, x);
}
