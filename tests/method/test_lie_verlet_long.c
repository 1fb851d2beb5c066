/* labels: invariant */
#include <check.h>
#include <math.h>

#include "support/factors.h"
#include "support/runs.h"
#include "support/suite.h"

/* Mean energy error over some steps. */
static double mean_energy(dvi_integrator *integrator, double first, double h, int steps)
{
  double sum = 0, value[2];
  for (int i = 0; i < steps; i++) {
    advance(integrator, h, 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    sum += value[0] - first;
  }
  return sum / steps;
}

/* A million steps of half a radian each. Roundings of one step are 1e-16 of the angle, and add up as a random walk: 1e3 times that. */
START_TEST(a_million_steps_stay_on_the_group_with_their_momentum)
{
  bodies body = pendulum_in_space();
  dvi_integrator *integrator = body_started(&body, "lie-verlet");
  const double h = .05;
  double first[2], last[2];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  const double early = mean_energy(integrator, first[0], h, 10000);
  advance(integrator, h, 980000);
  const double late = mean_energy(integrator, first[0], h, 10000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, last), DVI_OK);
  ck_assert_double_le(dvi_system_distance(body.system, dvi_integrator_q(integrator)), 1e-12);
  ck_assert_double_le(fabs(last[1] - first[1]), 1e-12);
  ck_assert_double_le(fabs(late - early), .05 * fabs(early)); /* means over 10000 of a chaotic motion's oscillation */
  dvi_integrator_destroy(&integrator);
  bodies_clear(&body);
}
END_TEST

/* The worst for rounding: the same rotation a million times. */
START_TEST(a_steady_rotation_stays_on_the_group)
{
  const double J[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, Omega[] = {.5, -.6, .7};
  bodies body = body_of(J, Omega);
  dvi_integrator *integrator = body_started(&body, "lie-verlet");
  advance(integrator, .1, 1000000);
  ck_assert_double_le(dvi_system_distance(body.system, dvi_integrator_q(integrator)), 1e-12);
  ck_assert_double_le(distance(3, dvi_integrator_p(integrator), Omega), 1e-15);
  dvi_integrator_destroy(&integrator);
  bodies_clear(&body);
}
END_TEST

/* Two directions with the mass matrix [2 1; 1 1] of a double pendulum, and their weights. */
static int weights_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 9.81 * (2 * q[2] + q[5]);
  return 0;
}

static int weights_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 6; i++) V_q[i] = i == 2 ? 2 * 9.81 : i == 5 ? 9.81 : 0;
  return 0;
}

START_TEST(coupled_directions_keep_their_length)
{
  const dvi_factor factors[] = {{.kind = DVI_S2}, {.kind = DVI_S2}};
  const dvi_potential potential = {.value = weights_value, .gradient = weights_gradient};
  double M[36] = {0};
  for (int i = 0; i < 3; i++) {
    M[6 * i + i] = 2;
    M[6 * (3 + i) + 3 + i] = M[6 * (3 + i) + i] = M[6 * i + 3 + i] = 1;
  }
  bodies pendula = {.q = {.866, 0, .5, 0, 0, 1}};
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.factors = factors,
                                                         .factor_count = 2,
                                                         .mass = {.values = M},
                                                         .potentials = &potential,
                                                         .potential_count = 1,
                                                         .autonomous = 1},
                                     &pendula.system),
                   DVI_OK);
  ck_assert_int_eq(dvi_system_project(pendula.system, pendula.q), DVI_OK);
  dvi_integrator *integrator = body_started(&pendula, "lie-verlet");
  double first, last;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  advance(integrator, .01, 1000000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &last), DVI_OK);
  ck_assert_double_le(dvi_system_distance(pendula.system, dvi_integrator_q(integrator)), 1e-14);
  ck_assert_double_le(fabs(last - first), .02 * fabs(first)); /* an oscillation of O(h^2) */
  dvi_integrator_destroy(&integrator);
  bodies_clear(&pendula);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("lie-verlet, long");
  tcase_add_test(tests, a_million_steps_stay_on_the_group_with_their_momentum);
  tcase_add_test(tests, a_steady_rotation_stays_on_the_group);
  tcase_add_test(tests, coupled_directions_keep_their_length);
  return run_tests("lie-verlet, long", tests);
}
