#include "solve/vector.h"

#include <math.h>

/* The length and the numbers of a vector. */
static sunindextype length(N_Vector x)
{
  return NV_LENGTH_S(x);
}

static double *numbers(N_Vector x)
{
  return NV_DATA_S(x);
}

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double *xs = numbers(x), *ys = numbers(y);
  double *zs = numbers(z);
  for (sunindextype i = 0, n = length(x); i < n; i++) zs[i] = a * xs[i] + b * ys[i];
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
  const double *xs = numbers(x);
  double *zs = numbers(z);
  for (sunindextype i = 0, n = length(x); i < n; i++) zs[i] = a * xs[i];
}

static void product(N_Vector x, N_Vector y, N_Vector z)
{
  const double *xs = numbers(x), *ys = numbers(y);
  double *zs = numbers(z);
  for (sunindextype i = 0, n = length(x); i < n; i++) zs[i] = xs[i] * ys[i];
}

/* A NaN is kept: it is not below any limit. */
static sunrealtype max_norm(N_Vector x)
{
  const double *xs = numbers(x);
  double largest = 0;
  for (sunindextype i = 0, n = length(x); i < n; i++) {
    const double size = fabs(xs[i]);
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

static sunrealtype least(N_Vector x)
{
  const double *xs = numbers(x);
  double least = xs[0];
  for (sunindextype i = 1, n = length(x); i < n; i++) least = xs[i] < least ? xs[i] : least;
  return least;
}

static sunrealtype weighted_norm(N_Vector x, N_Vector w)
{
  const double *xs = numbers(x), *ws = numbers(w);
  double sum = 0;
  for (sunindextype i = 0, n = length(x); i < n; i++) sum += (xs[i] * ws[i]) * (xs[i] * ws[i]);
  return sqrt(sum);
}

void dvi__vector_use_own_operations(N_Vector vector)
{
  vector->ops->nvlinearsum = linear_sum;
  vector->ops->nvscale = scale;
  vector->ops->nvprod = product;
  vector->ops->nvmaxnorm = max_norm;
  vector->ops->nvmin = least;
  vector->ops->nvwl2norm = weighted_norm;
}
