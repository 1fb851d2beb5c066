#include "study/point.h"

#include <dvi/system.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* ---- the watch ---- */

/* Find the energy, without what forces have supplied. */
static dvi_status watch_energy(dvi_integrator *integrator, dvi__watch *watch)
{
  DVI_TRY(dvi_integrator_invariants(integrator, watch->invariant));
  if (!isfinite(watch->invariant[0])) return DVI_NOT_FINITE;
  const double supplied = dvi_integrator_supplied(integrator, 0);
  const double energy = watch->invariant[0] - (isnan(supplied) ? 0.0 : supplied);
  if (!watch->begun) watch->first = energy;
  watch->change = fmax(watch->change, fabs(energy - watch->first));
  return DVI_OK;
}

static void watch_extremes(const double *q, dvi__watch *watch)
{
  for (int i = 0; i < watch->nq; i++) {
    watch->least[i] = watch->begun ? fmin(watch->least[i], q[i]) : q[i];
    watch->most[i] = watch->begun ? fmax(watch->most[i], q[i]) : q[i];
  }
}

static int watch_run(dvi_integrator *integrator, void *user)
{
  dvi__watch *watch = user;
  watch->status = watch_energy(integrator, watch);
  if (watch->status != DVI_OK) return -1;
  if (watch->least != NULL) watch_extremes(dvi_integrator_q(integrator), watch);
  watch->begun = 1;
  return watch->own->observe != NULL ? watch->own->observe(integrator, watch->own->user) : 0;
}

static dvi_status watch_open(const dvi_study_run *run, int extremes, dvi__watch *watch)
{
  const dvi_system *system = dvi_integrator_system(run->integrator);
  *watch = (dvi__watch){.own = &run->options, .nq = dvi_system_nq(system)};
  watch->invariant = DVI_NEW(double, dvi_system_invariant_count(system));
  if (extremes) {
    watch->least = DVI_NEW(double, watch->nq);
    watch->most = DVI_NEW(double, watch->nq);
  }
  if (watch->invariant != NULL && (!extremes || (watch->least != NULL && watch->most != NULL)))
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "sweep: no memory for a row");
}

/* ---- the point ---- */

/* Leave a failure in the row. A lack of memory has no sentence of its own, nor an energy that is
 * not finite. */
static void row_fail(dvi_status status, int has_sentence, dvi_study_row *row)
{
  const char *sentence = has_sentence && status != DVI_NO_MEMORY ? dvi_last_error() : "";
  row->status = status;
  row->sentence = sentence[0] != '\0' ? sentence : dvi_status_meaning(status);
}

static void run_fill_row(dvi__point *point)
{
  const dvi__watch *watch = &point->watch;
  dvi_study_row *row = &point->row;
  row->t = dvi_integrator_time(point->run.integrator);
  row->q = dvi_integrator_q(point->run.integrator);
  row->p = dvi_integrator_p(point->run.integrator);
  if (!watch->begun) return;
  row->invariant = watch->invariant;
  row->least = watch->least;
  row->most = watch->most;
  row->energy_error = watch->change;
}

static void point_advance(const volatile int *cancel, dvi__point *point)
{
  dvi_run_options options = point->run.options;
  options.observe = watch_run;
  options.user = &point->watch;
  options.cancel = cancel;
  const dvi_status status = dvi_run(point->run.integrator, &options, &point->row.report);
  run_fill_row(point);
  if (point->watch.status != DVI_OK)
    row_fail(point->watch.status, point->watch.status != DVI_NOT_FINITE, &point->row);
  else if (status != DVI_OK)
    row_fail(status, 1, &point->row);
}

dvi_status dvi__point_run(const dvi_study_sweep_options *options, const dvi_study_point *at,
                          dvi__point *point)
{
  *point = (dvi__point){.row = {.report = {.end = DVI_RUN_FAILED, .event = -1},
                                .t = (double)NAN,
                                .energy_error = (double)NAN}};
  point->row.report.event_time = (double)NAN;
  const dvi_status status = options->open(at, &point->run, options->user);
  if (status != DVI_OK) {
    row_fail(status, 1, &point->row);
    return DVI_OK;
  }
  if (point->run.integrator == NULL || point->run.options.cancel != NULL)
    return dvi__fail(DVI_BAD_STATE,
                     "sweep: point %lld: open must give an integrator, and leave cancel NULL",
                     (long long)at->number);
  DVI_TRY(watch_open(&point->run, options->extremes, &point->watch));
  point_advance(options->cancel, point);
  return DVI_OK;
}

void dvi__point_close(const dvi_study_sweep_options *options, dvi__point *point)
{
  if (options->close != NULL)
    options->close(&point->run, options->user);
  else
    dvi_integrator_destroy(&point->run.integrator);
  dvi__release(point->watch.invariant);
  dvi__release(point->watch.least);
  dvi__release(point->watch.most);
}
