#include "support/solid/blocks.h"

#include <check.h>

dvi_mesh *graded_block(int n, int cells, double grading)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = n};
  for (int i = 0; i < n; i++) options.cells[i] = cells;
  options.grading[0] = grading;
  ck_assert_msg(dvi_mesh_generate("kuhn", &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

void turning_start(const quad_solid *s, double size, quad *u, quad *v)
{
  for (int i = 0; i < s->size; i += s->n) {
    const quad *X = s->point + i, z = s->n == 3 ? X[2] : X[0];
    for (int j = 0; j < s->n; j++) u[i + j] = 0;
    v[i] = size * X[1] / 5;
    v[i + 1] = -size * z / 10;
    if (s->n == 3) v[i + 2] = 3 * size * X[0] * z / 20;
  }
}
