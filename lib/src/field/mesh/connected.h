/* Components of a mesh. */
#ifndef DVI_FIELD_MESH_CONNECTED_H
#define DVI_FIELD_MESH_CONNECTED_H
#include "field/mesh/mesh.h"

/* Return the first member of a set, and shorten the ways to it. parent [members] leads to it. */
int dvi__root_of(int *parent, int i);

/* Make one set of those of two members. Returns 0 if they are one already. */
int dvi__join(int *parent, int a, int b);

/* Set root [vertices] to the first vertex of each one's component. */
void dvi__find_components(const dvi_mesh *mesh, int *root);

#endif
