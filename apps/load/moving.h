/** What is shown of a field on a mesh that moves: the mesh of a state, and values at its nodes. */
#ifndef MOVING_OF_SCENE_H
#define MOVING_OF_SCENE_H
#include <dvi/moving.h>

#include "problem.h"

/** The nodes as they are at a time, and the values of all components there. */
typedef struct moving_views {
  dvi_mesh *mesh;
  int count;
  dvi_view view[DVI_MOVING_COMPONENTS_MAX];
  double *value; /**< [count][nodes] */
} moving_views;

/** Make them of a state. Returns DONE, or complains and returns the exit code. Call
 * moving_views_clear afterwards in any case. */
int moving_views_make(const problem *scene, double t, const double *q, moving_views *views);
void moving_views_clear(moving_views *views);

/** Write them as CSV, a row for each node with its position. Returns DONE, or complains and returns
 * the exit code. */
int moving_write(const problem *scene, const char *path, const moving_views *views);
#endif
