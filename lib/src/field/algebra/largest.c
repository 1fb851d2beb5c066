/* The largest eigenvalue by Lanczos' method in the scalar product of M,
 *
 *     M^-1 K q_j = beta_j q_{j-1} + alpha_j q_j + beta_{j+1} q_{j+1},      q_i.M q_j = delta_ij. */
#include "field/algebra/largest.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/algebra/ritz.h"

/* Conjugate gradients' relative residual, far below the thousandth that the bound may be off. */
static const double tolerance_of_solutions = 1e-10;

typedef struct lanczos {
  const dvi__pencil *pencil;
  const dvi__rows *rows;
  dvi__definite inverse; /* of M */
  int64_t n;
  double *q, *r, *Mq, *Mr, *last, *u; /* [n] q_j, the next one, M times these, M q_{j-1}, K q_j */
  double scale;                       /* power of two by which K is multiplied */
  dvi__ritz T;
} lanczos;

/* ---- all rows ---- */

static int is_own(const lanczos *s, int64_t row)
{
  return s->rows == NULL || s->rows->is_own[row];
}

/* Give x.y, the sum of the rounded products, rounded once. */
static dvi_status dot(const lanczos *s, const double *x, const double *y, double *value)
{
  dvi__accumulator sum = {.terms = 0};
  dvi__accumulate_products(&sum, s->n, x, y, s->rows != NULL ? s->rows->is_own : NULL);
  if (s->rows != NULL) return s->rows->sum(s->rows->all, &sum, value);
  *value = dvi__accumulator_value(&sum);
  return DVI_OK;
}

static dvi_status largest(const lanczos *s, double *value)
{
  return s->rows != NULL ? s->rows->largest(s->rows->all, value) : DVI_OK;
}

/* Give the largest size of an entry of a matrix. */
static dvi_status largest_entry(const lanczos *s, const dvi_matrix *A, double *most)
{
  *most = 0;
  for (int64_t i = 0; i < A->rows; i++)
    for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1) && is_own(s, i); e++)
      *most = fmax(*most, fabs(dvi__entry_value(A, e)));
  return largest(s, most);
}

/* ---- a bound ---- */

/* The largest sum of the entries' sizes in a row of M^-1 K bounds the eigenvalues. Infinite if M is
 * not diagonal. */
static dvi_status bound_by_rows(const lanczos *s, double *most)
{
  const dvi_matrix *K = s->pencil->K, *M = s->pencil->M;
  *most = M->column != NULL ? (double)INFINITY : 0;
  for (int64_t i = 0; i < K->rows && M->column == NULL; i++) {
    double sum = 0;
    for (int64_t e = dvi__first_entry(K, i); e < dvi__first_entry(K, i + 1); e++)
      sum += fabs(dvi__entry_value(K, e));
    if (is_own(s, i)) *most = fmax(*most, sum / M->value[i]);
  }
  return largest(s, most);
}

/* ---- the iteration ---- */

/* Make the next direction of length 1 from M r. Returns the length that it had. */
static dvi_status take_direction(lanczos *s, double *length)
{
  double square;
  DVI_TRY(dvi__definite_solve(&s->inverse, s->Mr, s->r, NULL));
  DVI_TRY(dot(s, s->r, s->Mr, &square));
  *length = sqrt(fmax(square, 0));
  double *const old = s->last;
  s->last = s->Mq;
  s->Mq = old;
  if (*length == 0) return DVI_OK;
  for (int64_t i = 0; i < s->n; i++) {
    s->q[i] = s->r[i] / *length;
    s->Mq[i] = s->Mr[i] / *length;
  }
  return DVI_OK;
}

static dvi_status advance(lanczos *s)
{
  const int j = s->T.steps++;
  if (s->rows != NULL) DVI_TRY(s->rows->refresh(s->rows->of, s->q));
  dvi_matrix_multiply(s->pencil->K, 0, s->q, s->u);
  for (int64_t i = 0; i < s->n; i++) s->u[i] *= s->scale;
  DVI_TRY(dot(s, s->q, s->u, &s->T.alpha[j]));
  for (int64_t i = 0; i < s->n; i++)
    s->Mr[i] = s->u[i] - s->T.alpha[j] * s->Mq[i] - s->T.beta[j] * s->last[i];
  return take_direction(s, &s->T.beta[j + 1]);
}

/* Bring the eigenvalues near 1, so that squares neither overflow nor vanish. */
static dvi_status find_scale(lanczos *s, double most_of_K)
{
  double most_of_M;
  int of_K, of_M;
  DVI_TRY(largest_entry(s, s->pencil->M, &most_of_M));
  (void)frexp(most_of_K, &of_K);
  (void)frexp(most_of_M, &of_M);
  s->scale = ldexp(1, of_M - of_K);
  return DVI_OK;
}

/* Let M r be a start whose parts in all eigenvectors are alike, which are orthonormal in M. For a
 * diagonal M these parts are those of M^(-1/2) M r. */
static void fill_start(lanczos *s)
{
  const dvi_matrix *M = s->pencil->M;
  uint64_t seed = 20221;
  int64_t drawn = 0;
  for (int64_t i = 0; i < s->n; i++) {
    const int64_t number = s->rows != NULL ? s->rows->number[i] : i;
    for (; drawn <= number; drawn++) seed = dvi__fill_random(1, seed, s->Mr + i);
  }
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t e = dvi__first_entry(M, i); e < dvi__first_entry(M, i + 1); e++)
      if (dvi__entry_column(M, i, e) == i) s->Mr[i] *= sqrt(dvi__entry_value(M, e));
}

static dvi_status iterate(lanczos *s, double *bound)
{
  const int64_t n = s->rows != NULL ? s->rows->total : s->n;
  double length, rows, most;
  DVI_TRY(largest_entry(s, s->pencil->K, &most));
  if (!(most > 0)) return DVI_OK;
  DVI_TRY(bound_by_rows(s, &rows));
  DVI_TRY(find_scale(s, most));
  fill_start(s);
  DVI_TRY(take_direction(s, &length));
  memset(s->last, 0, (size_t)s->n * sizeof *s->last);
  while (!dvi__ritz_suffices(&s->T, n, rows * s->scale, bound)) DVI_TRY(advance(s));
  *bound /= s->scale;
  return DVI_OK;
}

/* Make the vectors in `room`, and the inverse. */
static dvi_status prepare(lanczos *s, double **room)
{
  *room = DVI_NEW(double, 6 * s->n);
  if (*room == NULL)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for vectors of %lld numbers",
                     (long long)s->n);
  double **const vectors[] = {&s->q, &s->r, &s->Mq, &s->Mr, &s->last, &s->u};
  for (int i = 0; i < 6; i++) *vectors[i] = *room + i * s->n;
  s->inverse.is_diagonal = 1; /* a process may have no row */
  if (s->n > 0) DVI_TRY(dvi__definite_create(s->pencil->M, s->pencil->dimension, &s->inverse));
  s->inverse.tolerance = tolerance_of_solutions;
  return DVI_OK;
}

static dvi_status run(lanczos *s, double *bound)
{
  double *room = NULL;
  dvi_status status = prepare(s, &room);
  if (s->rows != NULL) status = s->rows->agree(s->rows->all, status);
  if (status == DVI_OK && room != NULL) status = iterate(s, bound);
  dvi__definite_clear(&s->inverse);
  dvi__release(room);
  return status;
}

dvi_status dvi__largest_eigenvalue(const dvi__pencil *pencil, const dvi__rows *rows, double *bound)
{
  lanczos s = {.pencil = pencil, .rows = rows, .n = pencil->K->rows};
  *bound = 0;
  if (s.n < 0 || (s.n < 1 && rows == NULL) || s.n > INT_MAX / 64)
    return dvi__fail(DVI_BAD_SIZE, "modes: %lld unknowns, 1 to %d possible", (long long)s.n,
                     INT_MAX / 64);
  return run(&s, bound);
}
