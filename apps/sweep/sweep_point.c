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

/* A point of the grid with its problem. */
typedef struct opened_point {
  grid_point at;
  problem *scene; /* NULL if it could not be made */
  event_list events;
  bool refused; /* the problem cannot be made, or not at this point */
} opened_point;

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

/* Write the content of the column status. */
static void write_status(const opened_point *point, const dvi_study_row *row, FILE *stream)
{
  char word[WORD_SIZE];
  const char *name = point->refused ? "refused" : dvi_status_name(row->status);
  if (row->report.end == DVI_RUN_EVENT)
    (void)snprintf(word, sizeof word, "event %s", point->events.event[row->report.event].name);
  else
    (void)snprintf(word, sizeof word, "%s", name);
  csv_text(stream, word);
}

static void sweep_write_row(const sweep_task *task, const opened_point *point,
                            const dvi_study_row *row, FILE *stream)
{
  const problem *model = task->model;
  for (int i = 0; i < point->at.settings.count; i++) {
    csv_text(stream, strchr(point->at.settings.word[i], '=') + 1);
    (void)fputc(',', stream);
  }
  write_status(point, row, stream);
  (void)fprintf(stream, ",%ld", row->report.steps);
  write_numbers(stream, 1, &row->t);
  if (shows_state(model)) {
    write_numbers(stream, model->nq, row->q);
    write_numbers(stream, model->nv, row->p);
  }
  write_numbers(stream, dvi_system_invariant_count(model->system), row->invariant);
  write_numbers(stream, 1, &row->energy_error);
}

static void sweep_complain(const opened_point *point, const char *sentence)
{
  char label[LABEL_SIZE] = "";
  int length = 0;
  for (int i = 0; i < point->at.settings.count && length < LABEL_SIZE; i++)
    length += snprintf(label + length, (size_t)(LABEL_SIZE - length), "%s%s", i > 0 ? "," : "",
                       point->at.settings.word[i]);
  complain("sweep: %s: %s", label, sentence);
}

sweep_row sweep_make_row(const sweep_task *task, const dvi_study_run *run,
                         const dvi_study_row *found)
{
  const opened_point *point = run->user;
  sweep_row row = {.failed = found->status != DVI_OK};
  size_t size;
  if (point == NULL) return row;
  if (row.failed && !point->refused) sweep_complain(point, found->sentence);
  FILE *stream = open_memstream(&row.text, &size);
  if (stream == NULL) return row;
  sweep_write_row(task, point, found, stream);
  const bool good = !ferror(stream);
  if (fclose(stream) == 0 && good) return row;
  free(row.text);
  row.text = NULL;
  return row;
}

/* ---- run ---- */

static bool has_columns(const problem *scene, const problem *model)
{
  return scene->nq == model->nq && scene->nv == model->nv &&
         dvi_system_invariant_count(scene->system) == dvi_system_invariant_count(model->system);
}

/* Make the problem of a point. Complains and returns false if it is none of this sweep. */
static bool make_problem(const sweep_task *task, opened_point *point)
{
  if (open_text(task->operand, &task->text, &point->at.settings, &point->scene) != DONE)
    sweep_complain(point, "the problem cannot be made with these values");
  else if (!has_columns(point->scene, task->model))
    sweep_complain(point,
                   "with these values the problem has other coordinates than without; sweep over "
                   "sizes by runs of their own");
  else
    return true;
  return false;
}

dvi_status sweep_open(const sweep_task *task, const dvi_study_point *at, dvi_study_run *run)
{
  opened_point *point = calloc(1, sizeof *point);
  if (point == NULL) return DVI_NO_MEMORY;
  run->user = point;
  grid_at(&task->grid, at->index, &point->at);
  point->refused = !make_problem(task, point);
  if (point->refused) return DVI_BAD_ARGUMENT;
  const problem *scene = point->scene;
  if (!events_list(&point->events, scene, NULL, NULL)) return DVI_NO_MEMORY;
  const double t_end = isnan(task->t_end) ? scene->t_end : task->t_end;
  run->options = (dvi_run_options){.h = isnan(task->h) ? copysign(scene->h, t_end) : task->h,
                                   .t_end = t_end,
                                   .events = point->events.event,
                                   .event_count = point->events.count};
  const dvi_status status = create_balanced(
      scene, task->method != NULL ? task->method : scene->method, &run->integrator);
  return status == DVI_OK ? dvi_integrator_start(run->integrator, 0.0, scene->q, scene->p) : status;
}

void sweep_close(dvi_study_run *run)
{
  opened_point *point = run->user;
  dvi_integrator_destroy(&run->integrator);
  if (point == NULL) return;
  events_clear(&point->events);
  problem_destroy(&point->scene);
  free(point);
}
