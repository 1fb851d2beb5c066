/* Singular matrices are named so, matrices that are badly scaled are not, and a border makes a
 * singular matrix regular. */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "num/linear.h"
#include "support/suite.h"
#include "matrix.h"

static dvi_status factor_of(int n, const double *a, dvi__linear_kind kind)
{
  matrix m;
  compress(n, a, &m);
  dvi__linear *linear = make(&m, kind, NULL);
  const dvi_status status = dvi__linear_factor(linear, m.values);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
  return status;
}

START_TEST(singular_matrices_are_named_singular)
{
  const double equal[9] = {1, 2, 3, 2, 4, 6, 1, 0, 1},
               rounded[9] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  ck_assert_int_eq(factor_of(3, equal, kinds[_i]), DVI_SINGULAR);
  check_words("3 x 3 matrix is singular to working precision");
  ck_assert_int_eq(factor_of(3, rounded, kinds[_i]), DVI_SINGULAR);
}
END_TEST

START_TEST(a_zero_value_on_the_pattern_can_make_it_singular)
{
  const double regular[4] = {1, 2, 3, 4};
  matrix m;
  compress(2, regular, &m);
  dvi__linear *linear = make(&m, kinds[_i], NULL);
  ck_assert_int_eq(dvi__linear_factor(linear, (double[]){0, 0, 0, 0}), DVI_SINGULAR);
  ck_assert_int_eq(dvi__linear_factor(linear, (double[]){1, 0, 1, 0}), DVI_SINGULAR);
  double b[2] = {3, 7};
  /* and the solver is usable again */
  ck_assert_int_eq(dvi__linear_factor(linear, m.values), DVI_OK);
  dvi__linear_solve(linear, b);
  ck_assert_double_eq_tol(b[0], 1, 4e-15);
  ck_assert_double_eq_tol(b[1], 1, 4e-15);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

START_TEST(a_column_without_entries_is_singular_at_the_factorisation)
{
  ck_assert_int_eq(factor_of(2, (double[]){1, 0, 1, 0}, kinds[_i]), DVI_SINGULAR);
  ck_assert_int_eq(factor_of(30, (double[900]){0}, kinds[_i]), DVI_SINGULAR);
}
END_TEST

/* Units must not matter. Rows and columns that differ by 1e200 leave the solution as exact as it
 * was. */
START_TEST(badly_scaled_rows_and_columns_are_solved_as_well_as_good_ones)
{
  const double a[9] = {4, 1, 2, 1, 5, 2, 1, 2, 6}, row[3] = {0x1p-400, 1, 0x1p330},
               column[3] = {0x1p40, 0x1p-200, 0x1p10};
  double scaled[9], good[3] = {7, 8, 9}, bad[3];
  for (int i = 0; i < 9; i++) scaled[i] = row[i / 3] * a[i] * column[i % 3];
  for (int i = 0; i < 3; i++) bad[i] = row[i] * good[i];
  solve(3, a, kinds[_i], good);
  solve(3, scaled, kinds[_i], bad);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(bad[i] * column[i] / good[i], 1, 1e-15);
}
END_TEST

/* A multiplier's column beside masses of 1e30. No row scaling alone sees that this is harmless. */
START_TEST(a_column_of_small_numbers_is_not_taken_for_singular)
{
  const double a[4] = {1e30, 1, -1e30, 1};
  double b[2] = {1e30 + 1, 1 - 1e30};
  solve(2, a, kinds[_i], b);
  ck_assert_double_eq_tol(b[0], 1, 1e-15);
  ck_assert_int_eq(factor_of(2, a, kinds[_i]), DVI_OK);
}
END_TEST

START_TEST(the_smallest_and_the_largest_numbers_do_not_overflow_the_scales)
{
  double b[2] = {DBL_TRUE_MIN * 8, DBL_MAX / 4};
  solve(2, (double[]){DBL_TRUE_MIN * 4, 0, 0, DBL_MAX / 2}, kinds[_i], b);
  ck_assert_double_eq(b[0], 2);
  ck_assert_double_eq(b[1], 0.5);
}
END_TEST

START_TEST(values_that_are_not_finite_are_refused)
{
  const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL};
  for (int k = 0; k < 3; k++) {
    const double a[4] = {1, 2, bad[k], 4};
    ck_assert_int_eq(factor_of(2, a, kinds[_i]), DVI_NOT_FINITE);
  }
}
END_TEST

/* ---- borders ---- */

enum {
  RING = 300,
  BORDER = 2,
  RINGED = RING + BORDER,
  RING_MOST = 3 * RING + (2 * RING + BORDER) * BORDER
};

/* Gives entry (i,j) of a ring of springs, which nothing holds in place, bordered by a row that
 * holds it, and by waves. */
static double ring_entry(int i, int j, double hold)
{
  if (i < RING && j < RING)
    return i == j ? 2 : (i - j + RING) % RING == 1 || (j - i + RING) % RING == 1 ? -1 : 0;
  if (i >= RING && j >= RING) return i == j && i > RING ? 0.5 : 0;
  const int at = i < j ? i : j, border = i < j ? j : i;
  return border == RING ? hold : 2 + sin(0.1 * at);
}

/* Returns the status of the solution, and how wrong it is. */
static dvi_status solve_ring(double hold, double *worst)
{
  static int start[RINGED + 1], row[RING_MOST];
  static double values[RING_MOST];
  double b[RINGED] = {0};
  int count = 0;
  for (int j = 0; j < RINGED; j++) {
    for (int i = 0; i < RINGED; i++) {
      if (i < RING && ring_entry(i, j, 1) == 0) continue;
      if (j < RING && ring_entry(i, j, 1) == 0) continue;
      row[count] = i;
      values[count++] = ring_entry(i, j, hold);
      b[i] += values[count - 1] * cos(j);
    }
    start[j + 1] = count;
  }
  const dvi__pattern pattern = {RINGED, RINGED, start, row};
  dvi__linear *linear;
  ck_assert_msg(dvi__linear_create_bordered(&pattern, BORDER, NULL, &linear) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi__linear_kind_of(linear), DVI__LINEAR_SPARSE);
  const dvi_status status = dvi__linear_factor(linear, values);
  if (status == DVI_OK) dvi__linear_solve(linear, b);
  *worst = 0;
  for (int j = 0; j < RINGED; j++) *worst = fmax(*worst, fabs(b[j] - cos(j)));
  dvi__linear_destroy(&linear);
  return status;
}

/* The ring alone is singular, and its other eigenvalues reach down to (2 pi/300)^2 = 4e-4. Kept
 * pivots may cost six digits. */
START_TEST(a_border_makes_a_singular_matrix_regular)
{
  double worst;
  ck_assert_msg(solve_ring(1, &worst) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_lt(worst, 1e6 * DBL_EPSILON);
  ck_assert_int_eq(solve_ring(0, &worst), DVI_SINGULAR);
}
END_TEST

SUITE(linear_singular)
{
  tcase_add_loop_test(tests, singular_matrices_are_named_singular, 0, 2);
  tcase_add_loop_test(tests, a_zero_value_on_the_pattern_can_make_it_singular, 0, 2);
  tcase_add_loop_test(tests, a_column_without_entries_is_singular_at_the_factorisation, 0, 2);
  tcase_add_loop_test(tests, badly_scaled_rows_and_columns_are_solved_as_well_as_good_ones, 0, 2);
  tcase_add_loop_test(tests, a_column_of_small_numbers_is_not_taken_for_singular, 0, 2);
  tcase_add_loop_test(tests, the_smallest_and_the_largest_numbers_do_not_overflow_the_scales, 0, 2);
  tcase_add_loop_test(tests, values_that_are_not_finite_are_refused, 0, 2);
  tcase_add_test(tests, a_border_makes_a_singular_matrix_regular);
}
