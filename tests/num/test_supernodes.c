/* The factor L D L^T in dense blocks, of matrices for which num/ldl.c chooses it. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/linear.h"
#include "num/supernodal/supernodes.h"
#include "support/suite.h"

/* A symmetric matrix that is diagonally dominant, and the product of it with (1, 2, .., n). */
typedef struct net {
  dvi__pattern pattern;
  double *values, *b;
} net;

static double entry(int i, int j)
{
  return i == j ? 12 : sin(i + j);
}

/* Couples neighbours of a square, also across the corners, or all with all. */
static int is_coupled(int side, int is_full, int i, int j)
{
  return is_full || (abs(i % side - j % side) <= 1 && abs(i / side - j / side) <= 1);
}

/* Full ones are dominated by n on the diagonal. */
static net make_net(int side, int is_full)
{
  const int n = side * side, reach = is_full ? n : side + 1;
  net made = {.pattern = {.rows = n, .columns = n, .start = DVI_NEW(int, n + 1)}};
  const size_t most = (size_t)n * (size_t)(is_full ? n : 9);
  made.pattern.row = DVI_NEW(int, most);
  made.values = DVI_NEW(double, most);
  made.b = DVI_NEW(double, n);
  for (int j = 0, count = 0; j < n; j++) {
    for (int i = j < reach ? 0 : j - reach; i < n && i <= j + reach; i++) {
      if (!is_coupled(side, is_full, i, j)) continue;
      made.pattern.row[count] = i;
      made.values[count] = entry(i, j) + (i == j && is_full ? n : 0);
      made.b[i] += made.values[count++] * (j + 1);
    }
    made.pattern.start[j + 1] = count;
  }
  return made;
}

static void clear_net(net *of)
{
  dvi__pattern_clear(&of->pattern);
  dvi__release(of->values);
  dvi__release(of->b);
}

static dvi__linear *factor(const net *of)
{
  dvi__linear *linear;
  ck_assert_int_eq(dvi__linear_create(&of->pattern, DVI__LINEAR_DEFINITE, NULL, &linear), DVI_OK);
  ck_assert_msg(dvi__linear_factor(linear, of->values) == DVI_OK, "%s", dvi_last_error());
  return linear;
}

/* 0: supernodes of all widths and heights; 1: one supernode of several panels. The condition is
 * below 10, so that errors are some units of roundoff. */
START_TEST(solutions_are_right_and_stay_so_with_the_next_factor)
{
  const int n = _i ? 169 : 3600;
  net made = make_net(_i ? 13 : 60, _i);
  dvi__linear *linear = factor(&made);
  double *x = DVI_NEW(double, n);
  for (int time = 0; time < 2; time++) {
    for (int i = 0; i < n; i++) x[i] = made.b[i];
    ck_assert_int_eq(dvi__linear_solve(linear, x), DVI_OK);
    for (int i = 0; i < n; i++) ck_assert_double_eq_tol(x[i], i + 1, 1e-14 * n);
    ck_assert_int_eq(dvi__linear_factor(linear, made.values), DVI_OK);
  }
  ck_assert_double_ge(dvi__linear_cost_of(linear).entries, _i ? n * (n + 1) / 2.0 : 20.0 * n);
  ck_assert(dvi__linear_condition(linear) > 0.1 && dvi__linear_condition(linear) <= 1);
  dvi__release(x);
  dvi__linear_destroy(&linear);
  clear_net(&made);
}
END_TEST

/* D holds the squares of the scales, and so rounding does not see them. */
START_TEST(powers_of_two_as_scales_change_no_bit)
{
  net made = make_net(60, 0);
  const int n = made.pattern.columns;
  double *x = DVI_NEW(double, 2 * (size_t)n), *scaled = x + n;
  for (int i = 0; i < n; i++) {
    x[i] = made.b[i];
    scaled[i] = ldexp(made.b[i], i % 31 - 15);
  }
  dvi__linear *linear = factor(&made);
  ck_assert_int_eq(dvi__linear_solve(linear, x), DVI_OK);
  for (int j = 0; j < n; j++)
    for (int e = made.pattern.start[j]; e < made.pattern.start[j + 1]; e++)
      made.values[e] = ldexp(made.values[e], made.pattern.row[e] % 31 + j % 31 - 30);
  ck_assert_int_eq(dvi__linear_factor(linear, made.values), DVI_OK);
  ck_assert_int_eq(dvi__linear_solve(linear, scaled), DVI_OK);
  for (int i = 0; i < n; i++) ck_assert_double_eq(ldexp(scaled[i], i % 31 - 15), x[i]);
  dvi__release(x);
  dvi__linear_destroy(&linear);
  clear_net(&made);
}
END_TEST

START_TEST(one_negative_direction_anywhere_is_refused)
{
  net made = make_net(13, 1);
  const int n = made.pattern.columns;
  dvi__linear *linear = factor(&made);
  for (int i = 0; i < n; i += 21) {
    const int at = dvi__pattern_find(&made.pattern, i, i);
    const double kept = made.values[at];
    made.values[at] = -1;
    ck_assert_int_eq(dvi__linear_factor(linear, made.values), DVI_SINGULAR);
    made.values[at] = kept;
  }
  ck_assert_int_eq(dvi__linear_factor(linear, made.values), DVI_OK);
  dvi__linear_destroy(&linear);
  clear_net(&made);
}
END_TEST

/* The paths to the root are 0 -> 4 -> 6, 2 -> 4 -> 6, and 1 -> 3 -> 5 -> 6. */
START_TEST(a_postorder_has_children_right_before_their_parents)
{
  const int parent[] = {4, 3, 4, 5, 6, 6, -1}, expected[] = {0, 2, 4, 1, 3, 5, 6};
  int order[7], work[21];
  dvi__elimination_postorder(7, parent, order, work);
  for (int k = 0; k < 7; k++) ck_assert_int_eq(order[k], expected[k]);
}
END_TEST

SUITE(supernodes)
{
  tcase_add_loop_test(tests, solutions_are_right_and_stay_so_with_the_next_factor, 0, 2);
  tcase_add_test(tests, powers_of_two_as_scales_change_no_bit);
  tcase_add_test(tests, one_negative_direction_anywhere_is_refused);
  tcase_add_test(tests, a_postorder_has_children_right_before_their_parents);
}
