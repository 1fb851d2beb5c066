/* Zeros of a function of the trajectory, located on the last step's path. */
#ifndef DVI_METHOD_EVENT_H
#define DVI_METHOD_EVENT_H
#include <dvi/run.h>

/* What an event search keeps between steps. */
typedef struct dvi__watch {
  double *q, *v;  /* [nq], [nv] work */
  double *before; /* [event_count] g at the end of the part of a step that was looked at last */
  double *zero;   /* [event_count * parts] the step's zeros that are not reported yet; NaN: none */
} dvi__watch;

dvi_status dvi__watch_create(dvi_integrator *integrator, const dvi_run_options *options, dvi__watch *watch);
void dvi__watch_destroy(dvi__watch *watch);

/* Find the zeros of the last step, which began at time `from`. Nothing is reported yet: on a failure the step can be taken back. */
dvi_status dvi__watch_find(dvi__watch *watch, dvi_integrator *integrator, const dvi_run_options *options, double from);

/* Call the events' callbacks in the order of time and note them in the report. *stop becomes 1 if one of them ends the run; later ones
 * are then left out. */
dvi_status dvi__watch_report(dvi__watch *watch, dvi_integrator *integrator, const dvi_run_options *options, dvi_run_report *report,
                             int *stop);

#endif
