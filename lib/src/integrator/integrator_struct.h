/* The inside of an integrator, for integrator.c, checkpoint.c, run.c and the ensemble's files. */
#ifndef DVI_METHOD_INTEGRATOR_STRUCT_H
#define DVI_METHOD_INTEGRATOR_STRUCT_H
#include "method/method.h"
#include "integrator/pace.h"

struct dvi_integrator {
  const dvi_system *system;
  dvi_shapes *shapes;   /* its own copy of the program's; NULL: there are none */
  dvi__pace *pace;      /* NULL: steps are steps of time */
  dvi__stepper stepper; /* of the system, or of the one that the pace puts in its place */
  dvi_counters counters;
  dvi__evaluator *evaluator; /* for diagnostics at one point */
  /* The present state, the one before the last step, and the one that a step works on: a step that fails spoils only `next`. Before the first
   * step `last.p` holds the start's velocity. */
  dvi__state now, last, next;
  double *numbers;            /* the memory of all three */
  double *memory_before;      /* the stepper's memory before the last step: the two change places with every step */
  double *v, *last_v;         /* [n] */
  size_t learned;             /* where in the stepper's memory stands what dvi__attempt learns */
  struct dvi__attempt *first; /* of a step that is taken again (attempt.h); NULL: none is */
  int started;
  double last_h;        /* in time; 0: no step was taken yet */
  double last_h_before; /* before the last step */
};

/* Lay the arrays of a state from *at on, which moves behind them; copy a state with its arrays. */
void dvi__state_lay_out(dvi__state *state, double **at, size_t n);
void dvi__state_copy(size_t n, const dvi__state *from, dvi__state *to);

/* A guess of the velocity, for general Lagrangians: the last step's mean velocity, or the start's. It depends on nothing that a checkpoint does not
 * hold, so that a restored run gives the same digits. last_q [n], last_p [n]. */
void dvi__guess_velocity(int n, const double *q, const double *last_q, const double *last_p, double last_h, double *v);

/* DVI_BAD_ARGUMENT unless h is a step that moves the time from t. */
dvi_status dvi__check_step(double t, double h);

/* A step of exactly h, from methods that choose their steps, too: what is left of a run. */
dvi_status dvi__integrator_step_exactly(dvi_integrator *integrator, double h);

/* Take the last step back, once, as if it had not been. */
void dvi__integrator_take_back(dvi_integrator *integrator);

/* The same for a step that succeeded while what followed did not. The status is passed on, the sentence named. */
dvi_status dvi__integrator_undo(dvi_integrator *integrator, dvi_status status);

#endif
