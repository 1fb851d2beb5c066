#include "bench_job.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

static const double clock_seconds = 0.02; /* process time that one measurement takes at least */
static const long repeats_max = 1000000;

static dvi_status run_method(const bench_job *job, const problem *scene, double t_end, double *q, long *evaluations)
{
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_integrator_create(scene->system, job->integrator, &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  const double h = t_end / (double)job->steps;
  for (long i = 0; i < job->steps && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  if (status == DVI_OK && q != NULL) {
    dvi_counters counters;
    dvi_integrator_counters(integrator, &counters);
    *evaluations = counters.gradients;
    memcpy(q, dvi_integrator_q(integrator), (size_t)scene->n * sizeof *q);
  }
  dvi_integrator_destroy(&integrator);
  return status;
}

/* q and p are room for the state: [n] each. */
static dvi_status run_code(const bench_job *job, const problem *scene, double t_end, double *q, double *p, long *evaluations)
{
  const dvi_reference_options options = {.code = job->code, .relative_tolerance = job->tolerance};
  dvi_reference_report report = {0};
  memcpy(q, scene->q, (size_t)scene->n * sizeof *q);
  memcpy(p, scene->p, (size_t)scene->n * sizeof *p);
  const dvi_status status = dvi_reference_solve(scene->system, 0.0, t_end, q, p, &options, &report);
  if (evaluations != NULL) *evaluations = report.evaluations;
  return status;
}

static dvi_status energy_change(const problem *scene, double t_end, const double *q, const double *p, double *change)
{
  double *value = calloc(2 * (size_t)dvi_system_invariant_count(scene->system), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  double *end = value + dvi_system_invariant_count(scene->system);
  dvi_status status = dvi_system_invariants(scene->system, 0.0, scene->q, scene->p, value);
  if (status == DVI_OK) status = dvi_system_invariants(scene->system, t_end, q, p, end);
  *change = fabs(end[0] - value[0]);
  free(value);
  return status;
}

dvi_status bench_job_try(bench_job *job, const problem *scene, const judgement *judge, double t_end)
{
  double *q = calloc(2 * (size_t)scene->n, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *p = q + scene->n;
  const double began = cpu_now();
  dvi_status status = job->steps > 0 ? run_method(job, scene, t_end, q, &job->evaluations)
                                     : run_code(job, scene, t_end, q, p, &job->evaluations);
  const double spent = cpu_now() - began;
  if (status == DVI_OK && job->steps == 0) status = energy_change(scene, t_end, q, p, &job->energy_error);
  job->error = judge_error(judge, scene, q);
  job->repeats = spent >= clock_seconds ? 1 : lround(fmin(ceil(clock_seconds / fmax(spent, 1e-9)), (double)repeats_max));
  free(q);
  return status;
}

dvi_status bench_job_time(bench_job *job, const problem *scene, double t_end, int round)
{
  double *q = calloc(2 * (size_t)scene->n, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  dvi_status status = DVI_OK;
  const double began = cpu_now();
  for (long i = 0; i < job->repeats && status == DVI_OK; i++)
    status = job->steps > 0 ? run_method(job, scene, t_end, NULL, NULL) : run_code(job, scene, t_end, q, q + scene->n, NULL);
  job->cpu[round] = (cpu_now() - began) / (double)job->repeats;
  free(q);
  return status;
}

static int by_size(const void *left, const void *right)
{
  const double a = *(const double *)left;
  const double b = *(const double *)right;
  return (a > b) - (a < b);
}

double bench_job_median(bench_job *job, int rounds)
{
  qsort(job->cpu, (size_t)rounds, sizeof *job->cpu, by_size);
  return rounds % 2 == 1 ? job->cpu[rounds / 2] : 0.5 * (job->cpu[rounds / 2 - 1] + job->cpu[rounds / 2]);
}
