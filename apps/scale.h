/** dvi bench --scale: what a step costs as the problem grows. */
#ifndef SCALE_H
#define SCALE_H
#include "options.h"

/** What is asked for. */
typedef struct scale_request {
  const char *problem;
  const char *sizes; /**< "ell=100,1000": a parameter of the problem and its values; or "threads=1,2": a key of the methods */
  const words *methods, *settings;
  double h; /**< NaN: the problem's */
  long rounds;
  long steps; /**< timed from the start; 0: 32 */
  const char *csv, *plot;
} scale_request;

/** Measure and report. Returns an exit code. */
int scale_run(const scale_request *request);
#endif
