#include "study/norms.h"

#include <math.h>

double norm_distance(int n, const double *a, const double *b)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(a[i] - b[i]));
  return size;
}

double norm_largest(int n, const double *x)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(x[i]));
  return size;
}
