#include "group/chart_nodes.h"

#include "group/chart_point.h"
#include "num/simd/wide.h"

static int some_of(int count, int first)
{
  return count - first < DVI__LANES ? count - first : DVI__LANES;
}

INLINE void spread(int count, const double *x, lane *lanes)
{
  for (int i = 0; i < count; i++) lanes[i] = (lane){x[i], x[i], x[i], x[i]};
}

/* Give one chart to all lanes. */
INLINE void spread_chart(const dvi__chart *chart, dvi__chart_kind kind, centres *at)
{
  spread(dvi__chart_stored(kind), chart->y0, at->y0);
  if (kind == DVI__CIRCLE || kind == DVI__SPHERE) spread(3, chart->basis[0], at->basis[0]);
  if (kind == DVI__SPHERE) spread(3, chart->basis[1], at->basis[1]);
}

/* ---- points ---- */

INLINE double place_kind(const dvi__chart *chart, dvi__chart_kind kind, const dvi__chart_nodes *n)
{
  centres at;
  spread_chart(chart, kind, &at);
  for (int k = 0; k < n->count; k += DVI__LANES) {
    const int some = some_of(n->count, k);
    const double beyond = some == DVI__LANES ? place_some(&at, kind, n, k, DVI__LANES)
                          : some == 2        ? place_some(&at, kind, n, k, 2)
                                             : place_some(&at, kind, n, k, some);
    if (beyond != 0) return beyond;
  }
  return 0;
}

WIDE static double place_all(const dvi__chart *chart, const dvi__chart_nodes *n)
{
  switch (chart->kind) {
  case DVI__LINE: return place_kind(chart, DVI__LINE, n);
  case DVI__CIRCLE: return place_kind(chart, DVI__CIRCLE, n);
  case DVI__SPHERE: return place_kind(chart, DVI__SPHERE, n);
  case DVI__ROTATION: return place_kind(chart, DVI__ROTATION, n);
  }
  return 0;
}

double dvi__chart_place_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes)
{
  return place_all(chart, nodes);
}

/* ---- derivatives ---- */

INLINE void differentiate_kind(const dvi__chart *chart, dvi__chart_kind kind, int even,
                               const double *inertia, const dvi__chart_nodes *n)
{
  centres at;
  spread_chart(chart, kind, &at);
  for (int k = 0; k < n->count; k += DVI__LANES) {
    const int some = some_of(n->count, k);
    if (some == DVI__LANES)
      differentiate_some(&at, kind, even, inertia, n, k, DVI__LANES);
    else if (some == 2)
      differentiate_some(&at, kind, even, inertia, n, k, 2);
    else
      differentiate_some(&at, kind, even, inertia, n, k, some);
  }
}

INLINE void differentiate(const dvi__chart *chart, int even, const double *inertia,
                          const dvi__chart_nodes *n)
{
  switch (chart->kind) {
  case DVI__LINE: differentiate_kind(chart, DVI__LINE, even, inertia, n); return;
  case DVI__CIRCLE: differentiate_kind(chart, DVI__CIRCLE, even, inertia, n); return;
  case DVI__SPHERE: differentiate_kind(chart, DVI__SPHERE, even, inertia, n); return;
  case DVI__ROTATION: differentiate_kind(chart, DVI__ROTATION, even, inertia, n); return;
  }
}

WIDE static void differentiate_all(const dvi__chart *chart, const dvi__chart_nodes *n)
{
  differentiate(chart, 0, NULL, n);
}

WIDE static void move_all(const dvi__chart *chart, const double *inertia, const dvi__chart_nodes *n)
{
  differentiate(chart, 1, inertia, n);
}

void dvi__chart_differentiate_nodes(const dvi__chart *chart, const dvi__chart_nodes *nodes)
{
  differentiate_all(chart, nodes);
}

void dvi__chart_move_nodes(const dvi__chart *chart, const double *inertia,
                           const dvi__chart_nodes *nodes)
{
  move_all(chart, inertia, nodes);
}

/* ---- moments ---- */

INLINE void moments_of_some(int vectors, const double *mass, const dvi__chart_nodes *n, int k,
                            int some, size_t stride, double *N)
{
  const size_t count = (size_t)n->count;
  lane y[9], a[9], sum[3] = {{0}};
  load_rows(3 * vectors, n->y + k, count, some, y);
  load_rows(3 * vectors, n->a + k, count, some, a);
  add_moment(vectors, y, a, sum);
  if (mass != NULL) {
    load_rows(3 * vectors, n->v + k, count, some, y);
    load_rows(3 * vectors, n->b + k, count, some, a);
    for (int i = 0; i < 3 * vectors; i++) a[i] -= mass[i % vectors] * y[i];
    add_moment(vectors, y, a, sum);
  }
  store_rows(3, sum, stride, some, N + k);
}

INLINE void moments_of_all(int vectors, const double *mass, const dvi__chart_nodes *n,
                           size_t stride, double *N)
{
  for (int k = 0; k < n->count; k += DVI__LANES) {
    const int some = some_of(n->count, k);
    if (some == DVI__LANES)
      moments_of_some(vectors, mass, n, k, DVI__LANES, stride, N);
    else if (some == 2)
      moments_of_some(vectors, mass, n, k, 2, stride, N);
    else
      moments_of_some(vectors, mass, n, k, some, stride, N);
  }
}

WIDE static void moments_of_rotation(const double *mass, const dvi__chart_nodes *n, size_t stride,
                                     double *N)
{
  moments_of_all(3, mass, n, stride, N);
}

WIDE static void moments_of_direction(const double *mass, const dvi__chart_nodes *n, size_t stride,
                                      double *N)
{
  moments_of_all(1, mass, n, stride, N);
}

void dvi__chart_moments_of_nodes(const dvi__chart *chart, const double *mass,
                                 const dvi__chart_nodes *nodes, size_t stride, double *N)
{
  if (chart->kind == DVI__ROTATION)
    moments_of_rotation(mass, nodes, stride, N);
  else
    moments_of_direction(mass, nodes, stride, N);
}
