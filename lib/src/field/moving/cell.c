/* Cells with linear fields. Between nodes (x_0,u_0) and (x_1,u_1), with h = x_1 - x_0, s = Du/h and
 * a = 0..1 along the cell,
 *
 *     L_e = h sum_k w_k l(t, x, u, u_t, u_x) + h m(u_0,u_1) - kappa (h - H)^2/h + mu/2 x_0'^2,
 *     u = (1-a) u_0 + a u_1,    u_x = s,    u_t = (1-a) u_0' + a u_1' - s ((1-a) x_0' + a x_1').
 *
 * This is the density in coordinates of the mesh, L(phi, q, Dq (D phi)^-1) det D phi, with the map
 * phi from cells of one length to those at x. Source: Leok 2004, sec. 5.6, whose formula has
 * L(j1 q) |D phi|, but the derivatives of q must be those by x. */
#include <string.h>

#include "field/moving/moving.h"

enum {
  LANES = 64,  /* points of a call of the density */
  ENDS = 2,    /* nodes of a cell */
  ENTRIES = 8, /* numbers on which a variable depends */
  CELL_NUMBERS = 2 * ENDS * DVI__NODE_NUMBERS
};

/* A variable of the density, with its derivatives by some numbers of the cell. */
typedef struct slope {
  double value, by[ENTRIES];
  int count, at[ENTRIES];
} slope;

/* The density at the points of some cells, each array variable by variable. */
typedef struct lanes {
  int cells, count;
  double y[LANES][CELL_NUMBERS];
  double x[LANES], z[DVI__MOVING_VARIABLES * LANES];
  double l[LANES], l_z[DVI__MOVING_VARIABLES * LANES], l_zz[DVI__MOVING_PAIRS * LANES];
  double l_x[LANES], l_xz[DVI__MOVING_VARIABLES * LANES], l_xx[LANES];
} lanes;

static const double sign[ENDS] = {-1, 1};

static void depend(slope *z, int at, double by)
{
  z->at[z->count] = at;
  z->by[z->count++] = by;
}

static double length_of(const dvi_moving *m, const double *y)
{
  return y[m->numbers] - y[0];
}

static double slope_of(const dvi_moving *m, const double *y, int component)
{
  const double *u = y + 1 + component;
  return (u[m->numbers] - u[0]) / length_of(m, y);
}

/* ---- variables ---- */

static void add_slope(const dvi_moving *m, const double *y, int component, double factor, slope *z)
{
  const double h = length_of(m, y), s = slope_of(m, y, component);
  z->value += factor * s;
  for (int a = 0; a < ENDS; a++) {
    depend(z, a * m->numbers, -factor * sign[a] * s / h);
    depend(z, a * m->numbers + 1 + component, factor * sign[a] / h);
  }
}

/* Give number k of a node, or its rate with from = half, at a point of the cell. */
static double between(const dvi_moving *m, const double *y, double a, int k)
{
  return (1 - a) * y[k] + a * y[m->numbers + k];
}

static slope find_position(const dvi_moving *m, const double *y, double a, int k)
{
  slope z = {.value = between(m, y, a, k)};
  depend(&z, k, 1 - a);
  depend(&z, m->numbers + k, a);
  return z;
}

static slope find_rate(const dvi_moving *m, const double *y, double a, int component)
{
  const double *rate = y + ENDS * m->numbers;
  const double s = slope_of(m, y, component), share[ENDS] = {1 - a, a};
  slope z = {.value = between(m, rate, a, 1 + component)};
  add_slope(m, y, component, -between(m, rate, a, 0), &z);
  for (int b = 0; b < ENDS; b++) {
    depend(&z, (ENDS + b) * m->numbers, -share[b] * s);
    depend(&z, (ENDS + b) * m->numbers + 1 + component, share[b]);
  }
  return z;
}

static slope find_variable(const dvi_moving *m, const double *y, double a, const dvi_jet *jet)
{
  slope z = {0};
  if (jet->rate) return find_rate(m, y, a, jet->component);
  if (jet->order[0] == 0) return find_position(m, y, a, 1 + jet->component);
  add_slope(m, y, jet->component, 1, &z);
  return z;
}

/* ---- second derivatives of variables ---- */

static void add_pair(dvi__stencil *s, int i, int j, double value)
{
  s->second[i * s->size + j] += value;
  s->second[j * s->size + i] += value;
}

/* Add factor times the second derivatives of s = Du/h. */
static void bend_slope(const dvi_moving *m, int component, double factor, dvi__stencil *s)
{
  const double h = length_of(m, s->y), Du_by_h = slope_of(m, s->y, component);
  for (int a = 0; a < ENDS; a++)
    for (int b = 0; b < ENDS; b++) {
      const double by = factor * sign[a] * sign[b] / (h * h);
      const int x = a * m->numbers, u = b * m->numbers + 1 + component;
      s->second[x * s->size + b * m->numbers] += 2 * Du_by_h * by;
      add_pair(s, x, u, -by);
    }
}

static void bend_variable(const dvi_moving *m, double a, const dvi_jet *jet, double factor,
                          dvi__stencil *s)
{
  if (!jet->rate && jet->order[0] == 0) return;
  if (!jet->rate) {
    bend_slope(m, jet->component, factor, s);
    return;
  }
  slope of_slope = {0};
  add_slope(m, s->y, jet->component, -factor, &of_slope);
  bend_slope(m, jet->component, -factor * between(m, s->y + s->half, a, 0), s);
  for (int i = 0; i < of_slope.count; i++) {
    add_pair(s, of_slope.at[i], s->half, (1 - a) * of_slope.by[i]);
    add_pair(s, of_slope.at[i], s->half + m->numbers, a * of_slope.by[i]);
  }
}

/* ---- the density. `order` is that of the highest derivatives that are wanted ---- */

static int gather(const dvi_moving *m, const dvi__moving_state *state, int cell, lanes *w)
{
  w->count = w->cells * m->points;
  for (int c = 0; c < w->cells; c++) {
    const int returned = dvi__moving_gather(m, state, cell + c, ENDS, w->y[c]);
    if (returned != 0) return returned;
    for (int k = 0; k < m->points; k++) {
      const int lane = c * m->points + k;
      w->x[lane] = between(m, w->y[c], m->gauss[k], 0);
      for (int j = 0; j < m->part.variables; j++)
        w->z[j * w->count + lane] =
            find_variable(m, w->y[c], m->gauss[k], &m->part.variable[j]).value;
    }
  }
  return 0;
}

static int evaluate(const dvi_moving *m, double t, int order, lanes *w)
{
  const dvi_density_part *p = &m->part;
  const int returned = p->density(w->count, t, w->x, w->z, w->l, order > 0 ? w->l_z : NULL,
                                  order > 1 ? w->l_zz : NULL, p->user);
  if (returned != 0 || m->space_derivative == NULL || order == 0) return returned;
  return m->space_derivative(w->count, t, w->x, w->z, w->l_x, order > 1 ? w->l_xz : NULL,
                             order > 1 ? w->l_xx : NULL, m->user);
}

/* Add factor times a product of two slopes to the second derivatives. */
static void add_product(const slope *a, const slope *b, double factor, dvi__stencil *s)
{
  for (int i = 0; i < a->count; i++)
    for (int j = 0; j < b->count; j++)
      s->second[a->at[i] * s->size + b->at[j]] += factor * a->by[i] * b->by[j];
}

static void add_both(const slope *a, const slope *b, double factor, dvi__stencil *s)
{
  add_product(a, b, factor, s);
  add_product(b, a, factor, s);
}

static void add_first(const slope *z, double factor, dvi__stencil *s)
{
  for (int i = 0; i < z->count; i++) s->first[z->at[i]] += factor * z->by[i];
}

/* Add the point of a lane, h w l, to the stencil. z has the variables and then the position. */
static void add_second_of_point(const dvi_moving *m, const lanes *w, int lane, const slope *z,
                                dvi__stencil *s)
{
  const int k = lane % m->points, n = m->part.variables;
  const double weight = m->weight[k], volume = weight * length_of(m, s->y);
  const slope h = {.count = 2, .at = {0, m->numbers}, .by = {-1, 1}};
  for (int j = 0; j < n; j++) {
    const double l_z = w->l_z[j * w->count + lane];
    add_both(&h, z + j, weight * l_z, s);
    bend_variable(m, m->gauss[k], &m->part.variable[j], volume * l_z, s);
  }
  for (int p = 0; p < m->part.pairs; p++) {
    const slope *a = z + m->pair[p][0], *b = z + m->pair[p][1];
    const double l_zz = volume * w->l_zz[p * w->count + lane];
    if (a == b)
      add_product(a, a, l_zz, s);
    else
      add_both(a, b, l_zz, s);
  }
  if (m->space_derivative == NULL) return;
  add_both(&h, z + n, weight * w->l_x[lane], s);
  add_product(z + n, z + n, volume * w->l_xx[lane], s);
  for (int j = 0; j < n; j++) add_both(z + n, z + j, volume * w->l_xz[j * w->count + lane], s);
}

static void add_point(const dvi_moving *m, int order, const lanes *w, int lane, dvi__stencil *s)
{
  const int k = lane % m->points, n = m->part.variables;
  const double weight = m->weight[k], volume = weight * length_of(m, s->y);
  slope z[DVI__MOVING_VARIABLES + 1];
  s->value += volume * w->l[lane];
  if (order == 0) return;
  for (int j = 0; j < n; j++) z[j] = find_variable(m, s->y, m->gauss[k], &m->part.variable[j]);
  z[n] = find_position(m, s->y, m->gauss[k], 0);
  s->first[0] -= weight * w->l[lane];
  s->first[m->numbers] += weight * w->l[lane];
  for (int j = 0; j < n; j++) add_first(z + j, volume * w->l_z[j * w->count + lane], s);
  if (m->space_derivative != NULL) add_first(z + n, volume * w->l_x[lane], s);
  if (order > 1) add_second_of_point(m, w, lane, z, s);
}

/* ---- other parts ---- */

/* Add h m(u_0,u_1). */
static int add_mean(const dvi_moving *m, int order, dvi__stencil *s)
{
  enum { BOTH = 2 * DVI_MOVING_COMPONENTS_MAX };
  const int n = 2 * m->components;
  const double h = length_of(m, s->y), *u = s->y + 1;
  double mean, first[BOTH], second[BOTH * (BOTH + 1) / 2];
  int at[BOTH];
  const int returned = m->mean.mean(1, u, u + m->numbers, &mean, order > 0 ? first : NULL,
                                    order > 1 ? second : NULL, m->mean.user);
  if (returned != 0) return returned;
  s->value += h * mean;
  for (int i = 0; i < n; i++) at[i] = i / m->components * m->numbers + 1 + i % m->components;
  for (int a = 0; a < ENDS && order > 0; a++) s->first[a * m->numbers] += sign[a] * mean;
  for (int i = 0; i < n && order > 0; i++) s->first[at[i]] += h * first[i];
  for (int i = 0, p = 0; i < n && order > 1; i++) {
    for (int a = 0; a < ENDS; a++) add_pair(s, a * m->numbers, at[i], sign[a] * first[i]);
    for (int j = 0; j < i; j++, p++) add_pair(s, at[i], at[j], h * second[p]);
    s->second[at[i] * (s->size + 1)] += h * second[p++];
  }
  return 0;
}

/* Add mu x_0'^2/2 - kappa (h - H)^2/h. */
static void add_mesh(const dvi_moving *m, int cell, dvi__stencil *s)
{
  const double h = length_of(m, s->y), H = m->node[cell + 1] - m->node[cell];
  const double rate = s->y[s->half], stiff = 2 * m->kappa * H * H / (h * h * h);
  const double pressure = m->kappa * (1 - H / h) * (1 + H / h);
  s->value += 0.5 * m->mu * rate * rate - m->kappa * (h - H) * (h - H) / h;
  s->first[s->half] += m->mu * rate;
  s->second[s->half * (s->size + 1)] += m->mu;
  for (int a = 0; a < ENDS; a++) {
    s->first[a * m->numbers] -= sign[a] * pressure;
    for (int b = 0; b < ENDS; b++)
      s->second[a * m->numbers * s->size + b * m->numbers] -= sign[a] * sign[b] * stiff;
  }
}

static int add_cell(const dvi_moving *m, int order, const lanes *w, int lane, int cell,
                    const dvi__moving_sums *sums)
{
  dvi__stencil s;
  dvi__stencil_clear(m, ENDS, &s);
  memcpy(s.y, w->y[lane], (size_t)s.size * sizeof *s.y);
  for (int k = 0; k < m->points; k++) add_point(m, order, w, lane * m->points + k, &s);
  const int returned = m->mean.mean != NULL ? add_mean(m, order, &s) : 0;
  if (returned != 0) return returned;
  if (dvi__moving_is_free(m)) add_mesh(m, cell, &s);
  dvi__stencil_scatter(m, &m->cell, cell, &s, sums);
  return 0;
}

int dvi__moving_add_cells(const dvi_moving *m, const dvi__moving_state *state,
                          const dvi__moving_sums *sums)
{
  const int second = sums->L_qq || sums->L_qv || sums->L_vv;
  const int order = second ? 2 : sums->L_q || sums->L_v;
  const int most = LANES / m->points;
  for (int cell = 0; cell < m->cells; cell += most) {
    lanes w;
    w.cells = m->cells - cell < most ? m->cells - cell : most;
    int returned = gather(m, state, cell, &w);
    if (returned == 0) returned = evaluate(m, state->t, order, &w);
    for (int c = 0; c < w.cells && returned == 0; c++)
      returned = add_cell(m, order, &w, c, cell + c, sums);
    if (returned != 0) return returned;
  }
  return 0;
}
