/* Drift: the trend of an error that oscillates.
 *
 * Samples of an oscillating error depend on each other, so a straight line through them all would
 * look far more certain than it is. Means over blocks depend on each other much less. The remaining
 * dependence between neighbouring residuals of the line is estimated. It widens the standard error
 * as for a first-order autoregressive series, by sqrt((1 + r) / (1 - r)). The lag-one correlation r
 * of detrended residuals is too small by (2 + 4 r) / m for m blocks on average (Kendall 1954), and
 * is corrected for that. The correction matters for a random walk, the most correlated case. About
 * one walk in seven still exceeds a significance of 3, against four in five without the
 * correction. */
#include <dvi/diagnostics.h>
#include <math.h>
#include <string.h>

enum { FEWEST_BLOCKS = 8 };

void dvi_drift_init(dvi_drift *drift)
{
  memset(drift, 0, sizeof *drift);
  drift->per_block = 1;
}

static void join_neighbours(dvi_drift *drift)
{
  for (int b = 0; b < DVI_DRIFT_BLOCKS / 2; b++) {
    drift->time[b] = drift->time[2 * b] + drift->time[2 * b + 1];
    drift->error[b] = drift->error[2 * b] + drift->error[2 * b + 1];
  }
  drift->blocks = DVI_DRIFT_BLOCKS / 2;
  drift->per_block *= 2;
}

static void open_block(dvi_drift *drift)
{
  if (drift->blocks == DVI_DRIFT_BLOCKS) join_neighbours(drift);
  drift->time[drift->blocks] = drift->error[drift->blocks] = 0;
  drift->filled = 0;
  drift->blocks++;
}

void dvi_drift_add(dvi_drift *drift, double t, double value)
{
  if (drift->count++ == 0) {
    drift->first = value;
    drift->start = t;
  }
  drift->end = t;
  const double error = value - drift->first;
  if (isnan(error) || fabs(error) > drift->largest) drift->largest = fabs(error); /* a NaN stays */
  if (drift->blocks == 0 || drift->filled == drift->per_block) open_block(drift);
  drift->time[drift->blocks - 1] += t;
  drift->error[drift->blocks - 1] += error;
  drift->filled++;
}

/* Compute the means of the full blocks. An unfilled last block would scatter more than the
 * others. */
static int block_means(const dvi_drift *drift, double *time, double *error)
{
  const int full = drift->filled == drift->per_block ? drift->blocks : drift->blocks - 1;
  for (int b = 0; b < full; b++) {
    time[b] = drift->time[b] / (double)drift->per_block;
    error[b] = drift->error[b] / (double)drift->per_block;
  }
  return full > 0 ? full : 0;
}

static double mean_of_blocks(int count, const double *x)
{
  double sum = 0;
  for (int i = 0; i < count; i++) sum += x[i];
  return count ? sum / count : 0;
}

/* Fit a line by least squares and replace the errors by its residuals. Return the slope, and the
 * times' sum of squares in *spread. */
static double fit_line(int count, const double *time, double *error, double *spread)
{
  const double time_mean = mean_of_blocks(count, time), error_mean = mean_of_blocks(count, error);
  double product = 0;
  *spread = 0;
  for (int b = 0; b < count; b++) {
    *spread += (time[b] - time_mean) * (time[b] - time_mean);
    product += (time[b] - time_mean) * (error[b] - error_mean);
  }
  const double slope = *spread > 0 ? product / *spread : 0;
  for (int b = 0; b < count; b++) error[b] -= error_mean + slope * (time[b] - time_mean);
  return slope;
}

/* Return the factor by which correlation of neighbours widens the standard error. The correlation
 * is limited to values that `count` blocks can show. */
static double standard_error_factor(int count, const double *residual, double squares)
{
  double product = 0;
  for (int b = 1; b < count; b++) product += residual[b] * residual[b - 1];
  double correlation = product / squares;
  correlation += (2 + 4 * correlation) / count;
  correlation = fmin(fmax(correlation, 0), 1 - 0.5 / count);
  return sqrt((1 + correlation) / (1 - correlation));
}

static double standard_error(int count, const double *residual, double spread)
{
  double squares = 0;
  for (int b = 0; b < count; b++) squares += residual[b] * residual[b];
  if (count < 3 || squares == 0 || spread == 0) return 0;
  return sqrt(squares / (count - 2) / spread) * standard_error_factor(count, residual, squares);
}

void dvi_drift_result(const dvi_drift *drift, dvi_drift_fit *fit)
{
  double time[DVI_DRIFT_BLOCKS], error[DVI_DRIFT_BLOCKS], spread;
  const int blocks = block_means(drift, time, error);
  fit->largest = drift->largest;
  fit->slope = fit_line(blocks, time, error, &spread);
  fit->deviation = standard_error(blocks, error, spread);
  fit->change = fit->slope * (drift->end - drift->start);
  fit->significance = (double)NAN;
  if (blocks >= FEWEST_BLOCKS)
    fit->significance = fit->slope == 0 ? 0 : fabs(fit->slope) / fit->deviation;
}
