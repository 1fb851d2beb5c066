#include "bench/sundials_build.h"

#include <dvi/dvi.h>
#include <dvi/study.h>
#include <math.h>

/* Defined by the build, but not for a compiler that is called by hand. */
#ifndef DVI_BUILD_SUNDIALS
#define DVI_BUILD_SUNDIALS "folder unknown"
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

static void blend(double a, const double *x, double b, const double *y, double *z)
{
  for (int i = 0; i < COUNT; i++) z[i] = a * x[i] + b * y[i];
}

/* The compiler must not know which function is called, and with which arguments. */
static void (*volatile own_sum)(double, const double *, double, const double *, double *) = blend;

/* What libdvi has for this file: the time of so many sums of SUNDIALS' vectors, or NaN. */
double dvi__sundials_sum_time(int count, int calls, double (*clock)(void));

static double time_own_sums(void)
{
  static double x[COUNT], y[COUNT], z[COUNT];
  for (int i = 0; i < COUNT; i++) x[i] = y[i] = 1;
  const double began = dvi_study_clock();
  for (int i = 0; i < CALLS; i++) own_sum(1.5, x, 2.5, y, z);
  return dvi_study_clock() - began;
}

/* Measure how many times as long a sum of vectors of SUNDIALS takes as the same loop compiled with
 * this program, by the least times of both by turns. NaN without memory, or if this program was
 * compiled without optimisation or with a sanitizer. */
static double sum_ratio(void)
{
  double own = HUGE_VAL, theirs = HUGE_VAL;
  if (!IS_YARDSTICK) return (double)NAN;
  for (int k = 0; k < TRIALS; k++) {
    const double seconds = dvi__sundials_sum_time(COUNT, CALLS, dvi_study_clock);
    if (isnan(seconds)) return seconds;
    own = fmin(own, time_own_sums());
    theirs = fmin(theirs, seconds);
  }
  return theirs / own;
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
