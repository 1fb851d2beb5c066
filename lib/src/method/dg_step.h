/* A step of discontinuous Galerkin: what dg and dg-phase share. */
#ifndef DVI_METHOD_DG_STEP_H
#define DVI_METHOD_DG_STEP_H
#include "action/discontinuous.h"
#include "method/one_step.h"

/* The `alarm` key: what a jump that is large against the motion does. Its value goes to dvi__dg_create. */
#define DVI__ALARM_KEY                                                         \
  {                                                                            \
    "alarm", dvi__alarm_choice, DVI__SAID, 0, DVI__ALARM_STOP,                 \
        "stop or warn if the jump is large against the motion; left out: stop" \
  }

enum { DVI__ALARM_STOP, DVI__ALARM_WARN };
const char *dvi__alarm_choice(int index);

/* Judge a jump of this size against a part of the largest motion, with `at` the size of what jumps: DVI_JUMP with the remedy, or counted, if it is larger. */
dvi_status dvi__watch_jump(const dvi__stepper *self, int alarm, double part, double jump, double motion, double at,
                           const char *remedy);
void dvi__explain_jumps(int alarm, dvi__text *text);

/* Fill a stepper's symmetric, memory and own for this space; not its order. */
dvi_status dvi__dg_create(dvi__stepper *self, const dvi__dg_space *space, int alarm);

/* The other operations of dvi__method, and what goes into its initialiser for them. */
dvi_status dvi__dg_step(dvi__stepper *self, dvi__state *state, double h);
const double *dvi__dg_jump(const dvi__stepper *self);

#define DVI__DG_OPERATIONS                                                                                    \
  .needs = DVI__ONE_FORM, .uses = DVI__ONE_FORM | DVI__POTENTIAL, .step = dvi__dg_step, .jump = dvi__dg_jump, \
  DVI__ONE_STEP_OPERATIONS

#endif
