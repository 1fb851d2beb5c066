/* The named parts of a mesh. */
#ifndef DVI_FIELD_MESH_PART_H
#define DVI_FIELD_MESH_PART_H
#include "field/mesh/mesh.h"

/* Make the parts "all" and "boundary", then those that are declared. */
dvi_status dvi__parts_create(dvi_mesh *mesh, const dvi_mesh_terms *terms);
void dvi__parts_clear(dvi_mesh *mesh);

#endif
