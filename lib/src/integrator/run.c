/* A run of an integrator. These functions give the loop of room march an integrator's coordinates
 * and velocities. */
#include "integrator/run.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "march/march.h"

typedef struct mechanics {
  dvi_integrator *integrator;
  const dvi_run_options *options;
  const dvi__keeper *keeper; /* of rows, or NULL */
  long first;                /* number of steps before the run */
  double *q, *v;             /* [nq], [nv] at an event */
} mechanics;

static double mechanics_time(const void *of)
{
  return dvi_integrator_time(((const mechanics *)of)->integrator);
}

/* Return the time left, with the clock's compensation. At large times rounding is a large part of a
 * step. */
static double time_left(const dvi_integrator *I, double t_end)
{
  return (t_end - I->now.t) + I->now.t_compensation;
}

static double mechanics_time_left(const void *of, double t_end)
{
  return time_left(((const mechanics *)of)->integrator, t_end);
}

int dvi__run_is_at_end(const dvi_integrator *I, double t_end)
{
  return fabs(time_left(I, t_end)) <= dvi__clock_error(I->now.t, t_end);
}

static long mechanics_steps(const void *of)
{
  return ((const mechanics *)of)->integrator->counters.steps;
}

/* Take a step that does not pass t_end. If a method that chooses its steps goes past t_end, the
 * step is replaced by an ordinary one of the time left. */
static dvi_status mechanics_advance(void *of, double h, double t_end, double tolerance)
{
  dvi_integrator *I = ((const mechanics *)of)->integrator;
  const double forward = h > 0 ? 1 : -1, left = mechanics_time_left(of, t_end);
  if (I->monitored != NULL) return dvi__monitored_time_step(I, h, t_end, tolerance);
  DVI_TRY(dvi_integrator_step(I, h));
  if (!dvi_integrator_chooses_steps(I)) return DVI_OK;
  if (forward * (I->now.t - t_end) <= tolerance) return DVI_OK;
  dvi__integrator_take_back(I);
  return dvi__integrator_step_exactly(I, left);
}

/* Rows are kept of the steps that a failure leaves, too. */
static dvi_status advance_with_rows(const mechanics *m, double h, long count, long *taken)
{
  dvi_integrator *I = m->integrator;
  const long every = m->options->every > 0 ? m->options->every : 1;
  dvi__trail trail = {.nq = dvi_system_nq(I->system),
                      .nv = I->system->n,
                      .every = every,
                      .wait = every - (I->counters.steps - m->first) % every};
  DVI_TRY(m->keeper->open(m->keeper->user, &trail));
  I->stepper.trail = &trail;
  const dvi_status status = dvi__integrator_steps(I, h, count, taken);
  I->stepper.trail = NULL;
  DVI_TRY(m->keeper->close(m->keeper->user, &trail));
  return status;
}

static dvi_status mechanics_advance_together(void *of, double h, long count, long *taken)
{
  const mechanics *m = of;
  if (m->keeper != NULL) return advance_with_rows(m, h, count, taken);
  return dvi__integrator_steps(m->integrator, h, count, taken);
}

static void mechanics_take_back(void *of)
{
  dvi__integrator_take_back(((const mechanics *)of)->integrator);
}

static dvi_status mechanics_reject(void *of, dvi_status status)
{
  return dvi__integrator_undo(((const mechanics *)of)->integrator, status);
}

static int mechanics_observe(void *of)
{
  const mechanics *m = of;
  return m->options->observe(m->integrator, m->options->user);
}

static dvi_status mechanics_save(const void *of, const char *path)
{
  return dvi_integrator_save(((const mechanics *)of)->integrator, path);
}

/* ---- events ---- */

static const char *event_name(const dvi_event *event)
{
  return event->name != NULL ? event->name : "unnamed";
}

static dvi__watched mechanics_event(const void *of, int k)
{
  const dvi_event *event = &((const mechanics *)of)->options->events[k];
  return (dvi__watched){.direction = event->direction, .terminal = event->terminal};
}

static dvi_status event_callback_value(const dvi_event *event, double t, const double *q,
                                       const double *v, double *g)
{
  const int returned = event->value(t, q, v, g, event->user);
  if (returned != 0)
    return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
                     "event '%s': the callback returned %d at t = %.9g", event_name(event),
                     returned, t);
  return isfinite(*g)
             ? DVI_OK
             : dvi__fail(DVI_NOT_FINITE, "event '%s' is %g at t = %.9g", event_name(event), *g, t);
}

/* Evaluate an event on the last step's path. */
static dvi_status event_value_on_path(void *of, int k, double t, double *g)
{
  const mechanics *m = of;
  DVI_TRY(dvi_integrator_interpolate(m->integrator, t, m->q, m->v));
  return event_callback_value(&m->options->events[k], t, m->q, m->v, g);
}

/* Evaluate an event at the present state. There is no step yet to interpolate on. */
static dvi_status event_value_at_start(void *of, int k, double *g)
{
  const mechanics *m = of;
  const dvi_integrator *I = m->integrator;
  const size_t n = (size_t)I->system->nv;
  for (size_t i = 0; i < n; i++) m->v[i] = 0;
  DVI_TRY(dvi_system_velocity(I->system, I->now.t, I->now.q, I->now.p, m->v));
  return event_callback_value(&m->options->events[k], I->now.t, I->now.q, m->v, g);
}

static dvi_status event_occurred(void *of, int k, double t, int *returned)
{
  const mechanics *m = of;
  const dvi_event *event = &m->options->events[k];
  if (event->occurred == NULL) return DVI_OK;
  DVI_TRY(dvi_integrator_interpolate(m->integrator, t, m->q, m->v));
  *returned = event->occurred(t, m->q, m->v, event->user);
  if (*returned >= 0) return DVI_OK;
  return dvi__fail(DVI_CALLBACK_FAILED, "event '%s': the callback at t = %.9g failed with %d",
                   event_name(event), t, *returned);
}

static dvi_status check_run_events(const dvi_run_options *options)
{
  if (options->event_count < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: %d events; 0 or more are possible",
                     options->event_count);
  if (options->event_count > 0 && options->events == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: %d events declared, but their list is NULL",
                     options->event_count);
  if (options->event_count == 0 && options->events != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "run: a list of events is given, but their count is 0");
  for (int k = 0; k < options->event_count; k++) {
    const dvi_event *event = &options->events[k];
    if (event->value == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "run: event %d has no value callback", k);
    if (event->direction < -1 || event->direction > 1)
      return dvi__fail(DVI_BAD_ARGUMENT, "run: event %d has direction %d; -1, 0 or 1 are possible",
                       k, event->direction);
  }
  return DVI_OK;
}

/* ---- a run ---- */

/* Tell whether steps may be taken together. If the run may be cancelled, only passes are, and steps
 * with rows. */
static int can_advance_together(const mechanics *m)
{
  const dvi_integrator *I = m->integrator;
  return I->stepper.method->pass != NULL ||
         (I->monitored == NULL && !dvi_integrator_chooses_steps(I) &&
          (m->options->cancel == NULL || m->keeper != NULL));
}

static dvi_status mechanics_run(mechanics *m, dvi_run_report *report)
{
  const dvi_integrator *I = m->integrator;
  const dvi_run_options *given = m->options;
  const dvi__marcher marcher = {
      .time = mechanics_time,
      .left = mechanics_time_left,
      .steps = mechanics_steps,
      .advance = mechanics_advance,
      .advance_together = can_advance_together(m) ? mechanics_advance_together : NULL,
      .take_back = mechanics_take_back,
      .reject = mechanics_reject,
      .event = mechanics_event,
      .value = event_value_on_path,
      .value_at_start = event_value_at_start,
      .occurred = event_occurred,
      .observe = given->observe != NULL ? mechanics_observe : NULL,
      .keeps_rows = m->keeper != NULL,
      .save = mechanics_save};
  const dvi__march_options options = {.h = given->h,
                                      .t_end = given->t_end,
                                      .chooses_steps = dvi_integrator_chooses_steps(I),
                                      .counts_by_time = I->monitored == NULL,
                                      .every = given->every,
                                      .event_count = given->event_count,
                                      .checkpoint = given->checkpoint,
                                      .checkpoint_every = given->checkpoint_every,
                                      .cancel = given->cancel};
  return dvi__march(m, &marcher, &options, report);
}

static dvi_status mechanics_reserve(mechanics *m)
{
  if (m->options->event_count == 0) return DVI_OK;
  m->q = DVI_NEW(double, m->integrator->system->n);
  m->v = DVI_NEW(double, m->integrator->system->n);
  if (m->q != NULL && m->v != NULL) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "run: no memory for %d events", m->options->event_count);
}

dvi_status dvi_run(dvi_integrator *I, const dvi_run_options *options, dvi_run_report *report)
{
  return dvi__run(I, options, NULL, report);
}

dvi_status dvi__run(dvi_integrator *I, const dvi_run_options *options, const dvi__keeper *keeper,
                    dvi_run_report *report)
{
  dvi_run_report own, *out = report != NULL ? report : &own;
  mechanics m = {.integrator = I, .options = options, .keeper = keeper};
  *out = (dvi_run_report){.end = DVI_RUN_FAILED, .event_time = (double)NAN, .event = -1};
  if (I == NULL || options == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "run: an argument is NULL");
  if (!I->started)
    return dvi__fail(DVI_BAD_STATE,
                     "run: the integrator has no state yet; call dvi_integrator_start first");
  DVI_TRY(check_run_events(options));
  m.first = I->counters.steps;
  dvi_status status = mechanics_reserve(&m);
  if (status == DVI_OK) status = mechanics_run(&m, out);
  dvi__release(m.q);
  dvi__release(m.v);
  return status;
}
