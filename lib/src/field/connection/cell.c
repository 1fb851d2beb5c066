/* With the edges u_i from corner 0, the rows of the lower triangle L, the places of the other
 * corners in the frame, are Gram and Schmidt's coefficients of the edges, or Cholesky's factor of
 * their inner products G_ij = (s_0i + s_0j - s_ij)/2, s = l^2. The gradients of the barycentric
 * coordinates are the columns of L^-1. The angle between the facets without corners i and j is that
 * between grad lambda_i and -grad lambda_j,
 *
 *     atan2(|grad lambda_i ^ grad lambda_j|, -grad lambda_i . grad lambda_j). */
#include "field/connection/cell.h"

#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/connection/lengths.h"
#include "field/regge/simplex.h"
#include "field/mesh/angle.h"
#include "num/simd/fused.h"

typedef dvi__twofold vector[DVI_MESH_DIMENSION_MAX];

static const dvi__twofold zero = {0, 0};

/* ---- vectors in twice the digits ---- */

FUSED_INLINE dvi__twofold dot(int n, const dvi__twofold *a, const dvi__twofold *b)
{
  dvi__twofold sum = zero;
  for (int l = 0; l < n; l++) sum = dvi__twofold_add_product(sum, a[l], b[l]);
  return sum;
}

FUSED_INLINE void subtract(int n, dvi__twofold factor, const dvi__twofold *b, dvi__twofold *a)
{
  for (int l = 0; l < n; l++) a[l] = dvi__twofold_less_product(a[l], factor, b[l]);
}

FUSED_INLINE void scale(int n, dvi__twofold factor, dvi__twofold *a)
{
  for (int l = 0; l < n; l++) a[l] = dvi__twofold_times(a[l], factor);
}

/* The root of a positive number, by Newton's step from that of its head. */
FUSED_INLINE dvi__twofold root_of(dvi__twofold a)
{
  const double first = sqrt(a.head);
  const dvi__twofold rest = dvi__twofold_less_product(a, (dvi__twofold){first, 0},
                                                      (dvi__twofold){first, 0});
  return dvi__exact_sum(first, rest.head / (2 * first));
}

/* ---- places ---- */

/* Let the longest edge be below 1. Returns the power of two by which all are multiplied. */
static double scale_of(double longest)
{
  int exponent;
  (void)frexp(longest, &exponent);
  return ldexp(1, -exponent);
}

static void set_edges(const dvi_mesh *mesh, int64_t cell, dvi__twofold edge[][DVI_MESH_SPACE_MAX])
{
  dvi__placed placed;
  double longest = 0;
  dvi__place_cell(mesh, mesh->n, cell, &placed);
  for (int i = 1; i <= mesh->n; i++)
    for (int l = 0; l < mesh->space; l++) longest = fmax(longest, fabs(placed.x[i][l]));
  const double factor = scale_of(longest);
  for (int i = 0; i < mesh->n; i++)
    for (int l = 0; l < mesh->space; l++)
      edge[i][l] = dvi__twofold_scaled((dvi__twofold){placed.x[i + 1][l], placed.tail[i + 1][l]},
                                       factor);
}

/* Set L and the frame by Gram and Schmidt's method, once, because twice the digits are enough. */
FUSED static void orthogonalise(dvi__twofold e[][DVI_MESH_SPACE_MAX], dvi__laid_cell *c)
{
  for (int i = 0; i < c->n; i++) {
    dvi__twofold *row = c->place[i + 1];
    for (int j = 0; j < i; j++) {
      row[j] = dot(c->space, e[i], e[j]);
      subtract(c->space, row[j], e[j], e[i]);
    }
    row[i] = root_of(dot(c->space, e[i], e[i]));
    scale(c->space, dvi__twofold_inverse(row[i]), e[i]);
    for (int l = 0; l < c->space; l++) c->frame[i][l] = e[i][l].head;
  }
}

FUSED_INLINE dvi__twofold inner_product(int n, const double *length, int i, int j)
{
  const double a = length[dvi__pair(n, 0, i)], b = length[dvi__pair(n, 0, j)],
               c = i == j ? 0 : length[i < j ? dvi__pair(n, i, j) : dvi__pair(n, j, i)];
  const dvi__twofold sides = dvi__twofold_plus(dvi__exact_product(a, a), dvi__exact_product(b, b));
  return dvi__twofold_scaled(dvi__twofold_plus(sides, dvi__exact_product(-c, c)), 0.5);
}

/* Set L by Cholesky's method. Returns 0 where the inner products are not positive definite, up to
 * roundings. */
FUSED static int factor_products(const double *length, dvi__laid_cell *c)
{
  for (int i = 0; i < c->n; i++) {
    const double square = inner_product(c->n, length, i + 1, i + 1).head;
    dvi__twofold *row = c->place[i + 1];
    for (int j = 0; j <= i; j++) {
      dvi__twofold rest = inner_product(c->n, length, i + 1, j + 1);
      for (int k = 0; k < j; k++)
        rest = dvi__twofold_less_product(rest, row[k], c->place[j + 1][k]);
      if (j == i && !(rest.head > dvi__flat_part * square)) return 0;
      row[j] = j == i ? root_of(rest)
                      : dvi__twofold_times(rest, dvi__twofold_inverse(c->place[j + 1][j]));
    }
  }
  return 1;
}

/* Solve L x = e_j for each j. */
FUSED static void set_slopes(dvi__laid_cell *c)
{
  for (int j = 0; j < c->n; j++)
    for (int i = 0; i < c->n; i++) {
      dvi__twofold rest = {i == j, 0};
      for (int k = 0; k < i; k++)
        rest = dvi__twofold_less_product(rest, c->place[i + 1][k], c->slope[j + 1][k]);
      c->slope[j + 1][i] = dvi__twofold_times(rest, dvi__twofold_inverse(c->place[i + 1][i]));
    }
  for (int l = 0; l < c->n; l++) {
    c->slope[0][l] = zero;
    for (int j = 1; j <= c->n; j++)
      c->slope[0][l] = dvi__twofold_plus(c->slope[0][l], dvi__twofold_scaled(c->slope[j][l], -1));
  }
}

static void turn_over(dvi__laid_cell *c)
{
  const int last = c->n - 1;
  for (int l = 0; l < c->space; l++) c->frame[last][l] = -c->frame[last][l];
  for (int i = 0; i <= c->n; i++) {
    c->place[i][last] = dvi__twofold_scaled(c->place[i][last], -1);
    c->slope[i][last] = dvi__twofold_scaled(c->slope[i][last], -1);
  }
}

static dvi_status lay_lengths(const dvi_mesh *mesh, const double *length, int64_t cell,
                              dvi__laid_cell *laid)
{
  double of_cell[DVI__PAIRS], longest = 0;
  dvi__cell_lengths(mesh, length, cell, of_cell);
  for (int e = 0; e < dvi__pairs(mesh->n); e++) longest = fmax(longest, of_cell[e]);
  const double factor = scale_of(longest);
  for (int e = 0; e < dvi__pairs(mesh->n); e++) of_cell[e] *= factor;
  if (factor_products(of_cell, laid)) return DVI_OK;
  return dvi__refuse_lengths(mesh, length, cell);
}

dvi_status dvi__lay_cell(const dvi_mesh *mesh, const double *length, int64_t cell,
                         dvi__laid_cell *laid)
{
  memset(laid, 0, sizeof *laid);
  laid->n = mesh->n;
  laid->space = mesh->space;
  if (length != NULL) {
    DVI_TRY(lay_lengths(mesh, length, cell, laid));
  } else {
    dvi__twofold edge[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
    set_edges(mesh, cell, edge);
    orthogonalise(edge, laid);
  }
  set_slopes(laid);
  if (mesh->orientation != NULL && mesh->orientation[cell] < 0) turn_over(laid);
  return DVI_OK;
}

/* ---- angles and bases ---- */

/* Components of the wedge product do not cancel. */
FUSED static dvi__twofold angle_between(int n, const dvi__twofold *a, const dvi__twofold *b)
{
  dvi__twofold square = zero;
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++) {
      const dvi__twofold minor = dvi__twofold_less_product(dvi__twofold_times(a[i], b[j]), a[j],
                                                           b[i]);
      square = dvi__twofold_add_product(square, minor, minor);
    }
  return dvi__twofold_angle(dvi__twofold_scaled(dot(n, a, b), -1), root_of(square));
}

dvi__twofold dvi__laid_angle(const dvi__laid_cell *laid, int i, int j)
{
  return angle_between(laid->n, laid->slope[i], laid->slope[j]);
}

FUSED static void set_basis(const dvi__laid_cell *c, int slot, vector *basis)
{
  const int first = slot == 0;
  int count = 0;
  for (int i = first + 1; i <= c->n; i++) {
    dvi__twofold *e = basis[count];
    if (i == slot) continue;
    for (int l = 0; l < c->n; l++)
      e[l] = dvi__twofold_plus(c->place[i][l], dvi__twofold_scaled(c->place[first][l], -1));
    for (int j = 0; j < count; j++) subtract(c->n, dot(c->n, e, basis[j]), basis[j], e);
    scale(c->n, dvi__twofold_inverse(root_of(dot(c->n, e, e))), e);
    count++;
  }
  memcpy(basis[count], c->slope[slot], sizeof(vector));
  const dvi__twofold size = root_of(dot(c->n, basis[count], basis[count]));
  scale(c->n, dvi__twofold_scaled(dvi__twofold_inverse(size), -1), basis[count]);
}

void dvi__facet_basis(const dvi__laid_cell *laid, int slot, vector *basis)
{
  set_basis(laid, slot, basis);
}

FUSED static void set_plane(const dvi__laid_cell *c, int i, int j, double *along, double *across)
{
  vector a, b;
  memcpy(a, c->slope[i], sizeof a);
  memcpy(b, c->slope[j], sizeof b);
  scale(c->n, dvi__twofold_inverse(root_of(dot(c->n, b, b))), b);
  subtract(c->n, dot(c->n, a, b), b, a);
  scale(c->n, dvi__twofold_inverse(root_of(dot(c->n, a, a))), a);
  for (int l = 0; l < c->n; l++) {
    along[l] = a[l].head;
    across[l] = b[l].head;
  }
}

void dvi__normal_plane(const dvi__laid_cell *laid, int i, int j, double *along, double *across)
{
  set_plane(laid, i, j, along, across);
}
