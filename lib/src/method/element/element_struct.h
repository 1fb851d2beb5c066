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

/* How Newton's method has the Jacobian, which is chosen when it is first needed
 * (element_newton.c). */
typedef struct dvi__newton_form {
  int is_operator;         /* 0: it is a matrix */
  dvi__operator A;         /* its products, and what preconditions them: */
  dvi__decoupled *systems; /* decoupled systems; NULL: the kinetic part */
  dvi__decoupled *owned;   /* these, where simplified Newton's method has none */
  double *point;           /* where they are frozen: work */
  int is_frozen;           /* what preconditions was made for the equations where they stand */
} dvi__newton_form;

/* What is frozen, in the memory: the step's length, 0: nothing is; how many iterations it took when
 * it was new; and the Jacobian at a point, by that, or as it is. */
enum { DVI__FROZEN_H, DVI__FROZEN_ITERATIONS, DVI__FROZEN_POINT };

typedef struct dvi__element {
  dvi__action *action;
  dvi_counters *counters;
  /* simplified Newton's method takes the Jacobian apart; NULL: it does not */
  dvi__decoupled *decoupled;
  int is_weighed, is_dear; /* its factors' cost is known; and too high for the ladder */
  int centred,
      /* in charts at its start, where a path that is not near its guess is followed; it keeps the
       * whole Jacobian */
      keeps_whole;
  /* symmetric Jacobians, and real parts of them, are definite for short steps: the mass is
   * constant, and positive */
  int definite;
  dvi__solver *solver;
  dvi__newton_form newton;
  int choice;     /* of the solver */
  dvi__rung rung; /* that was tried last */
  double *Y;      /* the unknowns; the arrays below lie behind */
  double *frozen; /* in the memory: what is frozen */
  int keeps;      /* the Jacobian is not frozen anew */
  /* the place whose iteration starts from the last step's forces; NULL: from Y */
  const dvi__element_place *forces_of;
  double *dq, *dq_low, *dp;
  double *guess;  /* [unknowns] of the iteration, in charts */
  double *branch; /* [DVI__BRANCH_ROOM * unknowns] room to follow one; NULL: not needed yet */
} dvi__element;

/* Put the equations at a step of length h from there. */
void dvi__element_put(dvi__element *own, const dvi__element_place *at, double h);

/* Whether the rungs follow one after the other. */
int dvi__element_is_ladder(const dvi__element *own);

/* Complete the equations by what Newton's methods need; free it. */
void dvi__element_set_newton(dvi__equations *equations);
void dvi__element_clear_newton(dvi__element *own);

/* Find out whether the factors of simplified Newton's method are too dear for the ladder.
 * DVI_NO_MEMORY, DVI_BAD_SIZE, DVI_SOLVER_FAILED. */
dvi_status dvi__element_weigh(dvi__element *own);

/* The systems that the last rung went by; NULL: it went by the whole Jacobian, or by none. */
const dvi__decoupled *dvi__element_frozen(const dvi__element *own);

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
