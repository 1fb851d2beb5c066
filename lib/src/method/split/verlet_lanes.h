/* Verlet's step for members of an ensemble side by side. The memory holds the gradient at the end
 * of the last step, which is that at the start of the next, and then a flag. */
#ifndef DVI_METHOD_SPLIT_VERLET_LANES_H
#define DVI_METHOD_SPLIT_VERLET_LANES_H
#include "method/method.h"

dvi_status dvi__verlet_prepare_lanes(dvi__stepper *self, int capacity);
void dvi__verlet_clear_lanes(dvi__stepper *self);
void dvi__verlet_step_lanes(dvi__stepper *self, dvi__members *members, double h);

#endif
