#include "study/levels.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SEARCH_TRIES = 40, ROOM_LEVELS = 6 };
static const long search_max =
    1L << 17; /* of one that is searched: the search shall end within seconds */
static const long finest_max = 1L << 22; /* of the last level after that one */
static const double level_room =
    1e5; /* first error over the floor, at least: five decades for the levels */

static double within(double x, double low, double high)
{
  return fmin(fmax(x, low), high);
}

/* Where the first level's error should lie. A high order shows late, when the terms beyond the
 * leading one have died out, but passes its few levels in many digits; a low order needs steps
 * without number to come near the floor. */
static double first_target(const order_study *s)
{
  if (s->first_error > 0.0) return s->first_error * study_size(s);
  const double digits = fmax(3.0 + 0.5 * s->order, fmin(1.0 + s->order, 15.0));
  return within(level_room * s->floor, pow(10.0, -digits) * study_size(s), 0.1 * s->ceiling);
}

/* The number of steps, strictly between too few and enough (0: not known), that the order foretells
 * from one error. */
static long next_guess(const order_study *s, long steps, double error, double target, long too_few,
                       long enough)
{
  const double factor = isfinite(error) ? within(pow(error / target, 1.0 / s->order), 0.25, 4.0)
                                        : 2.0;
  const double high = enough > 0 ? (double)enough - 1.0 : (double)search_max;
  return lround(within(ceil((double)steps * factor), (double)too_few + 1.0, high));
}

/* Search for the first level, of more steps than too_few: the error nearest below three times the
 * target. A step too large to solve is too rough. */
static dvi_status find_first(order_study *s, long too_few, level_trial *first)
{
  const double target = first_target(s);
  level_trial fine = {0}; /* the last one below; of no steps: there is none yet */
  long steps = lround(
      within(ceil(fabs(s->span) / s->scene->order_h), (double)too_few + 1.0, (double)search_max));
  for (int i = 0; i < SEARCH_TRIES; i++) {
    const dvi_status status = study_run(s, steps, first);
    if (status < 0) return status;
    const double error = status == DVI_OK ? first->error : (double)NAN;
    if (error <= 3.0 * target && error >= 0.1 * target) return DVI_OK;
    if (error <= 3.0 * target)
      fine = *first;
    else
      too_few = steps;
    if (too_few + 1 == fine.steps || too_few >= search_max) break;
    steps = next_guess(s, steps, error, target, too_few, fine.steps);
  }
  if (fine.steps == 0) return study_run(s, too_few, first);
  *first = fine;
  return DVI_OK;
}

/* A start that differs from the problem's in the last place. */
static void disturb(const order_study *s, double *q)
{
  const double size = study_size(s);
  for (int i = 0; i < s->scene->nq; i++) {
    const double place = DBL_EPSILON * fmax(fabs(s->scene->q[i]), 0.1 * size);
    q[i] = s->scene->q[i] + (i % 2 == 0 ? place : -place);
  }
}

/* What roundoff does to the end: how far a change of the start in its last place moves it. The
 * disturbed start is projected: where a constraint is made of numbers that are 0, even the last
 * place of the others is off it. */
static dvi_status find_floor(order_study *s, long steps)
{
  const int n = s->scene->nq;
  double *q = calloc(2 * (size_t)n, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *end = q + n;
  disturb(s, q);
  dvi_status status = study_integrate(s, q, &(dvi_start_options){.project = 1}, steps);
  if (status == DVI_OK) {
    memcpy(end, dvi_integrator_q(s->integrator), (size_t)n * sizeof *end);
    status = study_integrate(s, s->scene->q, NULL, steps);
  }
  double moved = DBL_EPSILON * study_size(s);
  for (int i = 0; i < n && status == DVI_OK; i++)
    moved = fmax(moved, fabs(end[i] - dvi_integrator_q(s->integrator)[i]));
  free(q);
  s->floor = STUDY_FLOOR_MARGIN * fmax(s->judge->error, moved);
  return status;
}

/* The first level, and the floor there. One that cannot be solved from the disturbed start hangs on
 * roundoffs: it is too rough, too. */
static dvi_status find_first_and_floor(order_study *s, level_trial *first)
{
  long too_few = 0;
  dvi_status status = find_first(s, too_few, first);
  while (status == DVI_OK && (status = find_floor(s, first->steps)) > 0 &&
         first->steps < search_max) {
    too_few = first->steps;
    status = find_first(s, too_few, first);
  }
  return status == DVI_OK ? find_first(s, too_few, first)
                          : status; /* now that the floor is known */
}

/* The ratio that leads from the first error to a little above the floor, with at most so many steps
 * if it can be. */
static double choose_ratio(const order_study *s, const level_trial *first, int levels,
                           double finest)
{
  const double span = first->error / (3.0 * s->floor);
  const double ratio = span > 1.0 && levels > 1 ? pow(span, 1.0 / (s->order * (levels - 1.0)))
                                                : 1.0;
  const double most = levels > 1 ? pow(finest / (double)first->steps, 1.0 / (levels - 1.0)) : 2.0;
  return within(ratio, 1.05, within(most, 1.05, 2.0));
}

/* Whether so many levels, each with one step more than the one before, stay above the floor. */
static bool has_room(const order_study *s, const level_trial *first, int levels)
{
  const double finest = (double)(first->steps + levels - 1);
  return first->error * pow((double)first->steps / finest, s->order) > s->floor;
}

/* Whether even many steps fail, or end where the solution is not: finer ones cost much and tell
 * nothing. */
static bool is_lost(const order_study *s, dvi_status status, const level_trial *first)
{
  static const double far = 10.0; /* times the largest error that tells an order */
  return dvi_integrator_monitor(s->integrator) != NULL &&
         (status > 0 || (status == DVI_OK && !(first->error <= far * s->ceiling)));
}

dvi_status choose_levels(order_study *study, double h, double ratio, int levels, long *steps,
                         bool *room)
{
  level_trial first;
  const double wanted = h > 0.0 ? within(fabs(study->span) / h, 1.0, (double)FIRST_STEPS_MAX) : 0.0;
  dvi_status status = wanted > 0.0 ? study_run(study, lround(wanted), &first)
                                   : find_first_and_floor(study, &first);
  if (status == DVI_OK && wanted > 0.0) status = find_floor(study, first.steps);
  steps[0] = 0;
  if (!(wanted > 0.0) && is_lost(study, status, &first)) return DVI_OK;
  if (status != DVI_OK) return status;
  *room = has_room(study, &first, levels < ROOM_LEVELS ? levels : ROOM_LEVELS);
  const double factor = ratio > 0.0 ? ratio
                                    : choose_ratio(study, &first, levels,
                                                   wanted > 0.0 ? HUGE_VAL : (double)finest_max);
  steps[0] = first.steps;
  for (int k = 1; k < levels; k++) {
    steps[k] = lround((double)first.steps * pow(factor, k));
    if (steps[k] <= steps[k - 1]) steps[k] = steps[k - 1] + 1;
  }
  return DVI_OK;
}
