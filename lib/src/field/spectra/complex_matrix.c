#include "field/spectra/complex_matrix.h"

#include <stddef.h>

#include "core/memory.h"
#include "core/status.h"

/* LAPACK's Fortran interface. Character arguments carry a hidden length that gfortran passes
 * last. */
extern void zgeqrf_(const int *m, const int *n, double complex *a, const int *lda,
                    double complex *tau, double complex *work, const int *lwork, int *info);
extern void zunmqr_(const char *side, const char *trans, const int *m, const int *n, const int *k,
                    const double complex *a, const int *lda, const double complex *tau,
                    double complex *c, const int *ldc, double complex *work, const int *lwork,
                    int *info, size_t side_length, size_t trans_length);
extern void ztrtrs_(const char *triangle, const char *trans, const char *diagonal, const int *n,
                    const int *nrhs, const double complex *a, const int *lda, double complex *b,
                    const int *ldb, int *info, size_t triangle_length, size_t trans_length,
                    size_t diagonal_length);
extern void zgesvd_(const char *left, const char *right, const int *m, const int *n,
                    double complex *a, const int *lda, double *s, double complex *u, const int *ldu,
                    double complex *vt, const int *ldvt, double complex *work, const int *lwork,
                    double *rwork, int *info, size_t left_length, size_t right_length);
extern void zgeev_(const char *left, const char *right, const int *n, double complex *a,
                   const int *lda, double complex *w, double complex *vl, const int *ldvl,
                   double complex *vr, const int *ldvr, double complex *work, const int *lwork,
                   double *rwork, int *info, size_t left_length, size_t right_length);
extern void zheev_(const char *vectors, const char *triangle, const int *n, double complex *a,
                   const int *lda, double *w, double complex *work, const int *lwork, double *rwork,
                   int *info, size_t vectors_length, size_t triangle_length);

enum { BLOCK = 64 };

void dvi__complex_qr(int rows, int columns, double complex *A, double complex *factor,
                     double complex *work)
{
  const int length = BLOCK * columns;
  int info;
  zgeqrf_(&rows, &columns, A, &rows, factor, work, &length, &info);
}

void dvi__complex_reflect(int rows, int columns, const double complex *A,
                          const double complex *factor, int sides, double complex *B,
                          double complex *work)
{
  const int length = BLOCK * sides;
  int info;
  zunmqr_("L", "C", &rows, &sides, &columns, A, &rows, factor, B, &rows, work, &length, &info, 1,
          1);
}

int dvi__complex_back(int rows, int columns, const double complex *A, int lead, int sides,
                      double complex *B)
{
  int info;
  ztrtrs_("U", "N", "N", &columns, &sides, A, &rows, B, &lead, &info, 1, 1, 1);
  return info == 0;
}

/* ---- decompositions ---- */

/* The work space of a decomposition, complex and real. */
typedef struct workspace {
  double complex *room;
  double *real;
  int length;
} workspace;

static dvi_status workspace_create(int n, workspace *work)
{
  work->length = BLOCK * n;
  work->room = DVI_NEW(double complex, work->length);
  work->real = DVI_NEW(double, 5 * (size_t)n);
  if (work->room != NULL && work->real != NULL) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "complex matrix: no memory for %d columns", n);
}

static dvi_status workspace_end(workspace *work, dvi_status status, int info, int n,
                                const char *what)
{
  dvi__release(work->room);
  dvi__release(work->real);
  if (status != DVI_OK || info == 0) return status;
  return dvi__fail(DVI_SOLVER_FAILED, "complex matrix: LAPACK found no %s of %d columns (code %d)",
                   what, n, info);
}

dvi_status dvi__complex_svd(int n, double complex *A, double *s, double complex *VH)
{
  const int one = 1;
  int info = 0;
  workspace work;
  const dvi_status status = workspace_create(n, &work);
  if (status == DVI_OK)
    zgesvd_("N", "A", &n, &n, A, &n, s, NULL, &one, VH, &n, work.room, &work.length, work.real,
            &info, 1, 1);
  return workspace_end(&work, status, info, n, "singular values");
}

dvi_status dvi__complex_eigenvalues(int n, double complex *A, double complex *z)
{
  const int one = 1;
  int info = 0;
  workspace work;
  const dvi_status status = workspace_create(n, &work);
  if (status == DVI_OK)
    zgeev_("N", "N", &n, A, &n, z, NULL, &one, NULL, &one, work.room, &work.length, work.real,
           &info, 1, 1);
  return workspace_end(&work, status, info, n, "eigenvalues");
}

dvi_status dvi__complex_hermitian(int n, double complex *A, double *lambda)
{
  int info = 0;
  workspace work;
  const dvi_status status = workspace_create(n, &work);
  if (status == DVI_OK)
    zheev_("V", "L", &n, A, &n, lambda, work.room, &work.length, work.real, &info, 1, 1);
  return workspace_end(&work, status, info, n, "Hermitian eigenvalues");
}
