/* What methods share whose step is that of action/partitioned.h. */
#ifndef DVI_METHOD_PARTITIONED_STEP_H
#define DVI_METHOD_PARTITIONED_STEP_H
#include "action/partitioned.h"
#include "method/method.h"

/* Make memory and own; order and symmetric are the method's. */
dvi_status dvi__partitioned_step_create(dvi__stepper *self, dvi__tableau tableau, int stages, dvi__projection projection);

/* The other operations of dvi__method, and what goes into its initialiser for them. */
void dvi__partitioned_step_destroy(dvi__stepper *self);
void dvi__partitioned_step_start(dvi__stepper *self, const double *v);
dvi_status dvi__partitioned_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__partitioned_step_multiplier(const dvi__stepper *self);
void dvi__partitioned_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__PARTITIONED_OPERATIONS                                                                              \
  .destroy = dvi__partitioned_step_destroy, .start = dvi__partitioned_step_start, .step = dvi__partitioned_step, \
  .multiplier = dvi__partitioned_step_multiplier, .explain = dvi__partitioned_step_explain

#endif
