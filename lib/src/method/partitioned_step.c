#include "method/partitioned_step.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"

/* The memory: the length of the last step (0: none), its multiplier [n], its unknowns (before the first step, the start's velocity). */
enum { LAST_H, MULTIPLIER };

typedef struct partitioned {
  dvi__partitioned *step;
  dvi__projection projection;
  dvi__solver *solver;
  double *guess, *x, *dq, *dp; /* [unknowns], [unknowns], [n], [n] */
} partitioned;

static size_t last_x(const dvi__stepper *self)
{
  return MULTIPLIER + (size_t)self->system->n;
}

static dvi_status residual(void *of, const double *x, double *R)
{
  return dvi__partitioned_residual(((const partitioned *)of)->step, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__partitioned_jacobian(((const partitioned *)of)->step, x, values);
}

static int row_scale(void *of, double *scale)
{
  return dvi__partitioned_scale(((const partitioned *)of)->step, scale) == DVI_OK;
}

static int allocate(dvi__stepper *self, partitioned *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__partitioned_unknowns(own->step);
  self->memory_count = last_x(self) + unknowns;
  own->guess = DVI_NEW(double, unknowns);
  own->x = DVI_NEW(double, unknowns);
  own->dq = DVI_NEW(double, n);
  own->dp = DVI_NEW(double, n);
  return own->guess && own->x && own->dq && own->dp;
}

dvi_status dvi__partitioned_step_create(dvi__stepper *self, dvi__tableau tableau, int stages, dvi__projection projection)
{
  const char *name = self->method->name;
  partitioned *own = self->own = DVI_NEW(partitioned, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", name);
  own->projection = projection;
  const dvi_status status = dvi__partitioned_create(self->system, tableau, stages, projection, self->counters, &own->step);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", name);
  if (!allocate(self, own)) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", name);
  const dvi__pattern *pattern = dvi__partitioned_pattern(own->step);
  dvi__equations equations = {.unknowns = dvi__partitioned_unknowns(own->step),
                              .pattern = pattern,
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale};
  return dvi__stationary_create(&equations, self->counters, &own->solver);
}

void dvi__partitioned_step_destroy(dvi__stepper *self)
{
  partitioned *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__partitioned_destroy(&own->step);
  dvi__release(own->guess);
  dvi__release(own->x);
  dvi__release(own->dq);
  dvi__release(own->dp);
  dvi__release(own);
}

void dvi__partitioned_step_start(dvi__stepper *self, const double *v)
{
  memset(self->memory, 0, self->memory_count * sizeof(double));
  memcpy(self->memory + last_x(self), v, (size_t)self->system->n * sizeof(double));
}

/* On the constraint p is alpha(q), to the last bit. */
static dvi_status advance(dvi__stepper *self, dvi__state *state, double h)
{
  const partitioned *own = self->own;
  const int n = self->system->n;
  dvi__partitioned_ends(own->step, own->dq, own->dp);
  dvi__add_compensated_all(n, state->q, state->q_carry, own->dq);
  dvi__add_compensated(&state->t, &state->t_carry, h);
  if (own->projection == DVI__NO_PROJECTION) {
    dvi__add_compensated_all(n, state->p, state->p_carry, own->dp);
    return DVI_OK;
  }
  memset(own->dq, 0, (size_t)n * sizeof(double));
  return dvi__form_gradient(dvi__partitioned_evaluator(own->step), state->q, own->dq, own->dp, state->p);
}

static void remember(dvi__stepper *self, double h)
{
  const partitioned *own = self->own;
  const int n = self->system->n, unknowns = dvi__partitioned_unknowns(own->step), m = unknowns / n;
  self->memory[LAST_H] = h;
  memcpy(self->memory + last_x(self), own->x, (size_t)unknowns * sizeof(double));
  for (int i = 0; i < n; i++) self->memory[MULTIPLIER + i] = own->projection != DVI__NO_PROJECTION ? own->x[i * m + m - 1] : 0;
}

dvi_status dvi__partitioned_step(dvi__stepper *self, dvi__state *state, double h)
{
  partitioned *own = self->own;
  const size_t n = (size_t)self->system->n;
  const double last_h = self->memory[LAST_H], *last = self->memory + last_x(self);
  dvi__partitioned_place(own->step, state->t, h, state->q, state->p, self->memory + MULTIPLIER);
  if (last_h != 0)
    dvi__partitioned_continue(own->step, h / last_h, last, own->guess);
  else
    dvi__partitioned_straight(own->step, last, own->guess);
  DVI_TRY(dvi__stationary_solve(own->solver, self->counters, dvi__largest(n, state->q), dvi__partitioned_unknowns(own->step),
                                own->guess, own->x));
  DVI_TRY(dvi__partitioned_residual(own->step, own->x, own->guess));
  remember(self, h);
  return advance(self, state, h);
}

const double *dvi__partitioned_step_multiplier(const dvi__stepper *self)
{
  const partitioned *own = self->own;
  return own->projection == DVI__NO_PROJECTION ? NULL : self->memory + MULTIPLIER;
}

void dvi__partitioned_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const partitioned *own = self->own;
  const dvi__pattern *pattern = dvi__partitioned_pattern(own->step);
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n", pattern->columns,
                dvi__pattern_entries(pattern), 100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  if (self->system->terms & DVI__ONE_FORM)
    dvi__text_add(text, "constraint: p = alpha(q), %s\n",
                  own->projection == DVI__NO_PROJECTION ? "which the steps leave" : "to the last bit after every step");
  dvi__text_add(text, "solver: Newton's method, last KINSOL with line search\n");
}
