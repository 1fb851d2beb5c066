/** One point of a sweep. The problem is created with its settings and run, and the result is one
 * row. */
#ifndef SWEEP_POINT_H
#define SWEEP_POINT_H
#include <stdio.h>

#include "sweep/grid.h"
#include "problem.h"
#include "load/scene.h"

/** The part of a sweep that is the same at all points. */
typedef struct sweep_task {
  const char *operand; /**< name of the catalogue, or path of the text */
  scene_text text;     /**< text of a scene, empty for the catalogue */
  const char *method;  /**< NULL for the scene's own method */
  double h, t_end;     /**< NaN for the problem's values */
  grid grid;
  /** problem with the settings of all points, whose columns are those of all points */
  const problem *model;
} sweep_task;

/** A row, to be freed. NULL without memory. */
typedef struct sweep_row {
  char *text;
  bool failed; /**< the point's run did not come to its end */
} sweep_row;

/** Write the names of the columns, with commas between them. */
void sweep_header(const sweep_task *task, FILE *stream);

/** Make the run of a point, for the library's sweep. Complains if its problem cannot be made. May
 * be called from several threads at once. */
dvi_status sweep_open(const sweep_task *task, const dvi_study_point *at, dvi_study_run *run);

/** Make the row of a run. Complains of a run that failed. */
sweep_row sweep_make_row(const sweep_task *task, const dvi_study_run *run,
                         const dvi_study_row *found);

/** Free what sweep_open made. */
void sweep_close(dvi_study_run *run);
#endif
