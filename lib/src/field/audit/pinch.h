/* Places where the cells around a vertex or an edge do not hang together. */
#ifndef DVI_FIELD_AUDIT_PINCH_H
#define DVI_FIELD_AUDIT_PINCH_H
#include "field/mesh/mesh.h"

/* Count the vertices, and the edges of simplices in three dimensions and more, whose n-cells are
 * not connected through facets there. `vertex` is such a vertex, or -1. DVI_NO_MEMORY. */
dvi_status dvi__find_pinches(const dvi_mesh *mesh, int64_t *count, int64_t *vertex);

#endif
