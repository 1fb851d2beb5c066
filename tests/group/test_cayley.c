#include <check.h>
#include <dvi/group.h>
#include <stdio.h>

#include "matrix.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH
/* The columns of (I - W/2)^-1 (I + W/2). */
static void quad_cayley(const double w[3], quad R[9])
{
  quad exact[3], W[9], left[9];
  quad_from(3, w, exact);
  quad_hat(exact, W);
  for (int i = 0; i < 9; i++) left[i] = (i % 4 == 0) - W[i] / 2;
  for (int j = 0; j < 3; j++) {
    quad column[3];
    for (int i = 0; i < 3; i++) column[i] = (i == j) + W[3 * i + j] / 2;
    quad_solve_linear(3, left, column);
    for (int i = 0; i < 3; i++) R[3 * i + j] = column[i];
  }
}

START_TEST(cayley_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 1;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], R[9];
    quad exact[9];
    point(i, 20, &seed, w);
    dvi_so3_cayley(w, R);
    quad_cayley(w, exact);
    for (int j = 0; j < 9; j++) {
      const double error = quad_error(1, R + j, exact + j);
      if (error > 0) worst = fmax(worst, error / (j % 4 == 0 ? 1 : fmin(1, length(w))));
    }
  }
  printf("cayley: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST

/* Entries of R that are rounded by half an ulp move w by up to 1 + |w|^2/4 times as much. */
START_TEST(its_inverse_is_right_to_4_ulp)
{
  double worst = 0;
  uint64_t seed = 2;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], found[3], R[9];
    quad rotation[9], exact[3];
    point(i, 20, &seed, w);
    quad_cayley(w, rotation);
    for (int j = 0; j < 9; j++) R[j] = (double)rotation[j];
    ck_assert_int_eq(dvi_so3_cayley_inverse(R, found), DVI_OK);
    quad_from(3, w, exact);
    const double error = quad_error(3, found, exact), size = length(w);
    if (error > 0) worst = fmax(worst, error / (fmin(1, size) * (1 + 0.25 * size * size)));
  }
  printf("cayley_inverse: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 4 * DBL_EPSILON);
}
END_TEST

/* hat(dcayley_w v) = (d/dt cayley(w + t v)) cayley(w)^T, by central differences in quadruple
 * precision. */
START_TEST(dcayley_is_its_derivative_moved_back)
{
  double worst = 0;
  uint64_t seed = 3;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], v[3], u[3];
    quad exact_w[3], exact_v[3], W[9], U[9];
    point(i, 20, &seed, w);
    random_vector(&seed, 1, v);
    dvi_so3_dcayley(w, v, u);
    /* With A = (I - W/2)^-1 it is hat(u) = A hat(v) A^T. */
    quad_from(3, w, exact_w);
    quad_from(3, v, exact_v);
    quad_hat(exact_w, W);
    quad_hat(exact_v, U);
    for (int j = 0; j < 9; j++) W[j] = (j % 4 == 0) - W[j] / 2;
    /* U becomes (A U)^T, and then (A (A U)^T)^T = A U A^T for its skew part */
    for (int pass = 0; pass < 2; pass++) {
      quad next[9];
      for (int j = 0; j < 3; j++) {
        quad column[3] = {U[j], U[3 + j], U[6 + j]};
        quad_solve_linear(3, W, column);
        for (int k = 0; k < 3; k++) next[3 * j + k] = column[k];
      }
      for (int j = 0; j < 9; j++) U[j] = next[j];
    }
    const quad exact[3] = {U[7], U[2], U[3]};
    worst = fmax(worst, quad_error(3, u, exact));
  }
  printf("dcayley: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST

START_TEST(the_rotation_of_any_quaternion_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 4;
  for (int i = 0; i < repeats(POINTS); i++) {
    const double scale = ldexp(1, 990 - i % 1980);
    double q[4], R[9];
    quad p[4];
    for (int j = 0; j < 4; j++) q[j] = scale * uniform(&seed) * (i % 7 == j ? 1e-9 : 1);
    for (int j = 0; j < 4; j++) p[j] = (quad)q[j] / (quad)scale;
    dvi_so3_from_quaternion(q, R);
    const quad n = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    const quad exact[9] = {(p[0] * p[0] + p[1] * p[1] - p[2] * p[2] - p[3] * p[3]) / n,
                           2 * (p[1] * p[2] - p[0] * p[3]) / n,
                           2 * (p[1] * p[3] + p[0] * p[2]) / n,
                           2 * (p[1] * p[2] + p[0] * p[3]) / n,
                           (p[0] * p[0] - p[1] * p[1] + p[2] * p[2] - p[3] * p[3]) / n,
                           2 * (p[2] * p[3] - p[0] * p[1]) / n,
                           2 * (p[1] * p[3] - p[0] * p[2]) / n,
                           2 * (p[2] * p[3] + p[0] * p[1]) / n,
                           (p[0] * p[0] - p[1] * p[1] - p[2] * p[2] + p[3] * p[3]) / n};
    worst = fmax(worst, quad_error(9, R, exact));
  }
  printf("from_quaternion: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST

/* Judges by (cos |w|/2, w sin(|w|/2) / |w|). */
START_TEST(the_quaternion_of_a_rotation_is_right_to_2_ulp)
{
  double worst = 0;
  uint64_t seed = 5;
  for (int i = 0; i < repeats(POINTS); i++) {
    double w[3], q[4], R[9];
    quad rotation[9], exact[4], exact_w[3];
    point(i, 2 * PI, &seed, w);
    quad_rotation(w, rotation);
    for (int j = 0; j < 9; j++) R[j] = (double)rotation[j];
    ck_assert_int_eq(dvi_so3_quaternion(R, q), DVI_OK);
    ck_assert_double_ge(q[0], 0);
    quad_from(3, w, exact_w);
    const quad angle = quad_norm(3, exact_w), ratio = angle > 0 ? sinq(angle / 2) / angle : 0;
    exact[0] = cosq(angle / 2);
    for (int j = 0; j < 3; j++) exact[1 + j] = ratio * exact_w[j];
    if ((double)(q[0] * exact[0] + q[1] * exact[1] + q[2] * exact[2] + q[3] * exact[3]) < 0)
      for (int j = 0; j < 4; j++) q[j] = -q[j]; /* the same rotation */
    worst = fmax(worst, quad_error(4, q, exact));
  }
  printf("quaternion: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 2 * DBL_EPSILON);
}
END_TEST
#endif

START_TEST(rotations_of_cayley_and_of_quaternions_are_orthogonal_to_1_ulp)
{
  double worst = 0;
  uint64_t seed = 6;
  for (int i = 0; i < 100000; i++) {
    double w[3], q[4], R[9], defect[9];
    random_vector(&seed, 20 * fabs(uniform(&seed)), w);
    for (int j = 0; j < 4; j++) q[j] = uniform(&seed);
    dvi_so3_cayley(w, R);
    worst = fmax(worst, orthogonality(R, defect));
    dvi_so3_from_quaternion(q, R);
    worst = fmax(worst, orthogonality(R, defect));
  }
  printf("R^T R - I: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, DBL_EPSILON);
}
END_TEST

START_TEST(the_inverse_of_dcayley_undoes_it)
{
  uint64_t seed = 7;
  for (int i = 0; i < 1000; i++) {
    double w[3], v[3], u[3];
    random_vector(&seed, 4 * fabs(uniform(&seed)), w);
    random_vector(&seed, 1, v);
    dvi_so3_dcayley(w, v, u);
    dvi_so3_dcayley_inverse(w, u, u);
    /* the inverse is as large as 1 + |w|^2/4 = 5 */
    for (int j = 0; j < 3; j++) ck_assert_double_eq_tol(u[j], v[j], 10 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(half_turns_are_refused_by_the_inverse_of_cayley)
{
  const double turn[9] = {-1, 0, 0, 0, 1, 0, 0, 0, -1};
  double w[3] = {7, 7, 7};
  ck_assert_int_eq(dvi_so3_cayley_inverse(turn, w), DVI_BAD_ARGUMENT);
  check_words("half turn");
  ck_assert(w[0] == 7 && w[1] == 7 && w[2] == 7);
}
END_TEST

START_TEST(the_quaternion_0_is_taken_for_1)
{
  const double q[4] = {0, 0, 0, 0};
  double R[9];
  dvi_so3_from_quaternion(q, R);
  for (int i = 0; i < 9; i++) ck_assert(R[i] == (i % 4 == 0));
}
END_TEST

SUITE(cayley)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, cayley_is_right_to_2_ulp);
  tcase_add_test(tests, its_inverse_is_right_to_4_ulp);
  tcase_add_test(tests, dcayley_is_its_derivative_moved_back);
  tcase_add_test(tests, the_rotation_of_any_quaternion_is_right_to_2_ulp);
  tcase_add_test(tests, the_quaternion_of_a_rotation_is_right_to_2_ulp);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, rotations_of_cayley_and_of_quaternions_are_orthogonal_to_1_ulp);
  tcase_add_test(tests, the_inverse_of_dcayley_undoes_it);
  tcase_add_test(tests, half_turns_are_refused_by_the_inverse_of_cayley);
  tcase_add_test(tests, the_quaternion_0_is_taken_for_1);
}
