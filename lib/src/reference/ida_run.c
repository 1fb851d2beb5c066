#include "reference/ida_run.h"

#include <float.h>

dvi_status dvi__ida_run_create(dvi__reference_run *run, int size, SUNMatrix matrix,
                               dvi__ida_run *ida)
{
  *ida = (dvi__ida_run){.run = run, .size = size, .matrix = matrix};
  ida->y = N_VNew_Serial(size, run->context);
  ida->ydot = N_VNew_Serial(size, run->context);
  ida->tested = N_VNew_Serial(size, run->context);
  ida->memory = IDACreate(run->context);
  if (ida->y == NULL || ida->ydot == NULL || ida->tested == NULL || ida->matrix == NULL ||
      ida->memory == NULL)
    return dvi__reference_no_setup(run);
  ida->linear = dvi__reference_linear(run, ida->y, matrix);
  return ida->linear == NULL ? dvi__reference_no_setup(run) : DVI_OK;
}

void dvi__ida_run_clear(dvi__ida_run *ida)
{
  if (ida->memory != NULL) IDAFree(&ida->memory);
  if (ida->linear != NULL) (void)SUNLinSolFree(ida->linear);
  if (ida->matrix != NULL) SUNMatDestroy(ida->matrix);
  if (ida->tested != NULL) N_VDestroy(ida->tested);
  if (ida->ydot != NULL) N_VDestroy(ida->ydot);
  if (ida->y != NULL) N_VDestroy(ida->y);
}

int dvi__ida_run_configure(const dvi__ida_run *ida, IDAResFn residual, void *user)
{
  const dvi__reference_run *run = ida->run;
  void *memory = ida->memory;
  return DVI__SUNDIALS_SILENCE(IDASetErrHandlerFn, memory) ||
         IDAInit(memory, residual, run->t, ida->y, ida->ydot) ||
         IDASStolerances(memory, run->options.relative_tolerance,
                         run->options.absolute_tolerance) ||
         IDASetUserData(memory, user) || IDASetMaxNumSteps(memory, run->options.max_steps) ||
         IDASetStopTime(memory, run->t_end) ||
         IDASetMinStep(memory, dvi__reference_least_step(run)) ||
         IDASetLinearSolver(memory, ida->linear, ida->matrix);
}

int dvi__ida_run_leave_untested(const dvi__ida_run *ida, int first, int count)
{
  const dvi_reference_options *options = &ida->run->options;
  double *number = N_VGetArrayPointer(ida->tested);
  for (int i = 0; i < ida->size; i++)
    number[i] = i >= first && i < first + count ? DBL_MAX : options->absolute_tolerance;
  if (IDASVtolerances(ida->memory, options->relative_tolerance, ida->tested)) return -1;
  for (int i = 0; i < ida->size; i++) number[i] = i >= first && i < first + count ? 0.0 : 1.0;
  return IDASetId(ida->memory, ida->tested) || IDASetSuppressAlg(ida->memory, 1);
}

dvi_status dvi__ida_run_solve(const dvi__ida_run *ida)
{
  dvi__reference_run *run = ida->run;
  const int flag = IDASolve(ida->memory, run->t_end, &run->reached, ida->y, ida->ydot, IDA_NORMAL);
  (void)IDAGetNumSteps(ida->memory, &run->steps);
  (void)IDAGetCurrentTime(ida->memory, &run->reached);
  return flag < 0 ? dvi__reference_stopped(run, flag, IDAGetReturnFlagName(flag)) : DVI_OK;
}
