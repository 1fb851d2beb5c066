/* Normals of the facets of a mesh. */
#ifndef DVI_FIELD_MESH_NORMAL_H
#define DVI_FIELD_MESH_NORMAL_H
#include "field/mesh/mesh.h"

/* Give the unit normal [space] of a facet that points out of one of its n-cells. */
void dvi__facet_normal(const dvi_mesh *mesh, int64_t facet, int64_t cell, double *normal);

/* Give the place of a facet's centre in one of its n-cells, as dvi_form_evaluate takes it. */
void dvi__facet_place(const dvi_mesh *mesh, int64_t facet, int64_t cell, double *place);

#endif
