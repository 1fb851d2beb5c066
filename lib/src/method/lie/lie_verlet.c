/* Velocity Verlet on Lie groups and spheres.
 *
 * The space is the chord from y0 to y1 in the coordinates y that contain the group. The quadrature
 * is the trapezoid.
 *     Ld(q0,q1) = (y1-y0).M(y1-y0)/(2h) - h/2 (V(y0) + V(y1)),
 *     on SO(3):  tr((I - F) Jd)/h - h/2 (V(R0) + V(R1)),  F = R0^T R1
 * The momenta are p0 = -D1 Ld and p1 = D2 Ld, with all forces and momenta projected on the tangent
 * spaces.
 *     p_half = p0 - h/2 dV(q0),
 *     F Jd - Jd F^T = (h p_half)^ gives q1 and rotates p_half,
 *     p1 = p_half - h/2 dV(q1).
 *
 * Forces F(t,q) join -dV in both kicks, and holonomic constraints add their forces (lie_rattle.h).
 *
 * The equation for q1 does not contain the potential (step/lie/lie_drift.h), so that a step has one
 * gradient and is explicit in the forces. The order is 2. The method is symmetric and symplectic,
 * and conserves momenta of symmetries to roundoff. A free body keeps its energy, too (Hairer and
 * Vilmart 2006). Source: Moser and Veselov 1991; Leok and Shingel 2012, sec. 2.3. */
#include <string.h>

#include "step/lie/lie_drift_members.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/lie/lie_rattle.h"
#include "method/method.h"
#include "num/compensated.h"

enum { SOLVE };

static const char *lie_verlet_solve_name(int index)
{
  static const char *const name[] = {"exp", "cayley"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"solve", lie_verlet_solve_name, 0, 0, DVI__BY_CAYLEY,
     "how the relative rotation of a body is parametrised in Newton's method: exp or cayley; the "
     "same rotation; default: cayley"},
    {0},
};

/* The memory holds the gradient at the end of the last step, which is that at the start of the
 * next, then a flag, then the displacement of each slot in the step, then the forces F(t,q) beside
 * the gradient, and the multipliers of constraints. */
typedef struct lie_verlet {
  dvi__evaluator *evaluator;
  dvi__lie_drift *drift;
  dvi__lie_rattle *rattle; /* NULL without holonomic constraints */
  dvi__evaluator *states;  /* for what forces supply, NULL without forces */
  double *v, *supply;      /* [nv], [1 + symmetries] */
} lie_verlet;

static double *lie_verlet_gradient_known(const dvi__stepper *self)
{
  return self->memory + self->system->n;
}

/* Where the displacement and the forces begin in the memory. */
static size_t displacement_at(const dvi__stepper *self)
{
  return (size_t)self->system->n + 1;
}

static size_t forces_at(const dvi__stepper *self)
{
  return displacement_at(self) + (size_t)self->system->nv;
}

static double *displacement_of(const dvi__stepper *self)
{
  return self->memory + displacement_at(self);
}

static double *lie_verlet_forces(const dvi__stepper *self)
{
  return self->memory + forces_at(self);
}

static double *lie_verlet_multipliers(const dvi__stepper *self)
{
  return lie_verlet_forces(self) + self->system->nv;
}

static dvi_status create_terms(const dvi__stepper *self, lie_verlet *own)
{
  const dvi_system *s = self->system;
  const size_t nv = (size_t)s->nv;
  if (s->row_count > 0)
    DVI_TRY(dvi__lie_rattle_create(s, own->drift, self->counters, &own->rattle));
  if (s->force_count == 0) return DVI_OK;
  own->v = DVI_NEW(double, nv + 1 + (size_t)s->symmetry_count);
  if (own->v == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory");
  own->supply = own->v + nv;
  return dvi__evaluator_create(s, 1, DVI__STATES, self->counters, &own->states);
}

static dvi_status lie_verlet_create(dvi__stepper *self)
{
  lie_verlet *own = self->own = DVI_NEW(lie_verlet, 1);
  self->order = 2;
  self->symmetric = 1;
  self->memory_count = (size_t)self->system->n + 1 + 2 * (size_t)self->system->nv +
                       (size_t)self->system->row_count;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory");
  DVI_TRY(dvi__lie_drift_create(self->system, (dvi__moser_veselov_map)self->settings.value[SOLVE],
                                self->counters, &own->drift));
  DVI_TRY(dvi__evaluator_create(self->system, 1, DVI__GRADIENTS, self->counters, &own->evaluator));
  return create_terms(self, own);
}

static void lie_verlet_destroy(dvi__stepper *self)
{
  lie_verlet *own = self->own;
  if (own == NULL) return;
  dvi__lie_rattle_destroy(&own->rattle);
  dvi__lie_drift_destroy(&own->drift);
  dvi__evaluator_destroy(&own->states);
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own->v);
  dvi__release(own);
}

static dvi_status lie_verlet_gradient(const dvi__stepper *self, const dvi__state *state)
{
  const lie_verlet *own = self->own;
  const dvi_system *s = self->system;
  if (s->force_count > 0)
    DVI_TRY(dvi__forces(own->evaluator, DVI__FORCE, 1, &state->t, state->q, NULL,
                        lie_verlet_forces(self)));
  if (s->potential_count > 0)
    DVI_TRY(dvi__potentials_gradient(own->evaluator, 1, &state->t, state->q, self->memory));
  if (s->force_count + s->potential_count > 0) *lie_verlet_gradient_known(self) = 1;
  return DVI_OK;
}

static void lie_verlet_kick(const dvi__stepper *self, const dvi__phase *phase, double h)
{
  const lie_verlet *own = self->own;
  if (self->system->potential_count > 0) dvi__lie_drift_kick(own->drift, h, self->memory, phase);
  if (self->system->force_count > 0)
    dvi__lie_drift_push(own->drift, h, lie_verlet_forces(self), phase);
}

/* Add what the forces at one end of the path supply, with the velocity of its momentum there. */
static dvi_status lie_verlet_supply(const dvi__stepper *self, dvi__state *state, double h)
{
  const lie_verlet *own = self->own;
  const double half = 0.5 * h;
  if (state->supplied == NULL || own->states == NULL) return DVI_OK;
  DVI_TRY(dvi__legendre_inverse(own->states, state->t, state->q, state->p, own->v));
  DVI_TRY(
      dvi__supply(own->states, 1, &half, lie_verlet_forces(self), state->q, own->v, own->supply));
  dvi__add_compensated_all(1 + self->system->symmetry_count, state->supplied,
                           state->supplied_compensation, own->supply);
  return DVI_OK;
}

static dvi_status lie_verlet_drift(const dvi__stepper *self, const dvi__state *state,
                                   const dvi__phase *phase, double h)
{
  const lie_verlet *own = self->own;
  if (own->rattle != NULL)
    return dvi__lie_rattle_drift(own->rattle, state->t, h, phase, lie_verlet_multipliers(self),
                                 displacement_of(self));
  return dvi__lie_drift_drift(own->drift, h, phase, displacement_of(self));
}

static dvi_status lie_verlet_step(dvi__stepper *self, dvi__state *state, double h)
{
  const lie_verlet *own = self->own;
  const dvi__phase phase = {.q = state->q,
                            .p = state->p,
                            .q_compensation = state->q_compensation,
                            .p_compensation = state->p_compensation};
  if (state->side > 1)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "lie-verlet takes independent constraints, and some depend on the others here; "
        "lie-galerkin takes them");
  if (*lie_verlet_gradient_known(self) == 0) DVI_TRY(lie_verlet_gradient(self, state));
  lie_verlet_kick(self, &phase, 0.5 * h);
  DVI_TRY(lie_verlet_supply(self, state, h));
  DVI_TRY(lie_verlet_drift(self, state, &phase, h));
  dvi__add_compensated(&state->t, &state->t_compensation, h);
  DVI_TRY(lie_verlet_gradient(self, state));
  DVI_TRY(lie_verlet_supply(self, state, h));
  lie_verlet_kick(self, &phase, 0.5 * h);
  return own->rattle != NULL ? dvi__lie_rattle_end(own->rattle, state->t, &phase) : DVI_OK;
}

/* ---- members of an ensemble side by side ---- */

/* The evaluator has counters of its own. dvi__members counts the evaluations of each member. */
typedef struct lie_verlet_lanes {
  dvi__evaluator *evaluator;
  double *work; /* [DVI__LIE_DRIFT_WORK*capacity] */
} lie_verlet_lanes;

static dvi_status lie_verlet_prepare_lanes(dvi__stepper *self, int capacity)
{
  const lie_verlet *own = self->own;
  const dvi_system *s = self->system;
  if (own->rattle != NULL || !dvi__lie_drift_has_members(own->drift) ||
      !dvi__system_has_gradients(s))
    return DVI_OK;
  lie_verlet_lanes *lanes = self->lanes = DVI_NEW(lie_verlet_lanes, 1);
  if (lanes == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory");
  lanes->work = DVI_NEW(double, DVI__LIE_DRIFT_WORK *(size_t)capacity);
  if (lanes->work == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory");
  return dvi__evaluator_create(s, capacity, DVI__GRADIENTS, NULL, &lanes->evaluator);
}

static void lie_verlet_clear_lanes(dvi__stepper *self)
{
  lie_verlet_lanes *lanes = self->lanes;
  dvi__evaluator_destroy(&lanes->evaluator);
  dvi__release(lanes->work);
  dvi__release(lanes);
}

static double *members_forces(const dvi__stepper *self, const dvi__members *m)
{
  return m->memory + forces_at(self) * (size_t)m->count;
}

static dvi_status lie_verlet_gradients(const dvi__stepper *self, const dvi__members *m)
{
  dvi__evaluator *evaluator = ((const lie_verlet_lanes *)self->lanes)->evaluator;
  if (self->system->force_count > 0)
    DVI_TRY(
        dvi__forces(evaluator, DVI__FORCE, m->count, m->t, m->q, NULL, members_forces(self, m)));
  return self->system->potential_count > 0
             ? dvi__potentials_gradient(evaluator, m->count, m->t, m->q, m->memory)
             : DVI_OK;
}

/* Evaluate the gradients at the start of a step if a member's is not known. Those that are known
 * stay as they are. */
static dvi_status lie_verlet_first_gradients(const dvi__stepper *self, dvi__members *m)
{
  const int gradients = (self->system->potential_count > 0) + (self->system->force_count > 0);
  double *known = m->memory + (size_t)self->system->n * (size_t)m->count;
  int wanted = 0;
  for (int k = 0; k < m->count && gradients > 0; k++) {
    wanted |= known[k] == 0;
    m->gradients[k] += known[k] == 0 ? 2 * gradients : gradients;
    known[k] = 1;
  }
  return wanted ? lie_verlet_gradients(self, m) : DVI_OK;
}

static void lie_verlet_kick_members(const dvi__stepper *self, const dvi__members *m,
                                    const dvi__phase *phase, double h)
{
  const lie_verlet *own = self->own;
  if (self->system->potential_count > 0)
    dvi__lie_drift_kick_members(own->drift, m->count, h, m->memory, phase);
  if (self->system->force_count > 0)
    dvi__lie_drift_push_members(own->drift, m->count, h, members_forces(self, m), phase);
}

/* Take the step of all members, or leave them all. When each steps alone, the member for which a
 * callback failed shows. */
static void lie_verlet_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  const lie_verlet *own = self->own;
  const lie_verlet_lanes *lanes = self->lanes;
  const size_t count = (size_t)m->count;
  const dvi__phase phase = {.q = m->q,
                            .p = m->p,
                            .q_compensation = m->q_compensation,
                            .p_compensation = m->p_compensation};
  if (lie_verlet_first_gradients(self, m) != DVI_OK) {
    memset(m->left, 1, count);
    return;
  }
  lie_verlet_kick_members(self, m, &phase, 0.5 * h);
  dvi__lie_drift_drift_members(own->drift, m->count, h, &phase,
                               m->memory + displacement_at(self) * count, lanes->work, m->left);
  for (size_t k = 0; k < count; k++) dvi__add_compensated(m->t + k, m->t_compensation + k, h);
  if (lie_verlet_gradients(self, m) != DVI_OK)
    memset(m->left, 1, count);
  else
    lie_verlet_kick_members(self, m, &phase, 0.5 * h);
}

static void lie_verlet_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v)
{
  const lie_verlet *own = self->own;
  dvi__lie_drift_path(own->drift, q0, displacement_of(self), h, tau, q, v);
}

static void lie_verlet_explain(const dvi__stepper *self, dvi__text *text)
{
  const lie_verlet *own = self->own;
  int alone, coupled;
  dvi__lie_drift_count(own->drift, &alone, &coupled);
  dvi__text_add(text, "kernel: explicit in the forces; one gradient a step (the last one of a step "
                      "is the first of the next)\n");
  dvi__text_add(text,
                "solver: slots by themselves: %d (lines, directions and angles in closed form, "
                "bodies by Newton's method, %s)\n",
                alone, lie_verlet_solve_name(self->settings.value[SOLVE]));
  dvi__text_add(text, "solver: slots coupled by the mass, in one Newton iteration: %d\n", coupled);
  if (own->rattle != NULL)
    dvi__text_add(text,
                  "solver: simplified Newton's method for the %d multipliers at the start, each "
                  "iteration a drift, with a matrix that is factored once a step\n",
                  self->system->row_count);
}

const dvi__method dvi__lie_verlet = {
    .name = "lie-verlet",
    .summary = "Verlet on rotations, rigid motions, directions, angles and products; one gradient "
               "a step; order 2; constant mass",
    .cite = "LeokShingel2012",
    .keys = keys,
    .needs = DVI__FACTORS,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FACTORS | DVI__FORCE | DVI__HOLONOMIC |
            DVI__DAMPING,
    .create = lie_verlet_create,
    .destroy = lie_verlet_destroy,
    .step = lie_verlet_step,
    .path = lie_verlet_path,
    .explain = lie_verlet_explain,
    .prepare_lanes = lie_verlet_prepare_lanes,
    .clear_lanes = lie_verlet_clear_lanes,
    .step_lanes = lie_verlet_step_lanes,
};
