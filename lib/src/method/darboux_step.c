#include "method/darboux_step.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"

/* The memory: the length of the last step (0: none), its unknowns (before the first step, the start's velocity). */
enum { LAST_H, LAST_X };

typedef struct darboux {
  dvi__darboux *step;
  dvi__solver *solver;
  double *guess, *x, *dq, *none; /* [unknowns], [unknowns], [n], [n] */
} darboux;

static dvi_status residual(void *of, const double *x, double *R)
{
  return dvi__darboux_residual(((const darboux *)of)->step, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__darboux_jacobian(((const darboux *)of)->step, x, values);
}

static int row_scale(void *of, double *scale)
{
  return dvi__darboux_scale(((const darboux *)of)->step, scale) == DVI_OK;
}

static int allocate(dvi__stepper *self, darboux *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__darboux_unknowns(own->step);
  self->memory_count = LAST_X + unknowns;
  own->guess = DVI_NEW(double, unknowns);
  own->x = DVI_NEW(double, unknowns);
  own->dq = DVI_NEW(double, n);
  own->none = DVI_NEW(double, n);
  return own->guess && own->x && own->dq && own->none;
}

dvi_status dvi__darboux_step_create(dvi__stepper *self, dvi__darboux_rule rule, int stages)
{
  darboux *own = self->own = DVI_NEW(darboux, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  self->symmetric = rule == DVI__GAUSS_STAGES || rule == DVI__TRAPEZOIDAL_PAIR;
  self->order = rule == DVI__GAUSS_STAGES ? 2 * stages : rule == DVI__TRAPEZOIDAL_PAIR ? 2 : 1;
  const dvi_status status = dvi__darboux_create(self->system, rule, stages, self->counters, &own->step);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", self->method->name);
  if (!allocate(self, own)) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  dvi__equations equations = {.unknowns = dvi__darboux_unknowns(own->step),
                              .pattern = dvi__darboux_pattern(own->step),
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale};
  return dvi__stationary_create(&equations, self->counters, &own->solver);
}

void dvi__darboux_step_destroy(dvi__stepper *self)
{
  darboux *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__darboux_destroy(&own->step);
  dvi__release(own->guess);
  dvi__release(own->x);
  dvi__release(own->dq);
  dvi__release(own->none);
  dvi__release(own);
}

void dvi__darboux_step_start(dvi__stepper *self, const double *v)
{
  memset(self->memory, 0, self->memory_count * sizeof(double));
  memcpy(self->memory + LAST_X, v, (size_t)self->system->n * sizeof(double));
}

/* The last stage is solved for p1 = alpha(q1): alpha is evaluated again, so that the constraint holds to the last bit. */
static dvi_status advance(darboux *own, int n, dvi__state *state, double h)
{
  dvi__darboux_end(own->step, own->x, own->dq);
  dvi__add_compensated_all(n, state->q, state->q_carry, own->dq);
  dvi__add_compensated(&state->t, &state->t_carry, h);
  memset(own->dq, 0, (size_t)n * sizeof(double));
  return dvi__form_gradient(dvi__darboux_evaluator(own->step), state->q, own->dq, own->none, state->p);
}

dvi_status dvi__darboux_step(dvi__stepper *self, dvi__state *state, double h)
{
  darboux *own = self->own;
  const int n = self->system->n, unknowns = dvi__darboux_unknowns(own->step);
  const double last_h = self->memory[LAST_H];
  dvi__darboux_place(own->step, state->t, h, state->q, state->p);
  if (last_h != 0)
    dvi__darboux_continue(own->step, h / last_h, self->memory + LAST_X, own->guess);
  else
    dvi__darboux_straight(own->step, self->memory + LAST_X, own->guess);
  DVI_TRY(dvi__stationary_solve(own->solver, self->counters, dvi__largest((size_t)n, state->q), unknowns, own->guess, own->x));
  self->memory[LAST_H] = h;
  memcpy(self->memory + LAST_X, own->x, (size_t)unknowns * sizeof(double));
  return advance(own, n, state, h);
}

void dvi__darboux_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const darboux *own = self->own;
  const dvi__pattern *pattern = dvi__darboux_pattern(own->step);
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n", pattern->columns,
                dvi__pattern_entries(pattern), 100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  dvi__text_add(text, "one-form: constant in the components of");
  for (int i = 0; i < self->system->n; i++)
    if (!dvi__darboux_is_x(own->step, i)) dvi__text_add(text, " q[%d]", i);
  dvi__text_add(text, ", which stand for the momenta of the others\n");
  dvi__text_add(text, "constraint: p = alpha(q), to the last bit after every step\n");
  dvi__text_add(text, "solver: Newton's method, last KINSOL with line search\n");
}
