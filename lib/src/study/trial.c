#include "study/trial.h"

#include <dvi/run.h>
#include <math.h>

#include "core/status.h"

dvi_status dvi__runs_check(const dvi_system *system, const dvi_study_runs *runs)
{
  if (system == NULL || runs == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "study: the system or the runs are NULL");
  if (runs->size != sizeof *runs)
    return dvi__fail(DVI_BAD_ARGUMENT, "study: set runs.size to sizeof(dvi_study_runs)");
  if (runs->q == NULL || (runs->p == NULL) == (runs->v == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "study: give q, and either p or v");
  if (!isfinite(runs->t) || !isfinite(runs->t_end))
    return dvi__fail(DVI_NOT_FINITE, "study: t = %g and t_end = %g must be finite", runs->t,
                     runs->t_end);
  if (runs->t == runs->t_end)
    return dvi__fail(DVI_BAD_ARGUMENT, "study: t and t_end are both %g; give another end", runs->t);
  if ((runs->end != NULL) + (runs->exact != NULL) + (runs->reference != 0) > 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "study: give one of end, exact and reference, not more");
  return DVI_OK;
}

int dvi__runs_cancelled(const dvi_study_runs *runs)
{
  return runs->cancel != NULL && *runs->cancel != 0;
}

double dvi__runs_steps(const dvi_study_runs *runs, double h)
{
  return fmax(round(fabs(runs->t_end - runs->t) / h), 1.0);
}

/* What the watch of a run's energy keeps. */
typedef struct energy_watch {
  double first, change;
  dvi_status status;
} energy_watch;

static int watch_energy(dvi_integrator *integrator, void *user)
{
  energy_watch *watch = user;
  double energy = 0.0;
  watch->status = dvi_integrator_invariant(integrator, 0, &energy);
  if (watch->status != DVI_OK) return 1;
  watch->change = fmax(watch->change, fabs(energy - watch->first));
  return 0;
}

/* Put the integrator at the start. */
static dvi_status trial_start(const dvi__trial *trial)
{
  const dvi_study_runs *runs = trial->runs;
  return runs->v != NULL
             ? dvi_integrator_start_velocity(trial->integrator, runs->t, runs->q, runs->v)
             : dvi_integrator_start(trial->integrator, runs->t, runs->q, runs->p);
}

static dvi_status trial_run(const dvi__trial *trial)
{
  const dvi_study_runs *runs = trial->runs;
  const dvi_run_options run = {
      .h = copysign(trial->h, runs->t_end - runs->t), .t_end = runs->t_end, .cancel = runs->cancel};
  DVI_TRY(trial_start(trial));
  return dvi_run(trial->integrator, &run, NULL);
}

static dvi_status first_run(dvi__trial *trial)
{
  const double began = dvi_study_clock();
  DVI_TRY(trial_run(trial));
  trial->seconds = dvi_study_clock() - began;
  dvi_integrator_counters(trial->integrator, &trial->counters);
  return DVI_OK;
}

dvi_status dvi__trial_open(const dvi_system *system, const char *method, const dvi_study_runs *runs,
                           double steps, dvi__trial *trial)
{
  *trial = (dvi__trial){.runs = runs, .h = fabs(runs->t_end - runs->t) / steps};
  DVI_TRY(dvi_integrator_create(system, method, &trial->integrator));
  const dvi_status status = first_run(trial);
  if (status == DVI_OK) return DVI_OK;
  dvi__trial_close(trial);
  return dvi__fail_in(status, "study of %s at h = %.6g", method, trial->h);
}

void dvi__trial_close(dvi__trial *trial)
{
  dvi_integrator_destroy(&trial->integrator);
}

dvi_status dvi__trial_time(dvi__trial *trial, long repeats, double *seconds)
{
  const double began = dvi_study_clock();
  for (long i = 0; i < repeats && !dvi__runs_cancelled(trial->runs); i++) DVI_TRY(trial_run(trial));
  *seconds = (dvi_study_clock() - began) / (double)repeats;
  return DVI_OK;
}

dvi_status dvi__trial_energy(dvi__trial *trial, double *change)
{
  const dvi_study_runs *runs = trial->runs;
  energy_watch watch = {.change = 0.0};
  const dvi_run_options run = {.h = copysign(trial->h, runs->t_end - runs->t),
                               .t_end = runs->t_end,
                               .observe = watch_energy,
                               .user = &watch,
                               .cancel = runs->cancel};
  DVI_TRY(trial_start(trial));
  DVI_TRY(dvi_integrator_invariant(trial->integrator, 0, &watch.first));
  DVI_TRY(dvi_run(trial->integrator, &run, NULL));
  *change = watch.change;
  return watch.status;
}
