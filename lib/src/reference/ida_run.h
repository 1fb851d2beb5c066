/* The common part of all reference solutions by IDA: vectors, a matrix with its solver, the
 * settings of a run, and the run. */
#ifndef DVI_REFERENCE_IDA_RUN_H
#define DVI_REFERENCE_IDA_RUN_H

#include "reference/run.h"

typedef struct dvi__ida_run {
  dvi__reference_run *run;
  int size;         /* number of unknowns */
  N_Vector y, ydot; /* the state and its rate, set by the caller before dvi__ida_run_configure */
  N_Vector tested;  /* work */
  SUNMatrix matrix;
  SUNLinearSolver linear;
  void *memory; /* memory of IDA */
} dvi__ida_run;

/* Create a run, which owns `matrix` from then on, also after a failure. A NULL matrix is a failure.
 * Clear the run also after a failure. */
dvi_status dvi__ida_run_create(dvi__reference_run *run, int size, SUNMatrix matrix,
                               dvi__ida_run *ida);
void dvi__ida_run_clear(dvi__ida_run *ida);

/* Configure IDA. Return 0, or another number if IDA refuses. `user` is passed to the residual and
 * to callbacks that are set later. */
int dvi__ida_run_configure(const dvi__ida_run *ida, IDAResFn residual, void *user);

/* Exclude `count` unknowns from `first` on from the error test and from the convergence test. At
 * index 2 the multipliers have errors of 1/h times those of q and p. */
int dvi__ida_run_leave_untested(const dvi__ida_run *ida, int first, int count);

/* Integrate to the end, and leave the end in y. */
dvi_status dvi__ida_run_solve(const dvi__ida_run *ida);

#endif
