#define _POSIX_C_SOURCE 200809L
#include "study.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "command.h"
#include "open.h"

static const double ceiling_digits = 1e-2; /* an error of 1 % of the solution's size is no longer asymptotic */
static const double search_target = 2e-3;  /* where the first level's error should lie, in the same unit */
static const double floor_margin = 10.0;   /* an error must exceed what blurs it by this factor */
static const double clock_seconds = 0.02;  /* process time that one measurement takes at least */

enum { SEARCH_TRIES = 30 };
static const long steps_max = 1L << 24;

double cpu_now(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double solution_size(const order_study *s)
{
  double size = 0.0;
  for (int i = 0; i < s->scene->n; i++) size = fmax(size, fabs(s->judge->q[i]));
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
  study->ceiling = ceiling_digits * solution_size(study);
  study->floor = floor_margin * judge->error;
  return DONE;
}

void study_clear(order_study *study)
{
  dvi_integrator_destroy(&study->integrator);
}

static dvi_status integrate(order_study *s, const double *q, long steps)
{
  const double h = s->t_end / (double)steps;
  dvi_status status = dvi_integrator_start(s->integrator, 0.0, q, s->scene->p);
  for (long i = 0; i < steps && status == DVI_OK; i++) status = dvi_integrator_step(s->integrator, h);
  return status;
}

dvi_status study_run(order_study *study, long steps, level_trial *trial)
{
  dvi_counters before;
  dvi_integrator_counters(study->integrator, &before);
  memset(trial, 0, sizeof *trial);
  trial->steps = steps;
  trial->h = study->t_end / (double)steps;
  trial->energy_error = trial->cpu_seconds = (double)NAN;
  const dvi_status status = integrate(study, study->scene->q, steps);
  if (status != DVI_OK) return status;
  trial->error = judge_error(study->judge, study->scene, dvi_integrator_q(study->integrator));
  dvi_integrator_counters(study->integrator, &trial->spent);
  trial->spent.residuals -= before.residuals;
  trial->spent.jacobians -= before.jacobians;
  trial->spent.factorizations -= before.factorizations;
  trial->spent.gradients -= before.gradients;
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
  for (long i = 0; i < trial->steps && good; i++) {
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
    const dvi_status status = integrate(study, study->scene->q, trial->steps);
    if (status != DVI_OK) return status;
    runs++;
    spent = cpu_now() - began;
  } while (spent < clock_seconds);
  trial->cpu_seconds = spent / (double)runs;
  return DVI_OK;
}

static double within(double x, double low, double high)
{
  return fmin(fmax(x, low), high);
}

/* Fewer or more steps, as the method's order foretells from one error; NaN: the run failed. */
static long better_steps(const order_study *s, long steps, double error)
{
  const double target = search_target * solution_size(s);
  const double factor = isfinite(error) ? pow(error / target, 1.0 / s->order) : 2.0;
  const double wanted = (double)steps * within(factor, 0.25, 2.0);
  return wanted >= 1.0 ? (long)ceil(wanted) : 1;
}

/* Search for the first level: an error below, but not far below, the ceiling. */
static dvi_status find_first(order_study *s, level_trial *first)
{
  const double target = search_target * solution_size(s);
  long steps = lround(within(ceil(fabs(s->t_end) / s->scene->order_h), 1.0, 1e6));
  long too_few = 0;
  for (int i = 0; i < SEARCH_TRIES && steps <= steps_max; i++) {
    const dvi_status status = study_run(s, steps, first);
    if (status < 0) return status;
    const double error = status == DVI_OK ? first->error : (double)NAN;
    const bool rough = !(error <= s->ceiling);
    if (rough)
      too_few = steps;
    else if (error > 0.1 * target || steps <= too_few + 1)
      return DVI_OK;
    const long next = better_steps(s, steps, error);
    steps = rough ? (next > steps ? next : steps + 1) : next < steps ? (next > too_few ? next : too_few + 1) : steps;
    if (!rough && steps == first->steps) return DVI_OK;
  }
  return study_run(s, steps <= steps_max ? steps : steps_max, first);
}

/* What roundoff does to the end: how far a change of the start in its last place moves it. */
static dvi_status find_floor(order_study *s, const level_trial *first)
{
  const int n = s->scene->n;
  double *q = calloc(2 * (size_t)n, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *end = q + n;
  const double size = solution_size(s);
  for (int i = 0; i < n; i++)
    q[i] = s->scene->q[i] + (i % 2 == 0 ? DBL_EPSILON : -DBL_EPSILON) * fmax(fabs(s->scene->q[i]), 0.1 * size);
  dvi_status status = integrate(s, q, first->steps);
  if (status == DVI_OK) {
    memcpy(end, dvi_integrator_q(s->integrator), (size_t)n * sizeof *end);
    status = integrate(s, s->scene->q, first->steps);
  }
  double moved = DBL_EPSILON * size;
  for (int i = 0; i < n && status == DVI_OK; i++) moved = fmax(moved, fabs(end[i] - dvi_integrator_q(s->integrator)[i]));
  free(q);
  s->floor = floor_margin * fmax(s->judge->error, moved);
  return status;
}

static double choose_ratio(const order_study *s, const level_trial *first, int levels)
{
  const double span = first->error / (3.0 * s->floor);
  const double ratio = span > 1.0 && levels > 1 ? pow(span, 1.0 / (s->order * (levels - 1.0))) : 1.0;
  return within(ratio, 1.05, 2.0);
}

dvi_status study_levels(order_study *study, double h, double ratio, int levels, long *steps)
{
  level_trial first;
  const double wanted = h != 0.0 ? within(fabs(study->t_end / h), 1.0, (double)steps_max) : 0.0;
  dvi_status status = wanted > 0.0 ? study_run(study, lround(wanted), &first) : find_first(study, &first);
  if (status == DVI_OK) status = find_floor(study, &first);
  if (status != DVI_OK) return status;
  const double factor = ratio > 0.0 ? ratio : choose_ratio(study, &first, levels);
  steps[0] = first.steps;
  for (int k = 1; k < levels; k++) {
    steps[k] = lround((double)first.steps * pow(factor, k));
    if (steps[k] <= steps[k - 1]) steps[k] = steps[k - 1] + 1;
  }
  return DVI_OK;
}
