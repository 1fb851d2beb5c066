/* The methods on groups and spheres share this galerkin step in the charts at its start. */
#ifndef DVI_METHOD_LIE_CHARTED_STEP_H
#define DVI_METHOD_LIE_CHARTED_STEP_H
#include "method/method.h"

/* Set order, symmetric, memory_count, settings.rest and own of a stepper. The step uses the
 * Lagrangian of the group's own velocity if `reduced` is not 0. */
dvi_status dvi__charted_step_create(dvi__stepper *self, int reduced);

void dvi__charted_step_destroy(dvi__stepper *self);
dvi_status dvi__charted_step(dvi__stepper *self, dvi__state *state, double h);
void dvi__charted_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v);
void dvi__charted_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__CHARTED_OPERATIONS                                                 \
  .takes_rest = 1, .needs = DVI__FACTORS, .destroy = dvi__charted_step_destroy, \
  .step = dvi__charted_step, .path = dvi__charted_step_path, .explain = dvi__charted_step_explain

#endif
