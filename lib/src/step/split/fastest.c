#include "step/split/fastest.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/cholesky.h"

/* The power method uses 2^SQUARINGS powers. Eigenvalues that differ by less than a thousandth are
 * not resolved. */
enum { MOST = DVI__FASTEST_MOST, SQUARINGS = 12 };

struct dvi__fastest {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int count, coordinate[MOST];
  double *H_qq, *H_qv, *H_vv; /* [entries] */
};

/* ---- create ---- */

static dvi_status fastest_initialise(dvi__fastest *f, const char *fast, dvi_counters *counters)
{
  const dvi_system *system = f->system;
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__HESSIANS, counters, &f->evaluator));
  f->H_qq = DVI_NEW(double, dvi__pattern_entries(&system->qq));
  f->H_qv = DVI_NEW(double, dvi__pattern_entries(&system->qv));
  f->H_vv = DVI_NEW(double, dvi__pattern_entries(&system->vv));
  if (!f->H_qq || !f->H_qv || !f->H_vv) return dvi__fail(DVI_NO_MEMORY, "frequency: no memory");
  for (int i = 0; i < system->n; i++)
    if (fast[i]) f->coordinate[f->count++] = i;
  return DVI_OK;
}

dvi_status dvi__fastest_create(const dvi_system *system, const char *fast, dvi_counters *counters,
                               dvi__fastest **fastest)
{
  dvi__fastest *f = *fastest = DVI_NEW(dvi__fastest, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "frequency: no memory");
  f->system = system;
  const dvi_status status = fastest_initialise(f, fast, counters);
  if (status != DVI_OK) dvi__fastest_destroy(fastest);
  return status;
}

void dvi__fastest_destroy(dvi__fastest **fastest)
{
  dvi__fastest *f = *fastest;
  if (f == NULL) return;
  dvi__evaluator_destroy(&f->evaluator);
  dvi__release(f->H_qq);
  dvi__release(f->H_qv);
  dvi__release(f->H_vv);
  dvi__release(f);
  *fastest = NULL;
}

/* ---- frequency ---- */

/* Write the coordinates' part of a symmetric matrix, times a sign. */
static void fastest_gather(const dvi__fastest *f, const dvi__pattern *pattern, const double *values,
                           double sign, long double *part)
{
  for (int k = 0; k < f->count; k++)
    for (int l = 0; l < f->count; l++) {
      const int entry = dvi__pattern_find(pattern, f->coordinate[k], f->coordinate[l]);
      part[k * f->count + l] = entry < 0 ? 0 : (long double)(sign * values[entry]);
    }
}

static void fastest_transpose(int n, long double *A)
{
  for (int k = 0; k < n; k++)
    for (int l = 0; l < k; l++) {
      const long double above = A[l * n + k];
      A[l * n + k] = A[k * n + l];
      A[k * n + l] = above;
    }
}

/* Set K <- C^{-1} K C^{-T}. */
static void fastest_reduce(int n, const long double *C, long double *K)
{
  for (int side = 0; side < 2; side++) {
    for (int k = 0; k < n; k++) dvi__cholesky_half(n, C, K + k * n);
    fastest_transpose(n, K);
  }
}

static long double trace_of_product(int n, const long double *A, const long double *B)
{
  long double sum = 0;
  for (int k = 0; k < n * n; k++) sum += A[k] * B[k];
  return sum;
}

/* Set A <- A^2 over its trace, for a symmetric A. */
static void fastest_square(int n, long double *A)
{
  long double product[MOST * MOST];
  const long double trace = trace_of_product(n, A, A);
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++) {
      long double sum = 0;
      for (int m = 0; m < n; m++) sum += A[k * n + m] * A[m * n + l];
      product[k * n + l] = sum / trace;
    }
  memcpy(A, product, (size_t)(n * n) * sizeof *A);
}

/* Return the eigenvalue of the largest magnitude. A high power of K is, up to its scale, the
 * projection on the eigenvectors. */
static double largest_eigenvalue(int n, const long double *K)
{
  long double power[MOST * MOST], trace = 0;
  memcpy(power, K, (size_t)(n * n) * sizeof *K);
  for (int k = 0; k < SQUARINGS; k++) fastest_square(n, power);
  for (int k = 0; k < n; k++) trace += power[k * n + k];
  return (double)(trace_of_product(n, K, power) / trace);
}

dvi_status dvi__fastest_frequency(dvi__fastest *f, double t, const double *q, const double *v,
                                  double *omega)
{
  long double K[MOST * MOST] = {0}, M[MOST * MOST] = {0};
  DVI_TRY(dvi__lagrangian_hessian(f->evaluator, 1, &t, q, v, f->H_qq, f->H_qv, f->H_vv));
  fastest_gather(f, &f->system->qq, f->H_qq, -1, K);
  fastest_gather(f, &f->system->vv, f->H_vv, 1, M);
  dvi__cholesky(f->count, M);
  fastest_reduce(f->count, M, K);
  const double square_of_it = largest_eigenvalue(f->count, K);
  if (!(square_of_it > 0) || !isfinite(square_of_it))
    return dvi__fail(DVI_BAD_STATE,
                     "the fast coordinates do not oscillate about this state; give omega");
  *omega = sqrt(square_of_it);
  return DVI_OK;
}
