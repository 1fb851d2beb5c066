/* How far an iteration has come: one verdict for the solver's own loops, and for loops over many
 * problems side by side, which must stop where each of them would stop alone. */
#ifndef DVI_SOLVE_PROGRESS_H
#define DVI_SOLVE_PROGRESS_H
#include <stdint.h>

typedef enum dvi__progress { DVI__GO_ON, DVI__CONVERGED, DVI__STALLED } dvi__progress;

/* How an iteration is expected to go. */
typedef struct dvi__pace {
  /* a correction above this part of the last one, both below the noise, is noise alone */
  double stagnant;
  /* corrections below it may be rounding noise; relative to the numbers that are added */
  double noise;
  double slowest; /* a correction above this part of what was to be feared ends the iteration */
  /* it contracts by about one factor, of several modes that may hide each other; else faster and
   * faster */
  int steady;
  /* what counts is the next correction's own part: the step takes nothing from the point before the
   * last */
  int ahead;
} dvi__pace;

/* What an iteration has gone through; 0: not yet. Below the noise nothing can be measured: there
 * the contraction that was seen above it goes on. */
typedef struct dvi__trail {
  double last, before; /* the corrections before the one at hand */
  double ratio;        /* the last one measured of two corrections */
  double contraction;  /* by which the iteration's own part shrinks */
  /* what may be left of that part: a correction may be small by chance, where complex modes turn */
  double own;
} dvi__trail;

/* Judge one correction and add it to the trail: converged at the roundoff floor, or stalled above
 * it. `unknown` and `size` are the sizes of the unknowns and of what they are added to. */
dvi__progress dvi__judge(double correction, dvi__trail *trail, const dvi__pace *pace,
                         double unknown, double size);

/* The ratio of a correction to the one before, after the verdict; 1 if there is none, or it grows.
 * Whether one that is expected would be below the roundoff floor. */
double dvi__ratio(double correction, const dvi__trail *trail);
int dvi__unseen(double expected, double unknown);

/* Iterations of many problems, [count] each: what they have gone through, as a dvi__trail has it
 * (without `before`), and their sizes. */
typedef struct dvi__trails {
  double *last, *ratio, *contraction, *own;
  double *size;
} dvi__trails;

/* The same for all of them: verdicts[k] is dvi__judge's on problem k. */
void dvi__judge_all(int count, const double *correction, const double *unknown,
                    const dvi__pace *pace, const dvi__trails *trails, int64_t *verdicts);

/* What the fixed point rung (nonlinear.h) judges by, with `patient` as there; `sweeps`: by the
 * equations' own variables. Its most iterations. */
dvi__pace dvi__fixed_point_pace(int patient, int sweeps);
int dvi__fixed_point_most(int patient);

#endif
