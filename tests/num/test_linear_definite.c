/* The factor L D L^T of positive definite matrices. */
#include <math.h>
#include <string.h>

#include "matrix.h"

enum { N = 24 };

/* Makes A = S (I + B B^T) S with a banded B and powers of two S, or 1. */
static void make_definite(int is_scaled, double *a)
{
  double b[N][N] = {{0}}, s[N];
  for (int i = 0; i < N; i++) {
    s[i] = is_scaled ? ldexp(1.0, 37 * i % 81 - 40) : 1;
    for (int j = i; j < N && j < i + 3; j++) b[i][j] = sin(5.0 * i + j);
  }
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double sum = i == j;
      for (int k = 0; k < N; k++) sum += b[i][k] * b[j][k];
      a[i * N + j] = s[i] * s[j] * sum;
    }
}

START_TEST(solutions_are_those_of_dense_ones_and_scales_change_no_bit)
{
  double a[N * N], scaled[N * N], dense[N], definite[N], of_scaled[N];
  make_definite(0, a);
  make_definite(1, scaled);
  for (int i = 0; i < N; i++) {
    dense[i] = definite[i] = cos(i);
    of_scaled[i] = ldexp(cos(i), 37 * i % 81 - 40);
  }
  solve(N, a, DVI__LINEAR_DENSE, dense);
  solve(N, a, DVI__LINEAR_DEFINITE, definite);
  solve(N, scaled, DVI__LINEAR_DEFINITE, of_scaled);
  for (int i = 0; i < N; i++) {
    ck_assert_double_eq_tol(definite[i], dense[i], 2e-14);
    ck_assert_double_eq(ldexp(of_scaled[i], 37 * i % 81 - 40), definite[i]);
  }
}
END_TEST

START_TEST(one_analysis_serves_all_factors_and_the_sign_is_known)
{
  double a[N * N], b[N] = {1};
  dvi_counters counters = {0};
  matrix m;
  make_definite(1, a);
  compress(N, a, &m);
  dvi__linear *linear = make(&m, DVI__LINEAR_DEFINITE, &counters);
  ck_assert_int_eq(dvi__linear_kind_of(linear), DVI__LINEAR_DEFINITE);
  for (int k = 0; k < 3; k++) {
    ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi__linear_solve(linear, b), DVI_OK);
  }
  ck_assert_int_eq(counters.symbolic, 1);
  ck_assert_int_eq(counters.preparations, 1);
  ck_assert_int_eq(counters.factorizations, 3);
  ck_assert_int_eq(counters.solves, 3);
  ck_assert_int_eq(dvi__linear_sign(linear), 1);
  ck_assert(dvi__linear_is_definite(linear, 1) && !dvi__linear_is_definite(linear, -1));
  ck_assert_double_gt(dvi__linear_condition(linear), 1e-3);
  ck_assert_double_ge(dvi__linear_cost_of(linear).entries, N);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

START_TEST(what_is_not_definite_is_refused_and_the_next_factor_is_right)
{
  const double bad[][4] = {{1, 2, 2, 1}, {-1, 0, 0, -1}, {1, 1, 1, 1}, {0, 0, 0, 0}, {1, 0, 0, 0}};
  matrix m;
  compress(2, (double[]){2, 1, 1, 3}, &m);
  dvi__linear *linear = make(&m, DVI__LINEAR_DEFINITE, NULL);
  double b[2] = {4, 7};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    ck_assert_int_eq(dvi__linear_factor(linear, bad[k]), DVI_SINGULAR);
    check_words("the 2 x 2 matrix is not positive definite");
  }
  ck_assert_int_eq(dvi__linear_factor(linear, (double[]){2, 1, NAN, 3}), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  ck_assert_int_eq(dvi__linear_solve(linear, b), DVI_OK);
  ck_assert_double_eq_tol(b[0], 1, 4e-15);
  ck_assert_double_eq_tol(b[1], 2, 4e-15);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

START_TEST(a_shared_factor_solves_to_the_same_bits_and_counts_its_own_solutions)
{
  double a[N * N], b[N], c[N];
  dvi_counters counters = {0};
  matrix m;
  dvi__linear *shared;
  make_definite(0, a);
  compress(N, a, &m);
  for (int i = 0; i < N; i++) b[i] = c[i] = cos(i);
  dvi__linear *linear = make(&m, DVI__LINEAR_DEFINITE, NULL);
  ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  ck_assert_int_eq(dvi__linear_share(linear, &counters, &shared), DVI_OK);
  ck_assert_int_eq(dvi__linear_solve(linear, b), DVI_OK);
  ck_assert_int_eq(dvi__linear_solve(shared, c), DVI_OK);
  ck_assert_mem_eq(b, c, sizeof b);
  ck_assert_int_eq(counters.solves, 1);
  ck_assert_int_eq(counters.factorizations, 0);
  ck_assert_double_eq(dvi__linear_condition(shared), dvi__linear_condition(linear));
  dvi__linear_destroy(&shared);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* [2 1; 1 3] is positive definite, [2 3; 3 1], [1 0; 0 -1] and [0 1; 1 0] are indefinite. */
START_TEST(symmetric_matrices_have_the_factor_that_their_sign_allows)
{
  const double some[][4] = {{2, 1, 1, 3}, {2, 3, 3, 1}, {1, 0, 0, -1}, {0, 1, 1, 0}};
  for (int k = 0; k < 4; k++) {
    const double *a = some[k];
    double b[2] = {a[0] - 2 * a[1], a[2] - 2 * a[3]};
    matrix m;
    dvi__linear *linear;
    compress(2, a, &m);
    ck_assert_msg(dvi__linear_create_symmetric(&m.pattern, m.values, NULL, &linear) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi__linear_kind_of(linear),
                     k == 0 ? DVI__LINEAR_DEFINITE : DVI__LINEAR_SPARSE);
    ck_assert_int_eq(dvi__linear_solve(linear, b), DVI_OK);
    ck_assert_double_eq_tol(b[0], 1, 4e-15);
    ck_assert_double_eq_tol(b[1], -2, 4e-15);
    dvi__linear_destroy(&linear);
    dvi__pattern_clear(&m.pattern);
  }
}
END_TEST

START_TEST(a_singular_symmetric_matrix_leaves_no_solver)
{
  matrix m;
  dvi__linear *linear;
  compress(2, (double[]){1, 1, 1, 1}, &m);
  ck_assert_int_eq(dvi__linear_create_symmetric(&m.pattern, m.values, NULL, &linear), DVI_SINGULAR);
  ck_assert_ptr_null(linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

SUITE(linear_definite)
{
  tcase_add_test(tests, a_shared_factor_solves_to_the_same_bits_and_counts_its_own_solutions);
  tcase_add_test(tests, symmetric_matrices_have_the_factor_that_their_sign_allows);
  tcase_add_test(tests, a_singular_symmetric_matrix_leaves_no_solver);
  tcase_add_test(tests, solutions_are_those_of_dense_ones_and_scales_change_no_bit);
  tcase_add_test(tests, one_analysis_serves_all_factors_and_the_sign_is_known);
  tcase_add_test(tests, what_is_not_definite_is_refused_and_the_next_factor_is_right);
}
