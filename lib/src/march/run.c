/* The loop of a run: steps, events, observers, checkpoints (dvi/run.h). */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "core/status.h"
#include "march/events.h"

/* The last step may be longer than h by this part of h. */
static const double stretch = 1e-9;
/* Doubles count at most this many steps. */
static const double steps_max = 0x1p53;

typedef struct march {
  void *of;
  const dvi__marcher *marcher;
  const dvi__march_options *options;
  dvi__event_search search;
  dvi_run_report *report;
  int stop;
} march;

static double march_time(const march *m)
{
  return m->marcher->time(m->of);
}

double dvi__clock_error(double t, double t_end)
{
  return 16 * DBL_EPSILON * fmax(fabs(t_end), fabs(t));
}

static double clock_error(const march *m, double t_end)
{
  return dvi__clock_error(march_time(m), t_end);
}

static dvi_status check_options(const march *m)
{
  const dvi__march_options *options = m->options;
  const double way = options->t_end - march_time(m);
  if (!isfinite(options->h) || options->h == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: h = %g; a finite step other than 0 is needed",
                     options->h);
  if (!isfinite(options->t_end))
    return dvi__fail(DVI_BAD_ARGUMENT, "run: t_end = %g is not finite", options->t_end);
  if (fabs(way) > clock_error(m, options->t_end) && (way > 0) != (options->h > 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "run: h = %g leads away from t_end = %g; the time is %g",
                     options->h, options->t_end, march_time(m));
  if (options->counts_by_time && !(fabs(way / options->h) <= steps_max))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "run: h = %g makes %.3g steps to t_end = %g; at most 2^53 can be counted; "
                     "take a longer step or a nearer end",
                     options->h, way / options->h, options->t_end);
  if (options->every < 0 || options->checkpoint_every < 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "run: every = %ld, checkpoint_every = %ld; 0 or more are possible",
                     options->every, options->checkpoint_every);
  if (options->checkpoint_every > 0 && options->checkpoint == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "run: checkpoint_every = %ld, but no checkpoint file is named",
                     options->checkpoint_every);
  return DVI_OK;
}

static void end_run(march *m, dvi_run_end end)
{
  m->report->end = end;
  m->stop = 1;
}

static dvi_status march_observe(march *m)
{
  if (m->marcher->observe == NULL) return DVI_OK;
  const long steps = m->marcher->steps(m->of);
  const double t = march_time(m);
  const int returned = m->marcher->observe(m->of);
  if (m->marcher->steps(m->of) != steps || march_time(m) != t)
    return dvi__fail(
        DVI_BAD_STATE,
        "run: the observer has moved the integrator from t = %.9g; it may only look at it", t);
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "run: the observer failed with %d at t = %.9g", returned,
                     t);
  if (returned > 0) end_run(m, DVI_RUN_STOPPED);
  return DVI_OK;
}

/* Return the next step's length: h, or the rest of the interval, or 0 at its end. If h divides the
 * interval up to the digits of h, the last step is stretched. */
static double next_step(const march *m, double t_end)
{
  const double left = m->marcher->left(m->of, t_end), h = m->options->h,
               missed = clock_error(m, t_end);
  if (fabs(left) <= missed) return 0;
  if (m->options->chooses_steps) return h;
  if (fabs(left - h) <= missed) return h;
  return left / h <= 1 + stretch ? left : h;
}

static dvi_status march_advance(march *m, double h, double t_end)
{
  return m->marcher->advance(m->of, h, t_end, clock_error(m, t_end));
}

/* End the run at the time of a terminal event. The step that contains the event is taken again, up
 * to that time. */
static dvi_status end_at_event(march *m)
{
  const double t_end = m->report->event_time;
  if (next_step(m, t_end) == 0) return DVI_OK;
  m->marcher->take_back(m->of);
  const double h = next_step(m, t_end);
  const dvi_status status = h != 0 ? march_advance(m, h, t_end) : DVI_OK;
  if (h == 0 || status != DVI_OK) m->report->steps--;
  return status;
}

static dvi_status find_events(march *m, double from)
{
  const dvi_status found = dvi__event_search_find(&m->search, from);
  if (found == DVI_OK) return DVI_OK;
  return m->marcher->reject(m->of, found);
}

static dvi_status march_one_step(march *m, double h)
{
  const dvi__march_options *options = m->options;
  const double from = march_time(m);
  const long every = options->every > 0 ? options->every : 1;
  DVI_TRY(march_advance(m, h, options->t_end));
  DVI_TRY(find_events(m, from));
  m->report->steps++;
  DVI_TRY(dvi__event_search_report(&m->search, options->h > 0, m->report, &m->stop));
  if (m->report->end == DVI_RUN_EVENT) DVI_TRY(end_at_event(m));
  if (options->cancel != NULL && *options->cancel && !m->stop) end_run(m, DVI_RUN_CANCELLED);
  if (m->stop || m->report->steps % every == 0 || next_step(m, options->t_end) == 0)
    DVI_TRY(march_observe(m));
  if (options->checkpoint != NULL && options->checkpoint_every > 0 &&
      m->report->steps % options->checkpoint_every == 0)
    return m->marcher->save(m->of, options->checkpoint);
  return DVI_OK;
}

/* Return the steps that may be taken before one after which something is looked at, each as long as
 * h. */
static long steps_unobserved(const march *m, double h)
{
  const dvi__march_options *options = m->options;
  const long every = options->every > 0 ? options->every : 1, done = m->report->steps;
  const double left = floor(m->marcher->left(m->of, options->t_end) / h) - 2;
  long count = left < INT_MAX ? (long)left : INT_MAX;
  if (options->event_count > 0 || options->chooses_steps || h != options->h) return 0;
  if (m->marcher->observe != NULL && !m->marcher->keeps_rows && every - done % every < count)
    count = every - done % every;
  if (options->checkpoint != NULL && options->checkpoint_every > 0 &&
      options->checkpoint_every - done % options->checkpoint_every < count)
    count = options->checkpoint_every - done % options->checkpoint_every;
  return count - 1;
}

static dvi_status march_together(march *m, double h)
{
  const long count = m->marcher->advance_together != NULL ? steps_unobserved(m, h) : 0;
  long taken = 0;
  if (count <= 1) return DVI_OK;
  const dvi_status status = m->marcher->advance_together(m->of, h, count, &taken);
  m->report->steps += taken;
  return status;
}

static dvi_status march_all_steps(march *m)
{
  const double t_end = m->options->t_end;
  DVI_TRY(march_observe(m));
  for (double h = next_step(m, t_end); h != 0 && !m->stop; h = next_step(m, t_end)) {
    DVI_TRY(march_together(m, h));
    DVI_TRY(march_one_step(m, h));
  }
  return DVI_OK;
}

/* Save the last good state, even if the run failed. The run's failure takes precedence over one of
 * saving. */
static dvi_status save_at_end(const march *m, dvi_status status)
{
  char sentence[1024];
  (void)snprintf(sentence, sizeof sentence, "%s", dvi_last_error());
  const dvi_status saved = m->marcher->save(m->of, m->options->checkpoint);
  if (status == DVI_OK) return saved;
  return saved == DVI_OK ? dvi__fail(status, "%s", sentence)
                         : dvi__fail_in(status, "%s; and then", sentence);
}

dvi_status dvi__march(void *of, const dvi__marcher *marcher, const dvi__march_options *options,
                      dvi_run_report *report)
{
  march m = {.of = of, .marcher = marcher, .options = options, .report = report};
  DVI_TRY(check_options(&m));
  DVI_TRY(dvi__event_search_create(of, marcher, options->event_count, &m.search));
  report->end = DVI_RUN_COMPLETE;
  dvi_status status = march_all_steps(&m);
  dvi__event_search_clear(&m.search);
  if (options->checkpoint != NULL) status = save_at_end(&m, status);
  if (status != DVI_OK) report->end = DVI_RUN_FAILED;
  return status;
}
