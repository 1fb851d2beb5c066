/* The inside of a solver, for the files of this room. */
#ifndef DVI_SOLVE_SOLVER_STRUCT_H
#define DVI_SOLVE_SOLVER_STRUCT_H
#include <math.h>

#include "solve/nonlinear.h"
#include "solve/progress.h"

typedef struct dvi__kinsol dvi__kinsol;

struct dvi__solver {
  dvi__equations equations;
  dvi_counters *counters;
  double *residual;    /* [unknowns] residual, then the correction */
  double *before;      /* [unknowns] first correction */
  double *magnitude;   /* [unknowns] magnitudes of what is summed in the rows, NULL if not known */
  double *moved;       /* [unknowns] what a correction moves in the rows, in the same memory */
  double *values;      /* values of the Jacobian, NULL if not prepared, or an operator */
  double *pairs;       /* [2*unknowns] of a COMPLEX Jacobian, else NULL */
  int factored;        /* values are factored */
  int unsolved;        /* the last correction was not found by an iterative solver */
  int in_use;          /* the current iteration uses them */
  int inverted;        /* the equations have inverted the Jacobian in use */
  dvi__linear *linear; /* NULL if not prepared */
  dvi__kinsol *kinsol; /* NULL if not prepared */
  dvi__kinsol *tester; /* tests the equations' own variables; NULL if not prepared */
  dvi__kinsol *many;   /* tests many solutions in these at once (certify.h); NULL if not prepared */
  double whole;        /* largest of those after the last iteration */
  int keeps_point;     /* the tester gets the point before it */
  int has_point;       /* and has it */
};

/* Prepare the operation `chord` at x, if that needs it. */
dvi_status dvi__solver_prepare_chord(dvi__solver *solver, const double *x);

/* Evaluate the residual and count it. */
dvi_status dvi__solver_residual(dvi__solver *solver, const double *x, double *r);

/* Evaluate the Jacobian at x into values and factor it. */
dvi_status dvi__solver_factor(dvi__solver *solver, const double *x);

/* Replace a residual by the correction of the factored Jacobian. Fails like dvi__linear_solve. */
dvi_status dvi__solver_correction(dvi__solver *solver, double *r);

/* Find whether every row at x is 0 to a rounding of what is summed in it and of the unknowns, as
 * the Jacobian in use sees them. With `settled` small corrections have not shrunk any more, and
 * rows may be left with their squares. Rows above `most` are not there. solver->residual holds the
 * last correction, and then the residual at x if the sizes of rows are known. */
dvi_status dvi__solver_at_floor(dvi__solver *solver, const double *x, int settled, double most,
                                int *at_floor);

/* Give the least part of the largest unknown beside which groups of unknowns are measured. Smaller
 * groups may be noise. */
double dvi__solver_least_part(const dvi__solver *solver);

/* Give the largest ratio of two vectors over the groups of unknowns. Groups of `to` count with at
 * least `least`. */
double dvi__solver_worst_ratio(const dvi__solver *solver, double least, const double *of,
                               const double *to);

/* Give the larger one of a ratio and one/other. */
static inline double dvi__worse_ratio(double worst, double one, double other)
{
  if (!(one > worst * other)) return worst;
  return other > 0 ? one / other : HUGE_VAL;
}

/* Report on the first two corrections of an iteration, each after it was made. */
void dvi__solver_note(const dvi__solver *solver, const double *x, dvi__solve_report *report);

/* Run Newton's method alone (newton.c). */
dvi_status dvi__newton(dvi__solver *solver, double size, int wary, double *x,
                       dvi__solve_report *report);

/* KINSOL (kinsol.c). After a positive status of dvi__kinsol_solve there is no solution, and x holds
 * the last point. dvi__kinsol_prepare makes one if there is none. `own` makes it for the equations'
 * own variables, which does nothing but certify. If it is more than 1, that is the number of
 * solutions at once. */
dvi_status dvi__kinsol_prepare(dvi__solver *solver, int own, dvi__kinsol **kinsol);
void dvi__kinsol_destroy(dvi__kinsol **kinsol);
/* Find whether x is a solution by KINSOL's own test of its residual. */
dvi_status dvi__kinsol_certify(dvi__kinsol *kinsol, double size, const double *x, int *certified,
                               dvi__solve_report *report);
/* Certify solutions in own variables by residuals that are known (certify.h). */
double *dvi__kinsol_point(dvi__kinsol *kinsol, int i);
dvi_status dvi__kinsol_note(dvi__kinsol *kinsol, int i, const double *next, double whole,
                            double size);
int dvi__kinsol_certify_known(dvi__kinsol *kinsol, int count);
dvi_status dvi__kinsol_solve(dvi__kinsol *kinsol, double size, double *x,
                             dvi__solve_report *report);

/* Replace x by x - correction. Gives the largest correction and the largest x. */
void dvi__correct(int count, const double *correction, double *x, double *largest_correction,
                  double *largest_x);

#endif
