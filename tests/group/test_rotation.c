#include <check.h>
#include <dvi/group.h>
#include <stdio.h>
#include <string.h>

#include "matrix.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH
static void quad_dexp(double sign, const double w[3], quad D[9])
{
  quad exact[3], W[9];
  for (int i = 0; i < 3; i++) exact[i] = (quad)(sign * w[i]);
  quad_hat(exact, W);
  quad_series(3, 1, W, D);
}

/* Errors of entries off the diagonal are measured against the angle if that is small, so that small
 * rotations keep their digits. Large angles are known to 1 ulp of themselves. */
START_TEST(exp_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 3;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], R[9];
    quad exact[9];
    point(i, 4 * PI, &seed, w);
    const double angle = length(w), small = fmin(1, angle);
    dvi_so3_exp(w, R);
    quad_rotation(w, exact);
    for (int j = 0; j < 9; j++) {
      const double error = quad_error(1, R + j, exact + j);
      if (error > 0) worst = fmax(worst, error / (fmax(1, angle) * (j % 4 == 0 ? 1 : small)));
    }
  }
  printf("exp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST

/* Entries of R that are rounded by half an ulp move w by pi/2 times as much, at worst. */
START_TEST(log_is_right_to_4_ulp_up_to_half_turns)
{
  double worst = 0;
  uint64_t seed = 4;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], found[3], R[9];
    quad rotation[9], exact[3];
    point(i, PI, &seed, w);
    const double angle = length(w);
    if (angle > PI + 1e-15) continue;
    quad_rotation(w, rotation);
    for (int j = 0; j < 9; j++) R[j] = (double)rotation[j];
    ck_assert_int_eq(dvi_so3_log(R, found), DVI_OK);
    quad_from(3, w, exact);
    /* roundoff decides the sign */
    if (angle > PI - 1e-15 && found[0] * w[0] + found[1] * w[1] + found[2] * w[2] < 0)
      for (int j = 0; j < 3; j++) found[j] = -found[j];
    const double error = quad_error(3, found, exact);
    if (error > 0) worst = fmax(worst, error / fmin(1, angle));
  }
  printf("log: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 4 * DBL_EPSILON);
}
END_TEST

/* Against |v|. */
START_TEST(dexp_is_right_to_3_ulp)
{
  double worst = 0;
  uint64_t seed = 5;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], v[3], u[3];
    quad D[9], exact[3], exact_v[3];
    point(i, 4 * PI, &seed, w);
    random_vector(&seed, 1, v);
    dvi_so3_dexp(w, v, u);
    quad_dexp(1, w, D);
    quad_from(3, v, exact_v);
    quad_apply(3, D, exact_v, exact);
    worst = fmax(worst, quad_error(3, u, exact));
  }
  printf("dexp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 3 * DBL_EPSILON);
}
END_TEST

/* Errors are relative to |v|. Near full turns the angle's roundoff, over the distance from there,
 * comes on top. */
START_TEST(the_inverse_of_dexp_is_right_to_4_ulp)
{
  double worst = 0;
  uint64_t seed = 6;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], v[3], u[3];
    quad D[9], exact[3];
    point(i, 2 * PI, &seed, w);
    random_vector(&seed, 1, v);
    dvi_so3_dexp_inverse(w, v, u);
    quad_dexp(1, w, D);
    quad_from(3, v, exact);
    quad_solve_linear(3, D, exact);
    const double gap = fmin(1, fabs(2 * PI - length(w)) / (2 * PI));
    worst = fmax(worst, quad_error(3, u, exact) * gap * gap);
  }
  printf("dexp_inverse: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 4 * DBL_EPSILON);
}
END_TEST

/* Gives d/dw of dexp_{-w} v by central differences with the step 1e-11, in quadruple precision,
 * right to 1e-21. */
static void quad_velocity_derivative(const double w[3], const double v[3], quad D[9])
{
  const quad step = (quad)1e-11;
  for (int j = 0; j < 3; j++) {
    quad side[2][3], exact_v[3], W[9], series[9];
    quad_from(3, v, exact_v);
    for (int sign = 0; sign < 2; sign++) {
      quad moved[3];
      for (int i = 0; i < 3; i++) moved[i] = -((quad)w[i] + (i == j ? (sign ? step : -step) : 0));
      quad_hat(moved, W);
      quad_series(3, 1, W, series);
      quad_apply(3, series, exact_v, side[sign]);
    }
    for (int i = 0; i < 3; i++) D[3 * i + j] = (side[1][i] - side[0][i]) / (2 * step);
  }
}

/* Errors are relative to |v|. Large angles are known to 1 ulp of themselves. */
START_TEST(the_derivative_of_the_velocity_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 7;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], v[3], D[9];
    quad exact[9];
    point(i, 4 * PI, &seed, w);
    random_vector(&seed, 1, v);
    dvi_so3_velocity_derivative(w, v, D);
    quad_velocity_derivative(w, v, exact);
    worst = fmax(worst, quad_error(9, D, exact) / fmax(1, length(w)));
  }
  printf("velocity_derivative: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST
#endif

START_TEST(dexp_of_the_opposite_turn_is_the_transpose)
{
  uint64_t seed = 8;
  for (int i = 0; i < 1000; i++) {
    double w[3], opposite[3], v[3], m[3], u[3], n[3];
    point(i, 4 * PI, &seed, w);
    random_vector(&seed, 1, v);
    random_vector(&seed, 1, m);
    for (int j = 0; j < 3; j++) opposite[j] = -w[j];
    dvi_so3_dexp(w, v, u);
    dvi_so3_dexp(opposite, m, n);
    ck_assert_double_eq_tol(m[0] * u[0] + m[1] * u[1] + m[2] * u[2],
                            n[0] * v[0] + n[1] * v[1] + n[2] * v[2], 8 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(exp_is_orthogonal_to_1_ulp)
{
  double worst = 0;
  uint64_t seed = 9;
  for (int i = 0; i < 100000; i++) {
    double w[3], R[9], defect[9];
    point(i, 4 * PI, &seed, w);
    dvi_so3_exp(w, R);
    worst = fmax(worst, orthogonality(R, defect));
  }
  printf("R^T R - I of exp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 1 * DBL_EPSILON);
}
END_TEST

/* A step of the walk, the roundoff of an exponential and of a product, is about 1 ulp. A bias of 1
 * % of that would show, as 1e4 > 3e3. */
START_TEST(a_million_factors_leave_the_group_as_a_random_walk_does)
{
  enum { FACTORS = 1000000 };
  double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, mean[9] = {0}, defect[9];
  uint64_t seed = 10;
  for (int i = 0; i < FACTORS; i++) {
    double w[3], E[9], product[9];
    random_vector(&seed, 2 * fabs(uniform(&seed)), w);
    dvi_so3_exp(w, E);
    (void)orthogonality(E, defect);
    for (int j = 0; j < 9; j++) mean[j] += defect[j] / FACTORS;
    multiply(R, E, product);
    memcpy(R, product, sizeof R);
  }
  const double left = orthogonality(R, defect);
  double bias = 0;
  for (int j = 0; j < 9; j++) bias = fmax(bias, fabs(mean[j]));
  printf("product of 1e6: %.2f sqrt(N) ulp; mean of E^T E - I: %.2f ulp / sqrt(N)\n",
         left / (1e3 * DBL_EPSILON), bias * 1e3 / DBL_EPSILON);
  ck_assert_double_le(left, 3e3 * DBL_EPSILON);
  ck_assert_double_le(bias, 3e-3 * DBL_EPSILON);
}
END_TEST

START_TEST(of_two_half_turns_log_takes_the_one_whose_largest_component_is_positive)
{
  const double turn[4][9] = {{1, 0, 0, 0, -1, 0, 0, 0, -1},
                             {-1, 0, 0, 0, 1, 0, 0, 0, -1},
                             {-1, 0, 0, 0, -1, 0, 0, 0, 1},
                             {-0.28, 0, -0.96, 0, -1, 0, -0.96, 0, 0.28}};
  const double axis[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.6, 0, 0.8}};
  for (int i = 0; i < 4; i++) {
    double w[3];
    ck_assert_int_eq(dvi_so3_log(turn[i], w), DVI_OK);
    for (int j = 0; j < 3; j++) ck_assert_double_eq_tol(w[j], PI * axis[i][j], 4 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(what_is_no_rotation_is_refused_and_nothing_is_written)
{
  const double bad[4][9] = {{1, 0, 0, 0, 1, 0, 0, 0, -1},
                            {1.001, 0, 0, 0, 1, 0, 0, 0, 1},
                            {1, 0, 0, 0, 1, 0, (double)NAN, 0, 1},
                            {1e200, 0, 0, 0, 1e200, 0, 0, 0, 1e200}};
  for (int i = 0; i < 4; i++) {
    double w[3] = {7, 7, 7}, q[4] = {7, 7, 7, 7};
    ck_assert_int_eq(dvi_so3_log(bad[i], w), DVI_BAD_ARGUMENT);
    check_words("dvi_so3_project");
    ck_assert_int_eq(dvi_so3_cayley_inverse(bad[i], w), DVI_BAD_ARGUMENT);
    ck_assert_int_eq(dvi_so3_quaternion(bad[i], q), DVI_BAD_ARGUMENT);
    ck_assert(w[0] == 7 && w[1] == 7 && w[2] == 7 && q[0] == 7 && q[3] == 7);
  }
}
END_TEST

START_TEST(no_angle_makes_nan)
{
  for (int exponent = -1074; exponent <= 1023; exponent++) {
    const double w[3] = {0, ldexp(1, exponent), -ldexp(0.75, exponent)}, v[3] = {1, -0.5, 0.25};
    double R[9], D[9], u[4][3], defect[9];
    dvi_so3_exp(w, R);
    ck_assert_double_le(orthogonality(R, defect), DBL_EPSILON);
    dvi_so3_cayley(w, R);
    ck_assert_double_le(orthogonality(R, defect), DBL_EPSILON);
    dvi_so3_dexp(w, v, u[0]);
    dvi_so3_dexp_inverse(w, v, u[1]);
    dvi_so3_dcayley(w, v, u[2]);
    dvi_so3_velocity_derivative(w, v, D);
    for (int i = 0; i < 3; i++)
      ck_assert(isfinite(u[0][i]) && isfinite(u[1][i]) && isfinite(u[2][i]));
    for (int i = 0; i < 9; i++) ck_assert(isfinite(D[i]));
  }
}
END_TEST

SUITE(rotation)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, exp_is_right_to_2_ulp);
  tcase_add_test(tests, log_is_right_to_4_ulp_up_to_half_turns);
  tcase_add_test(tests, dexp_is_right_to_3_ulp);
  tcase_add_test(tests, the_inverse_of_dexp_is_right_to_4_ulp);
  tcase_add_test(tests, the_derivative_of_the_velocity_is_right_to_2_ulp);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, dexp_of_the_opposite_turn_is_the_transpose);
  tcase_add_test(tests, exp_is_orthogonal_to_1_ulp);
  tcase_add_test(tests, a_million_factors_leave_the_group_as_a_random_walk_does);
  tcase_add_test(tests, of_two_half_turns_log_takes_the_one_whose_largest_component_is_positive);
  tcase_add_test(tests, what_is_no_rotation_is_refused_and_nothing_is_written);
  tcase_add_test(tests, no_angle_makes_nan);
}
