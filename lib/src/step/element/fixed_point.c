#include "step/element/fixed_point.h"

#include <math.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/cholesky.h"
#include "num/simd/lanes.h"
#include "space/legendre.h"
#include "space/quadrature.h"

/* ---- tables ---- */

/* Evaluate trial functions for P. Any basis gives the same P. This one is orthogonal in the
 * integral, and nearly so in the sums, psi_k' = P_k(1 - 2 tau), k = 0..s-1. */
static void legendre_trial(int s, long double tau, long double *psi, long double *dpsi)
{
  long double value[DVI_DEGREE_MAX + 2], difference[DVI_DEGREE_MAX + 2];
  dvi__legendre(s, tau, value, difference);
  for (int k = 0; k < s; k++) {
    dpsi[k] = value[k];
    psi[k] = k == 0 ? tau : -(difference[k + 1] + difference[k]) / (2 * (2 * k + 1));
  }
}

typedef struct tables {
  long double psi[DVI_QUADRATURE_MAX][DVI_DEGREE_MAX]; /* psi at node j, then C^{-1} psi */
  long double K[DVI_DEGREE_MAX * DVI_DEGREE_MAX];      /* [s*s] stiffness, then its factor C */
} tables;

static void fixed_point_fill(int s, int r, const long double *node, const long double *weight,
                             tables *t)
{
  long double dpsi[DVI_DEGREE_MAX];
  for (int j = 0; j < r; j++) {
    legendre_trial(s, node[j], t->psi[j], dpsi);
    for (int k = 0; k < s; k++)
      for (int l = 0; l <= k; l++) t->K[k * s + l] += weight[j] * dpsi[k] * dpsi[l];
  }
  dvi__cholesky(s, t->K);
  for (int j = 0; j < r; j++) dvi__cholesky_half(s, t->K, t->psi[j]);
}

/* Round to multiples of 2^-53, on which differences of numbers up to 1 are exact. */
static double to_grid(long double x)
{
  return (double)ldexpl(nearbyintl(ldexpl(x, 53)), -53);
}

/* Store c_i - P_ij by columns, c, and 1/2 - c. P_ij = (C^{-1} psi_i) . (C^{-1} psi_j) is symmetric
 * by its form. */
static void fixed_point_store(dvi__action *a, const long double *node, const tables *t)
{
  const int lanes = a->lanes;
  for (int i = 0; i < a->r; i++) {
    a->fixed_point.node[i] = to_grid(node[i]);
    a->fixed_point.slant[i] = 0.5 - a->fixed_point.node[i];
  }
  for (int i = 0; i < a->r; i++)
    for (int j = 0; j < a->r; j++) {
      long double P = 0;
      for (int k = 0; k < a->s; k++) P += t->psi[i][k] * t->psi[j][k];
      a->fixed_point.matrix[j * lanes + i] = a->fixed_point.node[i] - to_grid(P);
    }
}

/* Store the last factor of the path by the forces, Y = h/m (p0 straight - K^{-1} bar g), by
 * columns, in the space's own basis. */
static void fixed_point_store_path(dvi__action *a)
{
  const int s = a->s, r = a->r;
  for (int j = 0; j < r; j++)
    for (int k = 0; k < s; k++) {
      double sum = 0;
      for (int l = 0; l < s; l++) sum += a->stiffness_inverse[k * s + l] * a->bar[l * a->lanes + j];
      a->fixed_point.path[j * a->path_lanes + k] = -sum;
    }
}

static dvi_status fixed_point_allocate(dvi__action *a)
{
  const size_t n = (size_t)a->n, r = (size_t)a->r, lanes = (size_t)a->lanes;
  a->fixed_point.matrix = DVI_NEW(double, r *lanes);
  a->fixed_point.node = DVI_NEW(double, lanes);
  a->fixed_point.slant = DVI_NEW(double, r);
  a->fixed_point.path = DVI_NEW(double, r *(size_t)a->path_lanes);
  a->fixed_point.start = DVI_NEW(double, n);
  a->fixed_point.low = DVI_NEW(double, n);
  a->fixed_point.factor = DVI_NEW(double, n);
  a->fixed_point.weight = DVI_NEW(double, r);
  a->Z = DVI_NEW(double, n *lanes);
  a->fixed_point.shift.table = DVI_NEW(double, DVI__SHIFTS *r *lanes);
  if (a->fixed_point.matrix && a->fixed_point.node && a->fixed_point.slant && a->fixed_point.path &&
      a->fixed_point.start && a->fixed_point.low && a->fixed_point.factor &&
      a->fixed_point.weight && a->Z && a->fixed_point.shift.table)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
}

int dvi__action_has_fixed_point(const dvi__action *a)
{
  return a->system->mass_diagonal != NULL &&
         (a->system->terms & (DVI__FRICTION | DVI__VECTOR_POTENTIAL)) == 0 && a->terms.count == 0;
}

dvi_status dvi__action_prepare_fixed_point(dvi__action *a)
{
  long double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  if (!dvi__action_has_fixed_point(a)) return DVI_OK;
  DVI_TRY(fixed_point_allocate(a));
  DVI_TRY(dvi__quadrature_long(a->space.rule, a->r, node, weight));
  tables *t = DVI_NEW(tables, 1);
  if (t == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for tables of degree %d", a->s);
  fixed_point_fill(a->s, a->r, node, weight, t);
  fixed_point_store(a, node, t);
  fixed_point_store_path(a);
  dvi__release(t);
  return DVI_OK;
}

/* ---- iterations ---- */

void dvi__action_set_step(dvi__action *a)
{
  if (a->fixed_point.h == a->h) return;
  a->fixed_point.h = a->h;
  /* the forces are V_q, with the other sign */
  for (int j = 0; j < a->r; j++) a->fixed_point.weight[j] = -a->h * a->weight[j];
  for (int i = 0; i < a->n; i++) a->fixed_point.factor[i] = a->h / a->system->mass_diagonal[i];
}

static dvi__fixed_point fixed_point_of(const dvi__action *a)
{
  return (dvi__fixed_point){.n = a->n,
                            .stages = a->r,
                            .lanes = a->lanes,
                            .matrix = a->fixed_point.matrix,
                            .node = a->fixed_point.node,
                            .weight = a->fixed_point.weight,
                            .factor = a->fixed_point.factor,
                            .p0 = a->p0,
                            .start = a->fixed_point.start,
                            .low = a->fixed_point.low,
                            .origin = a->q0,
                            .force = a->L_q,
                            .Z = a->Z,
                            .Q = a->Q};
}

void dvi__action_fixed_point_begin(dvi__action *a, const double *Y)
{
  const size_t r = (size_t)a->r, lanes = (size_t)a->lanes;
  dvi__action_set_step(a);
  const dvi__fixed_point iteration = fixed_point_of(a);
  dvi__lanes_split(&iteration);
  dvi__lanes_product(a->n, a->s, a->lanes, a->lanes, a->psi, Y, a->Z);
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) a->Q[i * r + j] = a->q0[i] + a->Z[i * lanes + j];
}

void dvi__action_fixed_point_continue(dvi__action *a, double ratio, const double *g)
{
  dvi__action_set_step(a);
  const dvi__fixed_point iteration = fixed_point_of(a);
  dvi__lanes_split(&iteration);
  dvi__lanes_product(a->n, a->r, a->lanes, a->lanes, dvi__action_fixed_point_shift(a, ratio), g,
                     a->Z);
  dvi__lanes_begin(&iteration);
}

dvi_status dvi__action_iterate(dvi__action *a, double *change, double *largest)
{
  DVI_TRY(dvi__potentials_gradient(a->evaluator, a->r, a->t, a->Q, a->L_q));
  dvi__fixed_point iteration = fixed_point_of(a);
  dvi__lanes_iterate(&iteration);
  a->iterated = 1;
  *change = iteration.change;
  *largest = iteration.largest;
  return DVI_OK;
}

void dvi__action_fixed_point_path(dvi__action *a, double *Y)
{
  const size_t s = (size_t)a->s;
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, a->fixed_point.path, a->L_q, Y);
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t k = 0; k < s; k++)
      Y[i * s + k] = a->fixed_point.start[i] * a->straight[k] +
                     a->fixed_point.factor[i] * Y[i * s + k];
}

void dvi__action_fixed_point_ends(const dvi__action *a, double *dq, double *dq_low, double *dp)
{
  dvi__lanes_ends(&(dvi__ends){.n = a->n,
                               .stages = a->r,
                               .g = a->L_q,
                               .slant = a->fixed_point.slant,
                               .factor = a->fixed_point.factor,
                               .p0 = a->p0,
                               .moved = dq,
                               .low = dq_low,
                               .sum = dp});
}

int dvi__action_forces_count(const dvi__action *a)
{
  return dvi__action_has_fixed_point(a) ? a->n * a->r : 0;
}

void dvi__action_forces(const dvi__action *a, double *g)
{
  const double scale = a->iterated ? 1.0 : a->h;
  for (int k = 0; k < dvi__action_forces_count(a); k++) g[k] = scale * a->L_q[k];
}
