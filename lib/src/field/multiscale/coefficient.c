#include "field/multiscale/coefficient.h"

#include <math.h>

#include "core/status.h"

static dvi_status refuse(const dvi__coefficient *c, int64_t count, const double *x, double a,
                         int64_t i)
{
  if (c->axes == 1)
    return dvi__fail(DVI_NOT_FINITE, "%s: the coefficient is %g at x = %.10g; it must be positive",
                     c->name, a, x[i]);
  return dvi__fail(DVI_NOT_FINITE,
                   "%s: the coefficient is %g at (%.10g, %.10g); it must be positive", c->name, a,
                   x[i], x[count + i]);
}

dvi_status dvi__coefficient_sample(const dvi__coefficient *coefficient, int64_t count,
                                   const double *x, double *a)
{
  const int answer = coefficient->function(count, x, a, coefficient->user);
  if (answer != 0)
    return dvi__fail(DVI_CALLBACK_FAILED,
                     "%s: the coefficient returned %d instead of 0 for %lld points from x = %.10g",
                     coefficient->name, answer, (long long)count, x[0]);
  for (int64_t i = 0; i < count; i++)
    if (!(a[i] > 0) || !isfinite(a[i]) || !isfinite(1 / a[i]))
      return refuse(coefficient, count, x, a[i], i);
  return DVI_OK;
}

double dvi__coefficient_defect(double coarse, double fine)
{
  return fabs(coarse - fine) / fine;
}
