/* The lowest modes of H for fourier, by products alone.
 *
 * LOBPCG: X holds approximate modes, W their residuals H x - theta x divided by T + c, which is
 * near H, and P the last changes of X. Rayleigh and Ritz's method on the span of all three, made
 * orthonormal, gives the next X. Some more modes than asked for let the last ones converge as fast
 * as the others. Source: Knyazev 2001. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/algebra/vectors.h"
#include "field/schroedinger/schroedinger.h"
#include "num/eigen.h"

enum { ITERATIONS = 1000, MORE = 4, BLOCKS = 3 };

/* Residuals are as small as this beside an energy above the potential's minimum. Energies are then
 * as good as the square of it. */
static const double tolerance = 1e-11;

typedef struct span {
  const dvi_schroedinger *s;
  int64_t n;
  int width, columns;   /* of a block, and of the basis now */
  double *block;        /* [3][width][n] X, W and P */
  double *basis, *HB;   /* [3*width][n] orthonormal, and H of it */
  double *H, *unit, *Y; /* [(3*width)^2] full matrices of the span, by columns */
  double *theta;        /* [3*width] */
  double least;         /* of the potential */
  dvi__schroedinger_room room;
} span;

/* Append x, made orthogonal to the basis twice, unless little is left of it. */
static void append(span *b, const double *x)
{
  double *y = b->basis + b->columns * b->n;
  const double before = sqrt(dvi__dot(b->n, x, x));
  memcpy(y, x, (size_t)b->n * sizeof *y);
  for (int twice = 0; twice < 2; twice++)
    for (int j = 0; j < b->columns; j++) {
      const double *q = b->basis + j * b->n, part = dvi__dot(b->n, q, y);
      for (int64_t i = 0; i < b->n; i++) y[i] -= part * q[i];
    }
  const double size = sqrt(dvi__dot(b->n, y, y));
  if (!(size > 1e-8 * before)) return;
  for (int64_t i = 0; i < b->n; i++) y[i] /= size;
  dvi__schroedinger_act(b->s, b->s->still, 0, 1, y, b->HB + b->columns * b->n, &b->room);
  b->columns++;
}

/* Find the modes of H in the span of the basis. */
static dvi_status project(span *b)
{
  const int m = b->columns;
  memset(b->unit, 0, (size_t)(m * m) * sizeof *b->unit);
  for (int j = 0; j < m; j++) {
    b->unit[j * (m + 1)] = 1;
    for (int i = 0; i < m; i++)
      b->H[j * m + i] = 0.5 * (dvi__dot(b->n, b->basis + i * b->n, b->HB + j * b->n) +
                               dvi__dot(b->n, b->basis + j * b->n, b->HB + i * b->n));
  }
  return dvi__eigen_symmetric(m, b->H, b->unit, b->theta, b->Y);
}

/* to = sum of y_j from_j over the columns from `first` on. */
static void combine(const span *b, int first, const double *from, const double *y, double *to)
{
  memset(to, 0, (size_t)b->n * sizeof *to);
  for (int j = first; j < b->columns; j++)
    for (int64_t i = 0; i < b->n; i++) to[i] += y[j] * from[j * b->n + i];
}

/* Give the blocks X, W and P of the span's modes. Returns the largest residual of the first `count`
 * ones beside the energy of the last one. */
static double renew(span *b, int count)
{
  const double scale = b->theta[b->width - 1] - b->least;
  double worst = 0;
  for (int j = 0; j < b->width; j++) {
    const double *y = b->Y + j * b->columns, energy = fmax(b->theta[j] - b->least, 0.01 * scale);
    double *x = b->block + j * b->n, *w = x + b->width * b->n, *p = w + b->width * b->n;
    combine(b, 0, b->basis, y, x);
    combine(b, b->width, b->basis, y, p);
    combine(b, 0, b->HB, y, w);
    for (int64_t i = 0; i < b->n; i++) w[i] -= b->theta[j] * x[i];
    if (j < count) worst = fmax(worst, sqrt(dvi__dot(b->n, w, w)) / scale);
    for (int64_t i = 0; i < b->n; i++) w[i] /= b->s->diagonal[i] + energy;
  }
  return worst;
}

static dvi_status iterate(span *b, int count)
{
  double worst = 0;
  for (int i = 0; i < ITERATIONS; i++) {
    const int blocks = i < BLOCKS - 1 ? i + 1 : BLOCKS; /* W and P come one after the other */
    b->columns = 0;
    for (int j = 0; j < blocks * b->width; j++) append(b, b->block + j * b->n);
    DVI_TRY(project(b));
    worst = renew(b, count);
    if (worst <= tolerance) return DVI_OK;
  }
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "schroedinger: %d stationary states have residuals of %g of their energies after "
      "%d iterations",
      count, worst, ITERATIONS);
}

static dvi_status allocate(span *b)
{
  const int64_t most = (int64_t)BLOCKS * b->width;
  b->block = DVI_NEW(double, 3 * most * b->n);
  b->H = DVI_NEW(double, 3 * most * most + most);
  if (b->block == NULL || b->H == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld states", (long long)most);
  b->basis = b->block + most * b->n;
  b->HB = b->basis + most * b->n;
  b->unit = b->H + most * most;
  b->Y = b->unit + most * most;
  b->theta = b->Y + most * most;
  return dvi__schroedinger_make_room(b->s, &b->room);
}

/* Begin at random, but smooth. */
static void begin(span *b)
{
  (void)dvi__fill_random(b->width * b->n, 20221, b->block);
  for (int j = 0; j < b->width; j++)
    for (int64_t i = 0; i < b->n; i++)
      b->block[j * b->n + i] /= 1 + b->s->diagonal[i] * b->s->diagonal[i];
  b->least = INFINITY;
  for (int64_t k = 0; k < b->s->points; k++) b->least = fmin(b->least, b->s->still[k]);
}

dvi_status dvi__schroedinger_iterate_modes(const dvi_schroedinger *s, int count, double *energy,
                                           double *z)
{
  const int64_t most = s->free / BLOCKS;
  span b = {.s = s, .n = s->free, .width = count + MORE < most ? count + MORE : (int)most};
  if (count > b.width)
    return dvi__fail(DVI_BAD_SIZE,
                     "schroedinger: %d stationary states of %lld functions; for fourier with so "
                     "many, 1 to %lld can be found",
                     count, (long long)s->free, (long long)most);
  dvi_status status = allocate(&b);
  if (status == DVI_OK) {
    begin(&b);
    status = iterate(&b, count);
  }
  if (status == DVI_OK) {
    memcpy(energy, b.theta, (size_t)count * sizeof *energy);
    memcpy(z, b.block, (size_t)(count * b.n) * sizeof *z);
  }
  dvi__schroedinger_clear_room(&b.room);
  dvi__release(b.block);
  dvi__release(b.H);
  return status;
}
