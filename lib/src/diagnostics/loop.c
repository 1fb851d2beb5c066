/* Loop integrals. The trigonometric polynomial through the points is differentiated exactly, and
 * the trapezoidal rule integrates the product exactly. */
#include <dvi/diagnostics.h>
#include <math.h>

#include "core/status.h"
#include "num/finite.h"

static const double pi = 3.14159265358979323846;

/* Return the weight of the difference of the two neighbours at distance d in the derivative at
 * equal distances 2 pi/count (Fornberg 1996). */
static double difference_weight(int count, int d)
{
  const double angle = pi * d / count, sign = d % 2 == 1 ? 1 : -1;
  return 0.5 * sign / (count % 2 == 0 ? tan(angle) : sin(angle));
}

/* Return sum_k (p_k - mean) (q_(k+d) - q_(k-d)). The mean of p does not change the sum, but without
 * it rounding is less. */
static double neighbour_difference_sum(int count, int d, const double *q, const double *p,
                                       double mean)
{
  double sum = 0;
  for (int k = 0; k < count; k++)
    sum += (p[k] - mean) * (q[(k + d) % count] - q[(k + count - d) % count]);
  return sum;
}

static double loop_mean(int count, const double *p)
{
  double sum = 0;
  for (int k = 0; k < count; k++) sum += p[k];
  return sum / count;
}

dvi_status dvi_loop_integral(int n, int count, const double *q, const double *p, double *integral)
{
  if (q == NULL || p == NULL || integral == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "loop integral: an argument is NULL");
  if (n < 1 || count < DVI_LOOP_LEAST)
    return dvi__fail(DVI_BAD_SIZE,
                     "loop integral: %d coordinates at %d points; at least 1 and %d are needed", n,
                     count, DVI_LOOP_LEAST);
  if (dvi__first_not_finite((size_t)n * (size_t)count, q) >= 0 ||
      dvi__first_not_finite((size_t)n * (size_t)count, p) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "loop integral: a point of the loop is not finite");
  double sum = 0;
  for (int i = 0; i < n; i++, q += count, p += count) {
    const double mean = loop_mean(count, p);
    for (int d = 1; 2 * d < count; d++)
      sum += difference_weight(count, d) * neighbour_difference_sum(count, d, q, p, mean);
  }
  *integral = 2 * pi / count * sum;
  return DVI_OK;
}
