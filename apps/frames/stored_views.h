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

/** Where and when views are written. */
typedef struct frame_place {
  const char *path;
  const hdf5_head *head;
  const double *point; /**< of the mesh, if it has other ones than before, otherwise NULL */
  double t;
} frame_place;

/** Write views to a .vtu file, at the mesh's own points if `point` is NULL. */
dvi_status stored_views_write(const dvi_mesh *mesh, const double *point, const char *path,
                              int views, const dvi_view *view);

/** Add views, to a new file if they are the first ones. The first of several processes writes those
 * of the whole mesh. Complains and returns false if that fails, on all of them. */
bool stored_views_add(stored_views *stored, const frame_place *place, const dvi_mesh *mesh,
                      int views, const dvi_view *view);

/** Close the file. Complains and returns false if what was added is lost. */
bool stored_views_close(stored_views *stored, const char *path);
#endif
