/** Views of a mesh at the times of a run's rows, for ParaView: as a list of .vtu files, or as one
 * file of HDF5. */
#ifndef FRAMES_H
#define FRAMES_H
#include <dvi/mesh.h>
#include <stdbool.h>

#include "frames/stored_views.h"

/** The files so far. All zero without any. */
typedef struct frame_list {
  /** of all views, or of the next ones if it moves. NULL in a process that writes none */
  const dvi_mesh *mesh;
  const double *point;   /**< its points, if it moves, otherwise NULL */
  const char *path;      /**< of the list of files, FILE.pvd, or of the only one, FILE.vtkhdf */
  const hdf5_head *head; /**< of FILE.vtkhdf */
  stored_views stored;   /**< that file */
  int count, room;
  double *time; /**< [count] */
  char **name;  /**< [count] FILE_000000.vtu and so on, without folder */
} frame_list;

/** Prepare for views on a mesh, or for none if the path is NULL. If the mesh is no share, only the
 * first of several processes has it and writes. Returns DONE, or complains and
 * returns the exit code. */
int frames_start(frame_list *frames, const char *scene, const dvi_mesh *mesh, const char *path);

/** Take the mesh of the next views, and its points [vertices*space], which have moved. */
void frames_move(frame_list *frames, const dvi_mesh *mesh, const double *point);

/** Return whether views are written. */
bool frames_are_wanted(const frame_list *frames);

/** Write views at a time. Of several processes all call it, with those of their shares if the mesh
 * is one. The first one writes. Complains and returns false if that fails, on all of them. */
bool frames_add(frame_list *frames, double t, int views, const dvi_view *view);

/** Write the list of all files, or close the only one. Complains and returns false if that
 * fails. */
bool frames_keep(frame_list *frames);

void frames_clear(frame_list *frames);
#endif
