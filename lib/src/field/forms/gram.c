/* With the edges u_i = p_i - p_0 of a simplex and their inner products G_ij in the metric, the
 * circumcentre is p_0 + sum x_i u_i with G x = diag(G)/2. The gradients of the barycentric
 * coordinates have the inner products of G^-1, and the volume is sqrt |det G|/k!. */
#include "field/forms/gram.h"

#include <float.h>
#include <math.h>

#include "field/mesh/volume.h"

/* det G is zero if it is this part of the product of its rows, as after roundings. */
static const double null_part = 64 * DBL_EPSILON;

void dvi__place_cell(const dvi_mesh *mesh, int k, int64_t cell, dvi__placed *placed)
{
  const int corners = dvi__corners(mesh->kind, k), *corner = mesh->corner[k] + cell * corners;
  *placed = (dvi__placed){.corners = corners, .space = mesh->space, .metric = mesh->metric};
  for (int c = 0; c < corners; c++) dvi__mesh_difference(mesh, corner[0], corner[c], placed->x[c]);
}

static double product(const dvi__placed *p, const double *origin, const double *a, const double *b)
{
  double sum = 0;
  for (int l = 0; l < p->space; l++) sum += p->metric[l] * (a[l] - origin[l]) * (b[l] - origin[l]);
  return sum;
}

/* Replace G by its inverse (Gauss and Jordan's, with pivots from the diagonal, then from any
 * column, because a metric with signs may have zeros there). Returns det G. */
static double invert(int k, double G[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX])
{
  double work[DVI_MESH_DIMENSION_MAX][2 * DVI_MESH_DIMENSION_MAX] = {{0}}, determinant = 1;
  for (int i = 0; i < k; i++) {
    for (int j = 0; j < k; j++) work[i][j] = G[i][j];
    work[i][k + i] = 1;
  }
  for (int j = 0; j < k; j++) {
    int pivot = j;
    for (int i = j + 1; i < k; i++)
      if (fabs(work[i][j]) > fabs(work[pivot][j])) pivot = i;
    if (work[pivot][j] == 0) return 0;
    for (int l = 0; l < 2 * k && pivot != j; l++) {
      const double other = work[j][l];
      work[j][l] = work[pivot][l];
      work[pivot][l] = other;
    }
    determinant *= pivot == j ? work[j][j] : -work[j][j];
    const double scale = 1 / work[j][j];
    for (int l = 0; l < 2 * k; l++) work[j][l] *= scale;
    for (int i = 0; i < k; i++) {
      const double factor = work[i][j];
      for (int l = 0; l < 2 * k && i != j; l++) work[i][l] -= factor * work[j][l];
    }
  }
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) G[i][j] = work[i][k + j];
  return determinant;
}

/* An edge has its centre in the middle. */
static void compute_edge(double square, dvi__simplex *s)
{
  const double inverse = square != 0 ? 1 / square : 0;
  s->kappa = (square > 0) - (square < 0);
  s->volume = sqrt(fabs(square));
  s->centre[0] = s->centre[1] = 0.5;
  s->gradient[0][0] = s->gradient[1][1] = inverse;
  s->gradient[0][1] = s->gradient[1][0] = -inverse;
}

static void compute_gradients(int k, double inverse[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX],
                              dvi__simplex *s)
{
  double all = 0;
  for (int i = 0; i < k; i++) {
    double row = 0;
    for (int j = 0; j < k; j++) {
      s->gradient[i + 1][j + 1] = inverse[i][j];
      row += inverse[i][j];
    }
    s->gradient[i + 1][0] = s->gradient[0][i + 1] = -row;
    all += row;
  }
  s->gradient[0][0] = all;
}

void dvi__simplex_of(const dvi__placed *placed, int k, const int *corner, dvi__simplex *s)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  double G[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX] = {{0}},
         diagonal[DVI_MESH_DIMENSION_MAX] = {0}, size = 1;
  const double *origin = placed->x[corner[0]];
  s->k = k;
  for (int i = 0; i < k; i++)
    for (int j = 0; j <= i; j++)
      G[i][j] = G[j][i] = product(placed, origin, placed->x[corner[i + 1]],
                                  placed->x[corner[j + 1]]);
  if (k == 1) {
    compute_edge(G[0][0], s);
    return;
  }
  for (int i = 0; i < k; i++) {
    double row = 0;
    for (int j = 0; j < k; j++) row += fabs(G[i][j]);
    size *= row;
    diagonal[i] = G[i][i];
  }
  const double determinant = invert(k, G);
  s->kappa = fabs(determinant) <= null_part * size ? 0 : determinant > 0 ? 1 : -1;
  s->volume = sqrt(fabs(determinant)) / factorial[k];
  s->centre[0] = 1;
  for (int i = 0; i < k; i++) {
    s->centre[i + 1] = 0;
    for (int j = 0; j < k; j++) s->centre[i + 1] += 0.5 * G[i][j] * diagonal[j];
    s->centre[0] -= s->centre[i + 1];
  }
  compute_gradients(k, G, s);
}

void dvi__box_squares(const dvi__placed *placed, int k, double *square)
{
  for (int axis = 0; axis < k; axis++) {
    const double *edge = placed->x[1 << axis];
    square[axis] = product(placed, placed->x[0], edge, edge);
  }
}

double dvi__metric_volume(const dvi_mesh *mesh, int k, int64_t cell)
{
  static const int corner[] = {0, 1, 2, 3, 4};
  dvi__placed placed;
  dvi__simplex simplex;
  double square[DVI_MESH_DIMENSION_MAX], volume = 1;
  if (k == 0) return 1;
  dvi__place_cell(mesh, k, cell, &placed);
  if (mesh->kind == DVI_SIMPLICES) {
    dvi__simplex_of(&placed, k, corner, &simplex);
    return simplex.kappa * simplex.volume;
  }
  dvi__box_squares(&placed, k, square);
  for (int axis = 0; axis < k; axis++) volume *= copysign(sqrt(fabs(square[axis])), square[axis]);
  return volume;
}
