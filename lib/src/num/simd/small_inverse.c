#include "num/simd/small_inverse.h"

#include <math.h>
#include <string.h>

#include "num/simd/wide.h"
#include "num/simd/width.h"

enum { BLOCK = 4, MOST = DVI__SMALL_INVERSE_MOST };

/* Pivots of a matrix near 1 are near 1. */
static const double least_pivot = 1.0 / 16, largest_pivot = 16;

typedef double block __attribute__((vector_size(BLOCK * sizeof(double)), aligned(8), may_alias));

static void exchange_columns(int n, double *x, double *y)
{
  for (int i = 0; i < n; i++) {
    const double kept = x[i];
    x[i] = y[i];
    y[i] = kept;
  }
}

int dvi__small_invert(int n, double *A)
{
  int from[MOST], sign = 1;
  for (int k = 0; k < n; k++) {
    double *column = A + k * n;
    from[k] = k;
    for (int j = k + 1; j < n; j++)
      if (fabs(A[j * n + k]) > fabs(A[from[k] * n + k])) from[k] = j;
    if (from[k] != k) exchange_columns(n, column, A + from[k] * n);
    const double pivot = column[k], by = 1 / pivot;
    if (!(fabs(pivot) > 0)) return 0;
    if ((from[k] != k) ^ (pivot < 0)) sign = -sign;
    column[k] = 1;
    for (int i = 0; i < n; i++) column[i] *= by;
    for (int j = 0; j < n; j++) {
      const double factor = A[j * n + k];
      if (j == k) continue;
      A[j * n + k] = 0;
      for (int i = 0; i < n; i++) A[j * n + i] -= factor * column[i];
    }
  }
  for (int k = n - 1; k >= 0; k--)
    for (int j = 0; j < n && from[k] != k; j++)
      exchange_columns(1, &A[j * n + k], &A[j * n + from[k]]);
  return sign;
}

int dvi__near_one_stride(int n)
{
  return (n + BLOCK - 1) / BLOCK * BLOCK;
}

/* Invert the matrix of columns of `blocks` blocks (Gauss and Jordan), without exchanges. Returns 0
 * if a pivot is far from 1. */
INLINE int invert_near_one(int n, const int blocks, double *A)
{
  for (int k = 0; k < n; k++) {
    double *column = A + k * blocks * BLOCK;
    const double pivot = column[k], by = 1 / pivot;
    if (!(pivot > least_pivot && pivot < largest_pivot)) return 0;
    for (int i = 0; i < blocks; i++) ((block *)column)[i] *= by;
    column[k] = 1 + by; /* leaves -factor * by of the factor in row k */
    for (int j = 0; j < n; j++) {
      double *other = A + j * blocks * BLOCK;
      const double factor = j != k ? other[k] : 0;
      for (int i = 0; i < blocks; i++) ((block *)other)[i] -= factor * ((const block *)column)[i];
    }
    column[k] = by;
  }
  return 1;
}

WIDE static int near_one_invert(int n, double *A)
{
  switch (dvi__near_one_stride(n) / BLOCK) {
  case 1: return invert_near_one(n, 1, A);
  case 2: return invert_near_one(n, 2, A);
  case 3: return invert_near_one(n, 3, A);
  case 4: return invert_near_one(n, 4, A);
  case 5: return invert_near_one(n, 5, A);
  case 6: return invert_near_one(n, 6, A);
  case 7: return invert_near_one(n, 7, A);
  default: return invert_near_one(n, MOST / BLOCK, A);
  }
}

int dvi__near_one_invert(int n, double *A)
{
  return near_one_invert(n, A);
}

WIDE static void near_one_times(int n, const double *inverse, double *x)
{
  const int stride = dvi__near_one_stride(n);
  double y[MOST];
  for (int at = 0; at < stride; at += BLOCK) {
    block sum = {0};
    for (int k = 0; k < n; k++) sum += x[k] * *(const block *)(inverse + k * stride + at);
    memcpy(y + at, &sum, sizeof sum);
  }
  memcpy(x, y, (size_t)n * sizeof *x);
}

void dvi__near_one_times(int n, const double *inverse, double *x)
{
  near_one_times(n, inverse, x);
}
