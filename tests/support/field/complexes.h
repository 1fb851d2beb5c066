/* Complexes for tests whose vertices are those of a regular simplex, so that all edges have the
 * length sqrt 2. */
#ifndef TESTS_SUPPORT_FIELD_COMPLEXES_H
#define TESTS_SUPPORT_FIELD_COMPLEXES_H
#include <dvi/mesh.h>

/* The projective plane of 6 vertices. */
dvi_mesh *projective_plane(void);

/* The complex projective plane of 9 vertices (Kuehnel and Banchoff 1983). */
dvi_mesh *complex_projective_plane(void);

/* `count` triangles around vertex 0, a mesh in the plane, and 1 for the lengths of all edges, if
 * `length` [2*count] is not NULL. */
dvi_mesh *fan_mesh(int count, double *length);

#endif
