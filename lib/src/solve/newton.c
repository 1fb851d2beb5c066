/* Newton's method with a Jacobian that is kept while the corrections shrink fast (simplified
 * Newton: Hairer and Wanner 1996, sec. IV.8). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "solve/newton.h"
#include "solve/solver_struct.h"

enum { MOST_ITERATIONS = 40 };

/* Ratio of two corrections beyond which a new Jacobian costs less than the iterations that it
 * saves. Where the end of the iteration is foreseen, the factor is kept for at most MOST_KEPT more
 * iterations. They cost as much as a new Jacobian of few unknowns and the iterations with it. */
static const double keep_below = 0.05;
enum { MOST_KEPT = 5 };

/* Newton's corrections shrink fast until rounding noise of the residual, amplified by a stiff
 * Jacobian, dominates. One correction that doubles is a bad sign, and two end the iteration. */
static const dvi__criteria roundoff = {.stagnant = 0.5, .noise = 1e4 * DBL_EPSILON, .slowest = 2.0};

/* Small corrections that do not shrink are idle. They answer the roundings of some rows. One alone
 * may be that of unknowns without effect, as multipliers of dependent rows, while the error of the
 * others is still the square of their correction. With a second one it is a square again. Kept
 * Jacobians give no squares, and settle nothing. */
static const double small_correction = 1e-4, idle_ratio = 0.25;

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

/* Give the largest change of an unknown relative to that unknown itself, or to its group where the
 * end is foreseen. */
static double relative_change(const dvi__solver *s, const double *x)
{
  const double *correction = s->residual;
  double largest = 0;
  if (s->equations.ahead) return dvi__solver_worst_ratio(s, 0, correction, x);
  for (int i = 0; i < s->equations.unknowns; i++)
    if (fabs(correction[i]) > largest * fabs(x[i]) && x[i] != 0)
      largest = fabs(correction[i] / x[i]);
  return largest;
}

/* Tell whether small unknowns have settled. When the largest unknowns are at roundoff, much smaller
 * ones may not be. Newton's method goes on until each has lost its own error, or none gets
 * better. */
static int small_ones_settled(double change, double *last)
{
  const int settled = change <= 64 * DBL_EPSILON || change >= 0.5 * *last;
  *last = change;
  return settled;
}

/* Give the next correction's own part that is to be expected with this factor, as a part of this
 * correction. Below the noise a correction is more than its own part, and the contraction is that
 * seen above it. Where errors are squared, a correction's ratio to the last one is squared, too. A
 * kept Jacobian only keeps the ratio. */
static double expected_part(const dvi__history *history, double correction, int kept)
{
  if (history->contraction == 0 || history->own > correction) {
    const double ratio = dvi__ratio(correction, history);
    return kept ? ratio : ratio * ratio;
  }
  return history->contraction * (kept ? 1 : history->contraction) * (history->own / correction);
}

typedef dvi__outlook outlook;

/* Look ahead. The part that no longer counts is that of the largest unknowns, and of the group that
 * changes most. An unknown alone may be small by chance, and only keeps its digits. The ratio of
 * two corrections by one factor is as small as the change of the Jacobian over the first one, which
 * changes little over the step as a whole. The root of `reach` bounds it with a wide margin where
 * roundings hide it. */
static void look_ahead(const dvi__solver *s, const dvi__history *history, double correction,
                       double whole, int kept, double part, outlook *now)
{
  if (!kept && !s->equations.rough) now->reach = part;
  now->next = expected_part(history, correction, kept || s->equations.rough);
  if (history->contraction == 0) now->next = fmin(now->next, sqrt(now->reach));
  now->unseen = s->equations.group > 1
                    ? dvi__unseen_part(part)
                    : fmin(64 * DBL_EPSILON / part, dvi__unseen_part(correction / whole));
}

/* Tell whether the factor in use serves the next iteration, too. */
static int keeps_factor(const dvi__solver *s, const dvi__history *history, const outlook *now)
{
  const int is_foreseen = s->equations.ahead && !s->equations.rough,
            most = is_foreseen && !s->equations.renewed ? MOST_KEPT : 2;
  double part = now->next;
  if (!s->equations.renewed &&
      (history->before == 0 || (!is_foreseen && history->last < keep_below * history->before)))
    return 1;
  for (int i = 1; i < most && part > now->unseen; i++) part *= now->next;
  return part <= now->unseen;
}

/* Tell, after the second correction, whether a guess leads astray. */
static int leads_astray(const dvi__history *history, const dvi__criteria *criteria,
                        double correction, double whole, double size)
{
  return correction > criteria->noise * (whole + size) && dvi__misleading(history, whole);
}

/* Find whether the rows are at their floor, where corrections settle or do not shrink any more, and
 * after the first one, which may be the only one. It then leaves as small a part of the residual as
 * a rounding is of the correction. *evaluated tells whether solver->residual holds the residual at
 * x instead of the correction. */
static dvi_status test_rows(dvi__solver *s, const double *x, const dvi__criteria *criteria,
                            const dvi__history *history, double whole, int settled,
                            const dvi__solve_report *report, int *evaluated, int *at_floor)
{
  const int is_first = history->before == 0,
            stays = report->correction >= criteria->stagnant * history->before;
  *at_floor = *evaluated = 0;
  if (s->magnitude == NULL || !(settled || stays)) return DVI_OK;
  *evaluated = 1;
  return dvi__solver_at_floor(
      s, x, settled,
      is_first ? criteria->noise * whole / report->correction * report->row : HUGE_VAL, at_floor);
}

dvi_status dvi__newton(dvi__solver *s, double size, int wary, double *x, dvi__solve_report *report)
{
  const dvi__criteria criteria = newton_criteria(s);
  dvi__history history = {0};
  outlook now = {.next = HUGE_VAL, .reach = HUGE_VAL};
  double whole, last_relative = HUGE_VAL;
  int kept = 0, growing = 0, settled = 0, converged = 0, evaluated = 0, at_floor = 0;
  report->idle = 0;
  for (report->iterations = 1; report->iterations <= MOST_ITERATIONS; report->iterations++) {
    if (!kept) DVI_TRY(dvi__solver_factor(s, x));
    if (!kept || !evaluated) DVI_TRY(dvi__solver_residual(s, x, s->residual));
    report->row = dvi__largest((size_t)s->equations.unknowns, s->residual);
    const dvi_status solved = dvi__solver_correction(s, s->residual);
    s->unsolved = solved != DVI_OK;
    DVI_TRY(solved);
    dvi__correct(s->equations.unknowns, s->residual, x, &report->correction, &whole);
    dvi__solver_note(s, x, report);
    const dvi__progress progress = dvi__test_correction(report->correction, &history, &criteria,
                                                        whole, size);
    const int has_settled = converged || progress == DVI__CONVERGED;
    const double part = s->equations.ahead || has_settled ? relative_change(s, x) : 0;
    if (s->equations.ahead) look_ahead(s, &history, report->correction, whole, kept, part, &now);
    if (progress != DVI__STALLED && !converged && now.next <= now.unseen) return DVI_OK;
    const int is_small = report->correction <= small_correction * whole,
              is_idle = is_small && history.before > 0 &&
                        report->correction >= idle_ratio * history.before;
    converged = has_settled;
    report->idle = is_small ? report->idle + is_idle : 0;
    settled = is_small ? settled + (is_idle && !kept) : 0;
    evaluated = 0;
    if (progress != DVI__CONVERGED)
      DVI_TRY(
          test_rows(s, x, &criteria, &history, whole, settled > 1, report, &evaluated, &at_floor));
    if (at_floor) return DVI_OK;
    if (converged && small_ones_settled(part, &last_relative)) return DVI_OK;
    growing = progress == DVI__STALLED ? growing + 1 : 0;
    if (growing == 2 || report->correction > 1e300) break;
    if (wary && report->iterations == 2 && !converged &&
        leads_astray(&history, &criteria, report->correction, whole, size))
      break;
    kept = converged || keeps_factor(s, &history, &now);
  }
  if (converged) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not settle (change %.1e after %.1e)",
                   history.last, history.before);
}

/* ---- one of many problems side by side ---- */

void dvi__newton_begin(dvi__newton_course *course)
{
  *course = (dvi__newton_course){.now = {.next = HUGE_VAL, .reach = HUGE_VAL}};
}

static double largest_of_groups(int groups, const double *largest)
{
  double most = 0;
  for (int i = 0; i < groups; i++) most = largest[i] > most ? largest[i] : most;
  return most;
}

static double worst_of_groups(int groups, double least, const double *of, const double *to)
{
  double worst = 0;
  for (int i = 0; i < groups; i++)
    worst = dvi__worse_ratio(worst, of[i], to[i] > least ? to[i] : least);
  return worst;
}

/* Report as dvi__solver_note. */
static void note_groups(const dvi__solver *s, dvi__newton_course *course,
                        const dvi__newton_correction *of, double whole)
{
  const double least = dvi__solver_least_part(s) * whole;
  if (course->report.iterations == 1)
    memcpy(course->before, of->change, (size_t)of->groups * sizeof *of->change);
  if (course->report.iterations != 2) return;
  course->report.first = worst_of_groups(of->groups, least, course->before, of->whole);
  course->report.bend = worst_of_groups(of->groups, least, of->change, course->before);
}

dvi__progress dvi__newton_go_on(const dvi__solver *s, dvi__newton_course *course,
                                const dvi__newton_correction *of)
{
  const dvi__criteria criteria = newton_criteria(s);
  const double correction = largest_of_groups(of->groups, of->change),
               whole = largest_of_groups(of->groups, of->whole),
               part = worst_of_groups(of->groups, 0, of->change, of->whole);
  const int iterations = ++course->report.iterations;
  dvi__history *history = &course->history;
  note_groups(s, course, of, whole);
  const dvi__progress progress = dvi__test_correction(correction, history, &criteria, whole,
                                                      of->size);
  look_ahead(s, history, correction, whole, iterations > 1, part, &course->now);
  if (progress != DVI__STALLED && course->now.next <= course->now.unseen) return DVI__CONVERGED;
  if (iterations == 2 && leads_astray(history, &criteria, correction, whole, of->size))
    return DVI__STALLED;
  return progress == DVI__GO_ON && keeps_factor(s, history, &course->now) ? DVI__GO_ON
                                                                          : DVI__STALLED;
}
