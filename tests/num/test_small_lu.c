/* Factors of small full matrices solve as LAPACK's do. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "num/dense.h"
#include "num/simd/small_lu.h"
#include "support/suite.h"

enum { MOST = DVI__SMALL_LU_MOST, SQUARE = MOST * MOST };

typedef struct small_matrix {
  double upper[SQUARE], lower[SQUARE], diagonal[MOST];
  int pivot[MOST];
} small_matrix;

static dvi__small_lu factor_of(int n, small_matrix *m)
{
  *m = (small_matrix){{0}, {0}, {0}, {0}};
  return (dvi__small_lu){n, dvi__small_lu_stride(n), m->upper, m->lower, m->diagonal, m->pivot};
}

static double entry(int n, int i, int j)
{
  return sin(1.0 + 3 * i * n + 7 * j * j + i * j);
}

/* The matrices want exchanges of rows. LAPACK's own solution is as far from this one as roundings
 * that the condition amplifies, by 1e4 here. */
START_TEST(solutions_are_those_of_lapack)
{
  static small_matrix m;
  static double full[SQUARE];
  for (int n = 1; n <= MOST; n++) {
    const dvi__small_lu lu = factor_of(n, &m);
    double b[MOST], expected[MOST], largest = 0;
    int pivot[MOST], exchanges = 0;
    for (int j = 0; j < n; j++) {
      b[j] = expected[j] = cos(j);
      for (int i = 0; i < n; i++) full[j * n + i] = lu.upper[j * lu.stride + i] = entry(n, i, j);
    }
    ck_assert(dvi__dense_solve(n, full, pivot, expected));
    ck_assert_double_gt(dvi__small_lu_factor(&lu), 0);
    dvi__small_lu_solve(&lu, b);
    for (int i = 0; i < n; i++) {
      largest = fmax(largest, fabs(expected[i]));
      exchanges += lu.pivot[i] != i;
      ck_assert_int_eq(lu.pivot[i] + 1, pivot[i]);
    }
    for (int i = 0; i < n; i++)
      ck_assert_double_eq_tol(b[i], expected[i], 1e4 * n * DBL_EPSILON * largest);
    ck_assert(n < 4 || exchanges > 0);
  }
}
END_TEST

START_TEST(a_singular_matrix_has_no_factor)
{
  static small_matrix m;
  const dvi__small_lu lu = factor_of(6, &m);
  for (int j = 0; j < 6; j++)
    for (int i = 0; i < 6; i++) lu.upper[j * lu.stride + i] = i + j < 2 ? 1 : 0;
  ck_assert_double_eq(dvi__small_lu_factor(&lu), 0);
}
END_TEST

/* A factor leaves nothing behind for the next one. */
START_TEST(factors_depend_on_their_matrix_alone)
{
  static small_matrix first, second;
  enum { SIZE = 7, STRIDE = 8 };
  const dvi__small_lu used = factor_of(SIZE, &first), fresh = factor_of(SIZE, &second);
  const dvi__small_lu *const of[] = {&used, &used, &fresh};
  for (int pass = 0; pass < 3; pass++) {
    for (int j = 0; j < SIZE; j++)
      for (int i = 0; i < SIZE; i++)
        of[pass]->upper[j * STRIDE + i] = entry(pass == 0 ? 9 : 8, i, j);
    ck_assert_double_gt(dvi__small_lu_factor(of[pass]), 0);
  }
  ck_assert_mem_eq(&first, &second, sizeof first);
}
END_TEST

SUITE(small_lu)
{
  tcase_add_test(tests, solutions_are_those_of_lapack);
  tcase_add_test(tests, a_singular_matrix_has_no_factor);
  tcase_add_test(tests, factors_depend_on_their_matrix_alone);
}
