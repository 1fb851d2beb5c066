/* The monitor of distances, 1/g = S = sum of r^-p over all pairs of points. With one point r is its
 * distance from the origin.
 *
 *     g_q = -g^2 S_q,    g_qq = 2 g^3 S_q S_q^T - g^2 S_qq,
 *
 * With the difference d of the two points r^-p has the gradient -p r^-(p+2) d and the Hessian p
 * r^-(p+2) [ (p+2) d d^T/r^2 - I ]. */
#include <math.h>
#include <string.h>

#include "num/simd/rescaled.h"
#include "system/rescale/monitor.h"

/* A batch of points, coordinate i of point k at q[i*count + k], and two of the bodies. b < 0 stands
 * for the origin. */
typedef struct pair {
  const dvi__built_in *own;
  size_t count;
  const double *q;
  int a, b;
} pair;

/* Return the first of all pairs. The second function moves to the next one, and returns 0 if there
 * is none. */
static pair first_pair(const dvi__built_in *own, int count, const double *q)
{
  return (pair){.own = own,
                .count = (size_t)count,
                .q = q,
                .a = own->bodies > 1,
                .b = own->bodies > 1 ? 0 : -1};
}

static int next_pair(pair *p)
{
  if (p->b < 0) return 0;
  if (++p->b == p->a) p->a++, p->b = 0;
  return p->a < p->own->bodies;
}

/* Return the index where coordinate i of a body begins in a batch. */
static size_t place_of_body(const pair *p, int body, size_t i)
{
  return ((size_t)body * (size_t)p->own->dimension + i) * p->count;
}

/* Write coordinate i of the difference from b to a, at all points. */
static void pair_difference(const pair *p, size_t i, double *restrict d)
{
  const double *a = p->q + place_of_body(p, p->a, i);
  if (p->b < 0) {
    memcpy(d, a, p->count * sizeof *d);
    return;
  }
  const double *b = p->q + place_of_body(p, p->b, i);
  for (size_t k = 0; k < p->count; k++) d[k] = a[k] - b[k];
}

/* Compute the difference d [dimension*count], r^2 and r^-p at all points. */
static void pair_rates(const pair *p, double *restrict d, double *restrict square,
                       double *restrict rate)
{
  const double power = p->own->power;
  memset(square, 0, p->count * sizeof *square);
  for (size_t i = 0; i < (size_t)p->own->dimension; i++) {
    double *d_i = d + i * p->count;
    pair_difference(p, i, d_i);
    for (size_t k = 0; k < p->count; k++) square[k] += d_i[k] * d_i[k];
  }
  if (power == 1.5)
    dvi__rescaled_distances(p->count, square, rate);
  else
    for (size_t k = 0; k < p->count; k++) rate[k] = pow(square[k], -0.5 * power);
}

/* Add the pair's part of S_q. rate becomes -p r^-(p+2). */
static void add_pair_slope(const pair *p, const double *restrict d, const double *restrict square,
                           double *restrict rate, double *restrict S_q)
{
  const double power = p->own->power;
  for (size_t k = 0; k < p->count; k++) rate[k] = -power * rate[k] / square[k];
  for (size_t i = 0; i < (size_t)p->own->dimension; i++, d += p->count) {
    double *a = S_q + place_of_body(p, p->a, i);
    for (size_t k = 0; k < p->count; k++) a[k] += rate[k] * d[k];
    if (p->b < 0) continue;
    double *b = S_q + place_of_body(p, p->b, i);
    for (size_t k = 0; k < p->count; k++) b[k] -= rate[k] * d[k];
  }
}

/* Compute g, and S_q [n*count] unless it is NULL. */
static void distance_gradients(const dvi__built_in *own, int count, const double *q, double *g,
                               double *S_q)
{
  pair p = first_pair(own, count, q);
  memset(g, 0, p.count * sizeof *g);
  if (S_q != NULL) memset(S_q, 0, (size_t)own->n * p.count * sizeof *S_q);
  do {
    pair_rates(&p, own->a, own->square, own->rate);
    for (size_t k = 0; k < p.count; k++) g[k] += own->rate[k];
    if (S_q != NULL) add_pair_slope(&p, own->a, own->square, own->rate, S_q);
  } while (next_pair(&p));
  for (size_t k = 0; k < p.count; k++) g[k] = 1 / g[k];
}

static int distance_value(int count, const double *t, const double *q, double *g, void *user)
{
  (void)t;
  distance_gradients(user, count, q, g, NULL);
  return 0;
}

static int distance_gradient(int count, const double *t, const double *q, double *g_q, void *user)
{
  const dvi__built_in *own = user;
  const size_t points = (size_t)count;
  (void)t;
  distance_gradients(own, count, q, own->g, g_q);
  for (size_t i = 0; i < (size_t)own->n; i++)
    for (size_t k = 0; k < points; k++) g_q[i * points + k] *= -own->g[k] * own->g[k];
  return 0;
}

/* Add change to the entry (coordinate i of body x, coordinate j of body y), by columns. */
static void add_body_entry(const pair *p, int x, size_t i, int y, size_t j, size_t k, double change,
                           double *S_qq)
{
  S_qq[place_of_body(p, y, j) * (size_t)p->own->n + place_of_body(p, x, i) + k] += change;
}

static void add_pair_curvature(const pair *p, double *S_qq)
{
  const double power = p->own->power;
  const size_t d = (size_t)p->own->dimension;
  for (size_t e = 0; e < d * d * p->count; e++) {
    const size_t k = e % p->count, i = e / p->count % d, j = e / p->count / d;
    const double square = p->own->square[k], factor = power * p->own->rate[k] / square;
    const double d_i = p->own->a[i * p->count + k], d_j = p->own->a[j * p->count + k];
    const double change = factor * ((power + 2) * d_i * d_j / square - (i == j));
    add_body_entry(p, p->a, i, p->a, j, k, change, S_qq);
    if (p->b < 0) continue;
    add_body_entry(p, p->b, i, p->b, j, k, change, S_qq);
    add_body_entry(p, p->a, i, p->b, j, k, -change, S_qq);
    add_body_entry(p, p->b, i, p->a, j, k, -change, S_qq);
  }
}

static int distance_hessian(int count, const double *t, const double *q, double *g_qq, void *user)
{
  const dvi__built_in *own = user;
  const size_t n = (size_t)own->n, points = (size_t)count;
  double *S_q = own->V_q; /* free for use here */
  pair p = first_pair(own, count, q);
  (void)t;
  memset(g_qq, 0, n * n * points * sizeof *g_qq);
  distance_gradients(own, count, q, own->g, S_q);
  do {
    pair_rates(&p, own->a, own->square, own->rate);
    add_pair_curvature(&p, g_qq);
  } while (next_pair(&p));
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < points; k++) {
        double *entry = &g_qq[(j * n + i) * points + k];
        *entry = own->g[k] * own->g[k] *
                 (2 * own->g[k] * S_q[i * points + k] * S_q[j * points + k] - *entry);
      }
  return 0;
}

void dvi__distance_callbacks(dvi_potential *function)
{
  function->value_batch = distance_value;
  function->gradient_batch = distance_gradient;
  function->hessian_batch = distance_hessian;
}
