/* The shapes of cells in files, with the numbers by which formats call them. */
#ifndef DVI_FIELD_MESH_FILE_SHAPES_H
#define DVI_FIELD_MESH_FILE_SHAPES_H
#include <dvi/mesh.h>

typedef enum dvi__shape {
  DVI__POINT,
  DVI__LINE,
  DVI__TRIANGLE,
  DVI__QUADRANGLE,
  DVI__TETRAHEDRON,
  DVI__HEXAHEDRON,
  DVI__SHAPES
} dvi__shape;

enum { DVI__SHAPE_CORNERS = 8 };

/* What is known of a shape. */
typedef struct dvi__shape_facts {
  const char *name, *names;
  int dimension, corners;
  dvi_cell_kind kind; /* of points and lines DVI_SIMPLICES */
  int msh, vtk;       /* types of elements */
} dvi__shape_facts;
extern const dvi__shape_facts dvi__shape_facts_of[DVI__SHAPES];

/* Give the shape of k-cells, k from 0 to 3. */
dvi__shape dvi__shape_of(dvi_cell_kind kind, int k);

/* Files go around a quadrangle, and around the lower side of a box and then its upper one. Give the
 * corner of the mesh's cell that stands at a place in the file. The map is its own inverse. */
int dvi__corner_in_file(dvi__shape shape, int place);

#endif
