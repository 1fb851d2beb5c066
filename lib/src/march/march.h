/* A run of anything that advances in time: mechanics now, fields that are stepped asynchronously,
 * or ensembles. The loop knows times, events, observers and checkpoints, but no coordinates. */
#ifndef DVI_MARCH_MARCH_H
#define DVI_MARCH_MARCH_H
#include <dvi/run.h>

/* An event whose function the loop watches. */
typedef struct dvi__watched {
  int direction, terminal;
} dvi__watched;

/* What advances. All functions get `of`; those without a comment on NULL are needed. */
typedef struct dvi__marcher {
  double (*time)(const void *of);

  /* The time left to t_end, to the last digit that the clock knows. */
  double (*left)(const void *of, double t_end);

  /* Steps that were taken so far, by whom ever. */
  long (*steps)(const void *of);

  /* Take one step of h, not past t_end. What chooses the lengths of its steps ends exactly at
   * t_end, within `tolerance`, if its step would lead there or past it. On failure nothing
   * changes. */
  dvi_status (*advance)(void *of, double h, double t_end, double tolerance);

  /* Take the last step back, once; the same for a step that succeeded while what followed did not:
   * the status is passed on, and its sentence says so. */
  void (*take_back)(void *of);
  dvi_status (*reject)(void *of, dvi_status status);

  /* The event k, its function at a time within the last step, and at the start of the run before
   * any step; NULL without events. */
  dvi__watched (*event)(const void *of, int k);
  dvi_status (*value)(void *of, int k, double t, double *g);
  dvi_status (*value_at_start)(void *of, int k, double *g);

  /* The event k has occurred at t. *returned: as dvi_event's `occurred`. */
  dvi_status (*occurred)(void *of, int k, double t, int *returned);

  /* Show the present state to the program's observer; NULL: there is none. */
  int (*observe)(void *of);

  /* Write the state to a file. */
  dvi_status (*save)(const void *of, const char *path);
} dvi__marcher;

typedef struct dvi__march_options {
  double h, t_end;
  int chooses_steps;  /* `advance` chooses the lengths of its steps */
  int counts_by_time; /* t_end - t over h tells how many steps there will be */
  long every;         /* steps between calls of the observer; 0: 1 */
  int event_count;
  const char *checkpoint;
  long checkpoint_every;
  const volatile int *cancel;
} dvi__march_options;

/* Check the options against the time, and run to t_end (dvi/run.h). */
dvi_status dvi__march(void *of, const dvi__marcher *marcher, const dvi__march_options *options,
                      dvi_run_report *report);

#endif
