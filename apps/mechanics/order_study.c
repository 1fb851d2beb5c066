#define _POSIX_C_SOURCE 200809L
#include "mechanics/order_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/command.h"
#include "mechanics/march.h"

static const double ceiling_digits =
    1e-2; /* an error of 1 % of the solution's size is no longer asymptotic */
static const double clock_seconds = 0.02; /* process time that one measurement takes at least */
static const double repeats_max = 1e6;

static double now(clockid_t clock)
{
  struct timespec t;
  (void)clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double cpu_now(void)
{
  return now(CLOCK_PROCESS_CPUTIME_ID);
}

double elapsed_now(void)
{
  return now(CLOCK_MONOTONIC);
}

long study_repeats(double seconds)
{
  return seconds >= clock_seconds
             ? 1
             : lround(fmin(ceil(clock_seconds / fmax(seconds, 1e-9)), repeats_max));
}

double study_size(const order_study *s)
{
  const double size = judge_largest(s->scene->nq, s->judge->q);
  return size > 0.0 ? size : 1.0;
}

int study_refuse(const order_study *s)
{
  complain("%s: its steps do not lead to the solution at t = %g; is the monitor finite and above 0 "
           "all the way?",
           s->method, s->t_end);
  return FAILED;
}

int study_init(order_study *study, const problem *scene, const judgement *judge, const char *method,
               const pacing *how, double t_end)
{
  memset(study, 0, sizeof *study);
  study->scene = scene;
  study->judge = judge;
  study->method = method;
  study->t_end = t_end;
  const int code = open_paced(scene, method, how, &study->integrator);
  if (code != DONE) return code;
  const dvi_status status = march_span(study->integrator, scene->q, scene->p, scene->order_h, t_end,
                                       &study->span);
  if (status != DVI_OK || isnan(study->span)) {
    study_clear(study);
    return status != DVI_OK ? library_error(status) : study_refuse(study);
  }
  study->order = dvi_integrator_order(study->integrator);
  study->ceiling = ceiling_digits * study_size(study);
  study->floor = STUDY_FLOOR_MARGIN * judge->error;
  return DONE;
}

void study_clear(order_study *study)
{
  dvi_integrator_destroy(&study->integrator);
}

dvi_status study_integrate(order_study *s, const double *q, const dvi_start_options *start,
                           long steps)
{
  const dvi_status status = dvi_integrator_start_with(s->integrator, 0.0, q, s->scene->p, start);
  if (status != DVI_OK) return status;
  return march(s->integrator, s->span / (double)steps, steps, s->t_end, NULL, NULL, s->progress,
               s->method);
}

dvi_status study_run(order_study *study, long steps, level_trial *trial)
{
  dvi_counters before;
  dvi_integrator_counters(study->integrator, &before);
  memset(trial, 0, sizeof *trial);
  trial->steps = trial->taken = steps;
  trial->h = study->span / (double)steps;
  trial->energy_error = trial->cpu_seconds = (double)NAN;
  const dvi_status status = study_integrate(study, study->scene->q, NULL, steps);
  if (status != DVI_OK) return status;
  trial->error = judge_error(study->judge, study->scene, dvi_integrator_q(study->integrator));
  dvi_integrator_counters(study->integrator, &trial->spent);
  trial->spent.residuals -= before.residuals;
  trial->spent.jacobians -= before.jacobians;
  trial->spent.factorizations -= before.factorizations;
  trial->spent.gradients -= before.gradients;
  if (dvi_integrator_chooses_steps(study->integrator))
    trial->taken = trial->spent.steps - before.steps;
  return DVI_OK;
}

/* What a run is watched for. */
typedef struct watched {
  const dvi_system *system;
  double *value; /* [invariants] */
  double first;  /* the energy at the start; NaN: not yet */
  level_trial *trial;
} watched;

static int watch(dvi_integrator *integrator, void *user)
{
  watched *w = user;
  if (dvi_integrator_invariants(integrator, w->value) != DVI_OK) return -1;
  if (isnan(w->first)) w->first = w->value[0];
  w->trial->energy_error = fmax(w->trial->energy_error, fabs(w->value[0] - w->first));
  w->trial->distance = fmax(w->trial->distance,
                            dvi_system_distance(w->system, dvi_integrator_q(integrator)));
  return 0;
}

dvi_status study_watch(order_study *study, level_trial *trial)
{
  double *value = calloc((size_t)dvi_system_invariant_count(study->scene->system), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  watched w = {
      .system = study->scene->system, .value = value, .first = (double)NAN, .trial = trial};
  trial->energy_error = trial->distance = 0.0;
  const double h = study->span / (double)trial->steps;
  dvi_status status = dvi_integrator_start(study->integrator, 0.0, study->scene->q,
                                           study->scene->p);
  if (status == DVI_OK && watch(study->integrator, &w) != 0) status = DVI_NOT_FINITE;
  if (status == DVI_OK)
    status = march(study->integrator, h, trial->steps, study->t_end, watch, &w, NULL, NULL);
  free(value);
  return status;
}

dvi_status study_time(order_study *study, level_trial *trial)
{
  const double began = cpu_now();
  double spent;
  long runs = 0;
  do {
    const dvi_status status = study_integrate(study, study->scene->q, NULL, trial->steps);
    if (status != DVI_OK) return status;
    runs++;
    spent = cpu_now() - began;
  } while (spent < clock_seconds);
  trial->cpu_seconds = spent / (double)runs;
  return DVI_OK;
}
