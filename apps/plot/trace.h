/** A thinned record of a run for its plot. Its memory is bounded for runs of any length. */
#ifndef TRACE_H
#define TRACE_H
#include "csv/columns.h"

enum { TRACE_MAX = 2048, TRACE_PANELS = 3, TRACE_CURVES = 8 };

/** Some columns over time. */
typedef struct trace_panel {
  int curves, left_out;
  int column[TRACE_CURVES]; /**< indices of the shown columns */
  double *y[TRACE_CURVES];  /**< [TRACE_MAX] */
} trace_panel;

/** Times, and three panels for the motion, the energy, and the other invariants. */
typedef struct run_trace {
  const run_columns *columns;
  trace_panel panel[TRACE_PANELS];
  int count;
  long stride, seen; /**< interval of kept samples, and number of samples so far */
  double *t;
} run_trace;

/** Choose which of the columns that a run shows are drawn.
 *
 * Columns that were chosen by --columns or the scene are drawn, up to TRACE_CURVES in a panel. The
 * default is the first six coordinates, places and angles before directions. Entries of rotation
 * matrices are never drawn. The velocities are drawn for a body that only rotates. Complains and
 * returns false without memory. */
bool trace_init(run_trace *trace, const run_columns *columns, bool chosen);
void trace_clear(run_trace *trace);

/** Keep the columns as they were measured, unless they are thinned out. */
void trace_add(run_trace *trace, const dvi_integrator *integrator);

/** Draw the columns over time and the invariants' change since the start into an SVG file, and
 * report what is drawn. Complains and returns false if it cannot be written. */
bool trace_plot(const run_trace *trace, const char *path);
#endif
