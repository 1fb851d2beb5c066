/* Zeros of a function of the trajectory, located on the last step's path. */
#ifndef DVI_METHOD_EVENT_H
#define DVI_METHOD_EVENT_H
#include <dvi/run.h>

/* What an event search keeps between steps. */
typedef struct dvi__watch {
  double *q, *v;  /* [nq], [nv] work */
  double *before; /* [event_count] g at the end of the part of a step that was looked at last */
  double *zero;   /* [event_count] the zeros in that part that are not reported yet; NaN: none */
} dvi__watch;

dvi_status dvi__watch_create(dvi_integrator *integrator, const dvi_run_options *options, dvi__watch *watch);
void dvi__watch_destroy(dvi__watch *watch);

/* Find the events of the last step, call their callbacks in the order of time, and note them in the report. *stop becomes 1 if one of
 * them ends the run; later ones are then left out. */
dvi_status dvi__watch_step(dvi__watch *watch, dvi_integrator *integrator, const dvi_run_options *options, double from,
                           dvi_run_report *report, int *stop);

#endif
