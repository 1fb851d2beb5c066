/* One point of a sweep: its run, and its row. */
#ifndef DVI_STUDY_POINT_H
#define DVI_STUDY_POINT_H
#include <dvi/study.h>

/* What the watch of a run keeps. */
typedef struct dvi__watch {
  const dvi_run_options *own; /* the caller's options, whose observer is called, too */
  double *invariant;          /* [invariants] of the last look */
  double *least, *most;       /* [nq] NULL if they are not asked for */
  double first, change;       /* energy at the start, and its largest change */
  int nq;
  int begun;
  dvi_status status; /* status of the evaluation */
} dvi__watch;

/* A point with its row. The row points into the integrator and the watch. */
typedef struct dvi__point {
  dvi_study_run run;
  dvi_study_row row;
  dvi__watch watch;
} dvi__point;

/* Open a point and run it to its end. Failures of its run are left in the row. The status is that
 * of the sweep. Close it in any case. */
dvi_status dvi__point_run(const dvi_study_sweep_options *options, const dvi_study_point *at,
                          dvi__point *point);
void dvi__point_close(const dvi_study_sweep_options *options, dvi__point *point);
#endif
