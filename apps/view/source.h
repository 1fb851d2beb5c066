/** What a page shows, read from the files of a run. */
#ifndef VIEW_SOURCE_H
#define VIEW_SOURCE_H
#include "cli/options.h"
#include "problem.h"
#include "view/show.h"

/** All that is read for a page. All zero is nothing. */
typedef struct view_source {
  problem *scene;     /**< the scene of the run, owned, or NULL if it is not known */
  series_table table; /**< the rows */
  grid_series series; /**< the grids of a field, and what is drawn of them */
  grid_frames grids;
  view_layout layout; /**< what is drawn of the rows */
  int names;
  int places;        /**< the first of them that is of a definition. 0 without any */
  const char **name; /**< [names] coordinates that the layout is found from */
  int *column;       /**< [names] their columns */
  view_run run;
} view_source;

/** Read the rows of a run of a mechanical system from a CSV file, and find what they mean: by the
 * scene, or by their names alone. `frames` is how many a page may have, and `points` are the
 * scene's definitions that are drawn, too; without names they are where no coordinates are points.
 * Returns DONE, or complains and returns the exit code. Call view_source_clear afterwards in any
 * case. */
int view_source_rows(view_source *source, const char *path, long frames, const words *points);

/** Read the grids of a field from a .pvd file, or one .vtu file, and the rows beside them unless
 * their path is NULL. Fields are as in grid_frames_read. Returns and is cleared likewise. */
int view_source_grids(view_source *source, const char *path, const char *rows, long frames,
                      int fields, const char *const *field);

void view_source_clear(view_source *source);
#endif
