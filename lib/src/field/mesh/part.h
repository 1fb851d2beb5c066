/* The named parts of a mesh. */
#ifndef DVI_FIELD_MESH_PART_H
#define DVI_FIELD_MESH_PART_H
#include "field/mesh/mesh.h"

/* Make the parts "all" and "boundary", then those that are declared. */
dvi_status dvi__parts_create(dvi_mesh *mesh, const dvi_mesh_terms *terms);
/* Add a part of the marked cells of a degree to a mesh that nobody shares yet. `marked` has room
 * for the cells of any lower degree, and is overwritten. */
dvi_status dvi__part_add(dvi_mesh *mesh, const char *name, int degree, char *marked);

/* Give a share room for so many parts, in place of those that it has, and then each of them the
 * marked k-cells of each degree. */
dvi_status dvi__parts_resize(dvi_mesh *mesh, int parts);
dvi_status dvi__part_take(dvi_mesh *mesh, int p, const dvi__part *whole, int k, const char *marked);

void dvi__parts_clear(dvi_mesh *mesh);

#endif
