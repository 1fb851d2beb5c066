/** A thinned record of a field's run for its plot. Its memory is bounded for runs of any length. */
#ifndef FIELD_TRACE_H
#define FIELD_TRACE_H
#include "watch/field_columns.h"

enum { FIELD_TRACE_MAX = 4096 };

/** Rows at equal distances. */
typedef struct field_trace {
  const field_columns *columns;
  int count;
  long stride, seen; /**< interval of kept rows, and number of rows so far */
  double *t, *y;     /**< [FIELD_TRACE_MAX], [columns][FIELD_TRACE_MAX] */
} field_trace;

/** Prepare for the columns that a run shows. Complains and returns false without memory. */
bool field_trace_start(field_trace *trace, const field_columns *columns);
void field_trace_clear(field_trace *trace);

/** Keep the columns as they were measured, unless they are thinned out. */
void field_trace_add(field_trace *trace);

/** Draw the energy's change since the start, and the other columns, over time into an SVG file.
 * Complains and returns false if it cannot be written. */
bool field_trace_plot(const field_trace *trace, const char *path);
#endif
