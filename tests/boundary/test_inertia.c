/* labels: unit */
/* The signs of eigenvalues by block elimination, against matrices whose eigenvalues are known. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "boundary/inertia.h"
#include "support/suite.h"

enum { MOST = 48 };

/* A full pattern holds any matrix. Entries outside of the blocks are 0. */
typedef struct matrix {
  int n;
  dvi__pattern pattern;
  double value[MOST * MOST];
} matrix;

static void make(int n, matrix *m)
{
  *m = (matrix){.n = n};
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){0}, n, "matrix", &m->pattern), DVI_OK);
}

static void set_entry(matrix *m, int i, int j, double value)
{
  m->value[i * m->n + j] = m->value[j * m->n + i] = value;
}

static long negatives(const matrix *m, int size, int block)
{
  long negative = -1;
  ck_assert_msg(dvi__inertia(&m->pattern, m->value, size, block, &negative) == DVI_OK, "%s",
                dvi_last_error());
  return negative;
}

/* 2 - shift on the diagonal, -1 beside it. The eigenvalues are 2 - 2 cos(k pi/(n+1)) - shift.
 * Shifts of 1 and 2 make leading minors zero. */
START_TEST(a_chain_has_its_cosines)
{
  const double shift[] = {-0.1, 0.1, 1.000001, 2 + 1e-9, 2 - 1e-9, 3.1, 4.1};
  for (int n = 2; n <= 40; n += 7)
    for (int s = 0; s < 7; s++) {
      matrix m;
      long expected = 0;
      make(n, &m);
      for (int i = 0; i < n; i++) set_entry(&m, i, i, 2 - shift[s]);
      for (int i = 1; i < n; i++) set_entry(&m, i - 1, i, -1);
      for (int k = 1; k <= n; k++)
        expected += 2 - 2 * cos(k * 3.14159265358979324 / (n + 1)) < shift[s];
      for (int block = 1; block <= n; block++) ck_assert_int_eq(negatives(&m, n, block), expected);
      dvi__pattern_clear(&m.pattern);
    }
}
END_TEST

/* That chain closed to a ring, with 2 - 2 cos(2 k pi/n) - shift. */
START_TEST(a_ring_has_its_cosines)
{
  const double shift[] = {-0.1, 0.1, 1.000001, 2 + 1e-9, 3.1, 4.1};
  for (int n = 3; n <= 40; n++)
    for (int s = 0; s < 6; s++) {
      matrix m;
      long expected = 0;
      make(n, &m);
      for (int i = 0; i < n; i++) set_entry(&m, i, i, 2 - shift[s]);
      for (int i = 0; i < n; i++) set_entry(&m, i, (i + 1) % n, -1);
      for (int k = 0; k < n; k++)
        expected += 2 - 2 * cos(2 * k * 3.14159265358979324 / n) < shift[s];
      for (int block = 1; block <= n; block++) ck_assert_int_eq(negatives(&m, n, block), expected);
      dvi__pattern_clear(&m.pattern);
    }
}
END_TEST

/* Blocks on the diagonal that are zero but for their coupling, [0 1; 1 0] in each. No diagonal
 * pivot can eliminate them. */
START_TEST(zero_diagonals_are_no_trouble)
{
  matrix m;
  make(12, &m);
  for (int i = 0; i < 12; i += 2) set_entry(&m, i, i + 1, 1);
  ck_assert_int_eq(negatives(&m, 12, 4), 6);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

/* Rows behind `size` do not count. */
START_TEST(a_border_is_left_out)
{
  matrix m;
  make(9, &m);
  for (int i = 0; i < 9; i++) set_entry(&m, i, i, i < 8 ? 1 : -5);
  for (int i = 0; i < 8; i++) set_entry(&m, i, 8, 3);
  ck_assert_int_eq(negatives(&m, 8, 3), 0);
  dvi__pattern_clear(&m.pattern);
}
END_TEST

START_TEST(a_singular_complement_is_a_status)
{
  long negative;
  matrix m;
  make(4, &m);
  ck_assert_int_eq(dvi__inertia(&m.pattern, m.value, 4, 2, &negative), DVI_SINGULAR);
  check_words("block 0");
  for (long successes = 0; successes < 3; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__inertia(&m.pattern, m.value, 4, 2, &negative);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
  }
  dvi__pattern_clear(&m.pattern);
}
END_TEST

SUITE(inertia)
{
  tcase_add_test(tests, a_chain_has_its_cosines);
  tcase_add_test(tests, a_ring_has_its_cosines);
  tcase_add_test(tests, zero_diagonals_are_no_trouble);
  tcase_add_test(tests, a_border_is_left_out);
  tcase_add_test(tests, a_singular_complement_is_a_status);
}
