/* Dense LU by LAPACK, with a condition estimate. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/dense.h"
#include "num/factor.h"

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
  double *lu;   /* [n*n] by columns */
  double *work; /* [4 n] */
  int *pivot, *iwork;
  double reciprocal_condition;
} dense;

static void dense_destroy(void *factor)
{
  dense *d = factor;
  if (d == NULL) return;
  dvi__release(d->lu);
  dvi__release(d->work);
  dvi__release(d->pivot);
  dvi__release(d->iwork);
  dvi__release(d);
}

static dvi_status dense_create(const dvi__factor_form *form, void **factor)
{
  const size_t n = (size_t)form->pattern->columns;
  dense *d = *factor = DVI_NEW(dense, 1);
  if (d == NULL) return dvi__fail(DVI_NO_MEMORY, "dense LU: no memory");
  d->lu = DVI_NEW(double, n *n);
  d->work = DVI_NEW(double, 4 * n);
  d->pivot = DVI_NEW(int, n);
  d->iwork = DVI_NEW(int, n);
  if (d->lu != NULL && d->work != NULL && d->pivot != NULL && d->iwork != NULL) return DVI_OK;
  dense_destroy(d);
  *factor = NULL;
  return dvi__fail(DVI_NO_MEMORY, "dense LU: no memory for %zu x %zu numbers", n, n);
}

/* Fill the square and return its 1-norm. */
static double dense_fill(dense *d, const dvi__pattern *pattern, const double *values)
{
  const size_t n = (size_t)pattern->rows;
  double norm = 0;
  memset(d->lu, 0, n * n * sizeof(double));
  for (int j = 0; j < pattern->columns; j++) {
    double column = 0;
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      d->lu[(size_t)j * n + (size_t)pattern->row[e]] = values[e];
      column += fabs(values[e]);
    }
    norm = fmax(norm, column);
  }
  return norm;
}

static dvi_status dense_refactor(void *factor, const dvi__pattern *pattern, const double *values)
{
  dense *d = factor;
  const int n = pattern->rows;
  int status = 0;
  double reciprocal_condition = 0;
  const double norm = dense_fill(d, pattern, values);
  dgetrf_(&n, &n, d->lu, &n, d->pivot, &status);
  if (status == 0)
    dgecon_("1", &n, d->lu, &n, &norm, &reciprocal_condition, d->work, d->iwork, &status, 1);
  d->reciprocal_condition = reciprocal_condition;
  if (status == 0 && reciprocal_condition >= DVI__LEAST_RCOND) return DVI_OK;
  return dvi__fail(
      DVI_SINGULAR,
      "dense LU: the %d x %d matrix is singular to working precision (reciprocal condition %.1e)",
      n, n, reciprocal_condition);
}

static dvi_status dense_solve(void *factor, const dvi__pattern *pattern, double *b)
{
  const dense *d = factor;
  const int n = pattern->rows, one = 1;
  int status;
  dgetrs_("N", &n, &one, d->lu, &n, d->pivot, b, &n, &status, 1);
  return DVI_OK;
}

static double dense_condition(const void *factor)
{
  return ((const dense *)factor)->reciprocal_condition;
}

static int dense_sign(const void *factor, const dvi__pattern *pattern)
{
  const dense *d = factor;
  const int n = pattern->rows;
  int negative = 0;
  for (int i = 0; i < n; i++)
    negative ^= (d->pivot[i] != i + 1) ^ (d->lu[(size_t)i * (size_t)n + (size_t)i] < 0);
  return negative ? -1 : 1;
}

static dvi__linear_cost dense_cost(const void *factor, const dvi__pattern *pattern)
{
  const double n = pattern->columns;
  (void)factor;
  return (dvi__linear_cost){n * n, 2 * n * n * n / 3};
}

const dvi__factor_kind dvi__dense_factor = {.name = "dense LU (LAPACK)",
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
