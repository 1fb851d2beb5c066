/* Dense LU, with a condition estimate: of small matrices by own loops, else by LAPACK. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/dense.h"
#include "num/factor.h"
#include "num/simd/small_lu.h"

/* LAPACK's Fortran interface. Character arguments carry a hidden length that gfortran passes
 * last. */
extern void dgesv_(const int *n, const int *sides, double *a, const int *lda, int *pivot, double *b,
                   const int *ldb, int *info);
extern void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
extern void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a,
                    const int *lda, const int *ipiv, double *b, const int *ldb, int *info,
                    size_t trans_length);
extern void dgecon_(const char *norm, const int *n, const double *a, const int *lda,
                    const double *anorm, double *rcond, double *work, int *iwork, int *info,
                    size_t norm_length);

typedef struct dense {
  int is_small;
  dvi__small_lu small; /* the factor of a small matrix */
  double *lu;          /* [n*n] by columns; of a small matrix it is work */
  double *work;        /* [4 n] */
  int *pivot, *iwork;
  double norm; /* 1-norm of the matrix */
  double reciprocal_condition;
} dense;

/* Where the pivots of a small matrix differ by less than this, it is not nearly singular, and its
 * condition is not estimated. */
static const double safe_pivots = 1e-6;

static void dense_destroy(void *factor)
{
  dense *d = factor;
  if (d == NULL) return;
  dvi__release(d->small.upper);
  dvi__release(d->lu);
  dvi__release(d->work);
  dvi__release(d->pivot);
  dvi__release(d->iwork);
  dvi__release(d);
}

static int dense_allocate_small(dense *d, int n)
{
  const int stride = dvi__small_lu_stride(n);
  double *at = DVI_NEW(double, 2 * stride * stride + stride);
  if (at == NULL) return 0;
  d->small = (dvi__small_lu){.n = n,
                             .stride = stride,
                             .upper = at,
                             .lower = at + stride * stride,
                             .diagonal = at + 2 * stride * stride,
                             .pivot = d->pivot};
  return 1;
}

static dvi_status dense_create(const dvi__factor_form *form, void **factor)
{
  const size_t n = (size_t)form->pattern->columns;
  dense *d = *factor = DVI_NEW(dense, 1);
  if (d == NULL) return dvi__fail(DVI_NO_MEMORY, "dense LU: no memory");
  d->is_small = n <= DVI__SMALL_LU_MOST;
  d->lu = DVI_NEW(double, n *n);
  d->work = DVI_NEW(double, 4 * n);
  d->pivot = DVI_NEW(int, n);
  d->iwork = DVI_NEW(int, n);
  if (d->lu != NULL && d->work != NULL && d->pivot != NULL && d->iwork != NULL &&
      (!d->is_small || dense_allocate_small(d, (int)n)))
    return DVI_OK;
  dense_destroy(d);
  *factor = NULL;
  return dvi__fail(DVI_NO_MEMORY, "dense LU: no memory for %zu x %zu numbers", n, n);
}

/* Fill a square, whose columns have `stride` numbers, and note the 1-norm. */
static void dense_fill(dense *d, const dvi__pattern *pattern, const double *values, double *square,
                       size_t stride)
{
  double norm = 0;
  memset(square, 0, (size_t)pattern->columns * stride * sizeof(double));
  for (int j = 0; j < pattern->columns; j++) {
    double column = 0;
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      square[(size_t)j * stride + (size_t)pattern->row[e]] = values[e];
      column += fabs(values[e]);
    }
    norm = column > norm ? column : norm;
  }
  d->norm = norm;
}

/* Estimate the reciprocal condition of the factor in d->lu. */
static double dense_estimate(const dense *d, int n)
{
  double reciprocal_condition = 0;
  int status = 0;
  dgecon_("1", &n, d->lu, &n, &d->norm, &reciprocal_condition, d->work, d->iwork, &status, 1);
  return status == 0 ? reciprocal_condition : 0;
}

/* Estimate that of a small matrix by LAPACK, which has both factors in one square. */
static double dense_estimate_small(const dense *d)
{
  const int n = d->small.n, stride = d->small.stride;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      d->lu[j * n + i] = i == j ? d->small.diagonal[j]
                                : (i < j ? d->small.upper : d->small.lower)[j * stride + i];
  return dense_estimate(d, n);
}

static dvi_status dense_test_condition(int n, double reciprocal_condition)
{
  if (reciprocal_condition >= DVI__LEAST_RCOND) return DVI_OK;
  return dvi__fail(
      DVI_SINGULAR,
      "dense LU: the %d x %d matrix is singular to working precision (reciprocal condition %.1e)",
      n, n, reciprocal_condition);
}

static dvi_status dense_refactor_small(dense *d, const dvi__pattern *pattern, const double *values)
{
  dense_fill(d, pattern, values, d->small.upper, (size_t)d->small.stride);
  const double pivots = dvi__small_lu_factor(&d->small);
  if (pivots >= safe_pivots) return DVI_OK;
  return dense_test_condition(pattern->rows, pivots > 0 ? dense_estimate_small(d) : 0);
}

static dvi_status dense_refactor(void *factor, const dvi__pattern *pattern, const double *values)
{
  dense *d = factor;
  const int n = pattern->rows;
  int status = 0;
  if (d->is_small) return dense_refactor_small(d, pattern, values);
  dense_fill(d, pattern, values, d->lu, (size_t)n);
  dgetrf_(&n, &n, d->lu, &n, d->pivot, &status);
  d->reciprocal_condition = status == 0 ? dense_estimate(d, n) : 0;
  return dense_test_condition(n, d->reciprocal_condition);
}

static dvi_status dense_solve(void *factor, const dvi__pattern *pattern, double *b)
{
  const dense *d = factor;
  const int n = pattern->rows, one = 1;
  int status;
  if (d->is_small)
    dvi__small_lu_solve(&d->small, b);
  else
    dgetrs_("N", &n, &one, d->lu, &n, d->pivot, b, &n, &status, 1);
  return DVI_OK;
}

static double dense_condition(const void *factor)
{
  const dense *d = factor;
  return d->is_small ? dense_estimate_small(d) : d->reciprocal_condition;
}

/* LAPACK counts rows from 1. */
static int dense_sign(const void *factor, const dvi__pattern *pattern)
{
  const dense *d = factor;
  const int n = pattern->rows;
  int negative = 0;
  for (int i = 0; i < n; i++)
    negative ^= d->is_small
                    ? (d->pivot[i] != i) ^ (d->small.diagonal[i] < 0)
                    : (d->pivot[i] != i + 1) ^ (d->lu[(size_t)i * (size_t)n + (size_t)i] < 0);
  return negative ? -1 : 1;
}

static dvi__linear_cost dense_cost(const void *factor, const dvi__pattern *pattern)
{
  const double n = pattern->columns;
  (void)factor;
  return (dvi__linear_cost){n * n, 2 * n * n * n / 3};
}

const dvi__factor_kind dvi__dense_factor = {.name = "dense LU",
                                            .create = dense_create,
                                            .destroy = dense_destroy,
                                            .refactor = dense_refactor,
                                            .solve = dense_solve,
                                            .sign = dense_sign,
                                            .condition = dense_condition,
                                            .cost = dense_cost};

int dvi__dense_solve(int n, double *A, int *pivot, double *b)
{
  const int one = 1;
  int info;
  dgesv_(&n, &one, A, &n, pivot, b, &n, &info);
  return info == 0;
}
