/* The geometry of a cell. A vertex X_b that moves by d carries the field of the barycentric
 * coordinate L_a to L_a(x - L_b d). From this, with V the volume,
 *
 *     dV/dX_bj = V g_bj,    dg_ai/dX_bj = -g_bi g_aj,    g_ai = dL_a/dx_i.  */
#include "field/moving/moving.h"

enum { X, Y };

double dvi__moving_volume(const dvi_moving *m, const double *y)
{
  const double *b = y + m->numbers, *c = b + m->numbers;
  if (m->dimension == 1) return b[X] - y[X];
  return 0.5 * ((b[X] - y[X]) * (c[Y] - y[Y]) - (b[Y] - y[Y]) * (c[X] - y[X]));
}

dvi__simplex dvi__moving_simplex(const dvi_moving *m, const double *y)
{
  dvi__simplex s = {.volume = dvi__moving_volume(m, y)};
  const double *at[DVI__CELL_NODES] = {y, y + m->numbers, y + 2 * m->numbers};
  for (int a = 0; a < DVI__CELL_NODES && m->dimension == 2; a++) {
    const double *next = at[(a + 1) % DVI__CELL_NODES], *last = at[(a + 2) % DVI__CELL_NODES];
    s.gradient[a][X] = 0.5 * (next[Y] - last[Y]) / s.volume;
    s.gradient[a][Y] = 0.5 * (last[X] - next[X]) / s.volume;
  }
  if (m->dimension == 2) return s;
  s.gradient[0][X] = -1 / s.volume;
  s.gradient[1][X] = 1 / s.volume;
  return s;
}

void dvi__moving_reference(const dvi_moving *m, const dvi__corner *corner, double *x)
{
  for (int i = 0; i < m->dimension; i++)
    x[i] = m->node[i * m->listed + corner->node] + corner->turn[i] * m->period[i];
}

/* ---- the barrier ---- */

/* Add -kappa V B with B = J + (1 + D)/J - 1 - n, J = V_now/V, and D = |F|^2/2 in two dimensions,
 *
 *     D = 1/2 sum_ab K_ab X_a . X_b,    K_ab = G_a . G_b,
 *
 * with the gradients G of reference. In one dimension D = 0, and V B = (h - H)^2/h. B is 0 for a
 * cell as it was, which may be turned, grows without bounds as its area vanishes, and is
 * polyconvex. */
typedef struct barrier {
  double J, D, by_J[DVI__CELL_NODES][DVI_MOVING_AXES_MAX],
      by_D[DVI__CELL_NODES][DVI_MOVING_AXES_MAX], K[DVI__CELL_NODES][DVI__CELL_NODES];
} barrier;

static dvi__simplex reference(const dvi_moving *m, int cell)
{
  double y[DVI__CELL_NODES * DVI__NODE_NUMBERS] = {0};
  const dvi__corner *corner = m->cell.corner + (size_t)cell * (size_t)m->cell.nodes;
  for (int a = 0; a <= m->dimension; a++) dvi__moving_reference(m, corner + a, y + a * m->numbers);
  return dvi__moving_simplex(m, y);
}

static void add_shape(const dvi__simplex *was, const dvi_moving *m, const double *y, barrier *b)
{
  for (int a = 0; a <= m->dimension; a++)
    for (int c = 0; c <= m->dimension; c++) {
      for (int i = 0; i < m->dimension; i++)
        b->K[a][c] += was->gradient[a][i] * was->gradient[c][i];
      for (int i = 0; i < m->dimension; i++)
        b->by_D[a][i] += b->K[a][c] * (y[c * m->numbers + i] - y[i]);
    }
  for (int a = 0; a <= m->dimension; a++)
    for (int i = 0; i < m->dimension; i++)
      b->D += 0.5 * b->by_D[a][i] * (y[a * m->numbers + i] - y[i]);
}

static void add_second(const dvi_moving *m, const dvi__simplex *now, const barrier *b,
                       double factor, dvi__stencil *s)
{
  const double J = b->J, twice = 2 * (1 + b->D) / (J * J * J), of_J = 1 - (1 + b->D) / (J * J);
  const int n = m->dimension, numbers = (n + 1) * n;
  for (int k = 0; k < numbers * numbers; k++) {
    const int a = k / numbers / n, i = k / numbers % n, c = k % numbers / n, j = k % n;
    const double(*g)[DVI_MOVING_AXES_MAX] = now->gradient;
    const double area = J * (g[a][i] * g[c][j] - g[a][j] * g[c][i]);
    const double mixed = b->by_J[a][i] * b->by_D[c][j] + b->by_D[a][i] * b->by_J[c][j];
    s->second[(a * m->numbers + i) * s->size + c * m->numbers + j] +=
        factor * (twice * b->by_J[a][i] * b->by_J[c][j] - mixed / (J * J) + of_J * area +
                  (i == j ? b->K[a][c] / J : 0));
  }
}

void dvi__moving_add_barrier(const dvi_moving *m, int cell, const dvi__simplex *now,
                             dvi__stencil *s)
{
  const dvi__simplex was = reference(m, cell);
  const double factor = -m->kappa * was.volume;
  barrier b = {.J = now->volume / was.volume};
  if (m->dimension == 2) add_shape(&was, m, s->y, &b);
  const double J = b.J, D = b.D;
  s->value += factor * ((J - 1) * (J - 1) / J + (m->dimension == 2 ? (D - J) / J : 0));
  for (int a = 0; a <= m->dimension; a++)
    for (int i = 0; i < m->dimension; i++) {
      b.by_J[a][i] = J * now->gradient[a][i];
      s->first[a * m->numbers + i] += factor *
                                      ((1 - (1 + D) / (J * J)) * b.by_J[a][i] + b.by_D[a][i] / J);
    }
  add_second(m, now, &b, factor, s);
}
