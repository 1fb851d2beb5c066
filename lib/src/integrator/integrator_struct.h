/* The members of an integrator, for the files of this room. */
#ifndef DVI_INTEGRATOR_INTEGRATOR_STRUCT_H
#define DVI_INTEGRATOR_INTEGRATOR_STRUCT_H
#include "method/method.h"
#include "integrator/monitored_time.h"

struct dvi_integrator {
  const dvi_system *system;
  dvi_shapes *shapes;             /* copy of the program's shapes, or NULL */
  dvi__monitored_time *monitored; /* NULL for steps of time */
  dvi__stepper stepper;           /* stepper of the system, or of the transformed system */
  dvi_counters counters;
  dvi__evaluator *evaluator; /* for diagnostics at one point */
  /* The present state, the state before the last step, and the work state of a step. A step that
   * fails changes only `next`. Before the first step `last.p` holds the start's velocity. */
  dvi__state now, last, next;
  double *numbers; /* storage of all three states */
  /* the number of balances that are kept, 0 or 1 + symmetries, and the invariants at the start */
  size_t balances;
  double *at_start;
  /* the stepper's memory before the last step. Both memories change places with every step */
  double *memory_before;
  double *v, *last_v;         /* [n] */
  size_t learned;             /* offset of the numbers of dvi__attempt in the stepper's memory */
  struct dvi__attempt *first; /* first attempt of a step that is taken again, or NULL (attempt.h) */
  int started;
  int admitted;         /* the constraints have been found to be of their kind */
  double last_h;        /* length of the last step in time. 0 before the first step */
  double last_h_before; /* last_h before the last step */
};

/* Place the arrays of a state at *at, and move *at behind them. Copy a state with its arrays. */
void dvi__state_lay_out(const dvi_integrator *integrator, dvi__state *state, double **at);
void dvi__state_copy(const dvi_integrator *integrator, const dvi__state *from, dvi__state *to);

/* Count the numbers of a state's arrays, which are contiguous. */
size_t dvi__state_numbers(const dvi_integrator *integrator);

/* Guess the velocity of a general Lagrangian by the last step's mean velocity, or the start's. The
 * guess depends only on numbers that a checkpoint holds, so that a restored run gives the same
 * digits. last_q [n], last_p [n]. */
void dvi__guess_velocity(int n, const double *q, const double *last_q, const double *last_p,
                         double last_h, double *v);

/* Check a step. DVI_BAD_ARGUMENT unless h moves the time from t. */
dvi_status dvi__check_step(double t, double h);

/* Take a step of exactly h, the rest of a run, also by methods that choose their steps. */
dvi_status dvi__integrator_step_exactly(dvi_integrator *integrator, double h);

/* Take the last step back. Allowed once a step. */
void dvi__integrator_take_back(dvi_integrator *integrator);

/* Take back a step that succeeded while its events failed. The status is passed on, and its
 * sentence names the step. */
dvi_status dvi__integrator_undo(dvi_integrator *integrator, dvi_status status);

#endif
