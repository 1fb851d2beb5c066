/* The members of an integrator, for the files of this room. */
#ifndef DVI_INTEGRATOR_INTEGRATOR_STRUCT_H
#define DVI_INTEGRATOR_INTEGRATOR_STRUCT_H
#include "method/method.h"
#include "integrator/monitored_time.h"

struct dvi_integrator {
  /* The system of the steps. While a contact is held, this, the stepper and all that belongs to
   * them are those of its constraint (held.h). */
  const dvi_system *system;
  dvi_shapes *shapes;             /* copy of the program's shapes, or NULL */
  dvi__monitored_time *monitored; /* NULL for steps of time */
  dvi__stepper stepper;           /* stepper of the system, or of the transformed system */
  dvi_counters counters;
  dvi__evaluator *evaluator; /* for diagnostics at one point */
  /* The present state, the state before the last step, and the work state of a step. A step that
   * fails changes only `next`. Before the first step `last.p` holds the start's velocity. The
   * compensations of `last` and `next` are the same arrays, because only a step that is taken back
   * needs those of `last`, and none can be once the next step has begun. */
  dvi__state now, last, next;
  double *numbers; /* storage of all three states */
  /* the number of balances that are kept, 0 or 1 + symmetries, and the invariants at the start */
  size_t balances;
  double *at_start;
  /* the stepper's memory before the last step. Both memories change places with every step */
  double *memory_before;
  double *v, *last_v;         /* [n], NULL until first used (dvi__integrator_velocities) */
  size_t learned;             /* offset of the numbers of dvi__attempt in the stepper's memory */
  struct dvi__attempt *first; /* first attempt of a step that is taken again, or NULL (attempt.h) */
  struct dvi__hits *hits;     /* for contacts that are met at their times, or NULL (hits.h) */
  int started;
  int admitted;         /* the constraints have been found to be of their kind */
  double last_h;        /* length of the last step in time. 0 before the first step */
  double last_h_before; /* last_h before the last step */
};

/* Make `v` and `last_v` unless they are there. Steps may use them only if create did this. */
dvi_status dvi__integrator_velocities(dvi_integrator *integrator);

/* Let `next` have the compensations of `last`. */
void dvi__share_compensations(dvi_integrator *integrator);

/* Place the arrays of a state at *at, and move *at behind them. Copy a state with its arrays. q and
 * p are contiguous, and their compensations are, too. */
void dvi__state_lay_out(const dvi_integrator *integrator, dvi__state *state, double **at);
/* Find the side of the present state, unless it is known. */
dvi_status dvi__integrator_find_side(dvi_integrator *integrator);

/* Check that the step stays on one side of the points where the constraint's matrix is singular. No
 * trajectory goes through such a point, but a step can, and then follows no trajectory. */
dvi_status dvi__check_side(dvi_integrator *integrator);

/* Name the reason of a failed step if the trajectory ends within the step. `next` is undefined
 * already. */
dvi_status dvi__name_trajectory_end(const dvi_integrator *integrator, double h, dvi_status status);

/* Say which rows of constraints were redundant at the last start, if any. */
void dvi__explain_dependent_rows(const dvi_integrator *integrator, dvi__text *text);

void dvi__state_copy(const dvi_integrator *integrator, const dvi__state *from, dvi__state *to);

/* Count the numbers of a state's arrays. */
size_t dvi__state_numbers(const dvi_integrator *integrator);

/* Guess the velocity of a general Lagrangian by the last step's mean velocity, or the start's. The
 * guess depends only on numbers that a checkpoint holds, so that a restored run gives the same
 * digits. last_q [n], last_p [n]. */
void dvi__guess_velocity(int n, const double *q, const double *last_q, const double *last_p,
                         double last_h, double *v);

/* Check a step. DVI_BAD_ARGUMENT unless h moves the time from t. */
dvi_status dvi__check_step(double t, double h);

/* Take one step of the method, without a look at contacts, and take it back. */
dvi_status dvi__integrator_smooth_step(dvi_integrator *integrator, double h);

/* Take up to `count` steps, as many as possible in one pass or march of the method, with the bits
 * of single steps. Gives their number, also if a step fails. The last step, or all of a pass, is
 * not to be taken back. */
dvi_status dvi__integrator_steps(dvi_integrator *integrator, double h, long count, long *taken);

enum { DVI__TOGETHER = 32 }; /* more steps taken together would hardly save time */

void dvi__integrator_smooth_back(dvi_integrator *integrator);

/* Evaluate q [nq] and v [nv] at tau in [0,1] of the last smooth step. Either may be NULL. */
dvi_status dvi__integrator_path(dvi_integrator *integrator, double tau, double *q, double *v);

/* Hermite's cubic through q0 and q1 with the velocities v0 and v1, over a time h that may be 0. */
typedef struct dvi__cubic {
  double h;
  const double *q0, *v0, *q1, *v1; /* [n] */
} dvi__cubic;

/* Evaluate q and v [n] at tau in [0,1]. Either may be NULL. */
void dvi__cubic_point(int n, const dvi__cubic *cubic, double tau, double *q, double *v);

/* Evaluate the velocity [nv] of the present state. */
dvi_status dvi__integrator_velocity(dvi_integrator *integrator, double *v);

/* Evaluate the velocity [n] of `now` or `last`. */
dvi_status dvi__state_velocity(dvi_integrator *integrator, const dvi__state *state, double *v);

/* Begin anew at the present state, with its velocity v [nv], as at a start. The second function
 * does so after a change of the state on the way, or of its equations. */
void dvi__integrator_begin(dvi_integrator *integrator, const double *v);
void dvi__integrator_begin_anew(dvi_integrator *integrator, const double *v);

/* Make what belongs to a stepper: its memories, and an evaluator of the system. */
dvi_status dvi__integrator_equip(dvi_integrator *integrator);

/* Free the stepper, and what belongs to it. */
void dvi__integrator_strip(dvi_integrator *integrator);

/* Return the system that the program declared, also while a contact is held. */
const dvi_system *dvi__declared_system(const dvi_integrator *integrator);

/* Take a step of exactly h, the rest of a run, also by methods that choose their steps. */
dvi_status dvi__integrator_step_exactly(dvi_integrator *integrator, double h);

/* Make `next` the present state, after a step of h. */
void dvi__integrator_accept(dvi_integrator *integrator, double h);

/* Exchange the stepper's memory and that before the step. */
void dvi__exchange_memory(dvi_integrator *integrator);

/* Take the last step back. Allowed once a step. */
void dvi__integrator_take_back(dvi_integrator *integrator);

/* Take back a step that succeeded while its events failed. The status is passed on, and its
 * sentence names the step. */
dvi_status dvi__integrator_undo(dvi_integrator *integrator, dvi_status status);

#endif
