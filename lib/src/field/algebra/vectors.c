#include "field/algebra/vectors.h"

#include <math.h>
#include <stddef.h>

double dvi__dot(int64_t n, const double *x, const double *y)
{
  double sum[4] = {0, 0, 0, 0};
  int64_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (int j = 0; j < 4; j++) sum[j] += x[i + j] * y[i + j];
  for (; i < n; i++) sum[0] += x[i] * y[i];
  return sum[0] + sum[1] + (sum[2] + sum[3]);
}

void dvi__choose_sign(int64_t n, double *x)
{
  double most = 0;
  int64_t first = 0;
  for (int64_t i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  while (first < n - 1 && fabs(x[first]) < 0.5 * most) first++;
  if (x[first] >= 0) return;
  for (int64_t i = 0; i < n; i++) x[i] = -x[i];
}

static void swap(int64_t n, double *a, double *b)
{
  for (int64_t i = 0; i < n; i++) {
    const double kept = a[i];
    a[i] = b[i];
    b[i] = kept;
  }
}

void dvi__sort_modes(int64_t n, int count, double *eigenvalue, double *vector)
{
  for (int i = 0; i < count; i++) {
    int least = i;
    for (int j = i + 1; j < count; j++)
      if (eigenvalue[j] < eigenvalue[least]) least = j;
    if (least == i) continue;
    swap(1, eigenvalue + i, eigenvalue + least);
    if (vector != NULL) swap(n, vector + i * n, vector + least * n);
  }
}
