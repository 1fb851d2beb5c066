/* Exact signs of determinants of points, and what they say about spheres and planes. */
#ifndef DVI_FIELD_MESH_DELAUNAY_PREDICATE_H
#define DVI_FIELD_MESH_DELAUNAY_PREDICATE_H
#include <dvi/mesh.h>

/* Points whose coordinates are multiples of 2^-60 between -1 and 1, so that their differences are
 * integers of 62 bits, and which lie in a box of edge 1. A weight lowers the height to which its
 * point is lifted. */
typedef struct dvi__sites {
  int n;
  int64_t points;
  const double *x;      /* [points*n] */
  const double *weight; /* [points] multiples of 2^-120 from 0 to 1. NULL for none */
} dvi__sites;

/* Give the sign of a simplex's volume, det(x_k - x_0), after its corner `slot` was replaced by
 * point p. */
int dvi__side(const dvi__sites *sites, const int *vertex, int slot, int p);

/* Tell whether point p is inside of the sphere of a simplex of positive volume. A point on the
 * sphere is inside, or not, as if heights had been lowered by infinitely small amounts, by more
 * for points that come first in the order of their coordinates. All grid cubes are thereby divided
 * as Kuhn does, with common diagonals. */
int dvi__is_inside(const dvi__sites *sites, const int *vertex, int p);

#endif
