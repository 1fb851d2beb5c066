/* Boris's method for L = v.Mv/2 + A(t,q).v - V(t,q).
 *
 *     q_half = q0 + h/2 v0,                    v0 = M^-1 (p0 - A(t0,q0)),
 *     v- = v0 + h/2 M^-1 E,                    E = -V_q - A_t at (t0 + h/2, q_half),
 *     M (v+ - v-) = h/2 B (v+ + v-),           B_ij = dA_j/dq_i - dA_i/dq_j at the same point,
 *     v1 = v+ + h/2 M^-1 E,   q1 = q_half + h/2 v1,   p1 = M v1 + A(t1,q1).
 *
 * It is explicit but for the turn (step/split/gyration.h), symmetric, of order 2, and preserves the
 * volume of phase space, since every part does. It is not symplectic unless B is constant in space.
 * It does not depend on the gauge: A enters by B and A_t alone, and in p. Source: Boris 1970; Qin
 * et al. 2013, eq. 3 (volume); Hairer and Lubich 2018, eq. 2.2, with positions at the ends.
 *
 * The members of an ensemble take the same operations as one state. */
#include <string.h>

#include "step/split/gyration.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/method.h"
#include "num/compensated.h"
#include "num/simd/lanes.h"

/* The memory holds A at the end of the last step, which is that at the start of the next, and then
 * a flag. */
typedef struct boris {
  int n;
  dvi__evaluator *evaluator;
  dvi__gyration *gyration;
  double *numbers; /* owns the following */
  double *t;       /* [capacity] time in the middle */
  /* [n*capacity] */
  double *v, *E, *push, *turn, *A;
  double *A_q; /* [entries*capacity] */
} boris;

/* States side by side, number i of state k at [i*count + k]. */
typedef struct states {
  int count;
  double *t, *t_compensation, *q, *q_compensation, *p, *p_compensation;
  double *A; /* [n*count] at the start, then at the end */
} states;

/* ---- create, destroy ---- */

static void boris_destroy_part(boris *own)
{
  if (own == NULL) return;
  dvi__gyration_destroy(&own->gyration);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->numbers);
  dvi__release(own);
}

static dvi_status boris_fill(boris *own, const dvi_system *system, int capacity,
                             dvi_counters *counters)
{
  const size_t width = (size_t)capacity, n = (size_t)system->n,
               entries = (size_t)dvi__pattern_entries(&system->qv);
  own->n = system->n;
  own->numbers = DVI_NEW(double, width *(1 + 5 * n + entries));
  if (own->numbers == NULL) return dvi__fail(DVI_NO_MEMORY, "boris: no memory");
  own->t = own->numbers;
  own->v = own->t + width;
  own->E = own->v + n * width;
  own->push = own->E + n * width;
  own->turn = own->push + n * width;
  own->A = own->turn + n * width;
  own->A_q = own->A + n * width;
  DVI_TRY(dvi__gyration_create(system, counters, &own->gyration));
  return dvi__evaluator_create(system, capacity, DVI__GRADIENTS, counters, &own->evaluator);
}

static dvi_status boris_create(dvi__stepper *self)
{
  DVI_TRY(dvi__system_has_field(self->system));
  self->own = DVI_NEW(boris, 1);
  self->order = 2;
  self->symmetric = 1;
  self->memory_count = (size_t)self->system->n + 1;
  if (self->own == NULL) return dvi__fail(DVI_NO_MEMORY, "boris: no memory");
  return boris_fill(self->own, self->system, 1, self->counters);
}

static void boris_destroy(dvi__stepper *self)
{
  boris_destroy_part(self->own);
}

/* ---- a step ---- */

static size_t count_of(const boris *own, const states *s)
{
  return (size_t)own->n * (size_t)s->count;
}

static void drift(const boris *own, const states *s, double h)
{
  dvi__lanes_add_scaled(count_of(own, s), 0.5 * h, own->v, s->q, s->q_compensation);
}

/* Evaluate E and the gradients of A in the middle, and push = h/2 M^-1 E. */
static dvi_status evaluate_field(boris *own, const states *s, double h)
{
  double *A_t = own->push;
  for (int k = 0; k < s->count; k++) own->t[k] = s->t[k] + 0.5 * h;
  DVI_TRY(dvi__potentials_gradient(own->evaluator, s->count, own->t, s->q, own->E));
  DVI_TRY(dvi__magnetic_field(own->evaluator, s->count, own->t, s->q, own->A_q, A_t));
  for (size_t i = 0; i < count_of(own, s); i++) own->E[i] = -own->E[i] - A_t[i];
  dvi__mass_solve(own->evaluator, s->count, own->E, own->push);
  for (size_t i = 0; i < count_of(own, s); i++) own->push[i] *= 0.5 * h;
  return DVI_OK;
}

/* Take v0 to v1, and set turn = h/2 B (v+ + v-), which M v gains beside h E. */
static dvi_status push_and_turn(boris *own, const states *s, double h)
{
  const size_t numbers = count_of(own, s);
  double *v = own->v, *d = own->turn;
  for (size_t i = 0; i < numbers; i++) v[i] += own->push[i];
  dvi__gyration_times(own->gyration, s->count, h, own->A_q, v, d);
  DVI_TRY(dvi__gyration_solve(own->gyration, s->count, h, own->A_q, d));
  for (size_t i = 0; i < numbers; i++) {
    const double before = v[i], after = before + d[i];
    own->A[i] = before + after;
    v[i] = after + own->push[i];
  }
  dvi__gyration_times(own->gyration, s->count, 0.5 * h, own->A_q, own->A, own->turn);
  return DVI_OK;
}

static dvi_status boris_advance(boris *own, const states *s, double h)
{
  const size_t numbers = count_of(own, s);
  for (size_t i = 0; i < numbers; i++) own->v[i] = s->p[i] - s->A[i];
  dvi__mass_solve(own->evaluator, s->count, own->v, own->v);
  drift(own, s, h);
  DVI_TRY(evaluate_field(own, s, h));
  DVI_TRY(push_and_turn(own, s, h));
  drift(own, s, h);
  for (int k = 0; k < s->count; k++) dvi__add_compensated(s->t + k, s->t_compensation + k, h);
  DVI_TRY(dvi__vector_potential(own->evaluator, s->count, s->t, s->q, own->A));
  for (size_t i = 0; i < numbers; i++) {
    const double gained = (own->A[i] - s->A[i]) + (h * own->E[i] + own->turn[i]);
    dvi__add_compensated(s->p + i, s->p_compensation + i, gained);
  }
  memcpy(s->A, own->A, numbers * sizeof(double));
  return DVI_OK;
}

static dvi_status boris_step(dvi__stepper *self, dvi__state *state, double h)
{
  boris *own = self->own;
  double *known = self->memory + self->system->n;
  const states one = {.count = 1,
                      .t = &state->t,
                      .t_compensation = &state->t_compensation,
                      .q = state->q,
                      .q_compensation = state->q_compensation,
                      .p = state->p,
                      .p_compensation = state->p_compensation,
                      .A = self->memory};
  if (*known == 0)
    DVI_TRY(dvi__vector_potential(own->evaluator, 1, &state->t, state->q, self->memory));
  *known = 1;
  return boris_advance(own, &one, h);
}

/* ---- members side by side ---- */

static dvi_status boris_prepare_lanes(dvi__stepper *self, int capacity)
{
  if (!dvi__system_has_gradients(self->system)) return DVI_OK;
  self->lanes = DVI_NEW(boris, 1);
  if (self->lanes == NULL) return dvi__fail(DVI_NO_MEMORY, "boris: no memory");
  /* without counters, because the cost of a member is known */
  return boris_fill(self->lanes, self->system, capacity, NULL);
}

static void boris_clear_lanes(dvi__stepper *self)
{
  boris_destroy_part(self->lanes);
}

/* Return 1 if A is known for all members, 0 if for none, and -1 if for some. */
static int all_known(const double *known, int count)
{
  int members = 0;
  for (int k = 0; k < count; k++) members += known[k] != 0;
  return members == count ? 1 : members == 0 ? 0 : -1;
}

/* Take one batch for all members, or leave them all. When each steps alone, the member for which a
 * callback failed shows. */
static void boris_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  boris *own = self->lanes;
  double *known = m->memory + (size_t)own->n * (size_t)m->count;
  const int all = all_known(known, m->count);
  const states members = {.count = m->count,
                          .t = m->t,
                          .t_compensation = m->t_compensation,
                          .q = m->q,
                          .q_compensation = m->q_compensation,
                          .p = m->p,
                          .p_compensation = m->p_compensation,
                          .A = m->memory};
  dvi_status status = all < 0 ? DVI_NOT_CONVERGED : DVI_OK;
  if (all == 0) status = dvi__vector_potential(own->evaluator, m->count, m->t, m->q, m->memory);
  if (status == DVI_OK) status = boris_advance(own, &members, h);
  if (status != DVI_OK) memset(m->left, 1, (size_t)m->count);
  for (int k = 0; k < m->count; k++) {
    m->gradients[k] += all == 0 ? 3 : 2;
    known[k] = 1;
  }
}

static void boris_explain(const dvi__stepper *self, dvi__text *text)
{
  const boris *own = self->own;
  const int groups = dvi__gyration_groups(own->gyration);
  dvi__text_add(text, "kernel: explicit; field and forces in the middle of a step, A at its end\n");
  if (groups > 0)
    dvi__text_add(text,
                  "solver: none; velocities turn in %d group%s of at most 3 coordinates, by "
                  "cofactors\n",
                  groups, groups == 1 ? "" : "s");
  else
    dvi__text_add(text, "solver: one factorisation of M - h/2 B a step, which turns velocities\n");
}

const dvi__method dvi__boris = {
    .name = "boris",
    .summary = "Boris: drift, kick, turn by a magnetic field, kick, drift; order 2; constant mass",
    .cite = "Boris1970",
    .needs = DVI__CONSTANT_MASS | DVI__VECTOR_POTENTIAL,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__VECTOR_POTENTIAL,
    .create = boris_create,
    .destroy = boris_destroy,
    .step = boris_step,
    .explain = boris_explain,
    .prepare_lanes = boris_prepare_lanes,
    .clear_lanes = boris_clear_lanes,
    .step_lanes = boris_step_lanes,
};
