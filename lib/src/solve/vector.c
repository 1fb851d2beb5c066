#include "solve/vector.h"

#include <math.h>

#include "num/finite.h"
#include "num/simd/wide.h"

/* Number of sums that are made side by side, so that none waits for the one before. */
enum { IN_TURN = 8 };

/* Give the length of a vector, and its numbers. */
static sunindextype vector_length(N_Vector x)
{
  return NV_LENGTH_S(x);
}

static double *vector_numbers(N_Vector x)
{
  return NV_DATA_S(x);
}

WIDE static void vector_linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double *xs = vector_numbers(x), *ys = vector_numbers(y);
  double *zs = vector_numbers(z);
  for (sunindextype i = 0, n = vector_length(x); i < n; i++) zs[i] = a * xs[i] + b * ys[i];
}

WIDE static void vector_scale(sunrealtype a, N_Vector x, N_Vector z)
{
  const double *xs = vector_numbers(x);
  double *zs = vector_numbers(z);
  for (sunindextype i = 0, n = vector_length(x); i < n; i++) zs[i] = a * xs[i];
}

WIDE static void vector_product(N_Vector x, N_Vector y, N_Vector z)
{
  const double *xs = vector_numbers(x), *ys = vector_numbers(y);
  double *zs = vector_numbers(z);
  for (sunindextype i = 0, n = vector_length(x); i < n; i++) zs[i] = xs[i] * ys[i];
}

static sunrealtype vector_max_norm(N_Vector x)
{
  return dvi__largest((size_t)vector_length(x), vector_numbers(x));
}

WIDE static sunrealtype vector_least(N_Vector x)
{
  const double *xs = vector_numbers(x);
  const sunindextype n = vector_length(x);
  double least[IN_TURN];
  for (int j = 0; j < IN_TURN; j++) least[j] = xs[0];
  sunindextype i = 0;
  for (; i + IN_TURN <= n; i += IN_TURN)
    for (int j = 0; j < IN_TURN; j++) least[j] = xs[i + j] < least[j] ? xs[i + j] : least[j];
  for (; i < n; i++) least[0] = xs[i] < least[0] ? xs[i] : least[0];
  for (int j = 1; j < IN_TURN; j++) least[0] = least[j] < least[0] ? least[j] : least[0];
  return least[0];
}

WIDE static sunrealtype vector_weighted_norm(N_Vector x, N_Vector w)
{
  const double *xs = vector_numbers(x), *ws = vector_numbers(w);
  const sunindextype n = vector_length(x);
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
  vector->ops->nvlinearsum = vector_linear_sum;
  vector->ops->nvscale = vector_scale;
  vector->ops->nvprod = vector_product;
  vector->ops->nvmaxnorm = vector_max_norm;
  vector->ops->nvmin = vector_least;
  vector->ops->nvwl2norm = vector_weighted_norm;
}

static sunrealtype vector_any(N_Vector x)
{
  return vector_numbers(x)[0];
}

void dvi__vector_is_constant(N_Vector vector)
{
  vector->ops->nvmin = vector_any;
}
