/* Derivatives of the transformed Lagrangian. With v = w/g and the energy E = L_v.v - L, all of L at
 * (q,v),
 *
 *     Lg_q  = g L_q + (E0 - E) g_q            Lg_w = L_v
 *     Lg_qq = g L_qq + d g_q^T + g_q d^T + (v.L_vv v)/g g_q g_q^T + (E0 - E) g_qq,
 *             d = L_q - L_qv v
 *     Lg_qw = L_qv - g_q (L_vv v)^T/g         Lg_ww = L_vv/g
 *
 * On the exact orbit E = E0. At a step's nodes E - E0 is the error of the method. */
#include <string.h>

#include "system/rescale/transformed_struct.h"
#include "core/status.h"
#include "num/finite.h"

/* Add A x to y at every point, with A of a pattern. */
static void add_pattern_product(const dvi__pattern *pattern, size_t points, const double *A,
                                const double *x, double *y)
{
  for (size_t j = 0; j < (size_t)pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      for (size_t k = 0; k < points; k++)
        y[(size_t)pattern->row[e] * points + k] += A[(size_t)e * points + k] * x[j * points + k];
}

/* Compute d, Mv and vMv. */
static void products_with_velocity(const dvi__transformed *x, size_t points)
{
  const dvi__transformed_work *at = &x->work;
  const size_t n = (size_t)x->base->n;
  memset(at->d, 0, n * points * sizeof(double));
  memset(at->Mv, 0, n * points * sizeof(double));
  memset(at->vMv, 0, points * sizeof(double));
  add_pattern_product(&x->base->qv, points, at->base_qv, at->v, at->d);
  add_pattern_product(&x->base->vv, points, at->base_vv, at->v, at->Mv);
  for (size_t i = 0; i < n; i++)
    for (size_t k = i * points; k < (i + 1) * points; k++) {
      at->d[k] = at->L_q[k] - at->d[k];
      at->vMv[k - i * points] += at->v[k] * at->Mv[k];
    }
}

/* Compute all terms but g_qq. */
static dvi_status transformed_second_order(dvi__transformed *x, int count, const double *t,
                                           const double *q, const double *w)
{
  const dvi__transformed_work *at = &x->work;
  DVI_TRY(dvi__transformed_first_order(x, count, t, q, w));
  DVI_TRY(dvi__lagrangian_hessian(x->evaluator, count, t, q, at->v, at->base_qq, at->base_qv,
                                  at->base_vv));
  products_with_velocity(x, (size_t)count);
  return DVI_OK;
}

/* Compute the parts of L_qq and L_qw that come from g's derivatives, in all entries. */
static void fill_full(const dvi__transformed_work *at, size_t n, size_t points, double *L_qq,
                      double *L_qw)
{
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < points; k++) {
        const size_t e = (j * n + i) * points + k, row = i * points + k, column = j * points + k;
        const double g_i = at->g_q[row], g_j = at->g_q[column], g = at->g[k];
        L_qq[e] = at->d[row] * g_j + g_i * at->d[column] + at->vMv[k] / g * g_i * g_j +
                  at->lag[k] * at->g_qq[e];
        L_qw[e] = -g_i * at->Mv[column] / g;
      }
}

/* Add the system's own blocks where their patterns have entries, multiplied by `by` unless it is
 * NULL. */
static void add_base_block(const dvi__pattern *pattern, size_t n, size_t points, const double *A,
                           const double *by, double *full)
{
  for (size_t j = 0; j < n; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      for (size_t k = 0; k < points; k++)
        full[(j * n + (size_t)pattern->row[e]) * points + k] += (by != NULL ? by[k] : 1) *
                                                                A[(size_t)e * points + k];
}

/* Divide L_vv by g. */
static void divide_by_rate(const dvi__transformed *x, size_t points, double *L_ww)
{
  const dvi__transformed_work *at = &x->work;
  for (size_t e = 0; e < (size_t)dvi__pattern_entries(&x->base->vv); e++)
    for (size_t k = 0; k < points; k++)
      L_ww[e * points + k] = at->base_vv[e * points + k] / at->g[k];
}

/* Compute L_ww alone. It needs no Hessian of g, and with a constant mass none of L. */
static dvi_status velocity_hessian(dvi__transformed *x, int count, const double *t, const double *q,
                                   const double *w, double *L_ww)
{
  const dvi__transformed_work *at = &x->work;
  const size_t points = (size_t)count, vv = (size_t)dvi__pattern_entries(&x->base->vv);
  const int general = x->base->lagrangian != NULL;
  DVI_TRY(dvi__transformed_velocities(x, count, q, w));
  DVI_TRY(dvi__lagrangian_hessian(x->evaluator, count, t, q, at->v, general ? at->base_qq : NULL,
                                  general ? at->base_qv : NULL, at->base_vv));
  divide_by_rate(x, points, L_ww);
  return dvi__first_not_finite(vv * points, L_ww) < 0
             ? DVI_OK
             : dvi__fail(DVI_NOT_FINITE, "time transform: the Hessian is not finite");
}

dvi_status dvi__transformed_hessian(void *of, int count, const double *t, const double *q,
                                    const double *w, double *L_qq, double *L_qw, double *L_ww)
{
  dvi__transformed *x = of;
  const dvi__transformed_work *at = &x->work;
  const size_t n = (size_t)x->base->n, points = (size_t)count,
               vv = (size_t)dvi__pattern_entries(&x->base->vv);
  x->counters->hessians -= count;
  if (L_qq == NULL) return velocity_hessian(x, count, t, q, w, L_ww);
  DVI_TRY(transformed_second_order(x, count, t, q, w));
  DVI_TRY(dvi__monitor_hessian(x->monitor, count, q, at->g_qq));
  fill_full(at, n, points, L_qq, L_qw);
  add_base_block(&x->base->qq, n, points, at->base_qq, at->g, L_qq);
  add_base_block(&x->base->qv, n, points, at->base_qv, NULL, L_qw);
  divide_by_rate(x, points, L_ww);
  if (dvi__first_not_finite(n * n * points, L_qq) < 0 &&
      dvi__first_not_finite(n * n * points, L_qw) < 0 &&
      dvi__first_not_finite(vv * points, L_ww) < 0)
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "time transform: the Hessian is not finite");
}

dvi_status dvi__transformed_curvature(dvi__transformed *x, double t, const double *q,
                                      const double *w, dvi__curvature *at)
{
  const dvi__transformed_work *of = &x->work;
  DVI_TRY(transformed_second_order(x, 1, &t, q, w));
  *at = (dvi__curvature){*of->g, *of->vMv,    of->g_q,     of->d,
                         of->Mv, of->base_qq, of->base_qv, of->base_vv};
  return DVI_OK;
}
