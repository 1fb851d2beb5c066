/* A step of discontinuous Galerkin: what dg and dg-phase share. */
#ifndef DVI_METHOD_DG_STEP_H
#define DVI_METHOD_DG_STEP_H
#include "step/degenerate/discontinuous.h"
#include "method/one_step.h"

/* The `alarm` key: what a jump that is large against the motion does. Its value goes to
 * dvi__dg_create. */
#define DVI__ALARM_KEY                                                        \
  {                                                                           \
    "alarm", dvi__alarm_choice, DVI__SAID, 0, DVI__ALARM_STOP,                \
        "stop or warn if the jump is large against the motion; default: stop" \
  }

enum { DVI__ALARM_STOP, DVI__ALARM_WARN };
const char *dvi__alarm_choice(int index);

/* A jump, or `what` is watched of it, is too large: DVI_JUMP with the remedy, or counted. */
dvi_status dvi__ring_alarm(const dvi__stepper *self, int alarm, const char *what, double size,
                           double motion, const char *remedy);
void dvi__explain_jumps(int alarm, dvi__text *text);

/* Fill a stepper's symmetric, memory and own for this space; not its order. The remedy, a literal,
 * is what the alarm advises. */
dvi_status dvi__dg_create(dvi__stepper *self, const dvi__dg_space *space, int alarm,
                          const char *remedy);

/* The other operations of dvi__method, and what goes into its initialiser for them. */
dvi_status dvi__dg_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__dg_jump(const dvi__stepper *self);

#define DVI__DG_OPERATIONS                                                              \
  .needs = DVI__ONE_FORM, .uses = DVI__ONE_FORM | DVI__POTENTIAL, .step = dvi__dg_step, \
  .jump = dvi__dg_jump, DVI__ONE_STEP_OPERATIONS

#endif
