/* With D = (c_3 - c_2) X - c_1 y0 and X = B xi a direction has
 *
 *     T_j = c_1 B_j + xi_j D,     S_j = rate_j D + dT_j/ds 2 sigma + ...
 *
 * and a rotation y = R with A = dexp_{-xi} and Omega = A rate
 *
 *     T_j = R A_j^,     S_j = R (A_j^ Omega^ + (dOmega/dxi_j)^) */
#include "group/chart_bends.h"

#include <string.h>

#include "group/chart_lanes.h"
#include "group/stumpff.h"
#include "num/simd/wide.h"

typedef dvi__lane lane;

/* What is read at some nodes. of[k][j] is the derivative of order j of c_k in s. */
typedef struct place {
  lane xi[3], rate[3], y[9], v[9], a[9], b[9], c[9], of[3][4];
} place;

/* ---- points ---- */

/* d c_k / ds = (k c_{k+2} - c_{k+1}) / 2 */
INLINE void find_table(place *p)
{
  lane derivative[9];
  memcpy(derivative, p->c, sizeof derivative);
  for (int j = 0; j < 4; j++) {
    for (int k = 0; k < 3; k++) p->of[k][j] = derivative[k];
    for (int k = 0; k + 2 * (j + 1) < 9; k++)
      derivative[k] = 0.5 * (k * derivative[k + 2] - derivative[k + 1]);
  }
}

INLINE void find_functions(int size, int some, place *p)
{
  lane square = {0};
  for (int i = 0; i < size; i++) square += p->xi[i] * p->xi[i];
  for (int k = 0; k < some; k++) {
    double c[9];
    dvi__stumpff(square[k], c);
    for (int i = 0; i < 9; i++) p->c[i][k] = c[i];
  }
  find_table(p);
}

INLINE void read_place(int size, int stored, const dvi__chart_nodes *n, int k, int some, place *p)
{
  const size_t count = (size_t)n->count;
  memset(p, 0, sizeof *p);
  load_rows(size, n->xi + k, n->local, some, p->xi);
  load_rows(size, n->rate + k, n->local, some, p->rate);
  load_rows(stored, n->y + k, count, some, p->y);
  load_rows(stored, n->v + k, count, some, p->v);
  load_rows(stored, n->a + k, count, some, p->a);
  load_rows(stored, n->b + k, count, some, p->b);
  find_functions(size, some, p);
}

/* ---- curvature ---- */

/* The function w.y(xi) = w0 c_0 + c_1 z.xi + c_2 xi.B xi, up to a constant. Directions and angles
 * have no B. */
typedef struct form {
  lane w0, z[3], B[9];
} form;

INLINE void direction_form(const dvi__chart *chart, int size, int stored, const lane *w, form *f)
{
  memset(f, 0, sizeof *f);
  for (int i = 0; i < stored; i++) {
    f->w0 += chart->y0[i] * w[i];
    for (int j = 0; j < size; j++) f->z[j] += chart->basis[j][i] * w[i];
  }
}

INLINE void rotation_form(const dvi__chart *chart, const lane *w, form *f)
{
  const double *R = chart->y0;
  lane W[9]; /* R0^T w */
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      W[3 * i + j] = R[i] * w[j] + R[3 + i] * w[3 + j] + R[6 + i] * w[6 + j];
  const lane trace = W[0] + W[4] + W[8];
  f->w0 = (lane){0};
  f->z[0] = W[7] - W[5];
  f->z[1] = W[2] - W[6];
  f->z[2] = W[3] - W[1];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      f->B[3 * i + j] = 0.5 * (W[3 * i + j] + W[3 * j + i]);
      if (i == j) f->B[4 * i] -= trace;
    }
}

INLINE void form_of(const dvi__chart *chart, int size, int stored, const lane *w, form *f)
{
  if (size == 3)
    rotation_form(chart, w, f);
  else
    direction_form(chart, size, stored, w, f);
}

INLINE void inner(int size, const lane *a, const lane *b, lane *product)
{
  *product = a[0] * b[0];
  for (int i = 1; i < size; i++) *product += a[i] * b[i];
}

INLINE void times_B(int size, const form *f, const lane *x, lane *Bx)
{
  for (int i = 0; i < size; i++) {
    Bx[i] = (lane){0};
    for (int j = 0; j < size && size == 3; j++) Bx[i] += f->B[3 * i + j] * x[j];
  }
}

/* Differentiate j times in s, with m = z.xi and k = xi.B xi held fixed. */
INLINE void in_s(const form *f, const place *p, int j, const lane *m, const lane *k, lane *sum)
{
  *sum = p->of[0][j] * f->w0 + p->of[1][j] * *m + p->of[2][j] * *k;
}

/* H += x y^T + y x^T */
INLINE void add_outer(int size, const lane *x, const lane *y, lane *H)
{
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++) H[i * size + j] += x[i] * y[j] + y[i] * x[j];
}

/* Add the Hessian of w.y to H. */
INLINE void add_hessian(int size, const form *f, const place *p, lane *H)
{
  lane Bxi[3], m, k, first, second, beside[3];
  times_B(size, f, p->xi, Bxi);
  inner(size, f->z, p->xi, &m);
  inner(size, p->xi, Bxi, &k);
  in_s(f, p, 1, &m, &k, &first);
  in_s(f, p, 2, &m, &k, &second);
  for (int i = 0; i < size; i++) {
    beside[i] = 2 * (second * p->xi[i] + p->of[1][1] * f->z[i] + 2 * p->of[2][1] * Bxi[i]);
    H[i * size + i] += 2 * first;
  }
  add_outer(size, beside, p->xi, H);
  for (int i = 0; i < size * size && size == 3; i++) H[i] += 2 * p->of[2][0] * f->B[i];
}

/* Add the derivative of that Hessian along rate to H. */
INLINE void add_third(int size, const form *f, const place *p, lane *H)
{
  const lane *xi = p->xi, *u = p->rate;
  lane Bxi[3], Bu[3], m, k, sigma, m_u, k_u, second, third, on_xi[3], on_u[3];
  times_B(size, f, xi, Bxi);
  times_B(size, f, u, Bu);
  inner(size, f->z, xi, &m);
  inner(size, xi, Bxi, &k);
  inner(size, xi, u, &sigma);
  inner(size, f->z, u, &m_u);
  inner(size, xi, Bu, &k_u);
  in_s(f, p, 2, &m, &k, &second);
  in_s(f, p, 3, &m, &k, &third);
  const lane first_u = p->of[1][1] * m_u + 2 * p->of[2][1] * k_u,
             second_u = p->of[1][2] * m_u + 2 * p->of[2][2] * k_u;
  for (int i = 0; i < size; i++) {
    on_xi[i] = (4 * sigma * third + 2 * second_u) * xi[i] +
               4 * sigma * (p->of[1][2] * f->z[i] + 2 * p->of[2][2] * Bxi[i]) +
               4 * p->of[2][1] * Bu[i];
    on_u[i] = 4 * second * xi[i] + 2 * p->of[1][1] * f->z[i] + 4 * p->of[2][1] * Bxi[i];
    H[i * size + i] += 4 * sigma * second + 2 * first_u;
  }
  add_outer(size, on_xi, xi, H);
  add_outer(size, on_u, u, H);
  for (int i = 0; i < size * size && size == 3; i++) H[i] += 4 * p->of[2][1] * sigma * f->B[i];
}

INLINE void bend(const dvi__chart *chart, int size, int stored, const place *p, lane *in_xi,
                 lane *mixed)
{
  form of_a, of_b;
  memset(in_xi, 0, 9 * sizeof *in_xi);
  memset(mixed, 0, 9 * sizeof *mixed);
  form_of(chart, size, stored, p->a, &of_a);
  form_of(chart, size, stored, p->b, &of_b);
  add_hessian(size, &of_a, p, in_xi);
  add_third(size, &of_b, p, in_xi);
  add_hessian(size, &of_b, p, mixed);
}

/* ---- tangents ---- */

/* Compute column j of A and of dOmega/dxi, with Omega = rate - c_2 once + c_3 twice. */
INLINE void spin_columns(const place *p, int j, const lane *once, const lane *twice, lane *A,
                         lane *D)
{
  const lane by_2 = p->xi[j] * (2 * p->c[4] - p->c[3]), by_3 = p->xi[j] * (3 * p->c[5] - p->c[4]);
  lane e[3] = {{0}}, unused[2][3], turned[3], over_once[3], over_turned[3];
  e[j] += 1;
  lanes_dexp(p->c, -1, p->xi, e, unused[0], unused[1], A);
  lanes_cross(e, p->rate, turned);
  lanes_cross(e, once, over_once);
  lanes_cross(p->xi, turned, over_turned);
  for (int i = 0; i < 3; i++)
    D[i] = by_3 * twice[i] - by_2 * once[i] - p->c[2] * turned[i] +
           p->c[3] * (over_once[i] + over_turned[i]);
}

/* Row i of R x^ is the product of row i with x. */
INLINE void rotation_tangents(const place *p, lane T[3][9], lane S[3][9])
{
  lane Omega[3], once[3], twice[3];
  lanes_dexp(p->c, -1, p->xi, p->rate, once, twice, Omega);
  for (int j = 0; j < 3; j++) {
    lane A[3], D[3], turned[3], bent[3];
    spin_columns(p, j, once, twice, A, D);
    for (int i = 0; i < 9; i += 3) {
      lanes_cross(p->y + i, A, T[j] + i);
      lanes_cross(T[j] + i, Omega, turned);
      lanes_cross(p->y + i, D, bent);
      for (int k = 0; k < 3; k++) S[j][i + k] = turned[k] + bent[k];
    }
  }
}

INLINE void direction_tangents(const dvi__chart *chart, const place *p, lane T[3][9], lane S[3][9])
{
  const lane *c = p->c, d = c[3] - c[2], d_s = 3 * (c[5] - c[4]) + c[3],
             sigma = p->xi[0] * p->rate[0] + p->xi[1] * p->rate[1];
  for (int i = 0; i < 3; i++) {
    const double y0 = chart->y0[i], B[] = {chart->basis[0][i], chart->basis[1][i]};
    const lane X = B[0] * p->xi[0] + B[1] * p->xi[1], U = B[0] * p->rate[0] + B[1] * p->rate[1],
               D = d * X - c[1] * y0, along = d * U + sigma * (d_s * X - d * y0);
    for (int j = 0; j < 2; j++) {
      T[j][i] = c[1] * B[j] + p->xi[j] * D;
      S[j][i] = p->rate[j] * D + sigma * d * B[j] + p->xi[j] * along;
    }
  }
}

INLINE void angle_tangents(const dvi__chart *chart, const place *p, lane T[3][9], lane S[3][9])
{
  for (int i = 0; i < 2; i++) {
    T[0][i] = p->c[0] * chart->basis[0][i] - p->c[1] * p->xi[0] * chart->y0[i];
    S[0][i] = -p->rate[0] * p->y[i];
  }
}

/* ---- moments ---- */

INLINE void get_vector(int vectors, int j, const lane *y, lane *x)
{
  for (int i = 0; i < 3; i++) x[i] = y[i * vectors + j];
}

/* Compute W_b x y of each vector. */
INLINE void turn_vectors(int vectors, const double *W, const lane *y, lane *turned)
{
  for (int j = 0; j < vectors; j++) {
    lane x[3];
    get_vector(vectors, j, y, x);
    turned[j] = W[1] * x[2] - W[2] * x[1];
    turned[vectors + j] = W[2] * x[0] - W[0] * x[2];
    turned[2 * vectors + j] = W[0] * x[1] - W[1] * x[0];
  }
}

INLINE void add_moment(int vectors, const lane *y, const lane *a, lane *N)
{
  for (int j = 0; j < vectors; j++) {
    lane x[3], f[3], product[3];
    get_vector(vectors, j, y, x);
    get_vector(vectors, j, a, f);
    lanes_cross(x, f, product);
    for (int i = 0; i < 3; i++) N[i] += product[i];
  }
}

INLINE void moment_changes(int size, int even, const place *p, const double *W, lane T[3][9],
                           lane S[3][9], lane *C_xi, lane *C_rate)
{
  const int vectors = size == 3 ? 3 : 1;
  for (int j = 0; j < size; j++) {
    lane by_xi[3] = {{0}}, by_rate[3] = {{0}};
    add_moment(vectors, T[j], p->a, by_xi);
    if (!even) {
      add_moment(vectors, S[j], p->b, by_xi);
      add_moment(vectors, T[j], p->b, by_rate);
    }
    for (int i = 0; i < size; i++) {
      const double *w = W + 3 * i;
      C_xi[i * size + j] = w[0] * by_xi[0] + w[1] * by_xi[1] + w[2] * by_xi[2];
      C_rate[i * size + j] = w[0] * by_rate[0] + w[1] * by_rate[1] + w[2] * by_rate[2];
    }
  }
}

/* ---- all nodes ---- */

/* Store columns as the rows of a matrix [stored*size]. */
INLINE void store_columns(int size, int stored, lane columns[3][9], size_t stride, int some,
                          double *to)
{
  for (int i = 0; i < stored; i++)
    for (int j = 0; j < size; j++)
      store_rows(1, &columns[j][i], 0, some, to + (size_t)(i * size + j) * stride);
}

INLINE void turn_some(int size, int stored, const place *p, const double *W, lane T[3][9],
                      lane S[3][9], size_t count, int k, int some, const dvi__chart_bends *to)
{
  lane turned[3][9], C_xi[9], C_rate[9];
  for (int j = 0; j < size; j++) turn_vectors(stored / 3, W + 3 * j, p->y, turned[j]);
  store_columns(size, stored, turned, to->stride, some, to->turned_T + k);
  moment_changes(size, to->even, p, W, T, S, C_xi, C_rate);
  store_rows(size * size, C_xi, count, some, to->C_xi + k);
  if (to->even) return;
  store_rows(size * size, C_rate, count, some, to->C_rate + k);
  for (int j = 0; j < size; j++) turn_vectors(stored / 3, W + 3 * j, p->v, turned[j]);
  store_columns(size, stored, turned, to->stride, some, to->turned_S + k);
}

INLINE void bend_all(const dvi__chart *chart, int size, int stored, const dvi__chart_nodes *n,
                     const double *W, const dvi__chart_bends *to)
{
  const size_t count = (size_t)n->count;
  for (int k = 0; k < n->count; k += DVI__LANES) {
    const int some = n->count - k < DVI__LANES ? n->count - k : DVI__LANES;
    lane T[3][9], S[3][9], in_xi[9], mixed[9];
    place p;
    read_place(size, stored, n, k, some, &p);
    if (size == 3)
      rotation_tangents(&p, T, S);
    else if (size == 2)
      direction_tangents(chart, &p, T, S);
    else
      angle_tangents(chart, &p, T, S);
    store_columns(size, stored, T, to->stride, some, to->T + k);
    store_columns(size, stored, S, to->stride, some, to->S + k);
    bend(chart, size, stored, &p, in_xi, mixed);
    store_rows(size * size, in_xi, count, some, to->in_xi + k);
    store_rows(size * size, mixed, count, some, to->mixed + k);
    if (size > 1 && W != NULL) turn_some(size, stored, &p, W, T, S, count, k, some, to);
  }
}

WIDE static void bend_angle(const dvi__chart *chart, const dvi__chart_nodes *n,
                            const dvi__chart_bends *to)
{
  bend_all(chart, 1, 2, n, NULL, to);
}

WIDE static void bend_direction(const dvi__chart *chart, const dvi__chart_nodes *n, const double *W,
                                const dvi__chart_bends *to)
{
  bend_all(chart, 2, 3, n, W, to);
}

WIDE static void bend_rotation(const dvi__chart *chart, const dvi__chart_nodes *n, const double *W,
                               const dvi__chart_bends *to)
{
  bend_all(chart, 3, 9, n, W, to);
}

static void bend_line(const dvi__chart_nodes *n, const dvi__chart_bends *to)
{
  for (int k = 0; k < n->count; k++) {
    to->T[k] = 1;
    to->S[k] = to->in_xi[k] = to->mixed[k] = 0;
  }
}

void dvi__chart_bend_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes, const double *W,
                           const dvi__chart_bends *bends)
{
  switch (chart->kind) {
  case DVI__LINE: bend_line(nodes, bends); return;
  case DVI__CIRCLE: bend_angle(chart, nodes, bends); return;
  case DVI__SPHERE: bend_direction(chart, nodes, W, bends); return;
  case DVI__ROTATION: bend_rotation(chart, nodes, W, bends); return;
  }
}
