/* The passage of an edge with a damping or a current from one of its events to the next, and what
 * its faces owe it in between.
 *
 * With c = C/M1, z = c h and s = z/2, the solution of D' = -J - c D over an interval h, in which J
 * is constant, has the mean value
 *
 *     D_mean = phi1(z) D - phi2(z) int J,     phi1 = (1 - exp(-z))/z,  phi2 = (1 - phi1)/z,
 *
 * and A loses D_mean h/M1, and D the charge int J + z D_mean. The halves b and a of int J may
 * differ. Then D_mean is less by exp(-s) (b - a)/2, too. This keeps the passage its own inverse in
 * time, C A - D changes by int J alone, and without a damping b is a push at the begin and a one at
 * the end. */
#include <math.h>

#include "field/avi/engine.h"
#include "field/step/decay.h"

/* phi1 of z with change = exp(-z) - 1. */
static double phi1_from(double change, double z)
{
  return z != 0 ? -change / z : 1;
}

static double rate(const dvi__avi *avi, int64_t e)
{
  if (avi->extra == NULL || avi->extra[e] < 0) return 0;
  return avi->extras[avi->extra[e]].damping * avi->inverse[e];
}

dvi__avi_passage dvi__avi_passage_of(const dvi__avi *avi, int64_t e, double span,
                                     const double *half)
{
  const dvi__avi_extra *extra = avi->extras + avi->extra[e];
  const double z = rate(avi, e) * span, change = expm1(-z), first = phi1_from(change, z);
  const double second = extra->pushes > 0 ? dvi__decay_second(z) : 0,
               uneven = extra->pushes > 0 ? 0.5 * exp(-0.5 * z) : 0;
  double before = 0, after = 0;
  for (int i = extra->push; i < extra->push + extra->pushes; i++) {
    before += avi->push[i].profile * half[2 * avi->push[i].current];
    after += avi->push[i].profile * half[2 * avi->push[i].current + 1];
  }
  const double D = avi->D[e],
               mean = first * D - (second + uneven) * before - (second - uneven) * after,
               E = mean * avi->inverse[e], work = (before + after) * E;
  return (dvi__avi_passage){.A = avi->A[e] - E * span,
                            .D = (1 + change) * D - (first - z * uneven) * before -
                                 (first + z * uneven) * after,
                            .delivered = before + after + z * mean,
                            .worked = work < 0 ? -work : work};
}

double dvi__avi_owed_time(const dvi__avi *avi, int64_t e, int64_t f, double since)
{
  return dvi__decay_owed(rate(avi, e), avi->step[f], since);
}
