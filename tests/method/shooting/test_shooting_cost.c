/* labels: invariant */
/* The cost of a step of shooting in evaluations: as many shots with their second derivatives as
 * residuals, and no more. */
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 200 };

/* Points of a shot at which the motion is evaluated: stages, and nodes that no stage stands for.
 * Residuals and Jacobians a step, measured and rounded up: heun changes the energy so much, near
 * pericentres and turning points, that some of its steps are followed. */
static const struct {
  const char *method;
  int points;
  double residuals, jacobians;
} shots[] = {{"shooting:onestep=heun,quadrature=trapezoid", 2 + 1, 9.5, 1.5},
             {"shooting", 2 * 4 + 1, 2.5, 1.02},
             {"shooting:onestep=butcher6,quadrature=lobatto", 3 * 7 + 1, 2.2, 1.02},
             {"shooting:onestep=cooper-verner,quadrature=lobatto", 4 * 11 + 1, 2.2, 1.02}};
enum { SHOTS = sizeof shots / sizeof *shots };

static const struct {
  const char *name, *setting;
  double h;
} places[] = {{"pendulum", NULL, 0.1}, {"kepler", "e=0.3", 0.05}, {"henon-heiles", NULL, 0.1}};
enum { PLACES = sizeof places / sizeof *places };

/* Counts over so many steps after a first one, which starts the integrator, too. */
static dvi_counters counted(int place, const char *method)
{
  problem *model = create_problem(places[place].name, places[place].setting);
  dvi_integrator *integrator = start_integrator(model, method);
  dvi_counters first, n;
  advance(integrator, places[place].h, 1);
  dvi_integrator_counters(integrator, &first);
  advance(integrator, places[place].h, STEPS);
  dvi_integrator_counters(integrator, &n);
  n.gradients -= first.gradients;
  n.hessians -= first.hessians;
  n.residuals -= first.residuals;
  n.jacobians -= first.jacobians;
  n.followed -= first.followed;
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return n;
}

/* One Jacobian a step, but for a few that converge slowly. The shot from the inverse Legendre map
 * is that of the first residual and of the Jacobian, and none closes the step. */
START_TEST(a_step_is_as_many_shots_as_residuals)
{
  for (int place = 0; place < PLACES; place++) {
    const dvi_counters n = counted(place, shots[_i].method);
    ck_assert_double_le((double)n.jacobians, shots[_i].jacobians * STEPS);
    /* A step that is followed is placed at each of its parts, which takes a shot. For one that is
     * doubted the forces at both ends are evaluated. */
    const long fired = n.residuals + 6 * n.followed;
    ck_assert_int_le(n.gradients, shots[_i].points * fired + n.gradients / 20);
    ck_assert_int_le(n.hessians, shots[_i].points * fired);
    ck_assert_msg((double)n.residuals <= shots[_i].residuals * STEPS, "%s %s: %ld residuals",
                  places[place].name, shots[_i].method, n.residuals);
  }
}
END_TEST

/* All stages are evaluated at once. A fixed-point iteration makes the guess, points serve the
 * Jacobian and the residual there, and one residual closes the step. */
START_TEST(all_stages_are_evaluated_once_a_point)
{
  enum { STAGES = 2 * 4, POINTS = STAGES + 3 };
  for (int place = 0; place < PLACES; place++) {
    const dvi_counters n = counted(place, "shooting:solve=stages");
    ck_assert_int_le(n.hessians, POINTS * (n.residuals + STEPS));
    /* of two steps' motion */
    ck_assert_int_le(n.gradients, POINTS * (n.residuals + STEPS) + STAGES * STEPS + 4);
  }
}
END_TEST

SUITE(shooting_cost)
{
  tcase_add_loop_test(tests, a_step_is_as_many_shots_as_residuals, 0, SHOTS);
  tcase_add_test(tests, all_stages_are_evaluated_once_a_point);
}
