/* The whole monodromy matrix of a small field.
 *
 * Static fields make it defective: with dE = 0 the potential grows, A = -E t. But what A has of
 * them acts on nothing, and without dampings kicks, combinations of d^T, give D nothing of them. So
 * the coordinates are omega_j x_j.M1 A and x_j.D for the modes x_j of K x = omega^2 M1 x with
 * omega > 0, and with dampings x_j.D for those with omega = 0, too. Their squares are twice the
 * energy, and without dampings the matrix is close to an orthogonal one. Its squares, of which some
 * are taken, keep multipliers on the unit circle there, and spread the others. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/step/growth.h"
#include "num/eigen.h"

enum { SQUARES_LEAST = 6, SQUARES_MOST = 40 };

static const double static_below = 1e-11, grown = 1e6, threshold = 1e-6;

typedef struct modal {
  const dvi__flow *flow;
  int n, r, statics;          /* free edges, modes that are not static, and others */
  int size;                   /* coordinates */
  double *K, *M, *lambda, *X; /* [n*n] by columns, lambda [n] */
  double *T, *product;        /* [size*size] by columns */
} modal;

static void clear(modal *m)
{
  dvi__release(m->K);
  dvi__release(m->M);
  dvi__release(m->lambda);
  dvi__release(m->X);
  dvi__release(m->T);
  dvi__release(m->product);
}

static dvi_status no_memory(const modal *m)
{
  return dvi__fail(DVI_NO_MEMORY, "stability: no memory for %d modes", m->n);
}

/* ---- modes ---- */

/* The static modes come first. */
static dvi_status find_modes(modal *m)
{
  const size_t n = (size_t)m->n;
  m->K = DVI_NEW(double, n *n);
  m->M = DVI_NEW(double, n *n);
  m->X = DVI_NEW(double, n *n);
  m->lambda = DVI_NEW(double, n);
  if (!m->K || !m->M || !m->X || !m->lambda) return no_memory(m);
  for (size_t e = 0; e < n; e++) m->M[e * n + e] = m->flow->M1[e];
  m->flow->strain->stiffness(m->flow, m->K);
  DVI_TRY(dvi__eigen_symmetric(m->n, m->K, m->M, m->lambda, m->X));
  while (m->statics < m->n && !(m->lambda[m->statics] > static_below * m->lambda[m->n - 1]))
    m->statics++;
  m->r = m->n - m->statics;
  m->size = m->r + (m->flow->has_losses ? m->n : m->r);
  return DVI_OK;
}

/* Give the number of the i-th mode, static ones last. */
static int mode(const modal *m, int i)
{
  return (m->statics + i) % m->n;
}

/* ---- the matrix ---- */

static void begin_column(const modal *m, int j)
{
  const dvi__flow *flow = m->flow;
  const int i = mode(m, j < m->r ? j : j - m->r);
  const double *x = m->X + (size_t)i * (size_t)m->n, omega = sqrt(m->lambda[i]);
  memset(flow->A, 0, (size_t)m->n * sizeof(double));
  memset(flow->D, 0, (size_t)m->n * sizeof(double));
  for (int e = 0; e < m->n && j < m->r; e++) flow->A[e] = x[e] / omega;
  for (int e = 0; e < m->n && j >= m->r; e++) flow->D[e] = flow->M1[e] * x[e];
}

static void end_column(const modal *m, int j)
{
  const dvi__flow *flow = m->flow;
  double *column = m->T + (size_t)j * (size_t)m->size;
  for (int i = 0; i < m->size - m->r; i++) {
    const double *x = m->X + (size_t)mode(m, i) * (size_t)m->n;
    double a = 0, d = 0;
    for (int e = 0; e < m->n; e++) {
      a += x[e] * flow->M1[e] * flow->A[e];
      d += x[e] * flow->D[e];
    }
    if (i < m->r) column[i] = sqrt(m->lambda[mode(m, i)]) * a;
    column[m->r + i] = d;
  }
}

static double norm_of(const modal *m)
{
  double sum = 0;
  for (size_t i = 0; i < (size_t)m->size * (size_t)m->size; i++) sum += m->T[i] * m->T[i];
  return sqrt(sum);
}

static dvi_status make_matrix(modal *m, double period)
{
  const size_t size = (size_t)m->size;
  m->T = DVI_NEW(double, size *size);
  m->product = DVI_NEW(double, size *size);
  if (m->T == NULL || m->product == NULL) return no_memory(m);
  for (int j = 0; j < m->size; j++) {
    begin_column(m, j);
    DVI_TRY(m->flow->carry(m->flow->of, period));
    end_column(m, j);
  }
  return dvi__check_size(norm_of(m), period);
}

static void square(modal *m)
{
  const size_t size = (size_t)m->size;
  memset(m->product, 0, size * size * sizeof(double));
  for (size_t j = 0; j < size; j++)
    for (size_t k = 0; k < size; k++) {
      const double factor = m->T[j * size + k], *column = m->T + k * size;
      double *sum = m->product + j * size;
      for (size_t i = 0; i < size; i++) sum[i] += factor * column[i];
    }
  double *const old = m->T;
  m->T = m->product;
  m->product = old;
}

/* Take squares until the time is that of the slowest mode, unless something grows before. */
static void take_squares(modal *m, double *span)
{
  const double slowest = 6.2831853071795865 / sqrt(m->lambda[m->statics]), start = norm_of(m);
  for (int i = 0; i < SQUARES_MOST; i++) {
    if (norm_of(m) > grown * start || (i >= SQUARES_LEAST && *span >= slowest)) return;
    square(m);
    *span *= 2;
  }
}

static dvi_status find_largest(const modal *m, double *largest)
{
  const int size = m->size;
  double *real = DVI_NEW(double, 2 * size), *imaginary = real != NULL ? real + size : NULL;
  if (real == NULL) return no_memory(m);
  const dvi_status status = dvi__eigenvalues(size, m->T, size, real, imaginary, NULL);
  *largest = 0;
  for (int i = 0; i < size && status == DVI_OK; i++)
    *largest = fmax(*largest, hypot(real[i], imaginary[i]));
  dvi__release(real);
  return status;
}

dvi_status dvi__all_multipliers(const dvi__flow *flow, double period, dvi_stability *report)
{
  modal m = {.flow = flow, .n = (int)flow->n};
  double largest = 0;
  report->span = period;
  dvi_status status = find_modes(&m);
  if (status == DVI_OK) status = make_matrix(&m, period);
  if (status == DVI_OK) {
    take_squares(&m, &report->span);
    status = find_largest(&m, &largest);
  }
  if (status == DVI_OK) {
    report->growth = exp(fmax(log(largest), 0) / report->span);
    report->followed = m.size;
    report->resolution = threshold * sqrt(m.lambda[m.statics]) / 6.2831853071795865;
  }
  clear(&m);
  return status;
}
