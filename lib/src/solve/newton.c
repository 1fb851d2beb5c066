/* Newton's method with a Jacobian that is kept while the corrections shrink fast (simplified
 * Newton: Hairer and Wanner 1996, sec. IV.8). */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "num/finite.h"
#include "solve/solver_struct.h"

enum { MOST_ITERATIONS = 40 };

/* Beyond this ratio of two corrections a new Jacobian costs less than the iterations that it
 * saves. */
static const double keep_below = 0.05;

/* Newton's corrections shrink fast until rounding noise of the residual, amplified by a stiff
 * Jacobian, keeps them; one that doubles is a bad sign, two are the end. */
static const dvi__pace roundoff = {0.5, 1e4 * DBL_EPSILON, 2.0, 0, 0};

/* Corrections of noisy residuals may be noise from larger ones on. */
static dvi__pace pace_of(const dvi__solver *s)
{
  dvi__pace pace = roundoff;
  pace.noise = fmax(pace.noise, s->equations.noise);
  return pace;
}

/* A guess is as likely to lead to another solution as to the wanted one if the second correction is
 * larger than the first, or if the first one is a large part of the unknowns and does not shrink
 * fast. */
int dvi__misleading(const dvi__trail *trail, double whole)
{
  return trail->last > trail->before ||
         (trail->before > 0.5 * whole && trail->last > 0.25 * trail->before);
}

/* Largest change of an unknown relative to that unknown itself. */
static double relative_change(int count, const double *correction, const double *x)
{
  double largest = 0;
  for (int i = 0; i < count; i++)
    if (fabs(correction[i]) > largest * fabs(x[i]) && x[i] != 0)
      largest = fabs(correction[i] / x[i]);
  return largest;
}

/* When the largest unknowns are at roundoff, much smaller ones may not be: Newton's method goes on
 * until each has lost its own error, or none gets better. */
static int small_ones_settled(dvi__solver *s, const double *x, double *last)
{
  const double change = relative_change(s->equations.unknowns, s->residual, x);
  const int settled = change <= 64 * DBL_EPSILON || change >= 0.5 * *last;
  *last = change;
  return settled;
}

/* Where errors are squared, a correction's ratio to the last one is squared, too, and is the same
 * for all unknowns, small ones as well. A kept Jacobian only keeps the ratio. Whether a part of the
 * correction does not count any more: */
static int is_unseen(const dvi__solver *s, double part, double correction, double whole,
                     const double *x)
{
  return s->equations.ahead && dvi__unseen(part * correction, whole) &&
         part * relative_change(s->equations.unknowns, s->residual, x) <= 64 * DBL_EPSILON;
}

dvi_status dvi__newton(dvi__solver *s, double size, int wary, double *x, dvi__solve_report *report)
{
  const dvi__pace pace = pace_of(s);
  dvi__trail trail = {0};
  double whole, last_relative = HUGE_VAL;
  int fresh = 0, growing = 0, converged = 0;
  for (report->iterations = 1; report->iterations <= MOST_ITERATIONS; report->iterations++) {
    if (!fresh) DVI_TRY(dvi__solver_factor(s, x));
    DVI_TRY(dvi__solver_residual(s, x, s->residual));
    report->row = dvi__largest((size_t)s->equations.unknowns, s->residual);
    dvi__linear_solve(s->linear, s->residual);
    dvi__correct(s->equations.unknowns, s->residual, x, &report->correction, &whole);
    dvi__solver_note(s, x, report);
    const dvi__progress progress = dvi__judge(report->correction, &trail, &pace, whole, size);
    const double ratio = dvi__ratio(report->correction, &trail),
                 next = fresh ? ratio : ratio * ratio;
    if (progress != DVI__STALLED && !converged && is_unseen(s, next, report->correction, whole, x))
      return DVI_OK;
    int at_floor = 0;
    if (progress != DVI__CONVERGED && report->correction >= pace.stagnant * trail.before)
      DVI_TRY(dvi__solver_at_floor(s, x, &at_floor));
    if (at_floor) return DVI_OK;
    converged |= progress == DVI__CONVERGED;
    if (converged && small_ones_settled(s, x, &last_relative)) return DVI_OK;
    growing = progress == DVI__STALLED ? growing + 1 : 0;
    if (growing == 2 || report->correction > 1e300) break;
    if (wary && report->iterations == 2 && !converged && dvi__misleading(&trail, whole)) break;
    fresh = converged || is_unseen(s, next * next, report->correction, whole, x) ||
            (!s->equations.renewed &&
             (trail.before == 0 || trail.last < keep_below * trail.before));
  }
  if (converged) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e after %.1e)",
                   trail.last, trail.before);
}
