/* The k-cells of all degrees below that of a mesh's cells, and their incidence. */
#ifndef DVI_FIELD_MESH_COMPLEX_H
#define DVI_FIELD_MESH_COMPLEX_H
#include "field/mesh/mesh.h"

/* Make count, corner, facet and sign of the degrees below n, from the corners of the n-cells. Two
 * equal n-cells, and two boxes that share corners but not a face, are errors. */
dvi_status dvi__complex_build(dvi_mesh *mesh);

/* Find the k-cell with these vertices, in any order. -1 if there is none. The cells of a mesh
 * are sorted, except those of degree n, for which k must be smaller than n. */
int64_t dvi__complex_find(const dvi_mesh *mesh, int k, const int *vertex);

#endif
