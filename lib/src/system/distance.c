/* The monitor of distances, 1/g = S = sum of r^-p over all pairs of points; of one point, its distance r from the origin.
 *
 *     g_q = -g^2 S_q,    g_qq = 2 g^3 S_q S_q^T - g^2 S_qq,
 *     r^-p: gradient -p r^-(p+2) d, Hessian p r^-(p+2) [ (p+2) d d^T/r^2 - I ] in the difference d of the two points. */
#include <math.h>
#include <string.h>

#include "system/monitor.h"

/* A batch of points: coordinate i of point k is q[i*count + k]. */
typedef struct batch {
  const dvi__built_in *own;
  size_t count, k;
  const double *q;
} batch;

/* Coordinate i of the way from body b to body a; b < 0: from the origin. */
static double way(const batch *at, int a, int b, int i)
{
  const size_t d = (size_t)at->own->dimension, j = (size_t)i;
  const double x = at->q[((size_t)a * d + j) * at->count + at->k];
  return b < 0 ? x : x - at->q[((size_t)b * d + j) * at->count + at->k];
}

static double square(const batch *at, int a, int b)
{
  double sum = 0;
  for (int i = 0; i < at->own->dimension; i++) sum += way(at, a, b, i) * way(at, a, b, i);
  return sum;
}

typedef void (*of_pair)(const batch *at, int a, int b, double *result);

static void for_pairs(const batch *at, of_pair add, double *result)
{
  if (at->own->bodies == 1) add(at, 0, -1, result);
  for (int a = 0; a < at->own->bodies; a++)
    for (int b = 0; b < a; b++) add(at, a, b, result);
}

static void add_rate(const batch *at, int a, int b, double *S)
{
  *S += pow(square(at, a, b), -0.5 * at->own->power);
}

/* S_q of point k stands in its place of the batch. */
static void add_slope(const batch *at, int a, int b, double *S_q)
{
  const double p = at->own->power, factor = -p * pow(square(at, a, b), -0.5 * p - 1);
  const size_t d = (size_t)at->own->dimension;
  for (size_t i = 0; i < d; i++) {
    const double change = factor * way(at, a, b, (int)i);
    S_q[((size_t)a * d + i) * at->count + at->k] += change;
    if (b >= 0) S_q[((size_t)b * d + i) * at->count + at->k] -= change;
  }
}

/* Entry (body x coordinate i, body y coordinate j), by columns. */
static void add_entry(const batch *at, int x, size_t i, int y, size_t j, double value, double *S_qq)
{
  const size_t d = (size_t)at->own->dimension, row = (size_t)x * d + i, column = (size_t)y * d + j;
  S_qq[(column * (size_t)at->own->n + row) * at->count + at->k] += value;
}

static void add_curvature(const batch *at, int a, int b, double *S_qq)
{
  const double p = at->own->power, r2 = square(at, a, b), factor = p * pow(r2, -0.5 * p - 1);
  const size_t d = (size_t)at->own->dimension;
  for (size_t i = 0; i < d; i++)
    for (size_t j = 0; j < d; j++) {
      const double curvature = factor * ((p + 2) * way(at, a, b, (int)i) * way(at, a, b, (int)j) / r2 - (i == j));
      add_entry(at, a, i, a, j, curvature, S_qq);
      if (b < 0) continue;
      add_entry(at, b, i, b, j, curvature, S_qq);
      add_entry(at, a, i, b, j, -curvature, S_qq);
      add_entry(at, b, i, a, j, -curvature, S_qq);
    }
}

static double monitor(const batch *at)
{
  double S = 0;
  for_pairs(at, add_rate, &S);
  return 1 / S;
}

static int value(int count, const double *t, const double *q, double *g, void *user)
{
  (void)t;
  for (int k = 0; k < count; k++) g[k] = monitor(&(batch){user, (size_t)count, (size_t)k, q});
  return 0;
}

static int gradient(int count, const double *t, const double *q, double *g_q, void *user)
{
  const dvi__built_in *own = user;
  (void)t;
  memset(g_q, 0, (size_t)own->n * (size_t)count * sizeof *g_q);
  for (int k = 0; k < count; k++) {
    const batch at = {own, (size_t)count, (size_t)k, q};
    const double g = monitor(&at);
    for_pairs(&at, add_slope, g_q);
    for (size_t i = 0; i < (size_t)own->n; i++) g_q[i * at.count + at.k] *= -g * g;
  }
  return 0;
}

/* g_q is at hand only as own->V_q, which nobody else uses here. */
static int hessian(int count, const double *t, const double *q, double *g_qq, void *user)
{
  const dvi__built_in *own = user;
  const size_t n = (size_t)own->n, points = (size_t)count;
  double *g_q = own->V_q;
  memset(g_qq, 0, n * n * points * sizeof *g_qq);
  (void)gradient(count, t, q, g_q, user);
  for (size_t k = 0; k < points; k++) {
    const batch at = {own, points, k, q};
    const double g = monitor(&at);
    for_pairs(&at, add_curvature, g_qq);
    for (size_t j = 0; j < n; j++)
      for (size_t i = 0; i < n; i++) {
        double *entry = &g_qq[(j * n + i) * points + k];
        *entry = 2 * g_q[i * points + k] * g_q[j * points + k] / g - g * g * *entry;
      }
  }
  return 0;
}

void dvi__distance_callbacks(dvi_potential *function)
{
  function->value_batch = value;
  function->gradient_batch = gradient;
  function->hessian_batch = hessian;
}
