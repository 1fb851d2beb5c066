#include "step/element/two_point.h"

#include <math.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "space/legendre.h"

/* Evaluate beta_m(tau), m = 1..degree-1. The integral of P_m is (P_(m+1) - P_(m-1)) / (2
 * (2m+1)). */
static void bubbles_at(int degree, double tau, double *beta)
{
  long double value[DVI_DEGREE_MAX + 1], difference[DVI_DEGREE_MAX + 1];
  dvi__legendre(degree, 1 - (long double)tau, value, difference);
  for (int m = 1; m < degree; m++)
    beta[m - 1] = (double)((difference[m + 1] + difference[m]) / (2 * (2 * m + 1)));
}

/* Expand the bubbles in reduced trial functions, beta_m = sum_k psi_k bubble[m-1][k], fitted as any
 * path is. */
static void fill_bubbles(dvi__action *a)
{
  double at_point[DVI_DEGREE_MAX][DVI_DEGREE_MAX];
  const size_t s = (size_t)a->s;
  for (size_t l = 0; l < s; l++) bubbles_at(a->s, a->fit_point[l], at_point[l]);
  for (size_t m = 0; m + 1 < s; m++)
    for (size_t k = 0; k < s; k++)
      for (size_t l = 0; l < s; l++)
        a->two_point.bubble[m * s + k] += a->fit[k * s + l] * at_point[l][m];
}

/* Evaluate chi_a and chi_a' at the nodes, from the same rounded tables as the rows. */
static void fill_ends(dvi__action *a)
{
  const int s = a->s;
  for (int j = 0; j < a->r; j++)
    for (int c = 0; c <= s; c++) {
      const double *in_psi = c < 2 ? a->straight : a->two_point.bubble + (c - 2) * s;
      double *chi = a->two_point.chi + c * a->lanes + j,
             *dchi = a->two_point.dchi + c * a->lanes + j;
      for (int k = 0; k < s; k++) {
        *chi += in_psi[k] * a->psi[k * a->lanes + j];
        *dchi += in_psi[k] * a->dpsi[k * a->lanes + j];
      }
      if (c == 0) *chi = 1 - *chi, *dchi = -*dchi;
    }
}

dvi_status dvi__action_prepare_two_point(dvi__action *a)
{
  const size_t s = (size_t)a->s, table = (s + 1) * (size_t)a->lanes;
  a->two_point.bubble = DVI_NEW(double, s *(s - 1));
  a->two_point.chi = DVI_NEW(double, table);
  a->two_point.dchi = DVI_NEW(double, table);
  a->two_point.dp = DVI_NEW(double, a->n);
  a->two_point.rows = DVI_NEW(double, (size_t)a->n *s);
  if (!a->two_point.bubble || !a->two_point.chi || !a->two_point.dchi || !a->two_point.dp ||
      !a->two_point.rows)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for paths between ends");
  fill_bubbles(a);
  fill_ends(a);
  return DVI_OK;
}

void dvi__action_clear_two_point(const dvi__action *a)
{
  dvi__release(a->two_point.bubble);
  dvi__release(a->two_point.chi);
  dvi__release(a->two_point.dchi);
  dvi__release(a->two_point.rows);
  dvi__release(a->two_point.dp);
}

void dvi__action_two_point(const dvi__action *a, const double *q1, const double *Z, double *Y)
{
  const size_t s = (size_t)a->s;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t k = 0; k < s; k++) {
      double sum = a->straight[k] * (q1[i] - a->q0[i]);
      for (size_t m = 0; m + 1 < s; m++) sum += a->two_point.bubble[m * s + k] * Z[i * (s - 1) + m];
      Y[i * s + k] = sum;
    }
}

void dvi__action_two_point_ends(const dvi__action *a, const double *by_Y, const double *by_q0,
                                double *in_q0, double *in_q1, double *in_Z)
{
  const size_t s = (size_t)a->s;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    const double *in_Y = by_Y + i * s;
    in_q1[i] = 0;
    for (size_t k = 0; k < s; k++) in_q1[i] += a->straight[k] * in_Y[k];
    in_q0[i] = by_q0[i] - in_q1[i];
    for (size_t m = 0; m + 1 < s; m++) {
      double *sum = &in_Z[i * (s - 1) + m];
      *sum = 0;
      for (size_t k = 0; k < s; k++) *sum += a->two_point.bubble[m * s + k] * in_Y[k];
    }
  }
}

/* The derivatives by Y with q0 fixed are the rows R and psi(1) dp, which the elimination of p1 has
 * taken from them. */
dvi_status dvi__action_two_point_gradient(dvi__action *a, const double *Y, double *in_q0,
                                          double *in_q1, double *in_Z)
{
  DVI_TRY(dvi__action_residual(a, Y, a->two_point.rows));
  for (size_t i = 0, r = (size_t)a->r, s = (size_t)a->s; i < (size_t)a->n; i++) {
    double sum = 0;
    for (size_t j = i * r; j < (i + 1) * r; j++) sum += a->L_q[j];
    a->two_point.dp[i] = a->h * sum;
    for (size_t k = 0; k < s; k++) a->two_point.rows[i * s + k] += a->end[k] * a->two_point.dp[i];
  }
  dvi__action_two_point_ends(a, a->two_point.rows, a->two_point.dp, in_q0, in_q1, in_Z);
  return DVI_OK;
}

void dvi__action_two_point_rows(const dvi__action *a, const double *f, const double *g,
                                double *rows)
{
  const size_t r = (size_t)a->r, n = (size_t)a->n;
  for (size_t c = 0; c <= (size_t)a->s; c++) {
    const double *chi = a->two_point.chi + c * (size_t)a->lanes,
                 *dchi = a->two_point.dchi + c * (size_t)a->lanes;
    for (size_t i = 0; i < n; i++) {
      double sum = 0;
      for (size_t j = 0; j < r; j++)
        sum += a->weight[j] * (a->h * chi[j] * f[i * r + j] + dchi[j] * g[i * r + j]);
      rows[c * n + i] = sum;
    }
  }
}

dvi__path_points dvi__action_two_point_points(const dvi__action *a, const double *Y)
{
  dvi__action_stages(a, Y);
  return (dvi__path_points){a->r, a->t, a->Q, a->V, a->weight};
}

/* Set column[c] to
 *
 *     sum_j b_j [ chi_c (h L_qq chi_b + L_qv chi_b') + chi_c' (L_vq chi_b + L_vv chi_b'/h) ] */
static void two_point_block_column(const dvi__action *a, const dvi__joint_entry *block, int b,
                                   double *column)
{
  const int r = a->r;
  const double *chi = a->two_point.chi + b * a->lanes, *dchi = a->two_point.dchi + b * a->lanes;
  double *in_q = a->line, *in_v = a->line + r;
  dvi__action_weigh_hessian(a, block, chi, dchi, in_q, in_v);
  for (int c = 0; c <= a->s; c++) {
    const double *value = a->two_point.chi + c * a->lanes,
                 *slope = a->two_point.dchi + c * a->lanes;
    double sum = 0;
    for (int j = 0; j < r; j++) sum += value[j] * in_q[j] + slope[j] * in_v[j];
    column[c] = sum;
  }
}

dvi_status dvi__action_two_point_hessian(dvi__action *a, const double *Y, double *values)
{
  DVI_TRY(dvi__action_hessians(a, Y));
  const int size = a->s + 1;
  for (int e = 0; e < dvi__pattern_entries(&a->joint); e++)
    for (int b = 0; b < size; b++)
      two_point_block_column(a, &a->block[e], b,
                             values + ((size_t)e * (size_t)size + (size_t)b) * (size_t)size);
  return DVI_OK;
}

dvi_status dvi__action_value(dvi__action *a, const double *Y, double *S, double *seen)
{
  dvi__action_stages(a, Y);
  DVI_TRY(dvi__lagrangian_value(a->evaluator, a->r, a->t, a->Q, a->V, a->line));
  *S = *seen = 0;
  for (int j = 0; j < a->r; j++) {
    *S += a->h * (a->weight[j] * a->line[j]);
    *seen = fmax(*seen, fabs(a->line[j]));
  }
  return DVI_OK;
}

dvi_status dvi__action_unseen(dvi__action *a, const double *Y, double *unseen)
{
  double *q = a->two_point.dp, *v = a->two_point.rows, L;
  *unseen = 0;
  for (int half = 0; half <= 2; half++) {
    const double tau = 0.5 * half, t = a->t0 + tau * a->h;
    dvi__action_path(a, Y, a->h, tau, q, v);
    for (int i = 0; i < a->n; i++) q[i] += a->q0[i];
    DVI_TRY(dvi__lagrangian_value(a->evaluator, 1, &t, q, v, &L));
    *unseen = fmax(*unseen, fabs(L));
  }
  return DVI_OK;
}
