/* Runge-Kutta methods on Lie groups, for comparison. None of them is symplectic on a group, and
 * none keeps momenta or the energy over long times.
 *
 * Let q' = q.omega(q,p) with the group's own multiplication, let m' be the rate of the momenta
 * (step/lie/flow.h), and let k = (omega, m').
 *     explicit-midpoint   y1 = y0 + h k(y0 + h/2 k(y0))   in the coordinates y that contain the
 *                         group; y leaves the group
 *     implicit-midpoint   y1 = y0 + h k((y0 + y1)/2)      in the same coordinates; keeps quadratic
 *                         invariants, as R^T R and a direction's y.p (dvi__flow_plain)
 *     crouch-grossman     q1 = q0 exp(h omega_2),  k_2 at q0 exp(h/2 omega_1), in two stages
 *     munthe-kaas         q1 = q0 exp(theta),      theta' = dexp^-1 omega by the classical method
 *                         of order 4
 *
 * The orders are 2, 2, 2 and 4. Source: Leok and Shingel 2012, sec. 2.4; Crouch and Grossman 1993;
 * Munthe-Kaas 1998. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/lie/flow.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/method.h"
#include "num/compensated.h"
#include "num/finite.h"

enum { SCHEME };

enum { EXPLICIT_MIDPOINT, IMPLICIT_MIDPOINT, CROUCH_GROSSMAN, MUNTHE_KAAS, SCHEMES };

static const char *scheme_name(int index)
{
  static const char *const name[] = {"explicit-midpoint", "implicit-midpoint", "crouch-grossman",
                                     "munthe-kaas"};
  return index >= 0 && index < SCHEMES ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"scheme", scheme_name, 0, 0, MUNTHE_KAAS,
     "explicit-midpoint, implicit-midpoint, crouch-grossman (order 2) or munthe-kaas (order 4); "
     "default: munthe-kaas"},
    {0},
};

typedef struct lie_rk {
  dvi__flow *flow;
  double *numbers; /* owns all arrays below */
  /* [n] start of the step, with m0 in p for the schemes with exponentials */
  dvi__phase start;
  double *omega, *m_rate, *sum, *m_sum, *theta; /* [n] */
} lie_rk;

enum { ARRAYS = 9, MOST_ITERATIONS = 200 };

static dvi_status lie_rk_create(dvi__stepper *self)
{
  const size_t n = (size_t)self->system->n;
  lie_rk *own = self->own = DVI_NEW(lie_rk, 1);
  self->order = self->settings.value[SCHEME] == MUNTHE_KAAS ? 4 : 2;
  self->symmetric = self->settings.value[SCHEME] == IMPLICIT_MIDPOINT;
  self->memory_count = 0;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-rk: no memory");
  double *at = own->numbers = DVI_NEW(double, (ARRAYS * n));
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-rk: no memory");
  double **const array[ARRAYS] = {&own->start.q,
                                  &own->start.p,
                                  &own->start.q_compensation,
                                  &own->start.p_compensation,
                                  &own->omega,
                                  &own->m_rate,
                                  &own->sum,
                                  &own->m_sum,
                                  &own->theta};
  for (int i = 0; i < ARRAYS; i++) *array[i] = at + (size_t)i * n;
  return dvi__flow_create(self->system, self->counters, &own->flow);
}

static void lie_rk_destroy(dvi__stepper *self)
{
  lie_rk *own = self->own;
  if (own == NULL) return;
  dvi__flow_destroy(&own->flow);
  dvi__release(own->numbers);
  dvi__release(own);
}

static dvi__phase lie_rk_phase_of(const dvi__state *state)
{
  return (dvi__phase){.q = state->q,
                      .p = state->p,
                      .q_compensation = state->q_compensation,
                      .p_compensation = state->p_compensation};
}

static void lie_rk_copy(const dvi_system *system, const dvi__phase *from, const dvi__phase *to)
{
  const size_t points = (size_t)system->n * sizeof(double),
               momenta = (size_t)system->nv * sizeof(double);
  memcpy(to->q, from->q, points);
  memcpy(to->q_compensation, from->q_compensation, points);
  memcpy(to->p, from->p, momenta);
  memcpy(to->p_compensation, from->p_compensation, momenta);
}

/* ---- in the coordinates that contain the group ---- */

/* Compute the rates of the state's coordinates as plain numbers, in sum and m_sum. */
static dvi_status plain_rates(dvi__stepper *self, double t, const dvi__state *state)
{
  const lie_rk *own = self->own;
  DVI_TRY(dvi__flow_rates(own->flow, t, state->q, state->p, own->omega, own->m_rate));
  dvi__flow_plain(own->flow, state->q, state->p, own->omega, own->m_rate, own->sum, own->m_sum);
  return DVI_OK;
}

/* Set x = x0 + h rate with compensated sums. Returns the largest motion. */
static double move_numbers(int count, const double *x0, const double *x0_compensation, double h,
                           const double *rate, double *x, double *compensation)
{
  double moved = 0;
  for (int i = 0; i < count; i++) {
    const double last = x[i];
    x[i] = x0[i];
    compensation[i] = x0_compensation[i];
    dvi__add_compensated(x + i, compensation + i, h * rate[i]);
    moved = fmax(moved, fabs(x[i] - last));
  }
  return moved;
}

/* Set the state to the start plus h times the rates. Returns the largest motion. */
static double move_plainly(dvi__stepper *self, dvi__state *state, double h)
{
  const lie_rk *own = self->own;
  const dvi__phase *from = &own->start;
  return fmax(move_numbers(self->system->n, from->q, from->q_compensation, h, own->sum, state->q,
                           state->q_compensation),
              move_numbers(self->system->nv, from->p, from->p_compensation, h, own->m_sum, state->p,
                           state->p_compensation));
}

static dvi_status explicit_midpoint(dvi__stepper *self, dvi__state *state, double h)
{
  DVI_TRY(plain_rates(self, state->t, state));
  (void)move_plainly(self, state, 0.5 * h);
  DVI_TRY(plain_rates(self, state->t + 0.5 * h, state));
  (void)move_plainly(self, state, h);
  return DVI_OK;
}

/* Return 1 if a vector of a rotation, direction or angle has grown beyond 2. The midpoint of two
 * vectors of length 1 is no longer than 1. Where the iteration contracts, half a step rotates by
 * less than 1, and the guesses are no longer than sqrt(2). */
static int has_diverged(const dvi_system *system, const double *q)
{
  for (int c = 0; c < system->slot_count; c++) {
    const dvi__factor_slot *slot = &system->slots[c];
    if (slot->kind != DVI__LINE &&
        dvi__largest((size_t)dvi__chart_stored(slot->kind), q + slot->q) > 2)
      return 1;
  }
  return 0;
}

/* Iterate for the midpoint by fixed-point iteration, until rounding dominates. */
static dvi_status implicit_midpoint(dvi__stepper *self, dvi__state *state, double h)
{
  double last = HUGE_VAL;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    DVI_TRY(plain_rates(self, state->t + 0.5 * h, state));
    const double moved = move_plainly(self, state, 0.5 * h);
    const double scale = fmax(dvi__largest((size_t)self->system->n, state->q),
                              dvi__largest((size_t)self->system->nv, state->p));
    self->counters->residuals++;
    if (!isfinite(moved) || !isfinite(scale) || has_diverged(self->system, state->q)) break;
    if (moved <= 64 * DBL_EPSILON * scale && (moved == 0 || moved >= last)) {
      (void)move_plainly(self, state, h);
      return DVI_OK;
    }
    last = moved;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "the fixed-point iteration for the midpoint does not settle");
}

/* ---- on the group ---- */

/* Move the state from the start by theta, with the momenta m0 + h m_rate. */
static void move_state(dvi__stepper *self, dvi__state *state, const double *theta, double h,
                       const double *m_rate)
{
  const lie_rk *own = self->own;
  const dvi__phase phase = lie_rk_phase_of(state);
  lie_rk_copy(self->system, &own->start, &phase);
  dvi__flow_move(own->flow, theta, &phase);
  for (int i = 0; i < self->system->nv; i++)
    dvi__add_compensated(phase.p + i, phase.p_compensation + i, h * m_rate[i]);
  dvi__flow_leave(own->flow, &phase);
}

static dvi_status crouch_grossman(dvi__stepper *self, dvi__state *state, double h)
{
  const lie_rk *own = self->own;
  const double part[] = {0.5 * h, h};
  dvi__flow_enter(own->flow, &own->start);
  for (int stage = 0; stage < 2; stage++) {
    DVI_TRY(dvi__flow_rates(own->flow, state->t + 0.5 * h * stage, state->q, state->p, own->omega,
                            own->m_rate));
    for (int i = 0; i < self->system->nv; i++) own->theta[i] = part[stage] * own->omega[i];
    if (stage == 0)
      dvi__flow_place(own->flow, own->theta, part[stage], own->m_rate, &own->start, state->q,
                      state->p);
  }
  move_state(self, state, own->theta, h, own->m_rate);
  return DVI_OK;
}

static dvi_status munthe_kaas(dvi__stepper *self, dvi__state *state, double h)
{
  static const double c[] = {0, 0.5, 0.5, 1}, b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  const lie_rk *own = self->own;
  const size_t bytes = (size_t)self->system->nv * sizeof(double);
  dvi__flow_enter(own->flow, &own->start);
  memset(own->sum, 0, bytes);
  memset(own->m_sum, 0, bytes);
  memset(own->theta, 0, bytes);
  for (int stage = 0; stage < 4; stage++) {
    DVI_TRY(dvi__flow_rates(own->flow, state->t + c[stage] * h, state->q, state->p, own->omega,
                            own->m_rate));
    dvi__flow_theta_rate(own->flow, own->theta, own->omega, own->omega);
    const double next = stage < 3 ? c[stage + 1] * h : 0;
    for (int i = 0; i < self->system->nv; i++) {
      own->sum[i] += h * b[stage] * own->omega[i];
      own->m_sum[i] += b[stage] * own->m_rate[i];
      own->theta[i] = next * own->omega[i];
    }
    if (stage < 3)
      dvi__flow_place(own->flow, own->theta, next, own->m_rate, &own->start, state->q, state->p);
  }
  move_state(self, state, own->sum, h, own->m_sum);
  return DVI_OK;
}

static int is_finite(const dvi_system *system, const dvi__state *state)
{
  return dvi__first_not_finite((size_t)system->n, state->q) < 0 &&
         dvi__first_not_finite((size_t)system->nv, state->p) < 0;
}

static dvi_status lie_rk_step(dvi__stepper *self, dvi__state *state, double h)
{
  static dvi_status (*const scheme[])(dvi__stepper *, dvi__state *, double) = {
      explicit_midpoint, implicit_midpoint, crouch_grossman, munthe_kaas};
  const lie_rk *own = self->own;
  const dvi__phase phase = lie_rk_phase_of(state);
  lie_rk_copy(self->system, &phase, &own->start);
  const dvi_status status = scheme[self->settings.value[SCHEME]](self, state, h);
  if (status != DVI_OK && status != DVI_NOT_CONVERGED && !is_finite(self->system, state))
    return dvi__fail(DVI_NOT_FINITE, "a state inside the step is not finite");
  if (status == DVI_SINGULAR) /* the mass was regular at the start */
    return dvi__fail(DVI_NOT_CONVERGED, "the mass is singular at a state inside the step");
  DVI_TRY(status);
  dvi__add_compensated(&state->t, &state->t_compensation, h);
  return DVI_OK;
}

static void lie_rk_explain(const dvi__stepper *self, dvi__text *text)
{
  static const char *const kernel[] = {
      "explicit; two gradients a step", "fixed-point iteration; one gradient an iteration",
      "explicit; two gradients a step", "explicit; four gradients a step"};
  dvi__text_add(text, "kernel: %s; not symplectic\n", kernel[self->settings.value[SCHEME]]);
}

const dvi__method dvi__lie_rk = {
    .name = "lie-rk",
    .summary = "Runge-Kutta on groups, for comparison: Crouch-Grossman, Munthe-Kaas, midpoint "
               "rules; orders 2 and 4; not symplectic",
    .cite = "LeokShingel2012",
    .keys = keys,
    .needs = DVI__FACTORS,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS,
    .create = lie_rk_create,
    .destroy = lie_rk_destroy,
    .step = lie_rk_step,
    .explain = lie_rk_explain,
};
