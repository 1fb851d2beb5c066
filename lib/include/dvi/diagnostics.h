/** Diagnostics: drift of an invariant, fitted orders, symplecticity and reversibility of a step. */
#ifndef DVI_DIAGNOSTICS_H
#define DVI_DIAGNOSTICS_H
#include <dvi/integrator.h>

/** Blocks of a drift record; the record halves their number by joining neighbours when it is full. */
#define DVI_DRIFT_BLOCKS 64

/** A running record of one quantity along a run: constant memory for any number of samples. Visible so that it can live on the
 *  stack; read it through dvi_drift_result. */
typedef struct dvi_drift {
  double first;                  /**< the first sample; errors are measured from it */
  double largest;                /**< largest |error| */
  double time[DVI_DRIFT_BLOCKS]; /**< sums over each block */
  double error[DVI_DRIFT_BLOCKS];
  long per_block, filled, count; /**< samples a full block holds; in the last block; in all */
  int blocks;
} dvi_drift;

/** Largest error and trend of a recorded quantity. */
typedef struct dvi_drift_fit {
  double largest;      /**< largest |value - first value| */
  double slope;        /**< least-squares trend of the block means, per unit of time */
  double change;       /**< slope times the length of the record */
  double deviation;    /**< standard error of the slope, from the scatter of the block means */
  double significance; /**< |slope| / deviation: below 3 there is no evidence for a drift; NaN with fewer than 8 blocks */
} dvi_drift_fit;

/** An order fitted to errors. */
typedef struct dvi_order_fit {
  double slope;    /**< of log error over log h in the window */
  int first, last; /**< the window: indices into the arrays; first = -1 if there is none */
} dvi_order_fit;

#ifdef __cplusplus
extern "C" {
#endif

/** Start a record. */
void dvi_drift_init(dvi_drift *drift);

/** Add a sample: the quantity's value at time t. */
void dvi_drift_add(dvi_drift *drift, double t, double value);

/** Evaluate a record.
 *
 *  Oscillating errors are correlated from sample to sample; the means over (up to 64) blocks are not, so the slope's standard
 *  error comes from them. */
void dvi_drift_result(const dvi_drift *drift, dvi_drift_fit *fit);

/** Fit error = C h^slope over the longest window of consecutive step sizes whose errors lie above the floor and below `ceiling`.
 *
 *  @param      count     number of step sizes
 *  @param      h, error  [count], h positive and descending
 *  @param      floor     errors up to this are judged by roundoff, or by the judge's own error, and left out
 *  @param      ceiling   errors above this are pre-asymptotic and left out; 0: no such limit
 *  @param[out] fit       the slope and its window
 *  @retval DVI_BAD_SIZE  fewer than two errors lie in a window; fit->slope is NaN */
dvi_status dvi_order(int count, const double *h, const double *error, double floor, double ceiling, dvi_order_fit *fit);

/** How far the map of one step is from symplectic: |M^T J M - J| for its differenced derivative M, in the maximum norm, in
 *  coordinates scaled to unit size.
 *
 *  Differences of 10th order take 20 n steps; up to eight difference sizes are tried, and the smallest defect counts: what differences can
 *  not resolve, about 1e-12, is the floor. A second integrator of the same method takes the steps. Memory (2n)^2 numbers.
 *  @param      integrator  its method and system are used; it is left alone
 *  @param      t, q, p     where
 *  @param      h           the step
 *  @param[out] defect      the defect
 *  @retval (others)  as dvi_integrator_step */
dvi_status dvi_symplecticity(dvi_integrator *integrator, double t, const double *q, const double *p, double h, double *defect);

/** How far `steps` steps of h and as many of -h end from the start: the largest difference in q, relative to max(1,|q|).
 *
 *  @param integrator  left at the end of the way back */
dvi_status dvi_reversibility(dvi_integrator *integrator, double t, const double *q, const double *p, double h, long steps,
                             double *defect);

#ifdef __cplusplus
}
#endif
#endif
