#include "march/events.h"

#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"

/* Each step is searched in this many parts. A function that crosses zero twice within one part is
 * not noticed. */
enum { PARTS = 4, MOST_ITERATIONS = 200 };

/* A bracket on one step: two times a and b, the values of g there, and the width at which the
 * search ends. The width is a part of the step, in any unit, but not less than the rounding of
 * times. */
typedef struct bracket {
  double a, b, ga, gb, tolerance;
} bracket;

static dvi_status event_value_at(const dvi__event_search *w, int k, double t, double *g)
{
  return w->marcher->value(w->of, k, t, g);
}

dvi_status dvi__event_search_create(void *of, const dvi__marcher *marcher, int count,
                                    dvi__event_search *w)
{
  dvi_status status = DVI_OK;
  *w = (dvi__event_search){.of = of, .marcher = marcher, .count = count};
  if (count == 0) return DVI_OK;
  w->before = DVI_NEW(double, count);
  w->zero = DVI_NEW(double, (size_t)count *PARTS);
  if (w->before == NULL || w->zero == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "run: no memory for %d events", count);
  for (int k = 0; k < count && status == DVI_OK; k++)
    status = marcher->value_at_start(of, k, &w->before[k]);
  if (status != DVI_OK) dvi__event_search_clear(w);
  return status;
}

void dvi__event_search_clear(dvi__event_search *w)
{
  dvi__release(w->before);
  dvi__release(w->zero);
  *w = (dvi__event_search){0};
}

/* Test for a zero in the bracket. A zero exactly at the left end belongs to the part before. */
static int bracket_crosses(int direction, const bracket *at)
{
  if (at->ga == 0) return 0;
  /* the product of two small values may vanish */
  if (at->gb != 0 && (at->gb > 0) == (at->ga > 0)) return 0;
  const int rises = at->gb > at->ga;
  return direction == 0 || (direction > 0) == rises;
}

/* Locate the zero to the last digits of t, by Illinois' variant of regula falsi (Dowell and Jarratt
 * 1971). If three iterations do not halve the bracket, as at a multiple zero, one of bisection
 * follows. */
static dvi_status locate_zero(const dvi__event_search *w, int k, bracket at, double *zero)
{
  int side = 0;
  double tested_width = HUGE_VAL; /* width of the bracket at the last test, three iterations ago */
  *zero = at.b;
  for (int i = 0; i < MOST_ITERATIONS && at.gb != 0; i++) {
    const double width = at.b - at.a;
    const int lingers = i % 3 == 0 && fabs(width) > 0.5 * tested_width;
    double g, middle = at.a + width * (at.ga / (at.ga - at.gb));
    /* g's values may be of very different size */
    if (lingers || middle == at.a || middle == at.b) middle = at.a + 0.5 * width;
    if (i % 3 == 0) tested_width = fabs(width);
    *zero = middle;
    if (fabs(width) <= at.tolerance) break;
    DVI_TRY(event_value_at(w, k, middle, &g));
    if (g == 0) break;
    if ((g > 0) == (at.gb > 0)) {
      at.b = middle, at.gb = g;
      if (side == -1) at.ga *= 0.5;
      side = -1;
    } else {
      at.a = middle, at.ga = g;
      if (side == 1) at.gb *= 0.5;
      side = 1;
    }
  }
  return DVI_OK;
}

static dvi_status report_event(const dvi__event_search *w, int k, double zero,
                               dvi_run_report *report, int *stop)
{
  int returned = 0;
  report->events++;
  report->event = k;
  report->event_time = zero;
  if (w->marcher->event(w->of, k).terminal) {
    report->end = DVI_RUN_EVENT;
    *stop = 1;
  }
  DVI_TRY(w->marcher->occurred(w->of, k, zero, &returned));
  if (returned > 0) {
    report->end = DVI_RUN_STOPPED;
    *stop = 1;
  }
  return DVI_OK;
}

/* Drop a zero where g changes sign through infinity. Near a true zero |g| is less than at the ends
 * of the bracket. */
static dvi_status drop_pole(const dvi__event_search *w, int k, const bracket *at, double *zero)
{
  double g;
  DVI_TRY(event_value_at(w, k, *zero, &g));
  if (fabs(g) > fmax(fabs(at->ga), fabs(at->gb))) *zero = (double)NAN;
  return DVI_OK;
}

/* Search event k between a and b for one zero. */
static dvi_status find_zero(const dvi__event_search *w, int k, double a, double b, double *zero)
{
  bracket at = {.a = a,
                .b = b,
                .ga = w->before[k],
                .tolerance = 1e-13 * PARTS * fabs(b - a) + DBL_EPSILON * fabs(b)};
  *zero = (double)NAN;
  DVI_TRY(event_value_at(w, k, b, &at.gb));
  w->before[k] = at.gb;
  if (!bracket_crosses(w->marcher->event(w->of, k).direction, &at)) return DVI_OK;
  DVI_TRY(locate_zero(w, k, at, zero));
  return drop_pole(w, k, &at, zero);
}

dvi_status dvi__event_search_find(dvi__event_search *w, double from)
{
  const double to = w->marcher->time(w->of), width = (to - from) / (double)PARTS;
  for (int k = 0; k < w->count; k++)
    for (int part = 0; part < PARTS; part++) {
      const double a = from + part * width, b = part == PARTS - 1 ? to : from + (part + 1) * width;
      DVI_TRY(find_zero(w, k, a, b, &w->zero[k * PARTS + part]));
    }
  return DVI_OK;
}

/* Return the zero that the run meets first, of two at one time the first in the list. -1 if there
 * is none. */
static int earliest_zero(const dvi__event_search *w, int count, int forward)
{
  int first = -1;
  for (int k = 0; k < count; k++) {
    if (isnan(w->zero[k])) continue;
    if (first < 0 || (forward ? w->zero[k] < w->zero[first] : w->zero[k] > w->zero[first]))
      first = k;
  }
  return first;
}

dvi_status dvi__event_search_report(dvi__event_search *w, int forward, dvi_run_report *report,
                                    int *stop)
{
  const int count = w->count * PARTS;
  for (int k = earliest_zero(w, count, forward); k >= 0 && !*stop;
       k = earliest_zero(w, count, forward)) {
    const double zero = w->zero[k];
    w->zero[k] = (double)NAN;
    DVI_TRY(report_event(w, k / PARTS, zero, report, stop));
  }
  return DVI_OK;
}
