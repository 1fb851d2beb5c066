/** A thinned record of a run for its plot: bounded memory however long the run. */
#ifndef TRACE_H
#define TRACE_H
#include <stdbool.h>

enum { TRACE_MAX = 2048, TRACE_COORDINATES = 6 };

/** Times, some coordinates, and the energy. */
typedef struct run_trace {
  int coordinates; /**< how many are kept, at most TRACE_COORDINATES */
  int count;
  long stride, seen; /**< every stride-th sample is kept */
  double *t, *energy, *q[TRACE_COORDINATES];
} run_trace;

/** False without memory. */
bool trace_init(run_trace *trace, int coordinates);
void trace_clear(run_trace *trace);

void trace_add(run_trace *trace, double t, const double *q, double energy);

/** Coordinates over time, and the energy's error over time, as an SVG file. False, with a complaint, if it cannot be written. */
bool trace_plot(const run_trace *trace, const char *title, char *const *coordinate, const char *path);
#endif
