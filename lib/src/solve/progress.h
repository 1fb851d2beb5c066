/* Tests of convergence. The solver's own loops share them with loops over many problems side by
 * side, each of which must stop where it would stop alone. */
#ifndef DVI_SOLVE_PROGRESS_H
#define DVI_SOLVE_PROGRESS_H
#include <stdint.h>

#include "num/simd/settling.h"

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

/* Give the criteria and the largest number of iterations of simplified Newton's method. */
dvi__criteria dvi__simplified_criteria(void);
int dvi__simplified_most(void);

/* Tell, after two corrections, whether the guess is so far off that another solution might be
 * found. */
int dvi__misleading(const dvi__history *history, double whole);

#endif
