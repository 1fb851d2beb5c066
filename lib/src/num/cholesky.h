/* Cholesky's factor of small symmetric positive definite matrices, in long double, for tables that
 * are made once. */
#ifndef DVI_NUM_CHOLESKY_H
#define DVI_NUM_CHOLESKY_H
#include <math.h>

/* Factor K = C C^T. C replaces the lower triangle of K [n*n] by rows. The upper one is not read. */
static inline void dvi__cholesky(int n, long double *K)
{
  for (int k = 0; k < n; k++)
    for (int l = k; l < n; l++) {
      long double sum = K[l * n + k];
      for (int m = 0; m < k; m++) sum -= K[l * n + m] * K[k * n + m];
      K[l * n + k] = l == k ? sqrtl(sum) : sum / K[k * n + k];
    }
}

/* Replace x [n] by C^{-1} x. */
static inline void dvi__cholesky_half(int n, const long double *C, long double *x)
{
  for (int k = 0; k < n; k++) {
    for (int m = 0; m < k; m++) x[k] -= C[k * n + m] * x[m];
    x[k] /= C[k * n + k];
  }
}

#endif
