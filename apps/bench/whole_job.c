#include "bench/whole_job.h"

#include <dvi/study.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench/bare.h"
#include "bench/peer.h"
#include "cli/command.h"
#include "mechanics/field_motion.h"
#include "mechanics/march.h"

enum { ENERGY, EVALUATIONS = 0 };

static const table_column counted[] = {{"evaluations", "%.0f"}, {NULL, NULL}};

const study_words whole_job_words = MOTION_WORDS("integrator", counted);

/* ---- methods ---- */

/* Run the whole job. *preparation grows by the seconds of the integrator's creation. level is NULL
 * for a run for the clock. */
static dvi_status method_job(const whole_job *job, double steps, double *preparation,
                             study_level *level)
{
  const problem *scene = job->motion.scene;
  dvi_integrator *integrator = NULL;
  const double began = dvi_study_clock();
  dvi_status status = open_paced(scene, job->method, &job->how, &integrator) == DONE
                          ? DVI_OK
                          : DVI_BAD_OPTION;
  *preparation += dvi_study_clock() - began;
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  if (status == DVI_OK)
    status = march(integrator, job->span / steps, lround(steps), job->motion.t_end, NULL, NULL,
                   NULL, NULL);
  if (status == DVI_OK && level != NULL) {
    dvi_counters counters;
    dvi_integrator_counters(integrator, &counters);
    level->counted[EVALUATIONS] = (double)counters.gradients;
    level->parts = (double)counters.steps;
    level->error = judge_error(job->motion.judge, scene, dvi_integrator_q(integrator));
  }
  dvi_integrator_destroy(&integrator);
  return status;
}

/* A march of a field that is run for the clock is not asked for its end. */
static dvi_status march_job(const whole_job *job, double steps, double *preparation,
                            study_level *level)
{
  const problem *scene = job->motion.scene;
  field_motion_end end;
  double *q = NULL;
  if (level != NULL && (q = calloc((size_t)scene->nq, sizeof *q)) == NULL) return DVI_NO_MEMORY;
  const dvi_status status = field_motion(scene, job->method, steps, job->motion.t_end, false, q,
                                         &end);
  *preparation += end.seconds;
  if (status == DVI_OK && level != NULL) {
    level->counted[EVALUATIONS] = end.updates;
    level->parts = end.steps;
    level->error = judge_error(job->motion.judge, scene, q);
  }
  free(q);
  return status;
}

static dvi_status job_of(const whole_job *job, double steps, double *preparation,
                         study_level *level)
{
  return (dvi_scene_marches(job->motion.scene->scene, job->method) ? march_job : method_job)(
      job, steps, preparation, level);
}

static dvi_status method_run(void *user, double steps, study_level *level)
{
  const whole_job *job = user;
  double preparation = 0.0;
  level->length = job->span / steps;
  const double began = dvi_study_clock();
  const dvi_status status = job_of(job, steps, &preparation, level);
  level->seconds = dvi_study_clock() - began;
  return status;
}

static dvi_status method_watch(void *user, double steps, study_level *level)
{
  const whole_job *job = user;
  return study_watch(&job->study->subject, steps, level);
}

static dvi_status method_repeat(void *user, double steps, double *preparation)
{
  return job_of(user, steps, preparation, NULL);
}

static const char *last_reason(void *user)
{
  (void)user;
  return dvi_last_error();
}

void whole_job_of_method(whole_job *job, motion_study *study, const char *method, const pacing *how)
{
  *job = (whole_job){.subject = study->subject,
                     .peer = -1,
                     .motion = study->motion,
                     .method = method,
                     .how = *how,
                     .span = study->subject.span,
                     .study = study};
  job->subject.words = &whole_job_words;
  job->subject.run = method_run;
  job->subject.watch = method_watch;
  job->subject.repeat = method_repeat;
  job->subject.roundoff = NULL;
  job->subject.reason = last_reason;
  job->subject.user = job;
}

/* ---- peers ---- */

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

/* Run a peer from the start to each of the ENERGY_TIMES, because it shows its state only at the
 * end. */
static dvi_status peer_run(void *user, double tolerance, study_level *level)
{
  const whole_job *job = user;
  const problem *scene = job->motion.scene;
  double *q = job->room, *p = q + scene->nq;
  dvi_reference_report report = {0};
  dvi_status status = DVI_OK;
  level->further[ENERGY] = 0.0;
  for (int k = 1; k <= ENERGY_TIMES && status == DVI_OK; k++) {
    const double t = k == ENERGY_TIMES ? job->motion.t_end : job->motion.t_end * k / ENERGY_TIMES;
    double change = 0.0;
    const double began = dvi_study_clock();
    status = peer_solve(job->peer, scene, t, tolerance, q, p, &report);
    level->seconds = dvi_study_clock() - began;
    if (status == DVI_OK) status = energy_change(scene, t, q, p, &change);
    level->further[ENERGY] = fmax(level->further[ENERGY], change);
  }
  level->counted[EVALUATIONS] = (double)report.evaluations;
  level->parts = (double)report.steps;
  level->error = judge_error(job->motion.judge, scene, q);
  return status;
}

/* Run a peer for the clock. Creation and run are one call. */
static dvi_status peer_repeat(void *user, double tolerance, double *preparation)
{
  const whole_job *job = user;
  double *q = job->room;
  *preparation = (double)NAN;
  return peer_solve(job->peer, job->motion.scene, job->motion.t_end, tolerance, q,
                    q + job->motion.scene->nq, NULL);
}

/* Run a bare loop from the start. *preparation grows by the seconds of its creation. */
static dvi_status bare_solve(const whole_job *job, double h, long steps, double *preparation,
                             long *evaluations)
{
  const double began = dvi_study_clock();
  bare *loop = bare_create(job->motion.scene, job->degree, h);
  *preparation += dvi_study_clock() - began;
  if (loop == NULL) return DVI_NO_MEMORY;
  *evaluations = bare_run(loop, steps, job->room, job->room + job->motion.scene->nq);
  bare_destroy(loop);
  return DVI_OK;
}

/* Run a bare loop from the start to the steps nearest to each of the ENERGY_TIMES. */
static dvi_status bare_level(void *user, double steps, study_level *level)
{
  const whole_job *job = user;
  const problem *scene = job->motion.scene;
  long evaluations = 0;
  dvi_status status = DVI_OK;
  level->further[ENERGY] = 0.0;
  level->length = job->span / steps;
  for (int k = 1; k <= ENERGY_TIMES && status == DVI_OK; k++) {
    const long made = lround(steps * k / ENERGY_TIMES);
    double change = 0.0, preparation = 0.0;
    const double began = dvi_study_clock();
    status = bare_solve(job, level->length, made, &preparation, &evaluations);
    level->seconds = dvi_study_clock() - began;
    if (status == DVI_OK)
      status = energy_change(scene, level->length * (double)made, job->room, job->room + scene->nq,
                             &change);
    level->further[ENERGY] = fmax(level->further[ENERGY], change);
  }
  level->counted[EVALUATIONS] = (double)evaluations;
  level->parts = steps;
  level->error = judge_error(job->motion.judge, scene, job->room);
  return status;
}

static dvi_status bare_repeat(void *user, double steps, double *preparation)
{
  const whole_job *job = user;
  long evaluations;
  return bare_solve(job, job->span / steps, lround(steps), preparation, &evaluations);
}

static void peer_setting(void *user, double tolerance, char *text, size_t size)
{
  (void)user;
  (void)snprintf(text, size, "tol=%.0e", tolerance);
}

/* Make a job that is no method's. Its name, run and repeat are left out. DVI_NO_MEMORY. */
static dvi_status job_with_room(whole_job *job, const judged_motion *motion)
{
  const size_t n = (size_t)motion->scene->nq;
  *job = (whole_job){.motion = *motion, .peer = -1, .room = calloc(2 * n, sizeof *job->room)};
  job->subject = (study_subject){.problem = motion->scene->name,
                                 .words = &whole_job_words,
                                 .extent = motion->t_end,
                                 .judge = motion->judge->words,
                                 .judge_error = motion->judge->error,
                                 .user = job};
  return job->room != NULL ? DVI_OK : DVI_NO_MEMORY;
}

dvi_status whole_job_of_peer(whole_job *job, int peer, const judged_motion *motion)
{
  const dvi_status status = job_with_room(job, motion);
  job->peer = peer;
  job->subject.name = peer_name(peer);
  job->subject.run = peer_run;
  job->subject.repeat = peer_repeat;
  job->subject.setting = peer_setting;
  job->subject.reason = last_reason;
  return status;
}

dvi_status whole_job_of_bare(whole_job *job, int degree, const whole_job *beside,
                             const judged_motion *motion)
{
  const dvi_status status = job_with_room(job, motion);
  (void)snprintf(job->name, sizeof job->name, "bare:degree=%d", degree);
  job->degree = degree;
  job->beside = beside;
  job->span = job->subject.span = motion->t_end;
  job->subject.name = job->name;
  job->subject.run = bare_level;
  job->subject.repeat = bare_repeat;
  return status;
}

void whole_job_clear(whole_job *job)
{
  free(job->room);
  job->room = NULL;
}
