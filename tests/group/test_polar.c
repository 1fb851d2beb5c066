#include <check.h>
#include <dvi/group.h>
#include <stdio.h>

#include "matrix.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

/* Gives R diag(s) Q with random rotations R, Q. `factor` becomes R Q, which is closest to it if s_1
 * >= s_2 >= |s_3|, s_2 + s_3 > 0. */
static void stretched(uint64_t *seed, const double s[3], double M[9], double factor[9])
{
  double w[3], R[9], Q[9], SQ[9];
  random_vector(seed, PI * fabs(uniform(seed)), w);
  dvi_so3_exp(w, R);
  random_vector(seed, PI * fabs(uniform(seed)), w);
  dvi_so3_exp(w, Q);
  multiply(R, Q, factor);
  for (int i = 0; i < 9; i++) SQ[i] = s[i / 3] * Q[i];
  multiply(R, SQ, M);
}

#ifdef DVI_HAVE_QUADMATH
/* The orthogonal factor by Newton's method, X becomes (X + X^-T)/2. */
static void quad_polar(const double M[9], quad X[9])
{
  quad_from(9, M, X);
  for (int pass = 0; pass < 40; pass++) {
    quad inverse[9];
    for (int j = 0; j < 3; j++) { /* row j of `inverse` is column j of X^-1 */
      for (int i = 0; i < 3; i++) inverse[3 * j + i] = i == j;
      quad_solve_linear(3, X, inverse + 3 * j);
    }
    for (int i = 0; i < 3; i++) /* X^-T_ij = X^-1_ji */
      for (int j = 0; j < 3; j++) X[3 * i + j] = (X[3 * i + j] + inverse[3 * i + j]) / 2;
  }
}

/* Matrices as far as 1e-15 to 0.5 from rotations, whose roundoff is moved by at most 1/(s_2 +
 * s_3). */
START_TEST(the_projection_is_right_to_6_ulp)
{
  double worst = 0;
  uint64_t seed = 1;
  for (int i = 0; i < repeats(POINTS); i++) {
    const double size = 0.5 * pow(10, -i % 16);
    const double s[3] = {1 + size * fabs(uniform(&seed)), 1, 1 - size * fabs(uniform(&seed))};
    double M[9], R[9], factor[9];
    quad exact[9];
    stretched(&seed, s, M, factor);
    dvi_so3_project(M, R);
    quad_polar(M, exact);
    worst = fmax(worst, quad_error(9, R, exact));
    quad difference[9];
    for (int j = 0; j < 9; j++) difference[j] = (quad)M[j] - exact[j];
    ck_assert_double_eq_tol(dvi_so3_distance(M), (double)quad_norm(9, difference),
                            18 * DBL_EPSILON); /* |R - exact| of nine entries of 6 ulp */
  }
  printf("project: %.2f ulp\n", worst / DBL_EPSILON);
  ck_assert_double_le(worst, 6 * DBL_EPSILON);
}
END_TEST
#endif

/* R diag(s) Q is closest to R Q also where s_3 is 0 or negative, and of any size. */
START_TEST(singular_matrices_and_reflections_are_projected)
{
  const double stretch[5][3] = {
      {1, 1, 0}, {2, 1, -0.5}, {1e-3, 1e-3, 1e-9}, {1e200, 1e200, 5e199}, {1e-200, 5e-201, 0}};
  uint64_t seed = 2;
  for (int i = 0; i < 500; i++) {
    const double *s = stretch[i % 5];
    double M[9], R[9], factor[9], defect[9];
    stretched(&seed, s, M, factor);
    dvi_so3_project(M, R);
    ck_assert_double_le(orthogonality(R, defect), DBL_EPSILON);
    /* M's roundoff, of s_1, moves R by some s_1 / (s_2 + s_3) ulp, at most 4 */
    for (int j = 0; j < 9; j++) ck_assert_double_eq_tol(R[j], factor[j], 32 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(any_matrix_has_a_rotation)
{
  const double odd[4][9] = {{0},
                            {1, 0, 0, 0, 0, 0, 0, 0, 0},
                            {-1, 0, 0, 0, -1, 0, 0, 0, -1},
                            {1e308, -1e308, 1e308, 1e308, 1e308, 1e308, -1e308, 1e308, 1e308}};
  const double distance[3] = {sqrt(3), sqrt(2), 2};
  for (int i = 0; i < 4; i++) {
    double R[9], defect[9];
    dvi_so3_project(odd[i], R);
    ck_assert_double_le(orthogonality(R, defect), DBL_EPSILON);
    if (i < 3) ck_assert_double_eq_tol(dvi_so3_distance(odd[i]), distance[i], 4 * DBL_EPSILON);
    if (i == 0)
      for (int j = 0; j < 9; j++) ck_assert(R[j] == (j % 4 == 0));
  }
}
END_TEST

START_TEST(what_was_refused_is_taken_after_its_projection)
{
  double R[9] = {1.01, 0.02, 0, 0, 0.99, 0, 0, 0, 1}, w[3];
  ck_assert_int_eq(dvi_so3_log(R, w), DVI_BAD_ARGUMENT);
  dvi_so3_project(R, R);
  ck_assert_int_eq(dvi_so3_log(R, w), DVI_OK);
  /* in the plane tan w = (M_21 - M_12) / (M_11 + M_22) */
  ck_assert_double_eq_tol(w[2], -atan(0.01), 2 * DBL_EPSILON);
}
END_TEST

START_TEST(matrices_up_to_the_bound_are_read_as_rotations)
{
  static const int entries[][2] = {{0, 0}, {4, 4}, {8, 8}, {0, 8}}; /* which are moved */
  const double bound = 1e-8, part = entries[_i][0] == entries[_i][1] ? 1 : sqrt(.5);
  for (int off = 0; off < 2; off++) {
    const double s = (off ? 1.001 : .999) * bound * part;
    double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, w[3], q[4];
    R[entries[_i][0]] = R[entries[_i][1]] = 1 + s;
    ck_assert_int_eq(dvi_so3_log(R, w), off ? DVI_BAD_ARGUMENT : DVI_OK);
    ck_assert_int_eq(dvi_so3_quaternion(R, q), off ? DVI_BAD_ARGUMENT : DVI_OK);
  }
}
END_TEST

SUITE(polar)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, the_projection_is_right_to_6_ulp);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, singular_matrices_and_reflections_are_projected);
  tcase_add_test(tests, any_matrix_has_a_rotation);
  tcase_add_test(tests, what_was_refused_is_taken_after_its_projection);
  tcase_add_loop_test(tests, matrices_up_to_the_bound_are_read_as_rotations, 0, 4);
}
