/* One element of the action (step/element/action.h) as a step for a degenerate Lagrangian: p is
 * carried from step to step, and off alpha(q). */
#ifndef DVI_METHOD_CARRIED_STEP_H
#define DVI_METHOD_CARRIED_STEP_H
#include "step/element/action.h"
#include "method/one_step.h"

/* Make memory and own; order and symmetric are the method's. For a system with a one-form. `sign`:
 * what is off p = alpha(q) has the multipliers sign*lambda, and a step is refused where
 * dvi__form_definite does not like them; 0: every gauge will do. */
dvi_status dvi__carried_step_create(dvi__stepper *self, const dvi__action_space *space, int sign);

/* The other operations of dvi__method, and what goes into its initialiser for them. */
void dvi__carried_step_destroy(dvi__stepper *self);
dvi_status dvi__carried_step(dvi__stepper *self, dvi__state *state, double h);
void dvi__carried_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v);

#define DVI__CARRIED_OPERATIONS                                                                  \
  .destroy = dvi__carried_step_destroy, .start = dvi__one_step_start, .step = dvi__carried_step, \
  .path = dvi__carried_step_path, .explain = dvi__one_step_explain

#endif
