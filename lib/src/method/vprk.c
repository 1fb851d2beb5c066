/* Variational partitioned Runge-Kutta methods for degenerate Lagrangians alpha(q).v - H(q), projected onto p = alpha(q).
 *
 *     Ld = h sum_i b_i L(Q_i, V_i) with the stages of action/partitioned.h, stationary under q1 = q0 + h sum_i b_i V_i.
 *
 * Without a projection the momenta leave p = alpha(q), and the order is lost. Each projection kicks (q, p) along Omega^-1 grad phi, phi = p - alpha(q):
 *     symmetric   the same multiplier before and after the step, solved with it: symmetric, order 2s (Gauss)
 *     midpoint    the same, with grad alpha at the mean of both ends: symmetric, lower order
 *     symplectic  the multiplier of the last step before, its own after: carried from step to step; its alternating part is a parasite
 *     post        after the step alone
 *     none        for comparison
 * Source: Kraus 2017, arXiv:1708.07356. */
#include <string.h>

#include "action/partitioned.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"

enum { NODES, TABLEAU, PROJECTION };

static const char *tableau_name(int index)
{
  static const char *const name[] = {"gauss", "lobatto-iiie"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const char *projection_name(int index)
{
  static const char *const name[] = {"symmetric", "midpoint", "symplectic", "post", "none"};
  return index >= 0 && index < 5 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"nodes", NULL, 1, 6, 2, "the stages, 1 to 6; left out: 2"},
    {"tableau", tableau_name, 0, 0, DVI__GAUSS, "gauss or lobatto-iiie (2 stages or more); left out: gauss"},
    {"projection", projection_name, 0, 0, DVI__SYMMETRIC, "symmetric, midpoint, symplectic, post or none; left out: symmetric"},
    {0},
};

/* The memory: the length of the last step (0: none), its multiplier [n], its unknowns (before the first step, the start's velocity). */
enum { LAST_H, MULTIPLIER };

typedef struct vprk {
  dvi__partitioned *step;
  dvi__solver *solver;
  double *guess, *x, *dq, *dp; /* [unknowns], [unknowns], [n], [n] */
} vprk;

static size_t last_x(const dvi__stepper *self)
{
  return MULTIPLIER + (size_t)self->system->n;
}

static dvi_status residual(void *of, const double *x, double *R)
{
  return dvi__partitioned_residual(((const vprk *)of)->step, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__partitioned_jacobian(((const vprk *)of)->step, x, values);
}

static int row_scale(void *of, double *scale)
{
  return dvi__partitioned_scale(((const vprk *)of)->step, scale) == DVI_OK;
}

/* ---- making it ---- */

/* Measured where the projections differ, on massless-particle and vortices (tests/method/test_vprk.c): what a projection along directions that are
 * right to h, or on one side alone, leaves of the tableau's order. */
static int order_of(int tableau, int s, int projection)
{
  const int gauss = tableau == DVI__GAUSS, full = gauss ? 2 * s : 2 * s - 2;
  switch (projection) {
  case DVI__NO_PROJECTION: return gauss ? 2 * ((s + 1) / 2) : s > 2 ? 2 * ((s - 1) / 2) : 2;
  case DVI__MIDPOINT_PROJECTION: return gauss ? 2 * (s / 2) + 2 : s > 2 ? 2 * (s / 2) : 2;
  case DVI__POST_PROJECTION: return gauss || s == 2 ? full : full - 1;
  default: return full;
  }
}

static int allocate(dvi__stepper *self, vprk *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__partitioned_unknowns(own->step);
  self->memory_count = last_x(self) + unknowns;
  own->guess = DVI_NEW(double, unknowns);
  own->x = DVI_NEW(double, unknowns);
  own->dq = DVI_NEW(double, n);
  own->dp = DVI_NEW(double, n);
  return own->guess && own->x && own->dq && own->dp;
}

static dvi_status create(dvi__stepper *self)
{
  const int *value = self->settings.value;
  if (value[TABLEAU] == DVI__LOBATTO_IIIE && value[NODES] < 2)
    return dvi__fail(DVI_BAD_OPTION, "vprk: tableau=lobatto-iiie has its nodes at both ends; nodes=2 or more is needed");
  vprk *own = self->own = DVI_NEW(vprk, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "vprk: no memory");
  self->order = order_of(value[TABLEAU], value[NODES], value[PROJECTION]);
  self->symmetric = value[PROJECTION] == DVI__SYMMETRIC || value[PROJECTION] == DVI__MIDPOINT_PROJECTION;
  DVI_TRY(dvi__partitioned_create(self->system, (dvi__tableau)value[TABLEAU], value[NODES], (dvi__projection)value[PROJECTION],
                                  self->counters, &own->step));
  if (!allocate(self, own)) return dvi__fail(DVI_NO_MEMORY, "vprk: no memory");
  dvi__equations equations = {.unknowns = dvi__partitioned_unknowns(own->step),
                              .pattern = dvi__partitioned_pattern(own->step),
                              .linear = dvi__linear_for_exchanges(dvi__partitioned_pattern(own->step)),
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale};
  return dvi__stationary_create(&equations, self->counters, &own->solver);
}

static void destroy(dvi__stepper *self)
{
  vprk *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__partitioned_destroy(&own->step);
  dvi__release(own->guess);
  dvi__release(own->x);
  dvi__release(own->dq);
  dvi__release(own->dp);
  dvi__release(own);
}

static void start(dvi__stepper *self, const double *v)
{
  memset(self->memory, 0, self->memory_count * sizeof(double));
  memcpy(self->memory + last_x(self), v, (size_t)self->system->n * sizeof(double));
}

/* ---- the step ---- */

/* On the constraint p is alpha(q), to the last bit. */
static dvi_status advance(dvi__stepper *self, dvi__state *state, double h)
{
  const vprk *own = self->own;
  const int n = self->system->n;
  dvi__partitioned_ends(own->step, own->dq, own->dp);
  dvi__add_compensated_all(n, state->q, state->q_carry, own->dq);
  dvi__add_compensated(&state->t, &state->t_carry, h);
  if (self->settings.value[PROJECTION] == DVI__NO_PROJECTION) {
    dvi__add_compensated_all(n, state->p, state->p_carry, own->dp);
    return DVI_OK;
  }
  memset(own->dq, 0, (size_t)n * sizeof(double));
  return dvi__form_gradient(dvi__partitioned_evaluator(own->step), state->q, own->dq, own->dp, state->p);
}

static void remember(dvi__stepper *self, double h)
{
  const vprk *own = self->own;
  const int n = self->system->n, s = self->settings.value[NODES], unknowns = dvi__partitioned_unknowns(own->step), m = unknowns / n;
  self->memory[LAST_H] = h;
  memcpy(self->memory + last_x(self), own->x, (size_t)unknowns * sizeof(double));
  for (int i = 0; i < n; i++) self->memory[MULTIPLIER + i] = m > s ? own->x[i * m + s] : 0;
}

static dvi_status step(dvi__stepper *self, dvi__state *state, double h)
{
  vprk *own = self->own;
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

static const double *multiplier(const dvi__stepper *self)
{
  return self->settings.value[PROJECTION] == DVI__NO_PROJECTION ? NULL : self->memory + MULTIPLIER;
}

static void explain(const dvi__stepper *self, dvi__text *text)
{
  const vprk *own = self->own;
  const dvi__pattern *pattern = dvi__partitioned_pattern(own->step);
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n", pattern->columns,
                dvi__pattern_entries(pattern), 100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  dvi__text_add(text, "constraint: p = alpha(q), %s\n",
                self->settings.value[PROJECTION] == DVI__NO_PROJECTION ? "which the steps leave"
                                                                       : "to the last bit after every step");
  dvi__text_add(text, "solver: Newton's method, last KINSOL with line search\n");
}

const dvi__method dvi__vprk = {
    .name = "vprk",
    .summary = "partitioned Runge-Kutta, projected onto p = alpha(q); order 2s; degenerate Lagrangians only",
    .cite = "Kraus2017",
    .keys = keys,
    .needs = DVI__ONE_FORM,
    .uses = DVI__ONE_FORM | DVI__POTENTIAL,
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .multiplier = multiplier,
    .explain = explain,
};
