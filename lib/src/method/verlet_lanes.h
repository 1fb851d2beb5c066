/* Verlet's step for members of an ensemble side by side, and the layout of its memory. */
#ifndef DVI_METHOD_VERLET_LANES_H
#define DVI_METHOD_VERLET_LANES_H
#include "method/method.h"

/* The forces at the end of a step are those at the start of the next: memory holds a flag, then the forces. */
enum { DVI__FORCES_KNOWN, DVI__FORCES };

dvi_status dvi__verlet_prepare_lanes(dvi__stepper *self, int capacity);
void dvi__verlet_clear_lanes(dvi__stepper *self);
void dvi__verlet_step_lanes(dvi__stepper *self, dvi__members *members, double h);

#endif
