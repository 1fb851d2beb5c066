/* Steps by fixed-point iteration one after the other, without all that other steps need. */
#include <stdlib.h>
#include <string.h>

#include "method/element/element_struct.h"
#include "num/finite.h"
#include "solve/certify.h"
#include "solve/progress.h"
#include "step/element/fixed_point.h"

/* Steps of more numbers at the nodes have their costs in their loops. */
enum { FEW_NUMBERS = 1024, LONGEST_WAIT = 4096 };

int dvi__element_shows_residuals(const dvi__element *own)
{
  return dvi__action_has_offsets(own->action) && !dvi__action_lags(own->action);
}

/* Tell whether steps by fixed-point iteration can follow one after the other. Nothing but the ends
 * of each is asked then, and each starts from the forces of the one before. */
static int element_marches(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return self->method->march != NULL && dvi__action_has_fixed_point(own->action) &&
         dvi__action_has_offsets(own->action) && !own->has_forces && !own->has_rates &&
         !own->centred && !own->keeps_whole && self->system->damping == 0 &&
         own->choice <= DVI__SOLVER_FIXED_POINT &&
         (own->choice != DVI__SOLVER_CERTIFIED || dvi__element_shows_residuals(own)) &&
         self->system->n * dvi__action_nodes(own->action) <= FEW_NUMBERS;
}

/* Let KINSOL test few numbers at once. */
enum { TOGETHER = 32, CERTIFIED_NUMBERS = 4096 };

void dvi__element_admit_march(dvi__stepper *self)
{
  dvi__element *own = self->own;
  int numbers;
  self->marches = element_marches(self);
  own->most_together = self->marches ? TOGETHER : 1;
  if (!self->marches || own->choice != DVI__SOLVER_CERTIFIED) return;
  (void)dvi__action_offsets(own->action, &numbers);
  while (own->most_together > 2 && own->most_together * numbers > CERTIFIED_NUMBERS)
    own->most_together /= 2;
}

static void march_keep(int n, const dvi__state *state, dvi__state *last)
{
  last->t = state->t;
  last->t_compensation = state->t_compensation;
  memcpy(last->q, state->q, 2 * (size_t)n * sizeof(double));
}

/* Solve step number i of a march. Returns 0 if the iteration does not converge. */
static int march_solve(dvi__stepper *self, const dvi__state *state, double h, int i,
                       dvi__element_steps *steps)
{
  const dvi__element *own = self->own;
  dvi_counters *counters = self->counters;
  dvi__lanes_solving *solving = &steps->solving;
  const int certified = own->choice == DVI__SOLVER_CERTIFIED;
  if (state->t + h == state->t) return 0;
  solving->size = dvi__largest((size_t)self->system->n, state->q);
  if (certified) solving->before = dvi__certify_point(own->solver, i);
  const long iterations = dvi__action_solve_step(steps, state->t, h / self->memory[DVI__LAST_H],
                                                 self->memory + dvi__element_forces(self));
  counters->residuals += labs(iterations);
  if (solving->evaluate != NULL) counters->gradients += labs(iterations) * steps->ends.stages;
  if (iterations <= 0) return 0;
  if (!own->late_paths) dvi__action_fixed_point_path(own->action, own->Y);
  return !certified || dvi__certify_note(own->solver, i, solving->iteration->Z, steps->largest,
                                         solving->size) == DVI_OK;
}

/* Certify the steps of a march. After a failure, of which roundings may be the reason, each step is
 * certified alone for a while. */
static int march_certify(dvi__element *own, int taken)
{
  if (own->choice != DVI__SOLVER_CERTIFIED || taken == 0) return taken;
  const int certified = dvi__certify_noted(own->solver, taken);
  own->wait = certified                      ? 0
              : own->wait == 0               ? 1
              : 2 * own->wait < LONGEST_WAIT ? 2 * own->wait
                                             : LONGEST_WAIT;
  own->uncertified = own->wait;
  return certified ? taken : 0;
}

/* Tell whether the next step is by fixed-point iteration from the last step's forces, and in a
 * march. Single steps prepare what certifies them. */
static int march_is_due(dvi__stepper *self)
{
  dvi__element *own = self->own;
  if (self->memory[DVI__LAST_H] == 0 || self->memory[DVI__NEWTON_STEPS] != 0) return 0;
  if (own->choice == DVI__SOLVER_CERTIFIED &&
      !dvi__certify_is_prepared(own->solver, own->most_together))
    return 0;
  if (own->uncertified == 0) return 1;
  own->uncertified--;
  return 0;
}

int dvi__element_march(dvi__stepper *self, dvi__state *state, dvi__state *last, double h, int count)
{
  dvi__element *own = self->own;
  const int n = self->system->n, most = count < own->most_together ? count : own->most_together,
            patient = own->choice == DVI__SOLVER_FIXED_POINT || own->without_hessian != NULL;
  const dvi__criteria criteria = dvi__fixed_point_criteria(patient, 1);
  dvi__element_steps steps;
  int taken = 0;
  if (!march_is_due(self)) return 0;
  dvi__action_begin_steps(own->action, h, state->q, state->p, own->dq, own->dq_low, own->dp,
                          &steps);
  steps.solving.criteria = &criteria;
  steps.solving.most = dvi__fixed_point_most(patient);
  own->duration = h;
  own->rung = DVI__FIXED_POINT;
  for (; taken < most && march_solve(self, state, h, taken, &steps); taken++) {
    if (taken > 0) {
      march_keep(n, state, last);
      dvi__trail_put(self->trail, state);
    }
    dvi__element_advance(self, state, h);
    if (dvi__first_not_finite(2 * (size_t)n, state->q) >= 0) return 0;
  }
  taken = march_certify(own, taken);
  self->memory[DVI__NEWTON_WAIT] = 0;
  self->counters->fixed_points += taken;
  return taken;
}
