/* The largest eigenvalue by Lanczos' method in the scalar product of M,
 *
 *     M^-1 K q_j = beta_j q_{j-1} + alpha_j q_j + beta_{j+1} q_{j+1},      q_i.M q_j = delta_ij.
 *
 * The largest eigenvalue theta of the tridiagonal matrix lies below that of the pencil, lambda, and
 * from a start at random below lambda (1 - epsilon) with a probability of at most
 *
 *     1.648 sqrt(n) exp(-sqrt(epsilon) (2 m - 1))
 *
 * after m steps, whatever the spectrum is (Kuczynski and Wozniakowski 1992, sec. 4). A small
 * residual would not do: it tells of some eigenvalue, which may be the second one. A very small one
 * does, because the start has a part in every eigenvector. */
#include "field/algebra/largest.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { STEPS_MOST = 450, BETWEEN_TESTS = 16 };

static const double margin = 1e-3, improbable = 1e-8, settled = 1e-9;

typedef struct lanczos {
  const dvi__pencil *pencil;
  dvi__definite inverse; /* of M */
  int64_t n;
  double *q, *r, *Mq, *Mr, *last, *u; /* [n] q_j, the next one, M times these, M q_{j-1}, K q_j */
  double scale;                       /* power of two by which K is multiplied */
  int steps;
  double alpha[STEPS_MOST], beta[STEPS_MOST + 1];
} lanczos;

/* ---- the tridiagonal matrix ---- */

/* Count its eigenvalues above x by the signs of the pivots (Sturm). */
static int count_above(const lanczos *s, double x)
{
  int count = 0;
  double pivot = 1;
  for (int j = 0; j < s->steps; j++) {
    const double coupling = j > 0 ? s->beta[j] * (s->beta[j] / (pivot != 0 ? pivot : 1e-300)) : 0;
    pivot = s->alpha[j] - x - coupling;
    count += pivot > 0;
  }
  return count;
}

static double largest_ritz_value(const lanczos *s)
{
  double low = s->alpha[0], high = 0;
  for (int j = 0; j < s->steps; j++) {
    const double reach = s->beta[j] + (j + 1 < s->steps ? s->beta[j + 1] : 0);
    low = fmax(low, s->alpha[j]);
    high = fmax(high, s->alpha[j] + reach);
  }
  for (int i = 0; i < 60 && high - low > 1e-15 * high; i++) {
    const double middle = 0.5 * (low + high);
    if (count_above(s, middle) > 0)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* The part of the last direction in the eigenvector of theta, by the recurrence from there on, in
 * which the vector grows. */
static double last_component(const lanczos *s, double theta)
{
  double next = 0, here = 1, sum = 1;
  for (int j = s->steps - 1; j > 0; j--) {
    const double before = ((theta - s->alpha[j]) * here - s->beta[j + 1] * next) / s->beta[j];
    next = here;
    here = before;
    sum += here * here;
    if (sum > 1e200) return 0;
  }
  return 1 / sqrt(sum);
}

/* ---- bounds ---- */

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

static int steps_needed(int64_t n)
{
  const double steps = 0.5 * (1 + log(1.648 * sqrt((double)n) / improbable) / sqrt(margin));
  return steps < STEPS_MOST ? (int)ceil(steps) : STEPS_MOST;
}

/* ---- the iteration ---- */

static double dot(int64_t n, const double *x, const double *y)
{
  double sum = 0;
  for (int64_t i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* Make the next direction of length 1 from M r. Returns the length that it had. */
static dvi_status take_direction(lanczos *s, double *length)
{
  DVI_TRY(dvi__definite_solve(&s->inverse, s->Mr, s->r, NULL));
  *length = sqrt(fmax(dot(s->n, s->r, s->Mr), 0));
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
  const int j = s->steps++;
  dvi_matrix_multiply(s->pencil->K, 0, s->q, s->u);
  for (int64_t i = 0; i < s->n; i++) s->u[i] *= s->scale;
  s->alpha[j] = dot(s->n, s->q, s->u);
  for (int64_t i = 0; i < s->n; i++)
    s->Mr[i] = s->u[i] - s->alpha[j] * s->Mq[i] - s->beta[j] * s->last[i];
  return take_direction(s, &s->beta[j + 1]);
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
  dvi__fill_start(s->n, s->Mr);
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t e = dvi__first_entry(M, i); e < dvi__first_entry(M, i + 1); e++)
      if (dvi__entry_column(M, i, e) == i) s->Mr[i] *= sqrt(dvi__entry_value(M, e));
}

static dvi_status iterate(lanczos *s, double *bound)
{
  const int most = steps_needed(s->n);
  const double rows = bound_by_rows(s->pencil);
  double theta = 0;
  s->scale = scale_of(s->pencil);
  fill_start(s);
  DVI_TRY(take_direction(s, &s->beta[0]));
  memset(s->last, 0, (size_t)s->n * sizeof *s->last);
  s->beta[0] = 0;
  while (s->steps < most) {
    DVI_TRY(advance(s));
    const double beta = s->beta[s->steps];
    if (s->steps % BETWEEN_TESTS != 0 && s->steps < most && beta > 0) continue;
    theta = largest_ritz_value(s);
    if (rows * s->scale <= theta * (1 + margin) || !(beta > settled * theta) ||
        beta * last_component(s, theta) <= settled * theta)
      break;
  }
  *bound = fmin(theta / s->scale * (1 + margin), rows);
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
  dvi_status status = dvi__definite_create(s->pencil->M, 3, &s->inverse);
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
