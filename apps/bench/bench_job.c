#include "bench/bench_job.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "mechanics/march.h"
#include "load/open.h"
#include "bench/peer.h"
#include "mechanics/order_study.h"

/* Adds the time of creation to *creation. q: room for the end, [n], or NULL. */
static dvi_status run_method(const bench_job *job, const problem *scene, double t_end,
                             double *creation, double *q, long *evaluations, long *taken)
{
  dvi_integrator *integrator = NULL;
  const double began = cpu_now();
  dvi_status status = open_paced(scene, job->method, &job->how, &integrator) == DONE
                          ? DVI_OK
                          : DVI_BAD_OPTION;
  *creation += cpu_now() - began;
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  if (status == DVI_OK)
    status = march(integrator, job->h, job->steps, t_end, NULL, NULL, NULL, NULL);
  if (status == DVI_OK && q != NULL) {
    dvi_counters counters;
    dvi_integrator_counters(integrator, &counters);
    *evaluations = counters.gradients;
    *taken = counters.steps;
    memcpy(q, dvi_integrator_q(integrator), (size_t)scene->nq * sizeof *q);
  }
  dvi_integrator_destroy(&integrator);
  return status;
}

static dvi_status energy_change(const problem *scene, double t, const double *q, const double *p,
                                double *change)
{
  double *value = calloc(2 * (size_t)dvi_system_invariant_count(scene->system), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  double *then = value + dvi_system_invariant_count(scene->system);
  dvi_status status = dvi_system_invariants(scene->system, 0.0, scene->q, scene->p, value);
  if (status == DVI_OK) status = dvi_system_invariants(scene->system, t, q, p, then);
  *change = fabs(then[0] - value[0]);
  free(value);
  return status;
}

/* Watch the energy along the way, and leave the end in q and p. */
static dvi_status try_peer(bench_job *job, const problem *scene, double t_end, double *q, double *p)
{
  dvi_reference_report report = {0};
  dvi_status status = DVI_OK;
  job->energy_error = 0.0;
  for (int k = 1; k <= ENERGY_TIMES && status == DVI_OK; k++) {
    const double t = k == ENERGY_TIMES ? t_end : t_end * k / ENERGY_TIMES;
    double change = 0.0;
    const double began = cpu_now();
    status = peer_solve(job->peer, scene, t, job->tolerance, q, p, &report);
    job->tried = cpu_now() - began;
    if (status == DVI_OK) status = energy_change(scene, t, q, p, &change);
    job->energy_error = fmax(job->energy_error, change);
  }
  job->evaluations = report.evaluations;
  job->taken = report.steps;
  return status;
}

static dvi_status try_method(bench_job *job, const problem *scene, double t_end, double *q)
{
  double creation = 0.0;
  const double began = cpu_now();
  const dvi_status status = run_method(job, scene, t_end, &creation, q, &job->evaluations,
                                       &job->taken);
  job->tried = cpu_now() - began;
  return status;
}

dvi_status bench_job_try(bench_job *job, const problem *scene, const judgement *judge, double t_end)
{
  double *q = calloc(2 * (size_t)scene->nq, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  const dvi_status status = job->peer >= 0 ? try_peer(job, scene, t_end, q, q + scene->nq)
                                           : try_method(job, scene, t_end, q);
  job->error = judge_error(judge, scene, q);
  job->repeats = study_repeats(job->tried);
  free(q);
  return status;
}

dvi_status bench_job_time(bench_job *job, const problem *scene, double t_end, int round)
{
  double *q = calloc(2 * (size_t)scene->nq, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  dvi_status status = DVI_OK;
  double creation = job->peer >= 0 ? (double)NAN : 0.0; /* a peer is created and run in one call */
  const double began = cpu_now();
  for (long i = 0; i < job->repeats && status == DVI_OK; i++)
    status = job->peer >= 0
                 ? peer_solve(job->peer, scene, t_end, job->tolerance, q, q + scene->nq, NULL)
                 : run_method(job, scene, t_end, &creation, NULL, NULL, NULL);
  job->cpu[round] = (cpu_now() - began) / (double)job->repeats;
  job->creation[round] = creation / (double)job->repeats;
  free(q);
  return status;
}

void bench_job_finish(bench_job *job, int rounds)
{
  job->seconds = samples_spread(rounds, job->cpu);
  job->creation_seconds = samples_spread(rounds, job->creation).median;
}
