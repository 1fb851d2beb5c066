/* The topology of an orientable connected surface of triangles: trees, and loops that are left.
 *
 * All vertices of a component of the boundary count as one node. A tree of triangles and a tree of
 * nodes share no edge. The inner edges in neither of both are twice the genus in number, and each
 * closes a loop of triangles (Eppstein 2003). */
#ifndef DVI_FIELD_CONNECTION_SURFACE_H
#define DVI_FIELD_CONNECTION_SURFACE_H
#include "field/mesh/mesh.h"

/* What an edge belongs to. */
typedef enum dvi__edge_role {
  DVI__EDGE_FREE = 0, /* it closes a loop of triangles */
  DVI__EDGE_BOUNDARY,
  DVI__EDGE_OF_TRIANGLES, /* the tree of triangles goes through it */
  DVI__EDGE_OF_NODES      /* the tree of nodes goes along it */
} dvi__edge_role;

typedef struct dvi__surface {
  const dvi_mesh *mesh;
  int64_t nodes;
  int *node;   /* [vertices] */
  int *order;  /* [cells] of the tree of triangles, from its root on */
  int *parent; /* [cells] the corner that the facet to the parent leaves out, -1 for the root */
  char *role;  /* [edges] */
} dvi__surface;

/* Tell whether the mesh is such a surface. DVI_NO_MEMORY. */
dvi_status dvi__is_surface(const dvi_mesh *mesh, int *is_surface);

/* Refuse all other meshes. */
dvi_status dvi__check_surface(const dvi_mesh *mesh);

/* Find the trees, that of triangles from a root. On failure nothing is owned. */
dvi_status dvi__surface_create(const dvi_mesh *mesh, int64_t root, dvi__surface *surface);
void dvi__surface_clear(dvi__surface *surface);

/* Give 1 if the first of an inner edge's triangles has the edge, from its lower to its higher
 * vertex, in its sense, so that the ring of the higher vertex goes from the first triangle to the
 * second one, else -1. */
int dvi__edge_sense(const dvi_mesh *mesh, int64_t edge);

#endif
