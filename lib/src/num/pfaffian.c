/* Elimination by pivots of two rows and columns, which leaves the rest skew-symmetric. Rows and
 * columns are exchanged together, for the largest pivot of the current row. Source: Parlett and
 * Reid 1970; Wimmer 2012, arXiv:1102.3440. */
#include "num/pfaffian.h"

#include <math.h>

static void exchange_rows_and_columns(size_t n, double *A, size_t i, size_t j)
{
  for (size_t k = 0; k < n; k++) {
    const double kept = A[i * n + k];
    A[i * n + k] = A[j * n + k];
    A[j * n + k] = kept;
  }
  for (size_t k = 0; k < n; k++) {
    const double kept = A[k * n + i];
    A[k * n + i] = A[k * n + j];
    A[k * n + j] = kept;
  }
}

static size_t largest_of_row(size_t n, const double *A, size_t k)
{
  size_t largest = k + 1;
  for (size_t j = k + 2; j < n; j++)
    if (fabs(A[k * n + j]) > fabs(A[k * n + largest])) largest = j;
  return largest;
}

int dvi__pfaffian_sign(size_t n, double *A)
{
  int sign = 1;
  for (size_t k = 0; k < n; k += 2) {
    const size_t other = largest_of_row(n, A, k);
    const double pivot = A[k * n + other], *row = A + k * n, *next = row + n;
    if (pivot == 0) return 0;
    if (other != k + 1) exchange_rows_and_columns(n, A, k + 1, other);
    sign *= (pivot > 0) == (other == k + 1) ? 1 : -1;
    for (size_t i = k + 2; i < n; i++)
      for (size_t j = k + 2; j < n; j++)
        A[i * n + j] += (next[i] * row[j] - row[i] * next[j]) / pivot;
  }
  return sign;
}
