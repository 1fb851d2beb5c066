/* The faces of a simplex, by the sets of its corners. */
#ifndef DVI_FIELD_MESH_FACES_H
#define DVI_FIELD_MESH_FACES_H
#include "field/mesh/placed.h"

enum { DVI__CORNER_SETS = 1 << DVI__SIMPLEX_CORNERS };

/* Give the corners in a set, ascending. Returns their count. */
int dvi__corners_of_set(int set, int *corner);

/* Give the numbers of the faces of an n-cell of a mesh of simplices. */
void dvi__number_faces(const dvi_mesh *mesh, int64_t cell, int64_t number[DVI__CORNER_SETS]);

#endif
