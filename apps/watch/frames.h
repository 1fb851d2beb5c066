/** The field of a run at the times of its rows, as files for ParaView. */
#ifndef FRAMES_H
#define FRAMES_H
#include <dvi/field.h>
#include <stdbool.h>

#include "problem.h"

/** The files so far. All zero without a field to write. */
typedef struct frame_list {
  const dvi_field *field;
  const char *path; /**< of the list of files, FILE.pvd */
  int count, room;
  double *time; /**< [count] */
  char **name;  /**< [count] FILE_000000.vtu and so on, without folder */
  double *u;    /**< [vertices] */
} frame_list;

/** Prepare for a file, or for none if the path is NULL. Returns DONE, or complains and returns the
 * exit code. */
int frames_start(frame_list *frames, const problem *scene, const char *path);

/** Write the state's field. Complains and returns false if that fails. */
bool frames_add(frame_list *frames, const dvi_integrator *integrator);

/** Write the list of all files. Complains and returns false if that fails. */
bool frames_keep(const frame_list *frames);

void frames_clear(frame_list *frames);
#endif
