#include "num/pfaffian.h"
#include "support/suite.h"

enum { MOST = 6 };

static void fill(size_t n, const double *above, double *A)
{
  for (size_t i = 0; i < n; i++) {
    A[i * n + i] = 0;
    for (size_t j = i + 1; j < n; j++) {
      A[i * n + j] = *above++;
      A[j * n + i] = -A[i * n + j];
    }
  }
}

/* By rows above the diagonal. Pf of four is a12 a34 - a13 a24 + a14 a23. */
static const struct {
  size_t n;
  double above[15];
  int sign;
} matrices[] = {
    {2, {3}, 1},
    {2, {-1e-200}, -1},
    {2, {0}, 0},
    {4, {1, 0, 0, 0, 0, 1}, 1},
    /* q and p one after the other, a13 a24 */
    {4, {0, 1, 0, 0, 1, 0}, -1},
    {4, {1, 2, 3, 4, 5, 6}, 1},                             /* 6 - 10 + 12 */
    {4, {1, 9, 3, 4, 5, 6}, -1},                            /* 6 - 45 + 12 */
    {4, {1, 2, 1, 1, 1, 1}, 0},                             /* 1 - 2 + 1 */
    {4, {1e-9, 1, 0, 0, 1, 1e9}, 0},                        /* 1 - 1, an unlucky first pivot */
    {6, {0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, -1}, /* (-1)^(3 (3-1)/2) */
    {6, {0, 0, 0, 0, 2, 0, 0, -3, 0, 5, 0, 0, 0, 0, 0}, -1},
};

START_TEST(the_sign_is_that_of_the_pfaffian)
{
  double A[MOST * MOST];
  fill(matrices[_i].n, matrices[_i].above, A);
  ck_assert_int_eq(dvi__pfaffian_sign(matrices[_i].n, A), matrices[_i].sign);
}
END_TEST

/* Exchanging two rows and the same columns turns it. */
START_TEST(an_exchange_turns_it)
{
  double A[MOST * MOST], B[MOST * MOST];
  static const double above[15] = {0.3, -1, 2, 0.7, 5, 1, 1, -3, 2, 0.1, 4, 1, -2, 6, 0.5};
  for (size_t a = 0; a < MOST; a++)
    for (size_t b = 0; b < a; b++) {
      fill(MOST, above, A);
      for (size_t i = 0; i < MOST; i++)
        for (size_t j = 0; j < MOST; j++) {
          const size_t k = i == a ? b : i == b ? a : i, l = j == a ? b : j == b ? a : j;
          B[i * MOST + j] = A[k * MOST + l];
        }
      ck_assert_int_eq(dvi__pfaffian_sign(MOST, A), -dvi__pfaffian_sign(MOST, B));
    }
}
END_TEST

SUITE(pfaffian)
{
  tcase_add_loop_test(tests, the_sign_is_that_of_the_pfaffian, 0,
                      sizeof matrices / sizeof *matrices);
  tcase_add_test(tests, an_exchange_turns_it);
}
