/* Zeros of functions of time, located within the last step. */
#ifndef DVI_MARCH_EVENTS_H
#define DVI_MARCH_EVENTS_H
#include "march/march.h"

/* A search for the zeros of all events, with its values between steps. */
typedef struct dvi__event_search {
  void *of;
  const dvi__marcher *marcher;
  int count;
  double *before; /* [count] value at the end of the last part that was searched */
  double *zero;   /* [count * parts] the step's zeros that are not reported yet, or NaN */
} dvi__event_search;

dvi_status dvi__event_search_create(void *of, const dvi__marcher *marcher, int count,
                                    dvi__event_search *search);
void dvi__event_search_clear(dvi__event_search *search);

/* Find the zeros of the last step, which began at time `from`. Nothing is reported yet, so the step
 * can be taken back after a failure. */
dvi_status dvi__event_search_find(dvi__event_search *search, double from);

/* Call the events' callbacks in the order of time, and record the events in the report. *stop
 * becomes 1 if an event ends the run. Later events are then left out. */
dvi_status dvi__event_search_report(dvi__event_search *search, int forward, dvi_run_report *report,
                                    int *stop);

#endif
