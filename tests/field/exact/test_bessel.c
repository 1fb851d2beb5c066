/* labels: judge */
/* Bessel functions in quadruple precision, by identities that their recurrences do not use. */
#include "support/suite.h"
#include "support/waves/bessel.h"

enum { MOST = 40, POINTS = 400 };

static const double arguments[] = {0.01, 0.7, 2.404825557695773, 5, 17.3, 60, 120};

enum { ARGUMENTS = sizeof arguments / sizeof *arguments };

static void check_quad(quad value, quad expected, quad tolerance)
{
  ck_assert_msg(quad_abs(value - expected) <= tolerance, "%.30g is not %.30g", (double)value,
                (double)expected);
}

/* Bessel's integral J_n(x) = mean of cos(n t - x sin t) is exact by the trapezoidal rule, but for
 * J_{POINTS-n} (Abramowitz and Stegun 9.1.21). */
START_TEST(orders_are_integrals)
{
  const quad x = arguments[_i], pi = quad_acos(-1);
  quad_complex J[MOST + 1];
  bessel_j(MOST, qc(x, 0), J);
  for (int n = 0; n <= MOST; n += 1 + n / 4) {
    quad sum = 0;
    for (int k = 0; k < POINTS; k++) {
      const quad t = 2 * pi * k / POINTS;
      sum += quad_cos(n * t - x * quad_sin(t));
    }
    check_quad(J[n].re, sum / POINTS, 1e-30);
    check_quad(J[n].im, 0, 1e-30);
  }
}
END_TEST

/* The same for complex arguments, with cos(n t - z sin t). |cos| reaches exp(|Im z|). */
START_TEST(orders_of_complex_arguments_are_integrals)
{
  const quad_complex z = qc(7.5, _i == 0 ? 3 : -12);
  const quad pi = quad_acos(-1), size = quad_exp(quad_abs(z.im));
  quad_complex J[MOST + 1];
  bessel_j(MOST, z, J);
  for (int n = 0; n <= MOST; n += 1 + n / 4) {
    quad_complex sum = qc(0, 0);
    for (int k = 0; k < POINTS; k++) {
      const quad t = 2 * pi * k / POINTS;
      sum = qc_add(sum, qc_cos(qc_subtract(qc(n * t, 0), qc_scale(quad_sin(t), z))));
    }
    check_quad(J[n].re, sum.re / POINTS, 1e-30 * size);
    check_quad(J[n].im, sum.im / POINTS, 1e-30 * size);
  }
}
END_TEST

/* J_{n+1} Y_n - J_n Y_{n+1} = 2/(pi x), of which Y_0 and Y_1 are two series (9.1.16). */
START_TEST(wronskians_hold)
{
  const quad x = arguments[_i], expected = 2 / (quad_acos(-1) * x);
  quad_complex J[MOST + 2];
  quad Y[MOST + 2];
  bessel_j(MOST + 1, qc(x, 0), J);
  bessel_y(MOST + 1, x, Y);
  for (int n = 0; n <= MOST; n++)
    check_quad(J[n + 1].re * Y[n] - J[n].re * Y[n + 1], expected, 1e-28 * expected);
}
END_TEST

/* j_{n+1} y_n - j_n y_{n+1} = 1/x^2 (10.1.31). */
START_TEST(spherical_wronskians_hold)
{
  const quad x = arguments[_i], expected = 1 / (x * x);
  quad_complex j[MOST + 2];
  quad y[MOST + 2];
  spherical_j(MOST + 1, qc(x, 0), j);
  spherical_y(MOST + 1, x, y);
  for (int n = 0; n <= MOST; n++)
    check_quad(j[n + 1].re * y[n] - j[n].re * y[n + 1], expected, 1e-28 * expected);
}
END_TEST

/* Y_0' = -Y_1, by an extrapolated difference, whose error is h^4 Y_0^(5)/30. */
START_TEST(the_slope_of_the_order_zero_is_the_order_one)
{
  const quad x = arguments[_i], h = x * 1e-6;
  quad near[2], far[2], Y[2];
  for (int side = 0; side < 2; side++) {
    bessel_y(1, x + (side == 0 ? -h : h), Y);
    near[side] = Y[0];
    bessel_y(1, x + (side == 0 ? -2 * h : 2 * h), Y);
    far[side] = Y[0];
  }
  bessel_y(1, x, Y);
  const quad slope = (8 * (near[1] - near[0]) - (far[1] - far[0])) / (12 * h);
  check_quad(slope, -Y[1], 1e-17 * (1 + 1 / x));
}
END_TEST

/* Hankel's expansion H_n(x) = sqrt(2/(pi x)) exp(i chi) sum_k t_k, chi = x - n pi/2 - pi/4, t_k =
 * t_{k-1} i (4 n^2 - (2k-1)^2)/(8 k x), whose least term is exp(-2x) (9.2.7). */
START_TEST(large_arguments_have_an_expansion)
{
  const quad x = _i == 0 ? 60 : 120, pi = quad_acos(-1);
  quad_complex J[2];
  quad Y[2];
  bessel_j(1, qc(x, 0), J);
  bessel_y(1, x, Y);
  for (int n = 0; n < 2; n++) {
    const quad chi = x - n * pi / 2 - pi / 4;
    quad_complex term = qc(1, 0), sum = term;
    for (int k = 1; k < 60; k++) {
      term = qc_multiply(term, qc(0, (4 * n * n - (2 * k - 1) * (2 * k - 1)) / (8 * k * x)));
      sum = qc_add(sum, term);
    }
    const quad_complex H = qc_scale(quad_sqrt(2 / (pi * x)), qc_multiply(qc_exp(qc(0, chi)), sum));
    check_quad(J[n].re, H.re, 1e-31);
    check_quad(Y[n], H.im, 1e-31);
  }
}
END_TEST

/* Abramowitz and Stegun, table 9.5. */
static quad order_of(quad x, const void *user)
{
  const int order = *(const int *)user;
  quad_complex J[4];
  bessel_j(order, qc(x, 0), J);
  return J[order].re;
}

START_TEST(roots_are_those_of_the_tables)
{
  static const double known[2][3] = {{2.4048255577, 5.5200781103, 8.6537279129},
                                     {3.83171, 7.01559, 10.17347}};
  quad root[3];
  for (int order = 0; order < 2; order++) {
    find_roots(order_of, &order, 0.25, 0.5, 3, root);
    for (int i = 0; i < 3; i++) {
      check_quad(root[i], known[order][i], order == 0 ? 5e-11 : 5e-6);
      check_quad(order_of(root[i], &order), 0, 1e-30);
    }
  }
}
END_TEST

SUITE(bessel)
{
  tcase_add_loop_test(tests, orders_are_integrals, 0, ARGUMENTS);
  tcase_add_loop_test(tests, orders_of_complex_arguments_are_integrals, 0, 2);
  tcase_add_loop_test(tests, wronskians_hold, 0, ARGUMENTS);
  tcase_add_loop_test(tests, spherical_wronskians_hold, 0, ARGUMENTS);
  tcase_add_loop_test(tests, the_slope_of_the_order_zero_is_the_order_one, 0, ARGUMENTS);
  tcase_add_loop_test(tests, large_arguments_have_an_expansion, 0, 2);
  tcase_add_test(tests, roots_are_those_of_the_tables);
}
