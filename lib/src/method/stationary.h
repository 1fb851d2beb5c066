/* Solving a step's stationarity conditions by Newton's method, and along the branch of shorter
 * steps where that fails or is told to: what methods share whose step is not one element of the
 * action (element_step.h has those). */
#ifndef DVI_METHOD_STATIONARY_H
#define DVI_METHOD_STATIONARY_H
#include "method/method.h"
#include "solve/branch.h"

/* A step of length h from the state: put the equations at a step of length h, which is `part` of
 * it, and of what the method carries from step to step; x [unknowns], a guess for the equations
 * that were placed. */
typedef struct dvi__stationary_step {
  dvi__stepper *stepper;
  const dvi__state *state;
  double h;
  dvi_status (*place)(dvi__stepper *self, const dvi__state *state, double h, double part);
  dvi_status (*guess)(dvi__stepper *self, double h, double *x);
} dvi__stationary_step;

typedef struct dvi__stationary {
  dvi__solver *solver;
  double *x;    /* [unknowns] the solution */
  double *room; /* [DVI__BRANCH_ROOM * unknowns] */
} dvi__stationary;

/* Fill in what every such method has alike: no fixed point iteration, and zeros on the Jacobian's
 * diagonal. The equations' residual, jacobian and row_scale are the method's. */
dvi_status dvi__stationary_create(dvi__stepper *self, dvi__equations *equations,
                                  dvi__stationary *stationary);
void dvi__stationary_clear(dvi__stationary *stationary);

/* x of the step; the equations are left there, and the stepper knows whether the solution is to be
 * doubted. On failure a sentence with iterations and residual, or where the branch ends. */
dvi_status dvi__stationary_solve(const dvi__stationary *stationary,
                                 const dvi__stationary_step *step);

#endif
