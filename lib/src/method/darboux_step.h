/* What the one-step methods for degenerate Lagrangians share: a step of action/darboux.h. */
#ifndef DVI_METHOD_DARBOUX_STEP_H
#define DVI_METHOD_DARBOUX_STEP_H
#include "action/darboux.h"
#include "method/method.h"

/* A stepper's create; the rest of the table is DVI__DARBOUX_OPERATIONS. */
dvi_status dvi__darboux_step_create(dvi__stepper *self, dvi__darboux_rule rule, int stages);
void dvi__darboux_step_destroy(dvi__stepper *self);
void dvi__darboux_step_start(dvi__stepper *self, const double *v);
dvi_status dvi__darboux_step(dvi__stepper *self, dvi__state *state, double h);
void dvi__darboux_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__DARBOUX_OPERATIONS                                                                                           \
  .needs = DVI__ONE_FORM, .uses = DVI__ONE_FORM | DVI__POTENTIAL, .create = create, .destroy = dvi__darboux_step_destroy, \
  .start = dvi__darboux_step_start, .step = dvi__darboux_step, .explain = dvi__darboux_step_explain

#endif
