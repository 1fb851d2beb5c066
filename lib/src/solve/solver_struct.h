/* The inside of a solver, for the files of this room. */
#ifndef DVI_SOLVE_SOLVER_STRUCT_H
#define DVI_SOLVE_SOLVER_STRUCT_H
#include "solve/nonlinear.h"
#include "solve/progress.h"

typedef struct dvi__kinsol dvi__kinsol;

struct dvi__solver {
  dvi__equations equations;
  dvi_counters *counters;
  double *residual;    /* [unknowns]; then the correction */
  double *before;      /* [unknowns] the first correction */
  double *magnitude;   /* [unknowns] of what is summed in the rows; NULL: not known */
  double *values;      /* of the Jacobian; NULL: not prepared, or an operator */
  int factored;        /* these values are, */
  int in_use;          /* and the iteration at hand goes by them */
  dvi__linear *linear; /* NULL: not prepared */
  dvi__kinsol *kinsol; /* NULL: not prepared */
};

/* Evaluate, and count. */
dvi_status dvi__solver_residual(dvi__solver *solver, const double *x, double *r);

/* The Jacobian at x into values, and its factor. */
dvi_status dvi__solver_factor(dvi__solver *solver, const double *x);

/* Whether every row at x is 0 to a rounding of what is summed in it and of the unknowns, as the
 * Jacobian in use sees them. */
dvi_status dvi__solver_at_floor(dvi__solver *solver, const double *x, int *at_floor);

/* Groups of unknowns are measured beside at least this part of the largest: smaller ones may be
 * noise. */
double dvi__solver_least_part(const dvi__solver *solver);

/* Report on the first two corrections of an iteration, each after it was made. */
void dvi__solver_note(const dvi__solver *solver, const double *x, dvi__solve_report *report);

/* Newton's method alone (newton.c). */
dvi_status dvi__newton(dvi__solver *solver, double size, int wary, double *x,
                       dvi__solve_report *report);

/* KINSOL (kinsol.c). solve: a positive status if it ended without a solution; x then holds its last
 * point. */
dvi_status dvi__kinsol_create(dvi__solver *solver, dvi__kinsol **kinsol);
void dvi__kinsol_destroy(dvi__kinsol **kinsol);
/* Is x a solution by KINSOL's own test of its residual? */
dvi_status dvi__kinsol_certify(dvi__kinsol *kinsol, double size, const double *x, int *certified,
                               dvi__solve_report *report);
dvi_status dvi__kinsol_solve(dvi__kinsol *kinsol, double size, double *x,
                             dvi__solve_report *report);

/* After two corrections: is the guess so far off that another solution might be found? */
int dvi__misleading(const dvi__trail *trail, double whole);

/* x <- x - correction; gives the largest correction and the largest x. */
void dvi__correct(int count, const double *correction, double *x, double *largest_correction,
                  double *largest_x);

#endif
