/* KINSOL's test of solutions that other rungs found. In the equations' own variables their
 * residuals are known: the last iteration of each shows the residual at the point before it, from
 * which all results of the solution come. The test is on the largest residual, so that many
 * solutions pass together if each would pass alone. */
#ifndef DVI_SOLVE_CERTIFY_H
#define DVI_SOLVE_CERTIFY_H
#include "solve/nonlinear.h"

/* Test a solution. x stays, and NULL stands for the equations' own variables after fixed-point
 * iteration. DVI_NOT_CONVERGED: the solution does not pass, and the KINSOL rung should take
 * over. */
dvi_status dvi__certify(dvi__solver *solver, double size, const double *x,
                        dvi__solve_report *report);

/* Let the fixed-point rung keep the point before the last iteration for dvi__certify, and prepare
 * for the test of up to `most` solutions, if these are more than 1. DVI_NO_MEMORY. */
dvi_status dvi__certify_prepare(dvi__solver *solver, int most);
int dvi__certify_is_prepared(const dvi__solver *solver, int most);

/* Give the place for the point before the last iteration of solution i, which is no more than the
 * solutions that were noted. */
double *dvi__certify_point(dvi__solver *solver, int i);

/* Note the point after it, the largest number there, and the size of dvi__solve. DVI_NOT_FINITE if
 * numbers are too large or too small for a test. */
dvi_status dvi__certify_note(dvi__solver *solver, int i, const double *next, double whole,
                             double size);

/* Tell whether KINSOL certifies the first `count` solutions. Else each is to be tested alone. */
int dvi__certify_noted(dvi__solver *solver, int count);

#endif
