/** What can be seen of a grid from one side: its surface, seen in parallel rays. */
#ifndef SKIN_H
#define SKIN_H
#include "picture/vtu.h"

/** From where a grid is seen, by angles in degrees. */
typedef struct viewpoint {
  bool is_flat; /**< from above, x to the right and y up. The angles do not count then */
  double azimuth, elevation;
} viewpoint;

/** A face, with its corners around it. */
typedef struct skin_face {
  int corners; /**< 3 or 4 */
  int64_t vertex[4], cell;
} skin_face;

/** The surface of a grid, with points that are turned: to the right, up, and towards the eye. */
typedef struct skin {
  int64_t points, faces, edges;
  double *point;   /**< [points*3] */
  skin_face *face; /**< [faces] */
  int64_t *edge;   /**< [edges*2] points */
  double least[3], most[3];
} skin;

/** Return whether all points have one z, so that the grid is flat. */
bool skin_is_flat(const vtu_grid *g);

/** Find the surface: all cells of two dimensions, and the faces that only one cell of three
 * dimensions has. Lines have edges alone. Complains and returns false without memory. */
bool skin_make(const vtu_grid *g, const viewpoint *from, skin *s);

/** Turn a vector as the points are turned. */
void skin_turn(const viewpoint *from, const double *vector, double *turned);

void skin_clear(skin *s);
#endif
