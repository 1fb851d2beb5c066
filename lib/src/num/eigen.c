#include "num/eigen.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* LAPACK's Fortran interface. Character arguments carry a hidden length that gfortran passes
 * last. */
extern void dgeev_(const char *left, const char *right, const int *n, double *a, const int *lda,
                   double *wr, double *wi, double *vl, const int *ldvl, double *vr, const int *ldvr,
                   double *work, const int *lwork, int *info, size_t left_length,
                   size_t right_length);
extern void dsygv_(const int *type, const char *vectors, const char *triangle, const int *n,
                   double *a, const int *lda, double *b, const int *ldb, double *lambda,
                   double *work, const int *lwork, int *info, size_t vectors_length,
                   size_t triangle_length);
extern void dsyev_(const char *vectors, const char *triangle, const int *n, double *a,
                   const int *lda, double *lambda, double *work, const int *lwork, int *info,
                   size_t vectors_length, size_t triangle_length);
extern void dgesv_(const int *n, const int *sides, double *a, const int *lda, int *pivot, double *b,
                   const int *ldb, int *info);

extern void dpotrf_(const char *triangle, const int *n, double *a, const int *lda, int *info,
                    size_t triangle_length);

/* Find eigenvalues and vectors. LAPACK keeps Re and Im of a pair's vector in two columns.
 *
 *     T (x + iy) = (a + ib)(x + iy),   so that   T x = a x - b y,   T y = b x + a y. */
static int eigen_vectors(int n, double *copy, double *real_part, double *imaginary_part, double *X,
                         double *work)
{
  const int length = 8 * n, one = 1;
  int info = 0;
  dgeev_("N", "V", &n, copy, &n, real_part, imaginary_part, NULL, &one, X, &n, work, &length, &info,
         1, 1);
  return info;
}

static int invert_eigenvectors(int n, const double *X, double *copy, int *pivot, double *inverse)
{
  int info = 0;
  memcpy(copy, X, (size_t)n * (size_t)n * sizeof(double));
  for (int k = 0; k < n * n; k++) inverse[k] = k % (n + 1) == 0;
  dgesv_(&n, &n, copy, &n, pivot, inverse, &n, &info);
  return info;
}

dvi_status dvi__eigen(int n, const double *T, double *real_part, double *imaginary_part, double *X,
                      double *inverse)
{
  double *copy = dvi__duplicate(T, (size_t)n * (size_t)n, sizeof(double)),
         *work = DVI_NEW(double, 8 * (size_t)n);
  int *pivot = DVI_NEW(int, n);
  dvi_status status = DVI_OK;
  if (copy == NULL || work == NULL || pivot == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "eigenvalues: no memory for a matrix of %d columns", n);
  else if (eigen_vectors(n, copy, real_part, imaginary_part, X, work) != 0 ||
           invert_eigenvectors(n, X, copy, pivot, inverse) != 0)
    status = dvi__fail(DVI_SINGULAR,
                       "eigenvalues: a matrix of %d columns has no full set of eigenvectors", n);
  dvi__release(copy);
  dvi__release(work);
  dvi__release(pivot);
  return status;
}

static int is_finite(int n, const double *T, int lead)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      if (!isfinite(T[(size_t)j * (size_t)lead + (size_t)i])) return 0;
  return 1;
}

/* A pair's vector x + iy has its parts in two columns. */
static void take_last_components(int n, const double *X, const double *imaginary_part, double *last)
{
  for (int j = 0; j < n; j++) {
    const double *x = X + (size_t)j * (size_t)n;
    last[j] = fabs(x[n - 1]);
    if (imaginary_part[j] == 0 || j + 1 == n) continue;
    last[j] = last[j + 1] = hypot(x[n - 1], x[2 * n - 1]);
    j++;
  }
}

dvi_status dvi__eigenvalues(int n, double *T, int lead, double *real_part, double *imaginary_part,
                            double *last)
{
  const int one = 1, length = 40 * n;
  int info = 0;
  if (!is_finite(n, T, lead))
    return dvi__fail(DVI_NOT_FINITE, "eigenvalues: a matrix of %d columns is not finite", n);
  double *work = DVI_NEW(double, length);
  double *X = last != NULL ? DVI_NEW(double, (size_t)n *(size_t)n) : NULL;
  dvi_status status = DVI_OK;
  if (work == NULL || (last != NULL && X == NULL)) {
    status = dvi__fail(DVI_NO_MEMORY, "eigenvalues: no memory for a matrix of %d columns", n);
  } else {
    dgeev_("N", last != NULL ? "V" : "N", &n, T, &lead, real_part, imaginary_part, NULL, &one, X,
           X != NULL ? &n : &one, work, &length, &info, 1, 1);
    if (info != 0)
      status = dvi__fail(DVI_SINGULAR, "eigenvalues: those of %d columns do not converge", n);
    else if (last != NULL)
      take_last_components(n, X, imaginary_part, last);
  }
  dvi__release(work);
  dvi__release(X);
  return status;
}

dvi_status dvi__eigen_symmetric(int n, const double *K, const double *M, double *lambda, double *X)
{
  const size_t entries = (size_t)n * (size_t)n;
  const int type = 1, length = 8 * n;
  int info = 0;
  double *copy = dvi__duplicate(M, entries, sizeof(double)), *work = DVI_NEW(double, 8 * (size_t)n);
  dvi_status status = DVI_OK;
  if (copy == NULL || work == NULL) {
    status = dvi__fail(DVI_NO_MEMORY, "eigenvalues: no memory for a matrix of %d columns", n);
  } else {
    memcpy(X, K, entries * sizeof(double));
    dsygv_(&type, "V", "L", &n, X, &n, copy, &n, lambda, work, &length, &info, 1, 1);
    if (info != 0)
      status = dvi__fail(DVI_SINGULAR,
                         "eigenvalues: the mass of %d coordinates is not positive definite", n);
  }
  dvi__release(copy);
  dvi__release(work);
  return status;
}

int dvi__symmetric_eigenvalues(int n, double *A, double *lambda, double *work)
{
  const int length = 8 * n;
  int info = 0;
  dsyev_("N", "L", &n, A, &n, lambda, work, &length, &info, 1, 1);
  return info == 0;
}

int dvi__negative_ritz_values(int n, double *H, int lead, double next, double *work)
{
  const int one = 1, length = 4 * n;
  double *real = work, *imaginary = real + n, *vector = imaginary + n, *rest = vector + n * n;
  int info, count = 0;
  dgeev_("N", "V", &n, H, &lead, real, imaginary, NULL, &one, vector, &n, rest, &length, &info, 1,
         1);
  for (int k = 0; k < n && info == 0; k++)
    count += imaginary[k] == 0 && real[k] < 0 &&
             fabs(next * vector[k * n + n - 1]) <= 0.1 * fabs(real[k]);
  return count;
}

int dvi__is_positive_definite(int n, double *A)
{
  int info = 0;
  dpotrf_("L", &n, A, &n, &info, 1);
  return info == 0;
}
