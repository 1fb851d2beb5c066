#include "quad_regge.h"

#include <check.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 4 };

/* Find a k-cell by its ascending vertices. Cells are in the order of dictionaries. */
static int64_t find_cell(const dvi_mesh *mesh, int k, const int *vertex)
{
  const int *cell = k > 0 ? dvi_mesh_vertices(mesh, k, NULL) : NULL;
  int64_t low = 0, high = dvi_mesh_count(mesh, k) - 1;
  if (k == 0) return vertex[0];
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    int order = 0;
    for (int i = 0; i <= k && order == 0; i++) order = cell[middle * (k + 1) + i] - vertex[i];
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }
  ck_assert_int_eq(memcmp(cell + low * (k + 1), vertex, (size_t)(k + 1) * sizeof *vertex), 0);
  return low;
}

/* Gram's matrix of the edges from the first of k + 1 vertices, [k*MOST]. */
static void gram_of(const dvi_mesh *mesh, const quad *length, int k, const int *vertex, quad *G)
{
  quad square[MOST + 1][MOST + 1] = {{0}};
  for (int i = 0; i <= k; i++)
    for (int j = i + 1; j <= k; j++) {
      const int ends[] = {vertex[i], vertex[j]};
      const quad l = length[find_cell(mesh, 1, ends)];
      square[i][j] = square[j][i] = l * l;
    }
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++)
      G[i * MOST + j] = (square[0][i + 1] + square[0][j + 1] - square[i + 1][j + 1]) / 2;
}

/* Invert a definite matrix, and return its determinant (Gauss and Jordan, without exchanges). */
static quad invert(int k, quad *G)
{
  quad det = 1;
  for (int p = 0; p < k; p++) {
    const quad pivot = G[p * MOST + p];
    ck_assert_msg(pivot > 0, "the judge needs lengths of simplices");
    det *= pivot;
    G[p * MOST + p] = 1;
    for (int j = 0; j < k; j++) G[p * MOST + j] /= pivot;
    for (int i = 0; i < k; i++) {
      if (i == p) continue;
      const quad factor = G[i * MOST + p];
      G[i * MOST + p] = 0;
      for (int j = 0; j < k; j++) G[i * MOST + j] -= factor * G[p * MOST + j];
    }
  }
  return det;
}

static quad root_over_factorial(int k, quad det)
{
  static const int factorial[] = {1, 1, 2, 6, 24};
  return quad_sqrt(det) / factorial[k];
}

/* Subtract the angles of a simplex, and return its volume. */
static quad subtract_angles(const dvi_mesh *mesh, const quad *length, const int *vertex,
                            quad *deficit)
{
  const int n = dvi_mesh_dimension(mesh);
  quad G[MOST * MOST] = {0}, g[MOST + 1][MOST + 1] = {{0}};
  gram_of(mesh, length, n, vertex, G);
  const quad det = invert(n, G);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      g[i + 1][j + 1] = G[i * MOST + j];
      g[0][j + 1] -= G[i * MOST + j];
      g[i + 1][0] -= G[i * MOST + j];
      g[0][0] += G[i * MOST + j];
    }
  for (int i = 0; i <= n; i++)
    for (int j = i + 1; j <= n; j++) {
      int hinge[MOST], count = 0;
      for (int k = 0; k <= n; k++)
        if (k != i && k != j) hinge[count++] = vertex[k];
      deficit[find_cell(mesh, n - 2, hinge)] -= quad_acos(-g[i][j] / quad_sqrt(g[i][i] * g[j][j]));
    }
  return root_over_factorial(n, det);
}

quad quad_hinges(const dvi_mesh *mesh, const quad *length, quad *deficit, quad *volume)
{
  const int n = dvi_mesh_dimension(mesh), *cell = dvi_mesh_vertices(mesh, n, NULL);
  const int *hinge = n > 2 ? dvi_mesh_vertices(mesh, n - 2, NULL) : NULL;
  const quad pi = quad_acos(-1);
  int64_t at_boundary = 0;
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", n - 2, &at_boundary);
  quad all = 0;
  for (int64_t h = 0; h < dvi_mesh_count(mesh, n - 2); h++) {
    quad G[MOST * MOST] = {0};
    deficit[h] = 2 * pi;
    volume[h] = 1;
    if (hinge == NULL) continue;
    gram_of(mesh, length, n - 2, hinge + h * (n - 1), G);
    volume[h] = root_over_factorial(n - 2, invert(n - 2, G));
  }
  for (int64_t i = 0; i < at_boundary; i++) deficit[boundary[i]] = pi;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++)
    all += subtract_angles(mesh, length, cell + c * (n + 1), deficit);
  return all;
}

quad quad_regge_action(const dvi_mesh *mesh, double lambda, const quad *length)
{
  const int64_t hinges = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh) - 2);
  quad *deficit = calloc((size_t)hinges, sizeof *deficit),
       *volume = calloc((size_t)hinges, sizeof *volume);
  quad action = -lambda * quad_hinges(mesh, length, deficit, volume);
  for (int64_t h = 0; h < hinges; h++) action += volume[h] * deficit[h];
  free(deficit), free(volume);
  return action;
}

quad quad_schlaefli(const dvi_mesh *mesh, quad *length, int64_t e)
{
  const int64_t hinges = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh) - 2);
  const quad h = quad_parse("1e-11", NULL), at = length[e];
  quad *above = calloc((size_t)hinges, sizeof *above),
       *below = calloc((size_t)hinges, sizeof *below),
       *volume = calloc((size_t)hinges, sizeof *volume), sum = 0;
  length[e] = at + h;
  (void)quad_hinges(mesh, length, above, volume);
  length[e] = at - h;
  (void)quad_hinges(mesh, length, below, volume);
  length[e] = at;
  quad *unused = calloc((size_t)hinges, sizeof *unused);
  (void)quad_hinges(mesh, length, unused, volume);
  for (int64_t i = 0; i < hinges; i++) sum += volume[i] * (above[i] - below[i]) / (2 * h);
  free(above), free(below), free(volume), free(unused);
  return sum;
}
