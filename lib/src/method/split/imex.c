/* Implicit-explicit, that is explicit in the slow forces and implicit in the fast ones.
 *
 * The space is the straight line from q0 to q1. The quadrature is the trapezoid for the slow
 * potentials U and the midpoint for the fast ones W.
 *     Ld(q0,q1) = h/2 v.Mv - h/2 (U(t0,q0) + U(t1,q1)) - h W(t0 + h/2, (q0+q1)/2),
 *     v = (q1-q0)/h
 * With p0 = -D1 Ld and p1 = D2 Ld the step is a kick by U, an implicit midpoint step with W, and a
 * kick by U (method/split/impulse.h). For W = q.Kq/2 + b.q this is the Ld of Verlet's method for
 * U + W with the mass M + h^2/4 K. If b depends on time, the trapezoid is taken for b. Then a step
 * has one gradient and one linear system, whose matrix stays the same. The order is 2. The method
 * is symmetric and symplectic, and has no resonances. It behaves like an impulse method with the
 * fast frequencies 2 atan(h omega/2)/h. Source: Stern 2009, secs. 2.2.1, 2.2.2, prop. 2.2.1. */
#include "step/split/modified_mass.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "method/split/impulse.h"
#include "num/compensated.h"
#include "system/part.h"

enum { SOLVER };

static const dvi__key keys[] = {DVI__SOLVER_KEY, {0}};

typedef struct imex {
  dvi__impulse impulse;
  /* NULL if the fast potentials are not quadratic, or if the user asks for a solver */
  dvi__modified_mass *mass;
  double *d; /* [n] */
} imex;

static dvi_status imex_drift(dvi__stepper *self, dvi__state *state, double h)
{
  const imex *own = self->own;
  const int n = self->system->n;
  for (int i = 0; i < n; i++) own->d[i] = h * state->p[i];
  DVI_TRY(dvi__modified_mass_solve(own->mass, h, own->d));
  dvi__add_compensated_all(n, state->q, state->q_compensation, own->d);
  return DVI_OK;
}

static dvi_status imex_midpoint(dvi__stepper *self, dvi__state *state, double h)
{
  return dvi__impulse_inner_steps(self, state, h, 1);
}

static dvi_status create_linear(dvi__stepper *self)
{
  DVI_TRY(dvi__impulse_create(self, sizeof(imex), 1));
  imex *own = self->own;
  own->impulse.move = imex_drift;
  own->d = DVI_NEW(double, self->system->n);
  if (own->d == NULL) return dvi__fail(DVI_NO_MEMORY, "imex: no memory");
  const dvi_status status = dvi__modified_mass_create(own->impulse.fast, self->counters,
                                                      &own->mass);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "imex");
}

static dvi_status create_nonlinear(dvi__stepper *self, int solver)
{
  char specification[64] = "";
  dvi__text text = {specification, sizeof specification, 0};
  dvi__text_add(&text, "midpoint:solver=%s", dvi__solver_choice(solver));
  DVI_TRY(dvi__impulse_create(self, sizeof(imex), 0));
  ((imex *)self->own)->impulse.move = imex_midpoint;
  return dvi__impulse_take_inner(self, specification);
}

static dvi_status imex_create(dvi__stepper *self)
{
  const int solver = self->settings.value[SOLVER];
  if (solver == DVI__SOLVER_AUTO && dvi__system_fast_is_quadratic(self->system))
    return create_linear(self);
  return create_nonlinear(self, solver);
}

static dvi_status keep_lengths(dvi__stepper *self, int count)
{
  const imex *own = self->own;
  return own->mass != NULL ? dvi__modified_mass_keep(own->mass, count) : DVI_OK;
}

static void imex_destroy(dvi__stepper *self)
{
  imex *own = self->own;
  if (own == NULL) return;
  dvi__modified_mass_destroy(&own->mass);
  dvi__release(own->d);
  dvi__impulse_destroy(self);
}

static void imex_explain(const dvi__stepper *self, dvi__text *text)
{
  const imex *own = self->own;
  dvi__text_add(text, "kernel: kicks by the slow potentials, implicit midpoint steps with the fast "
                      "ones; one gradient of the slow ones a step\n");
  if (own->mass == NULL) {
    own->impulse.inner->method->explain(own->impulse.inner, text);
    return;
  }
  const dvi__pattern *pattern = dvi__modified_mass_pattern(own->mass);
  dvi__text_add(text,
                "solver: fast potentials are quadratic: one linear system a step, %d x %d with %d "
                "entries, factored once for all steps of a length (%s)\n",
                pattern->columns, pattern->columns, dvi__pattern_entries(pattern),
                dvi__modified_mass_solver(own->mass));
}

const dvi__method dvi__imex = {
    .name = "imex",
    .summary = "implicit midpoint rule for fast potentials, explicit kicks by the slow ones; order "
               "2; constant mass",
    .cite = "Stern2009",
    .keys = keys,
    DVI__IMPULSE_OPERATIONS,
    .create = imex_create,
    .destroy = imex_destroy,
    .keep_lengths = keep_lengths,
    .explain = imex_explain,
};
