#include "integrator/event.h"

#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"

/* Each step is looked at in this many parts: a function may cross zero and come back within one. */
enum { PARTS = 4, MOST_ITERATIONS = 200 };

/* A bracket on one step: times, g at both, and how narrow it is to become: a part of the step,
 * whatever its unit is, but not less than times are rounded by. */
typedef struct bracket {
  double a, b, ga, gb, tolerance;
} bracket;

static const char *name_of(const dvi_event *event)
{
  return event->name != NULL ? event->name : "unnamed";
}

static dvi_status ask(const dvi_event *event, double t, const double *q, const double *v, double *g)
{
  const int returned = event->value(t, q, v, g, event->user);
  if (returned != 0)
    return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY, "event '%s': the callback returned %d at t = %.9g",
                     name_of(event), returned, t);
  return isfinite(*g) ? DVI_OK : dvi__fail(DVI_NOT_FINITE, "event '%s' is %g at t = %.9g", name_of(event), *g, t);
}

/* On the last step's path. */
static dvi_status evaluate(dvi__watch *w, dvi_integrator *I, const dvi_event *event, double t, double *g)
{
  DVI_TRY(dvi_integrator_interpolate(I, t, w->q, w->v));
  return ask(event, t, w->q, w->v, g);
}

/* The start's value comes from the state itself: there is no step yet to interpolate on. */
static dvi_status first_value(dvi__watch *w, dvi_integrator *I, const dvi_event *event, double *g)
{
  const double t = dvi_integrator_time(I), *q = dvi_integrator_q(I);
  const size_t n = (size_t)dvi_system_nv(dvi_integrator_system(I));
  for (size_t i = 0; i < n; i++) w->v[i] = 0;
  DVI_TRY(dvi_system_velocity(dvi_integrator_system(I), t, q, dvi_integrator_p(I), w->v));
  return ask(event, t, q, w->v, g);
}

dvi_status dvi__watch_create(dvi_integrator *I, const dvi_run_options *options, dvi__watch *w)
{
  const size_t n = (size_t)dvi_system_nq(dvi_integrator_system(I));
  dvi_status status = DVI_OK;
  *w = (dvi__watch){0};
  if (options->event_count == 0) return DVI_OK;
  *w = (dvi__watch){DVI_NEW(double, n), DVI_NEW(double, n), DVI_NEW(double, options->event_count),
                    DVI_NEW(double, (size_t)options->event_count *PARTS)};
  if (!w->q || !w->v || !w->before || !w->zero)
    status = dvi__fail(DVI_NO_MEMORY, "run: no memory for %d events", options->event_count);
  for (int k = 0; k < options->event_count && status == DVI_OK; k++) status = first_value(w, I, &options->events[k], &w->before[k]);
  if (status != DVI_OK) dvi__watch_destroy(w);
  return status;
}

void dvi__watch_destroy(dvi__watch *w)
{
  dvi__release(w->q);
  dvi__release(w->v);
  dvi__release(w->before);
  dvi__release(w->zero);
  *w = (dvi__watch){0};
}

/* A zero exactly at the left end belongs to the part before. */
static int crosses(const dvi_event *event, const bracket *at)
{
  if (at->ga == 0) return 0;
  if (at->gb != 0 && (at->gb > 0) == (at->ga > 0)) return 0; /* the product of two small values may vanish */
  const int rises = at->gb > at->ga;
  return event->direction == 0 || (event->direction > 0) == rises;
}

/* Illinois' variant of regula falsi, to the last digits of t (Dowell and Jarratt 1971). Where three of its iterations do not halve the
 * bracket, as at a multiple zero, one of bisection follows. */
static dvi_status locate(dvi__watch *w, dvi_integrator *I, const dvi_event *event, bracket at, double *zero)
{
  int side = 0;
  double looked_at = HUGE_VAL; /* the width when the bracket was looked at last */
  *zero = at.b;
  for (int i = 0; i < MOST_ITERATIONS && at.gb != 0; i++) {
    const double width = at.b - at.a;
    const int lingers = i % 3 == 0 && fabs(width) > 0.5 * looked_at;
    double g, middle = at.a + width * (at.ga / (at.ga - at.gb));
    if (lingers || middle == at.a || middle == at.b) middle = at.a + 0.5 * width; /* g's values may be of very different size */
    if (i % 3 == 0) looked_at = fabs(width);
    *zero = middle;
    if (fabs(width) <= at.tolerance) break;
    DVI_TRY(evaluate(w, I, event, middle, &g));
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

static dvi_status report_event(dvi__watch *w, dvi_integrator *I, const dvi_event *event, int index, double zero,
                               dvi_run_report *report, int *stop)
{
  report->events++;
  report->event = index;
  report->event_time = zero;
  if (event->terminal) {
    report->end = DVI_RUN_EVENT;
    *stop = 1;
  }
  if (event->occurred == NULL) return DVI_OK;
  DVI_TRY(dvi_integrator_interpolate(I, zero, w->q, w->v));
  const int returned = event->occurred(zero, w->q, w->v, event->user);
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "event '%s': the callback at t = %.9g failed with %d", name_of(event), zero, returned);
  if (returned > 0) {
    report->end = DVI_RUN_STOPPED;
    *stop = 1;
  }
  return DVI_OK;
}

/* Whether g passes from one sign to the other through infinity: near a zero it is less than at the ends of the bracket. */
static dvi_status drop_pole(dvi__watch *w, dvi_integrator *I, const dvi_event *event, const bracket *at, double *zero)
{
  double g;
  DVI_TRY(evaluate(w, I, event, *zero, &g));
  if (fabs(g) > fmax(fabs(at->ga), fabs(at->gb))) *zero = (double)NAN;
  return DVI_OK;
}

/* Look at one event between a and b: it has at most one zero there. */
static dvi_status find_zero(dvi__watch *w, dvi_integrator *I, const dvi_event *event, double a, double b, double *before,
                            double *zero)
{
  bracket at = {a, b, *before, 0, 1e-13 * PARTS * fabs(b - a) + DBL_EPSILON * fabs(b)};
  *zero = (double)NAN;
  DVI_TRY(evaluate(w, I, event, b, &at.gb));
  *before = at.gb;
  if (!crosses(event, &at)) return DVI_OK;
  DVI_TRY(locate(w, I, event, at, zero));
  return drop_pole(w, I, event, &at, zero);
}

dvi_status dvi__watch_find(dvi__watch *w, dvi_integrator *I, const dvi_run_options *options, double from)
{
  const double to = dvi_integrator_time(I), width = (to - from) / (double)PARTS;
  for (int k = 0; k < options->event_count; k++)
    for (int part = 0; part < PARTS; part++) {
      const double a = from + part * width, b = part == PARTS - 1 ? to : from + (part + 1) * width;
      DVI_TRY(find_zero(w, I, &options->events[k], a, b, &w->before[k], &w->zero[k * PARTS + part]));
    }
  return DVI_OK;
}

/* The zero that the run meets first, of two at one time the first of the list; -1 if there is none. */
static int earliest(const dvi__watch *w, int count, int forward)
{
  int first = -1;
  for (int k = 0; k < count; k++) {
    if (isnan(w->zero[k])) continue;
    if (first < 0 || (forward ? w->zero[k] < w->zero[first] : w->zero[k] > w->zero[first])) first = k;
  }
  return first;
}

dvi_status dvi__watch_report(dvi__watch *w, dvi_integrator *I, const dvi_run_options *options, dvi_run_report *report, int *stop)
{
  const int count = options->event_count * PARTS, forward = options->h > 0;
  for (int k = earliest(w, count, forward); k >= 0 && !*stop; k = earliest(w, count, forward)) {
    const double zero = w->zero[k];
    w->zero[k] = (double)NAN;
    DVI_TRY(report_event(w, I, &options->events[k / PARTS], k / PARTS, zero, report, stop));
  }
  return DVI_OK;
}
