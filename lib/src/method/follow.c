/* The rows of a step that turns by a radian have several solutions, and on thin bodies, which turn fast as soon as their path errs, they stand close. Which one
 * Newton's method finds is chance, unless the guess is near. The one that is meant becomes the state itself as h goes to 0; it is followed from there, by longer
 * and longer steps, each guess the last path continued: continuation in h. */
#include "method/follow.h"

#include <math.h>
#include <string.h>

#include "core/status.h"

/* Radians between a guess and its solution. Other solutions were found by a third of a radian and more away, but by a fortieth where the smallest moment of
 * inertia is 1e-5 of the others. Steps below half a radian are nearer to their guess, those that are followed go on in such parts that they are. */
static const double near_by = 0.03, follows_by = 0.01;

/* In parts of the step: the first one, and the least by which it grows. */
static const double first_part = 1.0 / 8, least_part = 1.0 / 4096;

/* As h goes to 0 the Jacobian is the mass times a positive matrix over h. On the way to another solution beyond a fold its determinant is 0. */
int dvi__follow_is_meant(const dvi__action *action, const dvi__solver *solver, double h, const double *guess, const double *Y)
{
  const int sign = h < 0 && dvi__action_unknowns(action) % 2 != 0 ? -1 : 1;
  return (!dvi__action_signs(action) || dvi__solver_sign(solver) == sign) && dvi__action_turn(action, guess, Y) <= near_by;
}

/* The path continued over a step `ratio` times as long. */
static void stretch(const dvi__follow *own, double ratio, const double *Y, double *longer)
{
  const double *tau = dvi__action_fit_points(own->action);
  const size_t n = (size_t)own->n, s = (size_t)dvi__action_unknowns(own->action) / n;
  for (size_t m = 0; m < s; m++) {
    dvi__action_path(own->action, Y, 1.0, ratio * tau[m], own->v, NULL);
    for (size_t i = 0; i < n; i++) own->guess[i * s + m] = own->v[i];
  }
  dvi__action_fit(own->action, own->guess, longer);
}

/* What is followed is the path of a step `done` of the whole; of a step 0 the velocity. */
static dvi_status guess(const dvi__follow *own, double done, double next, const double *Y, double *longer)
{
  dvi__action_place(own->action, own->t, next * own->h, own->q, own->p);
  if (done > 0) {
    stretch(own, next / done, Y, longer);
    return DVI_OK;
  }
  memset(own->v, 0, (size_t)own->n * sizeof(double));
  DVI_TRY(dvi__legendre_inverse(dvi__action_evaluator(own->action), own->t, own->q, own->p, own->v));
  dvi__action_straight(own->action, own->v, longer);
  return DVI_OK;
}

static dvi_status lost(const dvi__follow *own, double done, const double *Y)
{
  if (done == 0)
    return dvi__fail(DVI_STEP_TOO_LARGE, "a step too large: not even that of h = %.3g has a path", least_part * own->h);
  dvi__action_path(own->action, Y, 1.0, 1.0, own->v, NULL);
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "a step too large: its path continues those of shorter steps up to h = %.3g, where it turns by %.3g; the bound "
                   "of a chart is half a turn",
                   done * own->h, dvi__action_turned(own->action, own->v));
}

dvi_status dvi__follow_path(const dvi__follow *own, double *Y, dvi__solve_report *report)
{
  const size_t bytes = (size_t)dvi__action_unknowns(own->action) * sizeof(double);
  double done = 0, part = first_part;
  int sign = 0;
  while (done < 1 && part >= least_part) {
    const double next = fmin(1, done + part);
    DVI_TRY(guess(own, done, next, Y, own->ahead));
    memcpy(own->guess, own->ahead, bytes);
    const dvi_status status = dvi__solve(own->solver, DVI__NEWTON, 0, 1, 0, own->ahead, report);
    if (status < 0) return status;
    const int folded = done > 0 && dvi__action_signs(own->action) && dvi__solver_sign(own->solver) != sign;
    const int follows = status == DVI_OK && !folded && dvi__action_turn(own->action, own->guess, own->ahead) <= follows_by;
    part *= follows ? 2 : 0.5;
    if (!follows) continue;
    memcpy(Y, own->ahead, bytes);
    sign = dvi__solver_sign(own->solver);
    done = next;
  }
  return done < 1 ? lost(own, done, Y) : DVI_OK;
}
