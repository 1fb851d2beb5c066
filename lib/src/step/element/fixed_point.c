#include "step/element/fixed_point.h"

#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/cholesky.h"
#include "num/simd/lanes.h"
#include "num/simd/wide.h"
#include "space/legendre.h"
#include "space/quadrature.h"
#include "system/evaluate/untested.h"

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
  /* psi and psi' at node j, then C^{-1} times these */
  long double psi[DVI_QUADRATURE_MAX][DVI_DEGREE_MAX], slope[DVI_QUADRATURE_MAX][DVI_DEGREE_MAX];
  long double K[DVI_DEGREE_MAX * DVI_DEGREE_MAX]; /* [s*s] stiffness, then its factor C */
} tables;

static void fixed_point_fill(int s, int r, const long double *node, const long double *weight,
                             tables *t)
{
  for (int j = 0; j < r; j++) {
    long double *dpsi = t->slope[j];
    legendre_trial(s, node[j], t->psi[j], dpsi);
    for (int k = 0; k < s; k++)
      for (int l = 0; l <= k; l++) t->K[k * s + l] += weight[j] * dpsi[k] * dpsi[l];
  }
  dvi__cholesky(s, t->K);
  for (int j = 0; j < r; j++) {
    dvi__cholesky_half(s, t->K, t->psi[j]);
    dvi__cholesky_half(s, t->K, t->slope[j]);
  }
}

/* Round to multiples of 2^-53, on which differences of numbers up to 1 are exact. */
static double to_grid(long double x)
{
  return (double)ldexpl(nearbyintl(ldexpl(x, 53)), -53);
}

/* x^T K^{-1} y of two functions at nodes, from C^{-1} x and C^{-1} y. */
static long double plain_product(int s, const long double *x, const long double *y)
{
  long double sum = 0;
  for (int k = 0; k < s; k++) sum += x[k] * y[k];
  return sum;
}

static double inner_product(int s, const long double *x, const long double *y)
{
  return to_grid(plain_product(s, x, y));
}

/* Store c_i - P_ij by columns, c, and 1/2 - c. P_ij = (C^{-1} psi_i) . (C^{-1} psi_j) is symmetric
 * by its form. */
static void fixed_point_store(dvi__action *a, const long double *node, const tables *t)
{
  const int lanes = a->fixed_point.lanes;
  for (int i = 0; i < a->r; i++) {
    a->fixed_point.node[i] = to_grid(node[i]);
    a->fixed_point.slant[i] = 0.5 - a->fixed_point.node[i];
  }
  for (int i = 0; i < a->r; i++)
    for (int j = 0; j < a->r; j++)
      a->fixed_point.matrix[j * lanes + i] = a->fixed_point.node[i] -
                                             inner_product(a->s, t->psi[i], t->psi[j]);
}

/* Store the rows of h v and the columns of a, 1 - W_ji, -W_ij and -U_ij. */
static void fixed_point_store_velocities(dvi__action *a, const tables *t)
{
  const int lanes = a->fixed_point.lanes, r = a->r;
  for (int i = 0; i < r; i++) {
    a->fixed_point.node[r + i] = 1;
    for (int j = 0; j < r; j++) {
      const double W = inner_product(a->s, t->psi[i], t->slope[j]);
      a->fixed_point.matrix[i * lanes + r + j] = 1 - W;
      a->fixed_point.matrix[(r + j) * lanes + i] = -W;
      a->fixed_point.matrix[(r + j) * lanes + r + i] = -inner_product(a->s, t->slope[i],
                                                                      t->slope[j]);
    }
  }
}

/* Store the last factor of the path by the forces, Y = h/m (p0 straight - K^{-1} (bar g + psi' a)),
 * by columns, in the space's own basis. `table` holds bar or psi'. */
static void fixed_point_store_path(const dvi__action *a, const double *table, double sign,
                                   double *path)
{
  const int s = a->s, r = a->r;
  for (int j = 0; j < r; j++)
    for (int k = 0; k < s; k++) {
      double sum = 0;
      for (int l = 0; l < s; l++) sum += a->stiffness_inverse[k * s + l] * table[l * a->lanes + j];
      path[j * a->path_lanes + k] = sign * sum;
    }
}

/* With a vector potential stages have numbers of their own. */
static int allocate_stages(dvi__action *a)
{
  const size_t numbers = (size_t)a->n * (size_t)a->fixed_point.stages;
  a->fixed_point.force = a->L_q;
  a->fixed_point.Q = a->Q;
  if (a->system->vector == NULL) return 1;
  a->fixed_point.force = DVI_NEW(double, numbers);
  a->fixed_point.Q = DVI_NEW(double, numbers);
  a->fixed_point.kinetic = DVI_NEW(double, a->n);
  return a->fixed_point.force && a->fixed_point.Q && a->fixed_point.kinetic;
}

static dvi_status fixed_point_allocate(dvi__action *a)
{
  a->fixed_point.stages = a->system->vector != NULL ? 2 * a->r : a->r;
  a->fixed_point.lanes = dvi__lanes_for(a->fixed_point.stages);
  const size_t n = (size_t)a->n, stages = (size_t)a->fixed_point.stages,
               lanes = (size_t)a->fixed_point.lanes;
  a->fixed_point.matrix = DVI_NEW(double, stages *lanes);
  a->fixed_point.node = DVI_NEW(double, lanes);
  a->fixed_point.slant = DVI_NEW(double, a->r);
  a->fixed_point.path = DVI_NEW(double, stages *(size_t)a->path_lanes);
  a->fixed_point.start = DVI_NEW(double, n);
  a->fixed_point.low = DVI_NEW(double, n);
  a->fixed_point.factor = DVI_NEW(double, n);
  a->fixed_point.weight = DVI_NEW(double, stages);
  a->Z = DVI_NEW(double, n *lanes);
  a->fixed_point.shift.table = DVI_NEW(double, DVI__SHIFTS *stages *lanes);
  if (allocate_stages(a) && a->fixed_point.matrix && a->fixed_point.node && a->fixed_point.slant &&
      a->fixed_point.path && a->fixed_point.start && a->fixed_point.low && a->fixed_point.factor &&
      a->fixed_point.weight && a->Z && a->fixed_point.shift.table)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
}

int dvi__action_has_fixed_point(const dvi__action *a)
{
  if (a->transformed != NULL) return a->terms.count == 0;
  return a->system->mass_diagonal != NULL &&
         (a->system->terms & (DVI__FRICTION | DVI__DAMPING)) == 0 && a->terms.count == 0;
}

int dvi__action_lags(const dvi__action *a)
{
  return a->Z != NULL && a->system->vector == NULL && a->transformed == NULL &&
         a->preconditioner == NULL && dvi__can_lag(a->system);
}

dvi__place_table dvi__action_place_table(const dvi__action *a)
{
  return (dvi__place_table){.lanes = a->fixed_point.lanes,
                            .matrix = a->fixed_point.matrix,
                            .weight = a->fixed_point.weight,
                            .factor = a->fixed_point.factor};
}

static dvi_status make_tables(const dvi__action *a, long double *node, tables **t)
{
  long double weight[DVI_QUADRATURE_MAX];
  *t = NULL;
  DVI_TRY(dvi__quadrature_long(a->space.rule, a->r, node, weight));
  *t = DVI_NEW(tables, 1);
  if (*t == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for tables of degree %d", a->s);
  fixed_point_fill(a->s, a->r, node, weight, *t);
  return DVI_OK;
}

dvi_status dvi__action_prepare_fixed_point(dvi__action *a)
{
  long double node[DVI_QUADRATURE_MAX];
  tables *t;
  if (!dvi__action_has_fixed_point(a)) return DVI_OK;
  DVI_TRY(fixed_point_allocate(a));
  DVI_TRY(make_tables(a, node, &t));
  fixed_point_store(a, node, t);
  fixed_point_store_path(a, a->bar, -1, a->fixed_point.path);
  if (a->system->vector != NULL) {
    fixed_point_store_velocities(a, t);
    fixed_point_store_path(a, a->dpsi, -1, a->fixed_point.path + a->r * a->path_lanes);
  }
  dvi__release(t);
  return DVI_OK;
}

/* Differences from 1 are exact on this grid, for numbers below 2. */
static double to_coarse_grid(long double x)
{
  return (double)(nearbyintl(0x1p52L * x) * 0x1p-52L);
}

dvi_status dvi__action_fill_transformed(const dvi__action *a, double *place, double *momentum,
                                        double *path)
{
  long double node[DVI_QUADRATURE_MAX];
  tables *t;
  DVI_TRY(make_tables(a, node, &t));
  for (int i = 0; i < a->r; i++)
    for (int j = 0; j < a->r; j++) {
      const double W = to_coarse_grid(plain_product(a->s, t->psi[i], t->slope[j]));
      place[j * a->lanes + i] = W;
      momentum[i * a->lanes + j] = 1 - W;
    }
  dvi__release(t);
  fixed_point_store_path(a, a->dpsi, 1, path);
  return DVI_OK;
}

/* ---- iterations ---- */

void dvi__action_set_step(dvi__action *a)
{
  if (a->fixed_point.h == a->h) return;
  a->fixed_point.h = a->h;
  /* the forces are V_q, with the other sign */
  for (int j = 0; j < a->r; j++) a->fixed_point.weight[j] = -a->h * a->weight[j];
  for (int j = a->r; j < a->fixed_point.stages; j++) a->fixed_point.weight[j] = a->weight[j - a->r];
  for (int i = 0; i < a->n; i++) a->fixed_point.factor[i] = a->h / a->system->mass_diagonal[i];
  if (a->preconditioner != NULL) dvi__preconditioner_set_step(a);
}

/* Set the arguments of the loops at the element's place. */
static dvi__fixed_point *place_iteration(dvi__action *a)
{
  a->fixed_point.iteration = (dvi__fixed_point){.n = a->n,
                                                .stages = a->fixed_point.stages,
                                                .lanes = a->fixed_point.lanes,
                                                .matrix = a->fixed_point.matrix,
                                                .node = a->fixed_point.node,
                                                .weight = a->fixed_point.weight,
                                                .factor = a->fixed_point.factor,
                                                .p0 = a->p0,
                                                .start = a->fixed_point.start,
                                                .low = a->fixed_point.low,
                                                .origin = a->q0,
                                                .force = a->fixed_point.force,
                                                .Z = a->Z,
                                                .Q = a->fixed_point.Q};
  return &a->fixed_point.iteration;
}

/* Put offsets from the rows of a batch [n*r] into Z, from stage `first` on. */
static void put_offsets(dvi__action *a, const double *batch, int first)
{
  const size_t r = (size_t)a->r, lanes = (size_t)a->fixed_point.lanes;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) a->Z[i * lanes + (size_t)first + j] = batch[i * r + j];
}

void dvi__action_fixed_point_begin(dvi__action *a, const double *Y)
{
  if (a->transformed != NULL) {
    dvi__transformed_begin(a, Y);
    return;
  }
  const size_t r = (size_t)a->r, stages = (size_t)a->fixed_point.stages;
  dvi__action_set_step(a);
  const dvi__fixed_point *iteration = place_iteration(a);
  if (a->fixed_point.lagged != NULL) dvi__lagged_begin(a->fixed_point.lagged, 1, 1, NULL);
  dvi__lanes_split(iteration);
  /* a step that failed may have left NaN behind the stages of a row */
  memset(a->Z, 0, (size_t)a->n * (size_t)a->fixed_point.lanes * sizeof(double));
  if (a->preconditioner != NULL) {
    dvi__preconditioner_begin(a);
    return;
  }
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->psi, Y, a->L_v);
  put_offsets(a, a->L_v, 0);
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) a->fixed_point.Q[i * stages + j] = a->q0[i] + a->L_v[i * r + j];
  if (stages == r) return;
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->dpsi, Y, a->L_v);
  put_offsets(a, a->L_v, a->r);
}

void dvi__action_fixed_point_continue(dvi__action *a, double ratio, const double *g)
{
  if (a->transformed != NULL) {
    dvi__transformed_continue(a, ratio, g);
    return;
  }
  dvi__action_set_step(a);
  const dvi__fixed_point *iteration = place_iteration(a);
  const double *shift = dvi__action_fixed_point_shift(a, ratio);
  if (a->fixed_point.lagged != NULL)
    dvi__lagged_begin(a->fixed_point.lagged, 1, ratio, g + (ptrdiff_t)a->n * a->r);
  if (a->preconditioner == NULL) {
    dvi__lanes_begin_from(iteration, shift, g);
    return;
  }
  dvi__lanes_split(iteration);
  dvi__lanes_product(a->n, a->fixed_point.stages, a->fixed_point.lanes, a->fixed_point.lanes, shift,
                     g, a->Z);
  dvi__preconditioner_begin(a);
}

/* Evaluate forces and A at the nodes, from the places and velocities of the stages. This and the
 * other kinds of iterations are compiled apart, so that the common one is lean. */
__attribute__((noinline)) static dvi_status evaluate_stages(dvi__action *a)
{
  const size_t r = (size_t)a->r, stages = (size_t)a->fixed_point.stages,
               lanes = (size_t)a->fixed_point.lanes;
  const double inverse_h = 1.0 / a->h;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) {
      a->Q[i * r + j] = a->fixed_point.Q[i * stages + j];
      a->V[i * r + j] = inverse_h * a->Z[i * lanes + r + j];
    }
  DVI_TRY(dvi__magnetic_gradient(a->evaluator, a->r, a->t, a->Q, a->V, a->L_q, a->L_v));
  for (size_t i = 0; i < (size_t)a->n; i++) {
    memcpy(a->fixed_point.force + i * stages, a->L_q + i * r, r * sizeof(double));
    memcpy(a->fixed_point.force + i * stages + r, a->L_v + i * r, r * sizeof(double));
  }
  return DVI_OK;
}

/* Iterate with slow forces that may lag. */
__attribute__((noinline)) static dvi_status iterate_lagged(dvi__action *a, double *change,
                                                           double *largest)
{
  dvi__fixed_point *iteration = &a->fixed_point.iteration;
  const dvi__place_table table = dvi__action_place_table(a);
  DVI_TRY(dvi__lagged_gradient(a->fixed_point.lagged, a->evaluator, a->t, a->Q, &table, a->L_q));
  a->iterated = 1;
  dvi__lanes_iterate(iteration);
  *change = iteration->change;
  *largest = iteration->largest;
  dvi__lagged_change(a->fixed_point.lagged, largest, change);
  return DVI_OK;
}

dvi_status dvi__action_iterate(dvi__action *a, double *change, double *largest)
{
  if (a->transformed != NULL) return dvi__transformed_iterate(a, change, largest);
  if (a->fixed_point.lagged != NULL) return iterate_lagged(a, change, largest);
  dvi__fixed_point *iteration = &a->fixed_point.iteration;
  const dvi_status status = a->fixed_point.stages > a->r
                                ? evaluate_stages(a)
                                : dvi__potentials_gradient_untested(a->evaluator, a->r, a->t, a->Q,
                                                                    a->L_q);
  if (status != DVI_OK) return status;
  a->iterated = 1;
  if (a->preconditioner != NULL) {
    dvi__preconditioner_iterate(a, change, largest);
    return DVI_OK;
  }
  dvi__lanes_iterate(iteration);
  *change = iteration->change;
  *largest = iteration->largest;
  return DVI_OK;
}

int dvi__action_has_offsets(const dvi__action *a)
{
  return a->system->mass_diagonal != NULL && a->Z != NULL;
}

const double *dvi__action_offsets(const dvi__action *a, int *count)
{
  *count = a->n * a->fixed_point.lanes;
  return a->Z;
}

WIDE static void subtract_offsets(size_t count, const double *restrict x, const double *restrict y,
                                  double *restrict difference)
{
  for (size_t k = 0; k < count; k++) difference[k] = x[k] - y[k];
}

dvi_status dvi__action_iteration_residual(dvi__action *a, const double *Z, double *residual)
{
  double change, largest;
  if (a->fixed_point.lagged != NULL) dvi__lagged_renew(a->fixed_point.lagged);
  DVI_TRY(dvi__action_iterate(a, &change, &largest));
  subtract_offsets((size_t)a->n * (size_t)a->fixed_point.lanes, Z, a->Z, residual);
  return DVI_OK;
}

void dvi__action_path_of_forces(const dvi__action *a, double h, const double *p0, const double *g,
                                double *Y)
{
  const size_t s = (size_t)a->s;
  dvi__lanes_product(a->n, a->fixed_point.stages, a->path_lanes, a->s, a->fixed_point.path, g, Y);
  for (size_t i = 0; i < (size_t)a->n; i++) {
    const double factor = h / a->system->mass_diagonal[i], start = factor * p0[i];
    for (size_t k = 0; k < s; k++) Y[i * s + k] = start * a->straight[k] + factor * Y[i * s + k];
  }
}

void dvi__action_fixed_point_path(const dvi__action *a, double *Y)
{
  if (a->transformed != NULL)
    dvi__transformed_path(a, Y);
  else
    dvi__action_path_of_forces(a, a->h, a->p0, a->fixed_point.force, Y);
}

int dvi__action_is_iterated(const dvi__action *a)
{
  return a->iterated;
}

/* Take g and a of the stages apart, with p0 - sum_j a_j. */
static void part_stages(const dvi__action *a)
{
  const size_t r = (size_t)a->r, stages = (size_t)a->fixed_point.stages;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    const double *row = a->fixed_point.force + i * stages;
    double sum = 0;
    for (size_t j = 0; j < r; j++) {
      a->L_q[i * r + j] = row[j];
      sum += row[r + j];
    }
    a->fixed_point.kinetic[i] = a->p0[i] - sum;
  }
}

void dvi__action_fixed_point_ends(const dvi__action *a, double *dq, double *dq_low, double *dp)
{
  const int has_velocities = a->fixed_point.stages > a->r;
  if (a->transformed != NULL) {
    dvi__transformed_ends(a, dq, dq_low, dp);
    return;
  }
  if (has_velocities) part_stages(a);
  dvi__lanes_ends(&(dvi__ends){.n = a->n,
                               .stages = a->r,
                               .g = a->L_q,
                               .slant = a->fixed_point.slant,
                               .factor = a->fixed_point.factor,
                               .p0 = has_velocities ? a->fixed_point.kinetic : a->p0,
                               .moved = dq,
                               .low = dq_low,
                               .sum = dp});
}

int dvi__action_forces_count(const dvi__action *a)
{
  const int stages = a->transformed != NULL ? 2 * a->r : a->fixed_point.stages;
  const int factors = a->fixed_point.lagged != NULL ? DVI__LAG_FACTORS : 0;
  return dvi__action_has_fixed_point(a) ? a->n * stages + factors : 0;
}

/* Give the forces of a path that the rows have. */
static void forces_of_rows(const dvi__action *a, double *g)
{
  const size_t r = (size_t)a->r, stages = (size_t)a->fixed_point.stages;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) {
      const size_t at = i * r + j;
      g[i * stages + j] = a->h * a->L_q[at];
      if (stages > r)
        g[i * stages + r + j] = a->L_v[at] - a->weight[j] * a->system->mass_diagonal[i] * a->V[at];
    }
}

/* Give the forces of the last iteration. */
static void iterated_forces(const dvi__action *a, double *g)
{
  const size_t numbers = (size_t)a->n * (size_t)a->fixed_point.stages;
  memcpy(g, a->fixed_point.force, numbers * sizeof(double));
  if (a->fixed_point.lagged != NULL) dvi__lagged_factors(a->fixed_point.lagged, 0, 1, g + numbers);
}

void dvi__action_forces(const dvi__action *a, double *g)
{
  if (dvi__action_forces_count(a) == 0) return;
  if (a->transformed != NULL)
    dvi__transformed_flows(a, g);
  else if (a->iterated)
    iterated_forces(a, g);
  else
    forces_of_rows(a, g);
  if (a->preconditioner != NULL) dvi__preconditioner_other_forces(a, g);
}

/* ---- steps one after the other ---- */

void dvi__action_begin_steps(dvi__action *a, double h, const double *q0, const double *p0,
                             double *dq, double *dq_low, double *dp, dvi__element_steps *steps)
{
  *steps = (dvi__element_steps){.action = a};
  dvi__lanes_solving *solving = &steps->solving;
  dvi__action_place(a, a->t0, h, q0, p0);
  dvi__action_set_step(a);
  solving->iteration = place_iteration(a);
  solving->t = a->t;
  if (a->preconditioner == NULL && a->fixed_point.stages == a->r)
    solving->evaluate = dvi__lone_gradient(a->evaluator, &solving->of);
  steps->ends = (dvi__ends){.n = a->n,
                            .stages = a->r,
                            .g = a->L_q,
                            .slant = a->fixed_point.slant,
                            .factor = a->fixed_point.factor,
                            .p0 = p0,
                            .moved = dq,
                            .low = dq_low,
                            .sum = dp};
  a->iterated = 1;
}

/* Iterate one by one, as dvi__lanes_solve does at once. */
static int solve_one_by_one(dvi__element_steps *steps)
{
  const dvi__lanes_solving *solving = &steps->solving;
  dvi__action *a = steps->action;
  dvi__history history = {0};
  double change;
  int count;
  const double *Z = dvi__action_offsets(a, &count);
  for (int i = 1; i <= solving->most; i++) {
    if (solving->before != NULL) memcpy(solving->before, Z, (size_t)count * sizeof *Z);
    if (dvi__action_iterate(a, &change, &steps->largest) != DVI_OK) return -i;
    const dvi__progress progress = dvi__settling_test(change, &history, solving->criteria,
                                                      steps->largest, solving->size);
    if (progress != DVI__GO_ON) return progress == DVI__CONVERGED ? i : -i;
  }
  return -solving->most;
}

static int solve_another_step(dvi__element_steps *steps, double ratio, double *g)
{
  dvi__action *a = steps->action;
  dvi__action_fixed_point_continue(a, ratio, g);
  const int iterations = solve_one_by_one(steps);
  if (iterations <= 0) return iterations;
  dvi__action_fixed_point_ends(a, steps->ends.moved, steps->ends.low, steps->ends.sum);
  dvi__action_forces(a, g);
  return iterations;
}

int dvi__action_solve_step(dvi__element_steps *steps, double t, double ratio, double *g)
{
  dvi__action *a = steps->action;
  const double *shift = steps->shift;
  a->t0 = t;
  for (int j = 0; j < a->r; j++) a->t[j] = t + a->node[j] * a->h;
  if (steps->solving.evaluate == NULL) return solve_another_step(steps, ratio, g);
  if (ratio != 1 || shift == NULL) shift = dvi__action_fixed_point_shift(a, ratio);
  if (ratio == 1) steps->shift = shift;
  dvi__lanes_begin_from(steps->solving.iteration, shift, g);
  const int iterations = dvi__lanes_solve(&steps->solving);
  if (iterations <= 0) return iterations;
  steps->largest = steps->solving.iteration->largest;
  dvi__lanes_ends(&steps->ends);
  memcpy(g, a->L_q, (size_t)a->n * (size_t)a->r * sizeof *g);
  return iterations;
}
