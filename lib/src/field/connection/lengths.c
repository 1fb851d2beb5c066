#include "field/connection/lengths.h"

#include <math.h>

#include "core/status.h"
#include "field/forms/duals.h"
#include "field/regge/simplex.h"

static dvi_status check_lengths(const dvi_mesh *mesh, const double *length)
{
  for (int64_t e = 0; e < mesh->count[1]; e++)
    if (!(length[e] > 0 && isfinite(length[e])))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: %s has the length %g, and lengths are positive and finite",
                       dvi__name_cell(mesh, 1, e).text, length[e]);
  return DVI_OK;
}

dvi_status dvi__check_metric(const dvi_mesh *mesh, const double *length)
{
  if (mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a mesh is needed");
  if (mesh->kind != DVI_SIMPLICES || mesh->n < 2)
    return dvi__fail(DVI_UNSUPPORTED,
                     "curvature: the mesh has cells of kind '%s', and triangles, tetrahedra or "
                     "4-simplices are needed: divide boxes as the generator kuhn does",
                     dvi__degree_name(mesh->kind, mesh->n));
  if (mesh->branching >= 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: %s belongs to more than two cells, 2 at most",
                     dvi__name_cell(mesh, mesh->n - 1, mesh->branching).text);
  for (int l = 0; l < mesh->space && length == NULL; l++)
    if (mesh->metric[l] < 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "curvature: axis %d is timelike, and angles are those of space; give the "
                       "lengths of the edges",
                       l);
  return length != NULL ? check_lengths(mesh, length) : DVI_OK;
}

void dvi__cell_lengths(const dvi_mesh *mesh, const double *length, int64_t cell, double *of_cell)
{
  int64_t number[DVI__CORNER_SETS];
  dvi__number_faces(mesh, cell, number);
  for (int i = 0; i <= mesh->n; i++)
    for (int j = i + 1; j <= mesh->n; j++)
      of_cell[dvi__pair(mesh->n, i, j)] = length[number[1 << i | 1 << j]];
}

dvi_status dvi__refuse_lengths(const dvi_mesh *mesh, const double *length, int64_t cell)
{
  int64_t number[DVI__CORNER_SETS];
  double of_cell[DVI__PAIRS];
  int corner[DVI__SIMPLEX_CORNERS];
  dvi__number_faces(mesh, cell, number);
  dvi__cell_lengths(mesh, length, cell, of_cell);
  const int set = dvi__missing_face(mesh->n, of_cell), k = dvi__corners_of_set(set, corner) - 1;
  if (k >= 2 && k < mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: the lengths of the edges of %s, a face of %s, are those of no "
                     "%s, or of a flat one",
                     dvi__name_cell(mesh, k, number[set]).text,
                     dvi__name_cell(mesh, mesh->n, cell).text, dvi__degree_name(DVI_SIMPLICES, k));
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "curvature: the lengths of the edges of %s are those of no %s, or of a flat one",
                   dvi__name_cell(mesh, mesh->n, cell).text,
                   dvi__degree_name(DVI_SIMPLICES, mesh->n));
}
