#include "method/stationary.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

/* ---- create ---- */

dvi_status dvi__stationary_create(dvi__stepper *self, dvi__equations *equations,
                                  dvi__stationary *stationary)
{
  const size_t unknowns = (size_t)equations->unknowns;
  self->follows = 1;
  stationary->x = DVI_NEW(double, unknowns);
  stationary->room = DVI_NEW(double, (DVI__BRANCH_ROOM * unknowns));
  if (stationary->x == NULL || stationary->room == NULL)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %zu unknowns", self->method->name, unknowns);
  equations->linear = dvi__linear_for_exchanges(equations->unknowns);
  stationary->has_iteration = equations->fixed_point_iterate != NULL;
  stationary->frozen = equations->fixed_point_frozen;
  return dvi__solver_create(equations, self->counters, &stationary->solver);
}

void dvi__stationary_clear(dvi__stationary *stationary)
{
  dvi__solver_destroy(&stationary->solver);
  dvi__release(stationary->x);
  dvi__release(stationary->room);
}

/* ---- solve ---- */

static dvi_status stationary_place_part(void *of, double part)
{
  const dvi__stationary_step *step = of;
  return step->place(step->stepper, step->state, part * step->h, part);
}

static dvi_status stationary_guess_part(void *of, double part, double *x)
{
  const dvi__stationary_step *step = of;
  return step->guess(step->stepper, part * step->h, x);
}

static double stationary_size_of(const dvi__stationary_step *step)
{
  return dvi__largest((size_t)step->stepper->system->n, step->state->q);
}

static dvi_status stationary_follow(const dvi__stationary *s, const dvi__stationary_step *step,
                                    dvi_status whole)
{
  dvi__stationary_step of = *step;
  const dvi__branch branch = {.of = &of,
                              .place = stationary_place_part,
                              .guess = stationary_guess_part,
                              .near = DVI__BRANCH_NEAR,
                              .parts = step->stepper->follow > 0 ? step->stepper->follow : 1,
                              .signs = 1,
                              .size = stationary_size_of(step),
                              .room = s->room};
  dvi__branch_failure failure;
  dvi__branch_end end;
  dvi__branch_note(whole, s->solver, &failure);
  step->stepper->counters->followed++;
  step->stepper->counters->newtons += !step->stepper->follow;
  const dvi_status status = dvi__branch_follow(&branch, s->solver, s->x, &end);
  if (status > 0 && end.ends) step->stepper->doubt = DVI__ASTRAY;
  return status <= 0 ? status : dvi__branch_tell(&end, step->h, &failure);
}

/* Try one rung from the guess. */
static dvi_status stationary_try(const dvi__stationary *s, const dvi__stationary_step *step,
                                 dvi__rung rung, dvi__solve_report *report)
{
  DVI_TRY(step->place(step->stepper, step->state, step->h, 1));
  DVI_TRY(step->guess(step->stepper, step->h, s->x));
  return dvi__solve(s->solver, rung, stationary_size_of(step), 1, 0, s->x, report);
}

/* Largest number of steps that skip the iteration after it failed. It is one at first, and doubles
 * with each failure. */
static const double longest_wait = 64;

/* Judge the branch by the way to a solution, where a method of Newton's led there. */
static void stationary_judge(dvi__stepper *stepper, const dvi__solve_report *report)
{
  const dvi__doubt doubt = dvi__branch_is_straight(report) ? DVI__LINEAR : DVI__DOUBTED;
  stepper->bend = fmax(stepper->bend, report->bend);
  if (!dvi__branch_is_near(report) && doubt > stepper->doubt) stepper->doubt = doubt;
}

/* Try the iteration, unless it failed lately. If its matrices are not those of the guess, success
 * leaves no doubt, because a contraction is one for all shorter steps, too. */
static dvi_status stationary_iterate(dvi__stationary *s, const dvi__stationary_step *step)
{
  enum { STEPS, LAST };
  dvi__solve_report report;
  double *wait = step->stepper->memory + s->ladder;
  if (wait[STEPS] > 0) {
    wait[STEPS]--;
    return DVI_NOT_CONVERGED;
  }
  const dvi_status status = stationary_try(s, step, DVI__FIXED_POINT, &report);
  s->iterated = status == DVI_OK;
  if (s->iterated) {
    dvi_counters *counters = step->stepper->counters;
    (*(s->frozen ? &counters->simplified : &counters->fixed_points))++;
  }
  if (s->iterated && s->frozen) stationary_judge(step->stepper, &report);
  wait[LAST] = s->iterated ? 0 : wait[LAST] == 0 ? 1 : fmin(2 * wait[LAST], longest_wait);
  wait[STEPS] = wait[LAST];
  return status;
}

static dvi_status stationary_newton(const dvi__stationary *s, const dvi__stationary_step *step)
{
  dvi__solve_report report;
  DVI_TRY(stationary_try(s, step, DVI__NEWTON, &report));
  step->stepper->counters->newtons++;
  if (report.iterations <= DVI__FAST_NEWTON)
    step->stepper->bend = fmax(step->stepper->bend, report.bend);
  else
    stationary_judge(step->stepper, &report);
  return DVI_OK;
}

dvi_status dvi__stationary_solve(dvi__stationary *s, const dvi__stationary_step *step)
{
  s->iterated = 0;
  if (step->stepper->follow) return stationary_follow(s, step, DVI_OK);
  if (s->has_iteration) {
    const dvi_status status = stationary_iterate(s, step);
    if (status <= 0) return status;
  }
  const dvi_status status = stationary_newton(s, step);
  return status > 0 ? stationary_follow(s, step, status) : status;
}
