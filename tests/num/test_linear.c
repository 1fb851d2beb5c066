#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/eigen.h"
#include "num/linear.h"
#include "support/suite.h"
#include "matrix.h"

START_TEST(a_known_system_has_its_known_solution)
{
  const double a[9] = {0, 2, 1, 1, 0, 0, 3, 0, 1};
  double b[3] = {7, 1, 6};
  solve(3, a, kinds[_i], b);
  ck_assert_double_eq_tol(b[0], 1, 1e-15); /* integers with a few roundings at most */
  ck_assert_double_eq_tol(b[1], 2, 1e-15);
  ck_assert_double_eq_tol(b[2], 3, 2e-15);
}
END_TEST

/* Compares with cofactors. Exchanged rows change the sign, a scale does not. */
START_TEST(determinants_have_their_sign)
{
  static const double a[][16] = {{0, 2, 0, 1, 0, 0, 3, 0, 1},
                                 {1, 0, 0, 0, 2, 1, 3, 0, 1},
                                 {0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                 {4e9, 1, 0, 0, 1, 4e-9, 1, 0, 0, 1, -4, 1, 0, 0, 1, -4}};
  static const int size[] = {3, 3, 4, 4}, sign[] = {-1, 1, -1, 1};
  matrix m;
  const int k = _i / 2;
  compress(size[k], a[k], &m);
  dvi__linear *linear = make(&m, kinds[_i % 2], NULL);
  ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi__linear_sign(linear), sign[k]);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* Makes A = S L D L^T S with entries of L in (-1,1), some of them 0, and powers of two S, which
 * differ by 2^40. D is 1 but for two rows of -1 or none. */
static void product(unsigned *state, int negative, double *a)
{
  enum { N = 8 };
  double l[N][N] = {{0}}, s[N];
  for (int i = 0; i < N; i++) {
    s[i] = ldexp(1.0, (int)((*state = *state * 1664525u + 1013904223u) >> 16) % 41 - 20);
    l[i][i] = 1;
    for (int j = 0; j < i; j++) {
      *state = *state * 1664525u + 1013904223u;
      l[i][j] = *state >> 31 ? (double)(*state >> 8) / (1 << 22) - 3 : 0;
    }
  }
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double sum = 0;
      for (int k = 0; k < N; k++)
        sum += (negative && (k == 2 || k == 5) ? -1 : 1) * l[i][k] * l[j][k];
      a[i * N + j] = s[i] * s[j] * sum;
    }
}

START_TEST(pivots_tell_whether_a_symmetric_matrix_is_definite)
{
  enum { N = 8 };
  unsigned state = 1;
  for (int k = 0; k < 200; k++) {
    double a[N * N];
    matrix m;
    product(&state, k % 2, a);
    compress(N, a, &m);
    dvi__linear *linear = make(&m, DVI__LINEAR_SPARSE, NULL);
    ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi__linear_is_definite(linear, 1), k % 2 == 0);
    ck_assert_int_eq(dvi__linear_is_definite(linear, -1), 0);
    for (int e = 0; e < dvi__pattern_entries(&m.pattern); e++) m.values[e] = -m.values[e];
    ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi__linear_is_definite(linear, -1), k % 2 == 0);
    ck_assert_int_eq(dvi__is_positive_definite(N, a), k % 2 == 0);
    dvi__linear_destroy(&linear);
    dvi__pattern_clear(&m.pattern);
  }
}
END_TEST

START_TEST(one_unknown_is_a_division)
{
  double b = 3;
  solve(1, (double[]){-4}, kinds[_i], &b);
  ck_assert_double_eq(b, -0.75);
}
END_TEST

/* Makes a band with a random part. It is diagonally dominant, so its condition number is about
 * 10. */
static void random_band(int n, int width, unsigned seed, double *a)
{
  srand(seed);
  memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (abs(i - j) <= width)
        a[i * n + j] = rand() / (double)RAND_MAX - 0.5 + (i == j ? 1 + width : 0);
}

START_TEST(dense_and_sparse_agree_with_the_solution_that_made_the_right_side)
{
  static double a[LARGEST * LARGEST];
  const int n = LARGEST, widths[] = {1, 4, LARGEST};
  random_band(n, widths[_i], 7, a);
  double x[LARGEST], b[2][LARGEST] = {{0}};
  for (int i = 0; i < n; i++) x[i] = cos(i);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) b[0][i] += a[i * n + j] * x[j];
  memcpy(b[1], b[0], sizeof b[0]);
  for (int k = 0; k < 2; k++) solve(n, a, kinds[k], b[k]);
  for (int i = 0; i < n; i++) {
    ck_assert_double_eq_tol(b[0][i], x[i], 1e-13); /* condition 10 times n roundings */
    ck_assert_double_eq_tol(b[1][i], x[i], 1e-13);
  }
}
END_TEST

START_TEST(a_factor_follows_new_values_and_the_analysis_is_done_once)
{
  const double first[9] = {4, 1, 0, 1, 5, 2, 0, 2, 6}, second[9] = {-3, 2, 0, 1, 8, 1, 0, -1, 2};
  dvi_counters counters = {0};
  matrix m, other;
  compress(3, first, &m);
  compress(3, second, &other);
  dvi__linear *linear = make(&m, kinds[_i], &counters);
  for (int round = 0; round < 3; round++) {
    double b[3] = {5, 8, 8}, c[3] = {-1, 10, 1};
    ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
    dvi__linear_solve(linear, b);
    ck_assert_int_eq(dvi__linear_factor(linear, other.values), DVI_OK);
    dvi__linear_solve(linear, c);
    for (int i = 0; i < 3; i++) {
      ck_assert_double_eq_tol(b[i], 1, 1e-15);
      ck_assert_double_eq_tol(c[i], 1, 1e-15);
    }
  }
  ck_assert_int_eq(counters.symbolic, kinds[_i] == DVI__LINEAR_SPARSE);
  ck_assert_int_eq(counters.factorizations, 6);
  ck_assert_int_eq(counters.solves, 6);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
  dvi__pattern_clear(&other.pattern);
}
END_TEST

/* With the pivots of the first matrix the second one would lose 7 digits (or 12). */
START_TEST(pivots_that_grow_bad_are_chosen_anew)
{
  const double pivot = _i < 2 ? 1e-7 : 1e-12;
  const double good[4] = {1, 0.5, 0.5, 1}, bad[4] = {pivot, 1, 1, 1};
  matrix m, other;
  compress(2, good, &m);
  compress(2, bad, &other);
  dvi__linear *linear = make(&m, kinds[_i % 2], NULL);
  double b[2] = {1 + 2 * pivot, 3};
  ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  ck_assert_int_eq(dvi__linear_factor(linear, other.values), DVI_OK);
  dvi__linear_solve(linear, b);
  ck_assert_double_eq_tol(b[0], 2, 4e-15);
  ck_assert_double_eq_tol(b[1], 1, 4e-15);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
  dvi__pattern_clear(&other.pattern);
}
END_TEST

START_TEST(the_kind_is_what_was_asked_and_auto_prefers_klu_for_sparse_matrices)
{
  static double a[LARGEST * LARGEST];
  matrix m;
  random_band(LARGEST, 1, 3, a);
  compress(LARGEST, a, &m);
  for (int k = 0; k < 2; k++) {
    dvi__linear *linear = make(&m, kinds[k], NULL);
    ck_assert_int_eq(dvi__linear_kind_of(linear), kinds[k]);
    dvi__linear_destroy(&linear);
    ck_assert_ptr_null(linear);
    dvi__linear_destroy(&linear);
  }
  dvi__linear *linear = make(&m, DVI__LINEAR_AUTO, NULL);
  ck_assert_int_eq(dvi__linear_kind_of(linear), DVI__LINEAR_SPARSE);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

START_TEST(auto_prefers_lapack_for_large_full_matrices)
{
  dvi__pattern full;
  dvi__linear *linear;
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){0}, 100, "full", &full), DVI_OK);
  ck_assert_int_eq(dvi__linear_create(&full, DVI__LINEAR_AUTO, NULL, &linear), DVI_OK);
  ck_assert_int_eq(dvi__linear_kind_of(linear), DVI__LINEAR_DENSE);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&full);
}
END_TEST

START_TEST(what_is_not_square_is_refused)
{
  int start[2] = {0, 0};
  const dvi__pattern none = {0, 0, start, start}, wide = {1, 2, start, start};
  dvi__linear *linear;
  ck_assert_int_eq(dvi__linear_create(&none, kinds[_i], NULL, &linear), DVI_BAD_SIZE);
  ck_assert_ptr_null(linear);
  ck_assert_int_eq(dvi__linear_create(&wide, kinds[_i], NULL, &linear), DVI_BAD_SIZE);
  ck_assert_ptr_null(linear);
}
END_TEST

/* ---- when they are made ---- */

START_TEST(nothing_is_made_before_the_first_factor)
{
  const double a[9] = {4, 1, 0, 1, 5, 2, 0, 2, 6};
  dvi_counters counters = {0};
  matrix m;
  compress(3, a, &m);
  const long before = dvi__allocation_count();
  dvi__linear *linear = make(&m, kinds[_i], &counters);
  ck_assert_int_eq(dvi__allocation_count() - before, 1); /* the solver's own struct */
  ck_assert_int_eq(dvi__linear_kind_of(linear), kinds[_i]);
  ck_assert_double_eq(dvi__linear_cost_of(linear).entries, 0);
  ck_assert_int_eq(counters.symbolic + counters.factorizations + counters.preparations, 0);
  for (int k = 0; k < 3; k++) ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  const long made = dvi__allocation_count();
  ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  ck_assert_int_eq(dvi__allocation_count(), made);
  ck_assert_int_eq(counters.symbolic, kinds[_i] == DVI__LINEAR_SPARSE);
  ck_assert_int_eq(counters.preparations, 1);
  ck_assert_double_ge(dvi__linear_cost_of(linear).entries, 7);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* A band of width 1 has no fill-in, which is known without a factor. */
START_TEST(an_analysis_tells_what_a_factor_costs)
{
  static double a[LARGEST * LARGEST];
  dvi_counters counters = {0};
  matrix m;
  random_band(LARGEST, 1, 3, a);
  compress(LARGEST, a, &m);
  dvi__linear *linear = make(&m, DVI__LINEAR_SPARSE, &counters);
  ck_assert_int_eq(dvi__linear_analyse(linear), DVI_OK);
  ck_assert_int_eq(counters.symbolic, 1);
  ck_assert_int_eq(counters.factorizations + counters.preparations, 0);
  ck_assert_double_eq(dvi__linear_cost_of(linear).entries, 3 * LARGEST - 2);
  ck_assert_double_le(dvi__linear_cost_of(linear).operations, dvi__pattern_operations(&m.pattern));
  ck_assert_int_eq(dvi__linear_analyse(linear), DVI_OK);
  ck_assert_int_eq(counters.symbolic, 1);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* Gives values of a complex matrix in pairs, of any size. Every other matrix has some small pivots
 * on its diagonal. */
static void random_values(const dvi__pattern *pattern, int parts, unsigned seed, double *values)
{
  srand(seed);
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      for (int part = 0; part < parts; part++) {
        const int is_small = pattern->row[e] == j && seed % 2 == 1 && j % 7 == 0;
        values[parts * e + part] = (rand() / (double)RAND_MAX - 0.5) * (is_small ? 1e-9 : 1) +
                                   (pattern->row[e] == j && !is_small ? 4 : 0);
      }
}

/* A factor depends on its matrix alone. The first one, which chooses the order of the pivots, has
 * the bits of a later one. */
START_TEST(the_first_factor_has_the_bits_of_any_other)
{
  static double a[LARGEST * LARGEST], values[2 * LARGEST * LARGEST],
      other_values[2 * LARGEST * LARGEST];
  const int parts = 1 + _i;
  matrix m;
  random_band(LARGEST, 5, 3, a);
  compress(LARGEST, a, &m);
  for (unsigned seed = 0; seed < 20; seed++) {
    double x[2 * LARGEST], y[2 * LARGEST];
    dvi__linear *linear[2];
    for (int k = 0; k < 2; k++)
      linear[k] = make(&m, parts == 1 ? DVI__LINEAR_SPARSE : DVI__LINEAR_COMPLEX, NULL);
    for (int i = 0; i < parts * LARGEST; i++) x[i] = y[i] = cos(i);
    random_values(&m.pattern, parts, seed, values);
    random_values(&m.pattern, parts, seed + 21, other_values);
    ck_assert_msg(dvi__linear_factor(linear[0], values) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi__linear_factor(linear[1], other_values), DVI_OK);
    ck_assert_int_eq(dvi__linear_factor(linear[1], values), DVI_OK);
    dvi__linear_solve(linear[0], x);
    dvi__linear_solve(linear[1], y);
    ck_assert_mem_eq(x, y, (size_t)(parts * LARGEST) * sizeof *x);
    for (int k = 0; k < 2; k++) dvi__linear_destroy(&linear[k]);
  }
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* With the diagonal d_j = 1e3 + i j and entries 1e3 beside it, the determinants of the leading
 * matrices are D_j = d_j D_(j-1) - 1e6 D_(j-2). All are computed in units of 1e3. */
START_TEST(complex_determinants_have_their_logarithm)
{
  static double a[LARGEST * LARGEST], values[2 * LARGEST * LARGEST];
  double before[2] = {0, 0}, last[2] = {1, 0};
  matrix m;
  random_band(LARGEST, 1, 3, a);
  compress(LARGEST, a, &m);
  for (int j = 0; j < LARGEST; j++) {
    const double tilt = 1e-3 * j, next[2] = {last[0] - tilt * last[1] - before[0],
                                             last[1] + tilt * last[0] - before[1]};
    memcpy(before, last, sizeof last);
    memcpy(last, next, sizeof last);
    for (int e = m.pattern.start[j]; e < m.pattern.start[j + 1]; e++) {
      values[2 * e] = 1e3;
      values[2 * e + 1] = m.pattern.row[e] == j ? j : 0;
    }
  }
  dvi__linear *linear = make(&m, DVI__LINEAR_COMPLEX, NULL);
  ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_OK);
  ck_assert_double_eq_tol(dvi__linear_log_determinant(linear),
                          LARGEST * log(1e3) + log(hypot(last[0], last[1])), 1e-10);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* (4 + i) x_j + x_(j+1) + x_(j-1) with x_j = 1 + i j. */
START_TEST(complex_systems_are_solved_in_pairs)
{
  static double a[LARGEST * LARGEST], values[2 * LARGEST * LARGEST];
  double b[2 * LARGEST] = {0};
  matrix m;
  random_band(LARGEST, 1, 3, a);
  compress(LARGEST, a, &m);
  for (int j = 0; j < LARGEST; j++)
    for (int e = m.pattern.start[j]; e < m.pattern.start[j + 1]; e++) {
      const int row = m.pattern.row[e];
      const double re = values[2 * e] = row == j ? 4 : 1, im = values[2 * e + 1] = row == j;
      b[2 * row] += re - im * j;
      b[2 * row + 1] += re * j + im;
    }
  dvi__linear *linear = make(&m, DVI__LINEAR_COMPLEX, NULL);
  ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_OK);
  ck_assert_int_eq(dvi__linear_sign(linear), 0); /* it has none */
  ck_assert_int_eq(dvi__linear_tells_definite(linear), 0);
  dvi__linear_solve(linear, b);
  for (int j = 0; j < LARGEST; j++) {
    ck_assert_double_eq_tol(b[2 * j], 1, 1e-15 * LARGEST);
    ck_assert_double_eq_tol(b[2 * j + 1], j, 1e-15 * LARGEST);
  }
  memset(values, 0, sizeof values);
  ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_SINGULAR);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* ---- patterns that promise too much ---- */

/* Entries that are always zero do not change the solution. */
START_TEST(entries_that_are_always_zero_do_no_harm)
{
  static double band[LARGEST * LARGEST], all[LARGEST * LARGEST];
  double b[2][LARGEST];
  matrix m;
  random_band(LARGEST, 2, 5, band);
  for (int i = 0; i < LARGEST * LARGEST; i++) all[i] = 1;
  compress(LARGEST, all, &m);
  for (int j = 0; j < LARGEST; j++)
    for (int i = 0; i < LARGEST; i++) m.values[j * LARGEST + i] = band[i * LARGEST + j];
  for (int i = 0; i < LARGEST; i++) b[0][i] = b[1][i] = cos(i);
  dvi__linear *linear = make(&m, kinds[_i], NULL);
  ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
  dvi__linear_solve(linear, b[0]);
  solve(LARGEST, band, DVI__LINEAR_DENSE, b[1]);
  for (int i = 0; i < LARGEST; i++) ck_assert_double_eq_tol(b[0][i], b[1][i], 1e-13);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

SUITE(linear)
{
  tcase_add_loop_test(tests, determinants_have_their_sign, 0, 8);
  tcase_add_test(tests, pivots_tell_whether_a_symmetric_matrix_is_definite);
  tcase_add_loop_test(tests, a_known_system_has_its_known_solution, 0, 2);
  tcase_add_loop_test(tests, one_unknown_is_a_division, 0, 2);
  tcase_add_loop_test(tests, dense_and_sparse_agree_with_the_solution_that_made_the_right_side, 0,
                      3);
  tcase_add_loop_test(tests, a_factor_follows_new_values_and_the_analysis_is_done_once, 0, 2);
  tcase_add_loop_test(tests, pivots_that_grow_bad_are_chosen_anew, 0, 4);
  tcase_add_test(tests, the_kind_is_what_was_asked_and_auto_prefers_klu_for_sparse_matrices);
  tcase_add_test(tests, auto_prefers_lapack_for_large_full_matrices);
  tcase_add_loop_test(tests, nothing_is_made_before_the_first_factor, 0, 2);
  tcase_add_test(tests, an_analysis_tells_what_a_factor_costs);
  tcase_add_loop_test(tests, the_first_factor_has_the_bits_of_any_other, 0, 2);
  tcase_add_test(tests, complex_systems_are_solved_in_pairs);
  tcase_add_test(tests, complex_determinants_have_their_logarithm);
  tcase_add_loop_test(tests, entries_that_are_always_zero_do_no_harm, 0, 2);
  tcase_add_loop_test(tests, what_is_not_square_is_refused, 0, 2);
}
