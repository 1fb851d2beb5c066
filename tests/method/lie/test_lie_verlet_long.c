/* labels: invariant slow long */
#include <check.h>
#include <math.h>

#include "support/systems/mixed_factors.h"
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

/* A million steps of half a radian each. Roundings of one step are 1e-16 of the angle, and add up
 * as a random walk to 1e3 times that. */
START_TEST(a_million_steps_stay_on_the_group_with_their_momentum)
{
  body pendulum;
  make_body(PENDULUM_3D, &pendulum);
  dvi_integrator *integrator = body_integrator(&pendulum, "lie-verlet");
  const double h = .05;
  double first[2], last[2];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  const double early = mean_energy(integrator, first[0], h, 10000);
  advance(integrator, h, repeats(980000));
  const double late = mean_energy(integrator, first[0], h, 10000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, last), DVI_OK);
  ck_assert_double_le(dvi_system_distance(pendulum.system, dvi_integrator_q(integrator)), 1e-12);
  ck_assert_double_le(fabs(last[1] - first[1]), 1e-12);
  /* means over 10000 of a chaotic motion's oscillation */
  ck_assert_double_le(fabs(late - early), .05 * fabs(early));
  dvi_integrator_destroy(&integrator);
  destroy_body(&pendulum);
}
END_TEST

START_TEST(coupled_directions_keep_their_length)
{
  body pendula;
  make_body(DIRECTIONS, &pendula);
  dvi_integrator *integrator = body_integrator(&pendula, "lie-verlet");
  double first[2], last[2];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  advance(integrator, .002, repeats(1000000));
  ck_assert_int_eq(dvi_integrator_invariants(integrator, last), DVI_OK);
  ck_assert_double_le(dvi_system_distance(pendula.system, dvi_integrator_q(integrator)), 1e-14);
  /* an oscillation of O(h^2) */
  ck_assert_double_le(fabs(last[0] - first[0]), 1e-3 * fabs(first[0]));
  ck_assert_double_le(fabs(last[1] - first[1]),
                      /* in units of what is added up */
                      1e-12 * magnitude(6, dvi_integrator_p(integrator)));
  dvi_integrator_destroy(&integrator);
  destroy_body(&pendula);
}
END_TEST

SUITE(lie_verlet_long)
{
  tcase_add_test(tests, a_million_steps_stay_on_the_group_with_their_momentum);
  tcase_add_test(tests, coupled_directions_keep_their_length);
}
