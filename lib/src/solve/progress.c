#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/finite.h"
#include "num/simd/lanes.h"
#include "num/simd/width.h"
#include "solve/solver_struct.h"

/* The iteration is at the floor when its own part of a correction is well below a rounding. That
 * part counts although the unknowns are then right: the last residual was that of the point before,
 * and what a step takes from it would err by this part in the same direction in every step (a
 * charge in a magnetic field: energy drift of 1e-17 a step). */
static const double settled = 0.125 * DBL_EPSILON;

/* Where the step takes all from one point, it is the next correction that must not show; over 5000
 * steps of outer-solar one of an eighth of a rounding does (5e-11), one of this part of it does not
 * (2e-12, which is the roundings' own), nor does it as energy drift of a stiff oscillator. */
static const double unseen = DBL_EPSILON / 2048;

/* Over many corrections an iteration that is not given up contracts at least by its slowest pace,
 * whatever two of them say, or by this. */
static const double hardly = 0.98;

#define LOOPS "solve/progress_width.h"
#include "num/simd/each_width.h"

dvi__progress dvi__judge(double correction, dvi__trail *trail, const dvi__pace *pace,
                         double unknown, double size)
{
  trail1 t = {{trail->last}, {trail->ratio}, {trail->contraction}, {trail->own}};
  const vector1 now = {correction}, whole = {unknown}, place = {size};
  mask1 verdict;
  judge1(&now, &whole, &place, pace, &t, &verdict);
  *trail = (dvi__trail){t.last[0], trail->last, t.ratio[0], t.contraction[0], t.own[0]};
  return (dvi__progress)verdict[0];
}

double dvi__ratio(double correction, const dvi__trail *trail)
{
  return correction < trail->before ? correction / trail->before : 1;
}

int dvi__unseen(double expected, double unknown)
{
  return expected <= settled * unknown;
}

/* ---- many problems ---- */

typedef void judge_many(int count, const double *correction, const double *unknown,
                        const dvi__pace *pace, const dvi__trails *trails, int64_t *verdicts);

#define LEVEL(suffix, target, width)                                                            \
  target static void judge_##suffix(int count, const double *correction, const double *unknown, \
                                    const dvi__pace *pace, const dvi__trails *trails,           \
                                    int64_t *verdicts)                                          \
  {                                                                                             \
    judge_from1(count, correction, unknown, pace, trails, verdicts,                             \
                judge_from##width(count, correction, unknown, pace, trails, verdicts, 0));      \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2"))), 4)
#endif

/* In the order of num/simd/lanes.c. gcc 12 takes comparisons of 8 numbers apart, one by one. */
static judge_many *const levels[] = {
    judge_baseline,
#ifdef __x86_64__
    judge_avx2,
    judge_avx2,
#endif
};

void dvi__judge_all(int count, const double *correction, const double *unknown,
                    const dvi__pace *pace, const dvi__trails *trails, int64_t *verdicts)
{
  levels[dvi__lanes_level()](count, correction, unknown, pace, trails, verdicts);
}

void dvi__correct(int count, const double *correction, double *x, double *largest_correction,
                  double *largest_x)
{
  for (int i = 0; i < count; i++) x[i] -= correction[i];
  *largest_correction = dvi__largest((size_t)count, correction);
  *largest_x = dvi__largest((size_t)count, x);
  if (isnan(*largest_x)) *largest_correction = HUGE_VAL;
}
