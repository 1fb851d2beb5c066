/* The n-cells at each facet, and what they say about the mesh. */
#ifndef DVI_FIELD_MESH_COFACE_H
#define DVI_FIELD_MESH_COFACE_H
#include "field/mesh/mesh.h"

/* Find the n-cells at each facet. Two n-cells with the same vertices are an error. */
dvi_status dvi__coface_build(dvi_mesh *mesh);

/* Orient the n-cells coherently. In R^n they get the orientation of R^n, and a cell that lies on
 * its neighbour's side of their common facet is an error. Elsewhere each component follows the
 * first of its cells, whose orientation `given` [cells] tells (dvi_mesh_terms). */
dvi_status dvi__coface_orient(dvi_mesh *mesh, const int8_t *given);

#endif
