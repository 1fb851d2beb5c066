/* labels: order */
/* Second order of methods with exact fast motion, uniformly in the fast frequency: h omega stays, omega grows as h falls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/suite.h"

enum { LEVELS = 5 };

/* The largest error of a coordinate of fpu at t = 1, divided by h^2, at h = 0.1/2^level and omega = x/h. The judge resolves the fast motion: 31 steps a period,
 * of order 8. */
static double error_constant(const char *method, double x, int level)
{
  const long steps = 10L << level, resolved = lround(5.0 * x) * steps;
  const double h = 1.0 / (double)steps;
  problem *chain = made_problem("fpu", spec("omega=%.17g", x / h));
  dvi_integrator *integrator = started(chain, method), *judge = started(chain, "composition:order=8,base=verlet");
  advance(integrator, h, steps);
  advance(judge, 1.0 / (double)resolved, resolved);
  const double error = distance(chain->nq, dvi_integrator_q(integrator), dvi_integrator_q(judge)) / (h * h);
  if (getenv("DVI_SHOW_ORDERS") != NULL) printf("%s, h omega = %g: omega = %g, error %.2f h^2\n", method, x, x / h, error);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&judge);
  problem_destroy(&chain);
  return error;
}

static double worst_constant(const char *method, double x)
{
  double worst = 0;
  for (int level = 0; level < LEVELS; level++) worst = fmax(worst, error_constant(method, x, level));
  return worst;
}

static const char *const methods[] = {"mollified",
                                      "trig:filter=hochbruck-lubich",
                                      "trig:filter=grimm-hochbruck",
                                      "respa:substeps=exact",
                                      "trig:filter=gautschi",
                                      "trig:filter=hairer-lubich"};
enum { METHODS = sizeof methods / sizeof *methods, FILTERED = 3 }; /* the first ones filter what the slow forces see */

/* 1.6 is the largest constant over all of these; it would grow 16 times at order 1. */
START_TEST(away_from_resonances_all_have_second_order_whatever_the_frequency)
{
  static const double product[] = {1.0, 5.0, 20.0};
  for (int k = 0; k < 3; k++) {
    const double worst = worst_constant(methods[_i], product[k]);
    ck_assert_msg(worst <= 2.0, "%s, h omega = %g: %.2f h^2", methods[_i], product[k], worst);
  }
}
END_TEST

/* phi = 1 lets the slow forces see a coordinate that comes back to the same place in each step. */
START_TEST(near_two_pi_only_those_with_an_inner_filter_have_it)
{
  const double x = 6.283;
  if (_i < FILTERED)
    ck_assert_double_le(worst_constant(methods[_i], x), 2.0);
  else
    ck_assert_double_ge(error_constant(methods[_i], x, LEVELS - 1), 10 * error_constant(methods[_i], x, 0));
}
END_TEST

START_TEST(steps_that_do_not_turn_fast_springs_right_have_first_order)
{
  const double coarse = error_constant("imex", 5.0, 0), fine = error_constant("imex", 5.0, LEVELS - 1);
  ck_assert_double_ge(fine, 10 * coarse);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("uniform order");
  tcase_add_loop_test(tests, away_from_resonances_all_have_second_order_whatever_the_frequency, 0, METHODS);
  tcase_add_loop_test(tests, near_two_pi_only_those_with_an_inner_filter_have_it, 0, METHODS);
  tcase_add_test(tests, steps_that_do_not_turn_fast_springs_right_have_first_order);
  return run_tests("uniform_order", tests);
}
