/* Fixed-point iteration. With as many points as degrees the equations of a step are those of a
 * partitioned Runge-Kutta method,
 *
 *     Q_i = q0 + h sum_j a_ij H_p_j,           a_ij the coefficients of collocation,
 *     P_i = p0 - h sum_j (b_j - b_j a_ji / b_i) H_q_j,
 *
 * whose right sides are a contraction for short steps. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/hamiltonian/canonical_struct.h"
#include "step/hamiltonian/rows.h"
#include "step/onestep/collocation.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "num/simd/small_lu.h"
#include "num/simd/wide.h"

enum { MOST = DVI__CANONICAL_DEGREE };

/* ---- create ---- */

/* Fill the inverse of the slopes psi_k'(c_j), column by column. */
static dvi_status fill_path(const dvi__canonical *c, double *path)
{
  const int s = c->s, stride = dvi__small_lu_stride(s);
  double upper[MOST * MOST] = {0}, lower[MOST * MOST] = {0}, diagonal[MOST];
  int pivot[MOST] = {0};
  const dvi__small_lu slope = {s, stride, upper, lower, diagonal, pivot};
  for (int j = 0; j < s; j++)
    for (int k = 0; k < s; k++) slope.upper[k * stride + j] = c->slope[j][k];
  if (!(dvi__small_lu_factor(&slope) > 0))
    return dvi__fail(DVI_SINGULAR, "the points of a step do not determine its path");
  for (int j = 0; j < s; j++) {
    path[j * c->iteration.lanes + j] = 1;
    dvi__small_lu_solve(&slope, path + j * c->iteration.lanes);
  }
  return DVI_OK;
}

static dvi_status fill_coefficients(const dvi__canonical *c, const dvi__canonical_iteration *own)
{
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST];
  if (c->rule == DVI_GAUSS)
    dvi__collocate_by(c->r, c->c, c->c, c->b, a);
  else
    DVI_TRY(dvi__collocate(c->r, c->c, a));
  for (int i = 0; i < c->r; i++)
    for (int j = 0; j < c->r; j++) {
      own->a[j * own->lanes + i] = a[i][j];
      own->adjoint[j * own->lanes + i] = c->b[j] - c->b[j] * a[j][i] / c->b[i];
    }
  return fill_path(c, own->path);
}

dvi_status dvi__canonical_iteration_create(dvi__canonical *c)
{
  if (!dvi__canonical_has_iteration(c)) return DVI_OK;
  dvi__canonical_iteration *own = &c->iteration;
  own->lanes = dvi__lanes_for(c->r);
  const size_t table = (size_t)c->r * (size_t)own->lanes, numbers = (size_t)dvi__canonical_room(c);
  own->a = DVI_NEW(double, 3 * table + 9 * numbers);
  if (own->a == NULL)
    return dvi__fail(DVI_NO_MEMORY, "no memory for %d points in %d dimensions", c->r, c->n);
  own->adjoint = own->a + table;
  own->path = own->adjoint + table;
  own->dq = own->path + table;
  own->dp = own->dq + numbers;
  own->sum = own->dp + numbers;
  own->q0 = own->sum + numbers;
  own->p0 = own->q0 + numbers;
  own->of_q = own->p0 + numbers;
  own->of_p = own->of_q + numbers;
  own->weight_q = own->of_p + numbers;
  own->weight_p = own->weight_q + numbers;
  return fill_coefficients(c, own);
}

void dvi__canonical_iteration_clear(dvi__canonical_iteration *iteration)
{
  dvi__release(iteration->a);
}

int dvi__canonical_has_iteration(const dvi__canonical *c)
{
  return c->r == c->s;
}

/* ---- iterate ---- */

/* Move a block of points. */
INLINE void move_block(double h, const block *sum, const block *start, const block *scale,
                       const block *weight, block *increment, block *point, largest_lanes *most)
{
  const block next = h * *sum, change = (next - *increment) * *weight, whole = next * *scale;
  *increment = next;
  *point = *start + next;
  note_change(&change, &whole, most);
}

/* Replace increments by h times the sums, and set the points. The last block may have zeros behind
 * the numbers. Gives the largest change and increment of one kind, q or p, in its units, changes by
 * their weights. */
WIDE static void move_points(int count, double h, const double *sum, const double *start,
                             const double *scale, const double *weight, double *increment,
                             double *point, largest *most)
{
  largest_lanes lanes = {{0}, {0}, {0}};
  for (int i = 0; i < count; i += BLOCK) {
    block by, from, unit, heavy, old, at;
    memcpy(&by, sum + i, sizeof by);
    memcpy(&from, start + i, sizeof from);
    memcpy(&unit, scale + i, sizeof unit);
    memcpy(&heavy, weight + i, sizeof heavy);
    memcpy(&old, increment + i, sizeof old);
    move_block(h, &by, &from, &unit, &heavy, &old, &at, &lanes);
    memcpy(increment + i, &old, sizeof old);
    memcpy(point + i, &at, sizeof at);
  }
  *most = (largest){0};
  add_largest(&lanes, most);
}

/* The least part of the largest motion as which a smaller one is measured. Changes of one that is
 * smaller yet may be roundings of the others. */
static const double least_part = 0x1p-20;

/* Measure p as a part of its own motion where that is the larger one, or changes of p alternate
 * with much smaller ones of q. */
static double weight_of_momenta(const largest *q, const largest *p)
{
  const double part = q->whole / p->whole;
  return part >= 1 || p->whole == 0 ? 1 : larger(part, least_part);
}

static double largest_motion(int count, const double *increment, double scale)
{
  double most = 0;
  for (int i = 0; i < count; i++) most = larger(fabs(increment[i]) * scale, most);
  return most;
}

/* Weigh the changes of each coordinate so that they are parts of its own motion in the guess.
 * Otherwise a coordinate that moves much less than another one would stop short of its own digits,
 * by about the same in every step, and its energy would drift. */
static void weigh_changes(int n, int r, const double *increment, const double *scale,
                          double *weight)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = larger(largest_motion(r, increment + i * r, scale[i * r]), most);
  for (int i = 0; i < n; i++) {
    const double one = largest_motion(r, increment + i * r, scale[i * r]),
                 factor = one > 0 && most <= DBL_MAX ? most / larger(one, least_part * most) : 1;
    for (int j = 0; j < r; j++) weight[i * r + j] = factor * scale[i * r + j];
  }
}

void dvi__canonical_begin(dvi__canonical *c, const double *x)
{
  dvi__canonical_iteration *own = &c->iteration;
  dvi__canonical_points(c, x);
  for (int i = 0; i < c->n; i++)
    for (int j = 0; j < c->r; j++) {
      const int at = i * c->r + j;
      own->dq[at] = c->Q[at] - c->q0[i];
      own->dp[at] = c->P[at] - c->p0[i];
      own->q0[at] = c->q0[i];
      own->p0[at] = c->p0[i];
      own->of_q[at] = 1;
      own->of_p[at] = 1 / c->unit[i];
    }
  weigh_changes(c->n, c->r, own->dq, own->of_q, own->weight_q);
  weigh_changes(c->n, c->r, own->dp, own->of_p, own->weight_p);
}

/* Make one sweep. Adds to the largest change, and gives the largest increment. */
static dvi_status sweep(dvi__canonical *c, double *change, double *whole)
{
  const dvi__canonical_iteration *own = &c->iteration;
  largest q, p;
  DVI_TRY(dvi__lagrangian_gradient(c->evaluator, c->r, c->t, c->Q, c->P, c->H_q, c->H_p));
  dvi__lanes_product(c->n, c->r, own->lanes, c->r, own->a, c->H_p, own->sum);
  move_points(c->n * c->r, c->h, own->sum, own->q0, own->of_q, own->weight_q, own->dq, c->Q, &q);
  dvi__lanes_product(c->n, c->r, own->lanes, c->r, own->adjoint, c->H_q, own->sum);
  move_points(c->n * c->r, -c->h, own->sum, own->p0, own->of_p, own->weight_p, own->dp, c->P, &p);
  const double weight = weight_of_momenta(&q, &p);
  *change = larger(larger(q.change, weight * p.change), *change);
  *whole = larger(q.whole, weight * p.whole);
  return DVI_OK;
}

/* One sweep makes errors of p those of q, and the other way round. Two of them contract errors of
 * both by one factor, whatever their units. */
dvi_status dvi__canonical_iterate(dvi__canonical *c, double *change, double *whole)
{
  *change = 0;
  DVI_TRY(sweep(c, change, whole));
  return sweep(c, change, whole);
}

void dvi__canonical_finish(const dvi__canonical *c, double *x)
{
  const dvi__canonical_iteration *own = &c->iteration;
  dvi__lanes_product(c->n, c->r, own->lanes, c->s, own->path, c->H_p, own->sum);
  for (int i = 0; i < c->n; i++, x += c->m) {
    for (int k = 0; k < c->s; k++) x[k] = c->h * own->sum[i * c->s + k];
    for (int j = 0; j < c->r; j++) x[c->s + j] = own->dp[i * c->r + j] / c->unit[i];
  }
}
