/* A velocity that decays, v' = -c v, between pushes. */
#ifndef DVI_FIELD_STEP_DECAY_H
#define DVI_FIELD_STEP_DECAY_H
#include <math.h>

/* Give phi1 = (1 - exp(-z))/z, the mean of exp(-z s) for s from 0 to 1. */
static inline double dvi__decay_mean(double z)
{
  return z != 0 ? -expm1(-z) / z : 1;
}

/* Give phi2 = (1 - phi1)/z. For small z, where the difference cancels, it is 1/2 - z/6 + z^2/24 and
 * so on. */
static inline double dvi__decay_second(double z)
{
  if (z > 1) return (1 - dvi__decay_mean(z)) / z;
  double term = 0.5, sum = term;
  for (int n = 3; fabs(term) > 1e-17; n++) sum += term *= -z / n;
  return sum;
}

/* Give the time for which a force still is owed, below 0 if more was paid, at a time `since` after
 * its last push. The pushes K = h H, once in h, stand for the force H all the time. A regular train
 * of them leaves in v more than that force does, by
 *
 *     K exp(-c x)/(1 - exp(-c h)) - H/c = H (h phi2(c h) - x phi1(c x))/phi1(c h)
 *
 * at the time x after a push, which is h/2 - x without a damping. */
static inline double dvi__decay_owed(double c, double h, double since)
{
  if (!(c > 0)) return since - 0.5 * h;
  return (since * dvi__decay_mean(c * since) - h * dvi__decay_second(c * h)) /
         dvi__decay_mean(c * h);
}

#endif
