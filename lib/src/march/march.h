/* A run of an object that advances in time. The integrator is the only one so far
 * (integrator/run.c), and ensembles have a loop of their own. The loop knows times, events,
 * observers and checkpoints, but no coordinates. */
#ifndef DVI_MARCH_MARCH_H
#define DVI_MARCH_MARCH_H
#include <dvi/run.h>

/* An event whose function the loop watches. */
typedef struct dvi__watched {
  int direction, terminal;
} dvi__watched;

/* The functions of an object that advances. All functions get the object `of`. Functions are
 * required unless a comment allows NULL. */
typedef struct dvi__marcher {
  double (*time)(const void *of);

  /* Return the time left to t_end, to the last digit of the clock. */
  double (*left)(const void *of, double t_end);

  /* Return the number of steps of the object so far, in this run and before. */
  long (*steps)(const void *of);

  /* Take one step of h, not past t_end. An object that chooses the lengths of its steps ends
   * exactly at t_end, within `tolerance`, if its step would lead there or past it. On failure
   * nothing changes. */
  dvi_status (*advance)(void *of, double h, double t_end, double tolerance);

  /* Take the last step back. Allowed once a step. */
  void (*take_back)(void *of);

  /* Take back a step that succeeded while its events failed. The status is passed on, and its
   * sentence says so. */
  dvi_status (*reject)(void *of, dvi_status status);

  /* Return the event k, its function at a time within the last step, and its function at the start
   * of the run before any step. NULL without events. */
  dvi__watched (*event)(const void *of, int k);
  dvi_status (*value)(void *of, int k, double t, double *g);
  dvi_status (*value_at_start)(void *of, int k, double *g);

  /* Report that the event k has occurred at t. *returned is the result of dvi_event's
   * `occurred`. */
  dvi_status (*occurred)(void *of, int k, double t, int *returned);

  /* Show the present state to the program's observer. NULL if there is none. */
  int (*observe)(void *of);

  /* Write the state to a file. */
  dvi_status (*save)(const void *of, const char *path);

  /* Take up to `count` steps of h with nothing between them, perhaps in one pass through memory,
   * and give their number. An ordinary step of h must follow. NULL if that is never possible. */
  dvi_status (*advance_together)(void *of, double h, long count, long *taken);
  int keeps_rows; /* it keeps what `observe` keeps, after the same steps */
} dvi__marcher;

typedef struct dvi__march_options {
  double h, t_end;
  int chooses_steps;  /* `advance` chooses the lengths of its steps */
  int counts_by_time; /* the number of steps is (t_end - t) / h */
  long every;         /* observer interval in steps (default 1) */
  int event_count;
  const char *checkpoint;
  long checkpoint_every;
  const volatile int *cancel;
} dvi__march_options;

/* Return the distance by which a sum of steps up to t may miss the end, a few roundings of the
 * times. */
double dvi__clock_error(double t, double t_end);

/* Check the options against the time, and run to t_end (dvi/run.h). */
dvi_status dvi__march(void *of, const dvi__marcher *marcher, const dvi__march_options *options,
                      dvi_run_report *report);

#endif
