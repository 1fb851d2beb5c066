/* Second derivatives of linear fields, recovered at nodes. With slopes s- and s+ of the cells at
 * both sides of a node, and lengths h- and h+,
 *
 *     L = -eps^2/2 sum_a (s+ - s-)^2 / m,    u_xx = (s+ - s-)/m,    m = (h- + h+)/2.
 *
 * End nodes have none, which is the natural condition u_xx = 0. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "field/moving/moving.h"

enum { AROUND = 3, MOST = 3 * DVI__NODE_NUMBERS };

/* A function of the numbers of three nodes. */
typedef struct form {
  double value, first[MOST], second[MOST][MOST];
} form;

/* Add the slope of the cell right of node `at` of the stencil, times a sign, with second
 * derivatives if they are wanted. */
static void add_slope(const dvi_moving *m, const double *y, int at, int component, double factor,
                      int with_second, form *f)
{
  const double h = y[(at + 1) * m->numbers] - y[at * m->numbers];
  const int u = at * m->numbers + 1 + component;
  const double s = (y[u + m->numbers] - y[u]) / h, sign[2] = {-1, 1};
  f->value += factor * s;
  for (int a = 0; a < 2; a++) {
    const int xa = (at + a) * m->numbers, ua = xa + 1 + component;
    f->first[xa] -= factor * sign[a] * s / h;
    f->first[ua] += factor * sign[a] / h;
    for (int b = 0; b < 2 && with_second; b++) {
      const int xb = (at + b) * m->numbers, ub = xb + 1 + component;
      const double by = factor * sign[a] * sign[b] / (h * h);
      f->second[xa][xb] += 2 * s * by;
      f->second[xa][ub] -= by;
      f->second[ub][xa] -= by;
    }
  }
}

/* Add -eps^2/2 d^2/m, with d the difference of two slopes, and m' = (-1/2, 0, 1/2). */
static void add_bend(const dvi_moving *m, int component, int with_second, dvi__stencil *s)
{
  form d;
  memset(&d, 0, with_second ? sizeof d : offsetof(form, second));
  add_slope(m, s->y, 0, component, -1, with_second, &d);
  add_slope(m, s->y, 1, component, 1, with_second, &d);
  double of_m[MOST] = {0};
  of_m[0] = -0.5;
  of_m[2 * m->numbers] = 0.5;
  const double r = d.value, width = 0.5 * (s->y[2 * m->numbers] - s->y[0]);
  const double factor = -0.5 * m->dispersion * m->dispersion / width;
  s->value += factor * r * r;
  for (int i = 0; i < s->half; i++) {
    const double of_i = of_m[i] / width;
    s->first[i] += factor * r * (2 * d.first[i] - r * of_i);
    for (int j = 0; j < s->half && with_second; j++) {
      const double of_j = of_m[j] / width;
      const double change = (d.first[i] - r * of_i) * (d.first[j] - r * of_j);
      s->second[i * s->size + j] += 2 * factor * (change + r * d.second[i][j]);
    }
  }
}

int dvi__moving_add_bends(const dvi_moving *m, const dvi__moving_state *state,
                          const dvi__moving_sums *sums)
{
  const int with_second = sums->L_qq || sums->L_qv || sums->L_vv;
  for (int k = 0; k < m->bend.count; k++) {
    dvi__stencil s;
    dvi__stencil_clear(m, AROUND, &s);
    const int returned = dvi__moving_gather(m, state, m->bend.corner + AROUND * k, AROUND, s.y);
    if (returned != 0) return returned;
    for (int c = 0; c < m->components; c++) add_bend(m, c, with_second, &s);
    dvi__stencil_scatter(m, &m->bend, k, &s, sums);
  }
  return 0;
}
