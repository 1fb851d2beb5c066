/* Quadrature and interpolation by Taylor coefficients at the ends. */
#include <float.h>
#include <math.h>

#include "space/osculation.h"
#include "support/suite.h"

static double binomial(int n, int k)
{
  return round(tgamma(n + 1.0) / tgamma(k + 1.0) / tgamma(n - k + 1.0));
}

/* Gives the rule's error for tau^d, with a_j = 1 if j = d, b_j = binomial(d, j), and the magnitude
 * of its terms. */
static double error_of(dvi__osculation rule, int terms, int d, double *magnitude)
{
  double weight[DVI_TAYLOR_MAX + 1], sum = 0;
  dvi__osculation_weights(rule, terms, weight);
  *magnitude = 0;
  for (int j = 0; j < dvi__osculation_count(rule, terms) && j <= d; j++) {
    const double term = weight[j] * ((j == d) + (j % 2 ? -1 : 1) * binomial(d, j));
    sum += term;
    *magnitude += fabs(term);
  }
  return sum - 1.0 / (d + 1);
}

/* Magnitudes grow to 1e3 at most for these. */
START_TEST(rules_are_exact_to_their_order_and_no_further)
{
  for (int rule = DVI__EULER_MACLAURIN; rule <= DVI__HERMITE; rule++)
    for (int terms = rule == DVI__HERMITE; terms <= 6; terms++) {
      const int order = dvi__osculation_order((dvi__osculation)rule, terms);
      double magnitude;
      for (int d = 0; d < order; d++) {
        const double error = error_of((dvi__osculation)rule, terms, d, &magnitude);
        ck_assert_double_le(fabs(error), 16 * DBL_EPSILON * magnitude);
      }
      const double error = error_of((dvi__osculation)rule, terms, order, &magnitude);
      ck_assert_double_ge(fabs(error), 1e3 * DBL_EPSILON * magnitude);
    }
}
END_TEST

START_TEST(bernoullis_numbers_are_those_of_the_books)
{
  static const double B[] = {1.0 / 6,       -1.0 / 30,      1.0 / 42, -1.0 / 30,
                             5.0 / 66,      -691.0 / 2730,  7.0 / 6,  -3617.0 / 510,
                             43867.0 / 798, -174611.0 / 330};
  double weight[DVI_TAYLOR_MAX + 1];
  dvi__osculation_weights(DVI__EULER_MACLAURIN, 20, weight);
  for (int l = 1; l <= 10; l++)
    ck_assert_double_eq_tol(weight[2 * l - 1] * 2 * l / B[l - 1], 1, 4 * DBL_EPSILON);
  /* B_40 = -261082718496449122051/13530 */
  ck_assert_double_eq_tol(weight[39] * 40 / (-261082718496449122051.0 / 13530), 1, 8 * DBL_EPSILON);
}
END_TEST

/* A polynomial of degree 2N-1 is its own interpolant. */
START_TEST(the_next_coefficients_are_those_of_the_polynomial)
{
  for (int N = 1; N <= 8; N++) {
    double from_a[8], from_b[8];
    dvi__hermite_next(N, from_a, from_b);
    for (int d = 0; d < 2 * N; d++) {
      double a_N = 0, b_N = 0;
      for (int j = 0; j < N; j++) {
        const double a = j == d, b = j <= d ? binomial(d, j) : 0, sign = j % 2 ? -1 : 1;
        a_N += from_a[j] * a + from_b[j] * b;
        b_N += sign * (from_a[j] * b + from_b[j] * a);
      }
      ck_assert_double_eq_tol(a_N, N == d, 1e-9); /* whole numbers below 1e6 */
      ck_assert_double_eq_tol((N % 2 ? -1 : 1) * b_N, N <= d ? binomial(d, N) : 0, 1e-9);
    }
  }
}
END_TEST

START_TEST(hermites_functions_give_back_polynomials_and_their_slopes)
{
  for (int N = 1; N <= 6; N++)
    for (int d = 0; d < 2 * N; d++)
      for (int point = 0; point <= 10; point++) {
        const double tau = point / 10.0;
        double here[6], slope[6], there[6], there_slope[6], value = 0, rate = 0;
        dvi__hermite_functions(N, tau, here, slope);
        dvi__hermite_functions(N, 1 - tau, there, there_slope);
        for (int j = 0; j < N; j++) {
          const double a = j == d, b = j <= d ? binomial(d, j) : 0, sign = j % 2 ? -1 : 1;
          value += here[j] * a + sign * there[j] * b;
          rate += slope[j] * a - sign * there_slope[j] * b;
        }
        ck_assert_double_eq_tol(value, pow(tau, d), 1e-13);
        ck_assert_double_eq_tol(rate, d > 0 ? d * pow(tau, d - 1) : 0, 1e-12);
      }
}
END_TEST

SUITE(osculation)
{
  tcase_add_test(tests, rules_are_exact_to_their_order_and_no_further);
  tcase_add_test(tests, bernoullis_numbers_are_those_of_the_books);
  tcase_add_test(tests, the_next_coefficients_are_those_of_the_polynomial);
  tcase_add_test(tests, hermites_functions_give_back_polynomials_and_their_slopes);
}
