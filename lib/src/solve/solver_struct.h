/* The inside of a solver, for the files of this room. */
#ifndef DVI_SOLVE_SOLVER_STRUCT_H
#define DVI_SOLVE_SOLVER_STRUCT_H
#include "solve/nonlinear.h"

typedef struct dvi__kinsol dvi__kinsol;

struct dvi__solver {
  dvi__equations equations;
  dvi_counters *counters;
  double *residual; /* [unknowns]; then the correction */
  double *values;   /* of the Jacobian */
  dvi__linear *linear;
  dvi__kinsol *kinsol;
};

/* Evaluate, and count. */
dvi_status dvi__solver_residual(dvi__solver *solver, const double *x, double *r);

/* The Jacobian at x into values, and its factor. */
dvi_status dvi__solver_factor(dvi__solver *solver, const double *x);

/* Newton's method alone (newton.c). */
dvi_status dvi__newton(dvi__solver *solver, double size, int wary, double *x, dvi__solve_report *report);

/* KINSOL (kinsol.c). solve: a positive status if it ended without a solution; x then holds its last point. */
dvi_status dvi__kinsol_create(dvi__solver *solver, dvi__kinsol **kinsol);
void dvi__kinsol_destroy(dvi__kinsol **kinsol);
/* Is x a solution by KINSOL's own test of its residual? */
dvi_status dvi__kinsol_certify(dvi__kinsol *kinsol, double size, const double *x, int *certified, dvi__solve_report *report);
dvi_status dvi__kinsol_solve(dvi__kinsol *kinsol, double size, double *x, dvi__solve_report *report);

/* How far an iteration has come (progress.c). */
typedef enum dvi__progress { DVI__GO_ON, DVI__CONVERGED, DVI__STALLED } dvi__progress;

/* Ratios of a correction to the last one: above `stagnant` it is rounding noise if it is also below `noise` (relative to the numbers that are
 * added), above `slowest` the iteration is given up. */
typedef struct dvi__pace {
  double stagnant, noise, slowest;
  int ahead; /* what counts is the next correction's own part: the step takes nothing from the point before the last */
} dvi__pace;

/* The corrections before the one at hand; 0: there was none. */
typedef struct dvi__trail {
  double last, before;
} dvi__trail;

/* Judge one correction and add it to the trail: converged at the roundoff floor, or stalled above it. `unknown` and `size` are the sizes of
 * the unknowns and of what they are added to. */
dvi__progress dvi__judge(double correction, dvi__trail *trail, const dvi__pace *pace, double unknown, double size);

/* After two corrections: is the guess so far off that another solution might be found? */
int dvi__misleading(const dvi__trail *trail, double whole);

/* x <- x - correction; gives the largest correction and the largest x. */
void dvi__correct(int count, const double *correction, double *x, double *largest_correction, double *largest_x);

#endif
