/* The order that a method's errors show. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "study/trial.h"

static const double order_tolerance = 0.2;
static const double first_parts = 16.0;    /* steps at which a search begins */
static const double ceiling_digits = 1e-2; /* errors of 1 % of q are no longer asymptotic */

/* The state of a study. */
typedef struct order_study {
  const dvi_system *system;
  const char *method;
  const dvi_study_runs *runs;
  double steps[DVI_STUDY_LEVELS_MAX + 1]; /* of each level */
  int levels, nq;
  int once;         /* runs are not repeated for the clock */
  int chooses;      /* the method chooses its steps */
  double *solution; /* [nq] at the end, from the judge */
  double *ends;     /* [(levels + 1) * nq] at the end of each level */
  dvi_study_level *level;
  dvi_study_order_result *result;
} order_study;

static dvi_status options_check(const char *method, const dvi_study_runs *runs,
                                const dvi_study_order_options *options)
{
  if (method == NULL || options == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "order study: the method or the options are NULL");
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "order study: set options.size to sizeof(dvi_study_order_options)");
  if (!(options->h >= 0.0) || !isfinite(options->h))
    return dvi__fail(DVI_BAD_ARGUMENT, "order study: h = %g must be positive, or 0 for a search",
                     options->h);
  if (options->ratio != 0.0 && (!(options->ratio > 1.0) || !isfinite(options->ratio)))
    return dvi__fail(DVI_BAD_ARGUMENT, "order study: the ratio of steps %g must be above 1",
                     options->ratio);
  if (options->levels != 0 && (options->levels < 2 || options->levels > DVI_STUDY_LEVELS_MAX))
    return dvi__fail(DVI_BAD_ARGUMENT, "order study: %d levels are not from 2 to %d",
                     options->levels, (int)DVI_STUDY_LEVELS_MAX);
  if (options->h == 0.0 && !dvi__has_judge(runs))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "order study: a search for steps needs one of end, exact and reference; give "
                     "it, or h");
  return DVI_OK;
}

/* Set the steps of each level, at least one more than those of the level before. */
static dvi_status set_steps(order_study *s, double h, double ratio)
{
  s->steps[0] = dvi__runs_steps(s->runs, h);
  for (int k = 1; k <= s->levels; k++)
    s->steps[k] = fmax(round(s->steps[0] * pow(ratio, k)), s->steps[k - 1] + 1.0);
  if (s->steps[s->levels] <= DVI_STUDY_STEPS_MAX) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "order study: %g steps of the last level are too many",
                   s->steps[s->levels]);
}

/* ---- the search ---- */

static double order_size(const order_study *s, const double *end)
{
  return fmax(dvi__distance(s->nq, end, NULL), dvi__distance(s->nq, s->runs->q, NULL));
}

static dvi_status search_run(double parts, double *error, void *user)
{
  const order_study *s = user;
  dvi__trial trial;
  DVI_TRY(dvi__trial_open(s->system, s->method, s->runs, parts, &trial));
  *error = dvi__distance(s->nq, dvi_integrator_q(trial.integrator), s->solution);
  dvi__trial_close(&trial);
  return dvi__runs_cancelled(s->runs) ? DVI_BAD_STATE : DVI_OK; /* ends the search */
}

static dvi_status search_steps(order_study *s, double ratio)
{
  dvi_integrator *integrator = NULL;
  DVI_TRY(dvi_integrator_create(s->system, s->method, &integrator));
  const int order = dvi_integrator_order(integrator);
  dvi_integrator_destroy(&integrator);
  const double size = order_size(s, s->solution);
  const dvi_study_search wanted = {.size = sizeof wanted,
                                   .levels = s->levels,
                                   .order = order,
                                   .span = s->runs->t_end - s->runs->t,
                                   .first_parts = first_parts,
                                   .size_of_result = size > 0.0 ? size : 1.0,
                                   .judge_error = s->result->judge_error,
                                   .ratio = ratio,
                                   .run = search_run,
                                   .user = s};
  dvi_study_levels found;
  DVI_TRY(dvi_study_search_levels(&wanted, &found));
  for (int k = 0; k < s->levels; k++) s->steps[k] = (double)found.parts[k];
  return DVI_OK;
}

/* ---- levels ---- */

static dvi_status fill_level(dvi__trial *trial, int once, dvi_study_level *level)
{
  *level = (dvi_study_level){.h = trial->h,
                             .steps = trial->counters.steps,
                             .seconds = trial->seconds,
                             .counters = trial->counters};
  const long repeats = once ? 1 : dvi_study_repeats(trial->seconds);
  DVI_TRY(dvi__trial_energy(trial, &level->energy_error));
  return repeats > 1 ? dvi__trial_time(trial, repeats, &level->seconds) : DVI_OK;
}

/* Run level k, and keep its end. The level after the last one has no result but its end. */
static dvi_status run_level(order_study *s, int k)
{
  dvi__trial trial;
  DVI_TRY(dvi__trial_open(s->system, s->method, s->runs, s->steps[k], &trial));
  memcpy(s->ends + (size_t)k * (size_t)s->nq, dvi_integrator_q(trial.integrator),
         (size_t)s->nq * sizeof *s->ends);
  s->result->claimed = dvi_integrator_order(trial.integrator);
  s->chooses = dvi_integrator_chooses_steps(trial.integrator);
  const dvi_status status = k < s->levels ? fill_level(&trial, s->once, &s->level[k]) : DVI_OK;
  dvi__trial_close(&trial);
  return status;
}

/* Compute the error of level k and its slope, once what it is compared with is known. */
static void judge_level(order_study *s, int k)
{
  const double *end = s->ends + (size_t)k * (size_t)s->nq;
  const double *solution = dvi__has_judge(s->runs) ? s->solution : end + s->nq;
  dvi_study_level *level = &s->level[k];
  level->error = dvi__distance(s->nq, end, solution);
  if (k > 0 && level[-1].error > 0.0 && level->error > 0.0)
    level->slope = log(level[-1].error / level->error) / log(level[-1].h / level->h);
  s->result->levels = k + 1;
}

static dvi_status run_levels(order_study *s)
{
  const int before = dvi__has_judge(s->runs) ? 0 : 1; /* a level waits for the next one */
  for (int k = 0; k < s->levels + before; k++) {
    DVI_TRY(run_level(s, k));
    if (dvi__runs_cancelled(s->runs)) break;
    if (k >= before) judge_level(s, k - before);
  }
  return DVI_OK;
}

/* ---- the fit ---- */

static void fit_levels(order_study *s)
{
  dvi_study_order_result *r = s->result;
  double h[DVI_STUDY_LEVELS_MAX], error[DVI_STUDY_LEVELS_MAX];
  dvi_order_fit fit;
  for (int k = 0; k < r->levels; k++) {
    h[k] = s->level[k].h;
    error[k] = s->level[k].error;
  }
  const double *end = dvi__has_judge(s->runs) ? s->solution
                                              : s->ends + (size_t)s->levels * (size_t)s->nq;
  const double size = order_size(s, end);
  r->floor = DVI_STUDY_FLOOR_MARGIN * fmax(r->judge_error, DBL_EPSILON * size);
  r->ceiling = ceiling_digits * size;
  r->settled = dvi_study_fit(r->levels, h, error, r->floor, r->ceiling, &fit);
  r->first = fit.first;
  r->last = fit.last;
  r->order = fit.first < 0 ? 0.0 : fit.slope;
  r->holds = r->settled && !s->chooses && fabs(r->order - r->claimed) <= order_tolerance;
}

static dvi_status order_run(order_study *s, const dvi_study_order_options *options)
{
  if (dvi__has_judge(s->runs))
    DVI_TRY(dvi__judge(s->system, s->runs, s->solution, &s->result->judge_error));
  const dvi_status searched = options->h == 0.0 ? search_steps(s, options->ratio) : DVI_OK;
  s->result->cancelled = dvi__runs_cancelled(s->runs);
  if (s->result->cancelled || searched != DVI_OK) return s->result->cancelled ? DVI_OK : searched;
  DVI_TRY(run_levels(s));
  s->result->cancelled = s->result->levels < s->levels;
  if (!s->result->cancelled) fit_levels(s);
  return DVI_OK;
}

dvi_status dvi_study_order(const dvi_system *system, const char *method, const dvi_study_runs *runs,
                           const dvi_study_order_options *options, dvi_study_level *level,
                           dvi_study_order_result *result)
{
  if (level == NULL || result == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "order study: the levels or the result are NULL");
  *result = (dvi_study_order_result){.first = -1, .last = -1};
  DVI_TRY(dvi__runs_check(system, runs));
  DVI_TRY(options_check(method, runs, options));
  order_study s = {.system = system,
                   .method = method,
                   .runs = runs,
                   .levels = options->levels != 0 ? options->levels : 6,
                   .nq = dvi_system_nq(system),
                   .once = options->once,
                   .level = level,
                   .result = result};
  if (options->h > 0.0)
    DVI_TRY(set_steps(&s, options->h, options->ratio != 0.0 ? options->ratio : 2.0));
  s.solution = DVI_NEW(double, s.nq);
  s.ends = (double *)dvi__allocate((size_t)s.nq, ((size_t)s.levels + 1) * sizeof *s.ends);
  const dvi_status status = s.solution != NULL && s.ends != NULL
                                ? order_run(&s, options)
                                : dvi__fail(DVI_NO_MEMORY, "order study: no memory for %d levels",
                                            s.levels);
  dvi__release(s.solution);
  dvi__release(s.ends);
  return status;
}
