#include "group/chart_members.h"

#include "group/chart_point.h"
#include "num/simd/wide.h"

/* Give the first member of a vector that should begin with member k. The last vector overlaps the
 * one before, and finds the same numbers again. */
static int first_of(int width, int k)
{
  return k + DVI__LANES <= width ? k : width - DVI__LANES;
}

INLINE void read_centres(const dvi__chart_members *charts, dvi__chart_kind kind, int k, centres *at)
{
  const size_t width = (size_t)charts->width;
  load_rows(dvi__chart_stored(kind), charts->y0 + k, width, DVI__LANES, at->y0);
  if (kind == DVI__CIRCLE || kind == DVI__SPHERE)
    load_rows(3, charts->basis + k, width, DVI__LANES, at->basis[0]);
  if (kind == DVI__SPHERE)
    load_rows(3, charts->basis + 3 * width + k, width, DVI__LANES, at->basis[1]);
}

/* ---- points ---- */

INLINE double place_from(const dvi__chart_members *charts, dvi__chart_kind kind,
                         const dvi__chart_nodes *n, int k)
{
  centres at;
  read_centres(charts, kind, k, &at);
  for (int first = k; first < n->count; first += charts->width) {
    const double beyond = place_some(&at, kind, n, first, DVI__LANES);
    if (beyond != 0) return beyond;
  }
  return 0;
}

INLINE double place_kind(const dvi__chart_members *charts, dvi__chart_kind kind,
                         const dvi__chart_nodes *n)
{
  for (int k = 0; k < charts->width; k += DVI__LANES) {
    const double beyond = place_from(charts, kind, n, first_of(charts->width, k));
    if (beyond != 0) return beyond;
  }
  return 0;
}

WIDE static double place_in_charts(const dvi__chart_members *charts, const dvi__chart_nodes *n)
{
  switch (charts->kind) {
  case DVI__LINE: return place_kind(charts, DVI__LINE, n);
  case DVI__CIRCLE: return place_kind(charts, DVI__CIRCLE, n);
  case DVI__SPHERE: return place_kind(charts, DVI__SPHERE, n);
  case DVI__ROTATION: return place_kind(charts, DVI__ROTATION, n);
  }
  return 0;
}

double dvi__chart_place_members(const dvi__chart_members *charts, const dvi__chart_nodes *nodes)
{
  return place_in_charts(charts, nodes);
}

/* ---- derivatives ---- */

INLINE void move_from(const dvi__chart_members *charts, dvi__chart_kind kind, int even,
                      const double *inertia, const dvi__chart_nodes *n, int k)
{
  centres at;
  read_centres(charts, kind, k, &at);
  for (int first = k; first < n->count; first += charts->width)
    differentiate_some(&at, kind, even, inertia, n, first, DVI__LANES);
}

INLINE void move_kind(const dvi__chart_members *charts, dvi__chart_kind kind, int even,
                      const double *inertia, const dvi__chart_nodes *n)
{
  for (int k = 0; k < charts->width; k += DVI__LANES)
    move_from(charts, kind, even, inertia, n, first_of(charts->width, k));
}

INLINE void move_by(const dvi__chart_members *charts, int even, const double *inertia,
                    const dvi__chart_nodes *n)
{
  switch (charts->kind) {
  case DVI__LINE: move_kind(charts, DVI__LINE, even, inertia, n); return;
  case DVI__CIRCLE: move_kind(charts, DVI__CIRCLE, even, inertia, n); return;
  case DVI__SPHERE: move_kind(charts, DVI__SPHERE, even, inertia, n); return;
  case DVI__ROTATION: move_kind(charts, DVI__ROTATION, even, inertia, n); return;
  }
}

WIDE static void differentiate_in_charts(const dvi__chart_members *charts,
                                         const dvi__chart_nodes *n)
{
  move_by(charts, 0, NULL, n);
}

WIDE static void move_in_charts(const dvi__chart_members *charts, const double *inertia,
                                const dvi__chart_nodes *n)
{
  move_by(charts, 1, inertia, n);
}

void dvi__chart_move_members(const dvi__chart_members *charts, const double *inertia,
                             const dvi__chart_nodes *nodes)
{
  if (inertia != NULL)
    move_in_charts(charts, inertia, nodes);
  else
    differentiate_in_charts(charts, nodes);
}

/* ---- ends of paths ---- */

/* Compute B x. */
INLINE void lift(const centres *at, const lane *x, lane *lifted)
{
  for (int i = 0; i < 3; i++) {
    lifted[i] = (lane){0};
    for (int j = 0; j < 2; j++) lifted[i] += at->basis[j][i] * x[j];
  }
}

INLINE void find_four(int size, const lane *xi, lane *c)
{
  lane square = {0};
  double s[DVI__LANES], functions[4][DVI__LANES];
  for (int i = 0; i < size; i++) square += xi[i] * xi[i];
  store_rows(1, &square, 0, DVI__LANES, s);
  dvi__stumpff_four_of(s, functions);
  load_rows(4, functions[0], DVI__LANES, DVI__LANES, c);
}

/* Compute the momentum at xi as dvi__chart_momentum. */
INLINE void rotation_momentum(const lane *c, const lane *xi, const lane *mu, lane *p)
{
  lane once[3], inner[3], turned[3];
  const lane by_once = -c[2];
  lanes_cross(xi, mu, once);
  for (int i = 0; i < 3; i++) inner[i] = by_once * mu[i] + c[3] * once[i];
  lanes_cross(xi, inner, turned);
  for (int i = 0; i < 3; i++) p[i] = mu[i] + turned[i];
}

INLINE void direction_momentum(const centres *at, const lane *c, const lane *xi, const lane *mu,
                               lane *p)
{
  lane x[3], y[3], P[3], on_x, on_centre, on_basis;
  lift(at, xi, x);
  for (int i = 0; i < 3; i++) y[i] = c[0] * at->y0[i] + c[1] * x[i];
  lanes_cross(mu, y, P);
  lanes_dot(x, P, &on_x);
  lanes_dot(at->y0, P, &on_centre);
  const lane along = (c[3] - c[2]) * on_x - c[1] * on_centre;
  for (int j = 0; j < 2; j++) {
    lanes_dot(at->basis[j], P, &on_basis);
    p[j] = c[1] * on_basis + along * xi[j];
  }
}

/* Compute mu1 - mu0 of a rotation in the centre's frame, and of a direction in space. */
INLINE void find_impulse(const centres *at, dvi__chart_kind kind, const dvi__chart_paths *paths,
                         size_t width, int k, lane *impulse)
{
  lane N, in_space[3], turned[3];
  for (int i = 0; i < 3; i++) {
    in_space[i] = (lane){0};
    for (int j = 0; j < paths->nodes; j++) {
      load_rows(1, paths->moment + (size_t)(i * paths->nodes + j) * width + k, 0, DVI__LANES, &N);
      in_space[i] += paths->h * paths->weight[j] * N;
    }
  }
  if (kind == DVI__ROTATION) lanes_turn_back(at->y0, in_space, turned);
  for (int i = 0; i < 3; i++)
    impulse[i] = (lane){0} + (kind == DVI__ROTATION ? turned[i] : in_space[i]);
}

INLINE void correct_from(const dvi__chart_members *charts, dvi__chart_kind kind,
                         const dvi__chart_paths *paths, int k)
{
  const size_t width = (size_t)charts->width;
  const int size = dvi__chart_size(kind);
  centres at;
  lane xi[3], p0[3], dp[3], mu[3], impulse[3], c[4], p1[3];
  read_centres(charts, kind, k, &at);
  load_rows(size, paths->xi + k, width, DVI__LANES, xi);
  load_rows(size, paths->p0 + k, width, DVI__LANES, p0);
  load_rows(size, paths->dp + k, width, DVI__LANES, dp);
  find_impulse(&at, kind, paths, width, k, impulse);
  store_rows(3, impulse, width, DVI__LANES, paths->impulse + k);
  if (kind == DVI__SPHERE) {
    lane stored[3];
    lift(&at, p0, stored);
    lanes_cross(at.y0, stored, mu);
  }
  for (int i = 0; i < 3; i++) mu[i] = (kind == DVI__SPHERE ? mu[i] : p0[i]) + impulse[i];
  find_four(size, xi, c);
  if (kind == DVI__ROTATION)
    rotation_momentum(c, xi, mu, p1);
  else
    direction_momentum(&at, c, xi, mu, p1);
  for (int i = 0; i < size; i++) p1[i] = p1[i] - p0[i] - dp[i];
  store_rows(size, p1, width, DVI__LANES, paths->correction + k);
}

INLINE void correct_kind(const dvi__chart_members *charts, dvi__chart_kind kind,
                         const dvi__chart_paths *paths)
{
  for (int k = 0; k < charts->width; k += DVI__LANES)
    correct_from(charts, kind, paths, first_of(charts->width, k));
}

WIDE static void correct_in_charts(const dvi__chart_members *charts, const dvi__chart_paths *paths)
{
  if (charts->kind == DVI__ROTATION)
    correct_kind(charts, DVI__ROTATION, paths);
  else
    correct_kind(charts, DVI__SPHERE, paths);
}

void dvi__chart_correct_members(const dvi__chart_members *charts, const dvi__chart_paths *paths)
{
  correct_in_charts(charts, paths);
}
