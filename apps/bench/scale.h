/** dvi bench --scale, which measures the cost of a step as the problem, or a method's key,
 * grows. */
#ifndef SCALE_H
#define SCALE_H
#include "cli/options.h"

/** The request of a measurement. */
typedef struct scale_request {
  const char *problem;
  /** varied quantity and its values, such as "ell=100,1000" or "threads=1,2" */
  const char *scaled;
  const words *methods, *settings;
  bool one_point; /**< callbacks have the one-point shape */
  double h;       /**< NaN for the problem's step */
  long rounds;
  long steps; /**< number of timed steps from the start (default 32) */
  const char *csv, *plot;
} scale_request;

/** Measure and report. Returns an exit code. */
int scale_run(const scale_request *request);
#endif
