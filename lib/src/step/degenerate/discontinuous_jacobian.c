/* The linearised equations of an element: as a matrix, and by its inverse. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/small_inverse.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "step/degenerate/discontinuous_struct.h"

enum { MOST = DVI__DG_POINTS_MOST };

static dvi_status hessians_on_path(dvi__discontinuous *e)
{
  const int qq = dvi__pattern_entries(&e->system->qq), qv = dvi__pattern_entries(&e->system->qv);
  for (int g = 0; g < e->points; g++) {
    for (int i = 0; i < e->n; i++)
      e->y[i] = e->from.q[i] + (e->Y[(i + 1) * e->S - 1] + e->side[g] * e->u[i]);
    DVI_TRY(dvi__form_hessian(e->evaluator, e->y, e->u, e->one_qq, e->one_qv));
    for (int k = 0; k < qq; k++) e->qq[k * e->points + g] = e->one_qq[k];
    for (int k = 0; k < qv; k++) e->qv[k * e->points + g] = e->one_qv[k];
  }
  return DVI_OK;
}

/* An entry (i,j) of the joint pattern has d alpha_i/dq_j (A), d alpha_j/dq_i (B) and h d2L/dq2 (K)
 * at c_i, and the derivatives of dN/dq- by q- and by the jump. */
typedef struct entry {
  double A[MOST], B[MOST], K[MOST];
  double by_trace, by_jump;
} entry;

static double discontinuous_at(const double *values, int where, int count, int point)
{
  return where >= 0 ? values[where * count + point] : 0;
}

static void discontinuous_gather(const dvi__discontinuous *e, const dvi__joint_entry *where,
                                 double stiffness, entry *out)
{
  for (int k = 0; k < e->r; k++) {
    out->A[k] = discontinuous_at(e->H_qv, where->vq, e->r, k);
    out->B[k] = discontinuous_at(e->H_qv, where->qv, e->r, k);
    out->K[k] = e->h * discontinuous_at(e->H_qq, where->qq, e->r, k);
  }
  out->by_trace = 0;
  out->by_jump = -stiffness;
  for (int g = 0; g < e->points; g++) {
    const double A = discontinuous_at(e->qv, where->vq, e->points, g),
                 B = discontinuous_at(e->qv, where->qv, e->points, g);
    const double H = discontinuous_at(e->qq, where->qq, e->points, g), plus = e->side[g],
                 minus = 1 - plus;
    out->by_trace += e->weight[g] * (minus * H - A);
    out->by_jump += e->weight[g] * (plus * minus * H + minus * B - plus * A);
  }
}

/* Fill the rows of a block in the column of the coefficient X_l, 0 < l. They are lanes. */
INLINE void coefficient_column(const dvi__discontinuous *e, const entry *of, int l, const int lanes,
                               double *column)
{
  double sum[MOST] = {0};
  for (int i = 0; i < e->r; i++) {
    const double impulse = e->phi[l][i] * of->K[i] + e->dphi[l][i] * of->B[i],
                 momentum = e->phi[l][i] * of->A[i];
    for (int k = 0; k < lanes; k++)
      sum[k] += e->weighted[i][k] * impulse + e->weighted_slope[i][k] * momentum;
  }
  memcpy(column, sum, (size_t)e->S * sizeof *sum);
  if (l == e->S - 1) column[l] += of->by_trace;
}

/* Fill the columns of all coefficients, which are `step` numbers apart. */
WIDE static void coefficient_columns(const dvi__discontinuous *e, const entry *of, size_t step,
                                     double *columns)
{
  for (int l = 1; l < e->S; l++, columns += step)
    if (e->S <= MOST / 2)
      coefficient_column(e, of, l, MOST / 2, columns);
    else
      coefficient_column(e, of, l, MOST, columns);
}

static dvi_status evaluate_hessians(dvi__discontinuous *e, const double *x)
{
  dvi__discontinuous_spread(e, x);
  DVI_TRY(dvi__lagrangian_hessian(e->evaluator, e->r, e->t, e->Q, e->V, e->H_qq, e->H_qv, e->H_vv));
  return hessians_on_path(e);
}

void dvi__discontinuous_fill(dvi__discontinuous *e, double *values)
{
  const size_t S = (size_t)e->S;
  for (int j = 0; j < e->n; j++) {
    const size_t first = (size_t)e->joint.start[j], length = (size_t)e->joint.start[j + 1] - first;
    for (size_t k = 0; k < length; k++) {
      entry of;
      double *columns = values + S * S * first + k * S, *last = columns + (S - 1) * length * S;
      discontinuous_gather(e, &e->block[first + k],
                           e->joint.row[first + k] == j ? e->stiffness[j] : 0, &of);
      coefficient_columns(e, &of, length * S, columns);
      memset(last, 0, S * sizeof *last);
      last[S - 1] = of.by_jump;
    }
  }
}

dvi_status dvi__discontinuous_jacobian(dvi__discontinuous *e, const double *x, double *values)
{
  DVI_TRY(evaluate_hessians(e, x));
  dvi__discontinuous_fill(e, values);
  return DVI_OK;
}

/* ---- inverse ---- */

/* With D_kl = sum_i b_i phi_k(c_i) phi_l'(c_i), Omega = (Dalpha)^T - Dalpha the same at all nodes,
 * and G the derivative of the last rows by the jump, the Jacobian is
 *
 *     [ D Omega  0 ]   rows 0 to S-2, coefficients 1 to S-1 and the jump
 *     [ d Omega  G ]   rows S-1, d the last row of D
 *
 * but for terms of O(h). Multiplied by [ D^-1 0; -d D^-1 1 ], and then by the inverses of Omega and
 * G, it is 1 + O(h). */
struct dvi__dg_inverse {
  int stride;
  double rows[MOST][MOST];                                 /* the first factor, by columns */
  double weighted[MOST][MOST], weighted_slope[MOST][MOST]; /* those of the element, times it */
  entry *block;                                            /* [n*n] by columns */
  double *Omega, *G; /* [n*n] inverses, by columns, in the same memory as the next */
  double *turn;      /* [n*n*MOST] the second factor, row by row of a component */
  double *inverse;   /* [stride*n*S + MOST] */
};

/* Returns 0 if D is singular. */
static int fill_rows(const dvi__discontinuous *e, dvi__dg_inverse *inverse)
{
  const int last = e->S - 1;
  double D[MOST][MOST] = {{0}}, packed[MOST * MOST];
  for (int k = 0; k <= last; k++)
    for (int l = 1; l <= last; l++)
      for (int i = 0; i < e->r; i++) D[l - 1][k] += e->weighted[i][k] * e->dphi[l][i];
  for (int l = 0; l < last; l++)
    for (int k = 0; k < last; k++) packed[l * last + k] = D[l][k];
  if (last > 0 && dvi__small_invert(last, packed) == 0) return 0;
  for (int k = 0; k < last; k++)
    for (int l = 0; l < last; l++) {
      inverse->rows[k][l] = packed[k * last + l];
      inverse->rows[k][last] -= D[l][last] * packed[k * last + l];
    }
  inverse->rows[last][last] = 1;
  for (int i = 0; i < e->r; i++)
    for (int k = 0; k <= last; k++)
      for (int l = 0; l <= last; l++) {
        inverse->weighted[i][l] += inverse->rows[k][l] * e->weighted[i][k];
        inverse->weighted_slope[i][l] += inverse->rows[k][l] * e->weighted_slope[i][k];
      }
  return 1;
}

static int dg_inverse_allocate(const dvi__discontinuous *e, dvi__dg_inverse *made)
{
  const size_t n = (size_t)e->n, unknowns = n * (size_t)e->S;
  made->stride = dvi__near_one_stride((int)unknowns);
  made->block = DVI_NEW(entry, n * n);
  made->Omega = DVI_NEW(double, (2 + MOST) * n * n);
  made->inverse = DVI_NEW(double, (size_t)made->stride *unknowns + MOST);
  if (made->block == NULL || made->Omega == NULL || made->inverse == NULL) return 0;
  made->G = made->Omega + n * n;
  made->turn = made->G + n * n;
  return 1;
}

dvi_status dvi__discontinuous_create_inverse(dvi__discontinuous *e)
{
  if (e->n > DVI__NEAR_ONE_MOST / e->S) return DVI_OK;
  e->inverse = DVI_NEW(dvi__dg_inverse, 1);
  if (e->inverse == NULL || !dg_inverse_allocate(e, e->inverse))
    return dvi__fail(DVI_NO_MEMORY, "dg: no memory for the inverse of degree %d", e->S - 1);
  if (!fill_rows(e, e->inverse)) dvi__discontinuous_destroy_inverse(e);
  return DVI_OK;
}

void dvi__discontinuous_destroy_inverse(dvi__discontinuous *e)
{
  dvi__dg_inverse *inverse = e->inverse;
  if (inverse == NULL) return;
  dvi__release(inverse->block);
  dvi__release(inverse->Omega);
  dvi__release(inverse->inverse);
  dvi__release(inverse);
  e->inverse = NULL;
}

/* Gather the entries, and invert Omega, the mean over the nodes, and G. Returns 0 if one is
 * singular, or the sign of the determinant is not 1. */
static int begin_inverse(const dvi__discontinuous *e, const dvi__dg_inverse *inverse)
{
  const int n = e->n, S = e->S;
  for (int j = 0; j < n; j++)
    for (int k = e->joint.start[j]; k < e->joint.start[j + 1]; k++) {
      const int i = e->joint.row[k];
      discontinuous_gather(e, &e->block[k], i == j ? e->stiffness[j] : 0,
                           inverse->block + j * n + i);
    }
  for (int at = 0; at < n * n; at++) {
    const entry *of = inverse->block + at;
    double sum = 0;
    for (int i = 0; i < e->r; i++) sum += e->b[i] * (of->B[i] - of->A[i]);
    inverse->Omega[at] = sum;
    inverse->G[at] = of->by_jump;
  }
  if (dvi__small_invert(n, inverse->Omega) == 0 || dvi__small_invert(n, inverse->G) <= 0) return 0;
  for (int at = 0; at < n * n; at++)
    for (int k = 0; k < S; k++)
      inverse->turn[at * MOST + k] = k < S - 1 ? inverse->Omega[at] : inverse->G[at];
  return 1;
}

/* Write a component's rows, times the first factor, in the column of coefficient l, or of the jump,
 * l = S. */
INLINE void write_rows(const dvi__discontinuous *e, const entry *of, int l, const int lanes,
                       double *rows)
{
  const dvi__dg_inverse *inverse = e->inverse;
  const double *unit = inverse->rows[e->S - 1], end = l == e->S       ? of->by_jump
                                                      : l == e->S - 1 ? of->by_trace
                                                                      : 0;
  double sum[MOST];
  for (int row = 0; row < lanes; row++) sum[row] = unit[row] * end;
  for (int k = 0; k < e->r && l < e->S; k++) {
    const double impulse = e->phi[l][k] * of->K[k] + e->dphi[l][k] * of->B[k],
                 momentum = e->phi[l][k] * of->A[k];
    for (int row = 0; row < lanes; row++)
      sum[row] += inverse->weighted[k][row] * impulse + inverse->weighted_slope[k][row] * momentum;
  }
  for (int row = 0; row < lanes; row++) rows[row] = sum[row];
}

/* Multiply the rows of all components by the second factor. */
INLINE void turn_rows(const dvi__discontinuous *e, const double *rows, const int lanes,
                      double *turned)
{
  for (int to = 0; to < e->n; to++) {
    double sum[MOST] = {0};
    for (int i = 0; i < e->n; i++) {
      const double *by = e->inverse->turn + (i * e->n + to) * MOST;
      for (int row = 0; row < lanes; row++) sum[row] += by[row] * rows[i * MOST + row];
    }
    memcpy(turned + to * e->S, sum, (size_t)lanes * sizeof *sum);
  }
}

INLINE void write_column(const dvi__discontinuous *e, int j, int l, const int lanes, double *column)
{
  double rows[DVI__NEAR_ONE_MOST * MOST];
  for (int i = 0; i < e->n; i++)
    write_rows(e, e->inverse->block + j * e->n + i, l, lanes, rows + i * MOST);
  turn_rows(e, rows, lanes, column);
}

WIDE static void write_columns(const dvi__discontinuous *e)
{
  double *column = e->inverse->inverse;
  for (int j = 0; j < e->n; j++)
    for (int l = 1; l <= e->S; l++, column += e->inverse->stride)
      if (e->S <= MOST / 2)
        write_column(e, j, l, MOST / 2, column);
      else
        write_column(e, j, l, MOST, column);
}

dvi_status dvi__discontinuous_invert(dvi__discontinuous *e, const double *x, int *inverted)
{
  DVI_TRY(evaluate_hessians(e, x));
  *inverted = e->inverse != NULL && begin_inverse(e, e->inverse);
  if (!*inverted) return DVI_OK;
  write_columns(e);
  *inverted = dvi__near_one_invert(e->n * e->S, e->inverse->inverse);
  return DVI_OK;
}

/* Multiply r by both factors. */
WIDE static void turn_right_side(const dvi__discontinuous *e, const double *r, double *turned)
{
  double rows[DVI__NEAR_ONE_MOST * MOST];
  for (int i = 0; i < e->n; i++) {
    double sum[MOST] = {0};
    for (int k = 0; k < e->S; k++)
      for (int row = 0; row < MOST; row++) sum[row] += e->inverse->rows[k][row] * r[i * e->S + k];
    memcpy(rows + i * MOST, sum, sizeof sum);
  }
  turn_rows(e, rows, MOST, turned);
}

void dvi__discontinuous_correct(dvi__discontinuous *e, double *r)
{
  double turned[DVI__NEAR_ONE_MOST + MOST];
  turn_right_side(e, r, turned);
  dvi__near_one_times(e->n * e->S, e->inverse->inverse, turned);
  memcpy(r, turned, (size_t)(e->n * e->S) * sizeof *r);
}
