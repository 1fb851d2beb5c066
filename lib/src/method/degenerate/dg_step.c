#include "method/degenerate/dg_step.h"

#include <math.h>

#include "num/finite.h"

const char *dvi__alarm_choice(int index)
{
  static const char *const name[] = {"stop", "warn"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

/* The memory holds the largest motion of a step so far, the jump [n], {q} - q* [n], and the
 * coefficients of the last element relative to q*, which the guess continues. */
enum { MOTION = DVI__CARRIED, JUMP };

typedef struct dg_step {
  dvi__one_step one;
  int alarm;
  const char *remedy;
  double part; /* admissible jump as a part of the largest motion */
} dg_step;

static double *dg_step_jump(const dvi__stepper *self)
{
  return self->memory + JUMP;
}

static double *dg_step_offset(const dvi__stepper *self)
{
  return dg_step_jump(self) + self->system->n;
}

/* ---- create ---- */

void dvi__explain_jumps(int alarm, dvi__text *text)
{
  dvi__text_add(text, "jumps: memory of the method; watched, %s\n",
                alarm == DVI__ALARM_STOP ? "an alarm stops the run" : "alarms are counted");
}

static void dg_step_explain(const dvi__stepper *self, dvi__text *text)
{
  dvi__explain_jumps(((const dg_step *)self->own)->alarm, text);
}

/* Scale the jump with the length of the step, to which it belongs. Otherwise the step would have no
 * rates. */
static dvi_status dg_step_place(dvi__stepper *self, const dvi__state *state, double h, double part)
{
  const dvi__one_step *one = self->own;
  const size_t n = (size_t)self->system->n;
  for (size_t i = 0; i < 2 * n; i++) one->carried[i] = part * dg_step_jump(self)[i];
  const dvi__dg_node node = {
      .q = state->q, .p = state->p, .jump = one->carried, .offset = one->carried + n};
  return dvi__discontinuous_place(one->of, state->t, h, &node);
}

DVI__STEP_PARTS(discontinuous)
DVI__STEP_KIND(discontinuous, dg_step_place, dg_step_explain, DVI__STEP_PART_MEMBERS);

dvi_status dvi__dg_create(dvi__stepper *self, const dvi__dg_space *space, int alarm,
                          const char *remedy)
{
  dvi__discontinuous *element;
  self->symmetric = space->flux == DVI__AVERAGE_FLUX || space->flux == DVI__PATH_FLUX;
  DVI_TRY(dvi__discontinuous_create(self->system, space, self->counters, &element));
  DVI_TRY(
      dvi__one_step_create(self, sizeof(dg_step), &kind, element, 1 + 2 * (size_t)self->system->n));
  dg_step *own = self->own;
  own->alarm = alarm;
  own->remedy = remedy;
  own->part = space->degree == 0 ? 4 : 0.5; /* elements of degree 0 move by jumps alone */
  return DVI_OK;
}

/* ---- the step ---- */

/* Exchange the two sides of a node, as a step in the other direction of time sees them. */
static void dg_step_reverse_jump(dvi__stepper *self)
{
  for (int i = 0; i < self->system->n; i++) dg_step_jump(self)[i] = -dg_step_jump(self)[i];
}

dvi_status dvi__ring_alarm(const dvi__stepper *self, int alarm, const char *what, double size,
                           double motion, const char *remedy)
{
  if (alarm == DVI__ALARM_STOP)
    return dvi__fail(DVI_JUMP,
                     "%s, %.2e, is large against the largest motion of a step, %.2e: the parasite "
                     "has grown, and smaller steps do not remove it; %s, alarm=warn goes on",
                     what, size, motion, remedy);
  self->counters->jump_alarms++;
  return DVI_OK;
}

/* Check the jump against the largest motion of a step so far. The motion dq of this step alone says
 * nothing, because trajectories turn. */
static dvi_status dg_step_check_jump(const dvi__stepper *self, const double *q, const double *dq)
{
  const dg_step *own = self->own;
  const size_t n = (size_t)self->system->n;
  double *motion = &self->memory[MOTION];
  const double size = dvi__largest(n, dg_step_jump(self)), rounding = 1e-10;
  *motion = fmax(*motion, dvi__largest(n, dq));
  if (size <= own->part * *motion + rounding * dvi__largest(n, q)) return DVI_OK;
  return dvi__ring_alarm(self, own->alarm, "the jump", size, *motion, own->remedy);
}

/* Remove the parasite from the jump at the start. Each pass reduces the parasite by a factor of h.
 * After the second pass the order is no longer affected. */
static dvi_status dg_step_settle_jump(dvi__stepper *self, const dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  if (!dvi__discontinuous_can_settle(one->of)) return DVI_OK;
  for (int k = 0; k < 2; k++) {
    DVI_TRY(dvi__one_step_solve(self, state, h));
    DVI_TRY(dvi__discontinuous_settle(one->of, one->x, dg_step_jump(self), dg_step_offset(self)));
  }
  return DVI_OK;
}

dvi_status dvi__dg_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  const double last_h = self->memory[DVI__LENGTH];
  double *coefficients = one->work;
  if (last_h != 0 && signbit(last_h) != signbit(h)) dg_step_reverse_jump(self);
  if (last_h == 0) DVI_TRY(dg_step_settle_jump(self, state, h));
  DVI_TRY(dvi__one_step_solve(self, state, h));
  DVI_TRY(dvi__discontinuous_end(one->of, one->x, one->dq, dg_step_jump(self), dg_step_offset(self),
                                 coefficients));
  DVI_TRY(dg_step_check_jump(self, state->q, one->dq));
  DVI_TRY(dvi__one_step_move(self, state, h, coefficients));
  return dvi__one_step_constrain(self, state);
}

const double *dvi__dg_jump(const dvi__stepper *self)
{
  return dg_step_jump(self);
}
