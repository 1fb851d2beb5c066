/* The star of Whitney's forms.
 *
 * On a simplex with barycentric coordinates lambda_i the form of the k-face I is
 *
 *     W_I = k! sum_i (-1)^i lambda_{I_i} d lambda_{I_0} ^ .. leave out I_i .. ^ d lambda_{I_k},
 *
 * and M_k has the integrals of W_I . W_J over all cells, with
 *
 *     d lambda_a ^ .. . d lambda_b ^ .. = det (grad lambda_a . grad lambda_b),
 *     int lambda_i lambda_j = V (1 + delta_ij)/((n+1)(n+2)).
 *
 * On a box the form of a face is the product of dx/h along its axes, and of the linear functions
 * that are 1 at the face across them. Source: Whitney 1957, sec. IV.27; Bossavit 1988. */
#include <math.h>

#include "core/status.h"
#include "field/forms/assemble.h"
#include "field/forms/gram.h"
#include "field/mesh/volume.h"

/* Give det grad lambda_a . grad lambda_b for the corners of two faces without one corner each. */
static double product_without(const dvi__simplex *s, int k, const int *I, int i, const int *J,
                              int j)
{
  double matrix[DVI_MESH_DIMENSION_MAX * DVI_MESH_DIMENSION_MAX];
  for (int a = 0, row = 0; a <= k; a++) {
    if (a == i) continue;
    for (int b = 0, column = 0; b <= k; b++)
      if (b != j) matrix[row * k + column++] = s->gradient[I[a]][J[b]];
    row++;
  }
  return dvi__determinant(k, matrix);
}

static double product_of_faces(const dvi__simplex *s, int k, const int *I, const int *J)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  const double each = factorial[k] * factorial[k] * s->volume / ((s->k + 1) * (s->k + 2));
  double sum = 0;
  for (int i = 0; i <= k; i++)
    for (int j = 0; j <= k; j++) {
      const double term = (I[i] == J[j] ? 2 : 1) * product_without(s, k, I, i, J, j);
      sum += (i + j) % 2 == 0 ? term : -term;
    }
  return each * sum;
}

static dvi_status simplex_matrix(const dvi_star *star, int k, int64_t cell,
                                 const dvi__local_faces *faces, double *matrix)
{
  static const int all[] = {0, 1, 2, 3, 4};
  const int n = star->mesh->n, count = faces->count;
  const double factor = star->factor[k] != NULL ? star->factor[k][cell] : 1;
  dvi__placed placed;
  dvi__simplex simplex;
  dvi__place_cell(star->mesh, n, cell, &placed);
  dvi__simplex_of(&placed, n, all, &simplex);
  if (simplex.kappa == 0) return dvi__refuse_null(star->mesh, n, cell);
  for (int a = 0; a < count; a++)
    for (int b = 0; b <= a; b++)
      matrix[a * count + b] = matrix[b * count + a] =
          factor * product_of_faces(&simplex, k, faces->corner[a], faces->corner[b]);
  return DVI_OK;
}

/* The edges of a box along its axes. */
typedef struct edges {
  int n, k;
  double square[DVI_MESH_DIMENSION_MAX]; /* in the metric */
} edges;

/* Faces are told by the bits of their first corner, and of their axes. */
static double product_in_box(const edges *e, const int *I, const int *J)
{
  const int corners = 1 << e->k, axes = I[0] ^ I[corners - 1];
  double product = 1;
  if (axes != (J[0] ^ J[corners - 1])) return 0;
  for (int axis = 0; axis < e->n; axis++) {
    const double length = sqrt(fabs(e->square[axis]));
    if (axes >> axis & 1)
      product *= length / e->square[axis];
    else
      product *= length / ((I[0] ^ J[0]) >> axis & 1 ? 6 : 3);
  }
  return product;
}

static dvi_status box_matrix(const dvi_star *star, int k, int64_t cell,
                             const dvi__local_faces *faces, double *matrix)
{
  edges e = {.n = star->mesh->n, .k = k};
  const int count = faces->count;
  const double factor = star->factor[k] != NULL ? star->factor[k][cell] : 1;
  dvi__placed placed;
  dvi__place_cell(star->mesh, e.n, cell, &placed);
  dvi__box_squares(&placed, e.n, e.square);
  for (int axis = 0; axis < e.n; axis++)
    if (e.square[axis] == 0) return dvi__refuse_null(star->mesh, e.n, cell);
  for (int a = 0; a < count; a++)
    for (int b = 0; b < count; b++)
      matrix[a * count + b] = factor * product_in_box(&e, faces->corner[a], faces->corner[b]);
  return DVI_OK;
}

dvi_status dvi__whitney_star(dvi_star *star, int k)
{
  return dvi__assemble(star, k, star->mesh->kind == DVI_BOXES ? box_matrix : simplex_matrix,
                       &star->matrix[k]);
}
