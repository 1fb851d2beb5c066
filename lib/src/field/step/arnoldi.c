/* Arnoldi's method for the monodromy matrix P of some periods, in the scalar product of the energy,
 *
 *     <x, y> = B_x.M2 B_y + D_x.M1^-1 D_y,     P q_j = sum over i <= j+1 of h_ij q_i,
 *
 * for which P is close to an orthogonal matrix without dampings. An eigenvalue theta of h with the
 * vector y belongs to an eigenvalue of P up to h_{m+1,m} |y_m| (Saad 2011, prop. 6.8). The start
 * has been carried through some periods, in which the fastest growing fields come forth. B stands
 * for A, whose static part has no energy, and would be all that is left where dampings take the
 * energy away. Solids have their displacements without rigid motions in place of B, and their
 * stiffness in that of M2. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/step/growth.h"
#include "num/eigen.h"

enum { DIRECTIONS = 40, PERIODS_BEFORE = 40 };

/* An eigenvalue counts if it is settled to this part of its distance from the circle. */
static const double settled = 0.1;

typedef struct arnoldi {
  const dvi__flow *flow;
  int64_t n;                            /* strains and D */
  double *q;                            /* [DIRECTIONS+1][n] the directions */
  double *image;                        /* [n] M2 B and M1^-1 D of the new one */
  double h[DIRECTIONS][DIRECTIONS + 1]; /* by columns */
} arnoldi;

static double *direction(const arnoldi *s, int j)
{
  return s->q + j * s->n;
}

static double dot(int64_t n, const double *x, const double *y)
{
  double sum = 0;
  for (int64_t i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* Make the image of a direction. Returns its length. */
static double weigh(const arnoldi *s, const double *q)
{
  const dvi__flow *flow = s->flow;
  const int64_t strains = flow->strains;
  flow->strain->weigh(flow, q, s->image);
  for (int64_t e = 0; e < flow->n; e++) s->image[strains + e] = flow->inverse[e] * q[strains + e];
  const double square = dot(s->n, q, s->image);
  return square < 0 ? 0 : sqrt(square); /* squares of rigid motions are roundings */
}

static dvi_status carry(const arnoldi *s, const double *from, double time, double *to)
{
  const dvi__flow *flow = s->flow;
  flow->strain->put(flow, from);
  memcpy(flow->D, from + flow->strains, (size_t)flow->n * sizeof(double));
  DVI_TRY(flow->carry(flow->of, time));
  flow->strain->take(flow, to);
  memcpy(to + flow->strains, flow->D, (size_t)flow->n * sizeof(double));
  return DVI_OK;
}

static void scale(const arnoldi *s, double *q, double factor)
{
  for (int64_t i = 0; i < s->n; i++) q[i] *= factor;
}

/* Take away from the direction j + 1, which is weighed, what it has of the others, twice for the
 * roundings. */
static double orthogonalise(arnoldi *s, int j)
{
  double *next = direction(s, j + 1), length = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i <= j; i++) {
      const double *q = direction(s, i), part = dot(s->n, q, s->image);
      s->h[j][i] += part;
      for (int64_t k = 0; k < s->n; k++) next[k] -= part * q[k];
    }
    length = weigh(s, next);
  }
  return length;
}

/* Returns the number of directions, which is smaller if they are exhausted. */
static dvi_status iterate(arnoldi *s, double time, int *directions)
{
  for (int j = 0; j < DIRECTIONS; j++) {
    *directions = j + 1;
    DVI_TRY(carry(s, direction(s, j), time, direction(s, j + 1)));
    const double before = weigh(s, direction(s, j + 1));
    const double length = orthogonalise(s, j);
    DVI_TRY(dvi__check_size(before + length, time));
    s->h[j][j + 1] = length;
    if (!(length > 1e-12 * before)) {
      s->h[j][j + 1] = 0;
      return DVI_OK;
    }
    scale(s, direction(s, j + 1), 1 / length);
  }
  return DVI_OK;
}

static dvi_status begin(arnoldi *s, double time)
{
  double *first = direction(s, 0);
  const dvi__flow *flow = s->flow;
  flow->strain->scatter(flow);
  flow->strain->take(flow, first);
  memcpy(first + flow->strains, flow->D, (size_t)flow->n * sizeof(double));
  for (int i = 0; i < PERIODS_BEFORE; i++) {
    DVI_TRY(carry(s, first, time, first));
    const double length = weigh(s, first);
    DVI_TRY(dvi__check_size(length, time));
    if (length == 0) return DVI_OK; /* dampings left nothing, which stays so */
    scale(s, first, 1 / length);
  }
  return DVI_OK;
}

/* The largest eigenvalue outside of the circle that is settled, or 1. */
static dvi_status find_largest(arnoldi *s, int m, double *largest)
{
  double real[DIRECTIONS], imaginary[DIRECTIONS], last[DIRECTIONS];
  const double next = s->h[m - 1][m];
  *largest = 1;
  DVI_TRY(dvi__eigenvalues(m, s->h[0], DIRECTIONS + 1, real, imaginary, last));
  for (int i = 0; i < m; i++) {
    const double size = hypot(real[i], imaginary[i]);
    if (size > *largest && next * last[i] < settled * (size - 1)) *largest = size;
  }
  return DVI_OK;
}

static dvi_status search(arnoldi *s, double period, double span, dvi_stability *report)
{
  int directions;
  double largest;
  const double time = period * ceil(span / (DIRECTIONS + PERIODS_BEFORE) / period);
  DVI_TRY(begin(s, time));
  DVI_TRY(iterate(s, time, &directions));
  DVI_TRY(find_largest(s, directions, &largest));
  report->growth = exp(log(largest) / time);
  report->span = time * (PERIODS_BEFORE + directions);
  report->followed = directions;
  report->resolution = 0.5 * log(2.0 * (double)s->flow->n) / report->span;
  return DVI_OK;
}

dvi_status dvi__largest_multipliers(const dvi__flow *flow, double period, double span,
                                    dvi_stability *report)
{
  arnoldi *s = DVI_NEW(arnoldi, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "stability: no memory");
  s->flow = flow;
  s->n = flow->strains + flow->n;
  s->q = DVI_NEW(double, (DIRECTIONS + 1) * s->n);
  s->image = DVI_NEW(double, s->n);
  const dvi_status status = s->q != NULL && s->image != NULL
                                ? search(s, period, span, report)
                                : dvi__fail(DVI_NO_MEMORY, "stability: no memory for %d fields",
                                            DIRECTIONS);
  dvi__release(s->q);
  dvi__release(s->image);
  dvi__release(s);
  return status;
}
