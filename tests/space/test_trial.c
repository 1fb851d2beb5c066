#include <float.h>
#include <math.h>

#include "space/quadrature.h"
#include "space/trial.h"
#include "roundoff.h"
#include "support/suite.h"

enum { BASES = DVI_CHEBYSHEV + 1, MOST = DVI_DEGREE_MAX };

/* A polynomial with coefficients of all sizes, of this degree in x = 2 tau - 1, and its primitive's
 * difference. */
static double polynomial(int degree, double tau)
{
  double sum = 0;
  for (int m = degree; m >= 0; m--) sum = (2 * tau - 1) * sum + cos(3 * m + 1);
  return sum;
}

static double evaluate(dvi_basis basis, int degree, const double *Y, double tau)
{
  double psi[MOST], sum = 0;
  dvi__trial_at(basis, degree, tau, psi, NULL, NULL);
  for (int k = 0; k < degree; k++) sum += psi[k] * Y[k];
  return sum;
}

static void multiply(int rows, int columns, const double *matrix, const double *x, double *y)
{
  for (int i = 0; i < rows; i++) {
    y[i] = 0;
    for (int j = 0; j < columns; j++) y[i] += matrix[i * columns + j] * x[j];
  }
}

/* Coefficients of polynomial() - polynomial(0) from its values at Gauss points. */
static void fit(dvi_basis basis, int degree, int points, int polynomial_degree, double *Y)
{
  double tau[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX], value[DVI_QUADRATURE_MAX],
      matrix[MOST * DVI_QUADRATURE_MAX];
  ck_assert_int_eq(dvi_quadrature(DVI_GAUSS, points, tau, weight), DVI_OK);
  for (int i = 0; i < points; i++)
    value[i] = polynomial(polynomial_degree, tau[i]) - polynomial(polynomial_degree, 0);
  dvi__trial_fit(basis, degree, points, tau, matrix);
  multiply(degree, points, matrix, value, Y);
}

/* The error of a sum of numbers near 1. Where long double is as short as double, nothing hides the
 * roundoff inside. */
static double roundoff(void)
{
  return long_double_is_long() ? DBL_EPSILON : 50 * DBL_EPSILON;
}

/* Values of equispaced coefficients are rounded like all others, but their functions are as large
 * as 2^degree / degree. */
static int highest(dvi_basis basis)
{
  return basis == DVI_LAGRANGE_EQUISPACED ? 12 : MOST;
}

START_TEST(psi_vanishes_at_0_and_bar_at_1)
{
  double psi[MOST], bar[MOST];
  for (int degree = 1; degree <= MOST; degree++) {
    dvi__trial_at((dvi_basis)_i, degree, 0, psi, NULL, NULL);
    dvi__trial_at((dvi_basis)_i, degree, 1, NULL, bar, NULL);
    for (int k = 0; k < degree; k++) ck_assert(psi[k] == 0 && bar[k] == 0);
  }
}
END_TEST

START_TEST(psi_and_bar_are_the_basis_less_its_ends)
{
  double psi[MOST], bar[MOST], dpsi[MOST], value[MOST + 1], slope[MOST + 1], left[MOST + 1],
      right[MOST + 1];
  for (int degree = 1; degree <= MOST; degree++) {
    const double tau = 0.37;
    ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, degree, tau, value, slope), DVI_OK);
    ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, degree, 0, left, NULL), DVI_OK);
    ck_assert_int_eq(dvi_basis_evaluate((dvi_basis)_i, degree, 1, right, NULL), DVI_OK);
    dvi__trial_at((dvi_basis)_i, degree, tau, psi, bar, dpsi);
    /* two roundings of numbers of at most the larger size, then one */
    for (int k = 1; k <= degree; k++) {
      ck_assert_double_eq_tol(psi[k - 1], value[k] - left[k],
                              2 * DBL_EPSILON * fmax(fabs(value[k]), fabs(left[k])));
      ck_assert_double_eq_tol(bar[k - 1], value[k] - right[k],
                              2 * DBL_EPSILON * fmax(fabs(value[k]), fabs(right[k])));
      ck_assert(dpsi[k - 1] == slope[k]);
    }
  }
}
END_TEST

START_TEST(psi_keeps_its_digits_near_0)
{
  double psi[MOST], dpsi[MOST];
  /* so small that 1 + tau rounds to 1 in double, and the next term is degree^4 tau^2 */
  const double tau = 1e-3 * DBL_EPSILON;
  dvi__trial_at((dvi_basis)_i, 5, tau, psi, NULL, NULL);
  dvi__trial_at((dvi_basis)_i, 5, 0, NULL, NULL, dpsi);
  /* roundoff of long double is near tau / 2 */
  for (int k = 0; k < 5; k++) ck_assert_double_eq_tol(psi[k] / tau, dpsi[k], 1.5);
}
END_TEST

START_TEST(the_tables_are_the_same_from_a_space_made_once)
{
  double psi[MOST], bar[MOST], dpsi[MOST], psi_once[MOST], bar_once[MOST], dpsi_once[MOST];
  dvi__space space;
  dvi__space_init(&space, (dvi_basis)_i, 7);
  dvi__trial_at((dvi_basis)_i, 7, 0.625, psi, bar, dpsi);
  dvi__trial_in(&space, 0.625L, psi_once, bar_once, dpsi_once);
  for (int k = 0; k < 7; k++)
    ck_assert(psi[k] == psi_once[k] && bar[k] == bar_once[k] && dpsi[k] == dpsi_once[k]);
}
END_TEST

START_TEST(fit_gives_back_a_polynomial_from_its_values)
{
  const dvi_basis basis = (dvi_basis)_i;
  double Y[MOST];
  for (int degree = 1; degree <= highest(basis); degree++)
    for (int more = 0; more <= 3; more++) {
      fit(basis, degree, degree + more, degree, Y);
      /* values up to degree, each rounded, with Lebesgue constants below 50 */
      for (double tau = 0; tau <= 1; tau += 0.125)
        ck_assert_double_eq_tol(evaluate(basis, degree, Y, tau),
                                polynomial(degree, tau) - polynomial(degree, 0),
                                100 * degree * roundoff());
    }
}
END_TEST

START_TEST(fit_at_its_own_nodes_reads_nodal_values)
{
  const dvi_basis basis = (dvi_basis)_i;
  double node[MOST + 1], matrix[MOST * MOST];
  for (int degree = 1; degree <= highest(basis); degree++) {
    ck_assert_int_eq(dvi_basis_nodes(basis, degree, node), DVI_OK);
    dvi__trial_fit(basis, degree, degree, node + 1, matrix);
    for (int k = 0; k < degree; k++)
      /* a node's rounding moves values by its slope, at most degree^2 */
      for (int i = 0; i < degree; i++)
        ck_assert_double_eq_tol(matrix[k * degree + i], k == i, 4 * degree * degree * roundoff());
  }
}
END_TEST

START_TEST(fit_with_more_points_is_the_least_squares_solution)
{
  /* residuals of values that no line through 0 fits are orthogonal to that line */
  const double tau[] = {0.1, 0.4, 0.7, 0.9}, value[] = {1, -1, 2, 0.5};
  double matrix[4], Y, along = 0;
  dvi__trial_fit((dvi_basis)_i, 1, 4, tau, matrix);
  multiply(1, 4, matrix, value, &Y);
  for (int i = 0; i < 4; i++) along += tau[i] * (value[i] - evaluate((dvi_basis)_i, 1, &Y, tau[i]));
  ck_assert_double_eq_tol(along, 0, 1e-15); /* four terms of order 1 */
}
END_TEST

START_TEST(shift_continues_a_polynomial_of_the_kept_degree)
{
  static const double ratios[] = {1, 0.5, 1.7, -1};
  const dvi_basis basis = (dvi_basis)_i;
  double Y[MOST], next[MOST], shift[MOST * MOST];
  for (int degree = 1; degree <= 10; degree++)
    for (int keep = 1; keep <= degree; keep++)
      for (int r = 0; r < 4; r++) {
        fit(basis, degree, degree, keep, Y);
        dvi__trial_shift(basis, degree, keep, ratios[r], shift);
        multiply(degree, degree, shift, Y, next);
        double size = 1; /* extrapolation multiplies the roundoff of Y by up to |shift| */
        for (int i = 0; i < degree * degree; i++) size = fmax(size, fabs(shift[i]));
        for (double tau = 0; tau <= 1; tau += 0.125)
          ck_assert_double_eq_tol(evaluate(basis, degree, next, tau),
                                  polynomial(keep, 1 + ratios[r] * tau) - polynomial(keep, 1),
                                  100 * degree * size * roundoff());
      }
}
END_TEST

START_TEST(shift_backward_by_the_whole_step_returns_the_step)
{
  /* ratio -1 gives q(1 - tau) - q(1) for every degree, as no extrapolation takes part */
  const dvi_basis basis = (dvi_basis)_i;
  double Y[MOST], next[MOST], shift[MOST * MOST];
  for (int degree = 1; degree <= highest(basis); degree++) {
    fit(basis, degree, degree, degree, Y);
    dvi__trial_shift(basis, degree, degree, -1, shift);
    multiply(degree, degree, shift, Y, next);
    for (double tau = 0; tau <= 1; tau += 0.125)
      ck_assert_double_eq_tol(evaluate(basis, degree, next, tau),
                              polynomial(degree, 1 - tau) - polynomial(degree, 1),
                              200 * degree * roundoff()); /* as in the fit, twice */
  }
}
END_TEST

START_TEST(shift_drops_derivatives_orthogonal_to_the_kept_degree)
{
  /* q' = P_m with m >= keep, whose best approximation of degree keep-1 is 0 */
  const dvi_basis basis = (dvi_basis)_i;
  enum { DEGREE = 6 };
  double matrix[DEGREE * DEGREE], Y[DEGREE], next[DEGREE], shift[DEGREE * DEGREE], tau[DEGREE],
      weight[DEGREE], value[DEGREE];
  double P[DEGREE + 1];
  ck_assert_int_eq(dvi_quadrature(DVI_GAUSS, DEGREE, tau, weight), DVI_OK);
  dvi__trial_fit(basis, DEGREE, DEGREE, tau, matrix);
  for (int keep = 1; keep < DEGREE; keep++)
    for (int m = 1; m < DEGREE; m++) {
      for (int i = 0; i < DEGREE; i++) { /* the primitive of P_m that vanishes at 0 */
        ck_assert_int_eq(dvi_basis_evaluate(DVI_LEGENDRE, DEGREE, tau[i], P, NULL), DVI_OK);
        value[i] = (P[m + 1] - P[m - 1]) / (2 * (2 * m + 1));
      }
      multiply(DEGREE, DEGREE, matrix, value, Y);
      dvi__trial_shift(basis, DEGREE, keep, 0.5, shift);
      multiply(DEGREE, DEGREE, shift, Y, next);
      const double end = fabs(evaluate(basis, DEGREE, next, 1));
      if (m >= keep)
        ck_assert_double_le(end, 1e-13); /* roundoff times |shift|, below 100 */
      else
        ck_assert_double_ge(end, 0.1);
    }
}
END_TEST

SUITE(trial)
{
  tcase_add_loop_test(tests, psi_vanishes_at_0_and_bar_at_1, 0, BASES);
  tcase_add_loop_test(tests, psi_and_bar_are_the_basis_less_its_ends, 0, BASES);
  if (long_double_is_long()) /* else the differences lose as many digits as tau is small */
    tcase_add_loop_test(tests, psi_keeps_its_digits_near_0, 0, BASES);
  tcase_add_loop_test(tests, the_tables_are_the_same_from_a_space_made_once, 0, BASES);
  tcase_add_loop_test(tests, fit_gives_back_a_polynomial_from_its_values, 0, BASES);
  tcase_add_loop_test(tests, fit_at_its_own_nodes_reads_nodal_values, DVI_LAGRANGE_LOBATTO,
                      DVI_LAGRANGE_LOBATTO + 1);
  tcase_add_loop_test(tests, fit_at_its_own_nodes_reads_nodal_values, DVI_LAGRANGE_CHEBYSHEV,
                      DVI_LAGRANGE_EQUISPACED + 1);
  tcase_add_loop_test(tests, fit_with_more_points_is_the_least_squares_solution, 0, BASES);
  tcase_add_loop_test(tests, shift_continues_a_polynomial_of_the_kept_degree, 0, BASES);
  tcase_add_loop_test(tests, shift_backward_by_the_whole_step_returns_the_step, 0, BASES);
  tcase_add_loop_test(tests, shift_drops_derivatives_orthogonal_to_the_kept_degree, 0, BASES);
}
