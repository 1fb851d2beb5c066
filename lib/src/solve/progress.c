#include <float.h>
#include <math.h>

#include "solve/solver_struct.h"

/* Corrections of a few roundings are at the floor, if the iteration's own part of them is well below a rounding. That part counts although the
 * unknowns are then right: the last residual was that of the point before, and what a step takes from it would err by this part in the same
 * direction in every step (a charge in a magnetic field: energy drift of 1e-17 a step). */
static const double rounding = 4 * DBL_EPSILON, settled = 0.125 * DBL_EPSILON;

/* Where the step takes all from one point, it is the next correction that must not show; over 5000 steps of outer-solar one of an eighth of a
 * rounding does (5e-11), one of this part of it does not (2e-12, which is the roundings' own). The contraction is known only near the floor. */
static const double unseen = DBL_EPSILON / 16384, near = 64 * DBL_EPSILON;

static double smaller(double a, double b)
{
  return a < b ? a : b;
}

/* What is left of the iteration's error in a correction, by the contraction seen before. It takes a division: where a correction is far from the
 * floor it is not asked for. */
static double expected(double correction, const dvi__trail *trail)
{
  if (trail->before == 0) return correction;
  return smaller(correction, trail->last * smaller(trail->last / trail->before, 1));
}

dvi__progress dvi__judge(double correction, dvi__trail *trail, const dvi__pace *pace, double unknown, double size)
{
  const dvi__trail before = *trail;
  const double last = before.last;
  *trail = (dvi__trail){correction, last};
  if (!isfinite(correction)) return DVI__STALLED;
  if (correction <= rounding * unknown && expected(correction, &before) <= settled * unknown) return DVI__CONVERGED;
  if (pace->ahead && last > 0 && correction <= near * unknown && expected(correction, trail) <= unseen * unknown)
    return DVI__CONVERGED;
  if (last == 0) return DVI__GO_ON;
  if (correction >= pace->stagnant * last && correction <= pace->noise * (unknown + size)) return DVI__CONVERGED;
  return correction > pace->slowest * last ? DVI__STALLED : DVI__GO_ON;
}

void dvi__correct(int count, const double *correction, double *x, double *largest_correction, double *largest_x)
{
  double change = 0, whole = 0;
  int nan = 0;
  for (int i = 0; i < count; i++) {
    x[i] -= correction[i];
    change = fabs(correction[i]) > change ? fabs(correction[i]) : change;
    whole = fabs(x[i]) > whole ? fabs(x[i]) : whole;
    nan |= isnan(x[i]);
  }
  *largest_correction = nan ? HUGE_VAL : change;
  *largest_x = whole;
}
