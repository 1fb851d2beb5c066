/* One step of the method from `now` to `next`, and the same again where its solution is doubted. */
#ifndef DVI_METHOD_ATTEMPT_H
#define DVI_METHOD_ATTEMPT_H
#include "integrator/integrator_struct.h"

/* Add to the stepper's memory, before it is allocated, what is learned from step to step. */
void dvi__attempt_extend(dvi_integrator *integrator);

/* Make room for a step that is taken again; for methods that can follow a branch. */
dvi_status dvi__attempt_allocate(dvi_integrator *integrator);
void dvi__attempt_clear(dvi_integrator *integrator);

/* A step of `length` with this density (dvi__state). On failure `next` and the memory are
 * spoilt. */
dvi_status dvi__attempt(dvi_integrator *integrator, double length, double density);

#endif
