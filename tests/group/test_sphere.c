#include <check.h>
#include <dvi/group.h>
#include <stdio.h>

#include "matrix.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

/* t of this length, tangent at the unit vector y. */
static void tangent(uint64_t *seed, double size, const double y[3], double t[3])
{
  double w[3];
  random_vector(seed, 1, w);
  t[0] = y[1] * w[2] - y[2] * w[1];
  t[1] = y[2] * w[0] - y[0] * w[2];
  t[2] = y[0] * w[1] - y[1] * w[0];
  const double scale = size / length(t);
  for (int i = 0; i < 3; i++) t[i] *= scale;
}

#ifdef DVI_HAVE_QUADMATH
static double chosen_length(int i, double longest, uint64_t *seed)
{
  return i < 50 * SPECIAL_ANGLES ? special_angle(i % SPECIAL_ANGLES)
                                 : longest * fabs(uniform(seed));
}

static void quad_great_circle(const double y[3], const double t[3], quad z[3])
{
  quad point[3], turn[3];
  quad_from(3, y, point);
  quad_from(3, t, turn);
  const quad angle = quad_norm(3, turn), ratio = angle > 0 ? sinq(angle) / angle : 1;
  for (int i = 0; i < 3; i++) z[i] = cosq(angle) * point[i] + ratio * turn[i];
  const quad size = quad_norm(3, z);
  for (int i = 0; i < 3; i++) z[i] /= size;
}

START_TEST(exp_on_the_sphere_is_right_to_3_ulp)
{
  double worst = 0;
  uint64_t seed = 1;
  for (int i = 0; i < repeats(POINTS); i++) {
    double y[3], t[3], z[3];
    quad exact[3];
    const double angle = chosen_length(i, 4 * PI, &seed);
    random_vector(&seed, 1, y);
    tangent(&seed, angle, y, t);
    dvi_s2_exp(y, t, z);
    quad_great_circle(y, t, exact);
    worst = fmax(worst, quad_error(3, z, exact) / fmax(1, angle));
  }
  printf("s2_exp: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 3 * DBL_EPSILON);
}
END_TEST

/* Judges from the given numbers. |t| is the angle between them, and t lies in their plane. Close to
 * half turns the direction is known as well as z + y. */
START_TEST(log_on_the_sphere_is_right_to_3_ulp)
{
  double worst = 0;
  uint64_t seed = 2;
  for (int i = 0; i < repeats(POINTS); i++) {
    double y[3], t[3], z[3];
    quad p[3], r[3], ahead[3];
    random_vector(&seed, 1, y);
    tangent(&seed, fmin(PI - 1e-8, chosen_length(i, PI, &seed)), y, t);
    dvi_s2_exp(y, t, z);
    dvi_s2_log(y, z, t);
    quad_from(3, y, p);
    quad_from(3, z, r);
    const quad cosine = p[0] * r[0] + p[1] * r[1] + p[2] * r[2],
               square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    for (int j = 0; j < 3; j++) ahead[j] = r[j] - cosine / square * p[j];
    const quad sine = quad_norm(3, ahead);
    for (int j = 0; j < 3; j++)
      ahead[j] *= sine > 0 ? atan2q(sine * sqrtq(square), cosine) / sine : 1;
    const double error = quad_error(3, t, ahead), size = (double)quad_norm(3, ahead);
    if (error > 0) worst = fmax(worst, error / size);
  }
  printf("s2_log: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 3 * DBL_EPSILON);
}
END_TEST

START_TEST(the_circle_is_right_to_1_ulp)
{
  uint64_t seed = 3;
  for (int i = 0; i < repeats(POINTS); i++) {
    const double angle = chosen_length(i, PI, &seed) * (i % 2 ? 1 : -1);
    double y[2];
    dvi_u1_exp(angle, y);
    const quad exact[2] = {cosq((quad)angle), sinq((quad)angle)};
    ck_assert_double_le(quad_error(2, y, exact), DBL_EPSILON);
    if (fabs(angle) <= PI) ck_assert_double_eq_tol(dvi_u1_log(y), angle, 2 * DBL_EPSILON);
  }
}
END_TEST
#endif

START_TEST(a_million_steps_stay_on_the_sphere)
{
  double y[3] = {0.6, 0, 0.8}, t[3];
  uint64_t seed = 4;
  for (int i = 0; i < 1000000; i++) {
    /* long ones would make it forget the errors before */
    tangent(&seed, 1e-4 * fabs(uniform(&seed)), y, t);
    dvi_s2_exp(y, t, y);
  }
  ck_assert_double_eq_tol(length(y), 1, 2 * DBL_EPSILON);
}
END_TEST

START_TEST(to_the_opposite_point_log_takes_the_axis_of_the_smallest_component)
{
  const double y[3][3] = {{1, 0, 0}, {0, -1, 0}, {0.48, 0.6, 0.64}},
               z[3][3] = {{-1, 0, 0}, {0, 1, 0}, {-0.48, -0.6, -0.64}};
  const double along = PI / sqrt(1 - 0.48 * 0.48);
  const double expected[3][3] = {
      {0, PI, 0},
      {PI, 0, 0},
      {along * (1 - 0.48 * 0.48), -along * 0.48 * 0.6, -along * 0.48 * 0.64}};
  for (int i = 0; i < 3; i++) {
    double t[3];
    dvi_s2_log(y[i], z[i], t);
    for (int j = 0; j < 3; j++) ck_assert_double_eq_tol(t[j], expected[i][j], 4 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(the_angle_of_the_half_turn_is_pi_whatever_the_sign_of_zero)
{
  ck_assert(dvi_u1_log((const double[2]){-1, 0.0}) == PI &&
            dvi_u1_log((const double[2]){-1, -0.0}) == PI);
  ck_assert(dvi_u1_log((const double[2]){0, 0}) == 0);
}
END_TEST

SUITE(sphere)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, exp_on_the_sphere_is_right_to_3_ulp);
  tcase_add_test(tests, log_on_the_sphere_is_right_to_3_ulp);
  tcase_add_test(tests, the_circle_is_right_to_1_ulp);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, a_million_steps_stay_on_the_sphere);
  tcase_add_test(tests, to_the_opposite_point_log_takes_the_axis_of_the_smallest_component);
  tcase_add_test(tests, the_angle_of_the_half_turn_is_pi_whatever_the_sign_of_zero);
}
