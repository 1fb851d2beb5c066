/* labels: unit invariant */
/* A ball that is held on the inside of a circle swings as a pendulum, and falls off it. */
#include <float.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/walls.h"

static dvi_integrator *throw_ball(const dvi_system *system, const double *q, const double *v)
{
  dvi_integrator *integrator = create_integrator(system, "galerkin:degree=3");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  return integrator;
}

/* Take steps until the ball is held, or until it is not. Return the last hit of that step. */
static dvi_hit step_until(dvi_integrator *integrator, double h, int held)
{
  for (int i = 0; i < 1000 && (dvi_integrator_held(integrator) >= 0) != held; i++)
    advance(integrator, h, 1);
  ck_assert_int_eq(dvi_integrator_held(integrator), held ? 0 : -1);
  return dvi_integrator_hit(integrator, dvi_integrator_hit_count(integrator) - 1);
}

/* The error of the energy, which is 1.3e-8 for degree 3, does not grow. */
START_TEST(a_ball_in_a_bowl_swings_on_after_its_hits)
{
  const double q[] = {.2, .1}, v[] = {1.5, 0};
  double first, energy, gap, worst = 0;
  dvi_system *system = create_holding_walls(WALLS_CIRCLE, 0.5);
  dvi_integrator *integrator = throw_ball(system, q, v);
  ck_assert_int_eq(step_until(integrator, 0.05, 1).kind, DVI_HOLD);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  for (int i = 0; i < repeats(4000); i++) {
    advance(integrator, 0.05, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
    ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
    worst = fmax(worst, fabs(energy - first));
    ck_assert_double_le(fabs(gap), 4 * DBL_EPSILON);
  }
  ck_assert_double_le(worst, 2e-8);
  ck_assert_int_eq(dvi_integrator_held(integrator), 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* At 4.9 the ball runs up beyond the middle, falls off where v^2 = g y, and is held again after its
 * hits. */
START_TEST(a_ball_that_falls_off_is_held_again)
{
  const double q[] = {0, -1}, v[] = {4.9, 0}, height = (4.9 * 4.9 / 9.81 - 2) / 3;
  double there[2], force;
  dvi_system *system = create_holding_walls(WALLS_CIRCLE, 0.5);
  dvi_integrator *integrator = throw_ball(system, q, v);
  (void)step_until(integrator, 0.01, 1);
  const dvi_hit release = step_until(integrator, 0.01, 0);
  ck_assert_int_eq(release.kind, DVI_RELEASE);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, release.t, there, NULL), DVI_OK);
  ck_assert_double_eq_tol(there[1], height, 1e-9);
  ck_assert_double_gt(step_until(integrator, 0.01, 1).t, release.t);
  ck_assert_int_eq(dvi_integrator_contact_force(integrator, 0, &force), DVI_OK);
  ck_assert_double_gt(force, 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(held_swings)
{
  tcase_add_test(tests, a_ball_in_a_bowl_swings_on_after_its_hits);
  tcase_add_test(tests, a_ball_that_falls_off_is_held_again);
}
