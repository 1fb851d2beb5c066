/* Cells with linear fields. In a cell of the volume V with barycentric coordinates L_a, and the
 * gradient s = sum_a u_a grad L_a,
 *
 *     L_e = V (sum_k w_k l(t, x, u, u_t, s) + m(u_0,u_1)) - kappa V_0 B,
 *     u = sum_a L_a u_a,    u_t = sum_a L_a (u_a' - s . x_a').
 *
 * This is the density in coordinates of the mesh, L(phi, q, Dq (D phi)^-1) det D phi, with the map
 * phi from cells that rest to those at x. Source: Leok 2004, sec. 5.6, whose formula has
 * L(j1 q) |D phi|, but the derivatives of q must be those by x. */
#include <string.h>

#include "field/moving/moving.h"

enum {
  LANES = 64, /* points of a call of the density */
  AXES = DVI_MOVING_AXES_MAX,
  ENTRIES = 2 * DVI__CELL_NODES * (AXES + 1), /* numbers on which a variable depends */
  POSITION_PAIRS = AXES * (AXES + 1) / 2
};

/* The derivatives of a variable of the density by some numbers of the cell. */
typedef struct slope {
  double by[ENTRIES];
  int count, at[ENTRIES];
} slope;

typedef dvi__moving_element element;

/* The density at the points of some cells, each array variable by variable. */
typedef struct lanes {
  int cells, count;
  element cell[LANES];
  double x[AXES * LANES], z[DVI__MOVING_VARIABLES * LANES];
  double l[LANES], l_z[DVI__MOVING_VARIABLES * LANES], l_zz[DVI__MOVING_PAIRS * LANES];
  double l_x[AXES * LANES], l_xz[AXES * DVI__MOVING_VARIABLES * LANES],
      l_xx[POSITION_PAIRS * LANES];
} lanes;

static void depend(slope *z, int at, double by)
{
  z->at[z->count] = at;
  z->by[z->count++] = by;
}

/* Give the place of coordinate i of node a, and that of a component. */
static int position_at(const element *e, int a, int i)
{
  return a * e->m->numbers + i;
}

static int value_at(const element *e, int a, int component)
{
  return a * e->m->numbers + e->m->dimension + component;
}

static void find_gradients(element *e)
{
  for (int c = 0; c < e->m->components; c++) {
    const double *u = e->y + value_at(e, 0, c);
    for (int i = 0; i < e->m->dimension; i++)
      for (int a = 1; a < e->nodes; a++)
        e->gradient[c][i] += e->simplex.gradient[a][i] * (u[a * e->m->numbers] - u[0]);
  }
}

static double dot(const element *e, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < e->m->dimension; i++) sum += a[i] * b[i];
  return sum;
}

/* ---- variables ---- */

double dvi__moving_between(const element *e, const double *place, int number)
{
  double sum = 0;
  for (int a = 0; a < e->nodes; a++) sum += place[a] * e->y[a * e->m->numbers + number];
  return sum;
}

/* Give the negative velocity of the mesh at a point. */
static void find_wind(const element *e, const double *place, double *wind)
{
  for (int i = 0; i < e->m->dimension; i++) wind[i] = -dvi__moving_between(e, place, e->rates + i);
}

/* Tell along which axis a variable is a derivative, or -1. */
static int axis_of(const dvi_jet *jet)
{
  return jet->order[0] > 0 ? 0 : jet->order[1] > 0 ? 1 : -1;
}

double dvi__moving_variable(const element *e, const double *place, const dvi_jet *jet)
{
  const int number = value_at(e, 0, jet->component);
  double wind[AXES];
  if (!jet->rate && axis_of(jet) >= 0) return e->gradient[jet->component][axis_of(jet)];
  if (!jet->rate) return dvi__moving_between(e, place, number);
  find_wind(e, place, wind);
  return dvi__moving_between(e, place, e->rates + number) +
         dot(e, wind, e->gradient[jet->component]);
}

/* ---- first derivatives of variables ---- */

/* Add those of the derivative of a component along a vector. */
static void add_slope(const element *e, int component, const double *along, slope *z)
{
  for (int a = 0; a < e->nodes; a++) {
    const double by = dot(e, along, e->simplex.gradient[a]);
    for (int i = 0; i < e->m->dimension; i++)
      depend(z, position_at(e, a, i), -by * e->gradient[component][i]);
    depend(z, value_at(e, a, component), by);
  }
}

static void add_number(const element *e, const double *place, int number, slope *z)
{
  for (int a = 0; a < e->nodes; a++) depend(z, a * e->m->numbers + number, place[a]);
}

static void add_rate(const element *e, const double *place, int component, slope *z)
{
  double wind[AXES];
  find_wind(e, place, wind);
  add_slope(e, component, wind, z);
  for (int a = 0; a < e->nodes; a++) {
    for (int i = 0; i < e->m->dimension; i++)
      depend(z, e->rates + position_at(e, a, i), -place[a] * e->gradient[component][i]);
    depend(z, e->rates + value_at(e, a, component), place[a]);
  }
}

static const double unit[AXES][AXES] = {{1, 0}, {0, 1}};

static void find_variable(const element *e, const double *place, const dvi_jet *jet, slope *z)
{
  z->count = 0;
  if (jet->rate)
    add_rate(e, place, jet->component, z);
  else if (axis_of(jet) < 0)
    add_number(e, place, value_at(e, 0, jet->component), z);
  else
    add_slope(e, jet->component, unit[axis_of(jet)], z);
}

/* ---- second derivatives of variables ---- */

static void add_pair(dvi__stencil *s, int i, int j, double value)
{
  s->second[i * s->size + j] += value;
  s->second[j * s->size + i] += value;
}

/* Add those of the derivative along a vector, with b = along . grad L,
 *
 *     d2/dX_ai dX_cj = b_c g_aj s_i + b_a g_ci s_j,    d2/dX_ai du_c = -b_a g_ci,
 *
 * where s is the gradient of the component. */
static void bend_slope(const element *e, int component, const double *along, dvi__stencil *s)
{
  const double *of_u = e->gradient[component];
  for (int a = 0; a < e->nodes; a++)
    for (int c = 0; c < e->nodes; c++) {
      const double *of_a = e->simplex.gradient[a], *of_c = e->simplex.gradient[c];
      const double by_a = dot(e, along, of_a), by_c = dot(e, along, of_c);
      for (int i = 0; i < e->m->dimension; i++) {
        add_pair(s, position_at(e, a, i), value_at(e, c, component), -by_a * of_c[i]);
        for (int j = 0; j < e->m->dimension; j++)
          s->second[position_at(e, a, i) * s->size + position_at(e, c, j)] +=
              by_c * of_a[j] * of_u[i] + by_a * of_c[i] * of_u[j];
      }
    }
}

static void bend_variable(const element *e, const double *place, const dvi_jet *jet, double factor,
                          dvi__stencil *s)
{
  double along[AXES];
  if (!jet->rate && axis_of(jet) < 0) return;
  if (jet->rate)
    find_wind(e, place, along);
  else
    memcpy(along, unit[axis_of(jet)], sizeof along);
  for (int i = 0; i < e->m->dimension; i++) along[i] *= factor;
  bend_slope(e, jet->component, along, s);
  for (int i = 0; i < e->m->dimension && jet->rate; i++) {
    slope by_axis = {.count = 0};
    add_slope(e, jet->component, unit[i], &by_axis);
    for (int k = 0; k < by_axis.count; k++)
      for (int a = 0; a < e->nodes; a++)
        add_pair(s, by_axis.at[k], e->rates + position_at(e, a, i),
                 -factor * place[a] * by_axis.by[k]);
  }
}

/* ---- the density. `order` is that of the highest derivatives that are wanted ---- */

int dvi__moving_element_at(const dvi_moving *m, const dvi__moving_state *state, int cell,
                           element *e)
{
  *e = (element){.m = m, .nodes = m->cell.nodes, .rates = m->cell.nodes * m->numbers};
  const dvi__corner *corner = m->cell.corner + (size_t)cell * (size_t)e->nodes;
  const int returned = dvi__moving_gather(m, state, corner, e->nodes, e->y);
  if (returned != 0) return returned;
  e->simplex = dvi__moving_simplex(m, e->y);
  find_gradients(e);
  return 0;
}

static int gather(const dvi_moving *m, const dvi__moving_state *state, int cell, lanes *w)
{
  w->count = w->cells * m->points;
  for (int c = 0; c < w->cells; c++) {
    element *e = &w->cell[c];
    const int returned = dvi__moving_element_at(m, state, cell + c, e);
    if (returned != 0) return returned;
    for (int k = 0; k < m->points; k++) {
      const int lane = c * m->points + k;
      for (int i = 0; i < m->dimension; i++)
        w->x[i * w->count + lane] = dvi__moving_between(e, m->place[k], i);
      for (int j = 0; j < m->part.variables; j++)
        w->z[j * w->count + lane] = dvi__moving_variable(e, m->place[k], &m->part.variable[j]);
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
  if (a != b) add_product(b, a, factor, s);
}

static void add_first(const slope *z, double factor, dvi__stencil *s)
{
  for (int i = 0; i < z->count; i++) s->first[z->at[i]] += factor * z->by[i];
}

/* Add the second derivatives of V w l at a point, with V held. z has the variables, and then the
 * coordinates of the point. */
static void add_second_of_point(const element *e, const lanes *w, int lane, const slope *z,
                                dvi__stencil *s)
{
  const dvi_moving *m = e->m;
  const int k = lane % m->points, n = m->part.variables;
  const double factor = m->weight[k] * e->simplex.volume;
  for (int j = 0; j < n; j++)
    bend_variable(e, m->place[k], &m->part.variable[j], factor * w->l_z[j * w->count + lane], s);
  for (int p = 0; p < m->part.pairs; p++)
    add_both(z + m->pair[p][0], z + m->pair[p][1], factor * w->l_zz[p * w->count + lane], s);
  for (int i = 0, p = 0; i < m->dimension && m->space_derivative != NULL; i++) {
    for (int j = 0; j <= i; j++, p++)
      add_both(z + n + i, z + n + j, factor * w->l_xx[p * w->count + lane], s);
    for (int j = 0; j < n; j++)
      add_both(z + n + i, z + j, factor * w->l_xz[(i * n + j) * w->count + lane], s);
  }
}

static void add_point(const element *e, int order, const lanes *w, int lane, dvi__stencil *s)
{
  const dvi_moving *m = e->m;
  const int k = lane % m->points, n = m->part.variables;
  const double factor = m->weight[k] * e->simplex.volume, *place = m->place[k];
  slope z[DVI__MOVING_VARIABLES + AXES];
  s->value += factor * w->l[lane];
  if (order == 0) return;
  for (int j = 0; j < n; j++) {
    find_variable(e, place, &m->part.variable[j], z + j);
    add_first(z + j, factor * w->l_z[j * w->count + lane], s);
  }
  for (int i = 0; i < m->dimension && m->space_derivative != NULL; i++) {
    z[n + i].count = 0;
    add_number(e, place, i, z + n + i);
    add_first(z + n + i, factor * w->l_x[i * w->count + lane], s);
  }
  if (order > 1) add_second_of_point(e, w, lane, z, s);
}

/* Add V m(u_0,u_1), with V held. */
static int add_mean(const element *e, int order, dvi__stencil *s)
{
  enum { BOTH = 2 * DVI_MOVING_COMPONENTS_MAX };
  const dvi_moving *m = e->m;
  const int n = 2 * m->components;
  const double V = e->simplex.volume, *left = e->y + value_at(e, 0, 0),
               *right = e->y + value_at(e, 1, 0);
  double mean, first[BOTH], second[BOTH * (BOTH + 1) / 2];
  int at[BOTH];
  const int returned = m->mean.mean(1, left, right, &mean, order > 0 ? first : NULL,
                                    order > 1 ? second : NULL, m->mean.user);
  if (returned != 0) return returned;
  s->value += V * mean;
  for (int i = 0; i < n; i++) at[i] = value_at(e, i / m->components, i % m->components);
  for (int i = 0; i < n && order > 0; i++) s->first[at[i]] += V * first[i];
  for (int i = 0, p = 0; i < n && order > 1; i++) {
    for (int j = 0; j < i; j++, p++) add_pair(s, at[i], at[j], V * second[p]);
    s->second[at[i] * (s->size + 1)] += V * second[p++];
  }
  return 0;
}

/* Let the volume of a stencil V M, whose derivatives are those of M times V so far, follow the
 * nodes. V' = V g and V'' = V (g_ai g_cj - g_aj g_ci). */
static void release_volume(const element *e, int order, dvi__stencil *s)
{
  const int n = e->m->dimension;
  for (int k = 0; k < e->nodes * n && order > 1; k++) {
    const int a = k / n, i = k % n, row = position_at(e, a, i);
    const double *of_a = e->simplex.gradient[a];
    for (int j = 0; j < s->size; j++) add_pair(s, row, j, of_a[i] * s->first[j]);
    for (int c = 0; c < e->nodes; c++)
      for (int j = 0; j < n; j++) {
        const double *of_c = e->simplex.gradient[c];
        s->second[row * s->size + position_at(e, c, j)] += s->value *
                                                           (of_a[i] * of_c[j] - of_a[j] * of_c[i]);
      }
  }
  for (int a = 0; a < e->nodes && order > 0; a++)
    for (int i = 0; i < n; i++)
      s->first[position_at(e, a, i)] += s->value * e->simplex.gradient[a][i];
}

static int add_cell(const dvi_moving *m, int order, const lanes *w, int lane, int cell,
                    const dvi__moving_sums *sums)
{
  const element *e = &w->cell[lane];
  dvi__stencil s;
  dvi__stencil_clear(m, e->nodes, &s);
  memcpy(s.y, e->y, (size_t)s.size * sizeof *s.y);
  for (int k = 0; k < m->points; k++) add_point(e, order, w, lane * m->points + k, &s);
  const int returned = m->mean.mean != NULL ? add_mean(e, order, &s) : 0;
  if (returned != 0) return returned;
  release_volume(e, order, &s);
  if (m->kappa > 0) dvi__moving_add_barrier(m, cell, order, &e->simplex, &s);
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
