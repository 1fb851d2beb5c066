/* Operations in quadruple precision, against libquadmath. */
#include <check.h>
#include <math.h>

#include "expr/graph_make.h"
#include "expr/quad.h"
#include "support/quad/quad_graph.h"
#include "support/suite.h"

#if defined DVI__QUAD && defined DVI_HAVE_QUADMATH
/* Arguments in the domain of every function that takes them, from small ones to large ones. */
static double argument(dvi__op op, int i)
{
  const double small[] = {-0.999, -0.7, -0.3, -1e-9, 1e-9, 0.1, 0.5, 0.75, 0.9999},
               any[] = {-700.25, -30.5, -1.2, -1e-7, 1e-7, 0.3, 2.75, 41.5, 690.125},
               positive[] = {1e-300, 1e-12, 0.001, 0.3, 0.999, 1.001, 2.5, 1e5, 1e200};
  switch (op) {
  case DVI__OP_ASIN:
  case DVI__OP_ACOS:
  case DVI__OP_ATANH: return small[i];
  case DVI__OP_ACOSH: return 1 + fmin(positive[i], 1e100) * 1e-3;
  case DVI__OP_LOG:
  case DVI__OP_SQRT:
  case DVI__OP_POWER:
  case DVI__OP_RAISE: return positive[i];
  default: return any[i];
  }
}
enum { ARGUMENTS = 9 };

/* Two dozen roundings of numbers of 113 bits, relative to the result, to the argument (angles), or
 * to the logarithm of the result (powers). */
static const double some_roundings = 24 * 1e-34;

static double off(quad a, quad b, quad size)
{
  const quad difference = a < b ? b - a : a - b;
  return (double)(difference / (size > 1 ? size : 1));
}

START_TEST(every_operation_is_right_to_its_last_digits)
{
  const dvi__op op = (dvi__op)_i;
  const int operands = dvi__operands(op);
  if (operands == 0) return;
  for (int i = 0; i < ARGUMENTS; i++)
    for (int j = 0; j < (operands > 1 ? ARGUMENTS : 1); j++) {
      const double exponent = op == DVI__OP_POWER ? -1.5 : 0;
      const quad a = (quad)argument(op, i) + (quad)1e-20,
                 b = operands > 1 ? (quad)argument(DVI__OP_SIN, j) / 300 : 0;
      const quad expected = quad_operate(op, exponent, a, b),
                 found = dvi__quad_operate(op, exponent, a, b);
      if (!isfinite((double)expected) || fabs((double)expected) > 1e300) continue;
      ck_assert_msg(off(found, expected, fabsq(expected)) <=
                        some_roundings * fmax(fmax(1, fabs((double)a)),
                                              fabs(log(fabs((double)expected) + 1e-300))),
                    "%d at %g, %g: %g, %g off", _i, (double)a, (double)b, (double)expected,
                    off(found, expected, fabsq(expected)));
    }
}
END_TEST

/* Takes central differences of order 2 with a step of 1e-8. The error is some 1e-16 of the third
 * derivative. */
START_TEST(slopes_are_those_of_the_values)
{
  const dvi__op op = (dvi__op)_i;
  const int operands = dvi__operands(op);
  if (operands == 0 || op == DVI__OP_SIGN) return;
  const int least = op == DVI__OP_WHERE; /* a condition is 0 or 1, and has no slope */
  const double exponent = op == DVI__OP_POWER ? 3.5 : 0;
  const quad step = (quad)1e-8,
             a = op == DVI__OP_ACOSH   ? (quad)1.7
                 : op == DVI__OP_WHERE ? (quad)1
                                       : (quad)0.6,
             b = (quad)0.8;
  quad slope[2] = {0, 0};
  dvi__quad_slopes(op, exponent, quad_operate(op, exponent, a, b), a, b, slope);
  for (int k = least; k < operands; k++) {
    const quad da = k == 0 ? step : 0, db = k == 1 ? step : 0;
    const quad difference = (quad_operate(op, exponent, a + da, b + db) -
                             quad_operate(op, exponent, a - da, b - db)) /
                            (2 * step);
    ck_assert_msg(off(slope[k], difference, 1) < 1e-14, "%d by %d: %g, not %g", _i, k,
                  (double)slope[k], (double)difference);
  }
}
END_TEST
#endif

SUITE(quad)
{
#if defined DVI__QUAD && defined DVI_HAVE_QUADMATH
  tcase_add_loop_test(tests, every_operation_is_right_to_its_last_digits, 0, DVI__OP_COUNT);
  tcase_add_loop_test(tests, slopes_are_those_of_the_values, 0, DVI__OP_COUNT);
#else
  (void)tests;
#endif
}
