/* The path of a step that continues those of shorter steps, down to none: of several solutions of a long step's equations, the one that is meant. */
#ifndef DVI_METHOD_FOLLOW_H
#define DVI_METHOD_FOLLOW_H
#include "action/action.h"
#include "solve/nonlinear.h"

/* Whether a solution [unknowns] turns so little away from its guess that it is thought to be that which the guess is near to. */
int dvi__follow_is_near(const dvi__action *action, const double *guess, const double *Y);

/* A step's start, an action with a centring and the solver of its rows; work: a velocity [n], and paths [unknowns]. */
typedef struct dvi__follow {
  dvi__action *action;
  dvi__solver *solver;
  double t, h;
  const double *q, *p;
  int n;
  double *v, *guess, *ahead;
} dvi__follow;

/* Y of the step h; the action is left there. DVI_STEP_TOO_LARGE where the path is lost. */
dvi_status dvi__follow_path(const dvi__follow *own, double *Y, dvi__solve_report *report);

#endif
