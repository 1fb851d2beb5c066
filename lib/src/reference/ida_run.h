/* What all judges by IDA have alike: vectors, a matrix with its solver, the settings of a run, and
 * the run. */
#ifndef DVI_REFERENCE_IDA_RUN_H
#define DVI_REFERENCE_IDA_RUN_H
#include <ida/ida.h>

#include "reference/run.h"

typedef struct dvi__ida_run {
  dvi__reference_run *run;
  int size; /* unknowns */
  /* the state and its rate, written by the judge before it configures; work */
  N_Vector y, ydot, tested;
  SUNMatrix matrix;
  SUNLinearSolver linear;
  void *memory; /* IDA's */
} dvi__ida_run;

/* `matrix` becomes its own, on failure, too; NULL is one. What there is must be cleared on failure,
 * too. */
dvi_status dvi__ida_run_create(dvi__reference_run *run, int size, SUNMatrix matrix,
                               dvi__ida_run *ida);
void dvi__ida_run_clear(dvi__ida_run *ida);

/* 0, or that IDA refuses. `user` goes to the residual and to what is set after. */
int dvi__ida_run_configure(const dvi__ida_run *ida, IDAResFn residual, void *user);

/* At index 2 the multipliers, `count` unknowns from `first` on, have errors of 1/h times those of q
 * and p: they belong neither in the error test nor in the test of the iteration's convergence. */
int dvi__ida_run_leave_untested(const dvi__ida_run *ida, int first, int count);

/* To the end, which is in y then. */
dvi_status dvi__ida_run_solve(const dvi__ida_run *ida);

#endif
