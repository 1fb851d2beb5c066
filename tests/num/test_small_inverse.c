/* Inverses of small full matrices: products, signs of determinants, singular matrices. */
#include <math.h>

#include "num/simd/small_inverse.h"
#include "support/suite.h"

enum { MOST = DVI__SMALL_INVERSE_MOST, MOST_NEAR_ONE = DVI__NEAR_ONE_MOST };

/* Fill A [stride*n] with numbers below `size`, and add `diagonal`. */
static void fill_matrix(int n, int stride, double size, double diagonal, double *A)
{
  unsigned state = 1 + (unsigned)n;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      state = state * 1103515245u + 12345u;
      A[j * stride + i] = size * ((state >> 16) % 1000 / 500.0 - 1) + (i == j ? diagonal : 0);
    }
}

/* The largest entry of A B - 1. */
static double defect_of_product(int n, const double *A, const double *B, int stride)
{
  double worst = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = i == j ? -1 : 0;
      for (int k = 0; k < n; k++) sum += A[k * stride + i] * B[j * stride + k];
      worst = fmax(worst, fabs(sum));
    }
  return worst;
}

START_TEST(a_matrix_times_its_inverse_is_one)
{
  const int n = _i;
  static double A[MOST * MOST], inverse[MOST * MOST];
  fill_matrix(n, n, 1, 0, A);
  fill_matrix(n, n, 1, 0, inverse);
  ck_assert_int_ne(dvi__small_invert(n, inverse), 0);
  ck_assert_double_le(defect_of_product(n, A, inverse, n), 1e-10);
}
END_TEST

START_TEST(near_one_there_is_no_exchange)
{
  const int n = _i, stride = dvi__near_one_stride(n);
  static double A[MOST_NEAR_ONE * MOST_NEAR_ONE], inverse[MOST_NEAR_ONE * MOST_NEAR_ONE];
  double x[MOST_NEAR_ONE], worst = 0;
  fill_matrix(n, stride, 0.2 / n, 1, A);
  fill_matrix(n, stride, 0.2 / n, 1, inverse);
  ck_assert_int_eq(dvi__near_one_invert(n, inverse), 1);
  ck_assert_double_le(defect_of_product(n, A, inverse, stride), 1e-14);
  for (int i = 0; i < n; i++) x[i] = A[i];
  dvi__near_one_times(n, inverse, x);
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(x[i] - (i == 0)));
  ck_assert_double_le(worst, 1e-14);
}
END_TEST

START_TEST(the_sign_is_that_of_the_determinant)
{
  double turn[] = {0, 1, -1, 0}, swap[] = {0, 1, 1, 0}, negative[] = {-2, 0, 0, 3},
         singular[] = {1, 2, 2, 4}, not_a_number[] = {NAN, 1, 1, 1}, tiny[] = {1, 0, 0, 1e-310},
         huge[] = {1, 1, HUGE_VAL, 1};
  ck_assert_int_eq(dvi__small_invert(2, turn), 1);
  ck_assert_int_eq(dvi__small_invert(2, swap), -1);
  ck_assert_int_eq(dvi__small_invert(2, negative), -1);
  ck_assert_int_eq(dvi__small_invert(2, singular), 0);
  ck_assert_int_eq(dvi__small_invert(2, not_a_number), 0);
  ck_assert_int_eq(dvi__small_invert(2, tiny), 0);
  ck_assert_int_eq(dvi__small_invert(2, huge), 0);
  ck_assert_double_eq(turn[1], -1);
  ck_assert_double_eq(negative[0], -0.5);
}
END_TEST

START_TEST(matrices_far_from_one_are_refused)
{
  double small[] = {0.01, 0, 0, 0, 0, 1, 0, 0}, large[] = {1, 0, 0, 0, 0, 100, 0, 0},
         none[] = {1, 0, 0, 0, 0, NAN, 0, 0};
  ck_assert_int_eq(dvi__near_one_invert(2, small), 0);
  ck_assert_int_eq(dvi__near_one_invert(2, large), 0);
  ck_assert_int_eq(dvi__near_one_invert(2, none), 0);
}
END_TEST

/* Fills those of several members, of which one has a pivot far from 1 if it is told. */
static void fill_members(int n, int lost, dvi__abreast *A)
{
  double one[MOST_NEAR_ONE * MOST_NEAR_ONE];
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    fill_matrix(n, n, (0.1 + 0.1 * lane) / n, lane == lost ? 100 : 1, one);
    for (int i = 0; i < n * n; i++) A[i][lane] = one[i];
  }
}

START_TEST(members_have_the_bits_of_one_alone)
{
  const int n = 2 * _i, stride = dvi__near_one_stride(n), lost = _i % 2;
  static dvi__abreast A[MOST_NEAR_ONE * MOST_NEAR_ONE];
  double one[MOST_NEAR_ONE * MOST_NEAR_ONE];
  int regular[DVI__ABREAST];
  for (int lane = 0; lane < DVI__ABREAST; lane++) regular[lane] = 1;
  fill_members(n, lost, A);
  dvi__near_one_invert_abreast(n, A, regular);
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    ck_assert_int_eq(regular[lane], lane != lost);
    fill_matrix(n, stride, (0.1 + 0.1 * lane) / n, lane == lost ? 100 : 1, one);
    ck_assert_int_eq(dvi__near_one_invert(n, one), regular[lane]);
    for (int at = 0; at < n * n && regular[lane]; at++) {
      const double member = A[at][lane];
      ck_assert_mem_eq(&member, &one[at / n * stride + at % n], sizeof member);
    }
  }
}
END_TEST

SUITE(small_inverse)
{
  tcase_add_loop_test(tests, a_matrix_times_its_inverse_is_one, 1, MOST + 1);
  tcase_add_loop_test(tests, near_one_there_is_no_exchange, 1, MOST_NEAR_ONE + 1);
  tcase_add_loop_test(tests, members_have_the_bits_of_one_alone, 1, MOST_NEAR_ONE / 2 + 1);
  tcase_add_test(tests, the_sign_is_that_of_the_determinant);
  tcase_add_test(tests, matrices_far_from_one_are_refused);
}
