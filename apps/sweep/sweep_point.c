#define _POSIX_C_SOURCE 200809L
#include "sweep/sweep_point.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "csv/balance.h"
#include "cli/command.h"
#include "csv/events.h"
#include "load/density.h"
#include "load/open.h"
#include "csv/table.h"

enum { LABEL_SIZE = 1024, WORD_SIZE = 256 };

/* The state of a run. */
typedef struct sweep_watch {
  double *invariant; /* [invariants] */
  double first, largest;
  bool begun;
  dvi_status status; /* status of the energy's evaluation */
} sweep_watch;

/* The result at a point. */
typedef struct outcome {
  char word[WORD_SIZE]; /* content of its column status */
  bool failed;
  long steps;
  double t;
  const double *q, *p, *invariant; /* NULL if there is none */
  double energy_error;
} outcome;

/* ---- columns ---- */

static void write_names(FILE *stream, int count, char *const *name)
{
  for (int i = 0; i < count; i++) {
    csv_text(stream, name[i]);
    (void)fputc(',', stream);
  }
}

/* A field has as many coordinates as vertices. Its energy and its probes tell of it. */
static bool shows_state(const problem *model)
{
  return !has_field(model);
}

void sweep_header(const sweep_task *task, FILE *stream)
{
  const problem *model = task->model;
  for (int i = 0; i < task->grid.axes; i++) {
    csv_text(stream, task->grid.axis[i].name);
    (void)fputc(',', stream);
  }
  (void)fputs("status,steps,t,", stream);
  if (shows_state(model)) {
    write_names(stream, model->nq, model->coordinate);
    write_names(stream, model->nv, model->momentum);
  }
  for (int i = 0; i < dvi_system_invariant_count(model->system); i++) {
    csv_text(stream, dvi_system_invariant_name(model->system, i));
    (void)fputc(',', stream);
  }
  (void)fputs("energy_error", stream);
}

/* Write numbers. Cells of missing numbers, and of numbers that are not finite, are empty. */
static void write_numbers(FILE *stream, int count, const double *number)
{
  for (int i = 0; i < count; i++) {
    (void)fputc(',', stream);
    if (number != NULL && isfinite(number[i])) (void)fprintf(stream, "%.17g", number[i]);
  }
}

static void sweep_write_row(const sweep_task *task, const grid_point *point, const outcome *end,
                            FILE *stream)
{
  const problem *model = task->model;
  for (int i = 0; i < point->settings.count; i++) {
    csv_text(stream, strchr(point->settings.word[i], '=') + 1);
    (void)fputc(',', stream);
  }
  csv_text(stream, end->word);
  (void)fprintf(stream, ",%ld", end->steps);
  write_numbers(stream, 1, &end->t);
  if (shows_state(model)) {
    write_numbers(stream, model->nq, end->q);
    write_numbers(stream, model->nv, end->p);
  }
  write_numbers(stream, dvi_system_invariant_count(model->system), end->invariant);
  write_numbers(stream, 1, &end->energy_error);
}

static sweep_row sweep_make_row(const sweep_task *task, const grid_point *point, const outcome *end)
{
  sweep_row row = {.failed = end->failed};
  size_t size;
  FILE *stream = open_memstream(&row.text, &size);
  if (stream == NULL) return row;
  sweep_write_row(task, point, end, stream);
  const bool good = !ferror(stream);
  if (fclose(stream) == 0 && good) return row;
  free(row.text);
  row.text = NULL;
  return row;
}

/* ---- run ---- */

static void sweep_complain(const grid_point *point, const char *sentence)
{
  char label[LABEL_SIZE] = "";
  int length = 0;
  for (int i = 0; i < point->settings.count && length < LABEL_SIZE; i++)
    length += snprintf(label + length, (size_t)(LABEL_SIZE - length), "%s%s", i > 0 ? "," : "",
                       point->settings.word[i]);
  complain("sweep: %s: %s", label, sentence);
}

/* Watch the energy. The driver calls this function at the start and after each step. */
static int sweep_observe(dvi_integrator *integrator, void *user)
{
  sweep_watch *w = user;
  w->status = dvi_integrator_invariants(integrator, w->invariant);
  if (w->status == DVI_OK && !isfinite(w->invariant[0])) w->status = DVI_NOT_FINITE;
  if (w->status != DVI_OK) return -1;
  const double energy = balanced_value(integrator, 0, w->invariant[0]);
  if (!w->begun) w->first = energy;
  w->begun = true;
  w->largest = fmax(w->largest, fabs(energy - w->first));
  return 0;
}

static dvi_status sweep_advance(const sweep_task *task, const problem *scene,
                                const event_list *events, dvi_integrator *integrator,
                                sweep_watch *w, outcome *end)
{
  const double t_end = isnan(task->t_end) ? scene->t_end : task->t_end;
  const double h = isnan(task->h) ? copysign(scene->h, t_end) : task->h;
  const dvi_run_options options = {.h = h,
                                   .t_end = t_end,
                                   .observe = sweep_observe,
                                   .user = w,
                                   .events = events->event,
                                   .event_count = events->count};
  dvi_run_report report = {.steps = 0};
  const dvi_status status = dvi_run(integrator, &options, &report);
  if (report.end == DVI_RUN_EVENT)
    (void)snprintf(end->word, sizeof end->word, "event %s", events->event[report.event].name);
  end->steps = report.steps;
  end->t = dvi_integrator_time(integrator);
  end->q = dvi_integrator_q(integrator);
  end->p = dvi_integrator_p(integrator);
  end->invariant = w->begun ? w->invariant : NULL;
  end->energy_error = w->begun ? w->largest : (double)NAN;
  return w->status != DVI_OK ? w->status : status;
}

/* Run the problem at a point. The integrator owns the state that `end` shows. */
static void sweep_run_problem(const sweep_task *task, const problem *scene, const grid_point *point,
                              dvi_integrator **integrator, sweep_watch *w, outcome *end)
{
  event_list events;
  dvi_status status = events_list(&events, scene, NULL, NULL) ? DVI_OK : DVI_NO_MEMORY;
  if (status == DVI_OK)
    status = create_balanced(scene, task->method != NULL ? task->method : scene->method,
                             integrator);
  if (status == DVI_OK) status = dvi_integrator_start(*integrator, 0.0, scene->q, scene->p);
  (void)snprintf(end->word, sizeof end->word, "%s", dvi_status_name(DVI_OK));
  if (status == DVI_OK) status = sweep_advance(task, scene, &events, *integrator, w, end);
  events_clear(&events);
  end->failed = status != DVI_OK;
  if (status == DVI_OK) return;
  (void)snprintf(end->word, sizeof end->word, "%s", dvi_status_name(status));
  const char *sentence = status == DVI_NO_MEMORY || w->status == DVI_NOT_FINITE ? ""
                                                                                : dvi_last_error();
  sweep_complain(point, sentence[0] != '\0' ? sentence : dvi_status_meaning(status));
}

static bool has_columns(const problem *scene, const problem *model)
{
  return scene->nq == model->nq && scene->nv == model->nv &&
         dvi_system_invariant_count(scene->system) == dvi_system_invariant_count(model->system);
}

sweep_row sweep_run(const sweep_task *task, long k)
{
  grid_point point;
  outcome end = {.word = "refused", .failed = true, .t = (double)NAN, .energy_error = (double)NAN};
  sweep_watch w = {.status = DVI_OK};
  problem *scene = NULL;
  dvi_integrator *integrator = NULL;
  sweep_row row = {.text = NULL};
  grid_at(&task->grid, k, &point);
  w.invariant = calloc((size_t)dvi_system_invariant_count(task->model->system),
                       sizeof *w.invariant);
  if (w.invariant == NULL) return row;
  if (open_text(task->operand, &task->text, &point.settings, &scene) != DONE)
    sweep_complain(&point, "the problem cannot be made with these values");
  else if (!has_columns(scene, task->model))
    sweep_complain(&point,
                   "with these values the problem has other coordinates than without; sweep over "
                   "sizes by runs of their own");
  else
    sweep_run_problem(task, scene, &point, &integrator, &w, &end);
  row = sweep_make_row(task, &point, &end);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&scene);
  free(w.invariant);
  return row;
}
