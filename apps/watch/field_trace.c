#include "watch/field_trace.h"

#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "plot/plot.h"

enum { CURVES_MOST = 8 };

bool field_trace_start(field_trace *trace, const field_columns *columns)
{
  const size_t series = (size_t)columns->count + 1;
  *trace = (field_trace){.columns = columns, .stride = 1};
  trace->t = calloc((series + 1) * FIELD_TRACE_MAX, sizeof *trace->t);
  if (trace->t == NULL) complain("out of memory");
  trace->y = trace->t != NULL ? trace->t + FIELD_TRACE_MAX : NULL;
  return trace->t != NULL;
}

void field_trace_clear(field_trace *trace)
{
  free(trace->t);
  trace->t = NULL;
}

/* Keep every second row. */
static void thin(field_trace *trace)
{
  trace->count /= 2;
  trace->stride *= 2;
  for (int i = 0; i < trace->count; i++) trace->t[i] = trace->t[2 * i];
  for (int k = 0; k < trace->columns->count; k++)
    for (int i = 0; i < trace->count; i++)
      trace->y[k * FIELD_TRACE_MAX + i] = trace->y[k * FIELD_TRACE_MAX + 2 * i];
}

void field_trace_add(field_trace *trace)
{
  if (trace->t == NULL || trace->seen++ % trace->stride != 0) return;
  if (trace->count == FIELD_TRACE_MAX) thin(trace);
  trace->t[trace->count] = dvi_march_time(trace->columns->march);
  for (int k = 0; k < trace->columns->count; k++)
    trace->y[k * FIELD_TRACE_MAX + trace->count] = trace->columns->number[k];
  trace->count++;
}

bool field_trace_plot(const field_trace *trace, const char *path)
{
  plot_curve curve[CURVES_MOST], change;
  int curves = 0, panels = 0, left_out = 0;
  plot_panel panel[2];
  for (int k = 0; k < trace->columns->count; k++) {
    const char *name = trace->columns->column[k].name;
    double *y = trace->y + k * FIELD_TRACE_MAX;
    const double start = y[0];
    if (strcmp(name, "energy") == 0) {
      for (int i = 0; i < trace->count; i++) y[i] -= start;
      change = (plot_curve){.label = "energy", .count = trace->count, .x = trace->t, .y = y};
      panel[panels++] = (plot_panel){.title = "change of the energy",
                                     .x_label = "t",
                                     .y_label = "change",
                                     .smooth = true,
                                     .curves = 1,
                                     .curve = &change};
    } else if (curves < CURVES_MOST) {
      curve[curves++] = (plot_curve){.label = name, .count = trace->count, .x = trace->t, .y = y};
    } else {
      left_out++;
    }
  }
  if (curves > 0)
    panel[panels++] = (plot_panel){.title = "the field over time",
                                   .x_label = "t",
                                   .y_label = "",
                                   .smooth = true,
                                   .curves = curves,
                                   .curve = curve};
  if (left_out > 0)
    complain("run: --plot leaves out %d columns; --columns chooses others", left_out);
  return plot_write(path, panels, panel);
}
