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
#include "field/algebra/vectors.h"

/* Conjugate gradients' relative residual, far below the thousandth that the bound may be off. */
static const double tolerance_of_solutions = 1e-10;

typedef struct lanczos {
  const dvi__pencil *pencil;
  dvi__definite inverse; /* of M */
  int64_t n;
  double *q, *r, *Mq, *Mr, *last, *u; /* [n] q_j, the next one, M times these, M q_{j-1}, K q_j */
  double scale;                       /* power of two by which K is multiplied */
  dvi__ritz T;
} lanczos;

/* ---- a bound ---- */

/* The largest sum of the entries' sizes in a row of M^-1 K bounds the eigenvalues. Infinite if M is
 * not diagonal. */
static double bound_by_rows(const dvi__pencil *pencil)
{
  const dvi_matrix *K = pencil->K, *M = pencil->M;
  double most = 0;
  if (M->column != NULL) return INFINITY;
  for (int64_t i = 0; i < K->rows; i++) {
    double sum = 0;
    for (int64_t e = dvi__first_entry(K, i); e < dvi__first_entry(K, i + 1); e++)
      sum += fabs(dvi__entry_value(K, e));
    most = fmax(most, sum / M->value[i]);
  }
  return most;
}

/* ---- the iteration ---- */

/* Make the next direction of length 1 from M r. Returns the length that it had. */
static dvi_status take_direction(lanczos *s, double *length)
{
  DVI_TRY(dvi__definite_solve(&s->inverse, s->Mr, s->r, NULL));
  *length = sqrt(fmax(dvi__dot(s->n, s->r, s->Mr), 0));
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
  dvi_matrix_multiply(s->pencil->K, 0, s->q, s->u);
  for (int64_t i = 0; i < s->n; i++) s->u[i] *= s->scale;
  s->T.alpha[j] = dvi__dot(s->n, s->q, s->u);
  for (int64_t i = 0; i < s->n; i++)
    s->Mr[i] = s->u[i] - s->T.alpha[j] * s->Mq[i] - s->T.beta[j] * s->last[i];
  return take_direction(s, &s->T.beta[j + 1]);
}

/* Bring the eigenvalues near 1, so that squares neither overflow nor vanish. */
static double scale_of(const dvi__pencil *pencil)
{
  int of_K, of_M;
  (void)frexp(dvi__largest_entry(pencil->K), &of_K);
  (void)frexp(dvi__largest_entry(pencil->M), &of_M);
  return ldexp(1, of_M - of_K);
}

/* Let M r be a start whose parts in all eigenvectors are alike, which are orthonormal in M. For a
 * diagonal M these parts are those of M^(-1/2) M r. */
static void fill_start(lanczos *s)
{
  const dvi_matrix *M = s->pencil->M;
  (void)dvi__fill_random(s->n, 20221, s->Mr);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t e = dvi__first_entry(M, i); e < dvi__first_entry(M, i + 1); e++)
      if (dvi__entry_column(M, i, e) == i) s->Mr[i] *= sqrt(dvi__entry_value(M, e));
}

static dvi_status iterate(lanczos *s, double *bound)
{
  const double rows = bound_by_rows(s->pencil);
  double length;
  s->scale = scale_of(s->pencil);
  fill_start(s);
  DVI_TRY(take_direction(s, &length));
  memset(s->last, 0, (size_t)s->n * sizeof *s->last);
  while (!dvi__ritz_suffices(&s->T, s->n, rows * s->scale, bound)) DVI_TRY(advance(s));
  *bound /= s->scale;
  return DVI_OK;
}

static dvi_status run(lanczos *s, double *bound)
{
  double *room = DVI_NEW(double, 6 * s->n);
  if (room == NULL)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for vectors of %lld numbers",
                     (long long)s->n);
  double **const vectors[] = {&s->q, &s->r, &s->Mq, &s->Mr, &s->last, &s->u};
  for (int i = 0; i < 6; i++) *vectors[i] = room + i * s->n;
  dvi_status status = dvi__definite_create(s->pencil->M, s->pencil->dimension, &s->inverse);
  s->inverse.tolerance = tolerance_of_solutions;
  if (status == DVI_OK) status = iterate(s, bound);
  dvi__definite_clear(&s->inverse);
  dvi__release(room);
  return status;
}

dvi_status dvi__largest_eigenvalue(const dvi__pencil *pencil, double *bound)
{
  lanczos s = {.pencil = pencil, .n = pencil->K->rows};
  *bound = 0;
  if (s.n < 1 || s.n > INT_MAX / 64)
    return dvi__fail(DVI_BAD_SIZE, "modes: %lld unknowns, 1 to %d possible", (long long)s.n,
                     INT_MAX / 64);
  return dvi__largest_entry(pencil->K) > 0 ? run(&s, bound) : DVI_OK;
}
