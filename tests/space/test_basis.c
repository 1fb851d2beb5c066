#include <float.h>
#include <math.h>
#include <stdio.h>

#include <dvi/basis.h>

#include "space/basis.h"
#include "quad.h"
#include "roundoff.h"
#include "support/suite.h"

#define MODAL DVI_LEGENDRE
#define BASES (DVI_CHEBYSHEV + 1)

/* Gives points of all kinds: inside, outside, at the ends, very near to the ends and to the middle,
 * and all around each node. */
static int points(dvi_basis basis, int degree, double *tau)
{
  static const double fixed[] = {
      -1, -0.3, -1e-17, 0, 1e-300, 1e-17, 1e-9, 0.1234, 0.49999999999999994, 0.5, 0.7, 1, 1.01, 2};
  double node[DVI_DEGREE_MAX + 1];
  int count = 0;
  for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++) tau[count++] = fixed[i];
  if (basis >= MODAL) return count;
  ck_assert_int_eq(dvi_basis_nodes(basis, degree, node), DVI_OK);
  for (int k = 0; k <= degree; k++) {
    tau[count++] = node[k];
    tau[count++] = nextafter(node[k], 2);
    tau[count++] = node[k] + 1e-12;
  }
  return count;
}

static double largest(int count, const double *x)
{
  double most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

#ifdef DVI_HAVE_QUADMATH
static void quad_nodes(dvi_basis basis, int degree, quad *node)
{
  quad weight[DVI_DEGREE_MAX + 1];
  if (basis == DVI_LAGRANGE_LOBATTO) quad_rule(DVI_LOBATTO, degree + 1, node, weight);
  if (basis == DVI_LAGRANGE_GAUSS) quad_rule(DVI_GAUSS, degree + 1, node, weight);
  for (int k = 0; k <= degree; k++) {
    if (basis == DVI_LAGRANGE_CHEBYSHEV) node[k] = (1 - cosq(k * quad_pi() / degree)) / 2;
    if (basis == DVI_LAGRANGE_EQUISPACED) node[k] = (quad)k / degree;
  }
}

/* Evaluates by the definition, products for nodal bases, the recurrences in x = 2 tau - 1 for modal
 * ones. */
static void quad_basis(dvi_basis basis, int degree, const quad *node, quad tau, quad *value,
                       quad *slope)
{
  const quad x = 2 * tau - 1;
  for (int k = 0; k <= degree; k++) {
    if (basis < MODAL) {
      value[k] = quad_cardinal(degree + 1, node, k, tau, &slope[k]);
    } else if (basis == DVI_LEGENDRE) {
      value[k] = quad_legendre(k, x, NULL, &slope[k]);
      slope[k] *= 2;
    } else {
      value[k] = k == 0 ? 1 : k == 1 ? x : 2 * x * value[k - 1] - value[k - 2];
      slope[k] = k == 0 ? 0 : k == 1 ? 2 : 4 * value[k - 1] + 2 * x * slope[k - 1] - slope[k - 2];
    }
  }
}

static double worst_relative(int count, const double *computed, const quad *exact)
{
  double worst = 0;
  for (int k = 0; k < count; k++) worst = fmax(worst, fabs((double)((quad)computed[k] - exact[k])));
  return worst / largest(count, computed);
}

START_TEST(values_and_derivatives_are_right_to_2_units_of_the_largest_against_quadruple_precision)
{
  const dvi_basis basis = (dvi_basis)_i;
  double tau[4 * DVI_DEGREE_MAX], value[DVI_DEGREE_MAX + 1], slope[DVI_DEGREE_MAX + 1],
      worst = 0, worst_slope = 0;
  quad node[DVI_DEGREE_MAX + 1], exact[DVI_DEGREE_MAX + 1], exact_slope[DVI_DEGREE_MAX + 1];
  static const int degrees[] = {1, 2, 3, 4, 7, 12, 25, DVI_DEGREE_MAX};
  for (size_t d = 0; d < sizeof degrees / sizeof *degrees; d++) {
    /* products cost degree^3 */
    const int degree = degrees[d], count = points(basis, degree, tau), stride = degree > 12 ? 5 : 1;
    quad_nodes(basis, degree, node);
    for (int i = 0; i < count; i += i < 14 ? 1 : stride) {
      ck_assert_int_eq(dvi_basis_evaluate(basis, degree, tau[i], value, slope), DVI_OK);
      quad_basis(basis, degree, node, tau[i], exact, exact_slope);
      worst = fmax(worst, worst_relative(degree + 1, value, exact));
      worst_slope = fmax(worst_slope, worst_relative(degree + 1, slope, exact_slope));
    }
  }
  printf("%-18s worst value %.2f, derivative %.2f units\n", dvi_basis_name(basis),
         worst / DBL_EPSILON, worst_slope / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
  ck_assert_double_le(worst_slope, 2 * DBL_EPSILON);
}
END_TEST
#endif

START_TEST(nodal_functions_sum_to_1_and_their_derivatives_to_0)
{
  double tau[4 * DVI_DEGREE_MAX], value[DVI_DEGREE_MAX + 1], slope[DVI_DEGREE_MAX + 1];
  for (int degree = 1; degree <= DVI_DEGREE_MAX; degree++) {
    const int count = points((dvi_basis)_i, degree, tau);
    for (int i = 0; i < count; i++) {
      double sum = 0, slope_sum = 0;
      ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, degree, tau[i], value, slope), DVI_OK);
      for (int k = 0; k <= degree; k++) {
        sum += value[k];
        slope_sum += slope[k];
      }
      /* each function and each addition is rounded to half an ulp, with a tenfold margin for the
       * narrow long double */
      const double roundoff = 10 * (degree + 1) * DBL_EPSILON;
      ck_assert_double_eq_tol(sum, 1, roundoff * fmax(1, largest(degree + 1, value)));
      ck_assert_double_eq_tol(slope_sum, 0, roundoff * largest(degree + 1, slope));
    }
  }
}
END_TEST

START_TEST(a_nodal_function_is_1_at_its_node_and_0_at_the_others)
{
  dvi__space space;
  long double value[DVI__TRIAL_MAX];
  for (int degree = 1; degree <= DVI_DEGREE_MAX; degree++) {
    /* other nodes are no binary fractions */
    if (_i == DVI_LAGRANGE_EQUISPACED && degree & (degree - 1)) continue;
    dvi__space_init(&space, (dvi_basis)_i, degree);
    for (int k = 0; k <= degree; k++) {
      dvi__space_evaluate(&space, space.mark[k] / space.scale, value, NULL);
      /* the 0 has a factor 0, the 1 is a product and its inverse */
      for (int j = 0; j <= degree; j++)
        ck_assert(j == k ? fabsl(value[j] - 1) <= 2 * DVI_DEGREE_MAX * long_roundoff()
                         : value[j] == 0);
    }
  }
}
END_TEST

START_TEST(the_modal_functions_are_interpolated_exactly_by_every_nodal_basis)
{
  dvi__space nodal, modal;
  long double at_node[DVI__TRIAL_MAX], cardinal[DVI__TRIAL_MAX], cardinal_slope[DVI__TRIAL_MAX];
  long double value[DVI__TRIAL_MAX], slope[DVI__TRIAL_MAX];
  for (int b = MODAL; b < BASES; b++)
    for (int degree = 1; degree <= DVI_DEGREE_MAX; degree++) {
      dvi__space_init(&nodal, (dvi_basis)_i, degree);
      dvi__space_init(&modal, (dvi_basis)b, degree);
      const long double tau = 0.3L;
      dvi__space_evaluate(&nodal, tau, cardinal, cardinal_slope);
      dvi__space_evaluate(&modal, tau, value, slope);
      for (int m = 0; m <= degree; m++) {
        long double sum = 0, slope_sum = 0, size = 0, slope_size = 0;
        for (int k = 0; k <= degree; k++) {
          dvi__space_evaluate(&modal, nodal.mark[k] / nodal.scale, at_node, NULL);
          sum += at_node[m] * cardinal[k];
          slope_sum += at_node[m] * cardinal_slope[k];
          size += fabsl(cardinal[k]);
          slope_size += fabsl(cardinal_slope[k]);
        }
        /* a node's roundoff moves a modal function by up to 2 degree^2 units */
        const long double roundoff = 4 * (long double)(degree * degree) * long_roundoff();
        ck_assert(fabsl(sum - value[m]) <= roundoff * size);
        ck_assert(fabsl(slope_sum - slope[m]) <= roundoff * slope_size);
      }
    }
}
END_TEST

START_TEST(modal_functions_are_1_at_the_right_end_and_alternate_at_the_left_one)
{
  double value[DVI_DEGREE_MAX + 1], slope[DVI_DEGREE_MAX + 1];
  const dvi_basis basis = (dvi_basis)_i;
  for (int end = 0; end <= 1; end++) {
    ck_assert_int_eq(dvi_basis_evaluate(basis, DVI_DEGREE_MAX, end, value, slope), DVI_OK);
    for (int k = 0; k <= DVI_DEGREE_MAX; k++) {
      const double sign = !end && k % 2 ? -1 : 1;
      ck_assert(value[k] == sign);
      /* P_k'(1) = k(k+1)/2, T_k'(1) = k^2, and twice that with respect to tau */
      ck_assert(slope[k] ==
                (end ? sign : -sign) * (basis == DVI_LEGENDRE ? k * (k + 1) : 2 * k * k));
    }
  }
}
END_TEST

START_TEST(nodes_ascend_and_are_symmetric)
{
  double node[DVI_DEGREE_MAX + 1];
  for (int degree = 1; degree <= DVI_DEGREE_MAX; degree++) {
    ck_assert_int_eq(dvi_basis_nodes((dvi_basis)_i, degree, node), DVI_OK);
    ck_assert((node[0] == 0 && node[degree] == 1) || _i == DVI_LAGRANGE_GAUSS);
    for (int k = 1; k <= degree; k++) ck_assert_double_gt(node[k], node[k - 1]);
    /* two roundings */
    for (int k = 0; k <= degree; k++)
      ck_assert_double_eq_tol(node[k] + node[degree - k], 1, DBL_EPSILON);
  }
}
END_TEST

START_TEST(either_output_may_be_left_out)
{
  double value[3], alone[3];
  ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, 2, 0.3, value, NULL), DVI_OK);
  ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, 2, 0.3, NULL, alone), DVI_OK);
  double both[3], both_slope[3];
  ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, 2, 0.3, both, both_slope), DVI_OK);
  for (int k = 0; k < 3; k++) ck_assert(value[k] == both[k] && alone[k] == both_slope[k]);
}
END_TEST

START_TEST(bad_arguments_are_refused_and_nothing_is_written)
{
  static const int degrees[] = {-1, 0, DVI_DEGREE_MAX + 1};
  double value[2] = {7, 7}, slope[2] = {7, 7};
  for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
    ck_assert_int_eq(dvi_basis_evaluate(DVI_LEGENDRE, degrees[i], 0.5, value, slope), DVI_BAD_SIZE);
    ck_assert_int_eq(dvi_basis_nodes(DVI_LAGRANGE_GAUSS, degrees[i], value), DVI_BAD_SIZE);
  }
  ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)BASES, 1, 0.5, value, slope), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)-1, 1, 0.5, value, slope), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_evaluate(DVI_LEGENDRE, 1, (double)NAN, value, slope),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_evaluate(DVI_LEGENDRE, 1, -(double)INFINITY, value, slope),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_nodes((dvi_basis)BASES, 1, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_nodes(DVI_LEGENDRE, 1, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_nodes(DVI_CHEBYSHEV, 1, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_basis_nodes(DVI_LAGRANGE_GAUSS, 1, NULL), DVI_BAD_ARGUMENT);
  ck_assert(value[0] == 7 && value[1] == 7 && slope[0] == 7 && slope[1] == 7);
}
END_TEST

START_TEST(every_basis_has_a_name_of_its_own)
{
  for (int i = 0; i < BASES; i++)
    for (int j = 0; j < i; j++)
      ck_assert_str_ne(dvi_basis_name((dvi_basis)i), dvi_basis_name((dvi_basis)j));
  ck_assert_ptr_null(dvi_basis_name((dvi_basis)BASES));
  ck_assert_ptr_null(dvi_basis_name((dvi_basis)-1));
}
END_TEST

SUITE(basis)
{
#ifdef DVI_HAVE_QUADMATH
  if (long_double_is_long()) /* promised only there */
    tcase_add_loop_test(
        tests,
        values_and_derivatives_are_right_to_2_units_of_the_largest_against_quadruple_precision, 0,
        BASES);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_loop_test(tests, nodal_functions_sum_to_1_and_their_derivatives_to_0, 0, MODAL);
  tcase_add_loop_test(tests, a_nodal_function_is_1_at_its_node_and_0_at_the_others, 0, MODAL);
  tcase_add_loop_test(tests, the_modal_functions_are_interpolated_exactly_by_every_nodal_basis, 0,
                      MODAL);
  tcase_add_loop_test(tests, modal_functions_are_1_at_the_right_end_and_alternate_at_the_left_one,
                      MODAL, BASES);
  tcase_add_loop_test(tests, nodes_ascend_and_are_symmetric, 0, MODAL);
  tcase_add_loop_test(tests, either_output_may_be_left_out, 0, BASES);
  tcase_add_test(tests, bad_arguments_are_refused_and_nothing_is_written);
  tcase_add_test(tests, every_basis_has_a_name_of_its_own);
}
