/** The map of a field on a line over space and time, drawn from a run. */
#ifndef FIELD_MAP_H
#define FIELD_MAP_H
#include <dvi/march.h>
#include <dvi/moving.h>

#include "load/quantity.h"
#include "plot/space_map.h"
#include "watch/line_values.h"

/** A map so far. All zero without one. */
typedef struct field_map {
  const problem *scene;
  const char *path; /**< NULL without a map */
  const char *axis;
  quantity shown; /**< of a density or a mesh that moves. Else u, the field's values at vertices */
  const dvi_moving *moving; /**< NULL for a mesh at rest */
  space_map map;
  double *x;         /**< [width] */
  double *q, *p, *v; /**< a state, and its velocities */
  double *U, *rate;  /**< coefficients and rates of a density's fields, or values at vertices, or of
                          all components at the places x on a mesh that moves */
  int64_t vertices;  /**< of the whole mesh of a field without a density, else 0 */
  line_values line;  /**< which gives their values */
  int *order;        /**< [vertices] along the axis */
  double *place, *ascend, *whole; /**< [vertices] places along the axis, and values in their order
                                     and in the mesh's */
} field_map;

/** Prepare a map of a quantity, by default that of quantity_choose, or no map if the path is NULL.
 * Returns DONE, or complains that the field is on no line, and returns the exit code. Call
 * field_map_clear afterwards in any case. */
int field_map_start(field_map *map, const problem *scene, const char *path, const char *quantity);
void field_map_clear(field_map *map);

/** Offer the state of a mechanical method. Complains and returns false if it cannot be shown. */
bool field_map_add_state(field_map *map, double t, const double *q, const double *p);

/** Offer the state of a march. */
bool field_map_add_march(field_map *map, const dvi_march *march);

/** Draw the map, if there is one, and say what it shows. Complains and returns false if it cannot
 * be written. */
bool field_map_draw(const field_map *map);
#endif
