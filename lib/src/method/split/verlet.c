/* Stoermer-Verlet.
 *
 * The space is the straight line from q0 to q1. The quadrature is the trapezoid.
 *     Ld(q0,q1) = h/2 L(q0, (q1-q0)/h) + h/2 L(q1, (q1-q0)/h)
 * For L = v.Mv/2 - V(q) the stationarity conditions p0 = -D1 Ld, p1 = D2 Ld are explicit.
 *     p_half = p0 - h/2 dV(q0),   q1 = q0 + h M^-1 p_half,   p1 = p_half - h/2 dV(q1).
 * The order is 2, and the method is symmetric and symplectic. Source: Marsden and West 2001, sec.
 * 2.3.1; Hairer, Lubich and Wanner 2003.
 *
 * Forces F(t,q) join -dV in both kicks. Forces F(t,q,v) make the first kick implicit
 * (friction.h). Holonomic constraints add their forces to both kicks (rattle.h). */
#include <string.h>

#include "step/split/temporal_blocking.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/split/friction.h"
#include "method/split/impulse.h"
#include "method/split/rattle.h"
#include "method/split/verlet_alone.h"
#include "method/split/verlet_lanes.h"
#include "num/compensated.h"

enum { BLOCKING, THREADS };

enum { BLOCKING_AUTO, BLOCKING_TEMPORAL, BLOCKING_NONE };

static const char *blocking_name(int index)
{
  static const char *const name[] = {"auto", "temporal", "none"};
  return index >= 0 && index < 3 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"blocking", blocking_name, 0, 0, BLOCKING_AUTO,
     "how a step goes through memory: temporal (once, block by block; potentials must declare "
     "gradient_range), none (one operation after the other), or auto (temporal where it is "
     "possible); the same digits; default: auto"},
    {"threads", NULL, 1, 64, 1,
     "for blocking=temporal: how many, 1 to 64; the same digits; default: 1"},
    {0},
};

/* The memory holds the gradient at the end of the last step, which is that at the start of the
 * next, and then a flag, and then the multipliers of holonomic constraints, from which those of the
 * next step are sought. */
typedef struct verlet {
  dvi__evaluator *evaluator;
  /* [2 n] a change, and forces; NULL if each coordinate moves alone, by its momentum divided by its
   * mass */
  double *change;
  dvi__division by;
  double scalar;
  double *supply;          /* [1 + symmetries] */
  dvi__blocking *blocking; /* NULL without temporal blocking */
  dvi__friction *friction; /* NULL without forces that depend on the velocity */
  dvi__rattle *rattle;     /* NULL without holonomic constraints */
} verlet;

static double *verlet_gradient_known(const dvi__stepper *self, double *memory)
{
  return memory + self->system->n;
}

static double *verlet_multipliers(const dvi__stepper *self)
{
  return self->memory + self->system->n + 1;
}

/* Their differences (rattle.h). */
static double *verlet_trend(const dvi__stepper *self)
{
  return verlet_multipliers(self) + self->system->row_count;
}

/* ---- create, destroy ---- */

static const char *verlet_obstacle(const dvi_system *system)
{
  return system->row_count > 0 ? "the system has holonomic constraints"
                               : dvi__blocking_obstacle(system);
}

static dvi_status create_blocking(dvi__stepper *self, verlet *own)
{
  const int asked = self->settings.value[BLOCKING], threads = self->settings.value[THREADS];
  const char *obstacle = asked == BLOCKING_NONE ? "blocking=none is asked for"
                                                : verlet_obstacle(self->system);
  if (obstacle == NULL) return dvi__blocking_create(self->system, threads, &own->blocking);
  if (asked == BLOCKING_TEMPORAL)
    return dvi__fail(DVI_UNSUPPORTED, "verlet: blocking=temporal is not possible: %s", obstacle);
  if (threads > 1)
    return dvi__fail(DVI_UNSUPPORTED, "verlet: threads=%d needs blocking=temporal, but %s", threads,
                     obstacle);
  return DVI_OK;
}

static dvi_status create_terms(const dvi__stepper *self, verlet *own)
{
  const dvi_system *s = self->system;
  if (s->row_count > 0 && (s->terms & DVI__FRICTION))
    return dvi__fail(DVI_UNSUPPORTED,
                     "verlet: forces that depend on the velocity are not taken beside holonomic "
                     "constraints phi(t,q) = 0; trapezoidal takes both");
  DVI_TRY(dvi__evaluator_create(s, 1, DVI__GRADIENTS, self->counters, &own->evaluator));
  if (s->row_count > 0) return dvi__rattle_create(s, own->evaluator, self->counters, &own->rattle);
  if (s->terms & DVI__FRICTION) return dvi__friction_create(s, self->counters, &own->friction);
  return DVI_OK;
}

static dvi_status allocate_numbers(const dvi_system *s, verlet *own)
{
  const int alone = s->mass_diagonal != NULL && s->force_count == 0 && s->row_count == 0;
  own->by = s->mass_scalar != 0 ? dvi__division_by(s->mass_scalar, &own->scalar) : DVI__BY_ARRAY;
  if (!alone) own->change = DVI_NEW(double, 2 * (size_t)s->n);
  own->supply = DVI_NEW(double, 1 + (size_t)s->symmetry_count);
  return own->supply != NULL && (alone || own->change != NULL)
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
}

static dvi_status verlet_create(dvi__stepper *self)
{
  verlet *own = self->own = DVI_NEW(verlet, 1);
  self->order = 2;
  self->symmetric = 1;
  self->stable = 2; /* a motion turns by theta in a step, cos(theta) = 1 - (h omega)^2/2 */
  self->memory_count = (size_t)self->system->n + 1 +
                       (1 + DVI__RATTLE_TREND) * (size_t)self->system->row_count;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  DVI_TRY(allocate_numbers(self->system, own));
  DVI_TRY(create_blocking(self, own));
  return create_terms(self, own);
}

static void verlet_destroy(dvi__stepper *self)
{
  verlet *own = self->own;
  if (own == NULL) return;
  dvi__blocking_destroy(&own->blocking);
  dvi__friction_destroy(&own->friction);
  dvi__rattle_destroy(&own->rattle);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->change);
  dvi__release(own->supply);
  dvi__release(own);
}

/* ---- without blocking ---- */

static dvi_status verlet_gradient(dvi__stepper *self, const dvi__state *state)
{
  const verlet *own = self->own;
  *verlet_gradient_known(self, self->memory) = 1;
  return dvi__potentials_gradient(own->evaluator, 1, &state->t, state->q, self->memory);
}

static void verlet_kick(const dvi__stepper *self, dvi__state *state, double h)
{
  dvi__lanes_add_scaled((size_t)self->system->n, -h, self->memory, state->p, state->p_compensation);
}

static void verlet_drift(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  dvi__mass_solve(own->evaluator, 1, state->p, own->change);
  for (int i = 0; i < self->system->n; i++) own->change[i] *= h;
  dvi__add_compensated_all(self->system->n, state->q, state->q_compensation, own->change);
  dvi__add_compensated(&state->t, &state->t_compensation, h);
}

/* Kick and drift each coordinate alone. */
static void verlet_kick_drift(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  (void)dvi__lanes_kick_drift(&(dvi__kick_drift){.count = (size_t)self->system->n,
                                                 .kicks = 1,
                                                 .kick = {-0.5 * h},
                                                 .drift = h,
                                                 .by = own->by,
                                                 .scalar = own->scalar,
                                                 .mass = self->system->mass_diagonal,
                                                 .force = self->memory,
                                                 .from = dvi__impulse_phase(state),
                                                 .to = dvi__impulse_phase(state)});
  dvi__add_compensated(&state->t, &state->t_compensation, h);
}

/* Add what the forces at one end of the straight line supply. The momentum is that of the line. */
static dvi_status verlet_supply(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  const double *v = own->change, half = 0.5 * h;
  double *F = own->change + self->system->n;
  if (state->supplied == NULL) return DVI_OK;
  if (own->friction != NULL)
    v = dvi__friction_velocity(own->friction);
  else
    dvi__mass_solve(own->evaluator, 1, state->p, own->change);
  DVI_TRY(dvi__forces(own->evaluator, DVI__FORCES, 1, &state->t, state->q, v, F));
  DVI_TRY(dvi__supply(own->evaluator, 1, &half, F, state->q, v, own->supply));
  dvi__add_compensated_all(1 + self->system->symmetry_count, state->supplied,
                           state->supplied_compensation, own->supply);
  return DVI_OK;
}

static void add_friction(const dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  dvi__lanes_add_scaled((size_t)self->system->n, h, dvi__friction_force(own->friction), state->p,
                        state->p_compensation);
}

static dvi_status verlet_begin(dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  if (own->friction != NULL) DVI_TRY(dvi__friction_solve(own->friction, state, h, self->memory));
  verlet_kick(self, state, 0.5 * h);
  if (own->friction != NULL) add_friction(self, state, 0.5 * h);
  if (own->rattle == NULL) return DVI_OK;
  return dvi__rattle_begin(own->rattle, state, h, verlet_multipliers(self), verlet_trend(self));
}

static dvi_status verlet_end(dvi__stepper *self, dvi__state *state, double h)
{
  const verlet *own = self->own;
  DVI_TRY(verlet_gradient(self, state));
  verlet_kick(self, state, 0.5 * h);
  if (own->rattle != NULL)
    return dvi__rattle_end(own->rattle, state, h, verlet_multipliers(self), verlet_trend(self));
  if (own->friction == NULL) return DVI_OK;
  DVI_TRY(dvi__friction_end(own->friction, state));
  add_friction(self, state, 0.5 * h);
  return DVI_OK;
}

/* A step with forces, constraints, or both. */
static dvi_status verlet_forced_step(dvi__stepper *self, dvi__state *state, double h)
{
  DVI_TRY(verlet_begin(self, state, h));
  DVI_TRY(verlet_supply(self, state, h));
  verlet_drift(self, state, h);
  DVI_TRY(verlet_supply(self, state, h));
  return verlet_end(self, state, h);
}

static dvi_status verlet_step(dvi__stepper *self, dvi__state *state, double h)
{
  if (*verlet_gradient_known(self, self->memory) == 0) DVI_TRY(verlet_gradient(self, state));
  if (self->system->force_count > 0 || self->system->row_count > 0)
    return verlet_forced_step(self, state, h);
  if (((const verlet *)self->own)->change == NULL) {
    verlet_kick_drift(self, state, h);
  } else {
    verlet_kick(self, state, 0.5 * h);
    verlet_drift(self, state, h);
  }
  DVI_TRY(verlet_gradient(self, state));
  verlet_kick(self, state, 0.5 * h);
  return DVI_OK;
}

/* ---- several steps at once ---- */

/* Take steps of few coordinates, or of those that temporal blocking does not take. */
static int verlet_pass_alone(dvi__stepper *self, const dvi__state *now, const double *before,
                             dvi__state *next, const double *h, int count)
{
  const verlet *own = self->own;
  const dvi__verlet_alone alone = {self->system, own->evaluator, own->by, own->scalar};
  const double *gradient = before;
  if (before[self->system->n] == 0) {
    if (verlet_gradient(self, now) != DVI_OK) return 0;
    gradient = self->memory;
  }
  *verlet_gradient_known(self, self->memory) = 1;
  return dvi__verlet_alone_steps(&alone, now, gradient, next, self->memory, h, count);
}

static int verlet_pass_blocked(dvi__stepper *self, const dvi__state *now, const double *before,
                               dvi__state *next, const double *h, int count)
{
  const verlet *own = self->own;
  double t[DVI__BLOCKING_SUBSTEPS];
  const int known = before[self->system->n] != 0;
  next->t = now->t;
  next->t_compensation = now->t_compensation;
  for (int i = 0; i < count; i++) {
    dvi__add_compensated(&next->t, &next->t_compensation, h[i]);
    t[i] = next->t;
  }
  self->counters->gradients += count + !known;
  *verlet_gradient_known(self, self->memory) = 1;
  return dvi__blocking_run(own->blocking, &(dvi__blocking_step){.count = count,
                                                                .h = h,
                                                                .t0 = now->t,
                                                                .t = t,
                                                                .from = dvi__impulse_phase(now),
                                                                .to = dvi__impulse_phase(next),
                                                                .gradient = known ? before : NULL,
                                                                .gradient_to = self->memory});
}

/* The step names a failure, and has its evaluations counted. */
static int verlet_pass(dvi__stepper *self, const dvi__state *now, const double *before,
                       dvi__state *next, const double *h, int count)
{
  const verlet *own = self->own;
  const long gradients = self->counters->gradients;
  int done = 0;
  if (own->blocking != NULL && count <= DVI__BLOCKING_SUBSTEPS)
    done = verlet_pass_blocked(self, now, before, next, h, count);
  else if (own->blocking == NULL && own->change == NULL && self->damping == NULL)
    done = verlet_pass_alone(self, now, before, next, h, count);
  if (!done) self->counters->gradients = gradients;
  return done;
}

static double verlet_traffic(const dvi__stepper *self, int count)
{
  const verlet *own = self->own;
  return own->blocking != NULL ? dvi__blocking_traffic(own->blocking, count) : 0;
}

/* ---- members side by side ---- */

/* Prepare lanes only for few coordinates. Temporal blocking has coordinates as lanes, so that
 * members as lanes gain only where the coordinates are too few to fill vectors. A user's choice of
 * temporal blocking is kept. */
enum { FEW_COORDINATES = 16 };

static dvi_status verlet_prepare_lanes(dvi__stepper *self, int capacity)
{
  const verlet *own = self->own;
  const int asked = self->settings.value[BLOCKING] == BLOCKING_TEMPORAL ||
                    self->settings.value[THREADS] > 1;
  const int pays = own->friction == NULL &&
                   (own->blocking == NULL || (!asked && self->system->n <= FEW_COORDINATES));
  return pays ? dvi__verlet_prepare_lanes(self, own->rattle, capacity) : DVI_OK;
}

static void verlet_explain(const dvi__stepper *self, dvi__text *text)
{
  const verlet *own = self->own;
  if (own->friction != NULL) {
    dvi__text_add(text,
                  "kernel: implicit in the first kick, for forces depend on the velocity; one "
                  "gradient a step, and the forces\n"
                  "solver: Newton's method for the n velocities of the first kick, with the "
                  "Jacobian M - h/2 dF/dv\n");
    return;
  }
  if (own->rattle != NULL) {
    dvi__text_add(text,
                  "kernel: explicit, but for the multipliers; one gradient a step (the last one of "
                  "a step is the first of the next)\n"
                  "solver: simplified Newton's method for the %d multipliers at the start, with "
                  "the matrix G M^-1 G^T, which is factored once a step and also gives those at "
                  "the end\n",
                  self->system->row_count);
    return;
  }
  dvi__text_add(
      text,
      "kernel: explicit; one gradient a step (the last one of a step is the first of the next)\n");
  dvi__text_add(text,
                "solver: none; no Hessian, no Jacobian, no factorisation of a step's equations\n");
  if (own->blocking != NULL)
    dvi__text_add(
        text,
        "blocking: temporal; at most %d substeps in one pass through memory; threads: %d of %d\n",
        dvi__blocking_depth(own->blocking), dvi__blocking_threads(own->blocking, 1),
        self->settings.value[THREADS]);
  else
    dvi__text_add(text, "blocking: none; %s\n",
                  self->settings.value[BLOCKING] == BLOCKING_NONE ? "it is asked for"
                                                                  : verlet_obstacle(self->system));
}

const dvi__method dvi__verlet = {
    .name = "verlet",
    .summary = "explicit leapfrog: straight line, trapezoid; order 2; constant mass",
    .cite = "MarsdenWest2001",
    .keys = keys,
    .needs = DVI__CONSTANT_MASS,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FORCES | DVI__HOLONOMIC | DVI__CONTACT |
            DVI__DAMPING,
    .create = verlet_create,
    .destroy = verlet_destroy,
    .step = verlet_step,
    .pass = verlet_pass,
    .traffic = verlet_traffic,
    .explain = verlet_explain,
    .prepare_lanes = verlet_prepare_lanes,
    .clear_lanes = dvi__verlet_clear_lanes,
    .step_lanes = dvi__verlet_step_lanes,
};
