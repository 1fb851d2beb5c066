/* Tests of convergence. The solver's own loops share them with loops over many problems side by
 * side, each of which must stop where it would stop alone. */
#ifndef DVI_SOLVE_PROGRESS_H
#define DVI_SOLVE_PROGRESS_H
#include <stdint.h>

typedef enum dvi__progress { DVI__GO_ON, DVI__CONVERGED, DVI__STALLED } dvi__progress;

/* Criteria of convergence, which depend on how an iteration is expected to go. */
typedef struct dvi__criteria {
  /* a correction above this part of the last one, both below the noise, is noise alone */
  double stagnant;
  /* corrections below it may be rounding noise, relative to the numbers that are added */
  double noise;
  double slowest; /* a correction above this part of the largest expected one ends the iteration */
  /* the iteration contracts by about one factor, of several modes that may hide each other, rather
   * than faster and faster */
  int steady;
  /* the next correction's own part counts, because the step reads nothing at the point before the
   * last */
  int ahead;
} dvi__criteria;

/* The history of an iteration, 0 before it starts. Below the noise nothing can be measured, and the
 * contraction that was seen above it is taken to go on. */
typedef struct dvi__history {
  double last, before; /* corrections before the current one */
  double ratio;        /* last measured ratio of two corrections */
  double contraction;  /* factor by which the iteration's own part of a correction shrinks */
  /* bound on that part; a correction may be small by chance, where complex modes turn */
  double own;
} dvi__history;

/* Test one correction and add it to the history. The iteration has converged at the roundoff floor,
 * has stalled above it, or goes on. `unknown` and `size` are the sizes of the unknowns and of the
 * numbers that they are added to. */
dvi__progress dvi__test_correction(double correction, dvi__history *history,
                                   const dvi__criteria *criteria, double unknown, double size);

/* Give the ratio of a correction to the one before, after the test. 1 if there is none, or it
 * grows. */
double dvi__ratio(double correction, const dvi__history *history);

/* Give the part of a correction that would be below the roundoff floor. `change` is the correction
 * as a part of the unknowns. */
double dvi__unseen_part(double change);

/* Histories of many problems, [count] each, without `before`, and the problems' sizes. */
typedef struct dvi__histories {
  double *last, *ratio, *contraction, *own;
  double *size;
} dvi__histories;

/* Test all of them. verdicts[k] is that of dvi__test_correction on problem k. */
void dvi__test_corrections(int count, const double *correction, const double *unknown,
                           const dvi__criteria *criteria, const dvi__histories *histories,
                           int64_t *verdicts);

/* Give the criteria of the fixed point rung (nonlinear.h), with `patient` as there. `own_variables`
 * says that the equations iterate in variables of their own. */
dvi__criteria dvi__fixed_point_criteria(int patient, int own_variables);

/* Give the largest number of iterations of the fixed point rung. */
int dvi__fixed_point_most(int patient);

#endif
