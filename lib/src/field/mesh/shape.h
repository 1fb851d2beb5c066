/* The corners and facets of a single simplex or box. */
#ifndef DVI_FIELD_MESH_SHAPE_H
#define DVI_FIELD_MESH_SHAPE_H
#include <dvi/mesh.h>

enum {
  DVI__CORNERS = 16, /* of a box of four dimensions */
  DVI__FACET_CORNERS = 8,
  DVI__FACETS = 8
};

/* Give the numbers of corners and of facets of a k-cell. */
int dvi__corners(dvi_cell_kind kind, int k);
int dvi__facets(dvi_cell_kind kind, int k);

/* Give the corners of facet `slot` of a k-cell, by their numbers in the cell, in the facet's own
 * order. Facet j of a simplex leaves out corner j. Facets 2a and 2a+1 of a box are at the near and
 * at the far end of its axis a. */
void dvi__facet_corners(dvi_cell_kind kind, int k, int slot, int *corner);

/* Give the sign with which the facet belongs to the boundary of its cell. */
int dvi__facet_sign(dvi_cell_kind kind, int slot);

/* Compare two orders a and b of one set of corners of a k-cell. 1 if they have one orientation, -1
 * if they are opposite, 0 if they are not those of one cell. */
int dvi__relative_orientation(dvi_cell_kind kind, int k, const int *a, const int *b);

#endif
