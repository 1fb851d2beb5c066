/* Stoermer-Verlet for many members at once: the operations of verlet.c, one batch of gradients a step. */
#include "method/verlet_lanes.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/members.h"

/* The evaluator counts for itself: what a member took is counted in dvi__members. */
typedef struct lanes {
  dvi__evaluator *evaluator;
} lanes;

dvi_status dvi__verlet_prepare_lanes(dvi__stepper *self, int capacity)
{
  if (self->system->mass_diagonal == NULL || !dvi__system_has_gradients(self->system)) return DVI_OK;
  lanes *own = self->lanes = DVI_NEW(lanes, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  return dvi__evaluator_create(self->system, capacity, DVI__GRADIENTS, NULL, &own->evaluator);
}

void dvi__verlet_clear_lanes(dvi__stepper *self)
{
  lanes *own = self->lanes;
  dvi__evaluator_destroy(&own->evaluator);
  dvi__release(own);
}

static void leave_all(dvi__members *m)
{
  memset(m->left, 1, (size_t)m->count);
}

static dvi_status forces(const dvi__stepper *self, dvi__members *m)
{
  const lanes *own = self->lanes;
  for (int k = 0; k < m->count; k++) m->gradients[k]++;
  return dvi__lagrangian_gradient(own->evaluator, m->count, m->t, m->q, NULL, m->memory + (size_t)DVI__FORCES * (size_t)m->count,
                                  NULL);
}

/* 1: all of them, 0: none, -1: some. */
static int forces_known(const dvi__members *m)
{
  const double *known = m->memory + (size_t)DVI__FORCES_KNOWN * (size_t)m->count;
  int members = 0;
  for (int k = 0; k < m->count; k++) members += known[k] != 0;
  return members == m->count ? 1 : members == 0 ? 0 : -1;
}

static void kick(const dvi__stepper *self, dvi__members *m, double h)
{
  const size_t count = (size_t)m->count;
  dvi__members_add((size_t)self->system->n * count, h, m->memory + DVI__FORCES * count, m->p, m->p_carry);
}

static void drift(const dvi__stepper *self, dvi__members *m, double h)
{
  const size_t count = (size_t)m->count;
  for (size_t i = 0; i < (size_t)self->system->n; i++)
    dvi__members_drift(count, h, self->system->mass_diagonal[i], m->p + i * count, m->q + i * count, m->q_carry + i * count);
  for (size_t k = 0; k < count; k++) dvi__add_compensated(m->t + k, m->t_carry + k, h);
}

/* One batch serves all or none: which member a callback failed for shows when each goes on alone. */
void dvi__verlet_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  const int known = forces_known(m);
  if (known < 0 || (known == 0 && forces(self, m) != DVI_OK)) {
    leave_all(m);
    return;
  }
  for (int k = 0; k < m->count && known == 0; k++) m->memory[DVI__FORCES_KNOWN * m->count + k] = 1;
  kick(self, m, 0.5 * h);
  drift(self, m, h);
  if (forces(self, m) != DVI_OK)
    leave_all(m);
  else
    kick(self, m, 0.5 * h);
}
