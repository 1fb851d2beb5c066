/* Recordings of runs. An observer of dvi_run keeps the rows, and events in front of those of the
 * program keep what they find. Where nothing else looks at the steps, they are taken together, and
 * their states go into the rows at once. */
#include <dvi/run.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "integrator/run.h"
#include "record/recording.h"
#include "system/evaluate/dynamics.h"

enum {
  KNOWN_PARTS = (1 << DVI__ROW_A) - 1,
  /* parts that rows at given times may have */
  PATH_PARTS = DVI_RECORD_T | DVI_RECORD_Q | DVI_RECORD_P | DVI_RECORD_V | DVI_RECORD_INVARIANTS |
               DVI_RECORD_STEP
};

/* An event of the program. */
typedef struct watched_event {
  struct record *record;
  const dvi_event *event;
  int index;
} watched_event;

typedef struct record {
  dvi_integrator *integrator;
  const dvi_system *system;
  const dvi_run_options *run;
  dvi_record_options options;
  dvi_recording *recording;
  dvi_event *event;       /* [run->event_count] the events of the run below */
  watched_event *watched; /* [run->event_count] */
  double *point;          /* [nq+2*nv] q, v and p of the path at a given time */
  int64_t times_done;
  long visits;       /* of the observer: the start, and every step where times are given */
  int ended;         /* an event ends the run */
  dvi_status status; /* of a row or an event that failed, and its sentence */
  char sentence[DVI__SENTENCE_SIZE];
} record;

/* ---- rows ---- */

/* Remember why a row or an event was not kept, and end the run. */
static int refuse(record *r, dvi_status status, const char *what)
{
  r->status = status;
  (void)snprintf(r->sentence, sizeof r->sentence, "record: no %s at t = %.9g: %s", what,
                 dvi_integrator_time(r->integrator), dvi_last_error());
  return -1;
}

static void copy_part(const record *r, dvi__row_part part, int count, const double *from)
{
  double *row = dvi__recording_row(r->recording, part);
  if (row != NULL) memcpy(row, from, (size_t)count * sizeof *row);
}

static void set_part(const record *r, dvi__row_part part, double number)
{
  double *row = dvi__recording_row(r->recording, part);
  if (row != NULL) *row = number;
}

/* Evaluate what the state alone does not have. */
static dvi_status measure_state(const record *r)
{
  dvi_integrator *I = r->integrator;
  double *v = dvi__recording_row(r->recording, DVI__ROW_V),
         *invariants = dvi__recording_row(r->recording, DVI__ROW_INVARIANTS),
         *constraint = dvi__recording_row(r->recording, DVI__ROW_CONSTRAINT),
         *reactions = dvi__recording_row(r->recording, DVI__ROW_REACTIONS);
  if (v != NULL) DVI_TRY(dvi__integrator_velocity(I, v));
  if (invariants != NULL) DVI_TRY(dvi_integrator_invariants(I, invariants));
  if (constraint != NULL) DVI_TRY(dvi_integrator_constraint(I, constraint));
  if (reactions != NULL) DVI_TRY(dvi_integrator_reactions(I, reactions));
  return DVI_OK;
}

/* Keep the present state, with the time t. */
static dvi_status record_state(const record *r, double t)
{
  const dvi_integrator *I = r->integrator;
  DVI_TRY(dvi__recording_open_rows(r->recording, 1));
  set_part(r, DVI__ROW_T, t);
  set_part(r, DVI__ROW_STEP, dvi_integrator_last_step(I));
  copy_part(r, DVI__ROW_Q, r->recording->nq, dvi_integrator_q(I));
  copy_part(r, DVI__ROW_P, r->recording->nv, dvi_integrator_p(I));
  DVI_TRY(measure_state(r));
  r->recording->rows++;
  return DVI_OK;
}

/* Keep the point of the last step's path at t. */
static dvi_status record_point(const record *r, double t)
{
  const int nq = r->recording->nq, nv = r->recording->nv;
  double *q = r->point, *v = q + nq, *p = v + nv;
  double *invariants = dvi__recording_row(r->recording, DVI__ROW_INVARIANTS);
  DVI_TRY(dvi_integrator_interpolate(r->integrator, t, q, v));
  if (invariants != NULL || dvi__recording_row(r->recording, DVI__ROW_P) != NULL)
    DVI_TRY(dvi_system_momentum(r->system, t, q, v, p));
  set_part(r, DVI__ROW_T, t);
  set_part(r, DVI__ROW_STEP, dvi_integrator_last_step(r->integrator));
  copy_part(r, DVI__ROW_Q, nq, q);
  copy_part(r, DVI__ROW_V, nv, v);
  copy_part(r, DVI__ROW_P, nv, p);
  if (invariants != NULL) DVI_TRY(dvi_system_invariants(r->system, t, q, p, invariants));
  r->recording->rows++;
  return DVI_OK;
}

/* Keep the points of the last step's path at the given times, in the run's direction. The start is
 * the present state, and the end, too, where the sum of the steps misses given times by roundings.
 */
static dvi_status record_times(record *r)
{
  const double now = dvi_integrator_time(r->integrator), forward = r->run->h > 0 ? 1 : -1;
  const int at_end = dvi__run_is_at_end(r->integrator, r->run->t_end);
  for (; r->times_done < r->options.time_count; r->times_done++) {
    const double t = r->options.times[r->times_done], ahead = forward * (t - now);
    if (ahead > 0 && !at_end) return DVI_OK;
    DVI_TRY(dvi__recording_open_rows(r->recording, 1));
    DVI_TRY(ahead < 0 ? record_point(r, t) : record_state(r, ahead > 0 ? t : now));
  }
  return DVI_OK;
}

/* ---- rows of steps that are taken together ---- */

/* Parts that follow from time, coordinates and momenta, or from the step of the run. */
enum {
  TRAIL_PARTS = DVI_RECORD_T | DVI_RECORD_Q | DVI_RECORD_P | DVI_RECORD_V | DVI_RECORD_INVARIANTS |
                DVI_RECORD_STEP
};

/* Tell whether nothing but rows is wanted between steps, of parts that follow from the states. */
static int keeps_trails(const record *r)
{
  const unsigned parts = r->options.parts, derived = DVI_RECORD_V | DVI_RECORD_INVARIANTS;
  return r->run->observe == NULL && r->run->event_count == 0 && r->options.times == NULL &&
         (parts & ~(unsigned)TRAIL_PARTS) == 0 &&
         ((parts & derived) == 0 || ((parts & DVI_RECORD_Q) != 0 && (parts & DVI_RECORD_P) != 0 &&
                                     !r->system->dynamics->searches_velocity));
}

static dvi_status open_trail(void *user, dvi__trail *trail)
{
  const record *r = user;
  DVI_TRY(dvi__recording_open_rows(r->recording, DVI__TOGETHER));
  trail->t = dvi__recording_row(r->recording, DVI__ROW_T);
  trail->q = dvi__recording_row(r->recording, DVI__ROW_Q);
  trail->p = dvi__recording_row(r->recording, DVI__ROW_P);
  return DVI_OK;
}

/* Evaluate the parts of the open row that follow from its state, as measure_state does. */
static dvi_status derive_row(const record *r)
{
  dvi_recording *made = r->recording;
  double *v = dvi__recording_row(made, DVI__ROW_V),
         *invariants = dvi__recording_row(made, DVI__ROW_INVARIANTS);
  set_part(r, DVI__ROW_STEP, r->run->h);
  if (v == NULL && invariants == NULL) return DVI_OK;
  return dvi__recording_derive_row(made, made->rows, r->integrator->evaluator,
                                   v != NULL ? v : r->point, invariants);
}

static dvi_status close_trail(void *user, const dvi__trail *trail)
{
  record *r = user;
  for (long k = 0; k < trail->rows; k++) {
    const dvi_status status = derive_row(r);
    if (status != DVI_OK) {
      (void)refuse(r, status, "row");
      return status;
    }
    r->recording->rows++;
  }
  return DVI_OK;
}

/* ---- the run ---- */

/* Keep the present state, unless the last row has it: a step is taken back if a terminal event
 * occurs at its start but for roundings. */
static dvi_status record_visit(const record *r)
{
  const dvi_recording *made = r->recording;
  const double now = dvi_integrator_time(r->integrator);
  if (made->rows > 0 && made->part[DVI__ROW_T].number[made->rows - 1] == now) return DVI_OK;
  return record_state(r, now);
}

/* Tell whether the run calls no observer after this one. */
static int is_last_visit(const record *r)
{
  return r->ended || (r->run->cancel != NULL && *r->run->cancel) ||
         dvi__run_is_at_end(r->integrator, r->run->t_end);
}

static int record_observe(dvi_integrator *integrator, void *user)
{
  record *r = user;
  const long every = r->options.times != NULL && r->run->every > 0 ? r->run->every : 1;
  const dvi_status status = r->options.times != NULL ? record_times(r) : record_visit(r);
  if (status != DVI_OK) return refuse(r, status, "row");
  if (r->run->observe == NULL) return 0;
  return r->visits++ % every == 0 || is_last_visit(r) ? r->run->observe(integrator, r->run->user)
                                                      : 0;
}

static int watched_value(double t, const double *q, const double *v, double *g, void *user)
{
  const dvi_event *event = ((const watched_event *)user)->event;
  return event->value(t, q, v, g, event->user);
}

static int watched_occurred(double t, const double *q, const double *v, void *user)
{
  const watched_event *w = user;
  const dvi_status status = dvi__recording_add_event(w->record->recording, w->index, t, q, v);
  if (status != DVI_OK) return refuse(w->record, status, "event");
  const int returned = w->event->occurred != NULL ? w->event->occurred(t, q, v, w->event->user) : 0;
  w->record->ended = w->event->terminal || returned > 0;
  return returned;
}

static void watch_events(record *r)
{
  for (int k = 0; k < r->run->event_count; k++) {
    r->watched[k] = (watched_event){.record = r, .event = &r->run->events[k], .index = k};
    r->event[k] = r->run->events[k];
    if (r->event[k].value != NULL) r->event[k].value = watched_value;
    r->event[k].occurred = watched_occurred;
    r->event[k].user = &r->watched[k];
  }
}

static dvi_status run_recorded(record *r)
{
  dvi_run_options run = *r->run;
  run.observe = record_observe;
  run.user = r;
  if (r->options.times != NULL) run.every = 1;
  if (run.event_count > 0 && run.events != NULL) {
    watch_events(r);
    run.events = r->event;
  }
  const dvi__keeper keeper = {open_trail, close_trail, r};
  const dvi_status status = dvi__run(r->integrator, &run, keeps_trails(r) ? &keeper : NULL,
                                     &r->recording->report);
  return r->status != DVI_OK ? dvi__fail(r->status, "%s", r->sentence) : status;
}

/* ---- what is asked for ---- */

static dvi_status check_parts(const record *r)
{
  const unsigned parts = r->options.parts, of_momenta = DVI_RECORD_P | DVI_RECORD_INVARIANTS;
  if ((parts & ~(unsigned)KNOWN_PARTS) != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "record: parts = %#x has unknown ones; %#x are all", parts,
                     (unsigned)KNOWN_PARTS);
  if ((parts & DVI_RECORD_REACTIONS) != 0 && dvi_system_constraint_count(r->system) == 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "record: reactions: the system has neither holonomic nor nonholonomic "
                     "constraints");
  if (r->options.times != NULL && (parts & of_momenta) != 0 && r->system->dynamics->by_momentum)
    return dvi__fail(DVI_UNSUPPORTED,
                     "record: momenta and invariants of a Hamiltonian have no rows at given times; "
                     "record coordinates and velocities there, or rows after steps");
  if (r->options.times != NULL && (parts & ~(unsigned)PATH_PARTS) != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "record: constraint and reactions have no rows at given times; record them "
                     "after steps");
  return DVI_OK;
}

static dvi_status check_times(const record *r)
{
  const int64_t count = r->options.time_count;
  const double *t = r->options.times, forward = r->run->h > 0 ? 1 : -1;
  if (count < 0 || (count > 0) != (t != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "record: %lld times, and their list is %s", (long long)count,
                     t != NULL ? "given" : "NULL");
  for (int64_t k = 0; k < count; k++) {
    const double before = k > 0 ? t[k - 1] : dvi_integrator_time(r->integrator);
    if (!isfinite(t[k]) || forward * (t[k] - before) < 0 || forward * (r->run->t_end - t[k]) < 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "record: time %lld is %.17g; times must go on from %.17g to %.17g",
                       (long long)k, t[k], before, r->run->t_end);
  }
  return DVI_OK;
}

/* Count the rows to reserve: those of the run if its steps are known. */
static int64_t rows_expected(const record *r)
{
  const double every = r->run->every > 0 ? (double)r->run->every : 1,
               way = r->run->t_end - dvi_integrator_time(r->integrator),
               rows = floor(way / r->run->h / every) + 3 + DVI__TOGETHER,
               most = DVI__MOST_RESERVED / dvi__row_width(r->system, r->options.parts);
  if (r->options.times != NULL) return r->options.time_count;
  if (dvi_integrator_chooses_steps(r->integrator) || !(rows >= 3 && rows <= most))
    return DVI__FIRST_ROWS;
  return (int64_t)rows;
}

static dvi_status reserve(record *r)
{
  const size_t events = r->run->event_count > 0 ? (size_t)r->run->event_count : 0;
  r->event = DVI_NEW(dvi_event, events);
  r->watched = DVI_NEW(watched_event, events);
  r->point = DVI_NEW(double, dvi_system_nq(r->system) + 2 * dvi_system_nv(r->system));
  if (r->event == NULL || r->watched == NULL || r->point == NULL)
    return dvi__fail(DVI_NO_MEMORY, "record: no memory for %zu events and a point", events);
  return dvi__recording_create(r->system, r->options.parts, rows_expected(r), &r->recording);
}

static void release(record *r)
{
  dvi__release(r->event);
  dvi__release(r->watched);
  dvi__release(r->point);
}

dvi_status dvi_record(dvi_integrator *integrator, const dvi_run_options *run,
                      const dvi_record_options *options, dvi_recording **recording)
{
  if (recording == NULL || integrator == NULL || run == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "record: an argument is NULL");
  *recording = NULL;
  record r = {.integrator = integrator, .system = dvi_integrator_system(integrator), .run = run};
  if (options != NULL) r.options = *options;
  if (r.options.parts == 0) r.options.parts = DVI_RECORD_Q | DVI_RECORD_P;
  r.options.parts |= DVI_RECORD_T;
  if (options != NULL && options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "record: set options.size to sizeof(dvi_record_options)");
  DVI_TRY(check_parts(&r));
  DVI_TRY(check_times(&r));
  dvi_status status = reserve(&r);
  if (status == DVI_OK) status = run_recorded(&r);
  release(&r);
  *recording = r.recording;
  return status;
}
