#include "field/mesh/normal.h"

#include <math.h>

#include "field/mesh/volume.h"

static double dot(int space, const double *a, const double *b)
{
  double sum = 0;
  for (int l = 0; l < space; l++) sum += a[l] * b[l];
  return sum;
}

/* Take the part along the edges away from a vector, twice because of roundings. The edges are made
 * orthogonal on the way. */
static void project_off(int m, int space, double *edge, double *vector)
{
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i <= m; i++) {
      double *of = i < m ? edge + i * space : vector;
      for (int j = 0; j < i; j++) {
        const double *e = edge + j * space, factor = dot(space, of, e) / dot(space, e, e);
        for (int l = 0; l < space; l++) of[l] -= factor * e[l];
      }
    }
}

static int is_corner(int corners, const int *corner, int vertex)
{
  for (int c = 0; c < corners; c++)
    if (corner[c] == vertex) return 1;
  return 0;
}

/* The outer normal points away from the corners of the cell that the facet has not. */
void dvi__facet_normal(const dvi_mesh *mesh, int64_t facet, int64_t cell, double *normal)
{
  const int m = mesh->n - 1, corners = dvi__corners(mesh->kind, m), space = mesh->space,
            point = (int)facet, *corner = m > 0 ? mesh->corner[m] + facet * corners : &point,
            *other = mesh->corner[mesh->n] + cell * dvi__corners(mesh->kind, mesh->n);
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX], inward[DVI_MESH_SPACE_MAX];
  while (is_corner(corners, corner, *other)) other++;
  dvi__mesh_difference(mesh, corner[0], *other, inward);
  if (m > 0) dvi__cell_edges(mesh, m, facet, edge);
  project_off(m, space, edge, inward);
  const double length = sqrt(dot(space, inward, inward));
  for (int l = 0; l < space; l++) normal[l] = -inward[l] / length;
}

void dvi__facet_place(const dvi_mesh *mesh, int64_t facet, int64_t cell, double *place)
{
  const int n = mesh->n, facets = dvi__facets(mesh->kind, n);
  int slot = 0;
  while (slot < facets - 1 && mesh->facet[n][cell * facets + slot] != facet) slot++;
  if (mesh->kind == DVI_SIMPLICES)
    for (int i = 0; i <= n; i++) place[i] = i == slot ? 0 : 1.0 / n;
  else
    for (int i = 0; i < n; i++) place[i] = i == slot / 2 ? slot % 2 : 0.5;
}
