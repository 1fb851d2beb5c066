/** Maps of a field on a line over space and time. */
#ifndef SPACE_MAP_H
#define SPACE_MAP_H
#include <stdbool.h>

enum { SPACE_MAP_WIDTH = 400, SPACE_MAP_ROWS = 1024 };

/** The values at equally spaced points, time by time. Of a long run every second row is dropped
 * whenever the map is full, so that its memory is bounded. */
typedef struct space_map {
  int width, rows;
  long stride, seen;
  double from, to; /**< the ends of space */
  double *time;    /**< [SPACE_MAP_ROWS] */
  double *value;   /**< [SPACE_MAP_ROWS][width] */
} space_map;

/** Begin a map from..to in space. Complains and returns false without memory. */
bool space_map_start(space_map *map, double from, double to);
void space_map_clear(space_map *map);

/** Return the place of the values [width] at the time t, or NULL if this row is left out. */
double *space_map_row(space_map *map, double t);

/** Draw the map into an SVG file. Complains and returns false if it cannot be written. */
bool space_map_draw(const space_map *map, const char *path, const char *title, const char *axis);
#endif
