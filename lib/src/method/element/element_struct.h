/* The inside of a step by one element, for element_step.c and element_branch.c. */
#ifndef DVI_METHOD_ELEMENT_STRUCT_H
#define DVI_METHOD_ELEMENT_STRUCT_H
#include "step/element/decoupled.h"
#include "method/element/element_step.h"
#include "solve/branch.h"

/* One step's worth of arguments: where it starts and what is known of the step before. */
typedef struct dvi__element_place {
  double t, h;
  const double *q, *p;
  double last_h;        /* 0: there was none */
  const double *last_Y; /* its unknowns; without a step before, a guess of the velocity [n] */
  const double *last_g; /* its forces; NULL: not known */
} dvi__element_place;

typedef struct dvi__element {
  dvi__action *action;
  /* simplified Newton's method takes the Jacobian apart; NULL: it does not */
  dvi__decoupled *decoupled;
  int centred,
      /* in charts at its start, where a path that is not near its guess is followed; it keeps the
       * whole Jacobian */
      keeps_whole;
  /* symmetric Jacobians, and real parts of them, are definite for short steps: the mass is
   * constant, and positive */
  int definite;
  dvi__solver *solver;
  int choice;     /* of the solver */
  dvi__rung rung; /* that was tried last */
  double *Y;      /* the unknowns; the arrays below lie behind */
  /* in the memory: FROZEN_H (0: nothing is), FROZEN_ITERATIONS that it took when it was new, and
   * the Jacobian */
  double *frozen;
  int keeps; /* the Jacobian is not frozen anew */
  /* the place whose iteration starts from the last step's forces; NULL: from Y */
  const dvi__element_place *forces_of;
  double *dq, *dq_low, *dp;
  double *guess;  /* [unknowns] of the iteration, in charts */
  double *branch; /* [DVI__BRANCH_ROOM * unknowns] room to follow one */
} dvi__element;

/* Y of a straight line along the velocity at the start, which is sought from that of the last
 * path. */
dvi_status dvi__element_straight(dvi__stepper *self, const dvi__element_place *at, double *Y);

/* Y of the solution that continues those of shorter steps; `whole`: what the ladder failed by, with
 * the thread's sentence, or DVI_OK. */
dvi_status dvi__element_follow(dvi__stepper *self, const dvi__element_place *at, dvi_status whole,
                               double *Y);

/* Whether the mass makes what is symmetric of a short step's Jacobian definite. */
int dvi__element_is_definite(const dvi_system *system, const dvi__evaluator *evaluator);

/* Of the solution that the ladder has found: what it tells of its branch. */
dvi__doubt dvi__element_doubt(const dvi__stepper *self, const dvi__element_place *at,
                              const dvi__solve_report *report);

/* The same in charts, where the turn from the guess decides: whether it is to be followed. */
int dvi__element_strays(const dvi__stepper *self, const dvi__element_place *at);

#endif
