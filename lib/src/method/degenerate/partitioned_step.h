/* Methods with a step of step/degenerate/partitioned.h share these functions. */
#ifndef DVI_METHOD_DEGENERATE_PARTITIONED_STEP_H
#define DVI_METHOD_DEGENERATE_PARTITIONED_STEP_H
#include "step/degenerate/partitioned.h"
#include "method/one_step.h"

/* Allocate memory and own. The caller sets order and symmetric. */
dvi_status dvi__partitioned_step_create(dvi__stepper *self, dvi__tableau tableau, int stages,
                                        dvi__projection projection);

/* The other operations of dvi__method, and their entries in its initialiser. */
dvi_status dvi__partitioned_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__partitioned_step_multiplier(const dvi__stepper *self);

#define DVI__PARTITIONED_OPERATIONS                                              \
  .step = dvi__partitioned_step, .multiplier = dvi__partitioned_step_multiplier, \
  DVI__ONE_STEP_OPERATIONS

/* Members of an ensemble side by side (partitioned_lanes.c), with the entries. */
dvi_status dvi__partitioned_prepare_lanes(dvi__stepper *self, int capacity);
void dvi__partitioned_clear_lanes(dvi__stepper *self);
void dvi__partitioned_step_lanes(dvi__stepper *self, dvi__members *members, double h);

#define DVI__PARTITIONED_LANES                                                                  \
  .prepare_lanes = dvi__partitioned_prepare_lanes, .clear_lanes = dvi__partitioned_clear_lanes, \
  .step_lanes = dvi__partitioned_step_lanes

#endif
