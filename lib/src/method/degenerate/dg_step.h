/* The methods dg and dg-phase share this step of discontinuous Galerkin elements. */
#ifndef DVI_METHOD_DEGENERATE_DG_STEP_H
#define DVI_METHOD_DEGENERATE_DG_STEP_H
#include "step/degenerate/discontinuous.h"
#include "method/one_step.h"

/* The `alarm` key chooses the reaction to a jump that is large against the motion. Its value goes
 * to dvi__dg_create. */
#define DVI__ALARM_KEY                                                        \
  {                                                                           \
    "alarm", dvi__alarm_choice, DVI__SAID, 0, DVI__ALARM_STOP,                \
        "stop or warn if the jump is large against the motion; default: stop" \
  }

enum { DVI__ALARM_STOP, DVI__ALARM_WARN };
const char *dvi__alarm_choice(int index);

/* Report that a jump, or the quantity named `what`, is too large. The alarm either returns DVI_JUMP
 * with the remedy or is counted. */
dvi_status dvi__ring_alarm(const dvi__stepper *self, int alarm, const char *what, double size,
                           double motion, const char *remedy);
void dvi__explain_jumps(int alarm, dvi__text *text);

/* Set symmetric, memory and own of a stepper for this space. The caller sets the order. The remedy,
 * a string literal, is the advice of the alarm. */
dvi_status dvi__dg_create(dvi__stepper *self, const dvi__dg_space *space, int alarm,
                          const char *remedy);

/* The other operations of dvi__method, and their entries in its initialiser. */
dvi_status dvi__dg_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__dg_jump(const dvi__stepper *self);

#define DVI__DG_OPERATIONS                                                              \
  .needs = DVI__ONE_FORM, .uses = DVI__ONE_FORM | DVI__POTENTIAL, .step = dvi__dg_step, \
  .jump = dvi__dg_jump, DVI__ONE_STEP_OPERATIONS

#endif
