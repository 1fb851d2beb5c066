/* Sines and cosines of lanes, against those of long doubles. */
#include <float.h>
#include <math.h>

#include "expr/compile/sines.h"
#include "support/suite.h"

/* Sine and cosine of as many angles as a block has lanes. */
static void both(const double *x, double *sine, double *cosine)
{
  dvi__plain_sines(DVI__LANES, x, sine, cosine);
}

/* The distance of a number from a longer one, in units of the last place of the latter. */
static double ulps(double found, long double right)
{
  int exponent;
  (void)frexp((double)right, &exponent);
  return (double)fabsl(found - right) / ldexp(DBL_EPSILON, exponent - 1);
}

/* The largest error for angles from `least` to `most`, spread over all exponents in between if
 * these have one sign. */
static double worst(double least, double most, int blocks)
{
  double largest = 0, x[DVI__LANES], sine[DVI__LANES], cosine[DVI__LANES], alone[DVI__LANES];
  for (int block = 0; block < blocks; block++) {
    for (int k = 0; k < DVI__LANES; k++) {
      const double part = fmod((block * DVI__LANES + k + 0.5) * 0.61803398874989485, 1.0);
      x[k] = least > 0 ? least * pow(most / least, part) : least + (most - least) * part;
    }
    both(x, sine, cosine);
    dvi__plain_sine(DVI__LANES, 1, x, alone);
    for (int k = 0; k < DVI__LANES; k++) {
      ck_assert(alone[k] == cosine[k] && dvi_angle_is_plain(x[k]));
      largest = fmax(largest, ulps(sine[k], sinl((long double)x[k])));
      largest = fmax(largest, ulps(cosine[k], cosl((long double)x[k])));
    }
  }
  return largest;
}

START_TEST(plain_angles_have_sines_right_to_a_unit_in_the_last_place)
{
  const int blocks = repeats(20000);
  ck_assert_double_lt(worst(-10, 10, blocks), 0.85);
  ck_assert_double_lt(worst(1e-300, 0.4999, blocks), 0.85);
  ck_assert_double_lt(worst(1, 520000, blocks), 0.85);
}
END_TEST

/* Angles whose distances from quarter turns go down to 2^-49. */
START_TEST(angles_near_quarter_turns_are_right_or_not_plain)
{
  static const double quarter = 1.57079632679489661923;
  double x[DVI__LANES], sine[DVI__LANES], cosine[DVI__LANES];
  for (int n = 1; n < 300000; n += 37) {
    for (int k = 0; k < DVI__LANES; k++)
      x[k] = nextafter(n * quarter, 0) + ldexp(1, -7 * k) * (k % 2 ? 1 : -1);
    both(x, sine, cosine);
    for (int k = 0; k < DVI__LANES; k++) {
      if (!dvi_angle_is_plain(x[k])) continue;
      ck_assert_double_lt(ulps(sine[k], sinl((long double)x[k])), 0.85);
      ck_assert_double_lt(ulps(cosine[k], cosl((long double)x[k])), 0.85);
    }
  }
}
END_TEST

START_TEST(zeros_keep_their_sign_and_what_is_not_finite_is_not_plain)
{
  double x[DVI__LANES] = {-0.0, 0.0}, sine[DVI__LANES], cosine[DVI__LANES];
  both(x, sine, cosine);
  ck_assert(signbit(sine[0]) && !signbit(sine[1]) && sine[0] == 0 && cosine[0] == 1);
  ck_assert(!dvi_angle_is_plain((double)NAN) && !dvi_angle_is_plain((double)INFINITY));
  ck_assert(!dvi_angle_is_plain(-1e6) && !dvi_angle_is_plain(3.14159265358979323846));
}
END_TEST

SUITE(sines)
{
  tcase_add_test(tests, plain_angles_have_sines_right_to_a_unit_in_the_last_place);
  tcase_add_test(tests, angles_near_quarter_turns_are_right_or_not_plain);
  tcase_add_test(tests, zeros_keep_their_sign_and_what_is_not_finite_is_not_plain);
}
