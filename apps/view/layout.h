/** What a state's numbers mean to the eye: points, bodies and chains, as the names of the
 * coordinates tell them. */
#ifndef VIEW_LAYOUT_H
#define VIEW_LAYOUT_H
#include <stdbool.h>
#include <stddef.h>

#include "cli/spelling.h"

enum { VIEW_NAME = 64, VIEW_NONE = -1 };

/** A point that moves. Each of its places in space is a coordinate, or stands still. */
typedef struct view_point {
  char name[VIEW_NAME];
  int from[3];     /**< the coordinates, or VIEW_NONE */
  double fixed[3]; /**< the places without a coordinate */
} view_point;

/** A rigid body: a rotation matrix of nine coordinates, row by row, and the place of its origin. */
typedef struct view_body {
  char name[VIEW_NAME];
  int rotation; /**< the first of the coordinates */
  int point;    /**< where its origin is, or VIEW_NONE for the origin of space */
  double mass, second[6], centre[3]; /**< as moments_find finds them. 0 if not known */
} view_body;

/** Two points, or one and the origin of space, VIEW_NONE, with a line between them. */
typedef struct view_link {
  int from, to;
} view_link;

/** All that moves. */
typedef struct view_layout {
  int points, bodies, links, link_room;
  view_point *point; /**< [points] */
  view_body *body;   /**< [bodies] */
  view_link *link;   /**< [links] */
  int *owner;        /**< [coordinates] the point that a coordinate moves, or VIEW_NONE */
  bool is_plane;     /**< all of it lies in the plane z = 0 */
  bool is_state;     /**< there is one point alone, of the first numbers */
  bool is_chain;     /**< the points are numbers at equal distances */
} view_layout;

/** Find points and bodies among coordinates, whose names `name_at` gives. x and y make points, R_11
 * to R_33 bodies, and cos and sin angles. Without any of them numbered names make a chain or a net,
 * which shows its numbers as heights, and the first two or three numbers of all others a point.
 * Returns false without memory. Call layout_clear afterwards in any case. */
bool layout_find(int coordinates, word_at name_at, const void *list, view_layout *layout);

/** Link two points. Returns false without memory. */
bool layout_link(view_layout *layout, int from, int to);

/** Return the number of the point of a name, or VIEW_NONE. */
int layout_point(const view_layout *layout, const char *name);

void layout_clear(view_layout *layout);
#endif
