/* Solve the stationarity conditions of a step by fixed-point iteration where the equations have one
 * that contracts, else by Newton's method. If this fails, or on request, follow the branch of
 * shorter steps. Methods share these functions if their step is not one element of the action, for
 * which element_step.h has its own. */
#ifndef DVI_METHOD_STATIONARY_H
#define DVI_METHOD_STATIONARY_H
#include "method/method.h"
#include "solve/branch.h"

/* A step of length h from the state. `place` puts the equations at a step of length h, which is
 * `part` of the whole step and of the carried numbers. `guess` writes x [unknowns], a guess for the
 * placed equations. */
typedef struct dvi__stationary_step {
  dvi__stepper *stepper;
  const dvi__state *state;
  double h;
  dvi_status (*place)(dvi__stepper *self, const dvi__state *state, double h, double part);
  dvi_status (*guess)(dvi__stepper *self, double h, double *x);
} dvi__stationary_step;

/* Numbers in the stepper's memory that tell when fixed-point iteration is tried again. */
enum { DVI__LADDER = 2 };

/* The most iterations of Newton's method that fast convergence takes, with a foreseen end. More
 * leave a doubt of the solution's branch. */
enum { DVI__FAST_NEWTON = 3 };

typedef struct dvi__stationary {
  dvi__solver *solver;
  double *x;         /* [unknowns] the solution */
  double *room;      /* [DVI__BRANCH_ROOM * unknowns] */
  int has_iteration; /* the equations have a fixed-point iteration */
  int frozen;        /* it is simplified Newton's method */
  int iterated;      /* the last solution is the iteration's */
  size_t ladder;     /* place of those numbers in the stepper's memory, which the caller sets */
} dvi__stationary;

/* Set what all such methods have in common, zeros on the diagonal of the Jacobian. The equations'
 * residual, jacobian, row_scale and fixed-point iteration are the method's. */
dvi_status dvi__stationary_create(dvi__stepper *self, dvi__equations *equations,
                                  dvi__stationary *stationary);
void dvi__stationary_clear(dvi__stationary *stationary);

/* Solve for x of the step. The equations stay placed there, and the stepper's doubt is set. On
 * failure the sentence has iterations and residual, or the end of the branch. */
dvi_status dvi__stationary_solve(dvi__stationary *stationary, const dvi__stationary_step *step);

#endif
