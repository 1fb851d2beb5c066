/* A step's equations are solved in quadruple precision (quad_step.c), and compared with the
 * solution (quad_motion.c). The proof has two halves, because the program in quadruple precision is
 * not the library. The errors have the order, and the library takes the same step at the largest
 * step size, where doubles still show the error.
 *
 * Steps are centred. From -h/2 to h/2 about a fixed time the error of a symmetric method is h^(p+1)
 * times a series in h^2, and is dominated by its leading term twice as fast as from a fixed
 * start. */
#include "mechanics/single_steps.h"

#include <dvi/study.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "load/catalogue.h"
#include "mechanics/quad_step.h"

/* The errors of single steps have a slope of one more than the order. */
static const closer_look look = {
    .asked = true,
    .of = "single steps",
    .digits = "in quadruple precision",
    .unlike = "is the Lagrangian smooth all along the motion? (abs and roots of 0 are not)",
    .excess = 1.0};

#ifdef QUAD_EXISTS
enum { SEARCH_TRIES = 60, N_MAX = 64 };
/* Error of the steps that are compared with the library's, above its rounding errors. */
static const double common_error = 1e-10;
static const double first_error = 1e-18,
                    /* last error of the levels, 100 rounding errors of the judge */
    last_error = 1e-28;
/* Steps of the run to the points, in one step of the problem. */
static const double guide_method_steps = 4.0;
/* largest difference of the library's step, relative to the first error */
static const double sameness = 0.01;

/* A point of the motion. */
typedef struct centre {
  double t;
  quad *z, *v; /* [2 n], [n] */
} centre;

typedef struct study {
  const problem *scene;
  const char *method;
  dvi_integrator *integrator;
  dvi_scene *read; /* scene of the catalogue, or NULL if the problem is a scene itself */
  quad_motion motion;
  quad_step *step;
  centre centre[SINGLE_POINTS];
  quad *room; /* [SINGLE_POINTS + 2][3 n] memory of the centres */
  double *state;
  int order;
  progress_line *progress;
} study;

/* Return the scene behind a problem, for its expressions, or NULL if there is none. */
static const dvi_scene *expressions_of(study *s, const words *settings)
{
  if (s->scene->scene != NULL) return s->scene->scene;
  for (const catalogue_text *at = catalogue_texts; at->name != NULL; at++)
    if (strcmp(at->name, s->scene->name) == 0 &&
        dvi_scene_parse(at->name, at->text, at->length, settings->count, settings->word, &s->read,
                        NULL, 0) != DVI_OK)
      return NULL;
  return s->read;
}

/* Move to the points on the motion by runs in doubles. Points near the motion are good enough. */
static dvi_status place_centres(study *s, double t_end)
{
  const int n = s->scene->nq;
  dvi_integrator *guide = NULL;
  dvi_status status = dvi_integrator_create(s->scene->system, "galerkin:degree=6", &guide);
  if (status == DVI_OK) status = dvi_integrator_start(guide, 0.0, s->scene->q, s->scene->p);
  const double each = t_end / SINGLE_POINTS;
  for (int k = 0; k < SINGLE_POINTS && status == DVI_OK; k++) {
    centre *c = &s->centre[k];
    c->t = (k + 0.5) * each;
    const double way = c->t - dvi_integrator_time(guide);
    const long steps = lround(ceil(guide_method_steps * fabs(way) / s->scene->order_h));
    for (long i = 0; i < steps && status == DVI_OK; i++)
      status = dvi_integrator_step(guide, way / (double)steps);
    c->z = s->room + 3 * n * k;
    c->v = c->z + 2 * n;
    for (int i = 0; i < n; i++) {
      c->z[i] = (quad)dvi_integrator_q(guide)[i];
      c->z[n + i] = (quad)dvi_integrator_p(guide)[i];
      c->v[i] = (quad)s->scene->v[i];
    }
  }
  dvi_integrator_destroy(&guide);
  return status;
}

/* Measure the sizes of q and p over all centres, because either may vanish at one of them. */
static void measure_motion_sizes(study *s)
{
  const int n = s->scene->nq;
  double q = 0.0, p = 0.0;
  for (int k = 0; k < SINGLE_POINTS; k++) {
    q = fmax(q, quad_largest(n, s->centre[k].z));
    p = fmax(p, quad_largest(n, s->centre[k].z + n));
  }
  s->motion.q_size = q > 0.0 ? q : 1.0;
  s->motion.p_size = p > 0.0 ? p : 1.0;
}

/* Compute the mass and the velocity at a centre, first with the velocity of the start, then with
 * its own. */
static bool settle_centre(study *s, const centre *c)
{
  const int n = s->scene->nq;
  for (int i = 0; i < 2; i++)
    if (!quad_motion_settle(&s->motion, (quad)c->t, c->z, c->v) ||
        !quad_motion_velocity(&s->motion, (quad)c->t, c->z, c->z + n, c->v))
      return false;
  return true;
}

/* Compute the error of the step of h about a centre. start [2 n] is the start of the step.
 * *judge_error is the wanted error on entry, and the actual one on return. */
static bool step_error(study *s, const centre *c, double h, quad *start, double *error,
                       double *judge_error)
{
  const size_t n = (size_t)s->scene->nq;
  quad *end = start + 2 * n, *step = end + 2 * n;
  const quad half = (quad)(0.5 * h), t = (quad)c->t;
  const double wanted = *judge_error;
  double of_start = wanted, of_end = wanted;
  memcpy(start, c->z, 2 * n * sizeof *start);
  memcpy(end, c->z, 2 * n * sizeof *end);
  if (!settle_centre(s, c) || !quad_motion_flow(&s->motion, t, -half, c->v, start, &of_start) ||
      !quad_motion_flow(&s->motion, t, half, c->v, end, &of_end))
    return false;
  memcpy(step, start, 2 * n * sizeof *step);
  if (!quad_step_take(s->step, &s->motion, t - half, 2 * half, c->v, step)) return false;
  *error = quad_motion_distance(&s->motion, step, end);
  *judge_error = fmax(of_start, of_end);
  return true;
}

/* Compute the error of a step of h, over all points. It will be about `foreseen`, and the judge's
 * own error is to be a small part of it. */
static bool mean_step_error(study *s, double h, double foreseen, double *error, double *judge_error)
{
  static const double part = 1e-4;
  double squares = 0.0;
  quad *start = s->room + 3 * s->scene->nq * SINGLE_POINTS;
  *judge_error = 0.0;
  for (int k = 0; k < SINGLE_POINTS; k++) {
    double one, of_judge = part * foreseen;
    progress_show(s->progress, -1.0, "single steps");
    if (!step_error(s, &s->centre[k], h, start, &one, &of_judge)) return false;
    squares += one * one;
    *judge_error = fmax(*judge_error, of_judge);
  }
  *error = sqrt(squares / SINGLE_POINTS);
  return isfinite(*error);
}

/* Search for the step that is compared with the library's. Returns 0 if there is none. The claimed
 * order is only a guess of how errors fall. */
static double find_common(study *s, double *of_common)
{
  double h = copysign(s->scene->order_h, s->centre[0].t), error = 0.0, judge_error = 0.0;
  for (int i = 0; i < SEARCH_TRIES; i++) {
    const bool good = mean_step_error(s, h, common_error, &error, &judge_error);
    if (good && error > 0.1 * common_error && error < 10.0 * common_error) {
      *of_common = error;
      return h;
    }
    h *= !good ? 0.5 : fmin(fmax(pow(common_error / error, 1.0 / (s->order + 1.0)), 0.25), 2.0);
  }
  return 0.0;
}

/* Compare the library's step from a centre with that in quadruple precision, from the same
 * doubles. */
static bool compare_with_library(study *s, const centre *c, double h, double *apart)
{
  const int n = s->scene->nq;
  quad *start = s->room + 3 * n * SINGLE_POINTS, *mine = start + 2 * n;
  double error, judge_error = common_error, *z = s->state;
  const double t = c->t - 0.5 * h;
  if (!step_error(s, c, h, start, &error, &judge_error)) return false;
  for (int i = 0; i < 2 * n; i++) z[i] = (double)start[i], start[i] = (quad)z[i];
  if (!quad_step_take(s->step, &s->motion, (quad)t, (quad)h, c->v, start)) return false;
  if (dvi_integrator_start(s->integrator, t, z, z + n) != DVI_OK ||
      dvi_integrator_step(s->integrator, h) != DVI_OK)
    return false;
  for (int i = 0; i < n; i++) {
    mine[i] = (quad)dvi_integrator_q(s->integrator)[i];
    mine[n + i] = (quad)dvi_integrator_p(s->integrator)[i];
  }
  *apart = fmax(*apart, quad_motion_distance(&s->motion, mine, start));
  return true;
}

/* The evidence of a measurement. */
typedef struct evidence {
  double judge_error; /* largest error of the solutions that the smallest steps are compared with */
  double common_h, common_error; /* length and error of larger steps, which doubles show, too */
  double apart; /* largest distance between the library's own steps of that length and these */
} evidence;

/* Fit the order to the slope of the errors over the lengths of their steps. */
static void fit_levels(closer_look *found, double judge_error)
{
  double of_unit[SINGLE_LEVELS];
  for (int k = 0; k < SINGLE_LEVELS; k++) of_unit[k] = found->error[k] / found->length[k];
  const double floor = 10.0 * judge_error / found->length[SINGLE_LEVELS - 1];
  found->settled = dvi_study_fit(SINGLE_LEVELS, found->length, of_unit, floor, HUGE_VAL,
                                 &found->fit);
}

static const char *measure_levels(study *s, closer_look *found, evidence *rests)
{
  double of_common = 0.0;
  measure_motion_sizes(s);
  const double common = find_common(s, &of_common),
               fall = pow(last_error / first_error, 1.0 / (SINGLE_LEVELS - 1));
  if (!(fabs(common) > 0.0))
    return "no step was found that can be solved and has an error near 1e-10";
  for (int k = 0; k < SINGLE_LEVELS; k++) {
    const double foreseen = first_error * pow(fall, k),
                 h = common * pow(foreseen / of_common, 1.0 / (s->order + 1.0));
    if (!mean_step_error(s, h, foreseen, &found->error[k], &rests->judge_error))
      return "their equations could not be solved";
    found->length[k] = fabs(h);
  }
  for (int k = 0; k < SINGLE_POINTS; k++)
    if (!compare_with_library(s, &s->centre[k], common, &rests->apart))
      return "the library's own step of that length fails";
  if (!(rests->apart <= sameness * of_common))
    return "the library's own steps are not those in quadruple precision";
  rests->common_error = of_common;
  rests->common_h = fabs(common);
  fit_levels(found, rests->judge_error);
  return NULL;
}

static void describe_evidence(closer_look *found, double t_end, const evidence *rests)
{
  (void)snprintf(found->title, sizeof found->title,
                 "single steps from %d points to t = %g, in quadruple precision",
                 (int)SINGLE_POINTS, t_end);
  (void)snprintf(found->judge, sizeof found->judge,
                 "judge of the steps: extrapolation, error %.1e; with h = %.3g and an error of "
                 "%.1e the library's own steps are %.1e from these",
                 rests->judge_error, rests->common_h, rests->common_error, rests->apart);
}

static dvi_status prepare_study(study *s, const words *settings, double t_end, closer_look *found)
{
  const size_t n = (size_t)s->scene->nq;
  const dvi_scene *expressions = s->scene->velocity == NULL && n <= N_MAX
                                     ? expressions_of(s, settings)
                                     : NULL;
  dvi_status status = dvi_integrator_create(s->scene->system, s->method, &s->integrator);
  if (status != DVI_OK) return status;
  s->order = dvi_integrator_order(s->integrator);
  s->step = quad_step_create(dvi_integrator_method(s->integrator), (int)n);
  if (s->step == NULL)
    found->missing =
        "they are there for galerkin with Gauss, Lobatto and Radau quadratures of up to 16 points";
  if (s->step != NULL && expressions == NULL)
    found->missing =
        "they are there for Lagrangians of R^n with expressions, of up to 64 coordinates";
  if (found->missing != NULL) return DVI_OK;
  s->room = calloc(3 * n * SINGLE_POINTS + 6 * n, sizeof *s->room);
  s->state = calloc(2 * n, sizeof *s->state);
  if (s->room == NULL || s->state == NULL || !quad_motion_init(&s->motion, expressions, (int)n))
    return DVI_NO_MEMORY;
  return place_centres(s, t_end);
}

dvi_status single_steps_measure(const problem *scene, const words *settings, const char *method,
                                double t_end, progress_line *progress, closer_look *found)
{
  study s = {.scene = scene, .method = method, .progress = progress};
  evidence rests = {0};
  *found = look;
  found->levels = SINGLE_LEVELS;
  const dvi_status status = prepare_study(&s, settings, t_end, found);
  if (status == DVI_OK && found->missing == NULL)
    found->missing = measure_levels(&s, found, &rests);
  describe_evidence(found, t_end, &rests);
  quad_step_destroy(&s.step);
  quad_motion_clear(&s.motion);
  dvi_integrator_destroy(&s.integrator);
  dvi_scene_destroy(&s.read);
  free(s.room);
  free(s.state);
  return status;
}
#else
dvi_status single_steps_measure(const problem *scene, const words *settings, const char *method,
                                double t_end, progress_line *progress, closer_look *found)
{
  (void)scene, (void)settings, (void)method, (void)t_end, (void)progress;
  *found = look;
  found->missing = "there is no arithmetic of 113 bits on this machine";
  return DVI_OK;
}
#endif
