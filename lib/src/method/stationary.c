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

static dvi_status solve_at_once(const dvi__stationary *s, const dvi__stationary_step *step)
{
  dvi__solve_report report;
  DVI_TRY(step->place(step->stepper, step->state, step->h, 1));
  DVI_TRY(step->guess(step->stepper, step->h, s->x));
  DVI_TRY(dvi__solve(s->solver, DVI__NEWTON, stationary_size_of(step), 1, 0, s->x, &report));
  step->stepper->counters->newtons++;
  step->stepper->bend = fmax(step->stepper->bend, report.bend);
  /* more than fast convergence takes, with a foreseen end */
  if (report.iterations <= 3 || dvi__branch_is_near(&report)) return DVI_OK;
  const dvi__doubt doubt = dvi__branch_is_straight(&report) ? DVI__LINEAR : DVI__DOUBTED;
  if (doubt > step->stepper->doubt) step->stepper->doubt = doubt;
  return DVI_OK;
}

dvi_status dvi__stationary_solve(const dvi__stationary *s, const dvi__stationary_step *step)
{
  const int asked = step->stepper->follow;
  const dvi_status status = asked ? DVI_OK : solve_at_once(s, step);
  return status > 0 || asked ? stationary_follow(s, step, status) : status;
}
