/* A step of step/hamiltonian/phase.h: what dg-phase does with a Hamiltonian. */
#ifndef DVI_METHOD_PHASE_STEP_H
#define DVI_METHOD_PHASE_STEP_H
#include "method/one_step.h"

/* Fill a stepper's symmetric, memory and own; not its order. `alarm` as in dg_step.h. */
dvi_status dvi__phase_step_create(dvi__stepper *self, int degree, int moments, int alarm);

dvi_status dvi__phase_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__phase_step_multiplier(const dvi__stepper *self);
const double *dvi__phase_step_jump(const dvi__stepper *self);

#endif
