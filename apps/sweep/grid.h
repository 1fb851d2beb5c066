/** The points of a sweep, which are all combinations of values of parameters. */
#ifndef GRID_H
#define GRID_H
#include <dvi/study.h>

#include "cli/options.h"
#include "problem.h"

enum { GRID_SETTING_SIZE = 128 };

/** A parameter and its values. */
typedef struct grid_axis {
  char name[GRID_SETTING_SIZE];
  long count;
  /** values as the user spelled them, with commas between them, or NULL for numbers */
  const char *list;
  double *value; /**< [count] values if list is NULL */
} grid_axis;

/** The axes. The last axis's value changes from point to point. */
typedef struct grid {
  int axes;
  grid_axis axis[WORDS_MAX];
  dvi_study_axis study[WORDS_MAX]; /**< the same axes for the library, set by grid_complete */
  long points;                     /**< set by grid_complete */
} grid;

/** A point's settings, "name=value", in the order of the axes. */
typedef struct grid_point {
  words settings;
  char text[WORDS_MAX][GRID_SETTING_SIZE];
} grid_point;

/** Read the axes of NAME=V1,V2,.. and NAME=FROM:TO:COUNT. Returns DONE, or complains and returns
 * the exit code. */
int grid_read(const words *settings, grid *read);

/** Return the settings that are the same at all points of the options. */
void grid_fixed(const grid *of, grid_point *point);

/** Put the axes that the problem's scene asks for in front, check that the problem has the
 * parameters, and count the points. Where the options name an axis of the scene, their values
 * count. Returns DONE, or complains and returns the exit code. */
int grid_complete(const problem *scene, grid *all);

/** Return the settings of the point with these indices [axes]. */
void grid_at(const grid *of, const int64_t *index, grid_point *point);

void grid_clear(grid *old);
#endif
