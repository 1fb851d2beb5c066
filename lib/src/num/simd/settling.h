/* The test of convergence of one iteration, for loops that do not call a function for it. Its
 * criteria and what it means stand in solve/progress.h. */
#ifndef DVI_NUM_SIMD_SETTLING_H
#define DVI_NUM_SIMD_SETTLING_H
#include <float.h>

typedef enum dvi__progress { DVI__GO_ON, DVI__CONVERGED, DVI__STALLED } dvi__progress;

/* Criteria of convergence, which depend on how an iteration is expected to go. */
typedef struct dvi__criteria {
  /* a correction above this part of the last one, both below the noise, is noise alone */
  double stagnant;
  /* corrections below it may be rounding noise, relative to the numbers that are added */
  double noise;
  double slowest; /* a correction above this part of the largest expected one ends the iteration */
  /* the iteration contracts by about one factor, of several modes that may hide each other, rather
   * than faster and faster */
  int steady;
  /* the next correction's own part counts, because the step reads nothing at the point before the
   * last */
  int ahead;
} dvi__criteria;

/* The history of an iteration, 0 before it starts. Below the noise nothing can be measured, and the
 * contraction that was seen above it is taken to go on. */
typedef struct dvi__history {
  double last, before; /* corrections before the current one */
  double ratio;        /* last measured ratio of two corrections */
  double contraction;  /* factor by which the iteration's own part of a correction shrinks */
  /* bound on that part; a correction may be small by chance, where complex modes turn */
  double own;
} dvi__history;

/* The iteration is at the floor when its own part of a correction is well below a rounding. That
 * part counts although the unknowns are then right. The last residual was that of the point before,
 * and the results that a step reads there would err by this part in the same direction in every
 * step (a charge in a magnetic field: energy drift of 1e-17 a step). */
static const double dvi__settled = 0.125 * DBL_EPSILON;

/* Where the step reads all results at one point, the next correction must not show. Over 5000 steps
 * of outer-solar, a correction of an eighth of a rounding shows (5e-11). One of this part of a
 * rounding does not (2e-12, from the roundings themselves), nor does it show as energy drift of a
 * stiff oscillator. */
static const double dvi__unseen = DBL_EPSILON / 2048;

/* Over many corrections an iteration that goes on contracts at least by its slowest factor, or by
 * this one, whatever two corrections say. */
static const double dvi__hardly = 0.98;

/* The loops' test of one problem, written with branches, because these are foreseen in one
 * iteration. A step of galerkin:degree=8 on kepler takes an eighth less than by a loop of one.
 * Update the history by one correction. */
static inline double dvi__settling_update(double correction, double noise,
                                          const dvi__criteria *criteria, dvi__history *t)
{
  const double most = criteria->slowest < dvi__hardly ? criteria->slowest : dvi__hardly,
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

static inline dvi__progress dvi__settling_test(double correction, dvi__history *history,
                                               const dvi__criteria *criteria, double unknown,
                                               double size)
{
  const double last = history->last, feared = history->own,
               noise = criteria->noise * (unknown + size);
  const double expected = dvi__settling_update(correction, noise, criteria, history);
  const int loud_before = last > noise;
  history->before = last;
  history->last = correction;
  if (!(correction <= DBL_MAX)) return DVI__STALLED;
  if (correction <= noise) {
    const double shows = criteria->ahead ? expected * history->own : history->own;
    const int stagnant = last != 0 && !loud_before && history->contraction == 0 &&
                         correction >= criteria->stagnant * last;
    if (stagnant || shows <= (criteria->ahead ? dvi__unseen : dvi__settled) * unknown)
      return DVI__CONVERGED;
  }
  return loud_before && correction > criteria->slowest * feared ? DVI__STALLED : DVI__GO_ON;
}

#endif
