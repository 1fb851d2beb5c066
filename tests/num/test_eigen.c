/* labels: unit */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "num/eigen.h"
#include "support/suite.h"

enum { MOST = 6 };

static double entry_at(int n, const double *A, int i, int j)
{
  return A[j * n + i];
}

/* X D X^{-1}, entry by entry. */
static double rebuilt(int n, const double *a, const double *b, const double *X,
                      const double *inverse, int i, int j)
{
  double sum = 0;
  for (int k = 0; k < n; k++) {
    double row = a[k] * entry_at(n, inverse, k, j);
    if (b[k] > 0) row += b[k] * entry_at(n, inverse, k + 1, j);
    if (b[k] < 0) row += b[k] * entry_at(n, inverse, k - 1, j);
    sum += entry_at(n, X, i, k) * row;
  }
  return sum;
}

/* Rotations have pairs, symmetric matrices real eigenvalues, and a general one of odd size has
 * both. */
START_TEST(a_matrix_is_made_again_from_its_eigen_structure)
{
  const int n = 1 + _i;
  double T[MOST * MOST], a[MOST], b[MOST], X[MOST * MOST], inverse[MOST * MOST];
  for (int k = 0; k < n * n; k++) T[k] = sin(1 + 3.7 * k) + (k % (n + 1) == 0 ? 0.3 * k : 0);
  ck_assert_int_eq(dvi__eigen(n, T, a, b, X, inverse), DVI_OK);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      ck_assert_double_eq_tol(rebuilt(n, a, b, X, inverse, i, j), entry_at(n, T, i, j), 1e-13);
}
END_TEST

START_TEST(of_a_pair_the_one_above_the_real_axis_stands_first)
{
  const double turn[4] = {0, 1, -1, 0}; /* by columns */
  double a[2], b[2], X[4], inverse[4];
  ck_assert_int_eq(dvi__eigen(2, turn, a, b, X, inverse), DVI_OK);
  ck_assert_double_eq_tol(a[0], 0, DBL_EPSILON);
  ck_assert_double_eq_tol(b[0], 1, DBL_EPSILON);
  ck_assert_double_eq_tol(b[1], -1, DBL_EPSILON);
}
END_TEST

START_TEST(eigenvalues_of_a_matrix_that_is_not_finite_are_refused)
{
  double T[4] = {1, 2, NAN, 3}, a[2], b[2];
  ck_assert_int_eq(dvi__eigenvalues(2, T, 2, a, b, NULL), DVI_NOT_FINITE);
  check_words("not finite");
}
END_TEST

/* The same numbers from two ways, of a part of a larger array. */
START_TEST(eigenvalues_and_last_components_are_those_of_the_eigen_structure)
{
  const int n = 1 + _i, lead = n + 2;
  double T[MOST * (MOST + 2)], copy[MOST * (MOST + 2)], a[MOST], b[MOST], last[MOST];
  double whole[MOST * MOST], wanted_a[MOST], wanted_b[MOST], X[MOST * MOST], inverse[MOST * MOST];
  for (int k = 0; k < n * n; k++)
    T[k / n * lead + k % n] = whole[k] = sin(1 + 3.7 * k) + (k % (n + 1) == 0 ? 0.3 * k : 0);
  memcpy(copy, T, sizeof T);
  ck_assert_int_eq(dvi__eigen(n, whole, wanted_a, wanted_b, X, inverse), DVI_OK);
  ck_assert_int_eq(dvi__eigenvalues(n, T, lead, a, b, last), DVI_OK);
  for (int j = 0; j < n; j++) {
    const int is_pair = b[j] != 0, x = b[j] < 0 ? j - 1 : j;
    double square = 0, end = 0;
    for (int c = x; c <= x + is_pair; c++) {
      for (int i = 0; i < n; i++) square += X[c * n + i] * X[c * n + i];
      end = hypot(end, X[c * n + n - 1]);
    }
    ck_assert_double_eq_tol(a[j], wanted_a[j], 1e-13);
    ck_assert_double_eq_tol(b[j], wanted_b[j], 1e-13);
    ck_assert_double_eq_tol(last[j], end / sqrt(square), 1e-13);
  }
  ck_assert_int_eq(dvi__eigenvalues(n, copy, lead, a, b, NULL), DVI_OK);
  for (int j = 0; j < n; j++) ck_assert_double_eq_tol(a[j], wanted_a[j], 1e-12);
}
END_TEST

START_TEST(lacking_memory_is_a_status)
{
  const double one[1] = {2};
  double a[1], b[1], X[1], inverse[1];
  for (long successes = 0; successes < 3; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__eigen(1, one, a, b, X, inverse);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
  }
  ck_assert_int_eq(dvi__eigen(1, one, a, b, X, inverse), DVI_OK);
  ck_assert_double_eq(a[0], 2);
}
END_TEST

/* K = ((2,-1),(-1,2)), M = diag(1,4): lambda^2 - 5/2 lambda + 3/4 = 0. */
START_TEST(two_symmetric_matrices_are_made_diagonal_together)
{
  const double K[] = {2, -1, -1, 2}, M[] = {1, 0, 0, 4}, root = sqrt(13) / 4;
  double lambda[2], X[4];
  ck_assert_int_eq(dvi__eigen_symmetric(2, K, M, lambda, X), DVI_OK);
  ck_assert_double_eq_tol(lambda[0], 1.25 - root, 4e-15);
  ck_assert_double_eq_tol(lambda[1], 1.25 + root, 4e-15);
  for (int k = 0; k < 2; k++) {
    const double *x = X + 2 * k;
    ck_assert_double_eq_tol(x[0] * x[0] + 4 * x[1] * x[1], 1, 4e-15);
    ck_assert_double_eq_tol(2 * x[0] - x[1], lambda[k] * x[0], 4e-15);
    ck_assert_double_eq_tol(2 * x[1] - x[0], lambda[k] * 4 * x[1], 4e-15);
  }
  ck_assert_double_eq_tol(X[0] * X[2] + 4 * X[1] * X[3], 0, 4e-15);
  ck_assert_int_eq(dvi__eigen_symmetric(2, K, (const double[]){1, 0, 0, -4}, lambda, X),
                   DVI_SINGULAR);
  for (long successes = 0; successes < 2; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__eigen_symmetric(2, K, M, lambda, X);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
  }
}
END_TEST

SUITE(eigen)
{
  tcase_add_loop_test(tests, a_matrix_is_made_again_from_its_eigen_structure, 0, MOST);
  tcase_add_loop_test(tests, eigenvalues_and_last_components_are_those_of_the_eigen_structure, 0,
                      MOST);
  tcase_add_test(tests, eigenvalues_of_a_matrix_that_is_not_finite_are_refused);
  tcase_add_test(tests, of_a_pair_the_one_above_the_real_axis_stands_first);
  tcase_add_test(tests, lacking_memory_is_a_status);
  tcase_add_test(tests, two_symmetric_matrices_are_made_diagonal_together);
}
