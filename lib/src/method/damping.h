/* Uniform friction f = -gamma p around the steps of a method. */
#ifndef DVI_METHOD_DAMPING_H
#define DVI_METHOD_DAMPING_H
#include "method/method.h"

/* Prepare a stepper for the friction of its system, after its create. Nothing is done without
 * friction. */
dvi_status dvi__damping_create(dvi__stepper *self);
void dvi__damping_destroy(dvi__stepper *self);

/* Advance the state by a step of the method, between two halves of the friction. On failure the
 * driver discards state and memory. */
dvi_status dvi__take_step(dvi__stepper *self, dvi__state *state, double h);

/* Do so with members side by side. */
void dvi__take_step_lanes(dvi__stepper *self, dvi__members *members, double h);

#endif
