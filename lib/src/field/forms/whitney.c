/* The star of Whitney's forms.
 *
 * On a simplex with barycentric coordinates lambda_i the form of the k-face I is
 *
 *     W_I = k! sum_i (-1)^i lambda_{I_i} d lambda_{I_0} ^ .. leave out I_i .. ^ d lambda_{I_k},
 *
 * and M_k has the integrals of W_I . W_J over all cells, with
 *
 *     d lambda_a ^ .. . d lambda_b ^ .. = det (grad lambda_a . grad lambda_b)
 *                                       = sum over sets of axes of the products of components,
 *     int lambda_i lambda_j = V (1 + delta_ij)/((n+1)(n+2)).
 *
 * On a box the form of a face is the product of dx/h along its axes, and of the linear functions
 * that are 1 at the face across them. Source: Whitney 1957, sec. IV.27; Bossavit 1988. */
#include <math.h>

#include "core/status.h"
#include "field/forms/assemble.h"
#include "field/forms/component.h"
#include "field/forms/gram.h"

enum { WEDGES = 10 }; /* of 2 or 3 corners of 5, at most */

/* The wedge products of d lambda at k corners of a simplex. In thin simplices all d lambda are
 * nearly parallel, and the determinants of their inner products would lose all digits, so that the
 * components are computed in twice the digits. */
typedef struct wedges {
  int n, k, components;
  double sign[DVI__COMPONENTS]; /* the product of the metric along the axes */
  double product[WEDGES][WEDGES];
  int number[1 << DVI__SIMPLEX_CORNERS]; /* by the bits of the corners */
} wedges;

static void compute_components(const dvi_mesh *mesh, wedges *w, const dvi__twofold *const *covector,
                               double *component)
{
  int axis[DVI_MESH_DIMENSION_MAX], count = 0;
  dvi__first_axes(w->k, axis);
  do {
    w->sign[count] = 1;
    for (int i = 0; i < w->k; i++) w->sign[count] *= mesh->metric[axis[i]];
    component[count++] = dvi__exact_minor(w->k, covector, axis);
  } while (dvi__next_axes(mesh->space, w->k, axis));
  w->components = count;
}

static void multiply_wedges(const dvi_mesh *mesh,
                            dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX],
                            wedges *w)
{
  double component[WEDGES][DVI__COMPONENTS] = {{0}};
  int count = 0;
  for (int mask = 0; mask < 1 << (w->n + 1); mask++) {
    const dvi__twofold *of[DVI__SIMPLEX_CORNERS];
    int corners = 0;
    for (int c = 0; c <= w->n; c++)
      if (mask >> c & 1) of[corners++] = covector[c];
    if (corners != w->k) continue;
    compute_components(mesh, w, of, component[count]);
    w->number[mask] = count++;
  }
  for (int a = 0; a < count; a++)
    for (int b = 0; b <= a; b++) {
      double sum = 0;
      for (int i = 0; i < w->components; i++) sum += w->sign[i] * component[a][i] * component[b][i];
      w->product[a][b] = w->product[b][a] = sum;
    }
}

/* Give the numbers of the wedge products at the corners of a face without one each. */
static void find_wedges(const wedges *w, const int *I, int *number)
{
  int mask = 0;
  for (int i = 0; i <= w->k; i++) mask |= 1 << I[i];
  for (int i = 0; i <= w->k; i++) number[i] = w->number[mask & ~(1 << I[i])];
}

static double product_of_faces(const wedges *w, const int *I, const int *J)
{
  int of_I[DVI__SIMPLEX_CORNERS], of_J[DVI__SIMPLEX_CORNERS];
  double sum = 0;
  find_wedges(w, I, of_I);
  find_wedges(w, J, of_J);
  for (int i = 0; i <= w->k; i++)
    for (int j = 0; j <= w->k; j++) {
      const double term = (I[i] == J[j] ? 2 : 1) * w->product[of_I[i]][of_J[j]];
      sum += (i + j) % 2 == 0 ? term : -term;
    }
  return sum;
}

static dvi_status simplex_matrix(const dvi_star *star, int k, int64_t cell,
                                 const dvi__local_faces *faces, double *matrix)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  const int n = star->mesh->n, count = faces->count;
  const double factor = star->factor[k] != NULL ? star->factor[k][cell] : 1;
  dvi__placed placed;
  dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX];
  double volume;
  wedges w = {.n = n, .k = k};
  dvi__place_cell(star->mesh, n, cell, &placed);
  if (dvi__covectors_of(&placed, n, covector, &volume) == 0)
    return dvi__refuse_null(star->mesh, n, cell);
  multiply_wedges(star->mesh, covector, &w);
  const double each = factor * factorial[k] * factorial[k] * volume / ((n + 1) * (n + 2));
  for (int a = 0; a < count; a++)
    for (int b = 0; b <= a; b++)
      matrix[a * count + b] = matrix[b * count + a] = each * product_of_faces(&w, faces->corner[a],
                                                                              faces->corner[b]);
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
