#include <check.h>
#include <dvi/group.h>
#include <stdio.h>

#include "matrix.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH
/* A turn as for rotations, and a shift of length 1. */
static void twist(int i, double longest, uint64_t *seed, double xi[6])
{
  point(i, longest, seed, xi);
  random_vector(seed, 1, xi + 3);
}

/* [hat(w), u; 0, 0] */
static void quad_twist(const double xi[6], quad A[16])
{
  quad exact[6], W[9];
  quad_from(6, xi, exact);
  quad_hat(exact, W);
  for (int i = 0; i < 16; i++)
    A[i] = i / 4 == 3 ? 0 : i % 4 == 3 ? exact[3 + i / 4] : W[3 * (i / 4) + i % 4];
}

/* From a matrix of 4 rows to R and x. */
static void quad_motion(const quad E[16], quad g[12])
{
  for (int i = 0; i < 9; i++) g[i] = E[4 * (i / 3) + i % 3];
  for (int i = 0; i < 3; i++) g[9 + i] = E[4 * i + 3];
}

/* Gives dexp_xi, from ad = [hat(w), 0; hat(u), hat(w)]. */
static void quad_dexp(const double xi[6], quad D[36])
{
  quad exact[6], W[9], U[9], ad[36];
  quad_from(6, xi, exact);
  quad_hat(exact, W);
  quad_hat(exact + 3, U);
  for (int i = 0; i < 36; i++) {
    const int row = i / 6, column = i % 6, entry = 3 * (row % 3) + column % 3;
    ad[i] = row / 3 == column / 3 ? W[entry] : row >= 3 ? U[entry] : 0;
  }
  quad_series(6, 1, ad, D);
}

START_TEST(exp_is_right_to_3_ulp)
{
  double worst = 0;
  uint64_t seed = 1;
  for (int i = 0; i < repeats(POINTS); i++) {
    double xi[6], g[12];
    quad A[16], E[16], exact[12];
    twist(i, 4 * PI, &seed, xi);
    dvi_se3_exp(xi, g);
    quad_twist(xi, A);
    quad_series(4, 0, A, E);
    quad_motion(E, exact);
    worst = fmax(worst, quad_error(12, g, exact) / fmax(1, length(xi)));
  }
  printf("exp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 3 * DBL_EPSILON);
}
END_TEST

/* Entries of R that are rounded move w by up to pi/2 times as much, and u by that times the
 * derivative of dexp^-1, which is below 2. */
START_TEST(log_is_right_to_6_ulp_up_to_half_turns)
{
  double worst = 0;
  uint64_t seed = 2;
  for (int i = 0; i < repeats(POINTS); i++) {
    double xi[6], found[6], g[12];
    quad A[16], E[16], motion[12], exact[6];
    twist(i, PI, &seed, xi);
    if (length(xi) > PI - 1e-15) continue; /* roundoff decides which of two is found */
    quad_twist(xi, A);
    quad_series(4, 0, A, E);
    quad_motion(E, motion);
    for (int j = 0; j < 12; j++) g[j] = (double)motion[j];
    ck_assert_int_eq(dvi_se3_log(g, found), DVI_OK);
    quad_from(6, xi, exact);
    worst = fmax(worst, quad_error(6, found, exact));
  }
  printf("log: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 6 * DBL_EPSILON);
}
END_TEST

START_TEST(cayley_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 3;
  for (int i = 0; i < repeats(POINTS); i++) {
    double xi[6], g[12];
    quad A[16], left[16], C[16], exact[12];
    twist(i, 4 * PI, &seed, xi);
    dvi_se3_cayley(xi, g);
    quad_twist(xi, A);
    for (int j = 0; j < 16; j++) left[j] = (j % 5 == 0) - A[j] / 2;
    for (int j = 0; j < 4; j++) {
      quad column[4];
      for (int k = 0; k < 4; k++) column[k] = (j == k) + A[4 * k + j] / 2;
      quad_solve_linear(4, left, column);
      for (int k = 0; k < 4; k++) C[4 * k + j] = column[k];
    }
    quad_motion(C, exact);
    worst = fmax(worst, quad_error(12, g, exact));
  }
  printf("cayley: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST

/* Errors are relative to |v| = |(a, b)|, with |u| = 1. Large angles are known to 1 ulp of
 * themselves. */
START_TEST(dexp_is_right_to_4_ulp)
{
  double worst = 0;
  uint64_t seed = 4;
  for (int i = 0; i < repeats(POINTS); i++) {
    double xi[6], v[6], u[6];
    quad D[36], exact_v[6], exact[6];
    twist(i, 4 * PI, &seed, xi);
    random_vector(&seed, 1, v);
    random_vector(&seed, 1, v + 3);
    dvi_se3_dexp(xi, v, u);
    quad_dexp(xi, D);
    quad_from(6, v, exact_v);
    quad_apply(6, D, exact_v, exact);
    worst = fmax(worst, quad_error(6, u, exact) / fmax(1, length(xi)));
  }
  printf("dexp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 4 * DBL_EPSILON);
}
END_TEST

/* The pole of order 2 at full turns moves by the roundoff of the angle. */
START_TEST(the_inverse_of_dexp_is_right_to_8_ulp)
{
  double worst = 0;
  uint64_t seed = 5;
  for (int i = 0; i < repeats(POINTS); i++) {
    double xi[6], v[6], u[6];
    quad D[36], exact[6];
    twist(i, 2 * PI, &seed, xi);
    random_vector(&seed, 1, v);
    random_vector(&seed, 1, v + 3);
    dvi_se3_dexp_inverse(xi, v, u);
    quad_dexp(xi, D);
    quad_from(6, v, exact);
    quad_solve_linear(6, D, exact);
    const double gap = fmin(1, fabs(2 * PI - length(xi)) / (2 * PI));
    worst = fmax(worst, quad_error(6, u, exact) * gap * gap * gap);
  }
  printf("dexp_inverse: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 8 * DBL_EPSILON);
}
END_TEST
#endif

/* Gives the body velocity (Omega, V) of exp(xi + t v), R' = R hat(Omega), x' = R V, by central
 * differences with an error of 1e-10. */
START_TEST(dexp_of_the_opposite_twist_is_the_body_velocity)
{
  const double step = 1e-5;
  uint64_t seed = 6;
  for (int i = 0; i < 200; i++) {
    double xi[6], opposite[6], v[6], u[6], g[12], side[2][12];
    random_vector(&seed, 3 * fabs(uniform(&seed)), xi);
    random_vector(&seed, 1, xi + 3);
    random_vector(&seed, 1, v);
    random_vector(&seed, 1, v + 3);
    for (int j = 0; j < 6; j++) opposite[j] = -xi[j];
    dvi_se3_dexp(opposite, v, u);
    dvi_se3_exp(xi, g);
    for (int sign = 0; sign < 2; sign++) {
      double moved[6];
      for (int j = 0; j < 6; j++) moved[j] = xi[j] + (sign ? step : -step) * v[j];
      dvi_se3_exp(moved, side[sign]);
    }
    const double hat[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    double turning[9];
    multiply(g, hat, turning);
    for (int j = 0; j < 9; j++)
      ck_assert_double_eq_tol((side[1][j] - side[0][j]) / (2 * step), turning[j], 1e-9);
    for (int j = 0; j < 3; j++)
      ck_assert_double_eq_tol((side[1][9 + j] - side[0][9 + j]) / (2 * step),
                              g[3 * j] * u[3] + g[3 * j + 1] * u[4] + g[3 * j + 2] * u[5], 1e-9);
  }
}
END_TEST

START_TEST(log_refuses_what_is_no_rotation_and_writes_nothing)
{
  const double g[12] = {2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0};
  double xi[6] = {7, 7, 7, 7, 7, 7};
  ck_assert_int_eq(dvi_se3_log(g, xi), DVI_BAD_ARGUMENT);
  check_words("dvi_so3_project");
  for (int i = 0; i < 6; i++) ck_assert(xi[i] == 7);
}
END_TEST

/* The inverse of dexp grows with the angle's square, and its roundoff with the cube. */
START_TEST(no_angle_makes_nan)
{
  for (int exponent = -1074; exponent <= 1000; exponent++) {
    const double xi[6] = {0, ldexp(1, exponent), -ldexp(0.75, exponent), 1, -0.5, 0.25},
                 v[6] = {1, 0.5, -0.5, 0.25, 1, -1};
    double g[2][12], u[2][6];
    dvi_se3_exp(xi, g[0]);
    dvi_se3_cayley(xi, g[1]);
    dvi_se3_dexp(xi, v, u[0]);
    dvi_se3_dexp_inverse(xi, v, u[1]);
    for (int i = 0; i < 12; i++) ck_assert(isfinite(g[0][i]) && isfinite(g[1][i]));
    for (int i = 0; i < 6; i++)
      ck_assert(isfinite(u[0][i]) && (exponent > 340 || isfinite(u[1][i])));
  }
}
END_TEST

SUITE(motion)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, exp_is_right_to_3_ulp);
  tcase_add_test(tests, log_is_right_to_6_ulp_up_to_half_turns);
  tcase_add_test(tests, cayley_is_right_to_2_ulp);
  tcase_add_test(tests, dexp_is_right_to_4_ulp);
  tcase_add_test(tests, the_inverse_of_dexp_is_right_to_8_ulp);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, dexp_of_the_opposite_twist_is_the_body_velocity);
  tcase_add_test(tests, log_refuses_what_is_no_rotation_and_writes_nothing);
  tcase_add_test(tests, no_angle_makes_nan);
}
