/* Components of a mesh. */
#ifndef DVI_FIELD_MESH_CONNECTED_H
#define DVI_FIELD_MESH_CONNECTED_H
#include "field/mesh/mesh.h"

/* Set root [vertices] to the first vertex of each one's component. */
void dvi__find_components(const dvi_mesh *mesh, int *root);

#endif
