/** One point of a sweep: the problem made anew with its settings, run, and told in one row. */
#ifndef SWEEP_POINT_H
#define SWEEP_POINT_H
#include <stdio.h>

#include "sweep/grid.h"
#include "problem.h"
#include "load/scene.h"

/** What is the same at all points. */
typedef struct sweep_task {
  const char *operand; /**< a name of the catalogue, or the path that the text was read from */
  scene_text text;     /**< of a scene; else empty */
  const char *method;  /**< NULL: the scene's own */
  double h, t_end;     /**< NaN: the problem's */
  grid grid;
  /** the problem with the settings that are the same at all points: its columns are those of all */
  const problem *model;
} sweep_task;

/** A row, to be freed. NULL: no memory was left for it. */
typedef struct sweep_row {
  char *text;
  bool failed; /**< the point's run did not come to its end */
} sweep_row;

/** The names of the columns, with commas between them. */
void sweep_header(const sweep_task *task, FILE *stream);

/** Run point k. What fails is told in the row, and by a complaint. May be called from several
 * threads at once. */
sweep_row sweep_run(const sweep_task *task, long k);
#endif
