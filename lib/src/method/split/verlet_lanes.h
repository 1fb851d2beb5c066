/* Verlet's step for members of an ensemble side by side. The memory holds the gradient at the end
 * of the last step, which is that at the start of the next, and then a flag, and then the
 * multipliers of holonomic constraints and their differences (rattle.h). */
#ifndef DVI_METHOD_SPLIT_VERLET_LANES_H
#define DVI_METHOD_SPLIT_VERLET_LANES_H
#include "method/split/rattle.h"

/* `rattle` is that of the method, or NULL without constraints. */
dvi_status dvi__verlet_prepare_lanes(dvi__stepper *self, const dvi__rattle *rattle, int capacity);
void dvi__verlet_clear_lanes(dvi__stepper *self);
void dvi__verlet_step_lanes(dvi__stepper *self, dvi__members *members, double h);

#endif
