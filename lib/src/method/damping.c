/* Uniform friction f = -gamma p around a step of a method,
 *
 *     p <- e^{-gamma h/2} p,   a step of the method,   p <- e^{-gamma h/2} p.
 *
 * The halves contract the symplectic form by e^{-gamma h}, and a symplectic step between them
 * leaves it alone. Momenta of symmetries shrink by the same factor. If the step is symmetric, all
 * is.
 *
 * Around a step of the system without friction this has order 2, which is what verlet and
 * lie-verlet do. An element of the discrete action weighs its nodes instead
 * (step/element/action.h), so that the halves only change the momenta p of the system into those of
 * the weighted action, and its order stays.
 *
 * Sources: McLachlan and Perlmutter 2001 (conformal Hamiltonian systems), McLachlan and Quispel
 * 2002, sec. 3.4 (such compositions), Kanai 1948 (the weighted Lagrangian). */
#include "method/damping.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/simd/fused.h"

struct dvi__damping {
  dvi__evaluator *evaluator;
  double *v;      /* [n] */
  double *before; /* [1 + symmetries] invariants before a half */
};

static int is_damped(const dvi__stepper *self)
{
  return self->system->damping > 0 && !self->method->composes;
}

dvi_status dvi__damping_create(dvi__stepper *self)
{
  if (!is_damped(self)) return DVI_OK;
  struct dvi__damping *own = self->damping = DVI_NEW(struct dvi__damping, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  const size_t n = (size_t)self->system->n;
  own->v = DVI_NEW(double, n + 1 + (size_t)self->system->symmetry_count);
  if (own->v == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  own->before = own->v + n;
  return dvi__evaluator_create(self->system, 1, DVI__STATES, self->counters, &own->evaluator);
}

void dvi__damping_destroy(dvi__stepper *self)
{
  struct dvi__damping *own = self->damping;
  if (own == NULL) return;
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->v);
  dvi__release(own);
  self->damping = NULL;
}

/* Evaluate what friction changes. An element counts for itself what it takes from the energy, by
 * the quadrature of its action. */
static dvi_status damped_invariant(const dvi__stepper *self, const dvi__state *state, int i,
                                   double *value)
{
  const struct dvi__damping *own = self->damping;
  *value = 0;
  if (i == 0 && self->weighs_damping) return DVI_OK;
  if (i == 0) DVI_TRY(dvi__legendre_inverse(own->evaluator, state->t, state->q, state->p, own->v));
  return dvi__invariant(own->evaluator, state->t, state->q, own->v, state->p, i, value);
}

/* Multiply p and its compensation by f. The rounding error of the product joins the latter. */
FUSED static void scale_momenta(size_t count, double f, double *restrict p,
                                double *restrict compensation)
{
  for (size_t i = 0; i < count; i++) {
    const double product = f * p[i], error = __builtin_fma(f, p[i], -product);
    compensation[i] = f * compensation[i] - error;
    p[i] = product;
  }
}

static double half_factor(const dvi__stepper *self, double h)
{
  return exp(-0.5 * self->system->damping * h);
}

static dvi_status damping_half(const dvi__stepper *self, dvi__state *state, double h)
{
  const struct dvi__damping *own = self->damping;
  const int count = state->supplied != NULL ? 1 + self->system->symmetry_count : 0;
  for (int i = 0; i < count; i++) DVI_TRY(damped_invariant(self, state, i, &own->before[i]));
  scale_momenta((size_t)self->system->nv, half_factor(self, h), state->p, state->p_compensation);
  for (int i = 0; i < count; i++) {
    double after;
    DVI_TRY(damped_invariant(self, state, i, &after));
    dvi__add_compensated(&state->supplied[i], &state->supplied_compensation[i],
                         after - own->before[i]);
  }
  return DVI_OK;
}

dvi_status dvi__take_step(dvi__stepper *self, dvi__state *state, double h)
{
  if (self->damping == NULL) return self->method->step(self, state, h);
  DVI_TRY(damping_half(self, state, h));
  DVI_TRY(self->method->step(self, state, h));
  return damping_half(self, state, h);
}

void dvi__take_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  const size_t count = (size_t)self->system->nv * (size_t)m->count;
  const double f = self->damping != NULL ? half_factor(self, h) : 1;
  if (self->damping != NULL) scale_momenta(count, f, m->p, m->p_compensation);
  self->method->step_lanes(self, m, h);
  if (self->damping != NULL) scale_momenta(count, f, m->p, m->p_compensation);
}
