/* An independent judge in quadruple precision: every map here by the power series that defines it,
 * for matrices of up to 6 rows, stored row by row. Roundoff is 1e-34 times what the series cancels,
 * a factor 1e6 for three turns, so nothing is done against it. */
#ifndef TEST_GROUP_QUAD_H
#define TEST_GROUP_QUAD_H
#ifdef DVI_HAVE_QUADMATH
#include <quadmath.h>

typedef __float128 quad;

enum { QUAD_ROWS = 6, QUAD_SERIES = 120 };

/* Computes C = A B. C is another matrix. */
static inline void quad_multiply(int n, const quad *A, const quad *B, quad *C)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      C[n * i + j] = 0;
      for (int k = 0; k < n; k++) C[n * i + j] += A[n * i + k] * B[n * k + j];
    }
}

static inline quad quad_norm(int count, const quad *x)
{
  quad sum = 0;
  for (int i = 0; i < count; i++) sum += x[i] * x[i];
  return sqrtq(sum);
}

/* Sums A^j / (j + shift)! over j, which is the exponential for shift 0, and dexp for shift 1 and A
 * = ad. */
static inline void quad_series(int n, int shift, const quad *A, quad *sum)
{
  quad power[QUAD_ROWS * QUAD_ROWS], next[QUAD_ROWS * QUAD_ROWS];
  for (int i = 0; i < n * n; i++) sum[i] = power[i] = i % (n + 1) == 0;
  for (int j = 1; j < QUAD_SERIES && quad_norm(n * n, power) > (quad)1e-40; j++) {
    quad_multiply(n, A, power, next);
    for (int i = 0; i < n * n; i++) sum[i] += power[i] = next[i] / (j + shift);
  }
}

/* b becomes A^-1 b, by Gauss-Jordan elimination with row exchanges. */
static inline void quad_solve_linear(int n, const quad *matrix, quad *b)
{
  quad A[QUAD_ROWS * QUAD_ROWS];
  for (int i = 0; i < n * n; i++) A[i] = matrix[i];
  for (int k = 0; k < n; k++) {
    int pivot = k;
    for (int i = k; i < n; i++)
      if (fabsq(A[n * i + k]) > fabsq(A[n * pivot + k])) pivot = i;
    for (int j = 0; j <= n; j++) {
      quad *one = j < n ? &A[n * k + j] : &b[k], *other = j < n ? &A[n * pivot + j] : &b[pivot];
      const quad kept = *one;
      *one = *other;
      *other = kept;
    }
    for (int i = 0; i < n; i++) {
      const quad factor = i == k ? 0 : A[n * i + k] / A[n * k + k];
      for (int j = k; j < n; j++) A[n * i + j] -= factor * A[n * k + j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = 0; k < n; k++) b[k] /= A[n * k + k];
}

static inline void quad_apply(int n, const quad *A, const quad *x, quad *y)
{
  for (int i = 0; i < n; i++) {
    y[i] = 0;
    for (int j = 0; j < n; j++) y[i] += A[n * i + j] * x[j];
  }
}

static inline void quad_hat(const quad w[3], quad W[9])
{
  const quad hat[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
  for (int i = 0; i < 9; i++) W[i] = hat[i];
}

static inline void quad_from(int count, const double *x, quad *y)
{
  for (int i = 0; i < count; i++) y[i] = (quad)x[i];
}

/* R = exp(hat(w)) */
static inline void quad_rotation(const double w[3], quad R[9])
{
  quad exact[3], W[9];
  quad_from(3, w, exact);
  quad_hat(exact, W);
  quad_series(3, 0, W, R);
}

/* The largest |computed - exact|. */
static inline double quad_error(int count, const double *computed, const quad *exact)
{
  quad largest = 0;
  for (int i = 0; i < count; i++) largest = fmaxq(largest, fabsq((quad)computed[i] - exact[i]));
  return (double)largest;
}

#endif
#endif
