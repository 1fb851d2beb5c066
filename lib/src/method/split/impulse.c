#include "method/split/impulse.h"

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "system/part.h"

/* The length of step for which the gradient in the memory was computed. */
static double *made_for(const dvi__stepper *self)
{
  return self->memory + self->system->n;
}

dvi__phase dvi__impulse_phase(const dvi__state *state)
{
  return (dvi__phase){.q = state->q,
                      .p = state->p,
                      .q_compensation = state->q_compensation,
                      .p_compensation = state->p_compensation};
}

/* ---- create, destroy ---- */

dvi_status dvi__impulse_create(dvi__stepper *self, size_t size, int all)
{
  dvi__impulse *own = self->own = dvi__allocate(1, size);
  self->order = 2;
  self->symmetric = 1;
  self->bound = 1;
  self->memory_count = (size_t)self->system->n + 1;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  if (!all) DVI_TRY(dvi__system_slow_part(self->system, &own->slow));
  DVI_TRY(dvi__system_fast_part(self->system, &own->fast));
  return dvi__evaluator_create(all ? self->system : own->slow, 1, DVI__GRADIENTS, self->counters,
                               &own->forces);
}

void dvi__impulse_destroy(dvi__stepper *self)
{
  dvi__impulse *own = self->own;
  if (own->inner != NULL) dvi__stepper_destroy(own->inner);
  dvi__release(own->inner);
  dvi__evaluator_destroy(&own->forces);
  dvi_system_destroy(&own->slow);
  dvi_system_destroy(&own->fast);
  dvi__release(own);
}

dvi_status dvi__impulse_take_inner(dvi__stepper *self, const char *specification)
{
  dvi__impulse *own = self->own;
  own->inner = DVI_NEW(dvi__stepper, 1);
  if (own->inner == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  const dvi_status status = dvi__stepper_create(own->fast, specification, NULL, self->counters,
                                                own->inner);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", self->method->name);
  self->memory_count += own->inner->memory_count;
  self->follows = own->inner->follows;
  return DVI_OK;
}

/* Return the inner stepper, which works on the memory of this method. */
static dvi__stepper *inner_of(const dvi__stepper *self)
{
  const dvi__impulse *own = self->own;
  own->inner->memory = made_for(self) + 1;
  return own->inner;
}

void dvi__impulse_start(dvi__stepper *self, const double *v)
{
  const dvi__impulse *own = self->own;
  if (own->inner != NULL) dvi__stepper_start(inner_of(self), v);
}

/* ---- the step ---- */

dvi_status dvi__impulse_inner_steps(dvi__stepper *self, dvi__state *state, double h, int count)
{
  dvi__stepper *inner = inner_of(self);
  const double t = state->t, t_compensation = state->t_compensation;
  for (int k = 0; k < count; k++) DVI_TRY(dvi__inner_step(self, inner, state, h / count));
  state->t = t;
  state->t_compensation = t_compensation;
  return DVI_OK;
}

static dvi_status impulse_gradient(dvi__stepper *self, const dvi__state *state, double h)
{
  const dvi__impulse *own = self->own;
  *made_for(self) = h;
  if (own->gradient != NULL) return own->gradient(self, state, h, self->memory);
  return dvi__potentials_gradient(own->forces, 1, &state->t, state->q, self->memory);
}

static void impulse_kick(const dvi__stepper *self, dvi__state *state, double h)
{
  dvi__lanes_add_scaled((size_t)self->system->n, -h, self->memory, state->p, state->p_compensation);
}

dvi_status dvi__impulse_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__impulse *own = self->own;
  const double length = *made_for(self);
  if (length == 0 || (own->gradient != NULL && length != h))
    DVI_TRY(impulse_gradient(self, state, h));
  impulse_kick(self, state, 0.5 * h);
  DVI_TRY(own->move(self, state, h));
  dvi__add_compensated(&state->t, &state->t_compensation, h);
  DVI_TRY(impulse_gradient(self, state, h));
  impulse_kick(self, state, 0.5 * h);
  return DVI_OK;
}
