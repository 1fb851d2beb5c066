/* The driver of a run. */
#include <dvi/run.h>
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "core/status.h"
#include "integrator/event.h"
#include "integrator/integrator_struct.h"

/* The last step may be longer than h by this part of it. */
static const double stretch = 1e-9;
/* Of more steps a number of double precision does not know how many they are. */
static const double steps_max = 0x1p53;

static dvi_status check_events(const dvi_run_options *options)
{
  if (options->event_count < 0) return dvi__fail(DVI_BAD_ARGUMENT, "run: %d events; 0 or more are possible", options->event_count);
  if (options->event_count > 0 && options->events == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: %d events declared, but their list is NULL", options->event_count);
  if (options->event_count == 0 && options->events != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: a list of events is given, but their count is 0");
  for (int k = 0; k < options->event_count; k++) {
    const dvi_event *event = &options->events[k];
    if (event->value == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "run: event %d has no value callback", k);
    if (event->direction < -1 || event->direction > 1)
      return dvi__fail(DVI_BAD_ARGUMENT, "run: event %d has direction %d; -1, 0 or 1 are possible", k, event->direction);
  }
  return DVI_OK;
}

/* What sums of steps may miss the end by: a few roundings of the times. */
static double clock_error(const dvi_integrator *I, const dvi_run_options *options)
{
  return 16 * DBL_EPSILON * fmax(fabs(options->t_end), fabs(dvi_integrator_time(I)));
}

static dvi_status check(const dvi_integrator *I, const dvi_run_options *options)
{
  if (I == NULL || options == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "run: an argument is NULL");
  if (!I->started) return dvi__fail(DVI_BAD_STATE, "run: the integrator has no state yet; call dvi_integrator_start first");
  const double way = options->t_end - dvi_integrator_time(I);
  if (!isfinite(options->h) || options->h == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: h = %g; a finite step other than 0 is needed", options->h);
  if (!isfinite(options->t_end)) return dvi__fail(DVI_BAD_ARGUMENT, "run: t_end = %g is not finite", options->t_end);
  if (fabs(way) > clock_error(I, options) && (way > 0) != (options->h > 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "run: h = %g leads away from t_end = %g; the time is %g", options->h, options->t_end,
                     dvi_integrator_time(I));
  if (I->pace == NULL && !(fabs(way / options->h) <= steps_max))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "run: h = %g makes %.3g steps to t_end = %g; at most 2^53 can be counted; take a longer step or a nearer end",
                     options->h, way / options->h, options->t_end);
  if (options->every < 0 || options->checkpoint_every < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: every = %ld, checkpoint_every = %ld; 0 or more are possible", options->every,
                     options->checkpoint_every);
  if (options->checkpoint_every > 0 && options->checkpoint == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: checkpoint_every = %ld, but no checkpoint file is named", options->checkpoint_every);
  return check_events(options);
}

static dvi_status observe(dvi_integrator *I, const dvi_run_options *options, dvi_run_report *report, int *stop)
{
  if (options->observe == NULL) return DVI_OK;
  const long steps = I->counters.steps;
  const double t = I->now.t;
  const int returned = options->observe(I, options->user);
  if (I->counters.steps != steps || I->now.t != t)
    return dvi__fail(DVI_BAD_STATE, "run: the observer has moved the integrator from t = %.9g; it may only look at it", t);
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "run: the observer failed with %d at t = %.9g", returned, dvi_integrator_time(I));
  if (returned > 0) {
    report->end = DVI_RUN_STOPPED;
    *stop = 1;
  }
  return DVI_OK;
}

/* The next step's length: h, or what is left of the way, or 0 at its end. An h that divides the way but for the digits that it was given
 * with is stretched in the last step. The clock's carry matters where the time is large: rounded it may miss much of a step. */
static double next_step(const dvi_integrator *I, const dvi_run_options *options)
{
  const double left = (options->t_end - I->now.t) + I->now.t_carry, h = options->h, missed = clock_error(I, options);
  if (fabs(left) <= missed) return 0;
  if (dvi_integrator_chooses_steps(I)) return h;
  if (fabs(left - h) <= missed) return h;
  return left / h <= 1 + stretch ? left : h;
}

/* A step of a method that chooses its length ends the run where it is to end: one that goes past is replaced by an ordinary one of what is left. */
static dvi_status take_step(dvi_integrator *I, const dvi_run_options *options, double h)
{
  const double forward = options->h > 0 ? 1 : -1, left = (options->t_end - I->now.t) + I->now.t_carry;
  if (I->pace != NULL) return dvi__pace_step(I, h, options->t_end, clock_error(I, options));
  if (!dvi_integrator_chooses_steps(I)) return dvi_integrator_step(I, h);
  DVI_TRY(dvi_integrator_step(I, h));
  if (forward * (I->now.t - options->t_end) <= clock_error(I, options)) return DVI_OK;
  dvi__integrator_take_back(I);
  return dvi__integrator_step_exactly(I, left);
}

/* A terminal event ends the run at its own time: the step that holds it is taken again, up to there. */
static dvi_status end_at(dvi_integrator *I, const dvi_run_options *options, dvi_run_report *report)
{
  dvi_run_options there = *options;
  there.t_end = report->event_time;
  if (next_step(I, &there) == 0) return DVI_OK;
  dvi__integrator_take_back(I);
  const double h = next_step(I, &there);
  if (h != 0) return take_step(I, &there, h);
  report->steps--;
  return DVI_OK;
}

static dvi_status one_step(dvi_integrator *I, const dvi_run_options *options, double h, dvi__watch *watch, dvi_run_report *report,
                           int *stop)
{
  const double from = dvi_integrator_time(I);
  const long every = options->every > 0 ? options->every : 1;
  DVI_TRY(take_step(I, options, h));
  const dvi_status found = dvi__watch_find(watch, I, options, from);
  if (found != DVI_OK) return dvi__integrator_undo(I, found);
  report->steps++;
  DVI_TRY(dvi__watch_report(watch, I, options, report, stop));
  if (report->end == DVI_RUN_EVENT) DVI_TRY(end_at(I, options, report));
  if (options->cancel != NULL && *options->cancel && !*stop) {
    report->end = DVI_RUN_CANCELLED;
    *stop = 1;
  }
  if (*stop || report->steps % every == 0 || next_step(I, options) == 0) DVI_TRY(observe(I, options, report, stop));
  if (options->checkpoint != NULL && options->checkpoint_every > 0 && report->steps % options->checkpoint_every == 0)
    return dvi_integrator_save(I, options->checkpoint);
  return DVI_OK;
}

static dvi_status loop(dvi_integrator *I, const dvi_run_options *options, dvi__watch *watch, dvi_run_report *report)
{
  int stop = 0;
  DVI_TRY(observe(I, options, report, &stop));
  for (double h = next_step(I, options); h != 0 && !stop; h = next_step(I, options))
    DVI_TRY(one_step(I, options, h, watch, report, &stop));
  return DVI_OK;
}

/* The last good state is saved even if the run failed; the run's failure is the one that counts. */
static dvi_status save_at_end(const dvi_integrator *I, const char *path, dvi_status status)
{
  char sentence[1024];
  (void)snprintf(sentence, sizeof sentence, "%s", dvi_last_error());
  const dvi_status saved = dvi_integrator_save(I, path);
  if (status == DVI_OK) return saved;
  return saved == DVI_OK ? dvi__fail(status, "%s", sentence) : dvi__fail_in(status, "%s; and then", sentence);
}

dvi_status dvi_run(dvi_integrator *I, const dvi_run_options *options, dvi_run_report *report)
{
  dvi_run_report own, *out = report != NULL ? report : &own;
  dvi__watch watch = {0};
  *out = (dvi_run_report){.end = DVI_RUN_FAILED, .event_time = (double)NAN, .event = -1};
  DVI_TRY(check(I, options));
  DVI_TRY(dvi__watch_create(I, options, &watch));
  out->end = DVI_RUN_COMPLETE;
  dvi_status status = loop(I, options, &watch, out);
  dvi__watch_destroy(&watch);
  if (options->checkpoint != NULL) status = save_at_end(I, options->checkpoint, status);
  if (status != DVI_OK) out->end = DVI_RUN_FAILED;
  return status;
}
