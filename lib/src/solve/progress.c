#include <float.h>
#include <math.h>

#include "solve/solver_struct.h"

/* Corrections of a few roundings are at the floor. */
static const double settled = 4 * DBL_EPSILON;

dvi__progress dvi__judge(double correction, double last, const dvi__pace *pace, double unknown, double size)
{
  if (!isfinite(correction)) return DVI__STALLED;
  if (correction <= settled * unknown) return DVI__CONVERGED;
  if (last == 0) return DVI__GO_ON;
  if (correction > pace->stagnant * last && correction <= pace->noise * (unknown + size)) return DVI__CONVERGED;
  return correction > pace->slowest * last ? DVI__STALLED : DVI__GO_ON;
}

void dvi__correct(int count, const double *correction, double *x, double *largest_correction, double *largest_x)
{
  double change = 0, whole = 0;
  int nan = 0;
  for (int i = 0; i < count; i++) {
    x[i] -= correction[i];
    change = fmax(change, fabs(correction[i]));
    whole = fmax(whole, fabs(x[i]));
    nan |= isnan(x[i]);
  }
  *largest_correction = nan ? HUGE_VAL : change;
  *largest_x = whole;
}
