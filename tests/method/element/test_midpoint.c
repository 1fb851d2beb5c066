/* labels: unit */
#include <check.h>

#include "support/runs.h"
#include "support/suite.h"

/* For L = v^2/2 - k q^2/2 the midpoint rule is the Cayley transform, which can be written down. */
START_TEST(on_an_oscillator_a_step_is_the_cayley_transform)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator, "midpoint");
  const double h = 0.3, k = 0.5, a = h * h * k / 4, q0 = oscillator->q[0], p0 = 0;
  advance(integrator, h, 1);
  /* a few roundings of 0.5 */
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], ((1 - a) * q0 + h * p0) / (1 + a),
                          2e-16);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], ((1 - a) * p0 - h * k * q0) / (1 + a),
                          2e-16);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

START_TEST(a_quadratic_invariant_is_conserved_to_roundoff)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator, "midpoint");
  double before, after;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &before), DVI_OK);
  advance(integrator, 0.7, 10000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &after), DVI_OK);
  /* 1e4 roundings that walk at random add up to 100 of them */
  ck_assert_double_eq_tol(after, before, 1e-14 * before * 100);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

static void check_same(const char *problem_name, const char *a, const char *b)
{
  problem *model = create_problem(problem_name, NULL);
  dvi_integrator *first = start_integrator(model, a), *second = start_integrator(model, b);
  advance(first, model->h, 50);
  advance(second, model->h, 50);
  ck_assert_double_eq(distance(model->nq, dvi_integrator_q(first), dvi_integrator_q(second)), 0);
  ck_assert_double_eq(distance(model->nq, dvi_integrator_p(first), dvi_integrator_p(second)), 0);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}

START_TEST(it_is_galerkin_of_degree_1_with_the_midpoint_bit_for_bit)
{
  check_same("henon-heiles", "midpoint", "galerkin:degree=1,quadrature=midpoint");
  check_same("double-pendulum", "midpoint", "galerkin:degree=1,quadrature=gauss,nodes=1");
}
END_TEST

SUITE(midpoint)
{
  tcase_add_test(tests, on_an_oscillator_a_step_is_the_cayley_transform);
  tcase_add_test(tests, a_quadratic_invariant_is_conserved_to_roundoff);
  tcase_add_test(tests, it_is_galerkin_of_degree_1_with_the_midpoint_bit_for_bit);
}
