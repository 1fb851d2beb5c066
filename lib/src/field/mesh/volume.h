/* Edges, volumes and handedness of the cells of a mesh. */
#ifndef DVI_FIELD_MESH_VOLUME_H
#define DVI_FIELD_MESH_VOLUME_H
#include "field/mesh/mesh.h"

/* Give the difference of two points as head + tail without an error, but for 1e-32 of the period of
 * a space that repeats itself. */
void dvi__mesh_exact_difference(const dvi_mesh *mesh, int a, int b, double *head, double *tail);

/* Give the edges [k*space] from the first corner of a k-cell, to all others of a simplex, along the
 * axes of a box. */
void dvi__cell_edges(const dvi_mesh *mesh, int k, int64_t cell, double *edge);

/* Give the determinant of a square matrix of 1 to 4 rows, which is overwritten. */
double dvi__determinant(int n, double *matrix);

/* Give 1 if an n-cell in R^n has the orientation of R^n, -1 if it has not, 0 if its volume
 * vanishes. */
int dvi__cell_handedness(const dvi_mesh *mesh, int64_t cell);

/* Give the volume of a k-cell as that of Euclidean space, at least 0. That of a vertex is 1. */
double dvi__cell_volume(const dvi_mesh *mesh, int k, int64_t cell);

/* Refuse n-cells whose volume vanishes beside their edges, boxes that are not rectangular, and, in
 * a space that repeats itself, edges of half a period and more. */
dvi_status dvi__check_cells(const dvi_mesh *mesh);

#endif
