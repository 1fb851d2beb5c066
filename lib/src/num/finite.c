#include "num/finite.h"

#include <math.h>

#include "num/simd/lanes.h"

/* So few numbers cost less than a call of the loops in lanes. */
enum { FEW = 8 };

ptrdiff_t dvi__first_not_finite(size_t count, const double *x)
{
  size_t i = 0;
  if (count > FEW && dvi__lanes_all_finite(count, x)) return -1;
  while (i < count && isfinite(x[i])) i++;
  return i < count ? (ptrdiff_t)i : -1;
}

double dvi__largest(size_t count, const double *x)
{
  double most = 0;
  int is_number = count <= FEW;
  for (size_t i = 0; is_number && i < count; i++) {
    const double magnitude = fabs(x[i]);
    is_number = magnitude == magnitude;
    most = magnitude > most ? magnitude : most;
  }
  if (is_number) return most;
  return dvi__lanes_largest(count, x);
}
