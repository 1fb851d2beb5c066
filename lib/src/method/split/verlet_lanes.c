/* Stoermer-Verlet for many members at once, with the operations of verlet.c and one batch of
 * gradients a step. */
#include "method/split/verlet_lanes.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/simd/lanes.h"

/* The evaluator has counters of its own. dvi__members counts the evaluations of each member. */
typedef struct lanes {
  dvi__evaluator *evaluator;
  dvi__division *by;           /* [n] divides each coordinate's momentum by its mass */
  double *scalar;              /* [n] */
  dvi__rattle_members *rattle; /* NULL without holonomic constraints */
  double *change;              /* [n*capacity] beside it */
} lanes;

static dvi_status prepare_rattle(const dvi__stepper *self, const dvi__rattle_matrix *matrix,
                                 int capacity, lanes *own)
{
  own->change = DVI_NEW(double, (size_t)self->system->n *(size_t)capacity);
  if (own->change == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  return dvi__rattle_members_create(self->system, matrix, capacity, self->counters, &own->rattle);
}

dvi_status dvi__verlet_prepare_lanes(dvi__stepper *self, const dvi__rattle *rattle, int capacity)
{
  const double *mass = self->system->mass_diagonal;
  const int n = self->system->n;
  dvi__rattle_matrix matrix;
  if (mass == NULL || !dvi__system_has_gradients(self->system)) return DVI_OK;
  if (rattle != NULL &&
      !(dvi__rattle_has_matrix(rattle, &matrix) && dvi__rattle_members_pay(self->system)))
    return DVI_OK;
  lanes *own = self->lanes = DVI_NEW(lanes, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  own->by = DVI_NEW(dvi__division, n);
  own->scalar = DVI_NEW(double, n);
  if (own->by == NULL || own->scalar == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  for (int i = 0; i < n; i++) own->by[i] = dvi__division_by(mass[i], &own->scalar[i]);
  if (rattle != NULL) DVI_TRY(prepare_rattle(self, &matrix, capacity, own));
  return dvi__evaluator_create(self->system, capacity, DVI__GRADIENTS, NULL, &own->evaluator);
}

void dvi__verlet_clear_lanes(dvi__stepper *self)
{
  lanes *own = self->lanes;
  dvi__evaluator_destroy(&own->evaluator);
  dvi__rattle_members_destroy(&own->rattle);
  dvi__release(own->by);
  dvi__release(own->scalar);
  dvi__release(own->change);
  dvi__release(own);
}

static void leave_all(dvi__members *m)
{
  memset(m->left, 1, (size_t)m->count);
}

static dvi_status verlet_lanes_gradient(const dvi__stepper *self, dvi__members *m)
{
  const lanes *own = self->lanes;
  for (int k = 0; k < m->count; k++) m->gradients[k]++;
  return dvi__potentials_gradient(own->evaluator, m->count, m->t, m->q, m->memory);
}

/* Kick as verlet_kick. */
static void verlet_lanes_kick(const dvi__stepper *self, dvi__members *m, double h)
{
  dvi__lanes_add_scaled((size_t)self->system->n * (size_t)m->count, -h, m->memory, m->p,
                        m->p_compensation);
}

static double *verlet_lanes_gradient_known(const dvi__stepper *self, const dvi__members *m)
{
  return m->memory + (size_t)self->system->n * (size_t)m->count;
}

/* Return 1 if the gradients of all members are known, 0 if none is, and -1 if some are. */
static int verlet_lanes_all_known(const dvi__stepper *self, const dvi__members *m)
{
  const double *known = verlet_lanes_gradient_known(self, m);
  int members = 0;
  for (int k = 0; k < m->count; k++) members += known[k] != 0;
  return members == m->count ? 1 : members == 0 ? 0 : -1;
}

/* Take the first kick and the drift, one coordinate at a time. */
static void verlet_lanes_kick_drift(const dvi__stepper *self, dvi__members *m, double h)
{
  const lanes *own = self->lanes;
  const size_t count = (size_t)m->count;
  for (size_t i = 0; i < (size_t)self->system->n; i++) {
    const size_t at = i * count;
    const dvi__phase row = {.q = m->q + at,
                            .p = m->p + at,
                            .q_compensation = m->q_compensation + at,
                            .p_compensation = m->p_compensation + at};
    (void)dvi__lanes_kick_drift(&(dvi__kick_drift){.count = count,
                                                   .kicks = 1,
                                                   .kick = {-0.5 * h},
                                                   .drift = h,
                                                   .by = own->by[i],
                                                   .scalar = own->scalar[i],
                                                   .force = m->memory + at,
                                                   .from = row,
                                                   .to = row});
  }
  for (size_t k = 0; k < count; k++) dvi__add_compensated(m->t + k, m->t_compensation + k, h);
}

/* ---- constraints ---- */

static dvi__rattle_lanes constrained_lanes(const dvi__stepper *self, const dvi__members *m)
{
  const size_t count = (size_t)m->count, n = (size_t)self->system->n;
  double *lambda = m->memory + (n + 1) * count;
  return (dvi__rattle_lanes){.count = m->count,
                             .t = m->t,
                             .q = m->q,
                             .q_compensation = m->q_compensation,
                             .p = m->p,
                             .p_compensation = m->p_compensation,
                             .lambda = lambda,
                             .trend = lambda + (size_t)self->system->row_count * count,
                             .left = m->left,
                             .residuals = m->residuals,
                             .gradients = m->gradients};
}

/* Take the first kick, with the forces of constraints, and the drift. */
static void verlet_lanes_begin_on_rows(const dvi__stepper *self, dvi__members *m, double h)
{
  const lanes *own = self->lanes;
  const size_t count = (size_t)m->count, n = (size_t)self->system->n;
  const dvi__rattle_lanes constrained = constrained_lanes(self, m);
  verlet_lanes_kick(self, m, 0.5 * h);
  dvi__rattle_members_begin(own->rattle, &constrained, h);
  dvi__mass_solve(own->evaluator, m->count, m->p, own->change);
  dvi__lanes_add_scaled(n * count, h, own->change, m->q, m->q_compensation);
  for (size_t k = 0; k < count; k++) dvi__add_compensated(m->t + k, m->t_compensation + k, h);
}

/* ---- steps ---- */

static void verlet_lanes_begin(const dvi__stepper *self, dvi__members *m, double h)
{
  if (((const lanes *)self->lanes)->rattle != NULL)
    verlet_lanes_begin_on_rows(self, m, h);
  else
    verlet_lanes_kick_drift(self, m, h);
}

static void verlet_lanes_end(const dvi__stepper *self, dvi__members *m, double h)
{
  const lanes *own = self->lanes;
  verlet_lanes_kick(self, m, 0.5 * h);
  if (own->rattle == NULL) return;
  const dvi__rattle_lanes constrained = constrained_lanes(self, m);
  dvi__rattle_members_end(own->rattle, &constrained, h);
}

/* Take one batch for all members, or leave them all. When each steps alone, the member for which a
 * callback failed shows. */
void dvi__verlet_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  const size_t count = (size_t)m->count;
  const int known = verlet_lanes_all_known(self, m);
  if (known < 0 || (known == 0 && verlet_lanes_gradient(self, m) != DVI_OK)) {
    leave_all(m);
    return;
  }
  for (size_t k = 0; k < count && known == 0; k++) verlet_lanes_gradient_known(self, m)[k] = 1;
  verlet_lanes_begin(self, m, h);
  if (verlet_lanes_gradient(self, m) != DVI_OK)
    leave_all(m);
  else
    verlet_lanes_end(self, m, h);
}
