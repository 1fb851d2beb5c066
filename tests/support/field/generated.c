#include "support/field/generated.h"

#include "support/suite.h"

dvi_mesh *generated(const char *name, dvi_generator_options options)
{
  dvi_mesh *mesh = NULL;
  options.size = sizeof options;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

dvi_mesh *grid_mesh(const char *name, int dimension, int cells, double grading)
{
  dvi_generator_options options = {.dimension = dimension};
  for (int i = 0; i < dimension; i++) options.cells[i] = cells;
  for (int i = 0; i < dimension; i++) options.grading[i] = grading;
  return generated(name, options);
}
