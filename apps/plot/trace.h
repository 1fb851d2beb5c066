/** A thinned record of a run for its plot: bounded memory however long the run. */
#ifndef TRACE_H
#define TRACE_H
#include "csv/columns.h"

enum { TRACE_MAX = 2048, TRACE_PANELS = 3, TRACE_CURVES = 8 };

/** Some columns over time. */
typedef struct trace_panel {
  int curves, left_out;
  int column[TRACE_CURVES]; /**< which of the shown columns */
  double *y[TRACE_CURVES];  /**< [TRACE_MAX] */
} trace_panel;

/** Times, and three panels: the motion, the energy, the other invariants. */
typedef struct run_trace {
  const run_columns *columns;
  trace_panel panel[TRACE_PANELS];
  int count;
  long stride, seen; /**< every stride-th sample is kept */
  double *t;
} run_trace;

/** Choose what is drawn of the columns that a run shows.
 *
 *  Columns that were chosen, by --columns or the scene, are drawn, up to TRACE_CURVES in a
 *  panel. Else it is the first six coordinates, places and angles before directions; entries of
 *  rotation matrices never: of a body that only turns, its velocities. False without memory,
 *  with a complaint. */
bool trace_init(run_trace *trace, const run_columns *columns, bool chosen);
void trace_clear(run_trace *trace);

/** Keep the columns as they were measured, unless they are thinned out. */
void trace_add(run_trace *trace, const dvi_integrator *integrator);

/** The columns over time, and the invariants' change since the start, as an SVG file; say what
 *  is drawn. False, with a complaint, if it cannot be written. */
bool trace_plot(const run_trace *trace, const char *path);
#endif
