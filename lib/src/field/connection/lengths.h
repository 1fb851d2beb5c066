/* A metric by the lengths of a mesh's edges. */
#ifndef DVI_FIELD_CONNECTION_LENGTHS_H
#define DVI_FIELD_CONNECTION_LENGTHS_H
#include "field/mesh/mesh.h"

/* Refuse meshes without hinges, and metrics and lengths that are not those of space. */
dvi_status dvi__check_metric(const dvi_mesh *mesh, const double *length);

/* Give the lengths [pairs] of the edges of a cell in the order of dvi__pair. */
void dvi__cell_lengths(const dvi_mesh *mesh, const double *length, int64_t cell, double *of_cell);

/* Refuse a cell whose lengths no simplex has. */
dvi_status dvi__refuse_lengths(const dvi_mesh *mesh, const double *length, int64_t cell);

#endif
