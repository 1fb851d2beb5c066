#include "support/systems/net.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

enum { MOST_DIMENSIONS = 3 };
static const double rest = 0.8;

/* ---- the grid ---- */

static int stride(const net *of, int axis)
{
  return axis == 0 ? 1 : axis == 1 ? of->side : of->side * of->side;
}

/* Whether mass m has a neighbour one step along an axis; without one there is the wall. */
static int has_neighbour(const net *of, int m, int axis, int step)
{
  const int at = m / stride(of, axis) % of->side + step;
  return at >= 0 && at < of->side;
}

/* ---- one spring ---- */

/* From a mass at displacement a, to its neighbour at b, or the wall (NULL), one step along an axis:
 * the difference of their places, and its length. b and a are entries of batches of `count`
 * points. */
static double stretch(const net *of, size_t count, const double *a, const double *b, int axis,
                      int step, double *d)
{
  double square = 0;
  for (int c = 0; c < of->dimension; c++) {
    d[c] = (c == axis ? step : 0) + (b != NULL ? b[(size_t)c * count] : 0) - a[(size_t)c * count];
    square += d[c] * d[c];
  }
  return sqrt(square);
}

/* Calls `visit` for every spring of the net at point k: each between two masses once, forward. */
typedef void visitor(const net *of, size_t count, size_t k, int m, int other, const double *d,
                     double length, double *to);

static void visit_springs(const net *of, size_t count, size_t k, const double *q, visitor *visit,
                          double *to)
{
  double d[MOST_DIMENSIONS];
  for (int m = 0; m < of->masses; m++)
    for (int axis = 0; axis < of->dimension; axis++)
      for (int step = -1; step <= 1; step += 2) {
        const int other = has_neighbour(of, m, axis, step) ? m + step * stride(of, axis) : -1;
        if (other >= 0 && step < 0) continue;
        const double *a = q + (size_t)m * (size_t)of->dimension * count + k;
        const double *b = other >= 0 ? q + (size_t)other * (size_t)of->dimension * count + k : NULL;
        const double length = stretch(of, count, a, b, axis, step, d);
        visit(of, count, k, m, other, d, length, to);
      }
}

static void add_energy(const net *of, size_t count, size_t k, int m, int other, const double *d,
                       double length, double *V)
{
  (void)count, (void)m, (void)other, (void)d;
  V[k] += 0.5 * of->k * (length - rest) * (length - rest);
}

static void add_force(const net *of, size_t count, size_t k, int m, int other, const double *d,
                      double length, double *V_q)
{
  const double factor = of->k * (1 - rest / length);
  for (int c = 0; c < of->dimension; c++) {
    V_q[((size_t)m * (size_t)of->dimension + (size_t)c) * count + k] -= factor * d[c];
    if (other >= 0)
      V_q[((size_t)other * (size_t)of->dimension + (size_t)c) * count + k] += factor * d[c];
  }
}

/* Where the block of two masses begins in a column of the second one. */
static int block_of(const net *of, int m, int other)
{
  const int column = other * of->dimension, first = of->start[column];
  int at = first;
  while (of->row[at] != m * of->dimension) at += of->dimension;
  return at - first;
}

static void add_block(const net *of, size_t count, size_t k, int m, int other, const double *H,
                      double sign, double *V_qq)
{
  const int D = of->dimension, block = block_of(of, m, other);
  for (int j = 0; j < D; j++)
    for (int i = 0; i < D; i++)
      V_qq[(size_t)(of->start[other * D + j] + block + i) * count + k] += sign * H[j * D + i];
}

static void add_curvature(const net *of, size_t count, size_t k, int m, int other, const double *d,
                          double length, double *V_qq)
{
  double H[MOST_DIMENSIONS * MOST_DIMENSIONS];
  const int D = of->dimension;
  for (int j = 0; j < D; j++)
    for (int i = 0; i < D; i++)
      H[j * D + i] = of->k * ((i == j ? 1 - rest / length : 0) +
                              rest / (length * length * length) * d[i] * d[j]);
  add_block(of, count, k, m, m, H, 1, V_qq);
  if (other < 0) return;
  add_block(of, count, k, other, other, H, 1, V_qq);
  add_block(of, count, k, m, other, H, -1, V_qq);
  add_block(of, count, k, other, m, H, -1, V_qq);
}

/* ---- callbacks ---- */

static int visit_points(const net *of, int count, size_t entries, const double *q, visitor *visit,
                        double *to)
{
  memset(to, 0, entries * (size_t)count * sizeof *to);
  for (size_t k = 0; k < (size_t)count; k++) visit_springs(of, (size_t)count, k, q, visit, to);
  return 0;
}

static int net_value(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t;
  return visit_points(user, count, 1, q, add_energy, V);
}

static int net_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const net *of = user;
  (void)t;
  return visit_points(of, count, (size_t)of->coordinates, q, add_force, V_q);
}

static int net_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const net *of = user;
  (void)t;
  return visit_points(of, count, (size_t)of->start[of->coordinates], q, add_curvature, V_qq);
}

/* ---- making it ---- */

static void list_pattern(net *made)
{
  const int D = made->dimension;
  int at = 0;
  for (int m = 0; m < made->masses; m++)
    for (int j = 0; j < D; j++) {
      for (int offset = -D; offset <= D; offset++) {
        const int axis = abs(offset) - 1, step = offset < 0 ? -1 : 1;
        if (offset != 0 && !has_neighbour(made, m, axis, step)) continue;
        const int other = offset == 0 ? m : m + step * stride(made, axis);
        for (int i = 0; i < D; i++) made->row[at++] = other * D + i;
      }
      made->start[m * D + j + 1] = at;
    }
}

static void list_start(net *made)
{
  for (int m = 0; m < made->masses; m++)
    for (int c = 0; c < made->dimension; c++) {
      double bulge = 0.1;
      for (int axis = 0; axis < made->dimension; axis++)
        bulge *= sin(3.14159265358979 * (1 + m / stride(made, axis) % made->side) /
                     (made->side + 1.0));
      made->q[m * made->dimension + c] = c == 0 ? bulge : 0.5 * bulge;
    }
}

void make_net(int dimension, int side, double k, int declared, net *made)
{
  *made = (net){.dimension = dimension, .side = side, .k = k, .masses = 1};
  for (int axis = 0; axis < dimension; axis++) made->masses *= side;
  made->coordinates = made->masses * dimension;
  const size_t n = (size_t)made->coordinates,
               block = (size_t)dimension * (2 * (size_t)dimension + 1);
  made->start = calloc(n + 1, sizeof(int));
  made->row = calloc(n * block, sizeof(int));
  made->q = calloc(2 * n, sizeof(double));
  ck_assert(made->start != NULL && made->row != NULL && made->q != NULL);
  made->p = made->q + n;
  list_pattern(made);
  list_start(made);
  dvi_potential springs = {
      .name = "springs", .value_batch = net_value, .gradient_batch = net_gradient, .user = made};
  if (declared) {
    springs.hessian_batch = net_hessian;
    springs.qq = (dvi_pattern){made->start, made->row};
  }
  const dvi_system_terms terms = {.dimension = made->coordinates,
                                  .mass.scalar = 1,
                                  .potentials = &springs,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made->system) == DVI_OK, "%s", dvi_last_error());
}

void free_net(net *made)
{
  dvi_system_destroy(&made->system);
  free(made->start);
  free(made->row);
  free(made->q);
}
