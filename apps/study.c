#define _POSIX_C_SOURCE 200809L
#include "study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "command.h"
#include "open.h"

enum { PROGRESS_STEPS = 256 };
static const double ceiling_digits = 1e-2; /* an error of 1 % of the solution's size is no longer asymptotic */
static const double clock_seconds = 0.02;  /* process time that one measurement takes at least */
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
  return seconds >= clock_seconds ? 1 : lround(fmin(ceil(clock_seconds / fmax(seconds, 1e-9)), repeats_max));
}

double study_size(const order_study *s)
{
  const double size = judge_largest(s->scene->n, s->judge->q);
  return size > 0.0 ? size : 1.0;
}

int study_init(order_study *study, const problem *scene, const judgement *judge, const char *method, double t_end)
{
  memset(study, 0, sizeof *study);
  study->scene = scene;
  study->judge = judge;
  study->method = method;
  study->t_end = t_end;
  const int code = open_integrator(scene, method, &study->integrator);
  if (code != DONE) return code;
  study->order = dvi_integrator_order(study->integrator);
  study->ceiling = ceiling_digits * study_size(study);
  study->floor = STUDY_FLOOR_MARGIN * judge->error;
  return DONE;
}

void study_clear(order_study *study)
{
  dvi_integrator_destroy(&study->integrator);
}

/* Methods that choose their steps are driven to the end: h is their first step. */
static dvi_status drive(order_study *s, double h, int (*observe)(dvi_integrator *, void *), void *user)
{
  return dvi_run(s->integrator, &(dvi_run_options){.h = h, .t_end = s->t_end, .observe = observe, .user = user}, NULL);
}

dvi_status study_integrate(order_study *s, const double *q, long steps)
{
  const double h = s->t_end / (double)steps;
  dvi_status status = dvi_integrator_start(s->integrator, 0.0, q, s->scene->p);
  if (dvi_integrator_chooses_steps(s->integrator)) return status == DVI_OK ? drive(s, h, NULL, NULL) : status;
  for (long i = 0; i < steps && status == DVI_OK; i++) {
    if (s->progress != NULL && i % PROGRESS_STEPS == 0) progress_show(s->progress, -1.0, s->method);
    status = dvi_integrator_step(s->integrator, h);
  }
  return status;
}

dvi_status study_run(order_study *study, long steps, level_trial *trial)
{
  dvi_counters before;
  dvi_integrator_counters(study->integrator, &before);
  memset(trial, 0, sizeof *trial);
  trial->steps = trial->taken = steps;
  trial->h = study->t_end / (double)steps;
  trial->energy_error = trial->cpu_seconds = (double)NAN;
  const dvi_status status = study_integrate(study, study->scene->q, steps);
  if (status != DVI_OK) return status;
  trial->error = judge_error(study->judge, study->scene, dvi_integrator_q(study->integrator));
  dvi_integrator_counters(study->integrator, &trial->spent);
  trial->spent.residuals -= before.residuals;
  trial->spent.jacobians -= before.jacobians;
  trial->spent.factorizations -= before.factorizations;
  trial->spent.gradients -= before.gradients;
  if (dvi_integrator_chooses_steps(study->integrator)) trial->taken = trial->spent.steps - before.steps;
  return DVI_OK;
}

static int watch(dvi_integrator *integrator, void *user)
{
  double **watched = user;
  double *value = watched[0];
  double *drift = watched[1];
  if (dvi_integrator_invariants(integrator, value) != DVI_OK) return -1;
  if (isnan(drift[0])) drift[0] = value[0];
  drift[1] = fmax(drift[1], fabs(value[0] - drift[0]));
  return 0;
}

dvi_status study_watch_energy(order_study *study, level_trial *trial)
{
  double *value = calloc((size_t)dvi_system_invariant_count(study->scene->system), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  double drift[2] = {(double)NAN, 0.0};
  double *watched[2] = {value, drift};
  const double h = study->t_end / (double)trial->steps;
  dvi_status status = dvi_integrator_start(study->integrator, 0.0, study->scene->q, study->scene->p);
  bool good = status == DVI_OK && watch(study->integrator, watched) == 0;
  const bool driven = good && dvi_integrator_chooses_steps(study->integrator);
  if (driven) status = drive(study, h, watch, watched);
  for (long i = 0; i < trial->steps && good && !driven; i++) {
    status = dvi_integrator_step(study->integrator, h);
    good = status == DVI_OK && watch(study->integrator, watched) == 0;
  }
  free(value);
  trial->energy_error = drift[1];
  return good || status != DVI_OK ? status : DVI_NOT_FINITE;
}

dvi_status study_time(order_study *study, level_trial *trial)
{
  const double began = cpu_now();
  double spent;
  long runs = 0;
  do {
    const dvi_status status = study_integrate(study, study->scene->q, trial->steps);
    if (status != DVI_OK) return status;
    runs++;
    spent = cpu_now() - began;
  } while (spent < clock_seconds);
  trial->cpu_seconds = spent / (double)runs;
  return DVI_OK;
}
