#include "solve/vector.h"

#include <math.h>

#include "num/finite.h"

/* Numbers that are reduced side by side, so that none waits for the one before. */
enum { IN_TURN = 8 };

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

static sunrealtype max_norm(N_Vector x)
{
  return dvi__largest((size_t)length(x), numbers(x));
}

static sunrealtype least(N_Vector x)
{
  const double *xs = numbers(x);
  const sunindextype n = length(x);
  double least[IN_TURN];
  for (int j = 0; j < IN_TURN; j++) least[j] = xs[0];
  sunindextype i = 0;
  for (; i + IN_TURN <= n; i += IN_TURN)
    for (int j = 0; j < IN_TURN; j++) least[j] = xs[i + j] < least[j] ? xs[i + j] : least[j];
  for (; i < n; i++) least[0] = xs[i] < least[0] ? xs[i] : least[0];
  for (int j = 1; j < IN_TURN; j++) least[0] = least[j] < least[0] ? least[j] : least[0];
  return least[0];
}

static sunrealtype weighted_norm(N_Vector x, N_Vector w)
{
  const double *xs = numbers(x), *ws = numbers(w);
  const sunindextype n = length(x);
  double sum[IN_TURN] = {0};
  sunindextype i = 0;
  for (; i + IN_TURN <= n; i += IN_TURN)
    for (int j = 0; j < IN_TURN; j++) sum[j] += (xs[i + j] * ws[i + j]) * (xs[i + j] * ws[i + j]);
  for (; i < n; i++) sum[0] += (xs[i] * ws[i]) * (xs[i] * ws[i]);
  for (int j = 1; j < IN_TURN; j++) sum[0] += sum[j];
  return sqrt(sum[0]);
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
