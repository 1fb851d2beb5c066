/* labels: unit */
#include <math.h>

#include "support/systems/bond.h"
#include "support/systems/oscillators.h"
#include "support/runs.h"
#include "support/suite.h"

static const char *const methods[] = {"mollified", "mollified:filter=projection"};

/* Beyond, what is left of |r| - 1 is a rounding, of which the growth shows the root. */
START_TEST(filtered_kicks_do_not_resonate)
{
  for (int k = 1; k <= 4; k++)
    for (int i = -50; i <= 50; i++)
      ck_assert_double_le(oscillators_growth(methods[_i], 0.1, k + 8e-5 * i), 1 + 1e-7);
}
END_TEST

/* With h omega below 1 the projection leaves all modes in, and nothing is filtered. */
START_TEST(modes_that_a_step_resolves_are_not_projected)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *projected = start_integrator(chain, "mollified:filter=projection"),
                 *plain = start_integrator(chain, "respa:substeps=exact");
  advance(projected, 0.019, 100);
  advance(plain, 0.019, 100);
  ck_assert_double_le(distance(6, dvi_integrator_q(projected), dvi_integrator_q(plain)), 1e-13);
  advance(projected, 0.021, 100);
  advance(plain, 0.021, 100);
  ck_assert_double_gt(distance(6, dvi_integrator_q(projected), dvi_integrator_q(plain)), 1e-6);
  dvi_integrator_destroy(&projected);
  dvi_integrator_destroy(&plain);
  problem_destroy(&chain);
}
END_TEST

/* Gives the mean of the fast motion that starts at rest at q, for oscillators sin(h omega)/(h
 * omega) q. */
START_TEST(the_average_asks_for_the_slow_force_at_the_mean_of_the_fast_motion)
{
  const double h = 0.05, omega = 50, x = h * omega, filter = sin(x) / x;
  problem *model = create_problem("oscillators", NULL);
  dvi_integrator *integrator = start_integrator(model, "mollified");
  advance(integrator, h, 1);
  const double p_half = -h / 2 * filter * filter, q = cos(x) + sin(x) / omega * p_half;
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q, 1e-15);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0],
                          cos(x) * p_half - omega * sin(x) - h / 2 * filter * filter * q, 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(fast_potentials_that_are_not_quadratic_are_refused)
{
  bond pair;
  dvi_integrator *integrator = NULL;
  make_bond(2500, 1, &pair);
  ck_assert_int_eq(dvi_integrator_create(pair.system, methods[_i], &integrator), DVI_UNSUPPORTED);
  check_words("mollified: a fast potential is not declared `quadratic`");
  check_words("imex and respa:substeps=k take any");
  destroy_bond(&pair);
}
END_TEST

SUITE(mollified)
{
  tcase_add_loop_test(tests, filtered_kicks_do_not_resonate, 0, 2);
  tcase_add_test(tests, modes_that_a_step_resolves_are_not_projected);
  tcase_add_test(tests, the_average_asks_for_the_slow_force_at_the_mean_of_the_fast_motion);
  tcase_add_loop_test(tests, fast_potentials_that_are_not_quadratic_are_refused, 0, 2);
}
