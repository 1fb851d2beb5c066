/** A field at the times of a run: a series of grids in .vtu files, or in one file of HDF5. */
#ifndef VIEW_GRIDS_H
#define VIEW_GRIDS_H
#include <stdbool.h>
#include <stdint.h>

#include "picture/skin.h"
#include "view/page.h"
#include "view/stored_grids.h"

/** The grids of a series, in the order of time. */
typedef struct grid_series {
  int count, room;
  double *time;        /**< [count] */
  char **path;         /**< [count] */
  stored_grids stored; /**< the file that has all of them, or none */
} grid_series;

/** What is drawn of a series: the surface of its first grid, and values at all its times. */
typedef struct grid_frames {
  vtu_grid first;
  skin surface;
  bool moves; /**< the points move */
  int frames, fields;
  int field[VTU_FIELDS];    /**< [fields] of the first grid's */
  float *point;             /**< [frames][points*3], or [points*3] if they stand still */
  float *value[VTU_FIELDS]; /**< [fields][frames][points or cells] */
} grid_frames;

/** Read the list of a series, FILE.pvd, or open FILE.vtkhdf, or take a single FILE.vtu. Returns
 * DONE, or complains and returns the exit code. Call grid_series_clear afterwards in any case. */
int grid_series_read(const char *path, grid_series *series);
void grid_series_clear(grid_series *series);

/** Read the grids `frame` [frames] of a series. If a page has no room for so many, some are left
 * out, and their number and the list become smaller. Fields are those of the names, or without any
 * the first few. Returns DONE, or complains and returns the exit code. Call grid_frames_clear
 * afterwards in any case. */
int grid_frames_read(const grid_series *series, int *frames, int *frame, int names,
                     const char *const *name, grid_frames *grids);
void grid_frames_clear(grid_frames *grids);

/** Write the mesh and its fields as JSON. */
void grid_frames_write(const grid_frames *grids, page *p);

/** Return whether all points have one z. */
bool grid_frames_are_flat(const grid_frames *grids);
#endif
