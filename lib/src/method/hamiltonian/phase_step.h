/* This step of step/hamiltonian/phase_element.h is that of dg-phase for a Hamiltonian. */
#ifndef DVI_METHOD_HAMILTONIAN_PHASE_STEP_H
#define DVI_METHOD_HAMILTONIAN_PHASE_STEP_H
#include "method/one_step.h"

/* Set symmetric, memory and own of a stepper. The caller sets the order. The argument `alarm` is
 * that of dg_step.h. */
dvi_status dvi__phase_step_create(dvi__stepper *self, int degree, int moments, int alarm);

dvi_status dvi__phase_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__phase_step_multiplier(const dvi__stepper *self);
const double *dvi__phase_step_jump(const dvi__stepper *self);

#endif
