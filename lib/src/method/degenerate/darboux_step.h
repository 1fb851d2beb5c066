/* The one-step methods for degenerate Lagrangians share this step of step/degenerate/darboux.h. */
#ifndef DVI_METHOD_DEGENERATE_DARBOUX_STEP_H
#define DVI_METHOD_DEGENERATE_DARBOUX_STEP_H
#include "step/degenerate/darboux.h"
#include "method/one_step.h"

/* Create a stepper for a rule. DVI__DARBOUX_OPERATIONS sets all other operations but create. */
dvi_status dvi__darboux_step_create(dvi__stepper *self, dvi__darboux_rule rule, int stages);
dvi_status dvi__darboux_step(dvi__stepper *self, dvi__state *state, double h);

#define DVI__DARBOUX_OPERATIONS                                                              \
  .needs = DVI__ONE_FORM, .uses = DVI__ONE_FORM | DVI__POTENTIAL, .step = dvi__darboux_step, \
  DVI__ONE_STEP_OPERATIONS

#endif
