/** Views of a mesh in one file of HDF5, as VTK's readers take them (VTKHDF). */
#ifndef STORED_VIEWS_H
#define STORED_VIEWS_H
#include <dvi/mesh.h>
#include <stdbool.h>

#include "picture/vtu.h"
#include "module/store.h"

/** The file. All zero before the first views. */
typedef struct stored_views {
  whole_file file; /**< before its first views are in it */
  hdf5_frames *frames;
  vtu_grid grid; /**< as it is drawn, with copies of points where space repeats itself */
} stored_views;

/** Add views at a time, to a new file at the path if they are the first ones. A mesh that moves has
 * other points than before. Complains and returns false if that fails. */
bool stored_views_add(stored_views *stored, const char *path, const hdf5_head *head,
                      const dvi_mesh *mesh, bool moves, double t, int views, const dvi_view *view);

/** Close the file. Complains and returns false if what was added is lost. */
bool stored_views_close(stored_views *stored, const char *path);
#endif
