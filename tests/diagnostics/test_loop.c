/* labels: unit */
/* Loop integrals are compared with known areas. */
#include <check.h>
#include <dvi/diagnostics.h>
#include <math.h>

#include "support/suite.h"

static const double pi = 3.14159265358979323846;
enum { MOST = 200 };

/* An ellipse with half axes 3 and 2 about (10, 20), run through at a speed that varies by `uneven`;
 * p = (-y, x)/2 + (5, 7): the integral is its area. */
static double area(int count, double uneven)
{
  double q[2 * MOST], p[2 * MOST], integral = 0;
  for (int k = 0; k < count; k++) {
    const double s = 2 * pi * k / count, angle = s + uneven * sin(s);
    q[k] = 10 + 3 * cos(angle);
    q[count + k] = 20 + 2 * sin(angle);
    p[k] = 5 - 0.5 * q[count + k];
    p[count + k] = 7 + 0.5 * q[k];
  }
  ck_assert_int_eq(dvi_loop_integral(2, count, q, p, &integral), DVI_OK);
  return integral;
}

/* The sum of errors of 200 points around 20, each rounded by 2e-15, with weights of order 1. */
static const double roundoff = 1e-12;

/* The only harmonic is below half the number of points. */
START_TEST(an_ellipse_has_its_area_from_the_fewest_points_on)
{
  for (int count = DVI_LOOP_LEAST; count <= MOST; count++)
    ck_assert_double_eq_tol(area(count, 0), 6 * pi, roundoff);
}
END_TEST

START_TEST(an_uneven_loop_converges_exponentially)
{
  double last = fabs(area(8, 0.7) - 6 * pi);
  ck_assert_double_gt(last, 1e-4);
  for (int count = 12; count <= 24; count += 4) {
    const double error = fabs(area(count, 0.7) - 6 * pi);
    ck_assert_double_le(error, fmax(last / 10, roundoff));
    last = error;
  }
  for (int count = 41; count <= 64; count++)
    ck_assert_double_eq_tol(area(count, 0.7), 6 * pi, roundoff);
}
END_TEST

START_TEST(bad_arguments_are_refused)
{
  double q[16] = {0}, p[16] = {0}, integral = 17;
  ck_assert_int_eq(dvi_loop_integral(2, 8, NULL, p, &integral), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_loop_integral(2, 7, q, p, &integral), DVI_BAD_SIZE);
  check_words("2 coordinates at 7 points; at least 1 and 8");
  ck_assert_int_eq(dvi_loop_integral(0, 8, q, p, &integral), DVI_BAD_SIZE);
  p[3] = (double)NAN;
  ck_assert_int_eq(dvi_loop_integral(2, 8, q, p, &integral), DVI_NOT_FINITE);
  ck_assert_double_eq(integral, 17);
}
END_TEST

SUITE(loop)
{
  tcase_add_test(tests, an_ellipse_has_its_area_from_the_fewest_points_on);
  tcase_add_test(tests, an_uneven_loop_converges_exponentially);
  tcase_add_test(tests, bad_arguments_are_refused);
}
