/* Ranks of incidence matrices. */
#ifndef DVI_FIELD_MESH_HOMOLOGY_H
#define DVI_FIELD_MESH_HOMOLOGY_H
#include <dvi/mesh.h>

/* Find the rank of d_k on the forms that vanish on held k-cells, k < n. */
dvi_status dvi__incidence_rank(const dvi_mesh *mesh, int k, const char *held, int64_t *rank);

#endif
