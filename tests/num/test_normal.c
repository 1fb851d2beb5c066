/* labels: unit */
#include <check.h>
#include <float.h>
#include <math.h>

#include "num/envelope.h"
#include "num/normal.h"
#include "num/philox.h"
#include "support/suite.h"

/* The known answers of Salmon et al. 2011, file kat_vectors of Random123. */
START_TEST(philox_has_the_bits_of_its_authors)
{
  uint32_t zero[4] = {0}, ones[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX},
           pi[4] = {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344};
  static const uint32_t of_zero[4] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8},
                        of_ones[4] = {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd},
                        of_pi[4] = {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
  dvi__philox(zero, 0);
  dvi__philox(ones, UINT64_MAX);
  dvi__philox(pi, UINT64_C(0x299f31d0a4093822));
  for (int i = 0; i < 4; i++) {
    ck_assert_uint_eq(zero[i], of_zero[i]);
    ck_assert_uint_eq(ones[i], of_ones[i]);
    ck_assert_uint_eq(pi[i], of_pi[i]);
  }
}
END_TEST

/* The logarithm is right to 3 roundings over the whole range, in particular near 1. */
START_TEST(the_logarithm_is_right_to_its_last_bits)
{
  for (int i = 1; i < 20000; i++) {
    const double inner = i / 20000.0, near = 1 - ldexp(1.0 + inner, -2 - i % 50),
                 small = ldexp(0.5 + inner / 2, -(i % 53));
    const double u[] = {inner, near, small};
    for (int k = 0; k < 3; k++)
      ck_assert_double_eq_tol(dvi__log(u[k]), log(u[k]), 3 * DBL_EPSILON * fabs(log(u[k])));
  }
  ck_assert_double_eq(dvi__log(1), 0);
}
END_TEST

/* Angles in turns are exact, and so are the turns that libm's arguments are made of here. */
START_TEST(cosine_and_sine_are_right_to_their_last_bits)
{
  const long double turn = 8 * atanl(1);
  for (int i = -30000; i <= 30000; i++) {
    const double turns = i / 8192.0;
    double c, s;
    dvi__circle(turns, &c, &s);
    ck_assert_double_eq_tol(c, (double)cosl(turn * turns), 1.5 * DBL_EPSILON);
    ck_assert_double_eq_tol(s, (double)sinl(turn * turns), 1.5 * DBL_EPSILON);
  }
}
END_TEST

START_TEST(decay_is_right_near_zero_and_far_from_it)
{
  for (int i = 1; i < 4000; i++) {
    const double x = -ldexp(i / 4000.0, 6 - i % 60);
    ck_assert_double_eq_tol(dvi__decay(x), expm1(x), 8 * DBL_EPSILON * fabs(expm1(x)));
  }
  ck_assert_double_eq(dvi__decay(-0.0), 0);
  ck_assert_double_eq(dvi__decay(-1e9), -1);
}
END_TEST

/* The moments 1 to 4 of N numbers have the standard errors 1, sqrt(2), sqrt(15) and sqrt(96) over
 * sqrt(N). The correlations of coordinates, of draws and of streams have the error 1/sqrt(N). The
 * numbers are the same in every run, and each bound is 4 standard errors. */
START_TEST(numbers_are_normal_and_independent)
{
  enum { MEMBERS = 500, DRAWS = 400, N = MEMBERS * DRAWS };
  static const double moment[4] = {0, 1, 0, 3};
  static const double error[4] = {1, 1.4143, 3.873, 9.798};
  double sum[4] = {0}, cross[3] = {0}, draw[MEMBERS], stream[MEMBERS], x[MEMBERS], y[MEMBERS],
         last[MEMBERS] = {0};
  for (int d = 0; d < DRAWS; d++) {
    for (int k = 0; k < MEMBERS; k++) draw[k] = d, stream[k] = k;
    dvi__normals(MEMBERS, 42, 7, draw, stream, x, y);
    for (int k = 0; k < MEMBERS; k++) {
      sum[0] += x[k];
      sum[1] += x[k] * x[k];
      sum[2] += x[k] * x[k] * x[k];
      sum[3] += x[k] * x[k] * x[k] * x[k];
      cross[0] += x[k] * y[k];
      cross[1] += x[k] * last[k];
      cross[2] += x[k] * x[(k + 1) % MEMBERS];
      last[k] = x[k];
    }
  }
  for (int i = 0; i < 4; i++)
    ck_assert_double_eq_tol(sum[i] / N, moment[i], 4 * error[i] / sqrt(N));
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(cross[i] / N, 0, 4 / sqrt(N));
}
END_TEST

/* A member's number does not depend on its neighbours, nor on whether both are asked for. */
START_TEST(numbers_are_functions_of_their_counter)
{
  const double draws[3] = {5, 0x1p40, 6}, streams[3] = {0, 4294967295.0, 1};
  double x[3], y[3], alone_x, alone_y;
  dvi__normals(3, 9, 2, draws, streams, x, y);
  for (int k = 0; k < 3; k++) {
    dvi__normals(1, 9, 2, draws + k, streams + k, &alone_x, &alone_y);
    ck_assert_double_eq(alone_x, x[k]);
    ck_assert_double_eq(alone_y, y[k]);
    dvi__normals(1, 9, 2, draws + k, streams + k, &alone_x, NULL);
    ck_assert_double_eq(alone_x, x[k]);
    dvi__normals(1, 10, 2, draws + k, streams + k, &alone_x, NULL);
    ck_assert_double_ne(alone_x, x[k]);
    dvi__normals(1, 9, 3, draws + k, streams + k, &alone_x, NULL);
    ck_assert_double_ne(alone_x, x[k]);
  }
}
END_TEST

/* C C^T of the factor of a matrix with a hole, from the products with unit vectors. */
START_TEST(an_envelope_factors_its_matrix)
{
  enum { N = 4 };
  static const double A[N][N] = {{4, 1, 0, 2}, {1, 5, 0, 0}, {0, 0, 3, 1}, {2, 0, 1, 6}};
  const int start[] = {0, 3, 5, 7, 10}, row[] = {0, 1, 3, 0, 1, 2, 3, 0, 2, 3};
  double values[10], C[N][N];
  dvi__pattern pattern;
  dvi__envelope *factor = NULL;
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, row}, N, "matrix", &pattern), DVI_OK);
  for (int j = 0, e = 0; j < N; j++)
    for (; e < start[j + 1]; e++) values[e] = A[row[e]][j];
  ck_assert_int_eq(dvi__envelope_create(&pattern, values, &factor), DVI_OK);
  for (int j = 0; j < N; j++) {
    for (int i = 0; i < N; i++) C[j][i] = i == j;
    dvi__envelope_product(factor, C[j]);
  }
  for (int i = 0; i < N; i++)
    for (int k = 0; k < N; k++) {
      double sum = 0;
      for (int j = 0; j < N; j++) sum += C[j][i] * C[j][k];
      ck_assert_double_eq_tol(sum, A[i][k], 8 * DBL_EPSILON);
    }
  dvi__envelope_destroy(&factor);
  values[9] = 0.5; /* no longer positive */
  ck_assert_int_eq(dvi__envelope_create(&pattern, values, &factor), DVI_SINGULAR);
  ck_assert_ptr_null(factor);
  check_words("row 3");
  dvi__pattern_clear(&pattern);
}
END_TEST

SUITE(normal)
{
  tcase_add_test(tests, philox_has_the_bits_of_its_authors);
  tcase_add_test(tests, the_logarithm_is_right_to_its_last_bits);
  tcase_add_test(tests, cosine_and_sine_are_right_to_their_last_bits);
  tcase_add_test(tests, decay_is_right_near_zero_and_far_from_it);
  tcase_add_test(tests, numbers_are_normal_and_independent);
  tcase_add_test(tests, numbers_are_functions_of_their_counter);
  tcase_add_test(tests, an_envelope_factors_its_matrix);
}
