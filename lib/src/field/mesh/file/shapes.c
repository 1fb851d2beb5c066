#include "field/mesh/file/shapes.h"

const dvi__shape_facts dvi__shape_facts_of[DVI__SHAPES] = {
    {"point", "points", 0, 1, DVI_SIMPLICES, 15, 1},
    {"line", "lines", 1, 2, DVI_SIMPLICES, 1, 3},
    {"triangle", "triangles", 2, 3, DVI_SIMPLICES, 2, 5},
    {"quadrangle", "quadrangles", 2, 4, DVI_BOXES, 3, 8},
    {"tetrahedron", "tetrahedra", 3, 4, DVI_SIMPLICES, 4, 10},
    {"hexahedron", "hexahedra", 3, 8, DVI_BOXES, 5, 11},
};

dvi__shape dvi__shape_of(dvi_cell_kind kind, int k)
{
  static const dvi__shape shape[2][4] = {
      {DVI__POINT, DVI__LINE, DVI__TRIANGLE, DVI__TETRAHEDRON},
      {DVI__POINT, DVI__LINE, DVI__QUADRANGLE, DVI__HEXAHEDRON},
  };
  return shape[kind == DVI_BOXES][k];
}

int dvi__corner_in_file(dvi__shape shape, int place)
{
  static const int around[DVI__SHAPE_CORNERS] = {0, 1, 3, 2, 4, 5, 7, 6};
  return dvi__shape_facts_of[shape].kind == DVI_BOXES ? around[place] : place;
}
