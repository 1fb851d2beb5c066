#include "field/mesh/volume.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/mesh/placed.h"

/* A volume is zero if this part of an edge is left beside the edges before, as after roundings. */
static const double flat_part = 64 * DBL_EPSILON;

/* If less is left, volumes are computed in twice the digits, because roundings grow by its
 * inverse. */
static const double thin_part = 0.1;

/* Edges of a box are orthogonal if the cosine of their angle is below this, as for corners that
 * were rounded or written with nine digits. */
static const double orthogonal_part = 1e-8;

void dvi__mesh_difference(const dvi_mesh *mesh, int a, int b, double *difference)
{
  const double *from = mesh->point + (size_t)a * (size_t)mesh->space,
               *to = mesh->point + (size_t)b * (size_t)mesh->space;
  for (int i = 0; i < mesh->space; i++) {
    const double period = mesh->period[i];
    difference[i] = to[i] - from[i];
    if (period > 0) difference[i] -= period * nearbyint(difference[i] / period);
  }
}

void dvi__mesh_exact_difference(const dvi_mesh *mesh, int a, int b, double *head, double *tail)
{
  const double *from = mesh->point + (size_t)a * (size_t)mesh->space,
               *to = mesh->point + (size_t)b * (size_t)mesh->space;
  for (int i = 0; i < mesh->space; i++) {
    const double period = mesh->period[i];
    dvi__twofold difference = dvi__exact_sum(to[i], -from[i]);
    const double turns = period > 0 ? nearbyint(difference.head / period) : 0;
    if (turns != 0) difference = dvi__twofold_plus(difference, dvi__exact_product(-turns, period));
    head[i] = difference.head;
    tail[i] = difference.tail;
  }
}

void dvi__cell_edges(const dvi_mesh *mesh, int k, int64_t cell, double *edge)
{
  const int corners = dvi__corners(mesh->kind, k), *corner = mesh->corner[k] + cell * corners;
  for (int i = 0; i < k; i++)
    dvi__mesh_difference(mesh, corner[0], corner[mesh->kind == DVI_BOXES ? 1 << i : i + 1],
                         edge + (size_t)i * (size_t)mesh->space);
}

double dvi__determinant(int n, double *a)
{
  double product = 1;
  for (int j = 0; j < n; j++) {
    int pivot = j;
    for (int i = j + 1; i < n; i++)
      if (fabs(a[i * n + j]) > fabs(a[pivot * n + j])) pivot = i;
    if (a[pivot * n + j] == 0) return 0;
    for (int l = 0; l < n && pivot != j; l++) {
      const double other = a[j * n + l];
      a[j * n + l] = a[pivot * n + l];
      a[pivot * n + l] = other;
    }
    product *= pivot == j ? a[j * n + j] : -a[j * n + j];
    for (int i = j + 1; i < n; i++) {
      const double factor = a[i * n + j] / a[j * n + j];
      for (int l = j + 1; l < n; l++) a[i * n + l] -= factor * a[j * n + l];
    }
  }
  return product;
}

int dvi__cell_handedness(const dvi_mesh *mesh, int64_t cell)
{
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX];
  dvi__cell_edges(mesh, mesh->n, cell, edge);
  const double determinant = dvi__determinant(mesh->n, edge);
  return (determinant > 0) - (determinant < 0);
}

static double dot(int count, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* Make the edges orthogonal (Gram and Schmidt's, twice is enough). Returns the product of their new
 * lengths, and in *part the smallest part of an old one which is left. */
static double orthogonalise(int k, int space, double *edge, double *part)
{
  double product = 1;
  *part = 1;
  for (int i = 0; i < k; i++) {
    double *e = edge + (size_t)i * (size_t)space;
    const double length = sqrt(dot(space, e, e));
    for (int twice = 0; twice < 2; twice++)
      for (int j = 0; j < i; j++) {
        const double *other = edge + (size_t)j * (size_t)space, square = dot(space, other, other),
                     factor = square > 0 ? dot(space, e, other) / square : 0;
        for (int l = 0; l < space; l++) e[l] -= factor * other[l];
      }
    const double left = sqrt(dot(space, e, e));
    product *= left;
    *part = fmin(*part, length > 0 ? left / length : 0);
  }
  return product;
}

static double volume_and_part(const dvi_mesh *mesh, int k, int64_t cell, double *part)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX];
  dvi__cell_edges(mesh, k, cell, edge);
  const double product = orthogonalise(k, mesh->space, edge, part);
  return mesh->kind == DVI_BOXES ? product : product / factorial[k];
}

static double volume_of_thin_simplex(const dvi_mesh *mesh, int k, int64_t cell)
{
  static const int all[] = {0, 1, 2, 3, 4};
  dvi__placed placed;
  dvi__gram gram;
  dvi__place_cell(mesh, k, cell, &placed);
  placed.metric = dvi__euclidean;
  (void)dvi__gram_of(&placed, k, all, &gram);
  return dvi__gram_volume(&gram);
}

double dvi__cell_volume(const dvi_mesh *mesh, int k, int64_t cell)
{
  double part;
  if (k == 0) return 1;
  const double volume = volume_and_part(mesh, k, cell, &part);
  return part > thin_part || mesh->kind == DVI_BOXES ? volume
                                                     : volume_of_thin_simplex(mesh, k, cell);
}

/* ---- checks ---- */

/* Compare each corner of a box with the sum of its edges, and the edges with each other. */
static int is_rectangular(const dvi_mesh *mesh, int64_t cell)
{
  const int n = mesh->n, space = mesh->space, *corner = mesh->corner[n] + (cell << n);
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX], to[DVI_MESH_SPACE_MAX], size = 0;
  dvi__cell_edges(mesh, n, cell, edge);
  for (int i = 0; i < n; i++) {
    const double *a = edge + (size_t)i * (size_t)space, square = dot(space, a, a);
    size += sqrt(square);
    for (int j = 0; j < i; j++) {
      const double *b = edge + (size_t)j * (size_t)space;
      if (fabs(dot(space, a, b)) > orthogonal_part * sqrt(square * dot(space, b, b))) return 0;
    }
  }
  for (int c = 1; c < 1 << n; c++) {
    dvi__mesh_difference(mesh, corner[0], corner[c], to);
    for (int i = 0; i < n; i++)
      for (int l = 0; l < space && c >> i & 1; l++) to[l] -= edge[i * space + l];
    if (sqrt(dot(space, to, to)) > orthogonal_part * size) return 0;
  }
  return 1;
}

/* The edge that a difference stands for is not known if it is as long as half a period. */
static dvi_status check_periods(const dvi_mesh *mesh)
{
  double edge[DVI_MESH_SPACE_MAX];
  for (int64_t e = 0; e < mesh->count[1]; e++) {
    dvi__cell_edges(mesh, 1, e, edge);
    for (int i = 0; i < mesh->space; i++)
      if (mesh->period[i] > 0 && fabs(edge[i]) > (0.5 - 1e-9) * mesh->period[i]) {
        const dvi__cell_name name = dvi__name_cell(mesh, 1, e);
        return dvi__fail(DVI_BAD_ARGUMENT,
                         "mesh: %s is as long as half of the period %.6g of axis %d: take three "
                         "cells along it, or more",
                         name.text, mesh->period[i], i);
      }
  }
  return DVI_OK;
}

static dvi_status check_cell(const dvi_mesh *mesh, int64_t cell)
{
  double part;
  const double volume = volume_and_part(mesh, mesh->n, cell, &part);
  if (isnan(volume) || !(part > flat_part)) {
    const dvi__cell_name name = dvi__name_cell(mesh, mesh->n, cell);
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: %s is degenerate: its volume vanishes", name.text);
  }
  if (mesh->kind != DVI_BOXES || is_rectangular(mesh, cell)) return DVI_OK;
  const dvi__cell_name name = dvi__name_cell(mesh, mesh->n, cell);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "mesh: %s is not rectangular: check the order of its corners, or divide the "
                   "mesh into simplices",
                   name.text);
}

dvi_status dvi__check_cells(const dvi_mesh *mesh)
{
  DVI_TRY(check_periods(mesh));
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) DVI_TRY(check_cell(mesh, c));
  return DVI_OK;
}
