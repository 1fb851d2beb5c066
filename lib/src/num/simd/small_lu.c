#include "num/simd/small_lu.h"

#include <math.h>
#include <string.h>

#include "num/simd/wide.h"
#include "num/simd/width.h"

enum { BLOCK = DVI__SMALL_LU_BLOCK, MOST = DVI__SMALL_LU_MOST };

int dvi__small_lu_stride(int n)
{
  return (n + BLOCK - 1) / BLOCK * BLOCK;
}

typedef double block __attribute__((vector_size(BLOCK * sizeof(double))));

/* Subtract factor x from y in the blocks from `first` to `end`. */
INLINE void subtract(int first, int end, double factor, const double *x, double *y)
{
  for (int i = first; i < end; i += BLOCK) {
    block a, b;
    memcpy(&a, x + i, sizeof a);
    memcpy(&b, y + i, sizeof b);
    b -= factor * a;
    memcpy(y + i, &b, sizeof b);
  }
}

/* Subtract four columns, one after the other, times their factors. The first one is `column`, and
 * the next ones are `step` numbers apart. */
INLINE void subtract_four(int first, int end, int step, const double *column, const block *factor,
                          double *y)
{
  for (int i = first; i < end; i += BLOCK) {
    block sum;
    memcpy(&sum, y + i, sizeof sum);
    for (int k = 0; k < BLOCK; k++) {
      block x;
      memcpy(&x, column + k * step + i, sizeof x);
      sum -= (*factor)[k] * x;
    }
    memcpy(y + i, &sum, sizeof sum);
  }
}

/* Replace four numbers from `at` on by those of L^-1, and subtract them from the ones behind. */
INLINE void eliminate_four(const dvi__small_lu *lu, int at, double *x)
{
  const int stride = lu->stride;
  const double *L = lu->lower + at * stride + at;
  block y;
  memcpy(&y, x + at, sizeof y);
  y[1] -= L[1] * y[0];
  y[2] = (y[2] - L[2] * y[0]) - L[stride + 2] * y[1];
  y[3] = ((y[3] - L[3] * y[0]) - L[stride + 3] * y[1]) - L[2 * stride + 3] * y[2];
  memcpy(x + at, &y, sizeof y);
  subtract_four(at + BLOCK, stride, stride, lu->lower + at * stride, &y, x);
}

/* Solve with U. */
INLINE void solve_upper(const dvi__small_lu *lu, double *x)
{
  const int stride = lu->stride;
  for (int at = stride - BLOCK; at >= 0; at -= BLOCK) {
    const double *U = lu->upper + at * stride + at, *diagonal = lu->diagonal + at;
    block y, reversed;
    memcpy(&y, x + at, sizeof y);
    y[3] /= diagonal[3];
    y[2] = (y[2] - U[3 * stride + 2] * y[3]) / diagonal[2];
    y[1] = ((y[1] - U[3 * stride + 1] * y[3]) - U[2 * stride + 1] * y[2]) / diagonal[1];
    y[0] = (((y[0] - U[3 * stride] * y[3]) - U[2 * stride] * y[2]) - U[stride] * y[1]) /
           diagonal[0];
    memcpy(x + at, &y, sizeof y);
    for (int k = 0; k < BLOCK; k++) reversed[k] = y[BLOCK - 1 - k];
    subtract_four(0, at, -stride, lu->upper + (at + BLOCK - 1) * stride, &reversed, x);
  }
}

static int row_of_pivot(int n, int k, const double *column)
{
  int at = k;
  for (int i = k + 1; i < n; i++)
    if (fabs(column[i]) > fabs(column[at])) at = i;
  return at;
}

/* Exchange two numbers of each of some columns. */
INLINE void exchange(int columns, int stride, double *one, double *other)
{
  for (int j = 0; j < columns; j++, one += stride, other += stride) {
    const double kept = *one;
    *one = *other;
    *other = kept;
  }
}

/* Exchange two rows of L and of the columns that are not done. */
static void exchange_rows(const dvi__small_lu *lu, int k, int with)
{
  const int stride = lu->stride;
  double *rest = lu->upper + k * stride;
  exchange(k, stride, lu->lower + k, lu->lower + with);
  exchange(lu->n - k, stride, rest + k, rest + with);
}

/* Make column k one of L and one of U, and subtract it from those behind it, up to `end`. Gives the
 * pivot. */
INLINE double factor_column(const dvi__small_lu *lu, int k, int end)
{
  const int n = lu->n, stride = lu->stride, first = k / BLOCK * BLOCK;
  double *column = lu->upper + k * stride, *lower = lu->lower + k * stride;
  lu->pivot[k] = row_of_pivot(n, k, column);
  if (lu->pivot[k] != k) exchange_rows(lu, k, lu->pivot[k]);
  const double pivot = column[k], inverse = 1 / pivot;
  lu->diagonal[k] = pivot;
  for (int i = first; i < stride; i++) lower[i] = column[i] * inverse;
  for (int i = first; i <= k; i++) lower[i] = 0;
  for (int i = k; i < stride; i++) column[i] = 0;
  for (int j = k + 1; j < end; j++)
    subtract(first, stride, lu->upper[j * stride + k], lower, lu->upper + j * stride);
  return pivot;
}

/* Four columns at a time are subtracted from those behind. */
WIDE static double small_lu_factor(const dvi__small_lu *lu)
{
  const int n = lu->n;
  double least = HUGE_VAL, most = 0;
  for (int at = 0; at < n; at += BLOCK) {
    const int end = at + BLOCK < n ? at + BLOCK : n;
    for (int k = at; k < end; k++) {
      const double size = fabs(factor_column(lu, k, end));
      if (!(size > 0)) return 0;
      least = size < least ? size : least;
      most = size > most ? size : most;
    }
    for (int j = end; j < n; j++) eliminate_four(lu, at, lu->upper + j * lu->stride);
  }
  for (int k = n; k < lu->stride; k++) lu->diagonal[k] = 1;
  return least / most;
}

double dvi__small_lu_factor(const dvi__small_lu *lu)
{
  return small_lu_factor(lu);
}

WIDE static void small_lu_solve(const dvi__small_lu *lu, double *b)
{
  const int n = lu->n, stride = lu->stride;
  double x[MOST];
  memcpy(x, b, (size_t)n * sizeof *b);
  memset(x + n, 0, (size_t)(stride - n) * sizeof *b);
  for (int k = 0; k < n; k++) {
    const double kept = x[lu->pivot[k]];
    x[lu->pivot[k]] = x[k];
    x[k] = kept;
  }
  for (int at = 0; at < stride; at += BLOCK) eliminate_four(lu, at, x);
  solve_upper(lu, x);
  memcpy(b, x, (size_t)n * sizeof *b);
}

void dvi__small_lu_solve(const dvi__small_lu *lu, double *b)
{
  small_lu_solve(lu, b);
}
