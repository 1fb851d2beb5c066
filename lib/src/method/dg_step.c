#include "method/dg_step.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"

const char *dvi__alarm_choice(int index)
{
  static const char *const name[] = {"stop", "warn"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

/* The memory: the length of the last step (0: none); the largest motion of a step so far; the jump [n]; {q} - q* [n]; the last element's coefficients
 * less q* [n*S] (before the first step, the start's velocity in their place). */
enum { LAST_H, MOTION, JUMP };

typedef struct dg_step {
  dvi__discontinuous *element;
  dvi__solver *solver;
  int alarm;
  double part;            /* of the largest motion of a step that a jump may be */
  double *guess, *x, *dq; /* [unknowns], [unknowns], [n] */
} dg_step;

static double *jump(const dvi__stepper *self)
{
  return self->memory + JUMP;
}

static double *offset(const dvi__stepper *self)
{
  return jump(self) + self->system->n;
}

static double *coefficients(const dvi__stepper *self)
{
  return offset(self) + self->system->n;
}

static dvi_status residual(void *of, const double *x, double *R)
{
  return dvi__discontinuous_residual(((const dg_step *)of)->element, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__discontinuous_jacobian(((const dg_step *)of)->element, x, values);
}

static int row_scale(void *of, double *scale)
{
  return dvi__discontinuous_scale(((const dg_step *)of)->element, scale) == DVI_OK;
}

/* ---- making it ---- */

static dvi_status allocate(dvi__stepper *self, dg_step *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__discontinuous_unknowns(own->element);
  self->memory_count = JUMP + 2 * n + unknowns;
  own->guess = DVI_NEW(double, unknowns);
  own->x = DVI_NEW(double, unknowns);
  own->dq = DVI_NEW(double, n);
  return own->guess && own->x && own->dq ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
}

dvi_status dvi__dg_create(dvi__stepper *self, const dvi__dg_space *space, int alarm)
{
  dg_step *own = self->own = DVI_NEW(dg_step, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  self->symmetric = space->flux == DVI__AVERAGE_FLUX || space->flux == DVI__PATH_FLUX;
  own->alarm = alarm;
  own->part = space->degree == 0 ? 4 : 0.5; /* elements of degree 0 move by jumps alone */
  DVI_TRY(dvi__discontinuous_create(self->system, space, self->counters, &own->element));
  DVI_TRY(allocate(self, own));
  const dvi__pattern *pattern = dvi__discontinuous_pattern(own->element);
  dvi__equations equations = {.unknowns = pattern->columns,
                              .pattern = pattern,
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale};
  return dvi__stationary_create(&equations, self->counters, &own->solver);
}

void dvi__dg_destroy(dvi__stepper *self)
{
  dg_step *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__discontinuous_destroy(&own->element);
  dvi__release(own->guess);
  dvi__release(own->x);
  dvi__release(own->dq);
  dvi__release(own);
}

void dvi__dg_start(dvi__stepper *self, const double *v)
{
  memset(self->memory, 0, self->memory_count * sizeof(double));
  memcpy(coefficients(self), v, (size_t)self->system->n * sizeof(double));
}

/* ---- the step ---- */

/* Seen from the other direction of time the two sides of a node change places. */
static void turn(dvi__stepper *self)
{
  for (int i = 0; i < self->system->n; i++) jump(self)[i] = -jump(self)[i];
}

/* A step from q by dq. The largest motion so far, and not this one's, for trajectories turn. */
static dvi_status watch(const dvi__stepper *self, const double *q, const double *dq)
{
  const dg_step *own = self->own;
  const size_t n = (size_t)self->system->n;
  const double size = dvi__largest(n, jump(self)), rounding = 1e-10;
  double *motion = &self->memory[MOTION];
  *motion = fmax(*motion, dvi__largest(n, dq));
  if (size <= own->part * *motion + rounding * dvi__largest(n, q)) return DVI_OK;
  if (own->alarm == DVI__ALARM_STOP)
    return dvi__fail(
        DVI_JUMP,
        "the jump, %.2e, is large against the largest motion of a step, %.2e: the parasite has grown, and smaller steps do not "
        "remove it; from the start on, a stiffness (dg:stiffness=c) keeps it small, alarm=warn goes on",
        size, *motion);
  self->counters->jump_alarms++;
  return DVI_OK;
}

static dvi_status solve(dvi__stepper *self, const dvi__state *state, double h)
{
  dg_step *own = self->own;
  const double last_h = self->memory[LAST_H];
  DVI_TRY(dvi__discontinuous_place(own->element, state->t, h, &(dvi__dg_node){state->q, state->p, jump(self), offset(self)}));
  if (last_h != 0)
    dvi__discontinuous_continue(own->element, h / last_h, coefficients(self), own->guess);
  else
    dvi__discontinuous_straight(own->element, coefficients(self), own->guess);
  return dvi__stationary_solve(own->solver, self->counters, dvi__largest((size_t)self->system->n, state->q),
                               dvi__discontinuous_unknowns(own->element), own->guess, own->x);
}

/* Each time the parasite's part of the jump at the start falls by a factor of h; the second time to the order at which it no longer matters. */
static dvi_status settle(dvi__stepper *self, const dvi__state *state, double h)
{
  dg_step *own = self->own;
  if (!dvi__discontinuous_can_settle(own->element)) return DVI_OK;
  for (int k = 0; k < 2; k++) {
    DVI_TRY(solve(self, state, h));
    DVI_TRY(dvi__discontinuous_settle(own->element, own->x, jump(self), offset(self)));
  }
  return DVI_OK;
}

dvi_status dvi__dg_step(dvi__stepper *self, dvi__state *state, double h)
{
  dg_step *own = self->own;
  const int n = self->system->n;
  if (self->memory[LAST_H] != 0 && signbit(self->memory[LAST_H]) != signbit(h)) turn(self);
  if (self->memory[LAST_H] == 0) DVI_TRY(settle(self, state, h));
  DVI_TRY(solve(self, state, h));
  DVI_TRY(dvi__discontinuous_end(own->element, own->x, own->dq, jump(self), offset(self), coefficients(self)));
  DVI_TRY(watch(self, state->q, own->dq));
  self->memory[LAST_H] = h;
  dvi__add_compensated_all(n, state->q, state->q_carry, own->dq);
  dvi__add_compensated(&state->t, &state->t_carry, h);
  memset(own->dq, 0, (size_t)n * sizeof(double));
  return dvi__form_gradient(dvi__discontinuous_evaluator(own->element), state->q, own->dq, own->guess, state->p);
}

const double *dvi__dg_jump(const dvi__stepper *self)
{
  return jump(self);
}

void dvi__dg_explain(const dvi__stepper *self, dvi__text *text)
{
  const dg_step *own = self->own;
  const dvi__pattern *pattern = dvi__discontinuous_pattern(own->element);
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n", pattern->columns,
                dvi__pattern_entries(pattern), 100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  dvi__text_add(text, "jumps: memory of the method; watched, %s\n",
                own->alarm == DVI__ALARM_STOP ? "an alarm stops the run" : "alarms are counted");
  dvi__text_add(text, "solver: Newton's method, last KINSOL with line search\n");
}
