#include "step/degenerate/discontinuous_struct.h"

#include <dvi/basis.h>
#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "system/dynamics/one_form.h"

enum { MOST = DVI__DG_POINTS_MOST };

/* ---- tables ---- */

static double discontinuous_lagrange(const dvi__discontinuous *e, int k, double tau)
{
  double product = 1;
  for (int l = 0; l < e->S; l++)
    if (l != k) product *= (tau - e->node[l]) / (e->node[k] - e->node[l]);
  return product;
}

static dvi_status fill_basis(dvi__discontinuous *e)
{
  double value[MOST], derivative[MOST];
  DVI_TRY(dvi_quadrature(DVI_GAUSS, e->r, e->c, e->b));
  if (e->S > 1) DVI_TRY(dvi_basis_nodes(DVI_LAGRANGE_LOBATTO, e->S - 1, e->node));
  for (int i = 0; i < e->r; i++) {
    value[0] = 1;
    derivative[0] = 0;
    if (e->S > 1)
      DVI_TRY(dvi_basis_evaluate(DVI_LAGRANGE_LOBATTO, e->S - 1, e->c[i], value, derivative));
    for (int k = 0; k < e->S; k++) {
      e->phi[k][i] = value[k];
      e->dphi[k][i] = derivative[k];
      e->weighted[i][k] = e->b[i] * value[k];
      e->weighted_slope[i][k] = e->b[i] * derivative[k];
    }
  }
  return DVI_OK;
}

static dvi_status discontinuous_fill_path(dvi__discontinuous *e, const dvi__dg_space *space)
{
  e->points = space->points;
  DVI_TRY(dvi_quadrature(DVI_GAUSS, e->points, e->side, e->weight));
  if (space->flux == DVI__LEFT_FLUX) e->side[0] = 0;
  if (space->flux == DVI__RIGHT_FLUX) e->side[0] = 1;
  e->lean = space->flux == DVI__LEFT_FLUX ? -0.5 : space->flux == DVI__RIGHT_FLUX ? 0.5 : 0;
  return DVI_OK;
}

/* ---- create ---- */

static double **discontinuous_owned_array(dvi__discontinuous *e, int i)
{
  double **const all[] = {&e->c_diagonal, &e->stiffness, &e->left,  &e->u,    &e->y, &e->alpha,
                          &e->gradient,   &e->flux,      &e->t,     &e->Q,    &e->V, &e->L_q,
                          &e->L_v,        &e->H_qq,      &e->H_qv,  &e->H_vv, &e->Y, &e->qq,
                          &e->qv,         &e->one_qq,    &e->one_qv};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status discontinuous_allocate(dvi__discontinuous *e)
{
  const size_t n = (size_t)e->n, r = (size_t)e->r, nS = n * (size_t)e->S,
               qq = (size_t)dvi__pattern_entries(&e->system->qq),
               qv = (size_t)dvi__pattern_entries(&e->system->qv), points = (size_t)e->points;
  const size_t size[] = {n,      n, n,     n,           n,           n,     n,
                         n,      r, n * r, n * r,       n * r,       n * r, qq * r,
                         qv * r, 1, nS,    qq * points, qv * points, qq,    qv};
  for (int i = 0; discontinuous_owned_array(e, i) != NULL; i++) {
    *discontinuous_owned_array(e, i) = DVI_NEW(double, size[i] > 0 ? size[i] : 1);
    if (*discontinuous_owned_array(e, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "dg: no memory for degree %d in %d dimensions", e->S - 1,
                       e->n);
  }
  return DVI_OK;
}

static dvi_status discontinuous_initialise(dvi__discontinuous *e, const dvi__dg_space *space,
                                           dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(e->system, e->S, e->r));
  DVI_TRY(fill_basis(e));
  DVI_TRY(discontinuous_fill_path(e, space));
  DVI_TRY(dvi__evaluator_create(e->system, e->r, DVI__HESSIANS, counters, &e->evaluator));
  DVI_TRY(dvi__joint_create(e->system, NULL, &e->joint, &e->block));
  DVI_TRY(dvi__pattern_blocks(&e->joint, e->S, &e->pattern));
  DVI_TRY(discontinuous_allocate(e));
  DVI_TRY(dvi__discontinuous_create_inverse(e));
  e->stiff = space->stiffness_count > 0;
  for (int i = 0; e->stiff && i < e->n; i++)
    e->c_diagonal[i] = space->stiffness[space->stiffness_count > 1 ? i : 0];
  return DVI_OK;
}

dvi_status dvi__discontinuous_create(const dvi_system *system, const dvi__dg_space *space,
                                     dvi_counters *counters, dvi__discontinuous **element)
{
  *element = NULL;
  dvi__discontinuous *e = DVI_NEW(dvi__discontinuous, 1);
  if (e == NULL) return dvi__fail(DVI_NO_MEMORY, "dg: no memory");
  e->system = system;
  e->n = system->n;
  e->S = space->degree + 1;
  e->r = space->nodes;
  const dvi_status status = discontinuous_initialise(e, space, counters);
  if (status != DVI_OK) dvi__discontinuous_destroy(&e);
  *element = e;
  return status;
}

void dvi__discontinuous_destroy(dvi__discontinuous **element)
{
  dvi__discontinuous *e = *element;
  if (e == NULL) return;
  for (int i = 0; discontinuous_owned_array(e, i) != NULL; i++)
    dvi__release(*discontinuous_owned_array(e, i));
  dvi__evaluator_destroy(&e->evaluator);
  dvi__discontinuous_destroy_inverse(e);
  dvi__pattern_clear(&e->joint);
  dvi__pattern_clear(&e->pattern);
  dvi__release(e->block);
  dvi__release(e);
  *element = NULL;
}

const dvi__pattern *dvi__discontinuous_pattern(const dvi__discontinuous *e)
{
  return &e->pattern;
}

dvi__evaluator *dvi__discontinuous_evaluator(const dvi__discontinuous *e)
{
  return e->evaluator;
}

/* ---- the nodes ---- */

/* Compute dN/dq+ (`plus`) or dN/dq- at q- = q* + below, with the jump u. The constant p = alpha(q*)
 * is subtracted from alpha here and in the element to reduce rounding errors. The contributions of
 * a constant to the rows cancel. */
static dvi_status node_gradient(dvi__discontinuous *e, const double *below, int stride,
                                const double *u, int plus, double *gradient)
{
  for (int i = 0; i < e->n; i++) gradient[i] = (plus ? e->stiffness[i] : -e->stiffness[i]) * u[i];
  for (int g = 0; g < e->points; g++) {
    const double sign = plus ? e->weight[g] : -e->weight[g],
                 turn = e->weight[g] * (plus ? e->side[g] : 1 - e->side[g]);
    for (int i = 0; i < e->n; i++) e->y[i] = e->from.q[i] + (below[i * stride] + e->side[g] * u[i]);
    DVI_TRY(dvi__form_gradient(e->evaluator, e->y, u, e->gradient, e->alpha));
    for (int i = 0; i < e->n; i++)
      gradient[i] += sign * (e->alpha[i] - e->from.p[i]) + turn * e->gradient[i];
  }
  return DVI_OK;
}

dvi_status dvi__discontinuous_place(dvi__discontinuous *e, double t0, double h,
                                    const dvi__dg_node *node)
{
  e->h = h;
  e->from = *node;
  for (int i = 0; i < e->n; i++) e->stiffness[i] = copysign(e->c_diagonal[i], h);
  for (int i = 0; i < e->r; i++) e->t[i] = t0 + e->c[i] * h;
  for (int i = 0; i < e->n; i++) {
    e->u[i] = node->offset[i] - 0.5 * node->jump[i];
    e->Y[i * e->S] = node->offset[i] + 0.5 * node->jump[i];
  }
  return node_gradient(e, e->u, 1, node->jump, 1, e->left);
}

/* ---- residual ---- */

static double discontinuous_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

/* Compute the polynomial and its slope at the nodes, which are lanes. */
INLINE void values_in_lanes(const dvi__discontinuous *e, const double *Y, const int lanes,
                            double *values, double *slopes)
{
  double value[MOST] = {0}, slope[MOST] = {0};
  for (int l = 0; l < e->S; l++)
    for (int k = 0; k < lanes; k++) {
      value[k] += e->phi[l][k] * Y[l];
      slope[k] += e->dphi[l][k] * Y[l];
    }
  memcpy(values, value, (size_t)lanes * sizeof *value);
  memcpy(slopes, slope, (size_t)lanes * sizeof *slope);
}

WIDE static void values_at_nodes(const dvi__discontinuous *e, const double *Y, double values[MOST],
                                 double slopes[MOST])
{
  if (e->r <= MOST / 2)
    values_in_lanes(e, Y, MOST / 2, values, slopes);
  else
    values_in_lanes(e, Y, MOST, values, slopes);
}

void dvi__discontinuous_spread(dvi__discontinuous *e, const double *x)
{
  const int S = e->S, r = e->r;
  for (int i = 0; i < e->n; i++, x += S) {
    double *Y = e->Y + i * S, value[MOST], slope[MOST];
    for (int k = 1; k < S; k++) Y[k] = x[k - 1];
    e->u[i] = x[S - 1];
    values_at_nodes(e, Y, value, slope);
    for (int k = 0; k < r; k++) {
      e->Q[i * r + k] = e->from.q[i] + value[k];
      e->V[i * r + k] = slope[k] / e->h;
    }
  }
}

/* Sum the rows of a component over the nodes. The rows are lanes. */
INLINE void rows_in_lanes(const dvi__discontinuous *e, const double *L_q, const double *L_v,
                          double p, const int lanes, double *row)
{
  double sum[MOST] = {0};
  for (int l = 0; l < e->r; l++) {
    const double impulse = e->h * L_q[l], momentum = L_v[l] - p;
    for (int k = 0; k < lanes; k++)
      sum[k] += e->weighted[l][k] * impulse + e->weighted_slope[l][k] * momentum;
  }
  memcpy(row, sum, (size_t)e->S * sizeof *sum);
}

WIDE static void rows_of_component(const dvi__discontinuous *e, const double *L_q,
                                   const double *L_v, double p, double *row)
{
  if (e->S <= MOST / 2)
    rows_in_lanes(e, L_q, L_v, p, MOST / 2, row);
  else
    rows_in_lanes(e, L_q, L_v, p, MOST, row);
}

dvi_status dvi__discontinuous_residual(dvi__discontinuous *e, const double *x, double *R)
{
  const size_t S = (size_t)e->S, r = (size_t)e->r;
  dvi__discontinuous_spread(e, x);
  DVI_TRY(dvi__lagrangian_gradient(e->evaluator, e->r, e->t, e->Q, e->V, e->L_q, e->L_v));
  DVI_TRY(node_gradient(e, e->Y + S - 1, e->S, e->u, 0, e->flux));
  for (size_t i = 0; i < (size_t)e->n; i++) {
    double *row = R + i * S;
    rows_of_component(e, e->L_q + i * r, e->L_v + i * r, e->from.p[i], row);
    row[0] += e->left[i];
    row[S - 1] += e->flux[i];
  }
  return DVI_OK;
}

dvi_status dvi__discontinuous_scale(dvi__discontinuous *e, double *scale)
{
  DVI_TRY(dvi__form_scale(e->evaluator, e->from.q, e->alpha));
  for (int i = 0; i < e->n; i++)
    for (int k = 0; k < e->S; k++) scale[i * e->S + k] = fmax(e->alpha[i], e->c_diagonal[i]);
  return DVI_OK;
}

/* ---- the end ---- */

/* Compute {q} - q* = Omega^-1 C u at {q} = e->y, with C = c + lean (Dalpha + (Dalpha)^T) = c + lean
 * (2 (Dalpha)^T - Omega). */
static dvi_status offset_of(dvi__discontinuous *e, const double *u, double *offset)
{
  memset(offset, 0, (size_t)e->n * sizeof *offset);
  if (!e->stiff && e->lean == 0) return DVI_OK;
  DVI_TRY(dvi__form_gradient(e->evaluator, e->y, u, e->gradient, e->alpha));
  for (int i = 0; i < e->n; i++) offset[i] = e->stiffness[i] * u[i] + 2 * e->lean * e->gradient[i];
  DVI_TRY(dvi__two_form_factor(e->evaluator, e->y));
  dvi__two_form_solve(e->evaluator, offset);
  for (int i = 0; i < e->n; i++) offset[i] -= e->lean * u[i];
  return DVI_OK;
}

dvi_status dvi__discontinuous_end(dvi__discontinuous *e, const double *x, double *dq, double *jump,
                                  double *offset, double *coefficients)
{
  const int S = e->S;
  dvi__discontinuous_spread(e, x);
  for (int i = 0; i < e->n; i++) {
    dq[i] = e->Y[(i + 1) * S - 1] + 0.5 * e->u[i];
    e->y[i] = e->from.q[i] + dq[i];
  }
  DVI_TRY(offset_of(e, e->u, offset));
  memcpy(jump, e->u, (size_t)e->n * sizeof *jump);
  for (int i = 0; i < e->n; i++) {
    dq[i] -= offset[i];
    for (int k = 0; k < S; k++) coefficients[i * S + k] = e->Y[i * S + k] - dq[i];
  }
  return DVI_OK;
}

/* ---- the start ---- */

/* Set y = Omega(q*) x. */
static dvi_status times_two_form(dvi__discontinuous *e, const double *x, double *y)
{
  const dvi__pattern *qv = &e->system->qv;
  DVI_TRY(dvi__form_hessian(e->evaluator, e->from.q, x, e->one_qq, e->one_qv));
  memset(y, 0, (size_t)e->n * sizeof *y);
  for (int j = 0; j < e->n; j++)
    for (int k = qv->start[j]; k < qv->start[j + 1]; k++) {
      y[qv->row[k]] += e->one_qv[k] * x[j];
      y[j] -= e->one_qv[k] * x[qv->row[k]];
    }
  return DVI_OK;
}

int dvi__discontinuous_can_settle(const dvi__discontinuous *e)
{
  return e->S % 2 == 1 || (e->stiff && e->lean == 0);
}

/* Compute {q} - q* at the start, where q* is known and {q} is not, by fixed-point iteration. Each
 * iteration contracts with the size of the jump. */
static dvi_status offset_at_start(dvi__discontinuous *e, const double *jump, double *offset)
{
  const int enough = 8;
  for (int k = 0; k < enough; k++) {
    for (int i = 0; i < e->n; i++) e->y[i] = e->from.q[i] + offset[i];
    DVI_TRY(offset_of(e, jump, offset));
  }
  return DVI_OK;
}

/* Multiply the change of the jump by (1 - M)^-1, which is 1/2 - Omega^-1 C for odd S and
 * 1/2 - Omega/(4c) for even S. */
dvi_status dvi__discontinuous_settle(dvi__discontinuous *e, const double *x, double *jump,
                                     double *offset)
{
  const int even = e->S % 2 == 0;
  dvi__discontinuous_spread(e, x);
  for (int i = 0; i < e->n; i++) {
    e->u[i] -= jump[i];
    e->y[i] = e->from.q[i] + offset[i];
  }
  if (even)
    DVI_TRY(times_two_form(e, e->u, e->flux));
  else
    DVI_TRY(offset_of(e, e->u, e->flux));
  for (int i = 0; i < e->n; i++)
    jump[i] += 0.5 * e->u[i] - (even ? e->flux[i] / (4 * e->stiffness[i]) : e->flux[i]);
  return offset_at_start(e, jump, offset);
}

/* ---- guesses ---- */

void dvi__discontinuous_straight(const dvi__discontinuous *e, const double *v, double *x)
{
  for (int i = 0; i < e->n; i++, x += e->S) {
    for (int k = 1; k < e->S; k++) x[k - 1] = e->node[k] * e->h * v[i];
    x[e->S - 1] = 0;
  }
}

void dvi__discontinuous_continue(dvi__discontinuous *e, double ratio, const double *coefficients,
                                 double *x)
{
  const int S = e->S;
  for (int k = 1; k < S && ratio != e->ratio; k++)
    for (int l = 0; l < S; l++)
      e->shift[k][l] = discontinuous_lagrange(e, l, 1 + ratio * e->node[k]);
  e->ratio = ratio;
  for (int i = 0; i < e->n; i++, coefficients += S, x += S) {
    for (int k = 1; k < S; k++)
      x[k - 1] = e->from.jump[i] + discontinuous_dot(S, e->shift[k], coefficients);
    x[S - 1] = e->from.jump[i];
  }
}
