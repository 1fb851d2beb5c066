#include "watch/recorder.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "watch/alarms.h"
#include "csv/columns.h"
#include "cli/command.h"
#include "watch/energy_report.h"
#include "watch/energy_watch.h"
#include "watch/growth_watch.h"
#include "csv/events.h"
#include "cli/file.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/field.h"
#include "load/moving.h"
#include "watch/field_map.h"
#include "frames/frames.h"
#include "watch/run_end.h"
#include "watch/run_head.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "plot/trace.h"
#include "store/row_output.h"

enum { NAME_SIZE = 256 };

/* The state of a run. */
typedef struct recorder {
  const run_request *request;
  const problem *scene;
  row_output out;
  whole_file events_out;
  run_head head;
  run_columns columns;
  event_list events;
  long hits[3]; /* hits, holds and releases of contacts */
  alarm_list alarms;
  run_trace trace;
  frame_list frames;
  const dvi_field *field; /* of which frames are written */
  density_views views;    /* or of a density */
  double *form;           /* [cells] values of the field, or coefficients of the density */
  field_map map;
  progress_line progress;
  double t_start, t;        /* start of the run, and end of the last observed step */
  double shortest, longest; /* steps of methods that choose them, 0 before the first */
  energy_watch watch;
  growth_watch growth;
  long steps_taken, given_steps;
  /* number counted from t = 0, so that a resumed run writes the rows of an uninterrupted one */
  long step;
  bool chooses; /* the method chooses its steps */
  long taken;   /* steps of this run */
  bool begun, row_written, stop_silently;
  const volatile sig_atomic_t *caught; /* signal that ends the run after its step, or 0 */
} recorder;

/* Write the components of a field with a density. */
static bool recorder_write_components(recorder *r, const dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator);
  const dvi_status status = dvi_density_lift(density_of(r->scene), t, dvi_integrator_q(integrator),
                                             r->form);
  return (status == DVI_OK || library_error(status) == DONE) &&
         density_views_fill(&r->views, r->form) == DONE &&
         frames_add(&r->frames, t, r->views.count, r->views.view);
}

/* Write the field on a mesh that moves, with the nodes where they are. */
static bool recorder_write_nodes(recorder *r, const dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator);
  moving_views now;
  bool good = moving_views_make(r->scene, t, dvi_integrator_q(integrator), &now) == DONE;
  frames_move(&r->frames, now.mesh, dvi_mesh_points(now.mesh));
  good = good && frames_add(&r->frames, t, now.count, now.view);
  moving_views_clear(&now);
  return good;
}

/* Write a solid, with the nodes where they are. */
static bool recorder_write_solid(recorder *r, const dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator);
  elastic_views now;
  bool good = elastic_views_of_state(r->scene, t, dvi_integrator_q(integrator),
                                     dvi_integrator_p(integrator), &now) == DONE;
  frames_move(&r->frames, r->frames.mesh, now.point);
  good = good && frames_add(&r->frames, t, now.count, now.view);
  elastic_views_clear(&now);
  return good;
}

/* Write the field of a state, in its cells if it is Maxwell's. */
static bool recorder_write_frame(recorder *r, const dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator);
  if (!frames_are_wanted(&r->frames)) return true;
  if (density_of(r->scene) != NULL) return recorder_write_components(r, integrator);
  if (dvi_scene_moving(r->scene->scene) != NULL) return recorder_write_nodes(r, integrator);
  if (elastic_of(r->scene) != NULL) return recorder_write_solid(r, integrator);
  field_view view;
  (void)dvi_field_lift(r->field, dvi_integrator_q(integrator), r->form);
  const bool good = field_view_make(r->field, dvi_field_degree(r->field) == 0 ? "u" : "A", r->form,
                                    &view) == DONE &&
                    frames_add(&r->frames, t, 1, &view.view);
  field_view_clear(&view);
  return good;
}

static bool recorder_write_row(recorder *r, dvi_integrator *integrator)
{
  columns_row(&r->columns, integrator, r->out.row);
  r->row_written = true;
  return row_output_add(&r->out) && recorder_write_frame(r, integrator);
}

/* Write an event that was found. */
static int recorder_write_event(int index, double t, const double *q, const double *v, void *user)
{
  recorder *r = user;
  if (r->events_out.stream == NULL) return 0;
  events_row(r->scene, r->events.event[index].name, t, q, v, r->events_out.stream);
  r->stop_silently = !run_file_is_good(&r->events_out);
  return r->stop_silently ? -1 : 0;
}

/* Write the hits of the last step, with the velocities before them. */
static bool recorder_write_hits(recorder *r, dvi_integrator *integrator)
{
  static const char *const suffix[] = {"", "_held", "_released"};
  const int count = dvi_integrator_hit_count(integrator);
  for (int i = 0; i < count; i++) r->hits[dvi_integrator_hit(integrator, i).kind]++;
  if (count == 0 || r->events_out.stream == NULL) return true;
  double *q = calloc(2 * (size_t)r->scene->nq, sizeof *q), *v = q + r->scene->nq;
  bool good = q != NULL;
  for (int i = 0; i < count && good; i++) {
    const dvi_hit hit = dvi_integrator_hit(integrator, i);
    good = dvi_integrator_interpolate(integrator, hit.t, q, v) == DVI_OK;
    char name[NAME_SIZE];
    (void)snprintf(name, sizeof name, "%s%s",
                   dvi_system_contact_name(r->scene->system, hit.contact), suffix[hit.kind]);
    if (good) events_row(r->scene, name, hit.t, q, v, r->events_out.stream);
  }
  free(q);
  return good && run_file_is_good(&r->events_out);
}

static void tell_hits(const recorder *r)
{
  const long *n = r->hits;
  if (n[DVI_HOLD] > 0)
    complain("run: contacts: %ld hit%s, %ld hold%s, %ld release%s", n[0], n[0] == 1 ? "" : "s",
             n[1], n[1] == 1 ? "" : "s", n[2], n[2] == 1 ? "" : "s");
  else if (n[DVI_HIT] > 0)
    complain("run: contacts: %ld hit%s", n[0], n[0] == 1 ? "" : "s");
}

/* A run that appends its rows to those of another one begins as an uninterrupted run would go
 * on. */
static bool row_is_due(const recorder *r)
{
  if (r->request->final || (!r->begun && r->out.has_row)) return false;
  return (!r->begun && !r->out.is_appended) || r->step % r->request->every == 0;
}

/* A checkpoint is saved after this step, and the rows up to it must not be lost. */
static bool flush_is_due(const recorder *r)
{
  const long every = r->request->checkpoint_every;
  return every > 0 && r->taken > 0 && r->taken % every == 0;
}

/* Note the lengths that the method chose, without the step that ends the run on time. */
static void note_step(recorder *r, const dvi_integrator *integrator)
{
  const double length = fabs(dvi_integrator_last_step(integrator));
  dvi_energy_balance energy = {0};
  (void)dvi_integrator_energy_balance(integrator, &energy);
  if (energy.given_steps > r->given_steps) {
    r->given_steps = energy.given_steps;
    return;
  }
  r->shortest = r->steps_taken == 0 ? length : fmin(r->shortest, length);
  r->longest = fmax(r->longest, length);
  r->steps_taken++;
}

/* Record a state. The driver calls this function at the start, after each step, and once more at
 * the end. */
static int recorder_observe(dvi_integrator *integrator, void *user)
{
  recorder *r = user;
  const double t = dvi_integrator_time(integrator);
  if (r->begun && t == r->t) return 0;
  r->t = t;
  r->step += r->begun;
  if (r->begun) energy_watch_step(&r->watch);
  if (r->begun) growth_watch_step(&r->growth);
  if (r->begun && !recorder_write_hits(r, integrator)) r->stop_silently = true;
  if (r->chooses && r->begun) note_step(r, integrator);
  r->taken += r->begun;
  r->row_written = !r->begun && r->out.has_row;
  const bool row = row_is_due(r);
  r->begun = true;
  bool good = !r->stop_silently;
  if (good && (row || r->trace.t != NULL)) good = columns_measure(&r->columns, integrator);
  if (good && row) good = recorder_write_row(r, integrator);
  if (good && flush_is_due(r)) good = row_output_flush(&r->out);
  if (good) good = alarms_look(&r->alarms, integrator);
  if (good && r->trace.t != NULL) trace_add(&r->trace, integrator);
  if (good)
    good = field_map_add_state(&r->map, t, dvi_integrator_q(integrator),
                               dvi_integrator_p(integrator));
  if (r->progress.shown)
    progress_show(&r->progress, (t - r->t_start) / (r->request->t_end - r->t_start), "dvi run");
  r->stop_silently = !good;
  return good ? 0 : -1;
}

/* Write the last state. It is always a row, for any --every. */
static bool write_last_row(recorder *r, dvi_integrator *integrator)
{
  return r->row_written ||
         (columns_measure(&r->columns, integrator) && recorder_write_row(r, integrator));
}

/* Return the number of the step that ends at t on the grid 0, h, 2h, ..., or 0 if t is not on it.
 * In another time there is no such grid, and the steps are counted. */
static long step_number(const dvi_integrator *integrator, double t, double h)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  if (dvi_integrator_monitor(integrator) != NULL) return counters.steps;
  const double steps = t / h;
  return steps > 0.0 && steps < 1e15 && fabs(steps - round(steps)) < 1e-6 ? lround(steps) : 0;
}

/* Report the steps of methods that choose them, and the jumps of the energy. */
static void report_steps(const recorder *r, const dvi_integrator *integrator)
{
  dvi_energy_balance energy;
  if (!r->chooses || r->steps_taken == 0) return;
  complain("run: %ld step%s of %.3g to %.3g", r->steps_taken, r->steps_taken == 1 ? "" : "s",
           r->shortest, r->longest);
  if (dvi_integrator_energy_balance(integrator, &energy) != DVI_OK) return;
  if (energy.fallbacks == 0)
    complain("run: no step was a fallback: the discrete energy is that of the start%s",
             energy.work != 0 ? " and the drive's work" : "");
  else
    complain("run: %ld fallback%s to the least-squares step; the largest energy jump is %.3g, the "
             "last %.3g, all together %.3g",
             energy.fallbacks, energy.fallbacks == 1 ? "" : "s", energy.largest_jump,
             energy.last_jump, energy.jumps - energy.given_jumps);
  if (energy.given_steps > 0)
    complain("run: %ld ordinary step%s of given length, to end on time: energy jump %.3g",
             energy.given_steps, energy.given_steps == 1 ? "" : "s", energy.given_jumps);
}

/* Drive the integrator to the end and write all rows. */
static int recorder_advance(recorder *r, dvi_integrator *integrator)
{
  const run_request *request = r->request;
  const dvi_run_options options = {.h = request->h,
                                   .t_end = request->t_end,
                                   .observe = recorder_observe,
                                   .user = r,
                                   .events = r->events.event,
                                   .event_count = r->events.count,
                                   .checkpoint = request->checkpoint,
                                   .checkpoint_every = request->checkpoint_every,
                                   .cancel = r->caught};
  if (r->events_out.stream != NULL) events_header(r->scene, r->events_out.stream);
  progress_start(&r->progress, request->final || r->out.file.stream != stdout);
  dvi_run_report report;
  const dvi_status status = dvi_run(integrator, &options, &report);
  progress_end(&r->progress);
  /* Complain at once, because the calls below may leave a sentence of their own. */
  const int code = status == DVI_OK ? DONE : r->stop_silently ? FAILED : library_error(status);
  report_steps(r, integrator);
  events_tell(&r->events, "run", &report);
  tell_hits(r);
  alarms_tell(&r->alarms);
  energy_tell(&r->watch, r->request);
  growth_watch_tell(&r->growth, request->method, request->h);
  if (r->stop_silently) return FAILED;
  const bool complete = (status != DVI_OK && request->final) || write_last_row(r, integrator);
  if (status != DVI_OK) return code;
  const int ended = *r->caught != 0 ? run_interrupted(request, (int)*r->caught, r->t) : DONE;
  return complete ? ended : FAILED;
}

/* List the names of the shown columns. */
static const char *column_name_at(int k, const void *list)
{
  const run_columns *columns = list;
  return k < columns->count ? columns->column[k].name : NULL;
}

/* Open the rows. Those of a resumed run may go on in the file of the run before it. The steps of
 * methods that choose them are not counted from t = 0. */
static bool open_rows(recorder *r, const dvi_integrator *integrator)
{
  const run_request *request = r->request;
  r->t_start = dvi_integrator_time(integrator);
  r->step = step_number(integrator, r->t_start, request->h);
  if (!run_head_make(&r->head, request, r->scene, request->h, column_name_at, &r->columns))
    return false;
  const bool is_counted = !r->chooses && dvi_integrator_monitor(integrator) == NULL;
  const hdf5_state state = {
      .t = r->t_start,
      .direction = request->t_end < r->t_start ? -1 : 1,
      .gap = is_counted ? (double)request->every * fabs(request->h) * (1 + 1e-9) : HUGE_VAL,
      .has_row = r->step % request->every == 0 && (!r->chooses || request->every == 1)};
  r->frames.head = &r->head.rows;
  return row_output_open(&r->out, request->out, &r->head.rows,
                         request->resume != NULL && !request->final ? &state : NULL);
}

static int write_files(recorder *r, dvi_integrator *integrator)
{
  const run_request *request = r->request;
  int code = FAILED;
  const bool chosen = request->columns != NULL || r->scene->column != NULL;
  if (request->plot != NULL && !trace_init(&r->trace, &r->columns, chosen)) {
    trace_clear(&r->trace);
    return FAILED;
  }
  if (open_rows(r, integrator) &&
      (request->events == NULL || file_open(&r->events_out, request->events)))
    code = recorder_advance(r, integrator);
  if (!row_output_close(&r->out, run_keeps_files(code))) code = FAILED;
  if (run_keeps_files(code) && request->events != NULL && !file_keep(&r->events_out)) code = FAILED;
  if (run_keeps_files(code) && !frames_keep(&r->frames)) code = FAILED;
  if (run_keeps_files(code) && request->plot != NULL && !trace_plot(&r->trace, request->plot))
    code = FAILED;
  if (run_keeps_files(code) && !field_map_draw(&r->map)) code = FAILED;
  file_discard(&r->events_out);
  trace_clear(&r->trace);
  return code;
}

static int recorder_start_frames(recorder *r)
{
  const dvi_density *density = density_of(r->scene);
  r->field = dvi_scene_field(r->scene->scene);
  const dvi_mesh *mesh = dvi_scene_mesh(r->scene->scene);
  const int code = frames_start(&r->frames, r->scene->name, mesh, r->request->pvd);
  if (code != DONE || dvi_scene_moving(r->scene->scene) != NULL || elastic_of(r->scene) != NULL)
    return code;
  const int64_t numbers = density != NULL ? density_coefficients(density)
                                          : dvi_mesh_count(mesh, dvi_field_degree(r->field));
  r->form = calloc((size_t)numbers, sizeof *r->form);
  if (r->form != NULL) return density != NULL ? density_views_make(r->scene, 1, &r->views) : DONE;
  complain("out of memory");
  return FAILED;
}

int record(const run_request *request, const problem *scene, dvi_integrator *integrator)
{
  recorder r = {
      .request = request, .scene = scene, .chooses = dvi_integrator_chooses_steps(integrator)};
  int code = columns_choose(&r.columns, scene, integrator, request->columns);
  if (code == DONE && request->pvd != NULL) code = recorder_start_frames(&r);
  if (code == DONE) code = field_map_start(&r.map, scene, request->map, request->map_of);
  if (code == DONE) code = alarms_read(&r.alarms, scene, &request->alarms);
  if (code == DONE &&
      !energy_watch_start(&r.watch, scene, integrator, energy_bound(scene, request->method)))
    code = FAILED;
  growth_watch_start(&r.growth, scene, integrator);
  r.caught = signals_note(run_ended_again);
  if (code == DONE)
    code = events_list(&r.events, scene, recorder_write_event, &r) ? write_files(&r, integrator)
                                                                   : FAILED;
  events_clear(&r.events);
  energy_watch_clear(&r.watch);
  columns_clear(&r.columns);
  run_head_clear(&r.head);
  frames_clear(&r.frames);
  density_views_clear(&r.views);
  field_map_clear(&r.map);
  free(r.form);
  return code;
}
