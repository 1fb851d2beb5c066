/* A measure of how SUNDIALS was compiled, for the command. */
#include <math.h>

#include "solve/sundials.h"

/* lib/exports.map has it for the command, which declares it, too. */
double dvi__sundials_sum_time(int count, int calls, double (*clock)(void));

static double time_sums(int calls, N_Vector x, N_Vector y, N_Vector z, double (*clock)(void))
{
  N_VConst(1.0, x);
  N_VConst(1.0, y);
  const double began = clock();
  for (int i = 0; i < calls; i++) N_VLinearSum(1.5, x, 2.5, y, z);
  return clock() - began;
}

/* Return the time of so many sums of SUNDIALS' vectors of `count` numbers. NaN without memory or
 * without SUNDIALS. */
double dvi__sundials_sum_time(int count, int calls, double (*clock)(void))
{
  SUNContext context = NULL;
  double seconds = (double)NAN;
  if (dvi__sundials_load() != DVI_OK || dvi__sundials->new_context(&context) != 0) return seconds;
  N_Vector x = N_VNew_Serial(count, context), y = N_VNew_Serial(count, context),
           z = N_VNew_Serial(count, context);
  if (x != NULL && y != NULL && z != NULL) seconds = time_sums(calls, x, y, z, clock);
  N_VDestroy(z);
  N_VDestroy(y);
  N_VDestroy(x);
  (void)SUNContext_Free(&context);
  return seconds;
}
