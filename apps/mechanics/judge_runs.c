#include "mechanics/judge_runs.h"
#include "mechanics/field_motion.h"
#include "study/norms.h"

#include <dvi/scene.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The runs do not share their polynomials. The ends of their steps differ as well, except the first
 * and the last, because the numbers of steps differ by a factor near the golden ratio. At every
 * level both halve their steps. Two runs may agree by luck, so the ends of the level before must
 * agree, too. The error is the largest distance of these four from each other. */
enum { LEVELS_MAX = 16, PROGRESS_STEPS = 256, MANY_COORDINATES = 64 };
static const double other_ratio = 1.618;
/* multiple of the problem's own step in a first run of low degree */
static const double first_step = 8.0;
static const double steps_max = 1L << 20; /* limit of a run */
/* Relative error above which an error that does not fall may still be one of steps that are too
 * large. */
static const double agreement = 1e-6;

/* A method, and the key and its two values in which the runs differ. */
typedef struct runner {
  const char *method, *key;
  int value[2];
  bool marches; /* it is a march of the scene's field */
} runner;

static const runner galerkin = {.method = "galerkin", .key = "degree", .value = {16, 12}},
                    lie_galerkin = {.method = "lie-galerkin", .key = "degree", .value = {16, 12}},
                    vprk = {.method = "vprk", .key = "nodes", .value = {6, 5}},
                    dg_phase = {.method = "dg-phase", .key = "degree", .value = {6, 5}},
                    hamiltonian = {.method = "hamiltonian", .key = "degree", .value = {6, 5}},
                    gauss = {.method = "gauss", .key = "stages", .value = {6, 5}, .marches = true};

/* Return whether the scene's field has marches by Gauss stages, as Schroedinger's equation does.
 * They go forward. */
static bool has_march(const problem *scene, double t_end)
{
  const char *section;
  return t_end > 0 && dvi_scene_marches(scene->scene, gauss.method) &&
         dvi_scene_march_refused(scene->scene, gauss.method, &section) == NULL;
}

/* With many coordinates a march is far cheaper than vprk, and needs no second derivatives. */
static const runner *runner_for(const problem *scene, double t_end)
{
  const dvi_system_terms *terms = scene->terms;
  if (terms->hamiltonian != NULL) return terms->constraint != NULL ? &dg_phase : &hamiltonian;
  if (terms->factors != NULL) return &lie_galerkin;
  if (terms->one_form == NULL) return &galerkin;
  return scene->nq >= MANY_COORDINATES && has_march(scene, t_end) ? &gauss : &vprk;
}

/* The ends of the runs. */
typedef struct levels {
  const runner *by;
  double *now;    /* [2][n] ends by the first value and by the second */
  double *before; /* [2][n] ends of the level before */
  bool follows;   /* there was a level before */
  double best;    /* smallest error so far of two levels that follow each other */
} levels;

static dvi_status run_once(const problem *scene, const runner *by, int which, long steps,
                           double t_end, progress_line *progress, double *q)
{
  char method[32];
  dvi_integrator *integrator = NULL;
  (void)snprintf(method, sizeof method, "%s:%s=%d", by->method, by->key, by->value[which]);
  if (by->marches) {
    if (progress != NULL) progress_show(progress, -1.0, "judge");
    return field_motion(scene, method, (double)steps, t_end, false, q, NULL);
  }
  dvi_status status = dvi_integrator_create(scene->system, method, &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  for (long i = 0; i < steps && status == DVI_OK; i++) {
    if (progress != NULL && i % PROGRESS_STEPS == 0) progress_show(progress, -1.0, "judge");
    status = dvi_integrator_step(integrator, t_end / (double)steps);
  }
  if (status == DVI_OK) memcpy(q, dvi_integrator_q(integrator), (size_t)scene->nq * sizeof *q);
  dvi_integrator_destroy(&integrator);
  return status;
}

/* Return the largest distance of any two ends, and at least the last place, because equal ends do
 * not prove that there is no error. */
static double spread_of(const levels *l, int n)
{
  const double *const end[4] = {l->now, l->now + n, l->before, l->before + n};
  double apart = DBL_EPSILON * norm_largest(n, l->now);
  for (int i = 0; i < (l->follows ? 4 : 2); i++)
    for (int j = 0; j < i; j++) apart = fmax(apart, norm_distance(n, end[i], end[j]));
  return apart;
}

static void keep_ends(judgement *judge, int n, const runner *by, const double *ends, double error,
                      const long *steps)
{
  memcpy(judge->q, ends, (size_t)n * sizeof *ends);
  memcpy(judge->other, ends + n, (size_t)n * sizeof *ends);
  judge->error = error;
  (void)snprintf(judge->words, sizeof judge->words,
                 "two runs of %s, %s %d in %ld steps and %s %d in %ld", by->method, by->key,
                 by->value[0], steps[0], by->key, by->value[1], steps[1]);
}

/* Take the ends of a level. Returns true if the next level will not be better. */
static bool take_level(judgement *judge, int n, levels *l, const long *steps)
{
  const double error = spread_of(l, n);
  const bool settled = l->best <= agreement * norm_largest(n, l->now) && !(error < 0.5 * l->best);
  if (error < l->best) keep_ends(judge, n, l->by, l->now, error, steps);
  if (l->follows) l->best = fmin(l->best, error);
  double *room = l->before;
  l->before = l->now;
  l->now = room;
  l->follows = true;
  return settled;
}

static dvi_status refine_runs(judgement *judge, const problem *scene, double t_end,
                              progress_line *progress, levels *l)
{
  const int n = scene->nq;
  dvi_status failure = DVI_OK;
  double steps = fmax(2.0, ceil(fabs(t_end) / (first_step * scene->h)));
  for (int level = 0; level < LEVELS_MAX && (level == 0 || other_ratio * steps <= steps_max);
       level++, steps *= 2.0) {
    const long both[2] = {lround(steps), lround(ceil(other_ratio * steps))};
    dvi_status status = run_once(scene, l->by, 0, both[0], t_end, progress, l->now);
    if (status == DVI_OK) status = run_once(scene, l->by, 1, both[1], t_end, progress, l->now + n);
    if (status < 0) return status;
    if (status > 0)
      failure = status; /* a smaller step may succeed */
    else if (take_level(judge, n, l, both))
      break;
  }
  return l->follows ? DVI_OK : failure;
}

dvi_status judge_by_runs(judgement *judge, const problem *scene, double t_end,
                         progress_line *progress)
{
  const size_t n = (size_t)scene->nq;
  double *ends = calloc(4 * n, sizeof *ends);
  judge->other = calloc(n, sizeof *judge->other);
  levels l = {
      .by = runner_for(scene, t_end), .now = ends, .before = ends + 2 * n, .best = HUGE_VAL};
  const dvi_status status = ends != NULL && judge->other != NULL
                                ? refine_runs(judge, scene, t_end, progress, &l)
                                : DVI_NO_MEMORY;
  free(ends);
  return status;
}
