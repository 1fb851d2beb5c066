#include "num/simd/small_inverse.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "num/simd/wide.h"
#include "num/simd/width.h"

enum { BLOCK = 4, MOST = DVI__SMALL_INVERSE_MOST, MOST_NEAR_ONE = DVI__NEAR_ONE_MOST };

/* Pivots of a matrix near 1 are near 1. */
static const double least_pivot = 1.0 / 16, largest_pivot = 16;

typedef double block __attribute__((vector_size(BLOCK * sizeof(double)), aligned(8), may_alias));

static void exchange(int count, int stride, double *a, double *b)
{
  for (int i = 0; i < count * stride; i += stride) {
    const double kept = a[i];
    a[i] = b[i];
    b[i] = kept;
  }
}

/* Find the column from k on whose entry in row k is largest. */
static int largest_column(int n, int k, const double *A)
{
  int column = k;
  for (int j = k + 1; j < n; j++)
    if (fabs(A[j * n + k]) > fabs(A[column * n + k])) column = j;
  return column;
}

INLINE void subtract_multiple(int n, double factor, const double *restrict x, double *restrict y)
{
  for (int i = 0; i < n; i++) y[i] -= factor * x[i];
}

/* Replace column k by that of the inverse, and take it out of all others. The entries of row k are
 * stored last, because a vector that is loaded after one of its numbers is stored waits. */
INLINE void eliminate_row(int n, int k, double *A)
{
  double *column = A + k * n;
  const double inverse = 1 / column[k];
  for (int i = 0; i < n; i++) column[i] *= inverse;
  column[k] = inverse;
  for (int j = 0; j < n; j++) {
    double *other = A + j * n;
    const double factor = other[k];
    if (j == k) continue;
    subtract_multiple(n, factor, column, other);
    other[k] = 0 - factor * inverse;
  }
}

WIDE static int small_invert(int n, double *A)
{
  int from[MOST], sign = 1;
  for (int k = 0; k < n; k++) {
    const int column = from[k] = largest_column(n, k, A);
    if (column != k) exchange(n, 1, A + k * n, A + column * n);
    const double pivot = A[k * n + k];
    if (!(fabs(pivot) >= DBL_MIN) || isinf(pivot)) return 0;
    if ((column != k) ^ (pivot < 0)) sign = -sign;
    eliminate_row(n, k, A);
  }
  for (int k = n; k-- > 0;)
    if (from[k] != k) exchange(n, n, A + k, A + from[k]);
  return sign;
}

int dvi__small_invert(int n, double *A)
{
  return small_invert(n, A);
}

int dvi__near_one_stride(int n)
{
  return (n + BLOCK - 1) / BLOCK * BLOCK;
}

static const block unit[BLOCK] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

/* Subtract a multiple of a column, and of another one unless it is NULL. */
INLINE void subtract(const int blocks, const block *x, double factor, const block *other,
                     double other_factor, block *y)
{
  for (int i = 0; i < blocks; i++) {
    block sum = y[i] - factor * x[i];
    if (other != NULL) sum -= other_factor * other[i];
    y[i] = sum;
  }
}

/* Divide column k by its pivot, and add the inverse of the pivot there. A multiple of the column
 * then leaves -factor/pivot of the factor in row k. Returns 0 if the pivot is far from 1. */
INLINE int divide_column(int k, const int blocks, block *column)
{
  const double pivot = ((const double *)column)[k], by = 1 / pivot;
  if (!(pivot > least_pivot && pivot < largest_pivot)) return 0;
  for (int i = 0; i < blocks; i++) column[i] *= by;
  column[k / BLOCK] += by * unit[k % BLOCK];
  return 1;
}

/* Leave the inverse of the pivot alone. */
INLINE void settle_column(int k, block *column)
{
  column[k / BLOCK] -= unit[k % BLOCK];
}

/* Eliminate rows k and k + 1 from all columns, in one pass. */
INLINE int eliminate_two(int n, int k, const int blocks, double *A)
{
  block *one = (block *)(A + k * blocks * BLOCK), *two = one + blocks;
  if (!divide_column(k, blocks, one)) return 0;
  subtract(blocks, one, ((const double *)two)[k], NULL, 0, two);
  if (!divide_column(k + 1, blocks, two)) return 0;
  const double both = ((const double *)one)[k + 1];
  for (int j = 0; j < n; j++) {
    block *y = (block *)(A + j * blocks * BLOCK);
    const double factor = ((const double *)y)[k];
    if (j == k || j == k + 1) continue;
    subtract(blocks, one, factor, two, ((const double *)y)[k + 1] - factor * both, y);
  }
  settle_column(k, one);
  subtract(blocks, two, both, NULL, 0, one);
  settle_column(k + 1, two);
  return 1;
}

INLINE int eliminate_last(int n, const int blocks, double *A)
{
  block *last = (block *)(A + (n - 1) * blocks * BLOCK);
  if (!divide_column(n - 1, blocks, last)) return 0;
  for (int j = 0; j < n - 1; j++) {
    block *y = (block *)(A + j * blocks * BLOCK);
    subtract(blocks, last, ((const double *)y)[n - 1], NULL, 0, y);
  }
  settle_column(n - 1, last);
  return 1;
}

/* Invert the matrix of columns of `blocks` blocks. */
INLINE int invert_near_one(int n, const int blocks, double *A)
{
  for (int k = 0; k + 1 < n; k += 2)
    if (!eliminate_two(n, k, blocks, A)) return 0;
  return n % 2 == 0 || eliminate_last(n, blocks, A);
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
  default: return invert_near_one(n, MOST_NEAR_ONE / BLOCK, A);
  }
}

int dvi__near_one_invert(int n, double *A)
{
  return near_one_invert(n, A);
}

WIDE static void near_one_times(int n, const double *inverse, double *x)
{
  const int stride = dvi__near_one_stride(n);
  double y[MOST_NEAR_ONE];
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

/* ---- of several members ---- */

/* The sums with 0 are those of divide_column, by which a zero may lose its sign. */
INLINE void divide_abreast(int n, int k, dvi__abreast *column, int *regular)
{
  const int first = k / BLOCK * BLOCK, end = first + BLOCK < n ? first + BLOCK : n;
  const dvi__abreast pivot = column[k], by = 1 / pivot;
  for (int lane = 0; lane < DVI__ABREAST; lane++)
    regular[lane] &= (pivot[lane] > least_pivot) & (pivot[lane] < largest_pivot);
  for (int i = 0; i < n; i++) column[i] *= by;
  for (int i = first; i < end; i++) column[i] += by * (i == k ? 1.0 : 0.0);
}

INLINE void subtract_abreast(int n, const dvi__abreast *x, const dvi__abreast *factor,
                             dvi__abreast *y)
{
  for (int i = 0; i < n; i++) y[i] -= *factor * x[i];
}

/* Eliminate two rows from two columns in one pass, which loads the divided columns once. */
INLINE void eliminate_from_pair(int n, int k, const dvi__abreast *one, const dvi__abreast *two,
                                dvi__abreast *y)
{
  const dvi__abreast both = one[k + 1], *z = y + n, y_one = y[k], z_one = z[k],
                     y_two = y[k + 1] - y_one * both, z_two = z[k + 1] - z_one * both;
  for (int i = 0; i < n; i++) {
    y[i] = (y[i] - y_one * one[i]) - y_two * two[i];
    y[n + i] = (z[i] - z_one * one[i]) - z_two * two[i];
  }
}

INLINE void eliminate_two_abreast(int n, int k, dvi__abreast *A, int *regular)
{
  dvi__abreast *one = A + k * n, *two = one + n;
  const dvi__abreast below = two[k];
  divide_abreast(n, k, one, regular);
  subtract_abreast(n, one, &below, two);
  divide_abreast(n, k + 1, two, regular);
  const dvi__abreast both = one[k + 1];
  for (int j = 0; j < n; j += 2)
    if (j != k) eliminate_from_pair(n, k, one, two, A + j * n);
  one[k] -= 1;
  subtract_abreast(n, two, &both, one);
  two[k + 1] -= 1;
}

WIDE static void near_one_invert_abreast(int n, dvi__abreast *A, int *regular)
{
  for (int k = 0; k < n; k += 2) eliminate_two_abreast(n, k, A, regular);
}

void dvi__near_one_invert_abreast(int n, dvi__abreast *A, int regular[DVI__ABREAST])
{
  near_one_invert_abreast(n, A, regular);
}
