#include "mechanics/quad.h"

#include <math.h>

#ifdef QUAD_EXISTS
double quad_largest(int n, const quad *x)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs((double)x[i]));
  return size;
}

double quad_distance(int n, const quad *a, const quad *b)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs((double)(a[i] - b[i])));
  return size;
}

static void quad_exchange_rows(int n, quad *a, quad *b)
{
  for (int j = 0; j < n; j++) {
    const quad kept = a[j];
    a[j] = b[j];
    b[j] = kept;
  }
}

static void quad_subtract_row(int n, quad factor, const quad *from, quad *row)
{
  for (int j = 0; j < n; j++) row[j] -= factor * from[j];
}

static int quad_pivot_row(int n, const quad *A, int column)
{
  int pivot = column;
  for (int i = column + 1; i < n; i++)
    if (fabs((double)A[i * n + column]) > fabs((double)A[pivot * n + column])) pivot = i;
  return pivot;
}

/* Invert by Gauss-Jordan elimination. The operations that reduce A to the identity turn the
 * identity into the inverse. */
bool quad_invert(int n, quad *A, quad *inverse)
{
  for (int i = 0; i < n * n; i++) inverse[i] = i % (n + 1) == 0 ? 1 : 0;
  for (int c = 0; c < n; c++) {
    const int pivot = quad_pivot_row(n, A, c);
    const quad divisor = A[pivot * n + c];
    if (!(fabs((double)divisor) > 0.0)) return false;
    if (pivot != c)
      quad_exchange_rows(n, A + c * n, A + pivot * n),
          quad_exchange_rows(n, inverse + c * n, inverse + pivot * n);
    for (int j = 0; j < n; j++) A[c * n + j] /= divisor, inverse[c * n + j] /= divisor;
    for (int i = 0; i < n; i++) {
      const quad factor = A[i * n + c];
      if (i != c)
        quad_subtract_row(n, factor, A + c * n, A + i * n),
            quad_subtract_row(n, factor, inverse + c * n, inverse + i * n);
    }
  }
  return true;
}
#endif
