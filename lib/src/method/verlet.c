/* Stoermer-Verlet.
 *
 * Space: straight line from q0 to q1.  Quadrature: trapezoid.
 *     Ld(q0,q1) = h/2 L(q0, (q1-q0)/h) + h/2 L(q1, (q1-q0)/h)
 * For L = v.Mv/2 - V(q) the stationarity conditions p0 = -D1 Ld, p1 = D2 Ld solve themselves:
 *     p_half = p0 - h/2 dV(q0),   q1 = q0 + h M^-1 p_half,   p1 = p_half - h/2 dV(q1).
 * Order 2, symmetric, symplectic.  Source: Marsden and West 2001, sec. 2.3.1; Hairer, Lubich and Wanner 2003. */
#include "core/memory.h"
#include "core/status.h"
#include "method/verlet_lanes.h"
#include "num/compensated.h"

typedef struct verlet {
  dvi__evaluator *evaluator;
  double *change; /* [n] */
} verlet;

static dvi_status create(dvi__stepper *self)
{
  verlet *own = self->own = DVI_NEW(verlet, 1);
  self->order = 2;
  self->symmetric = 1;
  self->memory_count = DVI__FORCES + (size_t)self->system->n;
  self->memory = DVI_NEW(double, self->memory_count);
  if (own == NULL || self->memory == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  own->change = DVI_NEW(double, self->system->n);
  if (own->change == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  return dvi__evaluator_create(self->system, 1, DVI__GRADIENTS, self->counters, &own->evaluator);
}

static void destroy(dvi__stepper *self)
{
  verlet *own = self->own;
  dvi__release(self->memory);
  if (own == NULL) return;
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->change);
  dvi__release(own);
}

static void start(dvi__stepper *self, const double *v)
{
  (void)v;
  self->memory[DVI__FORCES_KNOWN] = 0;
}

static dvi_status forces(dvi__stepper *self, const dvi__state *state)
{
  const verlet *own = self->own;
  self->memory[DVI__FORCES_KNOWN] = 1;
  return dvi__lagrangian_gradient(own->evaluator, 1, &state->t, state->q, NULL, self->memory + DVI__FORCES, NULL);
}

static void kick(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  for (int i = 0; i < self->system->n; i++) own->change[i] = h * self->memory[DVI__FORCES + i];
  dvi__add_compensated_all(self->system->n, state->p, state->p_carry, own->change);
}

static void drift(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  dvi__mass_solve(own->evaluator, 1, state->p, own->change);
  for (int i = 0; i < self->system->n; i++) own->change[i] *= h;
  dvi__add_compensated_all(self->system->n, state->q, state->q_carry, own->change);
  dvi__add_compensated(&state->t, &state->t_carry, h);
}

static dvi_status step(dvi__stepper *self, dvi__state *state, double h)
{
  if (self->memory[DVI__FORCES_KNOWN] == 0) DVI_TRY(forces(self, state));
  kick(self, state, 0.5 * h);
  drift(self, state, h);
  DVI_TRY(forces(self, state));
  kick(self, state, 0.5 * h);
  return DVI_OK;
}

static void explain(const dvi__stepper *self, dvi__text *text)
{
  (void)self;
  dvi__text_add(text, "kernel: explicit; one gradient a step (the last one of a step is the first of the next)\n");
  dvi__text_add(text, "solver: none; no Hessian, no Jacobian, no factorisation of a step's equations\n");
}

const dvi__method dvi__verlet = {
    .name = "verlet",
    .summary = "explicit leapfrog: straight line, trapezoid; order 2; constant mass",
    .cite = "MarsdenWest2001",
    .needs = DVI__CONSTANT_MASS,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL,
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .explain = explain,
    .prepare_lanes = dvi__verlet_prepare_lanes,
    .clear_lanes = dvi__verlet_clear_lanes,
    .step_lanes = dvi__verlet_step_lanes,
};
