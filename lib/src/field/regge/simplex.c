#include "field/regge/simplex.h"

#include <math.h>
#include <string.h>

#include "num/compensated.h"
#include "num/simd/fused.h"

typedef dvi__twofold square_matrix[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX];
typedef dvi__twofold product_matrix[DVI__SIMPLEX_CORNERS][DVI__SIMPLEX_CORNERS];

const double dvi__flat_part = 1e-28;

/* Lengths divided by a power of two, so that the largest is below 1. */
typedef struct scaled_lengths {
  int n;
  double scale;
  double length[DVI__PAIRS];
} scaled_lengths;

static scaled_lengths scale_lengths(int n, const double *length)
{
  scaled_lengths scaled = {.n = n};
  double most = 0;
  int exponent;
  for (int e = 0; e < dvi__pairs(n); e++) most = fmax(most, length[e]);
  (void)frexp(most, &exponent);
  scaled.scale = ldexp(1, exponent);
  for (int e = 0; e < dvi__pairs(n); e++) scaled.length[e] = length[e] / scaled.scale;
  return scaled;
}

static double length_of(const scaled_lengths *s, int i, int j)
{
  return i == j ? 0 : s->length[i < j ? dvi__pair(s->n, i, j) : dvi__pair(s->n, j, i)];
}

/* ---- products ---- */

/* Give the corner from which the product of the edges is smallest. Their inner products are then
 * those of the best condition. */
static int find_origin(const scaled_lengths *s, int k, const int *corner)
{
  int best = 0;
  double least = INFINITY;
  for (int o = 0; o <= k; o++) {
    double product = 1;
    for (int i = 0; i <= k; i++)
      if (i != o) product *= length_of(s, corner[o], corner[i]);
    if (product >= least) continue;
    least = product;
    best = o;
  }
  return best;
}

/* Give (s_oi + s_oj - s_ij)/2. */
FUSED_INLINE dvi__twofold inner_product(const scaled_lengths *s, int o, int i, int j)
{
  const double a = length_of(s, o, i), b = length_of(s, o, j), c = length_of(s, i, j);
  const dvi__twofold sides = dvi__twofold_plus(dvi__exact_product(a, a), dvi__exact_product(b, b));
  return dvi__twofold_scaled(dvi__twofold_plus(sides, dvi__exact_product(-c, c)), 0.5);
}

/* Replace a positive definite matrix by its inverse (Gauss and Jordan). Returns the determinant, or
 * 0 if the matrix is not positive definite. */
FUSED_INLINE double invert(int k, square_matrix a)
{
  double determinant = 1, square[DVI_MESH_DIMENSION_MAX];
  for (int i = 0; i < k; i++) square[i] = a[i][i].head;
  for (int j = 0; j < k; j++) {
    if (!(a[j][j].head > dvi__flat_part * square[j])) return 0;
    determinant *= a[j][j].head;
    const dvi__twofold scale = dvi__twofold_inverse(a[j][j]);
    a[j][j] = (dvi__twofold){1, 0};
    for (int l = 0; l < k; l++) a[j][l] = dvi__twofold_times(a[j][l], scale);
    for (int i = 0; i < k; i++) {
      const dvi__twofold factor = a[i][j];
      if (i == j) continue;
      a[i][j] = (dvi__twofold){0, 0};
      for (int l = 0; l < k; l++) a[i][l] = dvi__twofold_less_product(a[i][l], factor, a[j][l]);
    }
  }
  return determinant;
}

/* Set the products of the corners of a face, whose rows sum up to 0. Returns the determinant of the
 * inner products of the face's edges, 0 if there is no such face. */
FUSED static double find_products(const scaled_lengths *s, int k, const int *corner,
                                  product_matrix P)
{
  square_matrix G;
  int others[DVI__SIMPLEX_CORNERS], count = 0;
  const int slot = find_origin(s, k, corner), origin = corner[slot];
  for (int i = 0; i <= k; i++)
    if (i != slot) others[count++] = corner[i];
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) G[i][j] = inner_product(s, origin, others[i], others[j]);
  const double determinant = invert(k, G);
  dvi__twofold all = {0, 0};
  for (int i = 0; i < k && determinant > 0; i++) {
    dvi__twofold row = {0, 0};
    for (int j = 0; j < k; j++) {
      P[others[i]][others[j]] = G[i][j];
      row = dvi__twofold_plus(row, G[i][j]);
    }
    P[others[i]][origin] = P[origin][others[i]] = dvi__twofold_scaled(row, -1);
    all = dvi__twofold_plus(all, row);
  }
  P[origin][origin] = all;
  return determinant;
}

static void round_products(const scaled_lengths *s, int k, double determinant, product_matrix P,
                           dvi__simplex_products *products)
{
  static const double factorial[] = {1, 1, 2, 6, 24};
  products->volume = sqrt(determinant) / factorial[k] * pow(s->scale, k);
  for (int i = 0; i <= s->n; i++)
    for (int j = 0; j <= s->n; j++) products->P[i][j] = P[i][j].head / s->scale / s->scale;
}

static int face_exists(int n, const double *length, int k, const int *corner)
{
  product_matrix P;
  const scaled_lengths s = scale_lengths(n, length);
  return find_products(&s, k, corner, P) > 0;
}

int dvi__missing_face(int n, const double *length)
{
  for (int k = 2; k <= n; k++)
    for (int set = 1; set < 2 << n; set++) {
      int corner[DVI__SIMPLEX_CORNERS];
      if (dvi__corners_of_set(set, corner) == k + 1 && !face_exists(n, length, k, corner))
        return set;
    }
  return 0;
}

/* ---- hinges ---- */

/* Set the angle and the z_i of the hinge that lacks a and b, with A = P_aa, B = P_bb, C = P_ab and
 * W^2 = AB - C^2: the vectors of the plane are d lambda_a/sqrt(A) and
 * (A d lambda_b - C d lambda_a)/(sqrt(A) W). */
FUSED static void find_angle(const scaled_lengths *s, product_matrix P, int a, int b,
                             dvi__hinge *hinge)
{
  const dvi__twofold A = P[a][a], B = P[b][b], C = P[a][b],
                     square = dvi__twofold_less_product(dvi__twofold_times(A, B), C, C);
  const double W = sqrt(square.head), root = sqrt(A.head), size = sqrt(A.head * B.head);
  hinge->angle = atan2(W, -C.head);
  hinge->sine = W / size;
  hinge->cosine = -C.head / size;
  for (int i = 0; i <= s->n; i++) {
    const dvi__twofold across = dvi__twofold_less_product(dvi__twofold_times(A, P[b][i]), C,
                                                          P[a][i]);
    hinge->x[i] = P[a][i].head / root / s->scale;
    hinge->y[i] = across.head / (root * W) / s->scale;
  }
}

static void measure_hinge(const scaled_lengths *s, product_matrix P, int a, int b,
                          dvi__hinge *hinge)
{
  product_matrix of_face;
  int corner[DVI__SIMPLEX_CORNERS], count = 0;
  for (int i = 0; i <= s->n; i++)
    if (i != a && i != b) corner[count++] = i;
  memset(of_face, 0, sizeof of_face);
  const double determinant = s->n > 2 ? find_products(s, s->n - 2, corner, of_face) : 1;
  round_products(s, s->n - 2, determinant, of_face, &hinge->face);
  find_angle(s, P, a, b, hinge);
}

int dvi__simplex_measure(int n, const double *length, dvi__measured_simplex *simplex)
{
  static const int all[] = {0, 1, 2, 3, 4};
  product_matrix P;
  const scaled_lengths s = scale_lengths(n, length);
  memset(P, 0, sizeof P);
  const double determinant = find_products(&s, n, all, P);
  if (!(determinant > 0)) return 0;
  simplex->n = n;
  memcpy(simplex->length, length, (size_t)dvi__pairs(n) * sizeof *length);
  round_products(&s, n, determinant, P, &simplex->cell);
  for (int a = 0; a <= n; a++)
    for (int b = a + 1; b <= n; b++)
      measure_hinge(&s, P, a, b, simplex->hinge + dvi__pair(n, a, b));
  return 1;
}

/* ---- derivatives ---- */

/* The corners of pair e. */
typedef struct corners {
  int i, j;
} corners;

static corners corners_of(int n, int e)
{
  corners c = {0, 1};
  while (dvi__pair(n, c.i + 1, c.i + 2) <= e) c.i++;
  c.j = c.i + 1 + e - dvi__pair(n, c.i, c.i + 1);
  return c;
}

/* Replace derivatives by squares of lengths, dF/ds_e and d2F/ds_e ds_f, by those by lengths,
 * 2 l_e F_e and 4 l_e l_f F_ef + 2 F_e for e = f. */
static void by_lengths(const dvi__measured_simplex *m, double *slope)
{
  for (int e = 0; e < dvi__pairs(m->n); e++) slope[e] *= 2 * m->length[e];
}

static void bends_by_lengths(const dvi__measured_simplex *m, const double *slope, double *bend)
{
  const int pairs = dvi__pairs(m->n);
  for (int e = 0; e < pairs; e++) {
    for (int f = 0; f < pairs; f++) bend[e * pairs + f] *= 4 * m->length[e] * m->length[f];
    bend[e * pairs + e] += 2 * slope[e];
  }
}

/* dV/ds_ij = -V P_ij/2. */
static void size_slopes(int n, const dvi__simplex_products *p, double *slope)
{
  for (int e = 0; e < dvi__pairs(n); e++) {
    const corners c = corners_of(n, e);
    slope[e] = -0.5 * p->volume * p->P[c.i][c.j];
  }
}

/* d2V/ds_ij ds_kl = V/4 (P_ij P_kl - P_ik P_jl - P_il P_jk). */
static void size_bends(const dvi__measured_simplex *m, const dvi__simplex_products *p, double *bend)
{
  const int pairs = dvi__pairs(m->n);
  double slope[DVI__PAIRS];
  for (int e = 0; e < pairs; e++)
    for (int f = 0; f < pairs; f++) {
      const corners c = corners_of(m->n, e), d = corners_of(m->n, f);
      bend[e * pairs + f] = 0.25 * p->volume *
                            (p->P[c.i][c.j] * p->P[d.i][d.j] - p->P[c.i][d.i] * p->P[c.j][d.j] -
                             p->P[c.i][d.j] * p->P[c.j][d.i]);
    }
  size_slopes(m->n, p, slope);
  bends_by_lengths(m, slope, bend);
}

void dvi__volume_slopes(const dvi__measured_simplex *simplex, double *slope)
{
  size_slopes(simplex->n, &simplex->cell, slope);
  by_lengths(simplex, slope);
}

void dvi__volume_bends(const dvi__measured_simplex *simplex, double *bend)
{
  size_bends(simplex, &simplex->cell, bend);
}

void dvi__hinge_slopes(const dvi__measured_simplex *simplex, int h, double *slope)
{
  size_slopes(simplex->n, &simplex->hinge[h].face, slope);
  by_lengths(simplex, slope);
}

void dvi__hinge_bends(const dvi__measured_simplex *simplex, int h, double *bend)
{
  size_bends(simplex, &simplex->hinge[h].face, bend);
}

/* ---- derivatives of angles ---- */

/* Give Re((cosine + i sine) (x_i + i y_i) (x_j + i y_j)). */
static double turned(double cosine, double sine, double xi, double yi, double xj, double yj)
{
  return cosine * (xi * xj - yi * yj) - sine * (xi * yj + yi * xj);
}

static void angle_slopes(int n, const dvi__hinge *h, double *slope)
{
  for (int e = 0; e < dvi__pairs(n); e++) {
    const corners c = corners_of(n, e);
    slope[e] = -0.5 * h->sine *
               turned(h->cosine, h->sine, h->x[c.i], h->y[c.i], h->x[c.j], h->y[c.j]);
  }
}

void dvi__angle_slopes(const dvi__measured_simplex *simplex, int h, double *slope)
{
  angle_slopes(simplex->n, simplex->hinge + h, slope);
  by_lengths(simplex, slope);
}

/* Give the derivative of z_i by s_kl. With T_ij, the products in the hinge itself, and axes that
 * stay orthonormal with x along d lambda_a,
 *
 *     dx_i = (x_i x_k x_l + y_i (x_k y_l + x_l y_k) + x_k T_il + x_l T_ik)/2,
 *     dy_i = (y_i y_k y_l + y_k T_il + y_l T_ik)/2. */
static void turn(const dvi__hinge *h, int i, corners d, double *dx, double *dy)
{
  const double *x = h->x, *y = h->y, Til = h->face.P[i][d.j], Tik = h->face.P[i][d.i];
  *dx = 0.5 * (x[i] * x[d.i] * x[d.j] + y[i] * (x[d.i] * y[d.j] + x[d.j] * y[d.i]) + x[d.i] * Til +
               x[d.j] * Tik);
  *dy = 0.5 * (y[i] * y[d.i] * y[d.j] + y[d.i] * Til + y[d.j] * Tik);
}

/* d2 theta/ds_ij ds_kl = -(theta_kl Re(e^{2 i theta} z_i z_j)
 *                          + sin theta Re(e^{i theta} (z_i dz_j + dz_i z_j)))/2. */
static double angle_bend(const dvi__hinge *h, double slope, corners c, corners d)
{
  const double cosine = h->cosine, sine = h->sine, *x = h->x, *y = h->y;
  double xi, yi, xj, yj;
  turn(h, c.i, d, &xi, &yi);
  turn(h, c.j, d, &xj, &yj);
  return -0.5 * (slope * turned((cosine - sine) * (cosine + sine), 2 * sine * cosine, x[c.i],
                                y[c.i], x[c.j], y[c.j]) +
                 sine * (turned(cosine, sine, x[c.i], y[c.i], xj, yj) +
                         turned(cosine, sine, xi, yi, x[c.j], y[c.j])));
}

void dvi__angle_bends(const dvi__measured_simplex *simplex, int h, double *bend)
{
  const int n = simplex->n, pairs = dvi__pairs(n);
  double slope[DVI__PAIRS];
  angle_slopes(n, simplex->hinge + h, slope);
  for (int e = 0; e < pairs; e++)
    for (int f = 0; f < pairs; f++)
      bend[e * pairs + f] = angle_bend(simplex->hinge + h, slope[f], corners_of(n, e),
                                       corners_of(n, f));
  bends_by_lengths(simplex, slope, bend);
}
