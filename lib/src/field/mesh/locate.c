/* The cells that contain given points. Cells are listed in the bins of a regular grid that their
 * bounding boxes meet, so that a point looks at few cells. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

/* A point counts as inside if its weights are negative by no more than this. */
static const double inside = 1e-10;

typedef struct bins {
  const dvi_mesh *mesh;
  int n;
  int64_t count[DVI_MESH_DIMENSION_MAX], all; /* bins along each axis */
  double origin[DVI_MESH_DIMENSION_MAX], width[DVI_MESH_DIMENSION_MAX];
  int64_t *start; /* [all+1] */
  int *cell;
} bins;

/* ---- the grid ---- */

/* Give the bounding box of a cell, relative to its first corner, whose coordinate is returned. */
static double bound_cell(const dvi_mesh *mesh, int64_t cell, int axis, double *least, double *most)
{
  const int corners = dvi__corners(mesh->kind, mesh->n),
            *corner = mesh->corner[mesh->n] + cell * corners;
  double to[DVI_MESH_SPACE_MAX];
  *least = *most = 0;
  for (int c = 1; c < corners; c++) {
    dvi__mesh_difference(mesh, corner[0], corner[c], to);
    *least = fmin(*least, to[axis]);
    *most = fmax(*most, to[axis]);
  }
  return mesh->point[(int64_t)corner[0] * mesh->n + axis];
}

/* Find the extent of the mesh along an axis, and return the mean extent of a cell. */
static double measure_axis(bins *b, int axis, double *extent)
{
  const dvi_mesh *mesh = b->mesh;
  double least = INFINITY, most = -INFINITY, sum = 0, low, high;
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    least = fmin(least, mesh->point[v * b->n + axis]);
    most = fmax(most, mesh->point[v * b->n + axis]);
  }
  for (int64_t c = 0; c < mesh->count[b->n]; c++) {
    (void)bound_cell(mesh, c, axis, &low, &high);
    sum += high - low;
  }
  /* shares reduce points to the same period as the whole mesh */
  b->origin[axis] = mesh->period[axis] > 0 ? dvi__least_coordinate(mesh, axis, least) : least;
  *extent = mesh->period[axis] > 0 ? mesh->period[axis] : most - least;
  return sum / (double)mesh->count[b->n];
}

/* Bins have the size of a mean cell, or are larger, so that there are no more than cells. */
static void lay_out_grid(bins *b)
{
  const double cells = (double)b->mesh->count[b->n];
  double extent[DVI_MESH_DIMENSION_MAX], wanted[DVI_MESH_DIMENSION_MAX], all = 1;
  for (int a = 0; a < b->n; a++) {
    const double mean = measure_axis(b, a, &extent[a]);
    wanted[a] = fmin(fmax(extent[a] / mean, 1), cells);
    all *= wanted[a];
  }
  while (all > cells) {
    all = 1;
    for (int a = 0; a < b->n; a++) {
      wanted[a] = fmax(0.8 * wanted[a], 1);
      all *= wanted[a];
    }
  }
  b->all = 1;
  for (int a = 0; a < b->n; a++) {
    b->count[a] = (int64_t)wanted[a];
    b->width[a] = extent[a] / (double)b->count[a];
    b->all *= b->count[a];
  }
}

/* Give the bin of a coordinate, without wrapping it. */
static int64_t bin_of(const bins *b, int axis, double x)
{
  return (int64_t)floor((x - b->origin[axis]) / b->width[axis]);
}

/* Bring a bin into the grid: around it where space repeats itself, to its end elsewhere. */
static int64_t wrap(const bins *b, int axis, int64_t bin)
{
  const int64_t count = b->count[axis];
  if (b->mesh->period[axis] > 0) return (bin % count + count) % count;
  return bin < 0 ? 0 : bin >= count ? count - 1 : bin;
}

/* Give the first and the last bin of a cell's bounding box along each axis. */
static void find_bins(const bins *b, int64_t cell, int64_t *first, int64_t *last)
{
  const dvi_mesh *mesh = b->mesh;
  for (int a = 0; a < b->n; a++) {
    double least, most;
    const double x = bound_cell(mesh, cell, a, &least, &most), margin = 1e-9 * (most - least);
    first[a] = bin_of(b, a, x + least - margin);
    last[a] = bin_of(b, a, x + most + margin);
    if (!(mesh->period[a] > 0)) {
      first[a] = wrap(b, a, first[a]);
      last[a] = wrap(b, a, last[a]);
    } else if (last[a] - first[a] >= b->count[a]) {
      last[a] = first[a] + b->count[a] - 1;
    }
  }
}

/* Count the cell in its bins, or list it if there is a list. */
static void enter_cell(const bins *b, int64_t cell, int64_t *at, int *list)
{
  int64_t first[DVI_MESH_DIMENSION_MAX], last[DVI_MESH_DIMENSION_MAX], bin[DVI_MESH_DIMENSION_MAX];
  int axis = 0;
  find_bins(b, cell, first, last);
  memcpy(bin, first, (size_t)b->n * sizeof *bin);
  while (axis < b->n) {
    int64_t number = 0;
    for (int a = b->n - 1; a >= 0; a--) number = number * b->count[a] + wrap(b, a, bin[a]);
    if (list != NULL) list[at[number]] = (int)cell;
    at[number]++;
    for (axis = 0; axis < b->n && ++bin[axis] > last[axis]; axis++) bin[axis] = first[axis];
  }
}

static dvi_status fill_bins(bins *b)
{
  const int64_t cells = b->mesh->count[b->n];
  int64_t *at = DVI_NEW(int64_t, b->all), sum = 0;
  b->start = DVI_NEW(int64_t, b->all + 1);
  dvi_status status = at != NULL && b->start != NULL ? DVI_OK
                                                     : dvi__fail(DVI_NO_MEMORY, "mesh: no memory");
  for (int64_t c = 0; c < cells && status == DVI_OK; c++) enter_cell(b, c, at, NULL);
  for (int64_t i = 0; i < b->all && status == DVI_OK; i++) {
    const int64_t count = at[i];
    b->start[i] = at[i] = sum;
    sum += count;
  }
  if (status == DVI_OK) {
    b->start[b->all] = sum;
    b->cell = DVI_NEW(int, sum);
    if (b->cell == NULL) status = dvi__fail(DVI_NO_MEMORY, "mesh: no memory");
  }
  for (int64_t c = 0; c < cells && status == DVI_OK; c++) enter_cell(b, c, at, b->cell);
  dvi__release(at);
  return status;
}

/* ---- a cell ---- */

/* Solve sum_i w_i edge_i = d by Gauss's elimination with pivots. */
static void solve_edges(int n, const double *edge, const double *d, double *w)
{
  double A[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX + 1];
  for (int l = 0; l < n; l++) {
    for (int i = 0; i < n; i++) A[l][i] = edge[i * n + l];
    A[l][n] = d[l];
  }
  for (int j = 0; j < n; j++) {
    int pivot = j;
    for (int l = j + 1; l < n; l++)
      if (fabs(A[l][j]) > fabs(A[pivot][j])) pivot = l;
    for (int i = 0; i <= n; i++) {
      const double kept = A[j][i];
      A[j][i] = A[pivot][i];
      A[pivot][i] = kept;
    }
    for (int l = 0; l < n; l++) {
      const double factor = A[l][j] / A[j][j];
      for (int i = j; i <= n && l != j; i++) A[l][i] -= factor * A[j][i];
    }
  }
  for (int j = 0; j < n; j++) w[j] = A[j][n] / A[j][j];
}

/* Compute the weights of a point, as dvi_form_evaluate takes them. Returns 1 if it is inside. */
static int weigh(const bins *b, int64_t cell, const double *x, double *weight)
{
  const dvi_mesh *mesh = b->mesh;
  const int corners = dvi__corners(mesh->kind, b->n);
  const double *first = mesh->point + (int64_t)mesh->corner[b->n][cell * corners] * b->n;
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX], d[DVI_MESH_DIMENSION_MAX],
      w[DVI_MESH_DIMENSION_MAX], rest = 1;
  dvi__cell_edges(mesh, b->n, cell, edge);
  for (int a = 0; a < b->n; a++) {
    d[a] = x[a] - first[a];
    if (mesh->period[a] > 0) d[a] -= mesh->period[a] * round(d[a] / mesh->period[a]);
  }
  solve_edges(b->n, edge, d, w);
  for (int i = 0; i < b->n; i++) {
    if (!(w[i] >= -inside) || (mesh->kind == DVI_BOXES && !(w[i] <= 1 + inside))) return 0;
    rest -= w[i];
  }
  if (mesh->kind == DVI_BOXES) {
    memcpy(weight, w, (size_t)b->n * sizeof *w);
    return 1;
  }
  weight[0] = rest;
  memcpy(weight + 1, w, (size_t)b->n * sizeof *w);
  return rest >= -inside;
}

/* ---- points ---- */

/* Bring a point into the first period of each axis. fmod has no roundings. Returns 0 for a point
 * outside of the grid. */
static int reduce(const bins *b, const double *x, double *inner)
{
  for (int a = 0; a < b->n; a++) {
    const double period = b->mesh->period[a], from = x[a] - b->origin[a];
    const double rest = period > 0 ? fmod(from, period) : from, part = rest / b->width[a];
    inner[a] = period > 0 ? b->origin[a] + rest : x[a];
    if (!(fabs(part) <= (double)b->count[a] + 1)) return 0;
  }
  return 1;
}

static void locate(const bins *b, const double *point, int *cell, double *weight)
{
  double x[DVI_MESH_DIMENSION_MAX] = {0};
  int64_t number = 0;
  *cell = -1;
  if (!reduce(b, point, x)) return;
  for (int a = b->n - 1; a >= 0; a--)
    number = number * b->count[a] + wrap(b, a, bin_of(b, a, x[a]));
  for (int64_t i = b->start[number]; i < b->start[number + 1] && *cell < 0; i++)
    if (weigh(b, b->cell[i], x, weight)) *cell = b->cell[i];
}

static dvi_status check(const dvi_mesh *mesh, int64_t points, const double *point, const int *cell,
                        const double *weight)
{
  if (mesh == NULL || points < 0 || (points > 0 && (!point || !cell || !weight)))
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: to locate points, a mesh and arrays are needed");
  if (mesh->space != mesh->n)
    return dvi__fail(DVI_UNSUPPORTED,
                     "mesh: points are located among cells that fill their space; here %d-cells "
                     "lie in %d coordinates",
                     mesh->n, mesh->space);
  for (int64_t i = 0; i < points * mesh->n; i++)
    if (!isfinite(point[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh: coordinate %lld of point %lld is %g",
                       (long long)(i % mesh->n), (long long)(i / mesh->n), point[i]);
  return DVI_OK;
}

dvi_status dvi_mesh_locate(const dvi_mesh *mesh, int64_t points, const double *point, int *cell,
                           double *weight)
{
  DVI_TRY(check(mesh, points, point, cell, weight));
  const int n = mesh->n, width = mesh->kind == DVI_BOXES ? n : n + 1;
  bins b = {.mesh = mesh, .n = n};
  lay_out_grid(&b);
  const dvi_status status = fill_bins(&b);
  for (int64_t i = 0; i < points && status == DVI_OK; i++)
    locate(&b, point + i * n, cell + i, weight + i * width);
  dvi__release(b.start);
  dvi__release(b.cell);
  return status;
}
