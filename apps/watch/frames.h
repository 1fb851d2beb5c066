/** Views of a mesh at the times of a run's rows, as files for ParaView. */
#ifndef FRAMES_H
#define FRAMES_H
#include <dvi/mesh.h>
#include <stdbool.h>

/** The files so far. All zero without any. */
typedef struct frame_list {
  const dvi_mesh *mesh; /**< of all files, or of the next one */
  const char *path;     /**< of the list of files, FILE.pvd */
  int count, room;
  double *time; /**< [count] */
  char **name;  /**< [count] FILE_000000.vtu and so on, without folder */
} frame_list;

/** Prepare for a file on a mesh, or for none if the path is NULL. Returns DONE, or complains and
 * returns the exit code. */
int frames_start(frame_list *frames, const char *scene, const dvi_mesh *mesh, const char *path);

/** Return whether files are written. */
bool frames_are_wanted(const frame_list *frames);

/** Write views at a time. Complains and returns false if that fails. */
bool frames_add(frame_list *frames, double t, int views, const dvi_view *view);

/** Write the list of all files. Complains and returns false if that fails. */
bool frames_keep(const frame_list *frames);

void frames_clear(frame_list *frames);
#endif
