/* Hestenes and Stiefel 1952. The sums run in one order, so that equal inputs give equal bits. */
#include "field/algebra/conjugate.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/vectors.h"
#include "field/algebra/csr.h"

/* Iterations without a smaller residual that end the iteration, and the residual that is good
 * enough then. */
enum { PATIENCE = 200, GROWTH = 1000 };
static const double acceptable = 1e-6;

typedef struct search {
  const dvi__products *A;
  double *r, *z, *p, *Ap; /* [size] */
  double *best;           /* [size] x of the smallest residual, once that is acceptable */
  double rz;              /* r.z */
  double roundoff;        /* of the scaled right side */
} search;

static void precondition(const search *s)
{
  if (s->A->precondition != NULL)
    s->A->precondition(s->A->of, s->r, s->z);
  else
    memcpy(s->z, s->r, (size_t)s->A->size * sizeof *s->z);
}

static int is_acceptable(const search *s, double residual, double size)
{
  return residual <= fmax(acceptable * size, 100 * s->roundoff);
}

/* Take one step along p. */
static dvi_status advance(search *s, double *x)
{
  const int64_t n = s->A->size;
  DVI_TRY(s->A->times(s->A->of, s->p, s->Ap));
  const double curvature = dvi__dot(n, s->p, s->Ap);
  if (!(curvature > 0))
    return dvi__fail(DVI_SINGULAR,
                     "conjugate gradients: the matrix is not positive: a direction has p.Ap = %g",
                     curvature);
  const double step = s->rz / curvature;
  for (int64_t i = 0; i < n; i++) {
    x[i] += step * s->p[i];
    s->r[i] -= step * s->Ap[i];
  }
  precondition(s);
  const double rz = dvi__dot(n, s->r, s->z), ratio = rz / s->rz;
  for (int64_t i = 0; i < n; i++) s->p[i] = s->z[i] + ratio * s->p[i];
  s->rz = rz;
  return DVI_OK;
}

/* The residual of the recurrence goes below that of x. The search ends where many iterations bring
 * no smaller one, or where it grows: in a semidefinite matrix directions of roundings lead away. */
static dvi_status iterate(search *s, double tolerance, double size, double *x,
                          dvi__iteration_report *report)
{
  const int64_t n = s->A->size;
  int idle = 0;
  double smallest = size;
  while (smallest > fmax(tolerance * size, s->roundoff) && idle < PATIENCE && s->rz > 0) {
    const dvi_status status = advance(s, x);
    if (status == DVI_SINGULAR && is_acceptable(s, smallest, size)) break;
    DVI_TRY(status);
    const double residual = sqrt(dvi__dot(n, s->r, s->r));
    report->iterations++;
    idle = residual < smallest ? 0 : idle + 1;
    if (residual < smallest) smallest = residual;
    if (idle == 0 && is_acceptable(s, residual, size)) memcpy(s->best, x, (size_t)n * sizeof *x);
    if (is_acceptable(s, smallest, size) && residual > GROWTH * smallest) break;
  }
  report->residual = size > 0 ? smallest / size : 0;
  if (report->iterations > 0 && is_acceptable(s, smallest, size))
    memcpy(x, s->best, (size_t)n * sizeof *x);
  return DVI_OK;
}

/* Give a power of two that brings the largest number of b near 1, so that squares neither overflow
 * nor vanish. */
static double scale_of(int64_t n, const double *b)
{
  double most = 0;
  int exponent;
  for (int64_t i = 0; i < n; i++)
    if (!(fabs(b[i]) <= most)) most = fabs(b[i]);
  (void)frexp(most, &exponent);
  return most > 0 && isfinite(most) ? ldexp(1, exponent < -1000 ? 1000 : -exponent) : 1;
}

static dvi_status solve(search *s, double tolerance, const double *b, double *x,
                        dvi__iteration_report *report)
{
  const int64_t n = s->A->size;
  const double scale = scale_of(n, b);
  memset(x, 0, (size_t)n * sizeof *x);
  for (int64_t i = 0; i < n; i++) s->r[i] = scale * b[i];
  s->roundoff = scale * s->A->roundoff;
  const double size = sqrt(dvi__dot(n, s->r, s->r));
  if (!isfinite(size)) return dvi__fail(DVI_NOT_FINITE, "conjugate gradients: |b| is %g", size);
  precondition(s);
  memcpy(s->p, s->z, (size_t)n * sizeof *b);
  s->rz = dvi__dot(n, s->r, s->z);
  DVI_TRY(iterate(s, tolerance, size, x, report));
  for (int64_t i = 0; i < n; i++) x[i] /= scale;
  if (is_acceptable(s, report->residual * size, size)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "conjugate gradients: %g of the right side is left after %d iterations: it may "
                   "lie outside of the matrix's range",
                   report->residual, report->iterations);
}

dvi_status dvi__conjugate_gradients(const dvi__products *A, double tolerance, const double *b,
                                    double *x, dvi__iteration_report *report)
{
  const size_t n = (size_t)A->size;
  double *own = A->work == NULL ? DVI_NEW(double, 5 * n) : NULL;
  double *work = A->work != NULL ? A->work : own;
  dvi__iteration_report unasked = {0};
  if (work == NULL)
    return dvi__fail(DVI_NO_MEMORY, "conjugate gradients: no memory for %lld unknowns",
                     (long long)A->size);
  search s = {.A = A,
              .r = work,
              .z = work + n,
              .p = work + 2 * n,
              .Ap = work + 3 * n,
              .best = work + 4 * n};
  if (report == NULL) report = &unasked;
  *report = unasked;
  const dvi_status status = solve(&s, tolerance, b, x, report);
  dvi__release(own);
  return status;
}

/* Each pass reads a row up to the diagonal, the first from the left and the second from the
 * right. */
void dvi__gauss_seidel(const dvi_matrix *A, const double *r, double *z)
{
  for (int64_t i = 0; i < A->rows; i++) {
    int64_t e = A->start[i];
    double left = r[i];
    for (; A->column[e] < i; e++) left -= A->value[e] * z[A->column[e]];
    z[i] = left / A->value[e];
  }
  for (int64_t i = A->rows - 1; i >= 0; i--) {
    int64_t e = A->start[i + 1] - 1;
    double sum = 0;
    for (; A->column[e] > i; e--) sum += A->value[e] * z[A->column[e]];
    z[i] -= sum / A->value[e];
  }
}

static dvi_status times(void *of, const double *x, double *y)
{
  dvi_matrix_multiply(of, 0, x, y);
  return DVI_OK;
}

static void precondition_by_gauss_seidel(void *of, const double *r, double *z)
{
  dvi__gauss_seidel(of, r, z);
}

dvi__products dvi__products_of(const dvi_matrix *A)
{
  return (dvi__products){.size = A->rows,
                         .times = times,
                         .precondition = precondition_by_gauss_seidel,
                         .of = (void *)A};
}
