/* This step is one element of the action (step/element/action.h) for a degenerate Lagrangian. The
 * momentum p is carried from step to step, so that p = alpha(q) holds only approximately. */
#ifndef DVI_METHOD_DEGENERATE_CARRIED_STEP_H
#define DVI_METHOD_DEGENERATE_CARRIED_STEP_H
#include "step/element/action.h"
#include "method/one_step.h"

/* Allocate memory and own for a system with a one-form. The caller sets order and symmetric. The
 * distance from p = alpha(q) has the multipliers sign*lambda, and a step is refused where
 * dvi__form_definite rejects them. A sign of 0 admits every gauge. */
dvi_status dvi__carried_step_create(dvi__stepper *self, const dvi__action_space *space, int sign);

/* The other operations of dvi__method, and their entries in its initialiser. */
void dvi__carried_step_destroy(dvi__stepper *self);
dvi_status dvi__carried_step(dvi__stepper *self, dvi__state *state, double h);
void dvi__carried_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v);

#define DVI__CARRIED_OPERATIONS                                                                  \
  .destroy = dvi__carried_step_destroy, .start = dvi__one_step_start, .step = dvi__carried_step, \
  .path = dvi__carried_step_path, .explain = dvi__one_step_explain

#endif
