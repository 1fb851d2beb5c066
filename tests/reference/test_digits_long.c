/* labels: reference slow */
/* Long runs of the quadruple-precision judge. */
#include <math.h>

#include "support/quad/quad.h"
#include "support/suite.h"

/* fpu at T = 200 is sensitive: from 1/50 rounded to a double, as here, x0_1 differs by 5e-14 from what exact 1/50 gives. The printed
 * digits are those of the rounded start. */
START_TEST(fpu_has_the_printed_state_at_200)
{
  static const double printed[6] = {0.0568458230701694,  0.797913189042865,  0.229526402291378,
                                    0.00251963934996296, 0.0112354204569455, -0.0097345812522916};
  static const double unit[6] = {1e-16, 1e-15, 1e-15, 1e-17, 1e-16, 1e-16};
  double q[6] = {1.0, 0.0, 0.0, 1.0 / 50.0, 0.0, 0.0}, p[6] = {1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  ck_assert_double_lt(quad_solve("fpu", 0, NULL, 200.0, q, p), 1e-20);
  /* half a unit of the last printed digit, and one rounding */
  for (int i = 0; i < 6; i++) ck_assert_double_eq_tol(q[i], printed[i], 0.5 * unit[i] + 2.2e-16 * fabs(q[i]));
}
END_TEST

SUITE(digits_long)
{
  tcase_set_timeout(tests, 600);
  tcase_add_test(tests, fpu_has_the_printed_state_at_200);
}
