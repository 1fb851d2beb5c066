#include "study/work.h"

#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "study/levels.h"

enum { LEVELS_DEFAULT = 6 };

static const double first_error = 1e-2; /* first error of each subject, relative to the solution */
/* largest ratio of the first error to the largest asked one */
static const double above_asked = 1e3;
static const double more_parts = 4.0; /* largest factor in parts for this ratio */

/* ---- jobs ---- */

static void job_name(work_job *job, const study_subject *subject, double refinement)
{
  if (subject->setting != NULL)
    subject->setting(subject->user, refinement, job->setting, sizeof job->setting);
  else
    (void)snprintf(job->setting, sizeof job->setting, "%s=%.6g", subject->words->length,
                   subject->span / refinement);
}

/* Run the level once with `watch` and once without. The job counts if it has a result. */
static dvi_status job_try(work *w, const study_subject *subject, double refinement)
{
  work_job *job = &w->job[w->jobs];
  study_level watched = {.number = NULL};
  *job = (work_job){.subject = subject};
  job_name(job, subject, refinement);
  dvi_status status = study_watch(subject, refinement, &watched);
  if (status == DVI_OK) status = study_run(subject, refinement, &job->level);
  if (subject->watch != NULL) memcpy(job->level.further, watched.further, sizeof watched.further);
  job->repeats = dvi_study_repeats(job->level.seconds);
  w->jobs += status == DVI_OK;
  return status;
}

static void warn_left_out(const work *w)
{
  const work_job *job = &w->job[w->jobs];
  const study_subject *subject = job->subject;
  complain("%s: left out %s at %s: %s", w->command, subject->name, job->setting,
           subject->reason != NULL ? subject->reason(subject->user) : "it has no result");
}

dvi_status work_add(work *w, const study_subject *subject, double refinement)
{
  if (w->jobs == w->room) return DVI_BAD_SIZE;
  const dvi_status status = job_try(w, subject, refinement);
  if (status <= 0) return status;
  warn_left_out(w);
  return DVI_OK;
}

/* ---- levels ---- */

double work_smallest_asked(const numbers *asked)
{
  double smallest = HUGE_VAL;
  for (int i = 0; i < asked->count; i++) smallest = fmin(smallest, asked->number[i]);
  return smallest;
}

/* Choose the first error of a subject. Levels far above the asked errors would tell nothing, and of
 * a high order take long. */
static double first_error_of(const work *w, const study_subject *subject)
{
  double asked = 0.0;
  for (int i = 0; i < w->asked->count; i++) asked = fmax(asked, w->asked->number[i]);
  if (asked == 0.0) return first_error;
  /* Without this bound no level would lie above the floor. */
  const double judged = DVI_STUDY_FLOOR_MARGIN * DVI_STUDY_FLOOR_MARGIN * w->judge_error;
  const double near = fmin(first_error, fmax(above_asked * asked, judged) / subject->size);
  return fmax(near, first_error * pow(more_parts, -subject->order));
}

/* Return whether the last level took clearly less time than the one before. Smaller parts are
 * cheaper where they let a simpler solver work. */
static bool became_cheaper(const work *w, int first)
{
  static const double clearly = 0.9;
  const work_job *last = &w->job[w->jobs - 1];
  return w->jobs > first + 1 && last->level.seconds < clearly * (last - 1)->level.seconds;
}

/* Return whether neither of the last two levels is better than all before them. A single one may be
 * worse than a larger part by chance. */
static bool floor_is_reached(const work *w, int first)
{
  double best = HUGE_VAL;
  if (w->jobs < first + 3) return false;
  for (int i = first; i < w->jobs - 2; i++) best = fmin(best, w->job[i].level.error);
  return w->job[w->jobs - 2].level.error >= best && w->job[w->jobs - 1].level.error >= best;
}

/* Go on with smaller parts to the smallest asked error, as long as they make the error smaller, and
 * beyond it as long as they make the job cheaper. */
static dvi_status add_smaller(work *w, const study_subject *subject, int first)
{
  static const double ratio = 1.5;
  /* Limit of one job, some seconds at most for a small problem. */
  static const double parts_max = 1L << 20;
  const double wanted = work_smallest_asked(w->asked);
  dvi_status status = DVI_OK;
  if (w->jobs == first) return DVI_OK;
  double parts = w->job[w->jobs - 1].level.refinement;
  for (int k = LEVELS_DEFAULT; k < WORK_LEVELS_MAX && status == DVI_OK; k++) {
    const work_job *last = &w->job[w->jobs - 1];
    parts = ceil(ratio * parts);
    if (parts > parts_max || (last->level.error <= wanted && !became_cheaper(w, first))) break;
    if (floor_is_reached(w, first)) break;
    status = work_add(w, subject, (double)lround(parts));
  }
  return status;
}

/* Add larger parts, each twice as large, as long as their errors are about that of the first level.
 * Errors of fast phases do not fall with the length before it resolves them. */
static dvi_status add_larger(work *w, const study_subject *search, const study_subject *subject,
                             long parts)
{
  static const double as_good = 1.5;
  long larger[WORK_LONGER_MAX];
  int count = 0;
  study_level first = {.number = NULL}, level = {.number = NULL};
  dvi_status status = study_run(search, (double)parts, &first);
  while (status == DVI_OK && parts > 1 && count < WORK_LONGER_MAX) {
    parts /= 2;
    status = study_run(search, (double)parts, &level);
    if (status != DVI_OK || !(level.error <= as_good * first.error)) break;
    larger[count++] = parts;
  }
  if (status > 0) status = DVI_OK;
  while (status == DVI_OK && count > 0) status = work_add(w, subject, (double)larger[--count]);
  return status;
}

dvi_status work_add_levels(work *w, const study_subject *search, const study_subject *subject,
                           int levels, bool *lost)
{
  const bool extend = levels == 0;
  const dvi_study_search wanted = {.first_error = first_error_of(w, search),
                                   .levels = extend ? LEVELS_DEFAULT : levels};
  dvi_study_levels choice;
  dvi_status status = levels_choose(search, &wanted, &choice);
  *lost = status == DVI_OK && choice.parts[0] == 0;
  if (status != DVI_OK || *lost) return status;
  if (extend) status = add_larger(w, search, subject, choice.parts[0]);
  const int first = w->jobs;
  for (int k = 0; k < wanted.levels && status == DVI_OK; k++)
    status = work_add(w, subject, (double)choice.parts[k]);
  return status == DVI_OK && extend ? add_smaller(w, subject, first) : status;
}

/* Return whether no job from `first` on meets the smallest asked error. */
static bool more_wanted(const work *w, int first)
{
  const double wanted = work_smallest_asked(w->asked);
  for (int i = first; i < w->jobs; i++)
    if (w->job[i].level.error <= wanted) return false;
  return isfinite(wanted);
}

void work_add_tolerances(work *w, const study_subject *subject, int count, const double *tolerance,
                         int always)
{
  const int first = w->jobs;
  for (int k = 0; k < count && (k < always || more_wanted(w, first)); k++) {
    if (w->progress != NULL) progress_show(w->progress, -1.0, subject->name);
    if (w->jobs == w->room || job_try(w, subject, tolerance[k]) == DVI_OK) continue;
    warn_left_out(w);
  }
}

/* ---- rounds ---- */

static dvi_status job_time(work_job *job, int round)
{
  const study_subject *subject = job->subject;
  dvi_status status = DVI_OK;
  double preparation = 0.0;
  const double began = dvi_study_clock();
  for (long i = 0; i < job->repeats && status == DVI_OK; i++)
    status = subject->repeat(subject->user, job->level.refinement, &preparation);
  job->cpu[round] = (dvi_study_clock() - began) / (double)job->repeats;
  job->preparation[round] = preparation / (double)job->repeats;
  return status;
}

dvi_status work_run(work *w, double (*calibrate)(void))
{
  for (int round = 0; round < w->rounds; round++) {
    w->sample[round] = calibrate != NULL ? calibrate() : (double)NAN;
    for (int i = 0; i < w->jobs; i++) {
      const double done = (double)(round * w->jobs + i) / (double)(w->rounds * w->jobs);
      if (w->progress != NULL) progress_show(w->progress, done, w->shown);
      const dvi_status status = job_time(&w->job[i], round);
      if (status != DVI_OK) return status;
    }
  }
  for (int i = 0; i < w->jobs; i++) {
    work_job *job = &w->job[i];
    job->seconds = dvi_study_spread_of((int)w->rounds, job->cpu);
    job->preparation_seconds = dvi_study_spread_of((int)w->rounds, job->preparation).median;
  }
  w->calibration = dvi_study_spread_of((int)w->rounds, w->sample);
  return DVI_OK;
}

int work_group_end(const work *w, int first)
{
  const char *name = w->job[first].subject->name;
  int end = first;
  while (end < w->jobs && strcmp(w->job[end].subject->name, name) == 0) end++;
  return end;
}
