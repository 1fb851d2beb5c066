#include "trace.h"

#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "plot.h"

bool trace_init(run_trace *trace, int coordinates)
{
  memset(trace, 0, sizeof *trace);
  trace->coordinates = coordinates < TRACE_COORDINATES ? coordinates : TRACE_COORDINATES;
  trace->stride = 1;
  trace->t = calloc(TRACE_MAX, sizeof *trace->t);
  trace->energy = calloc(TRACE_MAX, sizeof *trace->energy);
  bool good = trace->t != NULL && trace->energy != NULL;
  for (int i = 0; i < trace->coordinates; i++) {
    trace->q[i] = calloc(TRACE_MAX, sizeof *trace->q[i]);
    good = good && trace->q[i] != NULL;
  }
  if (!good) {
    complain("out of memory for the plot");
    trace_clear(trace);
  }
  return good;
}

void trace_clear(run_trace *trace)
{
  free(trace->t);
  free(trace->energy);
  for (int i = 0; i < TRACE_COORDINATES; i++) free(trace->q[i]);
  memset(trace, 0, sizeof *trace);
}

/* Keep every other sample, and from now on only every other one. */
static void halve(run_trace *trace)
{
  for (int k = 0; k < TRACE_MAX / 2; k++) {
    trace->t[k] = trace->t[2 * k];
    trace->energy[k] = trace->energy[2 * k];
    for (int i = 0; i < trace->coordinates; i++) trace->q[i][k] = trace->q[i][2 * k];
  }
  trace->count = TRACE_MAX / 2;
  trace->stride *= 2;
}

void trace_add(run_trace *trace, double t, const double *q, double energy)
{
  if (trace->seen++ % trace->stride != 0) return;
  if (trace->count == TRACE_MAX) {
    halve(trace);
    if ((trace->seen - 1) % trace->stride != 0) return;
  }
  trace->t[trace->count] = t;
  trace->energy[trace->count] = energy;
  for (int i = 0; i < trace->coordinates; i++) trace->q[i][trace->count] = q[i];
  trace->count++;
}

bool trace_plot(const run_trace *trace, const char *title, char *const *coordinate, const char *path)
{
  plot_curve curves[TRACE_COORDINATES];
  for (int i = 0; i < trace->coordinates; i++)
    curves[i] = (plot_curve){.label = coordinate[i], .count = trace->count, .x = trace->t, .y = trace->q[i]};
  double *error = calloc(TRACE_MAX, sizeof *error);
  if (error == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  for (int k = 0; k < trace->count; k++) error[k] = trace->energy[k] - trace->energy[0];
  const plot_curve energy = {.count = trace->count, .x = trace->t, .y = error};
  const plot_panel panels[] = {
      {.title = title, .x_label = "t", .y_label = "coordinates", .smooth = true, .curves = trace->coordinates, .curve = curves},
      {.title = "energy - energy at the start", .x_label = "t", .y_label = "error", .smooth = true, .curves = 1, .curve = &energy},
  };
  const bool good = plot_write(path, 2, panels);
  free(error);
  return good;
}
