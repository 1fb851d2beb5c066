#include "step/onestep/flow_series.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/linear.h"

struct dvi__flow_series {
  const dvi_system *system;
  int n, degree;
  dvi__jet *jet;
  dvi__linear *kinetic; /* factors of L_vv, NULL for a diagonal mass */
  double *t;            /* [degree+1] */
  double *q, *v;        /* [(degree+1)*n], [degree*n] */
  double *L_q, *L_v;    /* [degree*n] */
  double *L_vv; /* values at the start, or, with Hessians, along the motion as the other two */
  double *L_qq, *L_qv;
  double *dq, *dv; /* [(degree+1)*2n*n], [degree*2n*n] */
};

/* ---- create ---- */

static int flow_series_allocate(dvi__flow_series *f, int hessians)
{
  const size_t n = (size_t)f->n, degree = (size_t)f->degree, coefficients = hessians ? degree : 1;
  f->t = DVI_NEW(double, degree + 1);
  f->q = DVI_NEW(double, (degree + 1) * n);
  f->v = DVI_NEW(double, (degree * n));
  f->L_q = DVI_NEW(double, (degree * n));
  f->L_v = DVI_NEW(double, (degree * n));
  f->L_vv = DVI_NEW(double, coefficients *(size_t)dvi__pattern_entries(&f->system->vv));
  if (!f->t || !f->q || !f->v || !f->L_q || !f->L_v || !f->L_vv) return 0;
  if (!hessians) return 1;
  f->L_qq = DVI_NEW(double, degree *(size_t)dvi__pattern_entries(&f->system->qq));
  f->L_qv = DVI_NEW(double, degree *(size_t)dvi__pattern_entries(&f->system->qv));
  f->dq = DVI_NEW(double, (degree + 1) * 2 * n * n);
  f->dv = DVI_NEW(double, degree * 2 * n * n);
  return f->L_qq && f->L_qv && f->dq && f->dv;
}

static dvi_status flow_series_initialise(dvi__flow_series *f, dvi__derivatives most,
                                         dvi_counters *counters)
{
  const dvi_system *s = f->system;
  DVI_TRY(dvi__jet_create(s, f->degree - 1, most, counters, &f->jet));
  if (!flow_series_allocate(f, most == DVI__HESSIANS))
    return dvi__fail(DVI_NO_MEMORY,
                     "series of the motion: no memory for degree %d in %d dimensions", f->degree,
                     f->n);
  if (s->mass_diagonal != NULL) return DVI_OK;
  if (s->mass_factor != NULL) return dvi__linear_share(s->mass_factor, counters, &f->kinetic);
  DVI_TRY(dvi__linear_create(&s->vv, DVI__LINEAR_AUTO, counters, &f->kinetic));
  return s->mass_values != NULL ? dvi__linear_factor(f->kinetic, s->mass_values) : DVI_OK;
}

dvi_status dvi__flow_series_create(const dvi_system *system, int degree, dvi__derivatives most,
                                   dvi_counters *counters, dvi__flow_series **series)
{
  *series = NULL;
  dvi__flow_series *f = DVI_NEW(dvi__flow_series, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "series of the motion: no memory");
  f->system = system;
  f->n = system->n;
  f->degree = degree;
  const dvi_status status = flow_series_initialise(f, most, counters);
  if (status != DVI_OK) dvi__flow_series_destroy(&f);
  *series = f;
  return status;
}

void dvi__flow_series_destroy(dvi__flow_series **series)
{
  dvi__flow_series *f = *series;
  if (f == NULL) return;
  double *const owned[] = {f->t,    f->q,    f->v,    f->L_q, f->L_v,
                           f->L_vv, f->L_qq, f->L_qv, f->dq,  f->dv};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__jet_destroy(&f->jet);
  dvi__linear_destroy(&f->kinetic);
  dvi__release(f);
  *series = NULL;
}

const double *dvi__flow_series_q(const dvi__flow_series *f)
{
  return f->q;
}

const double *dvi__flow_series_v(const dvi__flow_series *f)
{
  return f->v;
}

const double *dvi__flow_series_dq(const dvi__flow_series *f)
{
  return f->dq;
}

const double *dvi__flow_series_dv(const dvi__flow_series *f)
{
  return f->dv;
}

/* ---- the motion ---- */

/* Set x <- L_vv^-1 x at the start. */
static void solve_kinetic(dvi__flow_series *f, double *x)
{
  if (f->kinetic != NULL) {
    dvi__linear_solve(f->kinetic, x);
    return;
  }
  for (int i = 0; i < f->n; i++) x[i] /= f->system->mass_diagonal[i];
}

/* Factor L_vv. A constant mass is factored already. */
static dvi_status factor_kinetic(dvi__flow_series *f)
{
  if (f->system->lagrangian == NULL) return DVI_OK;
  DVI_TRY(dvi__jet_along(f->jet, 0, f->t, f->q, f->v, &(dvi__jets){.L_vv = f->L_vv}));
  return dvi__linear_factor(f->kinetic, f->L_vv);
}

/* Evaluate [L_q]_k, and [L_v]_{k+1} without its part of v_{k+1}. For a constant mass this is 0, and
 * q_{k+1} is known, which gives [L_q]_{k+1}, too. */
static dvi_status evaluate_forces(dvi__flow_series *f, int k)
{
  const size_t n = (size_t)f->n;
  const int general = f->system->lagrangian != NULL,
            degree = general || k + 3 <= f->degree ? k + 1 : k;
  memset(f->v + (size_t)(k + 1) * n, 0, n * sizeof(double));
  return dvi__jet_along(f->jet, degree, f->t, f->q, f->v,
                        &(dvi__jets){.L_q = f->L_q, .L_v = general ? f->L_v : NULL});
}

/* Compute v_{k+1} and q_{k+2}. */
static dvi_status next_coefficient(dvi__flow_series *f, int k)
{
  const size_t n = (size_t)f->n;
  const int general = f->system->lagrangian != NULL;
  double *v = f->v + (size_t)(k + 1) * n, *q = f->q + (size_t)(k + 2) * n;
  if (general || k % 2 == 0) DVI_TRY(evaluate_forces(f, k));
  for (size_t i = 0; i < n; i++)
    v[i] = f->L_q[(size_t)k * n + i] / (k + 1) - (general ? f->L_v[(size_t)(k + 1) * n + i] : 0);
  solve_kinetic(f, v);
  for (size_t i = 0; i < n; i++) q[i] = v[i] / (k + 2);
  return DVI_OK;
}

dvi_status dvi__flow_series_expand(dvi__flow_series *f, double t, const double *q, const double *v)
{
  const size_t n = (size_t)f->n;
  f->t[0] = t;
  f->t[1] = 1; /* create has set the other coefficients of t to 0 */
  memcpy(f->q, q, n * sizeof *q);
  memcpy(f->q + n, v, n * sizeof *v);
  memcpy(f->v, v, n * sizeof *v);
  DVI_TRY(factor_kinetic(f));
  for (int k = 0; k + 2 <= f->degree; k++) DVI_TRY(next_coefficient(f, k));
  if (dvi__first_not_finite((size_t)(f->degree + 1) * n, f->q) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the Taylor coefficients of the motion at t = %g are not finite",
                   t);
}

/* ---- derivative of the motion ---- */

/* Add factor A x, or factor A^T x, to y. */
static void multiply_add(const dvi__pattern *pattern, const double *A, int transposed,
                         double factor, const double *x, double *y)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      const int i = pattern->row[e];
      if (transposed)
        y[j] += factor * A[e] * x[i];
      else
        y[i] += factor * A[e] * x[j];
    }
}

/* Add factor [A x]_k to y, the coefficient of a product of series. The coefficients of A stand in
 * the pattern's order and start from `first`. Those of x stand at a distance of `stride`. */
static void flow_series_convolve(const dvi__pattern *pattern, const double *A, int transposed,
                                 int first, int k, double factor, const double *x, size_t stride,
                                 double *y)
{
  const size_t entries = (size_t)dvi__pattern_entries(pattern);
  for (int j = first; j <= k; j++)
    multiply_add(pattern, A + (size_t)j * entries, transposed, factor, x + (size_t)(k - j) * stride,
                 y);
}

/* Compute dv_{k+1} and dq_{k+2} of one column from dq_0 .. dq_{k+1} and dv_0 .. dv_k. */
static void next_variation(dvi__flow_series *f, int k, double *dq, double *dv)
{
  const dvi_system *s = f->system;
  const size_t n = (size_t)f->n, stride = 2 * n * n;
  double *next = dv + (size_t)(k + 1) * stride;
  memset(next, 0, n * sizeof *next);
  flow_series_convolve(&s->qq, f->L_qq, 0, 0, k, 1.0 / (k + 1), dq, stride, next);
  flow_series_convolve(&s->qv, f->L_qv, 0, 0, k, 1.0 / (k + 1), dv, stride, next);
  flow_series_convolve(&s->qv, f->L_qv, 1, 0, k + 1, -1, dq, stride, next);
  if (s->lagrangian != NULL)
    flow_series_convolve(&s->vv, f->L_vv, 0, 1, k + 1, -1, dv, stride, next);
  solve_kinetic(f, next);
  for (size_t i = 0; i < n; i++) dq[(size_t)(k + 2) * stride + i] = next[i] / (k + 2);
}

dvi_status dvi__flow_series_vary(dvi__flow_series *f)
{
  const size_t n = (size_t)f->n, stride = 2 * n * n;
  DVI_TRY(dvi__jet_along(f->jet, f->degree - 1, f->t, f->q, f->v,
                         &(dvi__jets){.L_qq = f->L_qq, .L_qv = f->L_qv, .L_vv = f->L_vv}));
  memset(f->dq, 0, 2 * stride * sizeof(double));
  memset(f->dv, 0, stride * sizeof(double));
  for (size_t i = 0; i < n; i++)
    f->dq[i * n + i] = f->dq[stride + (n + i) * n + i] = f->dv[(n + i) * n + i] = 1;
  for (size_t column = 0; column < 2 * n; column++)
    for (int k = 0; k + 2 <= f->degree; k++)
      next_variation(f, k, f->dq + column * n, f->dv + column * n);
  if (dvi__first_not_finite((size_t)(f->degree + 1) * stride, f->dq) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE,
                   "the derivatives of the motion's Taylor coefficients at t = %g are not finite",
                   f->t[0]);
}

/* ---- L along the motion ---- */

/* Return [L_q dq + L_v dv]_k of one column. */
static double variation_of_L(const dvi__flow_series *f, int k, const double *dq, const double *dv)
{
  const size_t n = (size_t)f->n, stride = 2 * n * n;
  double sum = 0;
  for (size_t j = 0; j <= (size_t)k; j++)
    for (size_t i = 0; i < n; i++)
      sum += f->L_q[j * n + i] * dq[((size_t)k - j) * stride + i] +
             f->L_v[j * n + i] * dv[((size_t)k - j) * stride + i];
  return sum;
}

dvi_status dvi__flow_series_lagrangian(dvi__flow_series *f, double *L, double *L_q0, double *L_v0)
{
  const size_t n = (size_t)f->n;
  const int wanted = L_q0 != NULL;
  DVI_TRY(dvi__jet_along(
      f->jet, f->degree - 1, f->t, f->q, f->v,
      &(dvi__jets){.L = L, .L_q = wanted ? f->L_q : NULL, .L_v = wanted ? f->L_v : NULL}));
  for (int k = 0; wanted && k < f->degree; k++)
    for (size_t i = 0; i < n; i++) {
      L_q0[(size_t)k * n + i] = variation_of_L(f, k, f->dq + i * n, f->dv + i * n);
      L_v0[(size_t)k * n + i] = variation_of_L(f, k, f->dq + (n + i) * n, f->dv + (n + i) * n);
    }
  return DVI_OK;
}
