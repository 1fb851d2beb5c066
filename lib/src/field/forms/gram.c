/* With the edges u_i = p_i - p_0 of a simplex and their inner products G_ij in the metric, the
 * circumcentre is p_0 + sum x_i u_i with G x = diag(G)/2. The gradients of the barycentric
 * coordinates have the inner products of G^-1, and the volume is sqrt |det G|/k!.
 *
 * G has the square of the edges' condition. Where the edges are far from parallel, doubles lose few
 * digits, and are fast. For all other simplices G is computed in twice the digits
 * (field/mesh/placed.h). */
#include "field/forms/gram.h"

#include <math.h>

typedef double square_matrix[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX];

/* Doubles lose at most two digits or so if |u_i| |u_j| (G^-1)_ij, lengths as in Euclidean space, is
 * below this. For i = j it is the inverse square of the sine between u_i and the other edges. */
static const double condition_most = 50;

/* A circumcentre that is so close to a facet has lost digits of its distance from it. One that is
 * closer than `centre_on_facet` is on the facet, as far as roundings can tell. */
static const double centre_near_facet = 0.01, centre_on_facet = 1e-12;

/* Squares beyond these would leave the range of doubles when four of them are multiplied. */
static const double square_least = 1e-60, square_most = 1e60;

/* ---- doubles ---- */

typedef struct edges {
  int k;
  double u[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  double length[DVI_MESH_DIMENSION_MAX]; /* squares as in Euclidean space */
  double square[DVI_MESH_DIMENSION_MAX]; /* G_ii */
  double determinant;
  square_matrix inverse; /* of G */
} edges;

/* Set the lower triangle of G. */
static int set_products(const dvi__placed *p, const int *corner, edges *e)
{
  for (int i = 0; i < e->k; i++) {
    double *u = e->u[i];
    dvi__placed_edge(p, corner[0], corner[i + 1], u);
    e->length[i] = 0;
    for (int l = 0; l < p->space; l++) e->length[i] += u[l] * u[l];
    if (!(e->length[i] > square_least && e->length[i] < square_most)) return 0;
    for (int j = 0; j <= i; j++) {
      double sum = 0;
      for (int l = 0; l < p->space; l++) sum += p->metric[l] * u[l] * e->u[j][l];
      e->inverse[i][j] = e->inverse[j][i] = sum;
    }
    e->square[i] = e->inverse[i][i];
  }
  return 1;
}

/* Replace G by its inverse, with the pivots of the diagonal (Gauss and Jordan). */
static int invert(edges *e)
{
  e->determinant = 1;
  for (int j = 0; j < e->k; j++) {
    double *row = e->inverse[j];
    const double pivot = row[j], scale = 1 / pivot;
    if (!(fabs(pivot) * condition_most >= e->length[j])) return 0;
    e->determinant *= pivot;
    row[j] = 1;
    for (int l = 0; l < e->k; l++) row[l] *= scale;
    for (int i = 0; i < e->k; i++) {
      const double factor = e->inverse[i][j];
      if (i == j) continue;
      e->inverse[i][j] = 0;
      for (int l = 0; l < e->k; l++) e->inverse[i][l] -= factor * row[l];
    }
  }
  return 1;
}

static int is_well_conditioned(const edges *e)
{
  for (int i = 0; i < e->k; i++)
    for (int j = 0; j <= i; j++) {
      const double entry = e->inverse[i][j];
      if (!(e->length[i] * e->length[j] * entry * entry <= condition_most * condition_most))
        return 0;
    }
  return 1;
}

static int is_near_facet(const dvi__simplex *s)
{
  for (int i = 0; i <= s->k; i++) {
    const double distance = fabs(s->centre[i]);
    if (distance < centre_near_facet && distance > centre_on_facet) return 1;
  }
  return 0;
}

/* Returns 0 if doubles are not enough. */
static int solve(const dvi__placed *placed, int k, const int *corner, edges *e)
{
  e->k = k;
  return set_products(placed, corner, e) && invert(e) && is_well_conditioned(e);
}

static double volume_of(const edges *e)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  return sqrt(fabs(e->determinant)) / factorial[e->k];
}

static int compute(const dvi__placed *placed, int k, const int *corner, dvi__simplex *s)
{
  edges e;
  if (!solve(placed, k, corner, &e)) return 0;
  s->kappa = e.determinant > 0 ? 1 : -1;
  s->volume = volume_of(&e);
  s->centre[0] = 1;
  s->square[0] = 0;
  for (int i = 0; i < k; i++) {
    double row = 0, centre = 0;
    for (int j = 0; j < k; j++) {
      row += e.inverse[i][j];
      centre += 0.5 * e.inverse[i][j] * e.square[j];
    }
    s->square[i + 1] = e.inverse[i][i];
    s->centre[i + 1] = centre;
    s->square[0] += row;
    s->centre[0] -= centre;
  }
  return !is_near_facet(s);
}

/* ---- twice the digits ---- */

/* The corner from which the edges come has what the other ones leave. */
static void compute_exactly(const dvi__placed *placed, int k, const int *corner, dvi__simplex *s)
{
  dvi__gram g;
  dvi__twofold centre_left = {1, 0}, all = {0, 0};
  s->kappa = dvi__gram_of(placed, k, corner, &g);
  s->volume = dvi__gram_volume(&g);
  for (int i = 0; i < k; i++) {
    dvi__twofold centre = {0, 0};
    const int slot = g.slot[i + 1];
    for (int j = 0; j < k; j++) {
      const double ratio = g.scale[j] / g.scale[i], scales = 1 / g.scale[i] / g.scale[j];
      centre = dvi__twofold_add_product(centre, dvi__twofold_scaled(g.inverse[i][j], 0.5 * ratio),
                                        g.square[j]);
      all = dvi__twofold_plus(all, dvi__twofold_scaled(g.inverse[i][j], scales));
    }
    s->square[slot] = g.inverse[i][i].head / g.scale[i] / g.scale[i];
    s->centre[slot] = centre.head;
    centre_left = dvi__twofold_less_product(centre_left, centre, (dvi__twofold){1, 0});
  }
  s->square[g.slot[0]] = all.head;
  s->centre[g.slot[0]] = centre_left.head;
}

/* An edge has its centre in the middle. */
static void compute_edge(const dvi__placed *placed, const int *corner, dvi__simplex *s)
{
  double edge[DVI_MESH_SPACE_MAX], square = 0, length = 0;
  dvi__placed_edge(placed, corner[0], corner[1], edge);
  for (int l = 0; l < placed->space; l++) {
    square += placed->metric[l] * edge[l] * edge[l];
    length += edge[l] * edge[l];
  }
  if (!(fabs(square) * condition_most >= length && length > square_least && length < square_most)) {
    compute_exactly(placed, 1, corner, s);
    return;
  }
  s->kappa = square > 0 ? 1 : -1;
  s->volume = sqrt(fabs(square));
  s->centre[0] = s->centre[1] = 0.5;
  s->square[0] = s->square[1] = 1 / square;
}

void dvi__simplex_of(const dvi__placed *placed, int k, const int *corner, dvi__simplex *s)
{
  s->k = k;
  if (k == 1)
    compute_edge(placed, corner, s);
  else if (!compute(placed, k, corner, s))
    compute_exactly(placed, k, corner, s);
}

/* ---- covectors ---- */

/* Set d lambda_i = sum_j (G^-1)_ij metric u_j. If corners 0 and 1 are close together, d lambda_0 is
 * nearly -d lambda_1. Their wedge product depends on what is left, so that the sum is not
 * rounded. */
static void set_covectors(const dvi__placed *placed, const edges *e,
                          dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX])
{
  for (int l = 0; l < placed->space; l++) {
    dvi__twofold left = {0, 0};
    for (int i = 0; i < e->k; i++) {
      double sum = 0;
      for (int j = 0; j < e->k; j++) sum += e->inverse[i][j] * e->u[j][l];
      covector[i + 1][l] = (dvi__twofold){placed->metric[l] * sum, 0};
      left = dvi__twofold_plus(left, (dvi__twofold){-placed->metric[l] * sum, 0});
    }
    covector[0][l] = left;
  }
}

int dvi__covectors_of(const dvi__placed *placed, int n,
                      dvi__twofold covector[DVI__SIMPLEX_CORNERS][DVI_MESH_SPACE_MAX],
                      double *volume)
{
  static const int all[] = {0, 1, 2, 3, 4};
  edges e;
  dvi__gram gram;
  if (solve(placed, n, all, &e)) {
    set_covectors(placed, &e, covector);
    *volume = volume_of(&e);
    return e.determinant > 0 ? 1 : -1;
  }
  const int kappa = dvi__gram_of(placed, n, all, &gram);
  *volume = dvi__gram_volume(&gram);
  if (kappa != 0) dvi__gram_covectors(&gram, covector);
  return kappa;
}

/* ---- cells ---- */

void dvi__box_squares(const dvi__placed *placed, int k, double *square)
{
  for (int axis = 0; axis < k; axis++) {
    const double *edge = placed->x[1 << axis];
    square[axis] = 0;
    for (int l = 0; l < placed->space; l++) square[axis] += placed->metric[l] * edge[l] * edge[l];
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
