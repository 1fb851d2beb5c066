#include "bench/sundials_build.h"

#include <dvi/dvi.h>
#include <dvi/study/study.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sundials/sundials_config.h>

/* Defined by the build, but not for a compiler that is called by hand. */
#ifndef DVI_BUILD_SUNDIALS
#define DVI_BUILD_SUNDIALS "folder unknown"
#endif

#if SUNDIALS_VERSION_MAJOR >= 7
#define NO_COMMUNICATOR SUN_COMM_NULL
#else
#define NO_COMMUNICATOR NULL
#endif

/* The loop of this file is no yardstick without optimisation, or with a sanitizer. */
#if !defined(__OPTIMIZE__) || defined(__SANITIZE_ADDRESS__)
enum { IS_YARDSTICK = 0 };
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
enum { IS_YARDSTICK = 0 };
#else
enum { IS_YARDSTICK = 1 };
#endif
#else
enum { IS_YARDSTICK = 1 };
#endif

enum { COUNT = 1000, CALLS = 200, TRIALS = 5 };

/* The ratio is 5 and more without optimisation, about 1 with it, and 2 with loops of single
 * numbers. */
static const double ratio_of_unoptimised = 3.2;

/* Another file might call it with other arguments, so that the compiler knows none of them. */
void sundials_build_sum(double a, const double *x, double b, const double *y, double *z);
void sundials_build_sum(double a, const double *x, double b, const double *y, double *z)
{
  for (int i = 0; i < COUNT; i++) z[i] = a * x[i] + b * y[i];
}

static double time_calls(N_Vector x, N_Vector y, N_Vector z, bool own)
{
  const double began = dvi_study_clock();
  for (int i = 0; i < CALLS; i++)
    if (own)
      sundials_build_sum(1.5, N_VGetArrayPointer(x), 2.5, N_VGetArrayPointer(y),
                         N_VGetArrayPointer(z));
    else
      N_VLinearSum(1.5, x, 2.5, y, z);
  return dvi_study_clock() - began;
}

/* Compare the least times, by turns. */
static double compare(N_Vector x, N_Vector y, N_Vector z)
{
  double own = HUGE_VAL, theirs = HUGE_VAL;
  N_VConst(1.0, x);
  N_VConst(1.0, y);
  for (int k = 0; k < TRIALS; k++) {
    own = fmin(own, time_calls(x, y, z, true));
    theirs = fmin(theirs, time_calls(x, y, z, false));
  }
  return theirs / own;
}

/* Measure how many times as long a sum of vectors of SUNDIALS takes as the same loop compiled with
 * this program. NaN without memory, or if this program was compiled without optimisation or with a
 * sanitizer. */
static double sum_ratio(void)
{
  SUNContext context = NULL;
  double ratio = (double)NAN;
  if (!IS_YARDSTICK || SUNContext_Create(NO_COMMUNICATOR, &context) != 0) return ratio;
  N_Vector x = N_VNew_Serial(COUNT, context), y = N_VNew_Serial(COUNT, context),
           z = N_VNew_Serial(COUNT, context);
  if (x != NULL && y != NULL && z != NULL) ratio = compare(x, y, z);
  N_VDestroy(z);
  N_VDestroy(y);
  N_VDestroy(x);
  (void)SUNContext_Free(&context);
  return ratio;
}

void sundials_build_print(FILE *stream)
{
  const double ratio = sum_ratio();
  (void)fprintf(stream, "SUNDIALS %s from %s: ", dvi_reference_version(), DVI_BUILD_SUNDIALS);
  if (isnan(ratio)) {
    (void)fprintf(stream, "not known whether it was compiled with optimisation\n");
    return;
  }
  (void)fprintf(stream, "%s\n",
                ratio < ratio_of_unoptimised ? "compiled with optimisation"
                                             : "compiled without optimisation, its codes are "
                                               "several times slower than they can be");
  (void)fprintf(stream, "its sum of vectors takes %.1f times as long as the same loop in dvi\n",
                ratio);
}
