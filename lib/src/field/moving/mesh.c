/* The mesh of a state, whose points are the nodes as they are. */
#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

/* Give the ends of the cells of an axis [2*cells]. */
static int *line_up(const dvi_moving *m)
{
  int *vertex = DVI_NEW(int, 2 * (size_t)m->cells);
  for (int k = 0; k < 2 * m->cells && vertex != NULL; k++) vertex[k] = (k + 1) / 2;
  return vertex;
}

dvi_status dvi__moving_mesh_of(const dvi_moving *m, const double *node, dvi_mesh **mesh)
{
  const int n = m->dimension;
  int width, *line = n == 1 ? line_up(m) : NULL;
  double *point = DVI_NEW(double, (size_t)n *(size_t)m->listed);
  dvi_status status = point != NULL && (n > 1 || line != NULL) ? DVI_OK : DVI_NO_MEMORY;
  for (int k = 0; k < n * m->listed && status == DVI_OK; k++)
    point[k] = node[k % n * m->listed + k / n];
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .points = m->listed,
                                .point = point,
                                .cells = m->cells,
                                .vertex = n == 1 ? line : dvi_mesh_vertices(m->mesh, n, &width),
                                .period = n == 1 ? NULL : m->period};
  status = status == DVI_OK ? dvi_mesh_create(&terms, mesh)
                            : dvi__fail(status, "moving: no memory for a mesh");
  dvi__release(point);
  dvi__release(line);
  return status;
}

dvi_status dvi_moving_mesh(const dvi_moving *moving, double t, const double *q, dvi_mesh **mesh)
{
  if (moving == NULL || q == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: a field, coordinates and a place for the mesh are needed");
  *mesh = NULL;
  DVI_TRY(dvi__moving_check(moving, &(dvi__moving_state){.t = t, .q = q}));
  double *node = DVI_NEW(double, (size_t)moving->dimension *(size_t)moving->listed);
  if (node == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  dvi_status status = dvi_moving_lift(moving, t, q, node, NULL);
  if (status == DVI_OK) status = dvi__moving_mesh_of(moving, node, mesh);
  dvi__release(node);
  return status;
}
