#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/finite.h"
#include "num/simd/lanes.h"
#include "num/simd/width.h"
#include "solve/solver_struct.h"

/* The iteration is at the floor when its own part of a correction is well below a rounding. That
 * part counts although the unknowns are then right. The last residual was that of the point before,
 * and the results that a step reads there would err by this part in the same direction in every
 * step (a charge in a magnetic field: energy drift of 1e-17 a step). */
static const double settled = 0.125 * DBL_EPSILON;

/* Where the step reads all results at one point, the next correction must not show. Over 5000 steps
 * of outer-solar, a correction of an eighth of a rounding shows (5e-11). One of this part of a
 * rounding does not (2e-12, from the roundings themselves), nor does it show as energy drift of a
 * stiff oscillator. */
static const double unseen = DBL_EPSILON / 2048;

/* Over many corrections an iteration that goes on contracts at least by its slowest factor, or by
 * this one, whatever two corrections say. */
static const double hardly = 0.98;

#define LOOPS "solve/progress_width.h"
#include "num/simd/each_width.h"

/* The loops' test of one problem, written with branches, because these are foreseen in one
 * iteration. A step of galerkin:degree=8 on kepler takes an eighth less than by a loop of one.
 * Update the history by one correction. */
static inline double update_alone(double correction, double noise, const dvi__criteria *criteria,
                                  dvi__history *t)
{
  const double most = criteria->slowest < hardly ? criteria->slowest : hardly,
               quotient = correction / t->last;
  const int first = t->last == 0, loud = correction > noise;
  const double shrinking = first ? 1 : quotient > most ? most : quotient;
  if (t->last > noise) {
    t->contraction = criteria->steady && !(shrinking > t->ratio) ? t->ratio : shrinking;
    t->ratio = shrinking;
  }
  const int blind = t->contraction == 0;
  const double own = t->contraction * t->own;
  const int renewed = first || blind || (loud && (!criteria->steady || correction > own));
  t->own = renewed ? correction : own;
  return blind ? shrinking : t->contraction;
}

dvi__progress dvi__test_correction(double correction, dvi__history *history,
                                   const dvi__criteria *criteria, double unknown, double size)
{
  const double last = history->last, feared = history->own,
               noise = criteria->noise * (unknown + size);
  const double expected = update_alone(correction, noise, criteria, history);
  const int loud_before = last > noise;
  history->before = last;
  history->last = correction;
  if (!(correction <= DBL_MAX)) return DVI__STALLED;
  if (correction <= noise) {
    const double shows = criteria->ahead ? expected * history->own : history->own;
    const int stagnant = last != 0 && !loud_before && history->contraction == 0 &&
                         correction >= criteria->stagnant * last;
    if (stagnant || shows <= (criteria->ahead ? unseen : settled) * unknown) return DVI__CONVERGED;
  }
  return loud_before && correction > criteria->slowest * feared ? DVI__STALLED : DVI__GO_ON;
}

double dvi__ratio(double correction, const dvi__history *history)
{
  return correction < history->before ? correction / history->before : 1;
}

double dvi__unseen_part(double change)
{
  return settled / change;
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
