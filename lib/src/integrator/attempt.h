/* One step of the method from `now` to `next`, taken again where its solution is doubted. */
#ifndef DVI_INTEGRATOR_ATTEMPT_H
#define DVI_INTEGRATOR_ATTEMPT_H
#include "integrator/integrator_struct.h"

/* Add the numbers that are learned from step to step to the size of the stepper's memory. Call this
 * before the memory is allocated. */
void dvi__attempt_extend(dvi_integrator *integrator);

/* Allocate the memory of a step that is taken again, for methods that can follow a branch. */
dvi_status dvi__attempt_allocate(dvi_integrator *integrator);
void dvi__attempt_clear(dvi_integrator *integrator);

/* Take a step of `length` with this density (dvi__state). On failure `next` and the memory are
 * undefined. */
dvi_status dvi__attempt(dvi_integrator *integrator, double length, double density);

#endif
