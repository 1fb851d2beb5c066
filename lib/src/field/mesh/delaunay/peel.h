/* Simplices of a triangulation that rounding errors made out of points in one plane. */
#ifndef DVI_FIELD_MESH_DELAUNAY_PEEL_H
#define DVI_FIELD_MESH_DELAUNAY_PEEL_H
#include "field/mesh/delaunay/insertion.h"

/* List the flat simplices, whose volume is at most this part of the product of their edges from any
 * corner. The caller releases the list in any case. */
dvi_status dvi__list_flat(const dvi__triangulation *t, double part, dvi__places *flat);

/* Remove the flat simplices at the hull, as those of points that lie on a side of it up to
 * rounding. Facets between them and others become the hull's. A flat simplex stays if the others
 * would not be a ball without it. The list keeps those that stay and are flat up to `part`. */
dvi_status dvi__peel(dvi__triangulation *t, double part, dvi__places *flat);

#endif
