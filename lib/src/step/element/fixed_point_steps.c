/* Steps by fixed-point iteration, one after the other. */
#include "step/element/fixed_point.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "core/status.h"
#include "system/evaluate/untested.h"

void dvi__action_begin_steps(dvi__action *a, double h, const double *q0, const double *p0,
                             double *dq, double *dq_low, double *dp, dvi__element_steps *steps)
{
  *steps = (dvi__element_steps){.action = a};
  dvi__lanes_solving *solving = &steps->solving;
  dvi__action_place(a, a->t0, h, q0, p0);
  dvi__action_set_step(a);
  solving->iteration = dvi__action_place_iteration(a);
  solving->t = a->t;
  if (a->preconditioner == NULL && a->fixed_point.stages == a->r)
    solving->evaluate = dvi__lone_gradient(a->evaluator, &solving->of);
  steps->ends = (dvi__ends){.n = a->n,
                            .stages = a->r,
                            .g = a->L_q,
                            .slant = a->fixed_point.slant,
                            .factor = a->fixed_point.factor,
                            .p0 = p0,
                            .moved = dq,
                            .low = dq_low,
                            .sum = dp};
  a->iterated = 1;
}

/* Iterate one by one, as dvi__lanes_solve does at once. */
static int solve_one_by_one(dvi__element_steps *steps)
{
  const dvi__lanes_solving *solving = &steps->solving;
  dvi__action *a = steps->action;
  dvi__history history = {0};
  double change;
  int count;
  const double *Z = dvi__action_offsets(a, &count);
  for (int i = 1; i <= solving->most; i++) {
    if (solving->before != NULL) memcpy(solving->before, Z, (size_t)count * sizeof *Z);
    if (dvi__action_iterate(a, &change, &steps->largest) != DVI_OK) return -i;
    const dvi__progress progress = dvi__settling_test(change, &history, solving->criteria,
                                                      steps->largest, solving->size);
    if (progress != DVI__GO_ON) return progress == DVI__CONVERGED ? i : -i;
  }
  return -solving->most;
}

static int solve_another_step(dvi__element_steps *steps, double ratio, double *g)
{
  dvi__action *a = steps->action;
  dvi__action_fixed_point_continue(a, ratio, g);
  const int iterations = solve_one_by_one(steps);
  if (iterations <= 0) return iterations;
  dvi__action_fixed_point_ends(a, steps->ends.moved, steps->ends.low, steps->ends.sum);
  dvi__action_forces(a, g);
  return iterations;
}

int dvi__action_solve_step(dvi__element_steps *steps, double t, double ratio, double *g)
{
  dvi__action *a = steps->action;
  const double *shift = steps->shift;
  a->t0 = t;
  for (int j = 0; j < a->r; j++) a->t[j] = t + a->node[j] * a->h;
  if (steps->solving.evaluate == NULL) return solve_another_step(steps, ratio, g);
  if (ratio != 1 || shift == NULL) shift = dvi__action_fixed_point_shift(a, ratio);
  if (ratio == 1) steps->shift = shift;
  dvi__lanes_begin_from(steps->solving.iteration, shift, g);
  const int iterations = dvi__lanes_solve(&steps->solving);
  if (iterations <= 0) return iterations;
  steps->largest = steps->solving.iteration->largest;
  dvi__lanes_ends(&steps->ends);
  memcpy(g, a->L_q, (size_t)a->n * (size_t)a->r * sizeof *g);
  return iterations;
}
