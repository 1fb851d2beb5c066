#include "sweep/resonance_point.h"

#include <math.h>
#include <stdio.h>

#include "csv/balance.h"
#include "cli/command.h"
#include "load/open.h"

enum { SETTING_SIZE = 192 };

/* A time of a run, and the largest change of the invariant until then. */
typedef struct mark {
  double t, error;
} mark;

/* The state of a run. Marks are set at steps 1, 2, 4, 8, .., so that the last but one lies between
 * a quarter and a half of the run. */
typedef struct resonance_watch {
  int watched;
  double first, largest;
  long steps; /* number of steps, -1 before the start */
  mark last, before;
  dvi_status status; /* status of the invariant's evaluation */
} resonance_watch;

static void set_mark(resonance_watch *w, double t)
{
  if (w->steps == 0 || (w->steps & (w->steps - 1)) != 0) return;
  w->before = w->last;
  w->last = (mark){.t = t, .error = w->largest};
}

/* Watch the invariant. The driver calls this function at the start and after each step. */
static int resonance_observe(dvi_integrator *integrator, void *user)
{
  resonance_watch *w = user;
  double value = (double)NAN;
  w->status = dvi_integrator_invariant(integrator, w->watched, &value);
  if (w->status != DVI_OK) return -1;
  value = balanced_value(integrator, w->watched, value);
  if (w->steps < 0) w->first = value;
  w->steps++;
  const double scale = fabs(w->first) > 0.0 ? fabs(w->first) : 1.0;
  w->largest = fmax(w->largest, fabs(value - w->first) / scale);
  if (!isfinite(value)) w->largest = (double)INFINITY;
  set_mark(w, dvi_integrator_time(integrator));
  return !(w->largest < RESONANCE_LIMIT);
}

static double growth_rate(const resonance_watch *w, double t)
{
  const double span = fabs(t - w->before.t);
  return span > 0.0 && w->before.error > 0.0 && isfinite(w->largest)
             ? log(w->largest / w->before.error) / span
             : (double)NAN;
}

static void resonance_complain(const resonance_task *task, double value, const char *sentence)
{
  complain("resonance: %s=%.17g: %s", task->name, value, sentence);
}

static dvi_status resonance_advance(const resonance_task *task, const problem *scene,
                                    dvi_integrator *integrator, resonance_point *point)
{
  resonance_watch w = {.watched = task->watched, .steps = -1};
  const dvi_run_options options = {.h = task->steps_vary ? point->value : task->h,
                                   .t_end = task->t_end,
                                   .observe = resonance_observe,
                                   .user = &w};
  dvi_run_report report = {.steps = 0};
  dvi_status status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  if (status == DVI_OK) status = dvi_run(integrator, &options, &report);
  point->steps = report.steps;
  point->t = dvi_integrator_time(integrator);
  point->error = w.steps > 0 ? fmin(w.largest, RESONANCE_LIMIT) : (double)NAN;
  point->growth = growth_rate(&w, point->t);
  point->unbounded = report.end == DVI_RUN_STOPPED;
  if (point->unbounded) point->status = "unbounded";
  return w.status != DVI_OK ? w.status : status;
}

static void resonance_run_problem(const resonance_task *task, const problem *scene,
                                  resonance_point *point)
{
  dvi_integrator *integrator = NULL;
  dvi_status status = create_balanced(scene, task->method, &integrator);
  point->status = dvi_status_name(DVI_OK);
  if (status == DVI_OK) status = resonance_advance(task, scene, integrator, point);
  point->failed = status != DVI_OK;
  if (point->failed) {
    point->status = dvi_status_name(status);
    resonance_complain(task, point->value,
                       dvi_last_error()[0] != '\0' ? dvi_last_error() : dvi_status_meaning(status));
  }
  dvi_integrator_destroy(&integrator);
}

void resonance_run(const resonance_task *task, resonance_point *point)
{
  char setting[SETTING_SIZE];
  words settings = task->settings;
  problem *scene = NULL;
  (void)snprintf(setting, sizeof setting, "%s=%.17g", task->name, point->value);
  if (!task->steps_vary) settings.word[settings.count++] = setting;
  *point = (resonance_point){.value = point->value,
                             .status = "refused",
                             .failed = true,
                             .t = (double)NAN,
                             .error = (double)NAN,
                             .growth = (double)NAN};
  if (open_text(task->operand, &task->text, &settings, &scene) == DONE)
    resonance_run_problem(task, scene, point);
  else
    resonance_complain(task, point->value, "the problem cannot be made with this value");
  problem_destroy(&scene);
}
