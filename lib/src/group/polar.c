/* The rotation R closest to a matrix M has the largest tr(R^T M) = q.K q among the unit quaternions
 * q of R, with K symmetric of trace 0 (Horn 1987). Jacobi's rotations find the eigenvectors of K.
 * They need no separate case where M is singular or reverses orientation. */
#include <dvi/group.h>
#include <math.h>

#include "group/vector.h"

/* Jacobi's method converges quadratically. Off-diagonals of 1 are below 1e-60 after six sweeps. */
enum { SWEEPS = 8 };

/* Make K_ij zero by a rotation of the coordinates i and j. The columns of V are the axes of these
 * coordinates. */
static void jacobi_rotate_pair(double K[4][4], double V[4][4], int i, int j)
{
  if (K[i][j] == 0) return;
  /* cotangent of twice the angle, which is 0 if this overflows */
  const double cotangent = (K[j][j] - K[i][i]) / (2 * K[i][j]);
  const double t = copysign(1, cotangent) / (fabs(cotangent) + hypot(1, cotangent)),
               c = 1 / sqrt(1 + t * t), s = t * c;
  for (int k = 0; k < 4; k++) {
    const double x = K[k][i], y = K[k][j], a = V[k][i], b = V[k][j];
    K[k][i] = c * x - s * y;
    K[k][j] = s * x + c * y;
    V[k][i] = c * a - s * b;
    V[k][j] = s * a + c * b;
  }
  for (int k = 0; k < 4; k++) {
    const double x = K[i][k], y = K[j][k];
    K[i][k] = c * x - s * y;
    K[j][k] = s * x + c * y;
  }
  K[i][j] = K[j][i] = 0;
}

static double largest_matrix_entry(const double M[9])
{
  double largest = 0;
  for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(M[i]));
  return largest;
}

void dvi_so3_project(const double M[9], double R[9])
{
  const double largest = largest_matrix_entry(M), scale = largest > 0 ? largest : 1;
  double m[9], V[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (int i = 0; i < 9; i++) m[i] = M[i] / scale;
  const double x = m[7] - m[5], y = m[2] - m[6], z = m[3] - m[1], xy = m[1] + m[3],
               yz = m[5] + m[7], zx = m[6] + m[2];
  double K[4][4] = {{m[0] + m[4] + m[8], x, y, z},
                    {x, m[0] - m[4] - m[8], xy, zx},
                    {y, xy, m[4] - m[8] - m[0], yz},
                    {z, zx, yz, m[8] - m[0] - m[4]}};
  for (int sweep = 0; sweep < SWEEPS; sweep++)
    for (int i = 0; i < 3; i++)
      for (int j = i + 1; j < 4; j++) jacobi_rotate_pair(K, V, i, j);
  int top = 0;
  for (int i = 1; i < 4; i++)
    if (K[i][i] > K[top][top]) top = i;
  const double q[4] = {V[0][top], V[1][top], V[2][top], V[3][top]};
  dvi_so3_from_quaternion(q, R);
}

/* excess = M^T M - I. */
static void find_excess(const double M[9], double excess[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      excess[3 * i + j] = ((M[i] * M[j] - (i == j)) + M[3 + i] * M[3 + j]) + M[6 + i] * M[6 + j];
}

/* Compute |M - R| of a matrix M = R S that is a rotation but for its excess. The distance is that
 * of S - I = (I + excess)^{1/2} - I = excess/2 - excess^2/8 + ... */
static double small_distance(const double excess[9])
{
  double sum = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const double square = dvi__dot(excess + 3 * i, excess + 3 * j);
      const double stretch = 0.5 * excess[3 * i + j] - 0.125 * square;
      sum += stretch * stretch;
    }
  return sqrt(sum);
}

double dvi_so3_distance(const double M[9])
{
  double third[3], excess[9];
  find_excess(M, excess);
  dvi__cross(M, M + 3, third);
  if (largest_matrix_entry(excess) <= 1e-8 && dvi__dot(third, M + 6) > 0)
    return small_distance(excess);
  const double scale = fmax(1, largest_matrix_entry(M));
  double R[9], sum = 0;
  dvi_so3_project(M, R);
  for (int i = 0; i < 9; i++) {
    const double difference = M[i] / scale - R[i] / scale;
    sum += difference * difference;
  }
  return scale * sqrt(sum);
}
