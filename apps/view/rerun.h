/** A run of a scene for its page, by dvi run, into files that are read and removed. */
#ifndef VIEW_RERUN_H
#define VIEW_RERUN_H
#include "cli/options.h"
#include "problem.h"

/** What dvi run is asked for. */
typedef struct view_rerun {
  const char *name, *method; /**< the scene, and the method or NULL for its own */
  double h, t_end;           /**< NaN for the scene's own */
  long frames;               /**< rows at about this number of times */
  const words *settings;
} view_rerun;

enum { RERUN_PATH = 4096 };

/** The files of the run, in a folder of their own. */
typedef struct view_files {
  char folder[RERUN_PATH], rows[RERUN_PATH + 16], grids[RERUN_PATH + 16];
  bool has_grids;
} view_files;

/** Run the scene, which is open. Returns DONE, or complains and returns the exit code, which after
 * Ctrl-C is that of dvi run, with the files complete. Call view_files_remove afterwards in any
 * case. */
int view_run_scene(const view_rerun *run, problem *scene, view_files *files);
void view_files_remove(view_files *files);
#endif
