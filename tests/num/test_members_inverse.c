/* labels: unit */
/* Inverses of many small matrices side by side have the bits of one alone, and say where
 * elimination without exchanges is not sound. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/members_chord.h"
#include "support/suite.h"

enum { N_MOST = 9, WIDTH_MOST = 35, NUMBERS = N_MOST * N_MOST };

static void best_again(void)
{
  dvi__lanes_choose(-1);
}

/* Entry (i, j) of matrix k, which is symmetric, and positive because its diagonal dominates. */
static double entry(int n, int i, int j, int k)
{
  const double off = sin(1.0 + (i < j ? i + 9 * j : j + 9 * i) + 3 * k);
  return i == j ? n + off : off;
}

static void fill(int n, int width, double *matrix)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      for (int k = 0; k < width; k++) matrix[(j * n + i) * width + k] = entry(n, i, j, k);
}

static double matrix[NUMBERS * WIDTH_MOST], work[N_MOST * WIDTH_MOST];
static char sound[WIDTH_MOST];

START_TEST(an_inverse_times_its_matrix_is_one)
{
  for (int n = 1; n <= N_MOST; n++) {
    fill(n, 1, matrix);
    dvi__members_inverse(n, 1, matrix, work, sound);
    ck_assert_int_eq(sound[0], 1);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        double sum = i == j ? -1 : 0;
        for (int l = 0; l < n; l++) sum += matrix[l * n + i] * entry(n, l, j, 0);
        ck_assert_double_le(fabs(sum), 4 * n * n * DBL_EPSILON); /* condition below 3 */
      }
  }
}
END_TEST

START_TEST(every_member_has_the_bits_of_one_alone)
{
  const int n = 1 + _i % N_MOST;
  double alone[NUMBERS];
  for (int width = 2; width <= WIDTH_MOST; width = width < 9 ? width + 1 : width + 13) {
    dvi__lanes_choose(_i / N_MOST);
    fill(n, width, matrix);
    dvi__members_inverse(n, width, matrix, work, sound);
    dvi__lanes_choose(0);
    for (int k = 0; k < width; k++) {
      char good;
      double largest[N_MOST];
      for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) alone[j * n + i] = entry(n, i, j, k);
      dvi__members_inverse(n, 1, alone, largest, &good);
      ck_assert_int_eq(sound[k], good);
      for (int e = 0; e < n * n; e++)
        ck_assert_mem_eq(&matrix[e * width + k], &alone[e], sizeof(double));
    }
  }
}
END_TEST

/* Matrices of two rows, by columns, side by side: a positive one, one without a diagonal, a
 * singular one, one with NaN, and one of very different units. */
START_TEST(matrices_that_need_exchanges_are_told)
{
  enum { WIDTH = 5 };
  static const double each[WIDTH][4] = {
      {2, 1, 1, 2}, {0, 1, 1, 0}, {1, 1, 1, 1}, {1, (double)NAN, 0, 1}, {1, 1e-9, 1e-9, 1e-12}};
  double all[4 * WIDTH];
  for (int e = 0; e < 4; e++)
    for (int k = 0; k < WIDTH; k++) all[e * WIDTH + k] = each[k][e];
  dvi__members_inverse(2, WIDTH, all, work, sound);
  ck_assert_mem_eq(sound, ((char[]){1, 0, 0, 0, 1}), WIDTH);
  ck_assert_double_eq_tol(all[0], 2.0 / 3, 1e-15);
}
END_TEST

SUITE(members_inverse)
{
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_test(tests, an_inverse_times_its_matrix_is_one);
  tcase_add_loop_test(tests, every_member_has_the_bits_of_one_alone, 0,
                      N_MOST * dvi__lanes_levels());
  tcase_add_test(tests, matrices_that_need_exchanges_are_told);
}
