/* labels: unit */
#include <check.h>

#include "support/runs.h"
#include "support/suite.h"

/* With a constant mass the trapezoidal rule is Stoermer-Verlet, and the two differ by roundings
 * only. */
START_TEST(with_a_constant_mass_it_is_verlet)
{
  problem *stars = create_problem("henon-heiles", NULL);
  dvi_integrator *implicit = start_integrator(stars, "trapezoidal"),
                 *explicit_one = start_integrator(stars, "verlet");
  advance(implicit, 0.1, 200);
  advance(explicit_one, 0.1, 200);
  /* 200 steps of a few roundings each, on an orbit that does not amplify them */
  ck_assert_double_le(distance(2, dvi_integrator_q(implicit), dvi_integrator_q(explicit_one)),
                      1e-14);
  ck_assert_double_le(distance(2, dvi_integrator_p(implicit), dvi_integrator_p(explicit_one)),
                      1e-14);
  dvi_integrator_destroy(&implicit);
  dvi_integrator_destroy(&explicit_one);
  problem_destroy(&stars);
}
END_TEST

START_TEST(it_takes_a_general_lagrangian)
{
  problem *pendula = create_problem("double-pendulum", NULL);
  dvi_integrator *integrator = start_integrator(pendula, "trapezoidal");
  double defect;
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, pendula->q, pendula->p, 0.02, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-10); /* differences resolve about 1e-12 */
  dvi_integrator_destroy(&integrator);
  problem_destroy(&pendula);
}
END_TEST

SUITE(trapezoidal)
{
  tcase_add_test(tests, with_a_constant_mass_it_is_verlet);
  tcase_add_test(tests, it_takes_a_general_lagrangian);
}
