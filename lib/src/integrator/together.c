/* Steps that are taken together, with nothing between them, with the bits of single steps. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "integrator/hits.h"
#include "integrator/integrator_struct.h"
#include "system/evaluate/dynamics.h"

/* Nothing but the method may have a part in these steps. */
static int can_step_together(const dvi_integrator *I, double h)
{
  return I->monitored == NULL && I->balances == 0 && I->system->dynamics->constraint == NULL &&
         !dvi__hits_divide(I) && !dvi_integrator_chooses_steps(I) &&
         dvi__check_step(I->now.t, h) == DVI_OK &&
         dvi__stepper_check_step(&I->stepper, h) == DVI_OK;
}

/* Take steps in one pass. They count as one last step. */
static int steps_in_a_pass(dvi_integrator *I, double h, int steps)
{
  double length[DVI__TOGETHER];
  for (int i = 0; i < steps; i++) length[i] = h;
  dvi__exchange_memory(I);
  I->next.density = I->now.density;
  I->next.side = I->now.side;
  if (I->stepper.method->pass(&I->stepper, &I->now, I->memory_before, &I->next, length, steps) &&
      isfinite(I->next.t) && I->next.t + h != I->next.t) {
    dvi__integrator_accept(I, h * steps);
    I->counters.steps += steps - 1;
    return steps;
  }
  dvi__exchange_memory(I);
  return 0;
}

/* Take steps by passes. Where one pass of several steps does not save ways through memory, each has
 * its own, so that the last step is one step. */
static int steps_in_passes(dvi_integrator *I, double h, int steps)
{
  const dvi__method *method = I->stepper.method;
  int taken = 0;
  if (I->stepper.trail == NULL && method->traffic != NULL &&
      method->traffic(&I->stepper, steps) > 0)
    return steps_in_a_pass(I, h, steps);
  for (; taken < steps && steps_in_a_pass(I, h, 1); taken++)
    dvi__trail_put(I->stepper.trail, &I->now);
  return taken;
}

/* Take steps one after the other. If they are more than one, `last` has been overwritten, also
 * where none of them is accepted. There is no last step then. */
static int steps_in_a_march(dvi_integrator *I, double h, int steps)
{
  const double start = I->last.t;
  dvi__exchange_memory(I);
  dvi__state_copy(I, &I->now, &I->next);
  memcpy(I->stepper.memory, I->memory_before, I->stepper.memory_count * sizeof(double));
  const int taken = I->stepper.method->march(&I->stepper, &I->next, &I->last, h, steps);
  if (taken == 0) {
    if (I->last.t != start) I->last_h = 0;
    dvi__exchange_memory(I);
    return 0;
  }
  const dvi__state before = I->last;
  dvi__integrator_accept(I, h);
  if (taken == 1) return 1;
  I->counters.steps += taken - 1;
  I->next = I->last;
  I->last = before;
  I->last.q_compensation = I->next.q_compensation;
  I->last.p_compensation = I->next.p_compensation;
  I->last_h_before = h;
  return taken;
}

/* March, and put the states into the trail of the stepper. What is not accepted leaves none. */
static int march_with_trail(dvi_integrator *I, double h, int steps)
{
  dvi__trail *trail = I->stepper.trail;
  const dvi__trail before = trail != NULL ? *trail : (dvi__trail){0};
  const int taken = steps_in_a_march(I, h, steps);
  if (taken > 0) dvi__trail_put(trail, &I->now);
  if (taken == 0 && trail != NULL) *trail = before;
  return taken;
}

/* Take steps together. Returns their number, or 0 if that is not possible, and the state has not
 * changed. */
static int steps_together(dvi_integrator *I, double h, int steps)
{
  const int marches = I->stepper.marches;
  if ((!marches && I->stepper.method->pass == NULL) || !can_step_together(I, h)) return 0;
  return marches ? march_with_trail(I, h, steps) : steps_in_passes(I, h, steps);
}

/* Between the steps of a march single ones are taken where it stops. */
dvi_status dvi__integrator_steps(dvi_integrator *I, double h, long count, long *taken)
{
  const int steps = count < DVI__TOGETHER ? (int)count : DVI__TOGETHER;
  for (int i = 0; i < steps; *taken = i) {
    const int together = steps_together(I, h, steps - i);
    if (together == 0 && !I->stepper.marches) return DVI_OK;
    if (together == 0) {
      DVI_TRY(dvi_integrator_step(I, h));
      dvi__trail_put(I->stepper.trail, &I->now);
    }
    i += together > 0 ? together : 1;
  }
  return DVI_OK;
}
