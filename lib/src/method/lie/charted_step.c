#include "method/lie/charted_step.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "num/compensated.h"
#include "system/chart/charted.h"

typedef dvi__charted_step_of charted_step;

/* Give the count of a path's numbers and those of row terms, and the degree. */
static size_t unknowns_of(const charted_step *own)
{
  return (size_t)dvi__action_unknowns(dvi__element_action(&own->inner));
}

static int degree_of(const charted_step *own)
{
  return dvi__action_space_of(dvi__element_action(&own->inner)).degree;
}

/* ---- create ---- */

static dvi_status charted_step_allocate(dvi__stepper *self, charted_step *own)
{
  const size_t nx = (size_t)self->system->nx, points = nx * (size_t)degree_of(own);
  self->memory_count = own->inner.memory_count + unknowns_of(own);
  own->local = DVI_NEW(double, 6 * nx + points + 1 + (size_t)self->system->symmetry_count);
  if (own->local == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  own->xi = own->local + 4 * nx;
  own->rate = own->xi + nx;
  own->offset = own->rate + nx;
  own->supply = own->offset + points;
  return DVI_OK;
}

/* Return 1 if a path of degree s in the charts at its start is such a path in the charts at its
 * end, too. Paths with s = 1 are one-parameter subgroups and great circles. Lines and circles have
 * one chart. */
static int has_two_ends(const dvi_system *system, const dvi__stepper *inner)
{
  int turns = 0;
  for (int c = 0; c < system->slot_count; c++)
    turns |= system->slots[c].kind == DVI__ROTATION || system->slots[c].kind == DVI__SPHERE;
  return !turns || dvi__action_space_of(dvi__element_action(inner)).degree == 1;
}

static dvi_status centre_paths(charted_step *own)
{
  dvi__centring centring;
  DVI_TRY(dvi__charted_centring(own->charted, dvi__action_nodes(dvi__element_action(&own->inner)),
                                &centring));
  return dvi__element_centre(&own->inner, &centring);
}

dvi_status dvi__charted_step_create(dvi__stepper *self, int reduced)
{
  charted_step *own = self->own = DVI_NEW(charted_step, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  const dvi_status made = dvi__charted_create(self->system, reduced, self->counters, &own->charted);
  if (made != DVI_OK) return dvi__fail_in(made, "%s", self->method->name);
  const dvi_status status = dvi__stepper_create_inner(
      self, "galerkin", dvi__charted_system(own->charted), NULL, &own->inner);
  if (status != DVI_OK)
    return dvi__fail_in(status, "%s, by the keys of galerkin", self->method->name);
  self->order = own->inner.order;
  self->weighs_damping = own->inner.weighs_damping;
  self->symmetric = own->inner.symmetric && has_two_ends(self->system, &own->inner);
  DVI_TRY(centre_paths(own));
  return charted_step_allocate(self, own);
}

void dvi__charted_step_destroy(dvi__stepper *self)
{
  charted_step *own = self->own;
  if (own == NULL) return;
  own->inner.memory = NULL;
  dvi__stepper_destroy(&own->inner);
  dvi__charted_destroy(&own->charted);
  dvi__release(own->local);
  dvi__release(own);
}

/* ---- the step ---- */

/* Solve the step in the charts at the state. */
static dvi_status charted_step_solve(dvi__stepper *self, const dvi__state *state, double h,
                                     dvi__state *local)
{
  charted_step *own = self->own;
  const size_t nx = (size_t)self->system->nx;
  dvi__charted_centre(own->charted, state->q);
  memset(own->local, 0, 4 * nx * sizeof(double));
  *local = (dvi__state){.t = state->t,
                        .t_compensation = state->t_compensation,
                        .density = state->density,
                        .side = state->side,
                        .q = own->local,
                        .p = own->local + nx,
                        .q_compensation = own->local + 2 * nx,
                        .p_compensation = own->local + 3 * nx};
  if (state->supplied != NULL && self->system->damping > 0) {
    own->power[0] = own->power[1] = 0;
    local->supplied = &own->power[0];
    local->supplied_compensation = &own->power[1];
  }
  dvi__charted_enter(own->charted, state->p, local->p);
  dvi__charted_enter(own->charted, state->p_compensation, local->p_compensation);
  own->inner.memory = self->memory;
  const dvi_status status = own->inner.method->step(&own->inner, local, h);
  return status == DVI_OK ? dvi__charted_check(own->charted, local->q)
                          : dvi__charted_explain(own->charted, status);
}

/* Add what the forces supply over the path to the state's sums. The power of a damped system is
 * that in the charts, which have no symmetries. */
static dvi_status add_supplies(const dvi__stepper *self, const double *path, double h,
                               const dvi__state *state)
{
  const charted_step *own = self->own;
  const dvi__action *action = dvi__element_action(&own->inner);
  const int count = 1 + self->system->symmetry_count;
  memset(own->supply, 0, (size_t)count * sizeof(double));
  for (int j = 0; self->system->force_count > 0 && j < dvi__action_nodes(action); j++) {
    double tau, weight;
    dvi__action_node(action, j, &tau, &weight);
    dvi__action_path(action, path, h, tau, own->xi, own->rate);
    DVI_TRY(dvi__charted_supply(own->charted, state->t + tau * h, own->xi, own->rate,
                                h * dvi__action_weight(action, j), own->supply));
  }
  if (self->system->damping > 0) own->supply[0] = own->power[0] - own->power[1];
  dvi__add_compensated_all(count, state->supplied, state->supplied_compensation, own->supply);
  return DVI_OK;
}

void dvi__charted_step_arrive(const dvi__charted_step_of *own, double *memory,
                              const dvi__state *local, dvi__state *state)
{
  const dvi__action *action = dvi__element_action(&own->inner);
  double *path = memory + DVI__LAST_Y, *own_path = memory + own->inner.memory_count;
  memcpy(own_path, path, unknowns_of(own) * sizeof(double));
  dvi__charted_arrive(own->charted,
                      &(dvi__phase){.q = local->q,
                                    .p = local->p,
                                    .q_compensation = local->q_compensation,
                                    .p_compensation = local->p_compensation},
                      &(dvi__phase){.q = state->q,
                                    .p = state->p,
                                    .q_compensation = state->q_compensation,
                                    .p_compensation = state->p_compensation});
  /* The next guess continues the same path in the charts at its end. */
  dvi__action_at_fit_points(action, own_path, own->offset);
  dvi__charted_follow(own->charted, state->q, local->q, degree_of(own), own->offset);
  dvi__action_fit(action, own->offset, path);
  state->t = local->t;
  state->t_compensation = local->t_compensation;
}

dvi_status dvi__charted_step(dvi__stepper *self, dvi__state *state, double h)
{
  dvi__state local;
  DVI_TRY(charted_step_solve(self, state, h, &local));
  if (state->supplied != NULL) DVI_TRY(add_supplies(self, self->memory + DVI__LAST_Y, h, state));
  dvi__charted_step_arrive(self->own, self->memory, &local, state);
  return DVI_OK;
}

void dvi__charted_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v)
{
  const charted_step *own = self->own;
  dvi__charted_centre(own->charted, q0);
  dvi__action_path(dvi__element_action(&own->inner), self->memory + own->inner.memory_count, h, tau,
                   own->xi, own->rate);
  dvi__charted_point(own->charted, own->xi, own->rate, q, v);
}

void dvi__charted_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const charted_step *own = self->own;
  dvi__text_add(text,
                "charts: natural ones, centred at the start of each step; %d coordinates for %d "
                "stored numbers\n",
                self->system->nx, self->system->n);
  own->inner.method->explain(&own->inner, text);
}
