/* Steps by fixed-point iteration one after the other, without all that other steps need. */
#include <stdlib.h>
#include <string.h>

#include "method/element/element_struct.h"
#include "num/finite.h"
#include "solve/progress.h"
#include "step/element/fixed_point.h"

/* Steps of more numbers at the nodes have their costs in their loops. */
enum { FEW_NUMBERS = 1024 };

int dvi__element_marches(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return self->method->march != NULL && own->late_paths && !own->centred && !own->keeps_whole &&
         self->system->damping == 0 &&
         (own->choice == DVI__SOLVER_AUTO || own->choice == DVI__SOLVER_FIXED_POINT) &&
         self->system->n * dvi__action_nodes(own->action) <= FEW_NUMBERS &&
         dvi__action_has_plain_steps(own->action);
}

static void march_keep(int n, const dvi__state *state, dvi__state *last)
{
  last->t = state->t;
  last->t_compensation = state->t_compensation;
  memcpy(last->q, state->q, 2 * (size_t)n * sizeof(double));
}

/* Solve one step. Returns 0 if the iteration does not converge. */
static int march_solve(dvi__stepper *self, const dvi__state *state, double h,
                       dvi__plain_steps *steps)
{
  dvi_counters *counters = self->counters;
  const double ratio = h / self->memory[DVI__LAST_H];
  if (state->t + h == state->t) return 0;
  steps->solving.size = dvi__largest((size_t)self->system->n, state->q);
  const long iterations = dvi__action_solve_step(steps, state->t, ratio,
                                                 self->memory + dvi__element_forces(self));
  counters->residuals += labs(iterations);
  counters->gradients += labs(iterations) * steps->ends.stages;
  return iterations > 0;
}

int dvi__element_march(dvi__stepper *self, dvi__state *state, dvi__state *last, double h, int count)
{
  dvi__element *own = self->own;
  const int n = self->system->n,
            patient = own->choice == DVI__SOLVER_FIXED_POINT || own->without_hessian != NULL;
  const dvi__criteria criteria = dvi__fixed_point_criteria(patient, 1);
  dvi__plain_steps steps;
  int taken = 0;
  if (self->memory[DVI__LAST_H] == 0 || self->memory[DVI__NEWTON_STEPS] != 0) return 0;
  dvi__action_begin_steps(own->action, h, state->q, state->p, own->dq, own->dq_low, own->dp,
                          &steps);
  steps.solving.criteria = &criteria;
  steps.solving.most = dvi__fixed_point_most(patient);
  own->duration = h;
  own->rung = DVI__FIXED_POINT;
  for (; taken < count && march_solve(self, state, h, &steps); taken++) {
    if (taken > 0) march_keep(n, state, last);
    (void)dvi__element_advance(self, state, h);
    if (dvi__first_not_finite(2 * (size_t)n, state->q) >= 0) return 0;
  }
  self->memory[DVI__NEWTON_WAIT] = 0;
  self->counters->fixed_points += taken;
  return taken;
}
