/* Viscosity. The rate of the field at a node is w = u' - s x', with the slope s of the parabola
 * through the node and its neighbours (of the only cell at an end). The force is F = -dR/dv with
 *
 *     R = nu/2 sum_e (w_1 - w_0)^2 / h_e,     s = (h+ s- + h- s+)/(h- + h+).
 *
 * A slope of one cell would make w jump at nodes, and a wave that travels with its nodes free of
 * losses. R is a square, so that energy is lost at the rate 2R, as by nu int u_tx^2. */
#include <stddef.h>
#include <string.h>

#include "field/moving/moving.h"

enum { AROUND = 4, MOST = AROUND * DVI__NODE_NUMBERS };

/* A recovered slope with its derivatives by the numbers of a stencil. */
typedef struct recovered {
  double value, by[MOST];
} recovered;

/* The force of one cell, between the nodes 1 and 2 of a stencil, and its derivatives. */
typedef struct drag {
  int n; /* numbers of the stencil */
  double y[2 * MOST], force[MOST], by_q[MOST][MOST], by_v[MOST][MOST];
} drag;

/* Give the slope of the cell right of node `at`. */
static recovered cell_slope(const dvi_moving *m, const double *y, int at, int component)
{
  const int x = at * m->numbers, u = x + 1 + component, next = m->numbers;
  const double h = y[x + next] - y[x];
  recovered s = {.value = (y[u + next] - y[u]) / h};
  s.by[x] = s.value / h;
  s.by[x + next] = -s.value / h;
  s.by[u] = -1 / h;
  s.by[u + next] = 1 / h;
  return s;
}

/* Give the slope at node `at`. is_end tells that a neighbour is missing. */
static recovered node_slope(const dvi_moving *m, const double *y, int at, int component, int is_end)
{
  if (is_end) return cell_slope(m, y, 1, component);
  const int x = at * m->numbers, step = m->numbers;
  const double before = y[x] - y[x - step], after = y[x + step] - y[x], both = before + after;
  const recovered left = cell_slope(m, y, at - 1, component);
  const recovered right = cell_slope(m, y, at, component);
  recovered s = {.value = (after * left.value + before * right.value) / both};
  for (int i = 0; i < AROUND * m->numbers; i++)
    s.by[i] = (after * left.by[i] + before * right.by[i]) / both;
  s.by[x - step] += (s.value - right.value) / both;
  s.by[x] += (right.value - left.value) / both;
  s.by[x + step] += (left.value - s.value) / both;
  return s;
}

/* With r = w_1 - w_0 = g.v, the force is -(nu/h) r g. Derivatives are added if they are wanted. */
static void add_drag(const dvi_moving *m, int component, const recovered *slope, int with_second,
                     drag *d)
{
  const double sign[2] = {-1, 1}, *rate = d->y + d->n;
  const int x[2] = {m->numbers, 2 * m->numbers};
  const double h = d->y[x[1]] - d->y[x[0]], factor = -m->viscosity / h;
  double g[MOST] = {0}, r = 0, r_q[MOST];
  for (int a = 0; a < 2; a++) {
    g[x[a]] = -sign[a] * slope[a].value;
    g[x[a] + 1 + component] = sign[a];
    r += sign[a] * (rate[x[a] + 1 + component] - slope[a].value * rate[x[a]]);
  }
  for (int i = 0; i < d->n; i++) d->force[i] += factor * r * g[i];
  if (!with_second) return;
  for (int j = 0; j < d->n; j++) r_q[j] = slope[0].by[j] * rate[x[0]] - slope[1].by[j] * rate[x[1]];
  for (int a = 0; a < 2; a++) r_q[x[a]] -= sign[a] * r / h;
  for (int i = 0; i < d->n; i++)
    for (int j = 0; j < d->n && g[i] != 0; j++) {
      d->by_q[i][j] += factor * g[i] * r_q[j];
      d->by_v[i][j] += factor * g[i] * g[j];
    }
  for (int a = 0; a < 2; a++)
    for (int j = 0; j < d->n; j++) d->by_q[x[a]][j] -= factor * r * sign[a] * slope[a].by[j];
}

/* Read the nodes around cell k. Those beyond an end are images of the end, and are not used. */
static int gather(const dvi_moving *m, const dvi__moving_state *state, int k, int with_second,
                  drag *d)
{
  double y[2 * MOST];
  const int first = m->periodic || k > 0 ? 0 : 1;
  const int last = m->periodic || k + 1 < m->cells ? AROUND : AROUND - 1;
  const int read = (last - first) * m->numbers;
  const int returned = dvi__moving_gather(m, state, m->drag.corner + AROUND * k + first,
                                          last - first, y);
  memset(d, 0, with_second ? sizeof *d : offsetof(drag, by_q));
  d->n = AROUND * m->numbers;
  memcpy(d->y + first * m->numbers, y, (size_t)read * sizeof *y);
  memcpy(d->y + d->n + first * m->numbers, y + read, (size_t)read * sizeof *y);
  return returned;
}

static int evaluate(const dvi_moving *m, const dvi__moving_state *state, int k, int with_second,
                    drag *d)
{
  const int returned = gather(m, state, k, with_second, d);
  for (int c = 0; c < m->components && returned == 0; c++) {
    const recovered slope[2] = {node_slope(m, d->y, 1, c, !m->periodic && k == 0),
                                node_slope(m, d->y, 2, c, !m->periodic && k + 1 == m->cells)};
    add_drag(m, c, slope, with_second, d);
  }
  return returned;
}

int dvi__moving_drag(double t, const double *q, const double *v, double *F, void *user)
{
  const dvi_moving *m = user;
  memset(F, 0, (size_t)m->unknowns * sizeof *F);
  for (int k = 0; k < m->cells; k++) {
    drag d;
    const int returned = evaluate(m, &(dvi__moving_state){t, q, v}, k, 0, &d);
    if (returned != 0) return returned;
    for (int i = 0; i < d.n; i++) {
      const int node = m->drag.corner[AROUND * k + i / m->numbers].node;
      const int at = node < 0 ? -1 : m->unknown[node * m->numbers + i % m->numbers];
      if (at >= 0) F[at] += d.force[i];
    }
  }
  return 0;
}

int dvi__moving_drag_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                              void *user)
{
  const dvi_moving *m = user;
  const size_t bytes = (size_t)dvi__pattern_entries(&m->drag_pattern) * sizeof(double);
  memset(F_q, 0, bytes);
  memset(F_v, 0, bytes);
  for (int k = 0; k < m->cells; k++) {
    drag d;
    const int returned = evaluate(m, &(dvi__moving_state){t, q, v}, k, 1, &d);
    if (returned != 0) return returned;
    const int *entry = m->drag.entry + (size_t)k * (size_t)d.n * (size_t)d.n;
    for (int i = 0; i < d.n; i++)
      for (int j = 0; j < d.n; j++) {
        const int at = entry[i * d.n + j];
        if (at >= 0) F_q[at] += d.by_q[i][j];
        if (at >= 0) F_v[at] += d.by_v[i][j];
      }
  }
  return 0;
}
