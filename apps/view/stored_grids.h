/** A series of grids in one file of HDF5, FILE.vtkhdf. */
#ifndef STORED_GRIDS_H
#define STORED_GRIDS_H
#include "module/store.h"
#include "picture/vtu.h"

/** The file. All zero is none. */
typedef struct stored_grids {
  const hdf5_module *module;
  hdf5_views *file;
  hdf5_views_content content;
} stored_grids;

/** Return whether a name is one of such a file. */
bool stored_grids_are_wanted(const char *path);

/** Open a file. Returns DONE, or complains and returns FAILED. */
int stored_grids_open(stored_grids *grids, const char *path);

/** Read the grid of a step. Returns DONE, or complains and returns FAILED. Call vtu_clear
 * afterwards in any case. */
int stored_grids_read(const stored_grids *grids, int64_t step, const char *path, vtu_grid *grid);

void stored_grids_close(stored_grids *grids);
#endif
