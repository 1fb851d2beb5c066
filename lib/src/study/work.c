/* Time of methods against their error. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "study/trial.h"

/* The state of a study. */
typedef struct work_study {
  const dvi_system *system;
  const dvi_study_runs *runs;
  int count, rounds;
  int cancelled; /* the flag was seen, and jobs may be without a run */
  dvi_study_job *job;
  double *solution;  /* [nq] */
  dvi__trial *trial; /* [count] without an integrator where the job's run failed */
  double *sample;    /* [count * rounds] seconds of each job in each round */
} work_study;

static dvi_status jobs_check(const dvi_study_runs *runs, int count, const dvi_study_job *job,
                             int rounds)
{
  if (!dvi__has_judge(runs))
    return dvi__fail(DVI_BAD_ARGUMENT, "work study: give one of end, exact and reference");
  if (job == NULL || count < 1) return dvi__fail(DVI_BAD_ARGUMENT, "work study: there is no job");
  if (rounds < 1 || rounds > DVI_STUDY_ROUNDS_MAX)
    return dvi__fail(DVI_BAD_ARGUMENT, "work study: %d rounds are not from 1 to %d", rounds,
                     (int)DVI_STUDY_ROUNDS_MAX);
  for (int i = 0; i < count; i++)
    if (job[i].method == NULL || !(job[i].h > 0.0) || !isfinite(job[i].h) ||
        dvi__runs_steps(runs, job[i].h) > DVI_STUDY_STEPS_MAX)
      return dvi__fail(DVI_BAD_ARGUMENT, "work study: job %d needs a method and a step, not h = %g",
                       i, job[i].h);
  return DVI_OK;
}

static int is_cancelled(work_study *s)
{
  s->cancelled = s->cancelled || dvi__runs_cancelled(s->runs);
  return s->cancelled;
}

/* Run each job once. */
static dvi_status open_jobs(work_study *s)
{
  for (int i = 0; i < s->count && !is_cancelled(s); i++) {
    dvi_study_job *job = &s->job[i];
    dvi__trial *trial = &s->trial[i];
    *job = (dvi_study_job){.method = job->method, .h = job->h};
    job->status = dvi__trial_open(s->system, job->method, s->runs, dvi__runs_steps(s->runs, job->h),
                                  trial);
    if (job->status < 0) return job->status;
    if (job->status != DVI_OK) continue;
    job->counters = trial->counters;
    job->error = dvi__distance(dvi_system_nq(s->system), dvi_integrator_q(trial->integrator),
                               s->solution);
  }
  return DVI_OK;
}

static void cancel_jobs(const work_study *s)
{
  for (int i = 0; i < s->count; i++)
    s->job[i] = (dvi_study_job){.method = s->job[i].method, .h = s->job[i].h, .cancelled = 1};
}

static dvi_status measure(work_study *s)
{
  DVI_TRY(dvi__judge(s->system, s->runs, s->solution, &(double){0.0}));
  DVI_TRY(open_jobs(s));
  for (int round = 0; round < s->rounds; round++)
    for (int i = 0; i < s->count; i++)
      if (s->job[i].status == DVI_OK && !is_cancelled(s))
        DVI_TRY(dvi__trial_time(&s->trial[i], dvi_study_repeats(s->trial[i].seconds),
                                &s->sample[(size_t)i * (size_t)s->rounds + (size_t)round]));
  for (int i = 0; i < s->count; i++)
    s->job[i].seconds = dvi_study_spread_of(s->rounds, s->sample + (size_t)i * (size_t)s->rounds);
  if (is_cancelled(s)) cancel_jobs(s);
  return DVI_OK;
}

dvi_status dvi_study_work(const dvi_system *system, const dvi_study_runs *runs, int count,
                          dvi_study_job *job, int rounds)
{
  DVI_TRY(dvi__runs_check(system, runs));
  DVI_TRY(jobs_check(runs, count, job, rounds));
  work_study s = {.system = system, .runs = runs, .count = count, .rounds = rounds, .job = job};
  s.solution = DVI_NEW(double, dvi_system_nq(system));
  s.trial = DVI_NEW(dvi__trial, count);
  s.sample = (double *)dvi__allocate((size_t)count, (size_t)rounds * sizeof *s.sample);
  const dvi_status status = s.solution != NULL && s.trial != NULL && s.sample != NULL
                                ? measure(&s)
                                : dvi__fail(DVI_NO_MEMORY, "work study: no memory for %d jobs",
                                            count);
  for (int i = 0; s.trial != NULL && i < count; i++) dvi__trial_close(&s.trial[i]);
  dvi__release(s.solution);
  dvi__release(s.trial);
  dvi__release(s.sample);
  return status;
}
