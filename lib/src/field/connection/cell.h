/* One n-simplex, laid into R^n with its frame, in twice the digits. */
#ifndef DVI_FIELD_CONNECTION_CELL_H
#define DVI_FIELD_CONNECTION_CELL_H
#include "field/mesh/placed.h"

/* Lengths are divided by a power of two, so that the longest edge from corner 0 is below 1. */
typedef struct dvi__laid_cell {
  int n, space;
  double frame[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];              /* 0 with lengths */
  dvi__twofold place[DVI__SIMPLEX_CORNERS][DVI_MESH_DIMENSION_MAX];      /* of corner 0 it is 0 */
  dvi__twofold slope[DVI__SIMPLEX_CORNERS][DVI_MESH_DIMENSION_MAX];      /* grad lambda_i */
} dvi__laid_cell;

/* Lay out a cell whose edges have given lengths [edges], or NULL for those between its points. The
 * frame is Gram and Schmidt's of the edges from corner 0, with the mesh's orientation.
 * DVI_BAD_ARGUMENT if no simplex has such lengths. */
dvi_status dvi__lay_cell(const dvi_mesh *mesh, const double *length, int64_t cell,
                         dvi__laid_cell *laid);

/* Give the dihedral angle between the facets without corner i and without corner j. */
dvi__twofold dvi__laid_angle(const dvi__laid_cell *laid, int i, int j);

/* Give orthonormal vectors of a facet, and its outer normal last, in the cell's frame. Equal facets
 * of two cells have equal vectors. */
void dvi__facet_basis(const dvi__laid_cell *laid, int slot,
                      dvi__twofold basis[][DVI_MESH_DIMENSION_MAX]);

/* Give orthonormal vectors of the plane normal to the hinge without corners i and j, in the cell's
 * frame: `along` the facet with corner i, and `across` it, into the cell. */
void dvi__normal_plane(const dvi__laid_cell *laid, int i, int j, double *along, double *across);

#endif
