/* Complex matrices, by what their factors are. */
#include <math.h>

#include "core/memory.h"
#include "field/spectra/complex_matrix.h"
#include "field/spectra/complex_number.h"
#include "support/suite.h"

enum { N = 7, ROWS = 11, BLOCK = 64 };

static void fill(int count, double complex *A)
{
  for (int k = 0; k < count; k++) A[k] = dvi__complex(sin(1 + 3.7 * k), cos(2 + 1.3 * k * k));
}

static void check_zero(double complex z)
{
  ck_assert_double_lt(cabs(z), 1e-13);
}

/* The solution x of least squares leaves A^H (A x - b) = 0. */
START_TEST(reflections_solve_least_squares)
{
  double complex A[ROWS * N], R[ROWS * N], b[ROWS], x[ROWS], factor[N], work[BLOCK * N];
  fill(ROWS * N, A);
  fill(ROWS * N, R);
  for (int i = 0; i < ROWS; i++) x[i] = b[i] = dvi__complex(i, 1);
  dvi__complex_qr(ROWS, N, R, factor, work);
  dvi__complex_reflect(ROWS, N, R, factor, 1, x, work);
  ck_assert(dvi__complex_back(ROWS, N, R, ROWS, 1, x));
  for (int i = 0; i < ROWS; i++)
    for (int k = 0; k < N; k++) b[i] -= A[k * ROWS + i] * x[k];
  for (int k = 0; k < N; k++) {
    double complex sum = 0;
    for (int i = 0; i < ROWS; i++) sum += conj(A[k * ROWS + i]) * b[i];
    check_zero(sum);
  }
}
END_TEST

START_TEST(a_singular_triangle_is_refused)
{
  double complex R[4] = {1, 0, 2, 0}, b[2] = {1, 1};
  ck_assert(!dvi__complex_back(2, 2, R, 2, 1, b));
}
END_TEST

/* A^H A v = s^2 v, for the rows v^H that are given. */
START_TEST(right_vectors_belong_to_their_singular_values)
{
  double complex A[N * N], copy[N * N], VH[N * N];
  double s[N];
  fill(N * N, A);
  fill(N * N, copy);
  ck_assert_int_eq(dvi__complex_svd(N, copy, s, VH), DVI_OK);
  for (int k = 0; k < N; k++) {
    double complex Av[N] = {0};
    if (k > 0) ck_assert_double_le(s[k], s[k - 1]);
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) Av[i] += A[j * N + i] * conj(VH[j * N + k]);
    for (int j = 0; j < N; j++) {
      double complex sum = 0;
      for (int i = 0; i < N; i++) sum += conj(A[j * N + i]) * Av[i];
      check_zero(sum - s[k] * s[k] * conj(VH[j * N + k]));
    }
  }
}
END_TEST

/* The companion matrix of (z - 1)(z - i)(z + 2i) = z^3 + (i - 1) z^2 + (2 - i) z - 2. */
START_TEST(a_companion_matrix_has_the_roots_of_its_polynomial)
{
  const double complex expected[] = {1, dvi__complex(0, 1), dvi__complex(0, -2)};
  double complex A[9] = {dvi__complex(1, -1), 1, 0, dvi__complex(-2, 1), 0, 1, 2, 0, 0}, z[3];
  ck_assert_int_eq(dvi__complex_eigenvalues(3, A, z), DVI_OK);
  for (int k = 0; k < 3; k++) {
    double nearest = 9;
    for (int i = 0; i < 3; i++) nearest = fmin(nearest, cabs(z[i] - expected[k]));
    ck_assert_double_lt(nearest, 1e-14);
  }
}
END_TEST

START_TEST(a_hermitian_matrix_has_real_eigenvalues_and_their_vectors)
{
  double complex A[N * N], X[N * N];
  double lambda[N];
  fill(N * N, X);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) A[j * N + i] = X[j * N + i] + conj(X[i * N + j]);
  for (int k = 0; k < N * N; k++) X[k] = A[k];
  ck_assert_int_eq(dvi__complex_hermitian(N, X, lambda), DVI_OK);
  for (int k = 0; k < N; k++)
    for (int i = 0; i < N; i++) {
      double complex sum = -lambda[k] * X[k * N + i];
      for (int j = 0; j < N; j++) sum += A[j * N + i] * X[k * N + j];
      check_zero(sum);
    }
}
END_TEST

START_TEST(lacking_memory_is_a_status)
{
  double complex A[1] = {2}, B[1];
  double s[1];
  for (long successes = 0; successes < 2; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status svd = dvi__complex_svd(1, A, s, B),
                     eigenvalues = dvi__complex_eigenvalues(1, A, B),
                     hermitian = dvi__complex_hermitian(1, A, s);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(svd, DVI_NO_MEMORY);
    ck_assert_int_eq(eigenvalues, DVI_NO_MEMORY);
    ck_assert_int_eq(hermitian, DVI_NO_MEMORY);
  }
}
END_TEST

SUITE(complex_matrix)
{
  tcase_add_test(tests, reflections_solve_least_squares);
  tcase_add_test(tests, a_singular_triangle_is_refused);
  tcase_add_test(tests, right_vectors_belong_to_their_singular_values);
  tcase_add_test(tests, a_companion_matrix_has_the_roots_of_its_polynomial);
  tcase_add_test(tests, a_hermitian_matrix_has_real_eigenvalues_and_their_vectors);
  tcase_add_test(tests, lacking_memory_is_a_status);
}
