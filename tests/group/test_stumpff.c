#include <check.h>
#include <stdio.h>

#include "group/stumpff.h"
#include "points.h"
#include "quad.h"
#include "support/suite.h"

#ifdef DVI_HAVE_QUADMATH
static quad exact(int k, double s)
{
  quad term = 1, sum = 0;
  for (int j = 1; j <= k; j++) term /= j;
  for (int j = 0; j < QUAD_SERIES; j++) {
    sum += term;
    term *= -(quad)s / ((2 * j + k + 1) * (2 * j + k + 2));
  }
  return sum;
}

/* Gives the error in units of 2.2e-16 of the function's size, which is its absolute value, or the
 * bound of the oscillation for functions with zeros. */
static double ulps(int k, double s, double computed)
{
  const double bound[3] = {1, 1 / fmax(1, sqrt(s)), 1 / fmax(2, s / 4)};
  const quad value = exact(k, s), size = k < 3 ? (quad)bound[k] : fabsq(value);
  return (double)(fabsq((quad)computed - value) / size) / DBL_EPSILON;
}

START_TEST(all_nine_are_right_to_4_ulp_up_to_two_turns)
{
  double worst[9] = {0};
  uint64_t seed = 1;
  for (int i = 0; i < repeats(20000); i++) {
    const double angle = i < SPECIAL_ANGLES ? special_angle(i) : 4 * PI * fabs(uniform(&seed)),
                 s = angle * angle;
    double c[9];
    dvi__stumpff(s, c);
    for (int k = 0; k < 9; k++) worst[k] = fmax(worst[k], ulps(k, s, c[k]));
  }
  for (int k = 0; k < 9; k++) printf("c_%d: %.2f ulp\n", k, worst[k]);
  for (int k = 0; k < 9; k++) ck_assert_double_le(worst[k], 4);
}
END_TEST

/* Its zeros at full turns are double, and 2 (sin(theta/2)/theta)^2 has them at the right places.
 * The angle's rounding counts twice. */
START_TEST(c_2_keeps_its_digits_close_to_a_full_turn)
{
  for (double gap = 0.1; gap > 1e-6; gap /= 10) {
    const double angle = 2 * PI - gap, s = angle * angle;
    double c[4];
    dvi__stumpff_four(s, c);
    ck_assert_double_le(fabs((double)(c[2] / exact(2, s) - 1)),
                        (2 * 2 * PI / gap + 4) * DBL_EPSILON);
  }
}
END_TEST
#endif

START_TEST(the_first_four_alone_have_the_same_digits)
{
  uint64_t seed = 2;
  for (int i = 0; i < 1000; i++) {
    const double s = 200 * fabs(uniform(&seed)) * fabs(uniform(&seed));
    double four[4], nine[9];
    dvi__stumpff_four(s, four);
    dvi__stumpff(s, nine);
    for (int k = 0; k < 4; k++) ck_assert(four[k] == nine[k]);
  }
}
END_TEST

START_TEST(no_size_of_s_makes_nan)
{
  for (int exponent = -1074; exponent <= 1024; exponent++) {
    double c[9];
    dvi__stumpff(ldexp(1, exponent), c); /* 2^1024 has overflowed */
    for (int k = 0; k < 9; k++) ck_assert(fabs(c[k]) <= 1);
  }
}
END_TEST

SUITE(stumpff)
{
#ifdef DVI_HAVE_QUADMATH
  tcase_add_test(tests, all_nine_are_right_to_4_ulp_up_to_two_turns);
  tcase_add_test(tests, c_2_keeps_its_digits_close_to_a_full_turn);
#else
  puts("no libquadmath: the comparison with quadruple precision is left out");
#endif
  tcase_add_test(tests, the_first_four_alone_have_the_same_digits);
  tcase_add_test(tests, no_size_of_s_makes_nan);
}
