/* The path of a step that continues those of shorter steps, down to none: of several solutions of a long step's equations, the one that is meant. */
#ifndef DVI_METHOD_FOLLOW_H
#define DVI_METHOD_FOLLOW_H
#include "action/action.h"
#include "solve/nonlinear.h"

/* Whether the solution Y [unknowns] that was found last, for a step h, is thought to be the one that is meant: it turns little away from its guess, and the
 * determinant of the rows' Jacobian has the sign that it has for short steps with a positive mass. */
int dvi__follow_is_meant(const dvi__action *action, const dvi__solver *solver, double h, const double *guess, const double *Y);

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
