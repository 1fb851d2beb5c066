/* The points and cells of a generated mesh, before it is one. */
#ifndef DVI_FIELD_MESH_GENERATE_DRAFT_H
#define DVI_FIELD_MESH_GENERATE_DRAFT_H
#include "field/mesh/mesh.h"

enum { DVI__SIDES = 8 };

typedef struct dvi__draft {
  dvi_mesh_terms terms;
  double *point; /* terms.point */
  int *vertex;   /* terms.vertex */
  double period[DVI_MESH_SPACE_MAX];
  unsigned char *side;          /* [points] bit i: the point lies on side i */
  const char *name[DVI__SIDES]; /* of the parts of the boundary, NULL for none */
} dvi__draft;

/* Options with all defaults filled in. */
typedef dvi_generator_options dvi__sizes;

/* Allocate the arrays. `generator` is for messages. DVI_BAD_OPTION if an int cannot number the
 * points or the corners of the cells. */
dvi_status dvi__draft_allocate(dvi__draft *draft, const char *generator, double points,
                               double cells);

/* Give the number of points of a grid along an axis, and the place of one of them. */
int dvi__nodes_along(const dvi__sizes *sizes, int axis);
double dvi__node_at(const dvi__sizes *sizes, int axis, int node);

/* The generators. They fill in a draft by sizes that have been checked. */
typedef dvi_status dvi__generator(const dvi__sizes *sizes, dvi__draft *draft);
dvi__generator dvi__generate_box, dvi__generate_kuhn, dvi__generate_staggered;
dvi__generator dvi__generate_bcc, dvi__generate_disk, dvi__generate_annulus;
dvi__generator dvi__generate_icosphere, dvi__generate_torus, dvi__generate_genus;
dvi__generator dvi__generate_cylinder, dvi__generate_ball;
dvi__generator dvi__generate_simplex_4, dvi__generate_simplex_5, dvi__generate_cell_16;
dvi__generator dvi__generate_cell_600, dvi__generate_cross_5;

/* Fill in the triangles between two rows of points around an axis, of which those in odd rows are
 * turned by half of an edge. Row j has the points j*around and so on. Returns the end. */
int *dvi__band_fill(int around, int row, int next, int *vertex);

/* The corners of the unit sphere's icosahedron, and its triangles. */
extern const int dvi__icosahedron[20][3];
void dvi__icosahedron_points(double *point);

#endif
