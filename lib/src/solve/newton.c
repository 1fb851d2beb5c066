/* Newton's method with a Jacobian that is kept while the corrections shrink fast (simplified
 * Newton: Hairer and Wanner 1996, sec. IV.8). */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "num/finite.h"
#include "solve/solver_struct.h"

enum { MOST_ITERATIONS = 40 };

/* Ratio of two corrections beyond which a new Jacobian costs less than the iterations that it
 * saves. */
static const double keep_below = 0.05;

/* Newton's corrections shrink fast until rounding noise of the residual, amplified by a stiff
 * Jacobian, dominates. One correction that doubles is a bad sign, and two end the iteration. */
static const dvi__criteria roundoff = {.stagnant = 0.5, .noise = 1e4 * DBL_EPSILON, .slowest = 2.0};

/* Small corrections that do not shrink answer the roundings of some rows. One alone may be that of
 * unknowns without effect, as multipliers of dependent rows, while the error of the others is still
 * the square of their correction. With a second one it is a square again. */
static const double small_correction = 1e-4;

/* Corrections of noisy residuals may be noise from larger ones on. */
static dvi__criteria newton_criteria(const dvi__solver *s)
{
  dvi__criteria criteria = roundoff;
  criteria.noise = fmax(criteria.noise, s->equations.noise);
  return criteria;
}

/* A guess is as likely to lead to another solution as to the wanted one if the second correction is
 * larger than the first, or if the first one is a large part of the unknowns and does not shrink
 * fast. */
int dvi__misleading(const dvi__history *history, double whole)
{
  return history->last > history->before ||
         (history->before > 0.5 * whole && history->last > 0.25 * history->before);
}

/* Give the largest change of an unknown relative to that unknown itself. */
static double relative_change(int count, const double *correction, const double *x)
{
  double largest = 0;
  for (int i = 0; i < count; i++)
    if (fabs(correction[i]) > largest * fabs(x[i]) && x[i] != 0)
      largest = fabs(correction[i] / x[i]);
  return largest;
}

/* Tell whether small unknowns have settled. When the largest unknowns are at roundoff, much smaller
 * ones may not be. Newton's method goes on until each has lost its own error, or none gets
 * better. */
static int small_ones_settled(dvi__solver *s, const double *x, double *last)
{
  const double change = relative_change(s->equations.unknowns, s->residual, x);
  const int settled = change <= 64 * DBL_EPSILON || change >= 0.5 * *last;
  *last = change;
  return settled;
}

/* Tell whether a part of the correction no longer counts. Where errors are squared, a correction's
 * ratio to the last one is squared, too, and is the same for all unknowns, small ones as well. A
 * kept Jacobian only keeps the ratio. */
static int is_unseen(const dvi__solver *s, double part, double correction, double whole,
                     const double *x)
{
  return s->equations.ahead && dvi__unseen(part * correction, whole) &&
         part * relative_change(s->equations.unknowns, s->residual, x) <= 64 * DBL_EPSILON;
}

dvi_status dvi__newton(dvi__solver *s, double size, int wary, double *x, dvi__solve_report *report)
{
  const dvi__criteria criteria = newton_criteria(s);
  dvi__history history = {0};
  double whole, last_relative = HUGE_VAL;
  int fresh = 0, growing = 0, converged = 0;
  report->idle = 0;
  for (report->iterations = 1; report->iterations <= MOST_ITERATIONS; report->iterations++) {
    if (!fresh) DVI_TRY(dvi__solver_factor(s, x));
    DVI_TRY(dvi__solver_residual(s, x, s->residual));
    report->row = dvi__largest((size_t)s->equations.unknowns, s->residual);
    const dvi_status solved = dvi__solver_correction(s, s->residual);
    s->unsolved = solved != DVI_OK;
    DVI_TRY(solved);
    dvi__correct(s->equations.unknowns, s->residual, x, &report->correction, &whole);
    dvi__solver_note(s, x, report);
    const dvi__progress progress = dvi__test_correction(report->correction, &history, &criteria,
                                                        whole, size);
    const double ratio = dvi__ratio(report->correction, &history),
                 next = fresh ? ratio : ratio * ratio;
    if (progress != DVI__STALLED && !converged && is_unseen(s, next, report->correction, whole, x))
      return DVI_OK;
    const int no_better = report->correction >= criteria.stagnant * history.before,
              is_idle = no_better && history.before > 0 &&
                        report->correction <= small_correction * whole;
    int at_floor = 0;
    report->idle = is_idle ? report->idle + 1 : 0;
    if (progress != DVI__CONVERGED && no_better)
      DVI_TRY(dvi__solver_at_floor(s, x, report->idle > 1, &at_floor));
    if (at_floor) return DVI_OK;
    converged |= progress == DVI__CONVERGED;
    if (converged && small_ones_settled(s, x, &last_relative)) return DVI_OK;
    growing = progress == DVI__STALLED ? growing + 1 : 0;
    if (growing == 2 || report->correction > 1e300) break;
    if (wary && report->iterations == 2 && !converged && dvi__misleading(&history, whole)) break;
    fresh = converged || is_unseen(s, next * next, report->correction, whole, x) ||
            (!s->equations.renewed &&
             (history.before == 0 || history.last < keep_below * history.before));
  }
  if (converged) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e after %.1e)",
                   history.last, history.before);
}
