/* Lanczos' method with implicit restarts (Lehoucq, Sorensen and Yang 1998), near a shift for the
 * inverse of K - shift M.
 *
 * ARPACK keeps its state in static variables, so that one thread at a time may use it. */
#include "field/algebra/modes.h"

#include <arpack/arpack.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/algebra/vectors.h"
#include "num/eigen.h"

enum { MULTIPLY = 1, MASS = 2, DONE = 99, RESTARTS = 1000, SHIFT_INVERT = 3 };

/* Where solutions are iterated, vectors are as good as these, and eigenvalues as their squares. */
static const double tolerance_of_solutions = 1e-10, tolerance_of_vectors = 1e-8;

static pthread_mutex_t arpack = PTHREAD_MUTEX_INITIALIZER;

typedef struct lanczos {
  const dvi__pencil *pencil;
  const dvi__definite *inverse; /* of K - shift M */
  int count, directions;
  double shift;
  double *residual, *basis, *places, *work, *product;
  a_int setting[11], place[11];
} lanczos;

/* ---- products ---- */

static dvi_status project(const dvi__pencil *pencil, double *x)
{
  return pencil->project != NULL ? pencil->project(pencil->of, x) : DVI_OK;
}

/* Set y to M x, or to (K - shift M)^-1 M x, for which ARPACK may have left M x at a third place. */
static dvi_status answer(const lanczos *s, int asked)
{
  double *x = s->places + s->place[0] - 1, *y = s->places + s->place[1] - 1;
  const double *Mx = asked == MULTIPLY ? s->places + s->place[2] - 1 : s->product;
  if (asked != MULTIPLY) dvi_matrix_multiply(s->pencil->M, 0, x, asked == MASS ? y : s->product);
  if (asked == MASS) return DVI_OK;
  DVI_TRY(dvi__definite_solve(s->inverse, Mx, y, NULL));
  return project(s->pencil, y);
}

/* ---- the iteration ---- */

static dvi_status explain(const lanczos *s, int info)
{
  if (info == 1)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "modes: %d of %d eigenvalues converged in %d restarts of Lanczos' method",
                     (int)s->setting[4], s->count, RESTARTS);
  return dvi__fail(DVI_SOLVER_FAILED, "modes: ARPACK failed with code %d", info);
}

static double tolerance_of(const lanczos *s)
{
  return s->inverse->factor == NULL && !s->inverse->is_diagonal ? tolerance_of_vectors : 0;
}

static dvi_status iterate(lanczos *s, a_int *info)
{
  const a_int n = (a_int)s->pencil->K->rows;
  const a_int length = s->directions * (s->directions + 8);
  a_int asked = 0;
  *info = 1; /* the start is given */
  for (;;) {
    dsaupd_c(&asked, "G", n, "LM", s->count, tolerance_of(s), s->residual, s->directions, s->basis,
             n, s->setting, s->place, s->places, s->work, length, info);
    if (asked == DONE) break;
    DVI_TRY(answer(s, (int)asked));
  }
  return *info == 0 ? DVI_OK : explain(s, (int)*info);
}

/* ARPACK fills in `chosen` itself if it wants all vectors. */
static dvi_status extract(lanczos *s, double *eigenvalue, double *vector, a_int *chosen)
{
  const a_int n = (a_int)s->pencil->K->rows;
  const a_int length = s->directions * (s->directions + 8);
  a_int info = 0;
  dseupd_c(vector != NULL, "A", chosen, eigenvalue, vector, n, s->shift, "G", n, "LM", s->count,
           tolerance_of(s), s->residual, s->directions, s->basis, n, s->setting, s->place,
           s->places, s->work, length, &info);
  return info == 0 ? DVI_OK : explain(s, (int)info);
}

static dvi_status allocate(lanczos *s)
{
  const int64_t n = s->pencil->K->rows, directions = s->directions;
  s->residual = DVI_NEW(double, n);
  s->basis = DVI_NEW(double, n *directions);
  s->places = DVI_NEW(double, 3 * n);
  s->work = DVI_NEW(double, directions *(directions + 8));
  s->product = DVI_NEW(double, n);
  if (!s->residual || !s->basis || !s->places || !s->work || !s->product)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for %d vectors of %lld numbers",
                     s->directions, (long long)n);
  (void)dvi__fill_random(n, 20221, s->residual);
  DVI_TRY(project(s->pencil, s->residual));
  s->setting[0] = 1; /* exact shifts */
  s->setting[2] = RESTARTS;
  s->setting[6] = SHIFT_INVERT;
  return DVI_OK;
}

static dvi_status run(lanczos *s, double *eigenvalue, double *vector)
{
  a_int info = 0, *chosen = DVI_NEW(a_int, s->directions);
  dvi_status status = allocate(s);
  if (status == DVI_OK && chosen == NULL) status = dvi__fail(DVI_NO_MEMORY, "modes: no memory");
  (void)pthread_mutex_lock(&arpack);
  if (status == DVI_OK) status = iterate(s, &info);
  if (status == DVI_OK) status = extract(s, eigenvalue, vector, chosen);
  (void)pthread_mutex_unlock(&arpack);
  dvi__release(chosen);
  dvi__release(s->residual);
  dvi__release(s->basis);
  dvi__release(s->places);
  dvi__release(s->work);
  dvi__release(s->product);
  return status;
}

/* ---- near a shift ---- */

static dvi_status shift_matrix(const dvi__pencil *pencil, double shift, dvi__csr *shifted)
{
  dvi__csr scaled;
  DVI_TRY(dvi__csr_copy(pencil->M, &scaled));
  const int64_t entries = scaled.start[scaled.rows];
  for (int64_t e = 0; e < entries; e++) scaled.value[e] *= -shift;
  const dvi_matrix minus = dvi__csr_view(&scaled, 1);
  const dvi_status status = dvi__csr_sum(pencil->K, &minus, shifted);
  dvi__csr_clear(&scaled);
  return status;
}

/* With eigenvalues below the shift, as of unstable states, the matrix is not definite. */
static dvi_status create_inverse(const dvi__pencil *pencil, double shift, dvi__definite *inverse)
{
  dvi__csr shifted;
  DVI_TRY(shift_matrix(pencil, shift, &shifted));
  const dvi_matrix view = dvi__csr_view(&shifted, 1);
  dvi_status status = shift > 0 ? DVI_SINGULAR
                                : dvi__definite_create(&view, pencil->dimension, inverse);
  if (status == DVI_SINGULAR) status = dvi__regular_create(&view, inverse);
  dvi__csr_clear(&shifted);
  return status;
}

static int smaller(int64_t a, int64_t b)
{
  return (int)(a < b ? a : b);
}

/* ---- all modes of small pencils ---- */

static void fill_dense(const dvi_matrix *A, double *full)
{
  memset(full, 0, (size_t)(A->rows * A->rows) * sizeof *full);
  for (int64_t i = 0; i < A->rows; i++)
    for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++)
      full[dvi__entry_column(A, i, e) * A->rows + i] += dvi__entry_value(A, e);
}

int dvi__first_of_nearest(int n, const double *value, int count, double shift)
{
  int first = 0;
  for (int last = n; last - first > count;)
    if (fabs(value[first] - shift) > fabs(value[last - 1] - shift))
      first++;
    else
      last--;
  return first;
}

static dvi_status modes_of_full(const dvi__pencil *pencil, double shift, int count,
                                double *eigenvalue, double *vector)
{
  const int64_t n = pencil->K->rows, square = n * n;
  double *room = DVI_NEW(double, 3 * square + n);
  if (room == NULL)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for full matrices of %lld unknowns",
                     (long long)n);
  double *K = room, *M = K + square, *X = M + square, *value = X + square;
  fill_dense(pencil->K, K);
  fill_dense(pencil->M, M);
  const dvi_status status = dvi__eigen_symmetric((int)n, K, M, value, X);
  const int first = dvi__first_of_nearest((int)n, value, count, shift);
  memcpy(eigenvalue, value + first, (size_t)count * sizeof *value);
  if (vector != NULL)
    memcpy(vector, X + (int64_t)first * n, (size_t)count * (size_t)n * sizeof *vector);
  dvi__release(room);
  return status;
}

/* Few unknowns, or nearly as many modes, leave Lanczos' method no room. */
static int is_small(int64_t n, int count)
{
  return n <= 64 || (n <= 2000 && 2 * (int64_t)count + 20 >= n);
}

static dvi_status lanczos_near(const dvi__pencil *pencil, double shift, int count,
                               double *eigenvalue, double *vector)
{
  const int64_t n = pencil->K->rows;
  dvi__definite inverse;
  DVI_TRY(create_inverse(pencil, shift, &inverse));
  inverse.tolerance = tolerance_of_solutions;
  inverse.correct = pencil->add_kernel;
  inverse.of = pencil->of;
  inverse.weight = -shift;
  lanczos s = {.pencil = pencil,
               .inverse = &inverse,
               .count = count,
               .directions = smaller(n, count < 8 ? 20 : 2 * (int64_t)count + 4),
               .shift = shift};
  const dvi_status status = run(&s, eigenvalue, vector);
  dvi__definite_clear(&inverse);
  return status;
}

/* A shift below zero of the size of the matrices makes a semidefinite K definite. */
static double default_shift(const dvi_matrix *K, const dvi_matrix *M)
{
  double k = 0, m = 0;
  for (int64_t i = 0; i < K->rows; i++) {
    for (int64_t e = dvi__first_entry(K, i); e < dvi__first_entry(K, i + 1); e++)
      if (dvi__entry_column(K, i, e) == i) k += dvi__entry_value(K, e);
    for (int64_t e = dvi__first_entry(M, i); e < dvi__first_entry(M, i + 1); e++)
      if (dvi__entry_column(M, i, e) == i) m += dvi__entry_value(M, e);
  }
  return -1e-5 * k / m;
}

/* Replace eigenvalues by Rayleigh's quotients, whose errors are squares of those of the vectors,
 * and sort them. Returns the largest |K x - lambda M x|, beside the largest entry of K. */
static double refine(const dvi__pencil *pencil, int count, double *value, double *vector,
                     double *room)
{
  const int64_t n = pencil->K->rows;
  const double size = dvi__largest_entry(pencil->K);
  double worst = 0, *Kx = room, *Mx = room + n;
  for (int k = 0; k < count; k++) {
    const double *x = vector + k * n;
    double most = 0, left = 0, xKx = 0, xMx = 0;
    dvi_matrix_multiply(pencil->K, 0, x, Kx);
    dvi_matrix_multiply(pencil->M, 0, x, Mx);
    for (int64_t i = 0; i < n; i++) {
      most = fmax(most, fabs(x[i]));
      left = fmax(left, fabs(Kx[i] - value[k] * Mx[i]));
      xKx += x[i] * Kx[i];
      xMx += x[i] * Mx[i];
    }
    worst = fmax(worst, left / (most * size));
    value[k] = xKx / xMx;
  }
  dvi__sort_modes(n, count, value, vector);
  return worst;
}

static dvi_status refuse_roundings(double shift)
{
  return dvi__fail(DVI_SINGULAR,
                   "modes: roundings of matrices with entries of very different sizes leave no "
                   "modes near the shift %g: take another one",
                   shift);
}

/* A shift at an eigenvalue makes K - shift M singular to roundoff, so that its solutions have the
 * right direction and no more digits, and other eigenvalues would be made of roundings. The shift
 * is then moved by a small part of the distance to the farthest eigenvalue, until the nearest one
 * is not so near. *from is where it is in the end. */
static dvi_status lanczos_beside(const dvi__pencil *pencil, double shift, int count, double *from,
                                 double *value, double *vector, double *room)
{
  enum { TRIES = 12 };
  const double near = 1e-6, part = 1e-5, allowed = 1e-6,
               unit = -default_shift(pencil->K, pencil->M);
  *from = shift;
  for (int i = 0; i < TRIES; i++) {
    double nearest = INFINITY, farthest = 0;
    dvi_status status = lanczos_near(pencil, *from, count, value, vector);
    if (status != DVI_OK && status != DVI_SINGULAR) return status;
    if (status == DVI_OK && !(refine(pencil, count, value, vector, room) <= allowed))
      status = refuse_roundings(shift);
    for (int k = 0; k < count && status == DVI_OK; k++) {
      nearest = fmin(nearest, fabs(value[k] - *from));
      farthest = fmax(farthest, fabs(value[k] - *from));
    }
    if (status == DVI_OK && nearest > near * farthest) return DVI_OK;
    if (status != DVI_OK && i + 1 == TRIES) return status;
    *from += (shift > 0 ? 1 : -1) * fmax(part * farthest, status == DVI_OK ? 0 : 1e-2 * unit);
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "modes: the shift %g lies within roundoff of many eigenvalues: take another one",
                   shift);
}

/* All eigenvalues that are as near to `from` as those found are known. Tell if these are all that
 * are as near to the shift as the chosen ones, but for a small move from it. */
static int are_nearest(int found, const double *value, int count, const double *chosen,
                       double shift, double from)
{
  const double small = 0.01, move = fabs(from - shift);
  double known = 0, needed = 0;
  for (int i = 0; i < found; i++) known = fmax(known, fabs(value[i] - from));
  for (int i = 0; i < count; i++) needed = fmax(needed, fabs(chosen[i] - shift));
  return move <= small * needed || needed + move <= known;
}

/* A few more eigenvalues than asked for tell which ones are the nearest. */
static dvi_status modes_by_lanczos(const dvi__pencil *pencil, double shift, int count,
                                   double *eigenvalue, double *vector)
{
  enum { MORE = 4 };
  const int64_t n = pencil->K->rows;
  const int asked = smaller(n - 1, (int64_t)count + MORE);
  double *value = DVI_NEW(double, asked + n * (asked + 2)), from;
  if (value == NULL)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for %d vectors of %lld numbers", asked,
                     (long long)n);
  dvi_status status = lanczos_beside(pencil, shift, asked, &from, value, value + asked,
                                     value + asked + n * asked);
  const int first = status == DVI_OK ? dvi__first_of_nearest(asked, value, count, shift) : 0;
  if (status == DVI_OK && !are_nearest(asked, value, count, value + first, shift, from))
    status = refuse_roundings(shift);
  if (status == DVI_OK) {
    memcpy(eigenvalue, value + first, (size_t)count * sizeof *value);
    if (vector != NULL)
      memcpy(vector, value + asked + (int64_t)first * n,
             (size_t)count * (size_t)n * sizeof *vector);
  }
  dvi__release(value);
  return status;
}

dvi_status dvi__modes_near(const dvi__pencil *pencil, double shift, int count, double *eigenvalue,
                           double *vector)
{
  const int64_t n = pencil->K->rows;
  if (!isfinite(shift)) return dvi__fail(DVI_BAD_ARGUMENT, "modes: the shift is %g", shift);
  if (count < 1 || count > n || (count == n && !is_small(n, count)) || n > INT_MAX / 64)
    return dvi__fail(DVI_BAD_SIZE, "modes: %d modes of %lld unknowns: take 1 to %lld", count,
                     (long long)n, (long long)n - !is_small(n, (int)n));
  DVI_TRY(is_small(n, count) ? modes_of_full(pencil, shift, count, eigenvalue, vector)
                             : modes_by_lanczos(pencil, shift, count, eigenvalue, vector));
  for (int i = 0; i < count && vector != NULL; i++) dvi__choose_sign(n, vector + i * n);
  return DVI_OK;
}

/* ---- for users ---- */

dvi_status dvi_matrix_modes(const dvi_matrix *K, const dvi_matrix *M,
                            const dvi_modes_options *options, double *eigenvalue, double *vector)
{
  const dvi_modes_options defaults = {.size = sizeof defaults};
  if (K == NULL || M == NULL || eigenvalue == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: two matrices and eigenvalues are needed");
  if (K->rows != M->rows || K->columns != K->rows || M->columns != M->rows)
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: the matrices have %lld and %lld rows",
                     (long long)K->rows, (long long)M->rows);
  if (options == NULL) options = &defaults;
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: set options.size to sizeof(dvi_modes_options)");
  const dvi__pencil pencil = {.K = K, .M = M, .dimension = options->dimension};
  const double shift = options->shift != 0 ? options->shift : default_shift(K, M);
  return dvi__modes_near(&pencil, shift, options->count != 0 ? options->count : 6, eigenvalue,
                         vector);
}
