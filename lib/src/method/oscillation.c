#include "method/oscillation.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/part.h"

/* ---- the step ---- */

/* In the memory, behind the impulse's: the fast gradient at the state, which the filter wanted, and the next move wants. */
static double *kept_gradient(const dvi__stepper *self)
{
  return self->memory + self->system->n + 1;
}

static dvi_status move(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__oscillation *own = self->own;
  const double middle = state->t + 0.5 * h;
  const dvi__phase phase = dvi__impulse_phase(state);
  if (!own->keeps) DVI_TRY(dvi__potentials_gradient(own->fast_forces, 1, &middle, state->q, own->V_q));
  dvi__modes_move(own->modes, h, own->keeps ? kept_gradient(self) : own->V_q, &phase);
  return DVI_OK;
}

static dvi_status make_filters(dvi__oscillation *own, int n, double h)
{
  const double *square = dvi__modes_squares(own->modes);
  own->h = 0;
  for (int k = 0; k < n; k++)
    if (!own->pair(own->number, h * h * square[k], &own->filter[k]))
      return dvi__fail(
          DVI_NOT_CONVERGED,
          "h omega = %.6g of a fast mode, where this filter does not exist: it divides by sinc(h omega), or by its root",
          fabs(h) * sqrt(fabs(square[k])));
  own->h = h;
  return DVI_OK;
}

static dvi_status filtered_gradient(dvi__stepper *self, const dvi__state *state, double h, double *V_q)
{
  dvi__oscillation *own = self->own;
  const int n = self->system->n;
  if (own->h != h) DVI_TRY(make_filters(own, n, h));
  double *fast = own->keeps ? kept_gradient(self) : own->V_q;
  DVI_TRY(dvi__potentials_gradient(own->fast_forces, 1, &state->t, state->q, fast));
  dvi__modes_of_forces(own->modes, fast, own->y);
  for (int k = 0; k < n; k++) own->y[k] *= -h * h * own->filter[k].shift;
  dvi__modes_to_coordinates(own->modes, own->y, own->nearby);
  for (int i = 0; i < n; i++) own->nearby[i] += state->q[i];
  DVI_TRY(dvi__potentials_gradient(own->impulse.forces, 1, &state->t, own->nearby, own->V_q));
  dvi__modes_of_forces(own->modes, own->V_q, own->y);
  for (int k = 0; k < n; k++) own->y[k] *= own->filter[k].psi;
  dvi__modes_to_forces(own->modes, own->y, V_q);
  return DVI_OK;
}

/* ---- create, destroy ---- */

static dvi_status fill(dvi__stepper *self, dvi__oscillation *own)
{
  const size_t n = (size_t)self->system->n;
  DVI_TRY(dvi__modes_create(own->impulse.fast, self->counters, &own->modes));
  own->filter = DVI_NEW(dvi__filter, n);
  own->V_q = DVI_NEW(double, n);
  own->y = DVI_NEW(double, n);
  own->nearby = DVI_NEW(double, n);
  if (!own->filter || !own->V_q || !own->y || !own->nearby) return dvi__fail(DVI_NO_MEMORY, "no memory");
  return dvi__evaluator_create(own->impulse.fast, 1, DVI__GRADIENTS, self->counters, &own->fast_forces);
}

dvi_status dvi__oscillation_create(dvi__stepper *self, dvi__filter_pair *pair, int number, const char *remedy)
{
  if (!dvi__system_fast_is_quadratic(self->system))
    return dvi__fail(
        DVI_UNSUPPORTED,
        "%s: a fast potential is not declared `quadratic`, and only such ones have modes; %s (it is '%s'; those of scenes are "
        "declared if their second derivatives are constant)",
        self->method->name, remedy, dvi__system_fast_not_quadratic(self->system));
  DVI_TRY(dvi__impulse_create(self, sizeof(dvi__oscillation), 0));
  dvi__oscillation *own = self->own;
  own->pair = pair;
  own->number = number;
  own->impulse.move = move;
  own->impulse.gradient = pair != NULL ? filtered_gradient : NULL;
  own->keeps = pair != NULL && self->system->autonomous;
  if (own->keeps) self->memory_count += (size_t)self->system->n;
  const dvi_status status = fill(self, own);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "%s", self->method->name);
}

void dvi__oscillation_destroy(dvi__stepper *self)
{
  dvi__oscillation *own = self->own;
  if (own == NULL) return;
  dvi__modes_destroy(&own->modes);
  dvi__evaluator_destroy(&own->fast_forces);
  dvi__release(own->filter);
  dvi__release(own->V_q);
  dvi__release(own->y);
  dvi__release(own->nearby);
  dvi__impulse_destroy(self);
}

void dvi__oscillation_explain(const dvi__stepper *self, dvi__text *text)
{
  const dvi__oscillation *own = self->own;
  dvi__text_add(
      text,
      "kernel: kicks by the slow potentials, one gradient of them a step; the fast ones move exactly, by their normal modes\n");
  dvi__text_add(text, "solver: none; modes of %d blocks of coordinates, the largest of %d, found once\n",
                dvi__modes_block_count(own->modes), dvi__modes_largest_block(own->modes));
}
