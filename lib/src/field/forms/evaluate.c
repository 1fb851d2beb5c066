/* Whitney's interpolation of a form in a cell (whitney.c has the forms). */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/forms/assemble.h"
#include "field/forms/component.h"
#include "field/forms/evaluate.h"
#include "field/forms/gram.h"
#include "field/mesh/complex.h"

/* One n-cell, and a place in it. */
typedef struct spot {
  const dvi_mesh *mesh;
  int k;
  const double *place;
  dvi__twofold covector[DVI__SIMPLEX_CORNERS]
                       [DVI_MESH_SPACE_MAX]; /* d lambda_i, or d xi of axis i */
} spot;

/* Add weight times the wedge product of k covectors. */
static void add_wedge(const spot *s, const dvi__twofold *const *covector, double weight,
                      double *value)
{
  int axis[DVI_MESH_DIMENSION_MAX], component = 0;
  dvi__first_axes(s->k, axis);
  do value[component++] += weight * dvi__exact_minor(s->k, covector, axis);
  while (dvi__next_axes(s->mesh->space, s->k, axis));
}

/* Add k! sum_i (-1)^i lambda_i d lambda without i, for the corners of a face. */
static void add_simplex_form(const spot *s, const int *corner, double a, double *value)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  for (int i = 0; i <= s->k; i++) {
    const dvi__twofold *covector[DVI__SIMPLEX_CORNERS];
    for (int j = 0, at = 0; j <= s->k; j++)
      if (j != i) covector[at++] = s->covector[corner[j]];
    const double weight = a * factorial[s->k] * s->place[corner[i]];
    add_wedge(s, covector, i % 2 == 0 ? weight : -weight, value);
  }
}

/* Faces of a box are told by the bits of their first and of their last corner. */
static void add_box_form(const spot *s, const int *corner, double a, double *value)
{
  const int axes = corner[0] ^ corner[(1 << s->k) - 1];
  const dvi__twofold *covector[DVI_MESH_DIMENSION_MAX];
  for (int axis = 0, at = 0; axis < s->mesh->n; axis++)
    if (axes >> axis & 1)
      covector[at++] = s->covector[axis];
    else
      a *= corner[0] >> axis & 1 ? s->place[axis] : 1 - s->place[axis];
  add_wedge(s, covector, a, value);
}

/* The axes of a box are orthogonal. */
static void find_box_covectors(const dvi__placed *placed, spot *s)
{
  double square[DVI_MESH_DIMENSION_MAX];
  dvi__box_squares(placed, s->mesh->n, square);
  for (int i = 0; i < s->mesh->n; i++)
    for (int l = 0; l < s->mesh->space; l++)
      s->covector[i][l] = (dvi__twofold){s->mesh->metric[l] * (placed->x[1 << i][l] / square[i]),
                                         0};
}

static int find_covectors(spot *s, int64_t cell)
{
  const int n = s->mesh->n, is_box = s->mesh->kind == DVI_BOXES;
  dvi__placed placed;
  double volume;
  dvi__place_cell(s->mesh, n, cell, &placed);
  if (is_box)
    find_box_covectors(&placed, s);
  else if (dvi__covectors_of(&placed, n, s->covector, &volume) == 0)
    return 0;
  for (int i = 0; i <= n - is_box; i++)
    for (int l = 0; l < s->mesh->space; l++)
      if (!isfinite(s->covector[i][l].head)) return 0;
  return 1;
}

/* Give a face of the cell by its corners there, and its sign beside the face of the mesh. */
static int64_t find_face(const spot *s, int64_t cell, const int *corner, int *sign)
{
  const dvi_mesh *mesh = s->mesh;
  const int corners = dvi__corners(mesh->kind, s->k),
            *vertex_of = mesh->corner[mesh->n] + cell * dvi__corners(mesh->kind, mesh->n);
  int vertex[DVI__CORNERS];
  *sign = 1;
  for (int c = 0; c < corners; c++) vertex[c] = vertex_of[corner[c]];
  const int64_t face = s->k == mesh->n ? cell : dvi__complex_find(mesh, s->k, vertex);
  if (s->k > 0)
    *sign = dvi__relative_orientation(mesh->kind, s->k, vertex,
                                      mesh->corner[s->k] + face * corners);
  return face;
}

static void add_form(const spot *s, const int *corner, double a, double *value)
{
  if (s->mesh->kind == DVI_BOXES)
    add_box_form(s, corner, a, value);
  else
    add_simplex_form(s, corner, a, value);
}

int dvi__form_weights(const dvi_mesh *mesh, int k, int64_t cell, const double *place,
                      const double *along, int *face, double *weight)
{
  spot s = {.mesh = mesh, .k = k, .place = place};
  const int components = dvi_form_components(mesh->space, k);
  dvi__local_faces faces;
  dvi__find_local_faces(mesh->kind, mesh->n, k, &faces);
  if (!find_covectors(&s, cell)) return 0;
  for (int i = 0; i < faces.count; i++) {
    int sign;
    double value[DVI__COMPONENTS] = {0};
    face[i] = (int)find_face(&s, cell, faces.corner[i], &sign);
    add_form(&s, faces.corner[i], sign, value);
    weight[i] = 0;
    for (int c = 0; c < components; c++) weight[i] += along[c] * value[c];
  }
  return faces.count;
}

dvi_status dvi_form_evaluate(const dvi_mesh *mesh, int k, const double *form, int64_t cell,
                             const double *place, double *value)
{
  if (mesh == NULL || form == NULL || place == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: a mesh, a form, a place and an array are needed");
  if (k < 0 || k > mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: the degree is %d, and may be 0 to %d", k, mesh->n);
  if (cell < 0 || cell >= mesh->count[mesh->n])
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: there is no cell %lld among the %lld of the mesh",
                     (long long)cell, (long long)mesh->count[mesh->n]);
  spot s = {.mesh = mesh, .k = k, .place = place};
  if (!find_covectors(&s, cell)) return dvi__refuse_null(mesh, mesh->n, cell);
  memset(value, 0, (size_t)dvi_form_components(mesh->space, k) * sizeof *value);
  dvi__local_faces faces;
  dvi__find_local_faces(mesh->kind, mesh->n, k, &faces);
  for (int i = 0; i < faces.count; i++) {
    int sign;
    const int64_t face = find_face(&s, cell, faces.corner[i], &sign);
    add_form(&s, faces.corner[i], sign * form[face], value);
  }
  return DVI_OK;
}

dvi_status dvi_form_at_centres(const dvi_mesh *mesh, int k, const double *form, double *value)
{
  double place[DVI__SIMPLEX_CORNERS];
  if (mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: a mesh, a form and an array are needed");
  const int components = dvi_form_components(mesh->space, k);
  for (int i = 0; i <= mesh->n; i++) place[i] = mesh->kind == DVI_BOXES ? 0.5 : 1.0 / (mesh->n + 1);
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++)
    DVI_TRY(
        dvi_form_evaluate(mesh, k, form, c, place, value != NULL ? value + c * components : NULL));
  return DVI_OK;
}
