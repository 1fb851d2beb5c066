/* The gradient in the charts where the mass couples no two factors, and a factor's own mass does
 * not change with its place. The kinetic energy is then that of the chart's own numbers, and has no
 * moment. With s = |xi|^2, sigma = xi.rate and Stumpff's c_k it is
 *
 *     line, circle   m rate^2/2
 *     sphere         m (c_1^2 |rate|^2 + g sigma^2)/2,    g = (1 - c_1^2)/s = c_3 (1 + c_1)
 *     rotation       Omega.J Omega/2,   Omega = dexp_{-xi} rate
 *
 * A potential's moment N = y x L_y on the way turns into the force T^T L_y. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "group/stumpff.h"
#include "group/vector.h"
#include "system/chart/charted_struct.h"

enum { FUNCTIONS = 6 };

/* ---- the mass ---- */

static double entry_of_mass(const dvi_system *s, int row, int column)
{
  const int e = dvi__pattern_find(&s->vv, row, column);
  return e >= 0 ? s->mass_values[e] : 0;
}

/* Give the mass of stored numbers i and j of a slot that does not change with its place. */
static double even_mass(const dvi_system *s, const dvi__factor_slot *slot, int i, int j)
{
  const int vectors = slot->kind == DVI__ROTATION ? 3 : 1;
  if (i / vectors != j / vectors) return 0;
  return entry_of_mass(s, slot->q + i % vectors, slot->q + j % vectors);
}

/* Tell whether a slot's mass is like that, and couples no other slot. */
static int is_apart(const dvi_system *s, const dvi__factor_slot *slot)
{
  const int stored = dvi__chart_stored(slot->kind);
  for (int j = 0; j < stored; j++) {
    for (int e = s->vv.start[slot->q + j]; e < s->vv.start[slot->q + j + 1]; e++)
      if ((s->vv.row[e] < slot->q || s->vv.row[e] >= slot->q + stored) && s->mass_values[e] != 0)
        return 0;
    for (int i = 0; i < stored; i++)
      if (entry_of_mass(s, slot->q + i, slot->q + j) != even_mass(s, slot, i, j)) return 0;
  }
  return 1;
}

/* Read J of a rotation from its mass I x J_d, or m. */
static void read_inertia(const dvi_system *s, const dvi__factor_slot *slot, double *inertia)
{
  if (slot->kind != DVI__ROTATION) {
    *inertia = entry_of_mass(s, slot->q, slot->q);
    return;
  }
  double trace = 0;
  for (int i = 0; i < 3; i++) trace += entry_of_mass(s, slot->q + i, slot->q + i);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      inertia[3 * i + j] = (i == j ? trace : 0) - entry_of_mass(s, slot->q + i, slot->q + j);
}

dvi_status dvi__charted_find_apart(dvi__charted *x)
{
  const dvi_system *s = x->base;
  for (int c = 0; c < s->slot_count; c++)
    if (!is_apart(s, &s->slots[c])) return DVI_OK;
  x->inertia = DVI_NEW(double, 9 * (size_t)s->slot_count);
  x->stumpff = DVI_NEW(double, FUNCTIONS *DVI__GROUP *(size_t)s->slot_count);
  if (x->inertia == NULL || x->stumpff == NULL)
    return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d factors", s->slot_count);
  for (int c = 0; c < s->slot_count; c++) read_inertia(s, &s->slots[c], x->inertia + 9 * (size_t)c);
  return DVI_OK;
}

/* ---- points ---- */

/* R = R0 (I + c_1 xi^ + c_2 xi^^2) */
static void turned_point(const double *R0, const double *c, const double *xi, double *R)
{
  const double diagonal = 1 - c[2] * dvi__dot(xi, xi);
  double E[9];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double even = c[2] * xi[i] * xi[j], odd = c[1] * xi[k];
    E[4 * i] = diagonal + c[2] * xi[i] * xi[i];
    E[3 * i + j] = even - odd;
    E[3 * j + i] = even + odd;
  }
  for (int i = 0; i < 9; i += 3)
    for (int j = 0; j < 3; j++)
      R[i + j] = R0[i] * E[j] + R0[i + 1] * E[3 + j] + R0[i + 2] * E[6 + j];
}

static void place_apart(const dvi__chart *chart, const double *c, const double *xi, double *y)
{
  const double *y0 = chart->y0;
  switch (chart->kind) {
  case DVI__LINE: *y = *y0 + *xi; return;
  case DVI__CIRCLE:
    for (int i = 0; i < 2; i++) y[i] = c[0] * y0[i] + c[1] * *xi * chart->basis[0][i];
    return;
  case DVI__SPHERE:
    for (int i = 0; i < 3; i++)
      y[i] = c[0] * y0[i] + c[1] * (chart->basis[0][i] * xi[0] + chart->basis[1][i] * xi[1]);
    return;
  case DVI__ROTATION: turned_point(y0, c, xi, y); return;
  }
}

/* Read chart numbers of a slot at point k of a batch. Those that it does not have are 0. */
static inline void read_local(const dvi__factor_slot *slot, size_t count, size_t k,
                              const double *batch, double *one)
{
  const double *from = batch + (size_t)slot->x * count + k;
  one[0] = from[0];
  one[1] = slot->kind >= DVI__SPHERE ? from[count] : 0;
  one[2] = slot->kind == DVI__ROTATION ? from[2 * count] : 0;
}

/* Compute y of a slot, and Stumpff's functions, at point k of a group. */
static dvi_status find_apart(dvi__charted *x, int c, int count, int from, int group, int k,
                             const double *xi)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  double at[DVI__CHART_SIZE],
      y[DVI__CHART_POINT] = {0},
      *functions = x->stumpff + FUNCTIONS * ((size_t)c * DVI__GROUP + (size_t)k);
  read_local(slot, (size_t)count, (size_t)from, xi, at);
  if (slot->kind != DVI__LINE) {
    const double square = dvi__dot(at, at), bound = dvi__chart_bound(slot->kind);
    if (!(square < bound * bound)) return dvi__charted_too_large(dvi__chart_angle(slot->kind, at));
    dvi__stumpff_six(square, functions);
  }
  place_apart(&x->chart[c], functions, at, y);
  for (int i = 0; i < dvi__chart_stored(slot->kind); i++) x->y[(slot->q + i) * group + k] = y[i];
  return DVI_OK;
}

/* ---- derivatives of one slot ---- */

static void sphere_kinetic(const double *c, double mass, const double *xi, const double *rate,
                           double *in_xi, double *in_rate)
{
  const double sigma = xi[0] * rate[0] + xi[1] * rate[1],
               square = rate[0] * rate[0] + rate[1] * rate[1], by_1 = 0.5 * (c[3] - c[2]),
               by_3 = 0.5 * (3 * c[5] - c[4]), g = c[3] * (1 + c[1]),
               by_g = by_3 * (1 + c[1]) + c[3] * by_1,
               along = 2 * c[1] * by_1 * square + by_g * sigma * sigma;
  for (int i = 0; i < 2; i++) {
    in_rate[i] = mass * (c[1] * c[1] * rate[i] + g * sigma * xi[i]);
    in_xi[i] = mass * (along * xi[i] + g * sigma * rate[i]);
  }
}

/* The momentum is dexp_xi J Omega, and the force the derivative of l.dexp_{-xi} rate with l =
 * J Omega held fixed. */
static void rotation_kinetic(const double *c, const double *inertia, const double *xi,
                             const double *rate, double *in_xi, double *in_rate)
{
  double Omega[3], l[3], normal[3];
  dvi__about(xi, -c[2], c[3], rate, Omega);
  for (int i = 0; i < 3; i++) l[i] = dvi__dot(inertia + 3 * i, Omega);
  dvi__about(xi, c[2], c[3], l, in_rate);
  dvi__cross(rate, l, normal);
  const double sigma = dvi__dot(xi, rate), lambda = dvi__dot(xi, l), both = dvi__dot(l, rate),
               by_2 = c[4] - 0.5 * c[3], by_3 = 0.5 * (3 * c[5] - c[4]),
               along = 2 * (by_3 * (lambda * sigma - dvi__dot(xi, xi) * both) -
                            by_2 * dvi__dot(xi, normal) - c[3] * both);
  for (int i = 0; i < 3; i++)
    in_xi[i] = c[3] * (sigma * l[i] + lambda * rate[i]) - c[2] * normal[i] + along * xi[i];
}

static void add_sphere_force(const dvi__chart *chart, const double *c, const double *xi,
                             const double *a, double *in_xi)
{
  const double z[] = {dvi__dot(chart->basis[0], a), dvi__dot(chart->basis[1], a)},
               by_s = (c[3] - c[2]) * (z[0] * xi[0] + z[1] * xi[1]) - c[1] * dvi__dot(chart->y0, a);
  for (int i = 0; i < 2; i++) in_xi[i] += c[1] * z[i] + by_s * xi[i];
}

/* The force is dexp_{-xi} of the moment in the frame of the centre. */
static void add_rotation_force(const dvi__chart *chart, const double *c, const double *xi,
                               const double *N, double *in_xi)
{
  const double *R0 = chart->y0;
  double moment[3], force[3];
  for (int i = 0; i < 3; i++) moment[i] = R0[i] * N[0] + R0[3 + i] * N[1] + R0[6 + i] * N[2];
  dvi__about(xi, -c[2], c[3], moment, force);
  for (int i = 0; i < 3; i++) in_xi[i] += force[i];
}

/* Compute the gradient of a slot from a = L_y, and the moment N. */
static void differentiate_apart(const dvi__chart *chart, const double *c, const double *inertia,
                                const double *xi, const double *rate, const double *y,
                                const double *a, double *in_xi, double *in_rate, double *N)
{
  switch (chart->kind) {
  case DVI__LINE:
  case DVI__CIRCLE:
    *in_rate = *inertia * *rate;
    *in_xi = chart->kind == DVI__LINE
                 ? *a
                 : c[0] * (a[0] * chart->basis[0][0] + a[1] * chart->basis[0][1]) -
                       c[1] * *xi * (a[0] * chart->y0[0] + a[1] * chart->y0[1]);
    return;
  case DVI__SPHERE:
    dvi__cross(y, a, N);
    sphere_kinetic(c, *inertia, xi, rate, in_xi, in_rate);
    add_sphere_force(chart, c, xi, a, in_xi);
    return;
  case DVI__ROTATION:
    for (int j = 0; j < 3; j++) {
      N[0] += y[3 + j] * a[6 + j] - y[6 + j] * a[3 + j];
      N[1] += y[6 + j] * a[j] - y[j] * a[6 + j];
      N[2] += y[j] * a[3 + j] - y[3 + j] * a[j];
    }
    rotation_kinetic(c, inertia, xi, rate, in_xi, in_rate);
    add_rotation_force(chart, c, xi, N, in_xi);
    return;
  }
}

static void gradient_of_slot(dvi__charted *x, int c, int count, int from, int group, int k,
                             const double *xi, const double *rate, double *L_xi, double *L_rate)
{
  const dvi__factor_slot *slot = &x->base->slots[c];
  double at[3], u[3], y[DVI__CHART_POINT] = {0}, a[DVI__CHART_POINT] = {0}, in_xi[3], in_rate[3],
                      N[3] = {0};
  read_local(slot, (size_t)count, (size_t)from, xi, at);
  read_local(slot, (size_t)count, (size_t)from, rate, u);
  for (int i = 0; i < dvi__chart_stored(slot->kind); i++) {
    y[i] = x->y[(slot->q + i) * group + k];
    a[i] = x->L_y[(slot->q + i) * group + k];
  }
  differentiate_apart(&x->chart[c], x->stumpff + FUNCTIONS * ((size_t)c * DVI__GROUP + (size_t)k),
                      x->inertia + 9 * (size_t)c, at, u, y, a, in_xi, in_rate, N);
  for (int i = 0; i < dvi__chart_size(slot->kind); i++) {
    const size_t to = (size_t)(slot->x + i) * (size_t)count + (size_t)from;
    L_xi[to] = in_xi[i];
    L_rate[to] = in_rate[i];
  }
  if (dvi__turns(slot) && dvi__charted_on_path(x, count))
    for (int i = 0; i < 3; i++) x->moment[(3 * c + i) * x->capacity + from] = N[i];
}

dvi_status dvi__charted_gradient_apart(dvi__charted *x, int count, int first, int group,
                                       const double *t, const double *xi, const double *rate,
                                       double *L_xi, double *L_rate)
{
  const int slots = x->base->slot_count;
  for (int c = 0; c < slots; c++)
    for (int k = 0; k < group; k++) DVI_TRY(find_apart(x, c, count, first + k, group, k, xi));
  memcpy(x->t, t + first, (size_t)group * sizeof *t);
  DVI_TRY(dvi__lagrangian_gradient(x->evaluator, group, x->t, x->y, NULL, x->L_y, NULL));
  for (int c = 0; c < slots; c++)
    for (int k = 0; k < group; k++)
      gradient_of_slot(x, c, count, first + k, group, k, xi, rate, L_xi, L_rate);
  return DVI_OK;
}
