#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <dvi/quadrature.h>

#include "space/quadrature.h"
#include "quad.h"
#include "roundoff.h"
#include "support/suite.h"

enum { RULES = DVI_SIMPSON + 1 };

static int fewest(dvi_rule rule)
{
  int n = 1;
  while (dvi_quadrature_order(rule, n) == 0) n++;
  return n;
}

static int most(dvi_rule rule)
{
  int n = DVI_QUADRATURE_MAX;
  while (dvi_quadrature_order(rule, n) == 0) n--;
  return n;
}

/* P_degree(2 tau - 1), plainly. */
static double legendre(int degree, double tau)
{
  double P = 1, before = 0;
  for (int k = 0; k < degree; k++) {
    const double next = ((2 * k + 1) * (2 * tau - 1) * P - k * before) / (k + 1);
    before = P;
    P = next;
  }
  return P;
}

static double integral_of_legendre(int n, const double *node, const double *weight, int degree)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += weight[i] * legendre(degree, node[i]);
  return sum;
}

#ifdef DVI_HAVE_QUADMATH
/* Distance in units of the last place of the exact number. */
static double ulps(double computed, quad exact)
{
  if (fabsq(exact) < (quad)1e-30) return computed == 0 ? 0 : INFINITY;
  return fabs((double)(((quad)computed - exact) / scalbnq(1, ilogbq(exact) - (DBL_MANT_DIG - 1))));
}

START_TEST(nodes_and_weights_are_right_to_2_ulp_against_quadruple_precision)
{
  double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX], worst_node = 0, worst_weight = 0;
  quad exact_node[DVI_QUADRATURE_MAX], exact_weight[DVI_QUADRATURE_MAX];
  const dvi_rule rule = (dvi_rule)_i;
  /* the one-size rules are members of these families */
  const dvi_rule family = rule == DVI_MIDPOINT  ? DVI_GAUSS
                          : rule > DVI_MIDPOINT ? DVI_CLENSHAW_CURTIS
                                                : rule;
  for (int n = fewest(rule); n <= most(rule); n++) {
    quad_rule(family, n, exact_node, exact_weight);
    ck_assert_int_eq(dvi_quadrature(rule, n, node, weight), DVI_OK);
    for (int i = 0; i < n; i++) {
      worst_node = fmax(worst_node, ulps(node[i], exact_node[i]));
      worst_weight = fmax(worst_weight, ulps(weight[i], exact_weight[i]));
    }
  }
  printf("%-16s worst node %.3f ulp, weight %.3f ulp\n", dvi_rule_name(rule), worst_node,
         worst_weight);
  ck_assert_double_le(worst_node, 2);
  ck_assert_double_le(worst_weight, 2);
}
END_TEST
#endif

START_TEST(a_rule_of_order_p_is_exact_below_degree_p_and_not_at_p)
{
  const dvi_rule rule = (dvi_rule)_i;
  double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  for (int n = fewest(rule); n <= most(rule); n++) {
    const int order = dvi_quadrature_order(rule, n);
    ck_assert_int_eq(dvi_quadrature(rule, n, node, weight), DVI_OK);
    /* |P_k| <= 1, and the roundoff of its recurrence grows with the degree */
    for (int degree = 0; degree < order; degree++)
      ck_assert_double_eq_tol(integral_of_legendre(n, node, weight, degree), degree == 0,
                              2e-16 * (4 + order));
    /* Gauss and its kin miss the first degree by about 1/n, Clenshaw-Curtis by about 1/n^3 */
    ck_assert_double_ge(fabs(integral_of_legendre(n, node, weight, order)), 0.2 / pow(n, 3));
  }
}
END_TEST

START_TEST(nodes_ascend_in_the_unit_interval_and_weights_are_positive)
{
  double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  const dvi_rule rule = (dvi_rule)_i;
  for (int n = fewest(rule); n <= most(rule); n++) {
    ck_assert_int_eq(dvi_quadrature(rule, n, node, weight), DVI_OK);
    ck_assert(node[0] >= 0 && node[n - 1] <= 1);
    for (int i = 0; i < n; i++) ck_assert_double_gt(weight[i], 0);
    for (int i = 1; i < n; i++) ck_assert_double_gt(node[i], node[i - 1]);
  }
}
END_TEST

/* All but the Radau rules. */
static const dvi_rule symmetric_rules[] = {DVI_GAUSS,    DVI_LOBATTO,   DVI_CLENSHAW_CURTIS,
                                           DVI_MIDPOINT, DVI_TRAPEZOID, DVI_SIMPSON};
enum { SYMMETRIC_RULES = RULES - 2 };

START_TEST(symmetric_rules_are_symmetric_to_the_last_bit)
{
  long double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  const dvi_rule rule = symmetric_rules[_i];
  for (int n = fewest(rule); n <= most(rule); n++) {
    ck_assert_int_eq(dvi__quadrature_long(rule, n, node, weight), DVI_OK);
    for (int i = 0; i <= (n - 1) / 2; i++) {
      ck_assert(weight[i] == weight[n - 1 - i]);
      /* the right one is rounded from the left one, which has more digits */
      ck_assert(node[n - 1 - i] == 1 - node[i]);
    }
  }
}
END_TEST

START_TEST(the_radau_rules_mirror_each_other)
{
  long double left[DVI_QUADRATURE_MAX], left_weight[DVI_QUADRATURE_MAX];
  long double right[DVI_QUADRATURE_MAX], right_weight[DVI_QUADRATURE_MAX];
  for (int n = 1; n <= DVI_QUADRATURE_MAX; n++) {
    ck_assert_int_eq(dvi__quadrature_long(DVI_RADAU_LEFT, n, left, left_weight), DVI_OK);
    ck_assert_int_eq(dvi__quadrature_long(DVI_RADAU_RIGHT, n, right, right_weight), DVI_OK);
    for (int i = 0; i < n; i++) {
      ck_assert(left_weight[i] == right_weight[n - 1 - i]);
      /* one of the two is 1 minus the other, rounded */
      ck_assert(fabsl(left[i] + right[n - 1 - i] - 1) <= long_roundoff());
    }
    ck_assert(left[0] == 0 && right[n - 1] == 1);
  }
}
END_TEST

START_TEST(the_one_size_rules_have_their_textbook_numbers)
{
  double node[3], weight[3];
  ck_assert_int_eq(dvi_quadrature(DVI_MIDPOINT, 1, node, weight), DVI_OK);
  ck_assert(node[0] == 0.5 && weight[0] == 1);
  ck_assert_int_eq(dvi_quadrature(DVI_TRAPEZOID, 2, node, weight), DVI_OK);
  ck_assert(node[0] == 0 && node[1] == 1 && weight[0] == 0.5 && weight[1] == 0.5);
  ck_assert_int_eq(dvi_quadrature(DVI_SIMPSON, 3, node, weight), DVI_OK);
  ck_assert(node[0] == 0 && node[1] == 0.5 && node[2] == 1);
  ck_assert(weight[0] == 1.0 / 6 && weight[1] == 2.0 / 3 && weight[2] == 1.0 / 6);
}
END_TEST

START_TEST(bad_sizes_are_refused_and_nothing_is_written)
{
  static const struct {
    dvi_rule rule;
    int n;
  } bad[] = {{DVI_GAUSS, 0},
             {DVI_GAUSS, -1},
             {DVI_GAUSS, DVI_QUADRATURE_MAX + 1},
             {DVI_LOBATTO, 1},
             {DVI_LOBATTO, DVI_QUADRATURE_MAX + 1},
             {DVI_RADAU_LEFT, 0},
             {DVI_RADAU_RIGHT, DVI_QUADRATURE_MAX + 1},
             {DVI_CLENSHAW_CURTIS, 1},
             {DVI_MIDPOINT, 0},
             {DVI_MIDPOINT, 2},
             {DVI_TRAPEZOID, 1},
             {DVI_TRAPEZOID, 3},
             {DVI_SIMPSON, 2},
             {DVI_SIMPSON, 4}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double node[DVI_QUADRATURE_MAX + 1] = {7}, weight[DVI_QUADRATURE_MAX + 1] = {7};
    ck_assert_int_eq(dvi_quadrature(bad[i].rule, bad[i].n, node, weight), DVI_BAD_SIZE);
    ck_assert(node[0] == 7 && weight[0] == 7);
    ck_assert_ptr_nonnull(strstr(dvi_last_error(), dvi_rule_name(bad[i].rule)));
    ck_assert_int_eq(dvi_quadrature_order(bad[i].rule, bad[i].n), 0);
  }
}
END_TEST

START_TEST(unknown_rules_and_missing_arrays_are_refused_and_nothing_is_written)
{
  double node[2] = {7, 7}, weight[2] = {7, 7};
  ck_assert_int_eq(dvi_quadrature((dvi_rule)RULES, 2, node, weight), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_quadrature((dvi_rule)-1, 2, node, weight), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_quadrature(DVI_GAUSS, 2, NULL, weight), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_quadrature(DVI_GAUSS, 2, node, NULL), DVI_BAD_ARGUMENT);
  ck_assert(node[0] == 7 && node[1] == 7 && weight[0] == 7 && weight[1] == 7);
  ck_assert_int_eq(dvi_quadrature_order((dvi_rule)RULES, 2), 0);
  ck_assert_ptr_null(dvi_rule_name((dvi_rule)RULES));
  ck_assert_ptr_null(dvi_rule_name((dvi_rule)-1));
}
END_TEST

START_TEST(every_rule_has_a_name_of_its_own)
{
  for (int i = 0; i < RULES; i++)
    for (int j = 0; j < i; j++)
      ck_assert_str_ne(dvi_rule_name((dvi_rule)i), dvi_rule_name((dvi_rule)j));
}
END_TEST

SUITE(quadrature)
{
#ifdef DVI_HAVE_QUADMATH
  if (long_double_is_long()) /* promised only there */
    tcase_add_loop_test(tests, nodes_and_weights_are_right_to_2_ulp_against_quadruple_precision, 0,
                        RULES);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_loop_test(tests, a_rule_of_order_p_is_exact_below_degree_p_and_not_at_p, 0, RULES);
  tcase_add_loop_test(tests, nodes_ascend_in_the_unit_interval_and_weights_are_positive, 0, RULES);
  tcase_add_loop_test(tests, symmetric_rules_are_symmetric_to_the_last_bit, 0, SYMMETRIC_RULES);
  tcase_add_test(tests, the_radau_rules_mirror_each_other);
  tcase_add_test(tests, the_one_size_rules_have_their_textbook_numbers);
  tcase_add_test(tests, bad_sizes_are_refused_and_nothing_is_written);
  tcase_add_test(tests, unknown_rules_and_missing_arrays_are_refused_and_nothing_is_written);
  tcase_add_test(tests, every_rule_has_a_name_of_its_own);
}
