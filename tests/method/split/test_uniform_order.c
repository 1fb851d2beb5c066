/* labels: order */
/* Methods with exact fast motion have second order uniformly in the fast frequency. h omega stays,
 * and omega grows as h falls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/suite.h"

enum { LEVELS = 5 };

/* Gives the largest error of a coordinate of fpu at t = 1, divided by h^2, at h = 0.1/2^level and
 * omega = x/h. The judge resolves the fast motion by 31 steps a period, of order 8. */
static double error_constant(const char *method, double x, int level)
{
  const long steps = 10L << level, resolved = lround(5.0 * x) * steps;
  const double h = 1.0 / (double)steps;
  problem *chain = create_problem("fpu", method_spec("omega=%.17g", x / h));
  dvi_integrator *integrator = start_integrator(chain, method),
                 *judge = start_integrator(chain, "composition:order=8,base=verlet");
  advance(integrator, h, steps);
  advance(judge, 1.0 / (double)resolved, resolved);
  const double error = distance(chain->nq, dvi_integrator_q(integrator), dvi_integrator_q(judge)) /
                       (h * h);
  if (getenv("DVI_SHOW_ORDERS") != NULL)
    printf("%s, h omega = %g: omega = %g, error %.2f h^2\n", method, x, x / h, error);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&judge);
  problem_destroy(&chain);
  return error;
}

static double worst_constant(const char *method, double x)
{
  double worst = 0;
  for (int level = 0; level < LEVELS; level++)
    worst = fmax(worst, error_constant(method, x, level));
  return worst;
}

/* The theorem of Hairer, Lubich and Wanner 2006, sec. XIII.4: positions have order 2 uniformly in
 * omega where, with the same constants for all x = h omega,
 *     |psi(x)| <= C1 sinc^2(x/2),      |phi(x)| <= C2 |sinc(x/2)|,
 *     |psi(x) phi(x)| <= C3 |sinc x|.
 * The first two can fail near even multiples of pi, the third one near odd ones. `bound` is above
 * the largest constant where they hold; at order 1 constants grow 16 times over the levels. */
typedef struct filter_row {
  const char *method;
  double bound;
  int near_pi, near_two_pi; /* whether they hold there */
} filter_row;

static const filter_row rows[] = {
    {"mollified", 2, 1, 1},
    {"mollified:filter=projection", 4, 1, 1},
    {"trig:filter=hochbruck-lubich", 2, 1, 1},
    {"trig:filter=grimm-hochbruck", 2, 1, 1},
    {"trig:filter=hairer-lubich", 2, 1, 0},
    {"respa:substeps=exact", 2, 1, 0},
    {"trig:filter=gautschi", 2, 0, 0},
};
enum { ROWS = sizeof rows / sizeof *rows };

static void check_order_at(const filter_row *row, double x, int holds)
{
  if (holds) {
    const double worst = worst_constant(row->method, x);
    ck_assert_msg(worst <= row->bound, "%s, h omega = %g: %.2f h^2", row->method, x, worst);
  } else {
    ck_assert_double_ge(error_constant(row->method, x, LEVELS - 1),
                        10 * error_constant(row->method, x, 0));
  }
}

START_TEST(away_from_resonances_all_have_second_order_whatever_the_frequency)
{
  static const double product[] = {1.0, 5.0, 20.0};
  for (int k = 0; k < 3; k++) check_order_at(&rows[_i], product[k], 1);
}
END_TEST

START_TEST(near_multiples_of_pi_only_those_have_it_for_which_the_theorem_holds)
{
  check_order_at(&rows[_i], 3.14, rows[_i].near_pi);
  check_order_at(&rows[_i], 6.283, rows[_i].near_two_pi);
}
END_TEST

/* Its phi divides by the root of sinc. It does not exist where sinc < 0, and is not bounded
 * before. */
START_TEST(exact_filters_have_it_far_from_the_zeros_of_sinc_alone)
{
  const char *method = "trig:filter=exact";
  ck_assert_double_le(worst_constant(method, 1.0), 2.0);
  ck_assert_double_le(worst_constant(method, 20.0), 2.0);
  ck_assert_double_ge(error_constant(method, 3.14, LEVELS - 1), 100.0);
}
END_TEST

START_TEST(steps_that_do_not_turn_fast_springs_right_have_first_order)
{
  const double coarse = error_constant("imex", 5.0, 0),
               fine = error_constant("imex", 5.0, LEVELS - 1);
  ck_assert_double_ge(fine, 10 * coarse);
}
END_TEST

SUITE(uniform_order)
{
  tcase_add_loop_test(tests, away_from_resonances_all_have_second_order_whatever_the_frequency, 0,
                      ROWS);
  tcase_add_loop_test(tests, near_multiples_of_pi_only_those_have_it_for_which_the_theorem_holds, 0,
                      ROWS);
  tcase_add_test(tests, exact_filters_have_it_far_from_the_zeros_of_sinc_alone);
  tcase_add_test(tests, steps_that_do_not_turn_fast_springs_right_have_first_order);
}
