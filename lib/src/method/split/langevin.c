/* Splittings of Langevin's equations.
 *
 * B is a kick by the forces, A a drift, O the exact motion in the heat bath (method/split/bath.h),
 * and VI a step of a galerkin variational integrator of any degree.
 *
 *     baoab   B(h/2) A(h/2) O(h) A(h/2) B(h/2)
 *     obabo   O(h/2) B(h/2) A(h) B(h/2) O(h/2)        Verlet's method between two O
 *     ovio    O(h/2) VI(h) O(h/2)
 *
 * Noise functions (shaking.h) join the action of VI.
 *
 * Averages of the stationary state have an error of order 2 with the first two, and of the order of
 * the integrator with ovio. That of positions by baoab vanishes for the harmonic oscillator, and is
 * of order 4 at large friction. Without friction baoab and obabo are Verlet's method. Sources:
 * Leimkuhler and Matthews 2013, eqs. 9 to 11 (baoab); Bussi and Parrinello 2007 (obabo); Bou-Rabee
 * and Owhadi 2010, sec. 2 (ovio).
 *
 * With holonomic constraints each O ends with the projection of p onto G M^-1 p + phi_t = 0, which
 * keeps exp(-H/kT) on phi = 0, and each A is a step of RATTLE without forces (rattle.h; Leimkuhler
 * and Matthews 2016, sec. 2). What a kick or a bath adds along G^T the next A takes away.
 *
 * Members of an ensemble side by side and a single state, which counts as one member, share the
 * code of a step, and have the same bits for this reason. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/split/bath.h"
#include "method/split/rattle.h"
#include "method/split/shaking.h"
#include "num/compensated.h"
#include "num/simd/lanes.h"
#include "system/part.h"

enum { SCHEME, REFINEMENT };

enum { BAOAB, OBABO, OVIO, SCHEMES };

static const char *langevin_scheme_name(int index)
{
  static const char *const name[] = {"baoab", "obabo", "ovio"};
  return index >= 0 && index < SCHEMES ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"scheme", langevin_scheme_name, 0, 0, BAOAB,
     "baoab or obabo, explicit, or ovio, a step of galerkin between two of the heat bath; all "
     "other "
     "keys are those of galerkin; default: baoab"},
    {"refinement", NULL, 0, 20, 0,
     "draw the noise of each step in 2^k parts; runs with h and k, and with h/2 and k - 1, see one "
     "path of noise; default: 0"},
    {0},
};

typedef struct langevin {
  dvi__bath *bath;
  dvi__evaluator *evaluator;
  double *numbers;       /* storage of the next arrays */
  double *p[2];          /* [n] momenta before and after the step without noise */
  double *v, *F;         /* [n] */
  double *supply;        /* [1 + symmetries] */
  dvi__rattle *rattle;   /* NULL without constraints */
  dvi_system *free;      /* the system without noise, of ovio */
  dvi__stepper *inner;   /* galerkin on it, or NULL */
  dvi__shaking *shaking; /* forces of the noise functions on it, or NULL */
} langevin;

/* Behind the numbers of the bath the memory of explicit schemes holds the gradient [n] at the
 * state, whether it is known, and the velocities [n] of both halves of the drift. That of ovio
 * holds the inner method's. With constraints explicit schemes hold the velocity [n] after the bath
 * and the multipliers, too. */
typedef struct rows {
  double *gradient, *known, *first_v, *last_v, *bath_v, *multipliers, *inner;
} rows;

static rows rows_of(const dvi__stepper *self, int count, double *memory)
{
  const size_t n = (size_t)self->system->n, members = (size_t)count;
  double *at = memory + DVI__BATH_MEMORY * members;
  return (rows){.gradient = at,
                .known = at + n * members,
                .first_v = at + (n + 1) * members,
                .last_v = at + (2 * n + 1) * members,
                .bath_v = at + (3 * n + 1) * members,
                .multipliers = at + (4 * n + 1) * members,
                .inner = at};
}

static int scheme_of(const dvi__stepper *self)
{
  return self->settings.value[SCHEME];
}

/* ---- create, destroy ---- */

static dvi_status create_explicit(dvi__stepper *self, langevin *own)
{
  if (self->settings.rest != NULL)
    return dvi__fail(
        DVI_BAD_OPTION,
        "langevin: %s is for galerkin, which only scheme=ovio has; choose it, or leave "
        "this out",
        self->settings.rest);
  if (self->system->terms & DVI__FRICTION)
    return dvi__fail(DVI_UNSUPPORTED,
                     "langevin: forces that depend on the velocity make the kicks implicit; choose "
                     "scheme=ovio");
  if (self->system->row_count > 0 && self->system->force_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "langevin: forces beside constraints are taken by scheme=ovio alone");
  if (self->system->noise.function_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "langevin: noise functions are taken by scheme=ovio alone; choose it");
  self->order = 2;
  const size_t n = (size_t)self->system->n, m = (size_t)self->system->row_count;
  self->memory_count = DVI__BATH_MEMORY + 3 * n + 1 + (m > 0 ? n + m : 0);
  return dvi__evaluator_create(self->system, 1, DVI__GRADIENTS, self->counters, &own->evaluator);
}

static dvi_status create_inner(dvi__stepper *self, langevin *own)
{
  const int functions = self->system->noise.function_count;
  if (functions > 0) DVI_TRY(dvi__shaking_create(self->system, &own->shaking));
  DVI_TRY(dvi__system_without_noise(self->system, functions,
                                    functions > 0 ? dvi__shaking_forces(own->shaking) : NULL,
                                    &own->free));
  dvi__stepper *inner = own->inner = DVI_NEW(dvi__stepper, 1);
  if (inner == NULL) return dvi__fail(DVI_NO_MEMORY, "langevin: no memory");
  const dvi_status status = dvi__stepper_create_inner(self, "galerkin", own->free, NULL, inner);
  if (status != DVI_OK) return dvi__fail_in(status, "langevin");
  self->order = inner->order;
  self->follows = inner->follows;
  self->fingerprint = inner->fingerprint;
  self->fingerprinted = inner->fingerprinted;
  self->memory_count = DVI__BATH_MEMORY + inner->memory_count;
  return dvi__evaluator_create(own->free, 1, DVI__GRADIENTS, NULL, &own->evaluator);
}

static dvi_status langevin_create(dvi__stepper *self)
{
  const size_t n = (size_t)self->system->n;
  langevin *own = self->own = DVI_NEW(langevin, 1);
  self->bound = 1;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "langevin: no memory");
  double *at = own->numbers = DVI_NEW(double, 4 * n + 1 + (size_t)self->system->symmetry_count);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "langevin: no memory");
  own->p[0] = at;
  own->p[1] = at + n;
  own->v = at + 2 * n;
  own->F = at + 3 * n;
  own->supply = at + 4 * n;
  const dvi_status status = dvi__bath_create(self->system, 1, &own->bath);
  if (status != DVI_OK) return dvi__fail_in(status, "langevin");
  DVI_TRY(scheme_of(self) == OVIO ? create_inner(self, own) : create_explicit(self, own));
  DVI_TRY(dvi__evaluator_prepare_symmetries(own->evaluator));
  if (self->system->row_count == 0) return DVI_OK;
  return dvi__rattle_create(own->free != NULL ? own->free : self->system, own->evaluator,
                            self->counters, &own->rattle);
}

static void langevin_destroy(dvi__stepper *self)
{
  langevin *own = self->own;
  if (own == NULL) return;
  if (own->inner != NULL) dvi__stepper_destroy(own->inner);
  dvi__release(own->inner);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__bath_destroy(&own->bath);
  dvi__rattle_destroy(&own->rattle);
  dvi_system_destroy(&own->free);
  dvi__shaking_destroy(&own->shaking);
  dvi__release(own->numbers);
  dvi__release(own);
}

/* Return the inner stepper, which works on the memory of this method. */
static dvi__stepper *inner_of(const dvi__stepper *self)
{
  const langevin *own = self->own;
  own->inner->memory = rows_of(self, 1, self->memory).inner;
  return own->inner;
}

static void langevin_start(dvi__stepper *self, const double *v)
{
  const langevin *own = self->own;
  dvi__bath_start(self->system, self->member, self->memory);
  if (own->inner != NULL) dvi__stepper_start(inner_of(self), v);
}

/* ---- parts of a step ---- */

/* A step of some members, or of one state that keeps balances. */
typedef struct move {
  dvi__stepper *self;
  dvi__bath *bath;
  dvi__evaluator *evaluator;
  dvi__members *members;
  dvi__state *state;    /* the only one, or NULL */
  dvi__state *balanced; /* NULL without balances */
  rows rows;
} move;

static size_t numbers_of(const move *m)
{
  return (size_t)m->self->system->n * (size_t)m->members->count;
}

/* Add what a force F at the velocity v supplies in the time h. */
static dvi_status add_supply(const move *m, double h, const double *F, const double *v)
{
  const langevin *own = m->self->own;
  DVI_TRY(dvi__supply(own->evaluator, 1, &h, F, m->balanced->q, v, own->supply));
  dvi__add_compensated_all(1 + m->self->system->symmetry_count, m->balanced->supplied,
                           m->balanced->supplied_compensation, own->supply);
  return DVI_OK;
}

/* The heat is the change of p by the bath, at the mean velocity. */
static dvi_status add_heat(const move *m, const double *before)
{
  const langevin *own = m->self->own;
  for (int i = 0; i < m->self->system->n; i++) {
    own->F[i] = m->members->p[i] - before[i];
    own->v[i] = 0.5 * (m->members->p[i] + before[i]);
  }
  dvi__mass_solve(own->evaluator, 1, own->v, own->v);
  return add_supply(m, 1, own->F, own->v);
}

static dvi_status meet_bath(const move *m, double tau)
{
  const langevin *own = m->self->own;
  dvi__members *s = m->members;
  if (m->balanced != NULL) memcpy(own->p[1], s->p, numbers_of(m) * sizeof(double));
  dvi__bath_move(m->bath, tau, 1 << m->self->settings.value[REFINEMENT], s->count, s->memory, s->p,
                 s->p_compensation);
  if (own->rattle != NULL) DVI_TRY(dvi__rattle_project(own->rattle, m->state));
  return m->balanced != NULL ? add_heat(m, own->p[1]) : DVI_OK;
}

static dvi_status renew_gradient(const move *m)
{
  dvi__members *s = m->members;
  for (int k = 0; k < s->count; k++) {
    m->rows.known[k] = 1;
    if (s->gradients != NULL) s->gradients[k]++;
  }
  return dvi__potentials_gradient(m->evaluator, s->count, s->t, s->q, m->rows.gradient);
}

/* Forces F(t,q) supply their part of the kick at the velocity v of the drift next to it. */
static dvi_status supply_of_kick(const move *m, double h, const double *v)
{
  const langevin *own = m->self->own;
  if (m->balanced == NULL || m->self->system->force_count == 0) return DVI_OK;
  DVI_TRY(dvi__forces(own->evaluator, DVI__FORCES, 1, m->members->t, m->members->q, v, own->F));
  return add_supply(m, h, own->F, v);
}

static void kick(const move *m, double h)
{
  dvi__lanes_add_scaled(numbers_of(m), -h, m->rows.gradient, m->members->p,
                        m->members->p_compensation);
}

static void find_velocity(const move *m, double *v)
{
  dvi__mass_solve(m->evaluator, m->members->count, m->members->p, v);
}

static void drift(const move *m, double h, const double *v)
{
  dvi__lanes_add_scaled(numbers_of(m), h, v, m->members->q, m->members->q_compensation);
}

static void advance_clocks(const move *m, double h)
{
  for (int k = 0; k < m->members->count; k++)
    dvi__add_compensated(m->members->t + k, m->members->t_compensation + k, h);
}

/* ---- steps ---- */

/* The first kick, and the half of the drift before the bath of baoab, or before the middle. */
static dvi_status first_half(const move *m, double h)
{
  kick(m, 0.5 * h);
  find_velocity(m, m->rows.first_v);
  DVI_TRY(supply_of_kick(m, 0.5 * h, m->rows.first_v));
  drift(m, 0.5 * h, m->rows.first_v);
  return DVI_OK;
}

static dvi_status last_half(const move *m, double h)
{
  find_velocity(m, m->rows.last_v);
  drift(m, 0.5 * h, m->rows.last_v);
  advance_clocks(m, h);
  DVI_TRY(renew_gradient(m));
  DVI_TRY(supply_of_kick(m, 0.5 * h, m->rows.last_v));
  kick(m, 0.5 * h);
  return DVI_OK;
}

static dvi_status explicit_step(const move *m, double h)
{
  const int at_ends = scheme_of(m->self) == OBABO;
  if (at_ends) DVI_TRY(meet_bath(m, 0.5 * h));
  DVI_TRY(first_half(m, h));
  if (!at_ends) DVI_TRY(meet_bath(m, h));
  DVI_TRY(last_half(m, h));
  return at_ends ? meet_bath(m, 0.5 * h) : DVI_OK;
}

/* A drift on the constraints. The bath breaks the trend of the multipliers. */
static dvi_status constrained_drift(const move *m, double h, double *v)
{
  const langevin *own = m->self->own;
  DVI_TRY(dvi__rattle_begin(own->rattle, m->state, h, m->rows.multipliers, NULL));
  find_velocity(m, v);
  drift(m, h, v);
  advance_clocks(m, h);
  return dvi__rattle_end(own->rattle, m->state, h, m->rows.multipliers, NULL);
}

/* A(h/2) O(h) A(h/2), or A(h). */
static dvi_status constrained_middle(const move *m, double h)
{
  const size_t bytes = numbers_of(m) * sizeof(double);
  if (scheme_of(m->self) == OBABO) {
    DVI_TRY(constrained_drift(m, h, m->rows.first_v));
    memcpy(m->rows.last_v, m->rows.first_v, bytes);
    return DVI_OK;
  }
  DVI_TRY(constrained_drift(m, 0.5 * h, m->rows.first_v));
  DVI_TRY(meet_bath(m, h));
  find_velocity(m, m->rows.bath_v);
  return constrained_drift(m, 0.5 * h, m->rows.last_v);
}

static dvi_status constrained_step(const move *m, double h)
{
  const langevin *own = m->self->own;
  const int at_ends = scheme_of(m->self) == OBABO;
  if (at_ends) DVI_TRY(meet_bath(m, 0.5 * h));
  kick(m, 0.5 * h);
  DVI_TRY(constrained_middle(m, h));
  DVI_TRY(renew_gradient(m));
  kick(m, 0.5 * h);
  DVI_TRY(dvi__rattle_project(own->rattle, m->state));
  return at_ends ? meet_bath(m, 0.5 * h) : DVI_OK;
}

static dvi_status inner_step(const move *m, dvi__state *state, double h)
{
  const langevin *own = m->self->own;
  const size_t bytes = numbers_of(m) * sizeof(double);
  if (own->shaking != NULL)
    dvi__shaking_draw(own->shaking, h, 2 << m->self->settings.value[REFINEMENT], m->self->memory);
  DVI_TRY(meet_bath(m, 0.5 * h));
  memcpy(own->p[0], state->p, bytes);
  DVI_TRY(dvi__inner_step(m->self, inner_of(m->self), state, h));
  memcpy(own->p[1], state->p, bytes);
  m->self->free_p[0] = own->p[0];
  m->self->free_p[1] = own->p[1];
  return DVI_OK;
}

static dvi_status langevin_step(dvi__stepper *self, dvi__state *state, double h)
{
  const langevin *own = self->own;
  if (h < 0) return dvi__fail(DVI_BAD_ARGUMENT, "friction and noise have no steps back in time");
  dvi__members one = {.count = 1,
                      .t = &state->t,
                      .t_compensation = &state->t_compensation,
                      .q = state->q,
                      .p = state->p,
                      .q_compensation = state->q_compensation,
                      .p_compensation = state->p_compensation,
                      .memory = self->memory};
  const move m = {.self = self,
                  .bath = own->bath,
                  .evaluator = own->evaluator,
                  .members = &one,
                  .state = state,
                  .balanced = state->supplied != NULL ? state : NULL,
                  .rows = rows_of(self, 1, self->memory)};
  if (own->inner != NULL) {
    DVI_TRY(inner_step(&m, state, h));
    return meet_bath(&m, 0.5 * h);
  }
  if (*m.rows.known == 0) DVI_TRY(renew_gradient(&m));
  return own->rattle != NULL ? constrained_step(&m, h) : explicit_step(&m, h);
}

/* ---- the path and the temperature ---- */

/* The paths of explicit schemes are straight lines, with a kink in the middle of baoab. */
static void langevin_path(const dvi__stepper *self, const double *q0, double h, double tau,
                          double *q, double *v)
{
  const langevin *own = self->own;
  const rows r = rows_of(self, 1, self->memory);
  if (own->inner != NULL) {
    const dvi__stepper *inner = inner_of(self);
    inner->method->path(inner, q0, h, tau, q, v);
    return;
  }
  const double first = tau < 0.5 ? tau : 0.5, last = tau - first;
  for (int i = 0; i < self->system->n; i++) {
    if (q != NULL) q[i] = q0[i] + h * (first * r.first_v[i] + last * r.last_v[i]);
    if (v != NULL) v[i] = tau < 0.5 ? r.first_v[i] : r.last_v[i];
  }
}

/* Return n less the rank of the constraints. The side tells how many rows depend on others. */
static int freedom_of(const dvi__stepper *self, const dvi__state *state)
{
  const int dependent = state->side > 1 ? state->side - 1 : 0;
  return self->system->n - (self->system->row_count - dependent);
}

/* After the O of baoab the velocity is that of the last half of the drift. The other schemes end
 * with an O. */
static dvi_status langevin_temperature(dvi__stepper *self, const dvi__state *state,
                                       double *temperature)
{
  const langevin *own = self->own;
  const int in_middle = scheme_of(self) == BAOAB && self->memory[DVI__BATH_DRAWS] > 0,
            freedom = freedom_of(self, state);
  if (freedom < 1)
    return dvi__fail(DVI_UNSUPPORTED, "temperature: the constraints leave no degree of freedom");
  const double *p = state->p, *v = own->v;
  if (in_middle) {
    const rows r = rows_of(self, 1, self->memory);
    v = own->rattle != NULL ? r.bath_v : r.last_v;
    DVI_TRY(dvi__lagrangian_gradient(own->evaluator, 1, &state->t, state->q, v, NULL, own->F));
    p = own->F;
  } else {
    dvi__mass_solve(own->evaluator, 1, p, own->v);
  }
  double twice = 0;
  for (int i = 0; i < self->system->n; i++) twice += p[i] * v[i];
  *temperature = twice / freedom;
  return DVI_OK;
}

/* ---- members side by side ---- */

typedef struct lanes {
  dvi__bath *bath;
  dvi__evaluator *evaluator; /* without counters, which the members have */
} lanes;

/* A mass that is not diagonal mixes coordinates, and a member then steps on its own. */
static dvi_status langevin_prepare_lanes(dvi__stepper *self, int capacity)
{
  const langevin *own = self->own;
  if (self->system->mass_diagonal == NULL || own->rattle != NULL || own->shaking != NULL ||
      !dvi__system_has_gradients(self->system))
    return DVI_OK;
  if (own->inner != NULL) {
    DVI_TRY(dvi__stepper_prepare_lanes(own->inner, capacity));
    if (own->inner->lanes == NULL) return DVI_OK;
  }
  lanes *side = self->lanes = DVI_NEW(lanes, 1);
  if (side == NULL) return dvi__fail(DVI_NO_MEMORY, "langevin: no memory");
  DVI_TRY(dvi__bath_create(self->system, capacity, &side->bath));
  return own->inner == NULL
             ? dvi__evaluator_create(self->system, capacity, DVI__GRADIENTS, NULL, &side->evaluator)
             : DVI_OK;
}

static void langevin_clear_lanes(dvi__stepper *self)
{
  lanes *side = self->lanes;
  dvi__bath_destroy(&side->bath);
  dvi__evaluator_destroy(&side->evaluator);
  dvi__release(side);
}

/* Return 1 if the gradients of all members are known, 0 if none is, and -1 if some are. */
static int gradients_known(const move *m)
{
  int known = 0;
  for (int k = 0; k < m->members->count; k++) known += m->rows.known[k] != 0;
  return known == m->members->count ? 1 : known == 0 ? 0 : -1;
}

static dvi_status explicit_lanes(const move *m, double h)
{
  const int known = gradients_known(m);
  if (known < 0) return DVI_BAD_STATE;
  if (known == 0) DVI_TRY(renew_gradient(m));
  return explicit_step(m, h);
}

static dvi_status inner_lanes(const move *m, double h)
{
  const langevin *own = m->self->own;
  dvi__members inner = *m->members;
  inner.memory = m->rows.inner;
  DVI_TRY(meet_bath(m, 0.5 * h));
  own->inner->method->step_lanes(own->inner, &inner, h);
  return meet_bath(m, 0.5 * h);
}

/* Take one batch for all members, or leave them all. When each steps alone, the member for which a
 * callback failed shows. */
static void langevin_step_lanes(dvi__stepper *self, dvi__members *members, double h)
{
  const langevin *own = self->own;
  const lanes *side = self->lanes;
  const move m = {.self = self,
                  .bath = side->bath,
                  .evaluator = side->evaluator,
                  .members = members,
                  .rows = rows_of(self, members->count, members->memory)};
  if (h < 0 || (own->inner != NULL ? inner_lanes(&m, h) : explicit_lanes(&m, h)) != DVI_OK)
    memset(members->left, 1, (size_t)members->count);
}

/* ---- explain ---- */

static void langevin_explain(const dvi__stepper *self, dvi__text *text)
{
  static const char *const parts[] = {"B(h/2) A(h/2) O(h) A(h/2) B(h/2)",
                                      "O(h/2) B(h/2) A(h) B(h/2) O(h/2)",
                                      "O(h/2) galerkin(h) O(h/2)"};
  const langevin *own = self->own;
  const dvi_noise *noise = &self->system->noise;
  dvi__text_add(text,
                "langevin: %s; kT = %g, friction %g, seed %llu, stream %u; the order is that of "
                "averages\n",
                parts[scheme_of(self)], noise->temperature, noise->friction, noise->seed,
                noise->stream);
  if (own->shaking != NULL)
    dvi__text_add(text, "noise functions: %d; their paths converge with order 1\n",
                  noise->function_count);
  if (own->inner != NULL) {
    dvi__text_add(text, "inner: %s\n", own->inner->specification);
    own->inner->method->explain(own->inner, text);
    return;
  }
  dvi__text_add(
      text,
      "kernel: explicit; one gradient a step (the last one of a step is the first of the next)\n"
      "solver: none; no Hessian, no Jacobian, no factorisation of a step's equations\n");
}

const dvi__method dvi__langevin = {
    .name = "langevin",
    .summary = "noise and friction of a heat bath around verlet or galerkin; constant mass",
    .cite = "LeimkuhlerMatthews2013",
    .keys = keys,
    .takes_rest = 1,
    .needs = DVI__CONSTANT_MASS | DVI__NOISE,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FORCES | DVI__HOLONOMIC | DVI__NOISE,
    .create = langevin_create,
    .destroy = langevin_destroy,
    .start = langevin_start,
    .step = langevin_step,
    .path = langevin_path,
    .explain = langevin_explain,
    .temperature = langevin_temperature,
    .prepare_lanes = langevin_prepare_lanes,
    .clear_lanes = langevin_clear_lanes,
    .step_lanes = langevin_step_lanes,
};
