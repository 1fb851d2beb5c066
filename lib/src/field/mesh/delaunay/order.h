/* An order in which points are inserted into a triangulation. */
#ifndef DVI_FIELD_MESH_DELAUNAY_ORDER_H
#define DVI_FIELD_MESH_DELAUNAY_ORDER_H
#include "field/mesh/delaunay/predicate.h"

/* Give an order [points] in which neighbours follow each other: rounds of random points, each
 * eight times the one before, sorted along Hilbert's curve (Amenta, Choi and Rote 2003). The
 * caller releases it. NULL if there is no memory. */
int *dvi__insertion_order(const dvi__sites *sites);

#endif
