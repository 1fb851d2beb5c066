/** dvi bench --scale: what a step costs as the problem grows, or as a method's key does. */
#ifndef SCALE_H
#define SCALE_H
#include "cli/options.h"

/** What is asked for. */
typedef struct scale_request {
  const char *problem;
  const char *scaled; /**< "ell=100,1000" or "threads=1,2": what is varied, and its values */
  const words *methods, *settings;
  bool one_point; /**< callbacks of the one-point shape */
  double h;       /**< NaN: the problem's */
  long rounds;
  long steps; /**< timed from the start; 0: 32 */
  const char *csv, *plot;
} scale_request;

/** Measure and report. Returns an exit code. */
int scale_run(const scale_request *request);
#endif
