/** Points of a sweep: all combinations of values of parameters. */
#ifndef GRID_H
#define GRID_H
#include "cli/options.h"
#include "problem.h"

enum { GRID_SETTING_SIZE = 128 };

/** A parameter and its values. */
typedef struct grid_axis {
  char name[GRID_SETTING_SIZE];
  long count;
  /** the values as the user spelled them, with commas between them; NULL: they are numbers */
  const char *list;
  double *value; /**< [count] then */
} grid_axis;

/** The axes; the last one's value changes from point to point. */
typedef struct grid {
  int axes;
  grid_axis axis[WORDS_MAX];
  long points; /**< set by grid_complete */
} grid;

/** A point's settings, "name=value", in the order of the axes. */
typedef struct grid_point {
  words settings;
  char text[WORDS_MAX][GRID_SETTING_SIZE];
} grid_point;

/** Read the axes of NAME=V1,V2,.. and NAME=FROM:TO:COUNT. Returns DONE, or complains and returns
 * the exit code. */
int grid_read(const words *settings, grid *read);

/** The settings that are the same at all points of the options. */
void grid_fixed(const grid *of, grid_point *point);

/** Put the axes that the problem's scene asks for in front, with the options' values where these
 *  name them, too; check that the problem has the parameters, and count the points. In the same
 *  manner. */
int grid_complete(const problem *scene, grid *all);

/** The settings of point k, from 0. */
void grid_at(const grid *of, long k, grid_point *point);

void grid_clear(grid *old);
#endif
