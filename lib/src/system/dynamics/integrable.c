/* The test that nonholonomic constraints are not integrable.
 *
 * In the space of (t,q) the rows are one-forms omega_a = a_a dt + A_a.dq, and the velocities (1,v)
 * lie in their kernel. By Frobenius' theorem the rows follow from functions of t and q alone, as
 * holonomic constraints do, if and only if all
 *
 *     d omega_a(X,Y) = X(omega_a(Y)) - Y(omega_a(X))     (constant X, Y)
 *
 * vanish for X, Y in the kernel, everywhere. Each row is tested alone, and all together, at a point
 * and at three more around it. Source: Bloch 2003, sec. 2.2. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/evaluate/evaluator_struct.h"

/* Beyond so many coordinates the test costs too much for a start, and is left out. */
enum { COORDINATES_MOST = 64, SAMPLES = 4 };

/* A distribution at a point z = (t,q) of N = n + 1 numbers. Matrices are stored row after row. */
typedef struct distribution {
  dvi__evaluator *e;
  int m, N;
  int kernel;         /* vectors of its basis */
  double size;        /* of the coordinates */
  double *z, *moved;  /* [N] */
  double *B, *change; /* [m*N] the rows, and work */
  double *reduced;    /* [m*N] */
  double *basis;      /* [N*N] a vector after the other */
  double *along;      /* [N*m*N] derivatives of B along each of them */
  double *phi_q, *g;  /* [entries], [m] */
  int *pivot;         /* [m] column of each row's pivot, -1 for a dependent row */
  double *numbers;
} distribution;

static dvi_status allocate_distribution(distribution *d)
{
  const size_t m = (size_t)d->m, N = (size_t)d->N,
               entries = (size_t)dvi__pattern_entries(&d->e->system->rows_q);
  double *at = d->numbers = DVI_NEW(double, 2 * N + 3 * m * N + N * N + m * N * N + entries + m);
  d->pivot = DVI_NEW(int, m);
  if (at == NULL || d->pivot == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for the test of %zu rows", m);
  d->z = at;
  d->moved = d->z + N;
  d->B = d->moved + N;
  d->change = d->B + m * N;
  d->reduced = d->change + m * N;
  d->basis = d->reduced + m * N;
  d->along = d->basis + N * N;
  d->phi_q = d->along + m * N * N;
  d->g = d->phi_q + entries;
  return DVI_OK;
}

static dvi_status evaluate_rows(const distribution *d, const double *z, double *B)
{
  const dvi__pattern *G = &d->e->system->rows_q;
  DVI_TRY(dvi__rows_gradients(d->e, z[0], z + 1, d->phi_q));
  DVI_TRY(dvi__rows_rate(d->e, z[0], z + 1, d->g));
  memset(B, 0, (size_t)d->m * (size_t)d->N * sizeof *B);
  for (int a = 0; a < d->m; a++) {
    B[a * d->N] = d->g[a];
    for (int k = G->start[a]; k < G->start[a + 1]; k++) B[a * d->N + 1 + G->row[k]] = d->phi_q[k];
  }
  return DVI_OK;
}

/* ---- the kernel ---- */

/* Reduce the rows from `first` to last-1, each to 1 in its pivot's column and to 0 in those of the
 * others. The time's column has no pivot, because no row may stop the time. Return the first
 * nonholonomic row that depends on those before it, or -1. */
static int reduce_rows(distribution *d, int first, int last)
{
  const double rounding = 1e-10;
  const int N = d->N;
  int dependent = -1;
  memcpy(d->reduced, d->B, (size_t)d->m * (size_t)N * sizeof(double));
  for (int a = first; a < last; a++) {
    double *row = d->reduced + a * N;
    const double before = dvi__largest((size_t)N - 1, row + 1);
    for (int b = first; b < a; b++) {
      const double factor = d->pivot[b] >= 0 ? row[d->pivot[b]] : 0;
      for (int c = 0; c < N && factor != 0; c++) row[c] -= factor * d->reduced[b * N + c];
    }
    int largest = 1;
    for (int c = 2; c < N; c++)
      if (fabs(row[c]) > fabs(row[largest])) largest = c;
    d->pivot[a] = fabs(row[largest]) > rounding * before ? largest : -1;
    if (d->pivot[a] < 0) {
      if (dependent < 0 && a >= d->e->system->place_rows) dependent = a;
      continue;
    }
    const double pivot = row[largest];
    for (int c = 0; c < N; c++) row[c] /= pivot;
    for (int b = first; b < a; b++) {
      double *other = d->reduced + b * N;
      const double factor = d->pivot[b] >= 0 ? other[largest] : 0;
      for (int c = 0; c < N && factor != 0; c++) other[c] -= factor * row[c];
    }
  }
  return dependent;
}

/* Make the basis of the reduced rows' kernel. */
static void fill_basis(distribution *d, int first, int last)
{
  const int N = d->N;
  d->kernel = 0;
  for (int c = 0; c < N; c++) {
    double *X = d->basis + d->kernel * N;
    int is_pivot = 0;
    for (int a = first; a < last; a++) is_pivot |= d->pivot[a] == c;
    if (is_pivot) continue;
    memset(X, 0, (size_t)N * sizeof *X);
    X[c] = 1;
    for (int a = first; a < last; a++)
      if (d->pivot[a] >= 0) X[d->pivot[a]] = -d->reduced[a * N + c];
    d->kernel++;
  }
}

/* ---- derivatives along the kernel ---- */

/* Differences of order 4 of the rows along X. */
static dvi_status difference_rows_along(distribution *d, const double *X, double *along)
{
  static const double weight[] = {2.0 / 3.0, -1.0 / 12.0};
  const size_t numbers = (size_t)d->m * (size_t)d->N;
  const double step = ldexp(d->size, -10) / dvi__largest((size_t)d->N, X);
  memset(along, 0, numbers * sizeof *along);
  for (int k = 0; k < 4; k++) {
    const int far = 1 + k / 2, sign = k % 2 ? -1 : 1;
    for (int c = 0; c < d->N; c++) d->moved[c] = d->z[c] + sign * far * step * X[c];
    DVI_TRY(evaluate_rows(d, d->moved, d->change));
    for (size_t i = 0; i < numbers; i++) along[i] += sign * weight[far - 1] / step * d->change[i];
  }
  return DVI_OK;
}

/* Tell whether d omega_a(X_i,X_j) is more than a rounding. */
static int twists(const distribution *d, int a, int i, int j)
{
  const int N = d->N;
  const double *X = d->basis + i * N, *Y = d->basis + j * N;
  const double *X_of = d->along + (i * d->m + a) * N, *Y_of = d->along + (j * d->m + a) * N;
  double sum = 0, size = 0, whole = 0;
  for (int c = 0; c < N; c++) {
    sum += X_of[c] * Y[c] - Y_of[c] * X[c];
    size += fabs(X_of[c] * Y[c]) + fabs(Y_of[c] * X[c]);
    whole += fabs(d->B[a * N + c]) * (fabs(X[c]) + fabs(Y[c]));
  }
  return fabs(sum) > 1e-6 * size + 1e-10 * whole / d->size;
}

/* Tell whether the rows from `first` to last-1 are not integrable at z. */
static dvi_status find_twist(distribution *d, int first, int last, int *found)
{
  const int places = d->e->system->place_rows;
  *found = 0;
  (void)reduce_rows(d, first, last);
  fill_basis(d, first, last);
  for (int i = 0; i < d->kernel; i++)
    DVI_TRY(difference_rows_along(d, d->basis + i * d->N, d->along + i * d->m * d->N));
  for (int a = first > places ? first : places; a < last && !*found; a++)
    for (int i = 0; i < d->kernel; i++)
      for (int j = 0; j < i && !*found; j++) *found = twists(d, a, i, j);
  return DVI_OK;
}

/* ---- the test ---- */

/* Move to a sample. The point itself is sample 0, and the others are spread by irrational parts of
 * the size of the coordinates. */
static dvi_status place_sample(distribution *d, int sample, double t, const double *q)
{
  d->z[0] = t;
  for (int i = 0; i < d->N - 1; i++) {
    const double part = 0.618033988749895 * (double)((i + 1) * sample);
    d->z[i + 1] = q[i] + 0.3 * d->size * (sample > 0 ? part - floor(part) - 0.3 : 0);
  }
  return evaluate_rows(d, d->z, d->B);
}

/* Tell whether the rows seem integrable at all samples, of which two at least must be defined. */
static dvi_status seem_integrable(distribution *d, double t, const double *q, int first, int last,
                                  int *integrable)
{
  int defined = 0;
  *integrable = 0;
  for (int sample = 0; sample < SAMPLES; sample++) {
    int twisted = 0;
    dvi_status status = place_sample(d, sample, t, q);
    if (status == DVI_OK) status = find_twist(d, first, last, &twisted);
    if (status == DVI_CALLBACK_FAILED) return status;
    if (twisted) return DVI_OK;
    defined += status == DVI_OK;
  }
  *integrable = defined >= 2;
  return DVI_OK;
}

static const char *name_of(const dvi_system *s, int a)
{
  int k = s->nonholonomic_count - 1;
  while (s->nonholonomics[k].first > a) k--;
  return s->nonholonomics[k].name;
}

static dvi_status test_rows(distribution *d, double t, const double *q)
{
  const dvi_system *s = d->e->system;
  int integrable = 0;
  DVI_TRY(place_sample(d, 0, t, q));
  const int dependent = reduce_rows(d, 0, d->m);
  if (dependent >= 0)
    return dvi__fail(DVI_SINGULAR,
                     "nonholonomic constraint '%s' depends on the other constraints at t = %.6g; "
                     "leave out the rows that follow from others",
                     name_of(s, dependent), t);
  for (int a = s->place_rows; a < d->m && !integrable; a++) {
    DVI_TRY(seem_integrable(d, t, q, a, a + 1, &integrable));
    if (integrable)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "nonholonomic constraint '%s' is integrable: it follows from a function "
                       "phi(t,q) that stays the same, which is a holonomic constraint; declare "
                       "phi = 0, so that q keeps it, too",
                       name_of(s, a));
  }
  if (d->m > 1) DVI_TRY(seem_integrable(d, t, q, 0, d->m, &integrable));
  return !integrable
             ? DVI_OK
             : dvi__fail(DVI_BAD_ARGUMENT,
                         "the nonholonomic constraints, '%s' and the others, are integrable "
                         "together: they follow from functions phi(t,q) that stay the same, which "
                         "are holonomic constraints; declare phi = 0, so that q keeps them, too",
                         name_of(s, s->place_rows));
}

dvi_status dvi__rows_are_nonholonomic(dvi__evaluator *e, double t, const double *q)
{
  const dvi_system *s = e->system;
  if (s->nonholonomic_count == 0 || s->n > COORDINATES_MOST) return DVI_OK;
  distribution d = {
      .e = e, .m = s->row_count, .N = s->n + 1, .size = fmax(dvi__largest((size_t)s->n, q), 1)};
  /* the counters of members of an ensemble are those that they would have alone, but one integrator
   * tests for all */
  const dvi_counters before = *e->counters;
  dvi_status status = allocate_distribution(&d);
  if (status == DVI_OK) status = test_rows(&d, t, q);
  dvi__release(d.numbers);
  dvi__release(d.pivot);
  *e->counters = before;
  return status;
}
