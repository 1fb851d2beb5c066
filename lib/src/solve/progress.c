#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/finite.h"
#include "num/simd/lanes.h"
#include "num/simd/width.h"
#include "solve/solver_struct.h"

#define LOOPS "solve/progress_width.h"
#include "num/simd/each_width.h"

dvi__progress dvi__test_correction(double correction, dvi__history *history,
                                   const dvi__criteria *criteria, double unknown, double size)
{
  return dvi__settling_test(correction, history, criteria, unknown, size);
}

double dvi__ratio(double correction, const dvi__history *history)
{
  return correction < history->before ? correction / history->before : 1;
}

double dvi__unseen_part(double change)
{
  return dvi__settled / change;
}

/* ---- many problems ---- */

typedef void test_many(int count, const double *correction, const double *unknown,
                       const dvi__criteria *criteria, const dvi__histories *histories,
                       int64_t *verdicts);

#define LEVEL(suffix, target, width)                                                               \
  target static void test_##suffix(int count, const double *correction, const double *unknown,     \
                                   const dvi__criteria *criteria, const dvi__histories *histories, \
                                   int64_t *verdicts)                                              \
  {                                                                                                \
    test_from1(count, correction, unknown, criteria, histories, verdicts,                          \
               test_from##width(count, correction, unknown, criteria, histories, verdicts, 0));    \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2"))), 4)
#endif

/* Levels in the order of num/simd/lanes.c. gcc 12 compares vectors of 8 numbers one by one. */
static test_many *const levels[] = {
    test_baseline,
#ifdef __x86_64__
    test_avx2,
    test_avx2,
#endif
};

void dvi__test_corrections(int count, const double *correction, const double *unknown,
                           const dvi__criteria *criteria, const dvi__histories *histories,
                           int64_t *verdicts)
{
  levels[dvi__lanes_level()](count, correction, unknown, criteria, histories, verdicts);
}

void dvi__correct(int count, const double *correction, double *x, double *largest_correction,
                  double *largest_x)
{
  for (int i = 0; i < count; i++) x[i] -= correction[i];
  *largest_correction = dvi__largest((size_t)count, correction);
  *largest_x = dvi__largest((size_t)count, x);
  if (isnan(*largest_x)) *largest_correction = HUGE_VAL;
}
