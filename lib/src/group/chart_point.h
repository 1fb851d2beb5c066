/* Operations of charts at DVI__LANES points side by side. Each lane has a chart of its own, so that
 * the lanes are the nodes of one path, or members of an ensemble. */
#ifndef DVI_GROUP_CHART_POINT_H
#define DVI_GROUP_CHART_POINT_H
#include <math.h>

#include "group/chart_lanes.h"
#include "group/chart_nodes.h"
#include "group/stumpff.h"

typedef dvi__lane lane;

/* The charts' centres, and the bases of their tangent planes. */
typedef struct centres {
  lane y0[DVI__CHART_POINT], basis[2][3];
} centres;

/* ---- points ---- */

/* v = y Omega^ */
INLINE void place_rotation(const centres *chart, const lane *c, const lane *xi, const lane *rate,
                           lane *y, lane *v)
{
  const lane *R0 = chart->y0;
  lane E[9], Omega[3], once[3], twice[3], square;
  lanes_dot(xi, xi, &square);
  const lane diagonal = 1 - c[2] * square;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const lane even = c[2] * xi[i] * xi[j], odd = c[1] * xi[k];
    E[4 * i] = diagonal + c[2] * xi[i] * xi[i];
    E[3 * i + j] = even - odd;
    E[3 * j + i] = even + odd;
  }
  for (int i = 0; i < 9; i += 3)
    for (int j = 0; j < 3; j++)
      y[i + j] = R0[i] * E[j] + R0[i + 1] * E[3 + j] + R0[i + 2] * E[6 + j];
  lanes_dexp(c, -1, xi, rate, once, twice, Omega);
  for (int i = 0; i < 9; i += 3) lanes_cross(y + i, Omega, v + i);
}

/* With X = B xi, v = c_1 B rate + sigma ((c_3 - c_2) X - c_1 y0) */
INLINE void place_direction(const centres *chart, const lane *c, const lane *xi, const lane *rate,
                            lane *y, lane *v)
{
  const lane sigma = xi[0] * rate[0] + xi[1] * rate[1];
  for (int i = 0; i < 3; i++) {
    const lane y0 = chart->y0[i], e = chart->basis[0][i], f = chart->basis[1][i];
    const lane X = e * xi[0] + f * xi[1];
    y[i] = c[0] * y0 + c[1] * X;
    v[i] = c[1] * (e * rate[0] + f * rate[1]) + sigma * ((c[3] - c[2]) * X - c[1] * y0);
  }
}

INLINE void place_angle(const centres *chart, const lane *c, const lane *xi, const lane *rate,
                        lane *y, lane *v)
{
  for (int i = 0; i < 2; i++) {
    const lane y0 = chart->y0[i], e = chart->basis[0][i];
    y[i] = c[0] * y0 + c[1] * *xi * e;
    v[i] = *rate * (c[0] * e - c[1] * *xi * y0);
  }
}

INLINE void place_lanes(const centres *chart, dvi__chart_kind kind, const lane *c, const lane *xi,
                        const lane *rate, lane *y, lane *v)
{
  switch (kind) {
  case DVI__LINE:
    *y = *chart->y0 + *xi;
    *v = *rate;
    return;
  case DVI__CIRCLE: place_angle(chart, c, xi, rate, y, v); return;
  case DVI__SPHERE: place_direction(chart, c, xi, rate, y, v); return;
  case DVI__ROTATION: place_rotation(chart, c, xi, rate, y, v); return;
  }
}

/* ---- derivatives ---- */

/* Compute the products of covectors with the centre and its tangents, a.y0 and a.B. */
INLINE void project(const centres *chart, const lane *a, lane *on_centre, lane *on_basis)
{
  const lane *y0 = chart->y0, *e = chart->basis[0], *f = chart->basis[1];
  *on_centre = y0[0] * a[0] + y0[1] * a[1] + y0[2] * a[2];
  on_basis[0] = e[0] * a[0] + e[1] * a[1] + e[2] * a[2];
  on_basis[1] = f[0] * a[0] + f[1] * a[1] + f[2] * a[2];
}

/* Compute z and `along` of the gradient c_1 z + along xi of a.y. */
INLINE void direction_gradient(const centres *chart, const lane *c, const lane *xi, const lane *a,
                               lane *on_centre, lane *z, lane *along)
{
  project(chart, a, on_centre, z);
  *along = (c[3] - c[2]) * (z[0] * xi[0] + z[1] * xi[1]) - c[1] * *on_centre;
}

/* The gradient of b.v in xi is the derivative of that in rate along rate. */
INLINE void direction_kinetic(const centres *chart, const lane *c, const lane *xi, const lane *rate,
                              const lane *b, lane *in_xi, lane *in_rate)
{
  lane on_centre, z[2], along;
  direction_gradient(chart, c, xi, b, &on_centre, z, &along);
  const lane d = c[3] - c[2], sigma = xi[0] * rate[0] + xi[1] * rate[1],
             on_xi = z[0] * xi[0] + z[1] * xi[1], on_rate = z[0] * rate[0] + z[1] * rate[1],
             bent = sigma * ((3 * (c[5] - c[4]) + c[3]) * on_xi - d * on_centre) + d * on_rate;
  for (int i = 0; i < 2; i++) {
    in_rate[i] = c[1] * z[i] + along * xi[i];
    in_xi[i] = d * sigma * z[i] + along * rate[i] + bent * xi[i];
  }
}

INLINE void add_direction_force(const centres *chart, const lane *c, const lane *xi, const lane *a,
                                lane *in_xi)
{
  lane on_centre, z[2], along;
  direction_gradient(chart, c, xi, a, &on_centre, z, &along);
  for (int i = 0; i < 2; i++) in_xi[i] += c[1] * z[i] + along * xi[i];
}

/* Compute the moment y x a of a rotation, column by column. */
INLINE void rotation_moment(const lane *y, const lane *a, lane *N)
{
  N[0] = N[1] = N[2] = (lane){0};
  for (int j = 0; j < 3; j++) {
    N[0] += y[3 + j] * a[6 + j] - y[6 + j] * a[3 + j];
    N[1] += y[6 + j] * a[j] - y[j] * a[6 + j];
    N[2] += y[j] * a[3 + j] - y[3 + j] * a[j];
  }
}

/* The gradient of b.v in rate is dexp_{-xi} n with the moment n of b at y, and that in xi is its
 * derivative along rate. b has the moment of v, too, which is added to that of a. */
INLINE void differentiate_rotation(const centres *chart, const lane *c, const lane *xi,
                                   const lane *rate, const lane *y, const lane *v, const lane *a,
                                   const lane *b, lane *in_xi, lane *in_rate)
{
  lane N[3], of_v[3], n[3], force[3], once[3], twice[3], by_once[3], by_twice[3], bent[3], sigma;
  rotation_moment(y, b, N);
  lanes_turn_back(chart->y0, N, n);
  lanes_dexp(c, -1, xi, n, once, twice, in_rate);
  rotation_moment(y, a, N);
  rotation_moment(v, b, of_v);
  for (int i = 0; i < 3; i++) N[i] += of_v[i];
  lanes_turn_back(chart->y0, N, force);
  lanes_dexp(c, -1, xi, force, by_once, by_twice, in_xi);
  lanes_dot(xi, rate, &sigma);
  const lane by_2 = sigma * (2 * c[4] - c[3]), by_3 = sigma * (3 * c[5] - c[4]);
  lanes_cross(rate, n, by_once);
  lanes_cross(rate, once, by_twice);
  lanes_cross(xi, by_once, bent);
  for (int i = 0; i < 3; i++)
    in_xi[i] += by_3 * twice[i] - by_2 * once[i] + c[3] * (by_twice[i] + bent[i]) -
                c[2] * by_once[i];
}

/* The gradients of a.y and b.v of an angle are those of v alone, because y'' = -y. */
INLINE void differentiate_angle(const centres *chart, const lane *c, const lane *xi,
                                const lane *rate, const lane *a, const lane *b, lane *in_xi,
                                lane *in_rate)
{
  const lane *y0 = chart->y0, *e = chart->basis[0];
  const lane sine = c[1] * *xi, on_centre = b[0] * y0[0] + b[1] * y0[1],
             on_basis = b[0] * e[0] + b[1] * e[1];
  *in_rate = c[0] * on_basis - sine * on_centre;
  *in_xi = c[0] * (a[0] * e[0] + a[1] * e[1]) - sine * (a[0] * y0[0] + a[1] * y0[1]) -
           *rate * (c[0] * on_centre + sine * on_basis);
}

INLINE void differentiate_lanes(const centres *chart, dvi__chart_kind kind, const lane *c,
                                const lane *xi, const lane *rate, const lane *y, const lane *v,
                                const lane *a, const lane *b, lane *in_xi, lane *in_rate)
{
  switch (kind) {
  case DVI__LINE:
    *in_xi = *a;
    *in_rate = *b;
    return;
  case DVI__CIRCLE: differentiate_angle(chart, c, xi, rate, a, b, in_xi, in_rate); return;
  case DVI__SPHERE:
    direction_kinetic(chart, c, xi, rate, b, in_xi, in_rate);
    add_direction_force(chart, c, xi, a, in_xi);
    return;
  case DVI__ROTATION:
    differentiate_rotation(chart, c, xi, rate, y, v, a, b, in_xi, in_rate);
    return;
  }
}

/* ---- even masses ---- */

INLINE void even_direction(const lane *c, double mass, const lane *xi, const lane *rate,
                           lane *in_xi, lane *in_rate)
{
  const lane sigma = xi[0] * rate[0] + xi[1] * rate[1],
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
INLINE void even_rotation(const lane *c, const double *J, const lane *xi, const lane *rate,
                          lane *in_xi, lane *in_rate)
{
  lane Omega[3], l[3], normal[3], once[3], twice[3], sigma, lambda, both, square, on_normal;
  lanes_dexp(c, -1, xi, rate, once, twice, Omega);
  for (int i = 0; i < 3; i++)
    l[i] = J[3 * i] * Omega[0] + J[3 * i + 1] * Omega[1] + J[3 * i + 2] * Omega[2];
  lanes_dexp(c, 1, xi, l, once, twice, in_rate);
  lanes_cross(rate, l, normal);
  lanes_dot(xi, rate, &sigma);
  lanes_dot(xi, l, &lambda);
  lanes_dot(l, rate, &both);
  lanes_dot(xi, xi, &square);
  lanes_dot(xi, normal, &on_normal);
  const lane by_2 = c[4] - 0.5 * c[3], by_3 = 0.5 * (3 * c[5] - c[4]),
             along = 2 * (by_3 * (lambda * sigma - square * both) - by_2 * on_normal - c[3] * both);
  for (int i = 0; i < 3; i++)
    in_xi[i] = c[3] * (sigma * l[i] + lambda * rate[i]) - c[2] * normal[i] + along * xi[i];
}

/* The force of a rotation is dexp_{-xi} of the moment in the frame of the centre. */
INLINE void add_rotation_force(const centres *chart, const lane *c, const lane *xi, const lane *y,
                               const lane *a, lane *in_xi)
{
  lane N[3], moment[3], once[3], twice[3], force[3];
  rotation_moment(y, a, N);
  lanes_turn_back(chart->y0, N, moment);
  lanes_dexp(c, -1, xi, moment, once, twice, force);
  for (int i = 0; i < 3; i++) in_xi[i] += force[i];
}

INLINE void move_lanes(const centres *chart, dvi__chart_kind kind, const double *inertia,
                       const lane *c, const lane *xi, const lane *rate, const lane *y,
                       const lane *a, lane *in_xi, lane *in_rate)
{
  switch (kind) {
  case DVI__LINE:
  case DVI__CIRCLE:
    *in_rate = *inertia * *rate;
    *in_xi = *a;
    if (kind == DVI__CIRCLE)
      *in_xi = c[0] * (a[0] * chart->basis[0][0] + a[1] * chart->basis[0][1]) -
               c[1] * *xi * (a[0] * chart->y0[0] + a[1] * chart->y0[1]);
    return;
  case DVI__SPHERE:
    even_direction(c, *inertia, xi, rate, in_xi, in_rate);
    add_direction_force(chart, c, xi, a, in_xi);
    return;
  case DVI__ROTATION:
    even_rotation(c, inertia, xi, rate, in_xi, in_rate);
    add_rotation_force(chart, c, xi, y, a, in_xi);
    return;
  }
}

INLINE void add_moment(int vectors, const lane *y, const lane *a, lane *N)
{
  lane moment[3];
  if (vectors == 3)
    rotation_moment(y, a, moment);
  else
    lanes_cross(y, a, moment);
  for (int i = 0; i < 3; i++) N[i] += moment[i];
}

/* ---- some points ---- */

/* Returns the first |xi| that is not below the bound, else 0. */
INLINE double beyond_bound(dvi__chart_kind kind, const lane *square, int some)
{
  const double bound = dvi__chart_bound(kind);
  for (int k = 0; k < some; k++)
    if (!((*square)[k] < bound * bound)) return sqrt((*square)[k]);
  return 0;
}

INLINE void find_functions(const lane *square, lane *c)
{
  double s[DVI__LANES], functions[DVI__NODE_FUNCTIONS][DVI__LANES];
  store_rows(1, square, 0, DVI__LANES, s);
  dvi__stumpff_six_of(s, functions);
  load_rows(DVI__NODE_FUNCTIONS, functions[0], DVI__LANES, DVI__LANES, c);
}

/* Place some points from k on. The kind and the usual numbers of points are constants, so that all
 * vectors are in registers. Returns as beyond_bound. */
INLINE double place_some(const centres *chart, dvi__chart_kind kind, const dvi__chart_nodes *n,
                         int k, int some)
{
  const int size = dvi__chart_size(kind), stored = dvi__chart_stored(kind);
  const size_t count = (size_t)n->count;
  lane xi[3], rate[3], c[DVI__NODE_FUNCTIONS], y[9], v[9];
  load_rows(size, n->xi + k, n->local, some, xi);
  load_rows(size, n->rate + k, n->local, some, rate);
  if (kind != DVI__LINE) {
    lane square = xi[0] * xi[0];
    for (int i = 1; i < size; i++) square += xi[i] * xi[i];
    const double beyond = beyond_bound(kind, &square, some);
    if (beyond != 0) return beyond;
    find_functions(&square, c);
    store_rows(DVI__NODE_FUNCTIONS, c, count, some, n->functions + k);
  }
  place_lanes(chart, kind, c, xi, rate, y, v);
  store_rows(stored, y, count, some, n->y + k);
  if (n->v != NULL) store_rows(stored, v, count, some, n->v + k);
  return 0;
}

/* Differentiate at some points from k on, with the even mass `inertia` if `even`. */
INLINE void differentiate_some(const centres *chart, dvi__chart_kind kind, int even,
                               const double *inertia, const dvi__chart_nodes *n, int k, int some)
{
  const int size = dvi__chart_size(kind), stored = dvi__chart_stored(kind);
  const size_t count = (size_t)n->count;
  lane xi[3], rate[3], c[DVI__NODE_FUNCTIONS], y[9], a[9], in_xi[3], in_rate[3];
  load_rows(size, n->xi + k, n->local, some, xi);
  load_rows(size, n->rate + k, n->local, some, rate);
  if (kind != DVI__LINE) load_rows(DVI__NODE_FUNCTIONS, n->functions + k, count, some, c);
  load_rows(stored, n->a + k, count, some, a);
  if (kind == DVI__ROTATION) load_rows(stored, n->y + k, count, some, y);
  if (even) {
    move_lanes(chart, kind, inertia, c, xi, rate, y, a, in_xi, in_rate);
  } else {
    lane v[9], b[9];
    load_rows(stored, n->b + k, count, some, b);
    if (kind == DVI__ROTATION) load_rows(stored, n->v + k, count, some, v);
    differentiate_lanes(chart, kind, c, xi, rate, y, v, a, b, in_xi, in_rate);
  }
  store_rows(size, in_xi, n->local, some, n->in_xi + k);
  store_rows(size, in_rate, n->local, some, n->in_rate + k);
}

#endif
