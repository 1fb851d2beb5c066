/* Vectors of 3 numbers, and matrices of 9 stored row by row. */
#ifndef TEST_GROUP_MATRIX_H
#define TEST_GROUP_MATRIX_H
#include <math.h>

static inline double length(const double w[3])
{
  return sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

/* C = A B */
static inline void multiply(const double A[9], const double B[9], double C[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* Computes defect = R^T R - I, each product and sum exact to some 1e-19, and returns its largest
 * entry. */
static inline double orthogonality(const double R[9], double defect[9])
{
  double largest = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      long double sum = -(i == j);
      for (int k = 0; k < 3; k++) sum += (long double)R[3 * k + i] * R[3 * k + j];
      defect[3 * i + j] = (double)sum;
      largest = fmax(largest, fabs(defect[3 * i + j]));
    }
  return largest;
}

#endif
