#include "judge_runs.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The runs share neither their polynomials nor, because the number of steps differs by a factor near the golden ratio, the ends of their steps
 * (but the first and the last). At every level both halve their steps. */
enum { DEGREE = 16, OTHER_DEGREE = 12, LEVELS_MAX = 16, PROGRESS_STEPS = 256 };
static const double other_ratio = 1.618;
static const double first_step = 8.0;     /* of the problem's own step for a first run of low degree */
static const double steps_max = 1L << 20; /* of a run */
static const double agreement = 1e-6;     /* relative: before that, an error that does not fall may be one of steps too large */

/* How far apart the ends of two runs are, and how large they are. */
typedef struct comparison {
  double distance, size;
} comparison;

static dvi_status run_once(const problem *scene, int degree, long steps, double t_end, progress_line *progress, double *q)
{
  char method[32];
  dvi_integrator *integrator = NULL;
  (void)snprintf(method, sizeof method, "galerkin:degree=%d", degree);
  dvi_status status = dvi_integrator_create(scene->system, method, &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  for (long i = 0; i < steps && status == DVI_OK; i++) {
    if (progress != NULL && i % PROGRESS_STEPS == 0) progress_show(progress, -1.0, "judge");
    status = dvi_integrator_step(integrator, t_end / (double)steps);
  }
  if (status == DVI_OK) memcpy(q, dvi_integrator_q(integrator), (size_t)scene->n * sizeof *q);
  dvi_integrator_destroy(&integrator);
  return status;
}

static comparison compare(int n, const double *a, const double *b)
{
  comparison found = {0.0, 0.0};
  for (int i = 0; i < n; i++) {
    found.distance = fmax(found.distance, fabs(a[i] - b[i]));
    found.size = fmax(found.size, fabs(a[i]));
  }
  return found;
}

static void keep(judgement *judge, int n, const double *ends, double distance, const long *steps)
{
  memcpy(judge->q, ends, (size_t)n * sizeof *ends);
  memcpy(judge->other, ends + n, (size_t)n * sizeof *ends);
  judge->error = distance;
  (void)snprintf(judge->words, sizeof judge->words, "two runs of galerkin, degree %d in %ld steps and degree %d in %ld",
                 (int)DEGREE, steps[0], (int)OTHER_DEGREE, steps[1]);
}

/* ends: room for [2][n]. Equal ends are no proof of no error: the last place remains. */
static dvi_status refine(judgement *judge, const problem *scene, double t_end, progress_line *progress, double *ends)
{
  const int n = scene->n;
  dvi_status failure = DVI_OK;
  double steps = fmax(2.0, ceil(fabs(t_end) / (first_step * scene->h)));
  judge->error = HUGE_VAL;
  for (int level = 0; level < LEVELS_MAX && (level == 0 || other_ratio * steps <= steps_max); level++, steps *= 2.0) {
    const long both[2] = {lround(steps), lround(ceil(other_ratio * steps))};
    dvi_status status = run_once(scene, DEGREE, both[0], t_end, progress, ends);
    if (status == DVI_OK) status = run_once(scene, OTHER_DEGREE, both[1], t_end, progress, ends + n);
    if (status < 0) return status;
    if (status != DVI_OK) {
      failure = status; /* a smaller step may succeed */
      continue;
    }
    const comparison ends_of = compare(n, ends, ends + n);
    const double distance = fmax(ends_of.distance, DBL_EPSILON * ends_of.size);
    const bool settled = judge->error <= agreement * ends_of.size && !(distance < 0.5 * judge->error);
    if (distance < judge->error) keep(judge, n, ends, distance, both);
    if (settled) break;
  }
  return isfinite(judge->error) ? DVI_OK : failure;
}

dvi_status judge_by_runs(judgement *judge, const problem *scene, double t_end, progress_line *progress)
{
  const size_t n = (size_t)scene->n;
  double *ends = calloc(2 * n, sizeof *ends);
  judge->other = calloc(n, sizeof *judge->other);
  const dvi_status status = ends != NULL && judge->other != NULL ? refine(judge, scene, t_end, progress, ends) : DVI_NO_MEMORY;
  free(ends);
  return status;
}
