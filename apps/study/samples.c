#include "study/samples.h"

#include <math.h>
#include <stdbool.h>

static bool has_logarithm(double x)
{
  return x > 0.0 && isfinite(x);
}

double samples_power(int count, const double *x, const double *y)
{
  double used = 0.0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (int i = 0; i < count; i++) {
    if (!has_logarithm(x[i]) || !has_logarithm(y[i])) continue;
    used += 1.0;
    mean_x += (log(x[i]) - mean_x) / used;
    mean_y += (log(y[i]) - mean_y) / used;
  }
  double square = 0.0;
  double product = 0.0;
  double widest = 0.0;
  for (int i = 0; i < count; i++) {
    if (!has_logarithm(x[i]) || !has_logarithm(y[i])) continue;
    const double away = log(x[i]) - mean_x;
    square += away * away;
    product += away * (log(y[i]) - mean_y);
    widest = fmax(widest, fabs(away));
  }
  return widest > 1e-12 * fmax(1.0, fabs(mean_x))
             ? product / square
             : (double)NAN; /* a smaller width is roundoff of a single x */
}
