#include "field/mesh/mesh.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/coface.h"
#include "field/mesh/complex.h"
#include "field/mesh/part.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

/* ---- names for messages ---- */

const char *dvi__degree_name(dvi_cell_kind kind, int k)
{
  static const char *const name[2][DVI__DEGREES] = {
      {"vertex", "edge", "triangle", "tetrahedron", "4-simplex"},
      {"vertex", "edge", "rectangle", "box", "4-box"},
  };
  return name[kind == DVI_BOXES][k];
}

/* Name a cell by its number and its first vertices, as the whole mesh has them. */
static dvi__cell_name name_by_vertices(const dvi_mesh *mesh, int k, int64_t cell)
{
  dvi__cell_name name;
  const int count = dvi__corners(mesh->kind, k), shown = count < 5 ? count : 4,
            *vertex = mesh->corner[k] + cell * count;
  size_t at = 0;
  at += (size_t)snprintf(name.text, sizeof name.text, "%s %lld (vert%s",
                         dvi__degree_name(mesh->kind, k),
                         (long long)dvi__whole_number(mesh, k, cell), count > 1 ? "ices" : "ex");
  for (int c = 0; c < shown; c++)
    at += (size_t)snprintf(name.text + at, sizeof name.text - at, " %lld",
                           (long long)dvi__whole_number(mesh, 0, vertex[c]));
  (void)snprintf(name.text + at, sizeof name.text - at, "%s)", shown < count ? " .." : "");
  return name;
}

dvi__cell_name dvi__name_cell(const dvi_mesh *mesh, int k, int64_t cell)
{
  dvi__cell_name name;
  if (mesh->corner[k] != NULL) return name_by_vertices(mesh, k, cell);
  (void)snprintf(name.text, sizeof name.text, "vertex %lld",
                 (long long)dvi__whole_number(mesh, 0, cell));
  return name;
}

/* ---- create ---- */

static dvi_status check_dimensions(const dvi_mesh_terms *t, int space)
{
  if (t->kind != DVI_SIMPLICES && t->kind != DVI_BOXES)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: there are no cells of kind %d", (int)t->kind);
  if (t->dimension < 1 || t->dimension > DVI_MESH_DIMENSION_MAX)
    return dvi__fail(DVI_BAD_SIZE, "mesh: the dimension is %d, and must be 1 to %d", t->dimension,
                     (int)DVI_MESH_DIMENSION_MAX);
  if (space < t->dimension || space > DVI_MESH_SPACE_MAX)
    return dvi__fail(DVI_BAD_SIZE, "mesh: points have %d coordinates, and need %d to %d", space,
                     t->dimension, (int)DVI_MESH_SPACE_MAX);
  return DVI_OK;
}

static dvi_status check_counts(const dvi_mesh_terms *t)
{
  if (t->points < 1 || t->points >= INT_MAX || t->point == NULL)
    return dvi__fail(t->points < 1 || t->point != NULL ? DVI_BAD_SIZE : DVI_BAD_ARGUMENT,
                     "mesh: needs points, and %lld are given", (long long)t->points);
  if (t->cells < 1 || t->cells >= INT_MAX || t->vertex == NULL)
    return dvi__fail(t->cells < 1 || t->vertex != NULL ? DVI_BAD_SIZE : DVI_BAD_ARGUMENT,
                     "mesh: needs cells, and %lld are given", (long long)t->cells);
  if (t->parts < 0 || (t->parts > 0 && t->part == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: %d parts, but none is given", t->parts);
  return DVI_OK;
}

/* Copy the two properties of the axes. */
static dvi_status take_axes(dvi_mesh *mesh, const dvi_mesh_terms *t)
{
  for (int i = 0; i < mesh->space; i++) {
    mesh->metric[i] = t->metric != NULL ? t->metric[i] : 1;
    mesh->period[i] = t->period != NULL ? t->period[i] : 0;
    if (fabs(mesh->metric[i]) != 1)
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh: the metric of axis %d is %g, and must be 1 or -1",
                       i, mesh->metric[i]);
    if (!(mesh->period[i] >= 0) || !isfinite(mesh->period[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh: the period of axis %d is %g", i, mesh->period[i]);
  }
  return DVI_OK;
}

static dvi_status take_points(dvi_mesh *mesh, const dvi_mesh_terms *t)
{
  const int64_t numbers = t->points * mesh->space;
  mesh->count[0] = t->points;
  mesh->point = dvi__duplicate(t->point, (size_t)numbers, sizeof *t->point);
  if (mesh->point == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for %lld points", (long long)t->points);
  for (int64_t i = 0; i < numbers; i++)
    if (!isfinite(mesh->point[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh: coordinate %d of point %lld is %g",
                       (int)(i % mesh->space), (long long)(i / mesh->space), mesh->point[i]);
  return DVI_OK;
}

static dvi_status check_corners(const dvi_mesh *mesh, int64_t cell, const int *vertex)
{
  const int corners = dvi__corners(mesh->kind, mesh->n);
  for (int c = 0; c < corners; c++) {
    if (vertex[c] < 0 || vertex[c] >= mesh->count[0])
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh: %s %lld has vertex %d, but there are %lld points",
                       dvi__degree_name(mesh->kind, mesh->n), (long long)cell, vertex[c],
                       (long long)mesh->count[0]);
    for (int d = 0; d < c; d++)
      if (vertex[d] == vertex[c])
        return dvi__fail(DVI_BAD_ARGUMENT, "mesh: %s %lld is degenerate: it has vertex %d twice",
                         dvi__degree_name(mesh->kind, mesh->n), (long long)cell, vertex[c]);
  }
  return DVI_OK;
}

/* Sort the vertices of a simplex. Returns the sign of the permutation. */
static int sort_simplex(int count, int *vertex)
{
  int sign = 1;
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && vertex[j - 1] > vertex[j]; j--) {
      const int other = vertex[j];
      vertex[j] = vertex[j - 1];
      vertex[j - 1] = other;
      sign = -sign;
    }
  return sign;
}

/* Take the vertices of the cells, and note the orientation with which each is given. */
static dvi_status take_cells(dvi_mesh *mesh, const dvi_mesh_terms *t, int8_t *given)
{
  const int corners = dvi__corners(mesh->kind, mesh->n);
  mesh->count[mesh->n] = t->cells;
  mesh->corner[mesh->n] = dvi__duplicate(t->vertex, (size_t)t->cells * (size_t)corners,
                                         sizeof *t->vertex);
  if (mesh->corner[mesh->n] == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for %lld cells", (long long)t->cells);
  for (int64_t c = 0; c < t->cells; c++) {
    int *vertex = mesh->corner[mesh->n] + c * corners;
    DVI_TRY(check_corners(mesh, c, vertex));
    given[c] = (int8_t)(mesh->kind == DVI_BOXES ? 1 : sort_simplex(corners, vertex));
  }
  return DVI_OK;
}

static dvi_status check_points_in_use(const dvi_mesh *mesh)
{
  char *used = DVI_NEW(char, mesh->count[0]);
  if (used == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory");
  const int64_t corners = mesh->count[mesh->n] * dvi__corners(mesh->kind, mesh->n);
  for (int64_t i = 0; i < corners; i++) used[mesh->corner[mesh->n][i]] = 1;
  int64_t v = 0;
  while (v < mesh->count[0] && used[v]) v++;
  dvi__release(used);
  if (v == mesh->count[0]) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "mesh: point %lld belongs to no cell", (long long)v);
}

static dvi_status build(dvi_mesh *mesh, const dvi_mesh_terms *terms, int8_t *given)
{
  DVI_TRY(take_axes(mesh, terms));
  DVI_TRY(take_points(mesh, terms));
  DVI_TRY(take_cells(mesh, terms, given));
  DVI_TRY(check_points_in_use(mesh));
  DVI_TRY(dvi__complex_build(mesh));
  DVI_TRY(dvi__check_cells(mesh));
  DVI_TRY(dvi__coface_build(mesh));
  DVI_TRY(dvi__coface_orient(mesh, given));
  return dvi__parts_create(mesh, terms);
}

dvi_status dvi_mesh_create(const dvi_mesh_terms *terms, dvi_mesh **mesh)
{
  if (terms == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: terms and mesh are needed");
  *mesh = NULL;
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: set terms.size to sizeof(dvi_mesh_terms)");
  const int space = terms->space != 0 ? terms->space : terms->dimension;
  DVI_TRY(check_dimensions(terms, space));
  DVI_TRY(check_counts(terms));
  dvi_mesh *made = DVI_NEW(dvi_mesh, 1);
  int8_t *given = DVI_NEW(int8_t, terms->cells);
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "mesh: no memory");
  if (made != NULL && given != NULL) {
    atomic_init(&made->owners, 1);
    made->kind = terms->kind;
    made->n = terms->dimension;
    made->space = space;
    status = build(made, terms, given);
  }
  dvi__release(given);
  if (status == DVI_OK)
    *mesh = made;
  else
    dvi_mesh_destroy(&made);
  return status;
}

dvi_mesh *dvi_mesh_share(const dvi_mesh *mesh)
{
  dvi_mesh *shared = (dvi_mesh *)mesh;
  if (shared != NULL) atomic_fetch_add(&shared->owners, 1);
  return shared;
}

void dvi_mesh_destroy(dvi_mesh **mesh)
{
  if (mesh == NULL || *mesh == NULL) return;
  dvi_mesh *m = *mesh;
  *mesh = NULL;
  if (atomic_fetch_sub(&m->owners, 1) > 1) return;
  dvi__parts_clear(m);
  dvi__share_destroy(m->share);
  for (int k = 0; k < DVI__DEGREES; k++) {
    dvi__release(m->corner[k]);
    dvi__release(m->facet[k]);
    dvi__release(m->sign[k]);
  }
  dvi__release(m->point);
  dvi__release(m->orientation);
  dvi__release(m->coface);
  dvi__release(m);
}

/* ---- access ---- */

int dvi_mesh_dimension(const dvi_mesh *mesh)
{
  return mesh != NULL ? mesh->n : 0;
}

int dvi_mesh_space(const dvi_mesh *mesh)
{
  return mesh != NULL ? mesh->space : 0;
}

dvi_cell_kind dvi_mesh_kind(const dvi_mesh *mesh)
{
  return mesh != NULL ? mesh->kind : DVI_SIMPLICES;
}

int64_t dvi_mesh_count(const dvi_mesh *mesh, int k)
{
  return mesh != NULL && k >= 0 && k <= mesh->n ? mesh->count[k] : 0;
}

const double *dvi_mesh_points(const dvi_mesh *mesh)
{
  return mesh != NULL ? mesh->point : NULL;
}

const int *dvi_mesh_vertices(const dvi_mesh *mesh, int k, int *width)
{
  const int known = mesh != NULL && k >= 1 && k <= mesh->n;
  if (width != NULL) *width = known ? dvi__corners(mesh->kind, k) : 0;
  return known ? mesh->corner[k] : NULL;
}

dvi_status dvi_mesh_centres(const dvi_mesh *mesh, int k, double *centre)
{
  double to[DVI_MESH_SPACE_MAX];
  if (mesh == NULL || centre == NULL || k < 0 || k > mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: there are no centres of degree %d", k);
  const int space = mesh->space, width = k > 0 ? dvi__corners(mesh->kind, k) : 1,
            *corner = mesh->corner[k];
  for (int64_t cell = 0; cell < mesh->count[k]; cell++) {
    const int first = corner != NULL ? corner[cell * width] : (int)cell;
    double *x = centre + cell * space;
    memcpy(x, mesh->point + (int64_t)first * space, (size_t)space * sizeof *x);
    for (int c = 1; c < width && corner != NULL; c++) {
      dvi__mesh_difference(mesh, first, corner[cell * width + c], to);
      for (int l = 0; l < space; l++) x[l] += to[l] / width;
    }
  }
  return DVI_OK;
}

dvi_status dvi_mesh_incidence(const dvi_mesh *mesh, int k, dvi_matrix *incidence)
{
  if (mesh == NULL || incidence == NULL || k < 0 || k >= mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: there is no incidence of degree %d", k);
  *incidence = (dvi_matrix){.rows = mesh->count[k + 1],
                            .columns = mesh->count[k],
                            .width = dvi__facets(mesh->kind, k + 1),
                            .column = mesh->facet[k + 1],
                            .sign = mesh->sign[k + 1]};
  return DVI_OK;
}

const int8_t *dvi_mesh_orientation(const dvi_mesh *mesh)
{
  return mesh != NULL ? mesh->orientation : NULL;
}
