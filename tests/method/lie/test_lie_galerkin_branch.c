/* labels: invariant */
/* Long steps of thin bodies, whose equations have several solutions. The step takes the branch
 * connected to h = 0, which is the motion's, or it is refused. */
#include <dvi/integrator.h>
#include <math.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"

static const double unit[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static dvi_system *free_rod(const double *J)
{
  const double inertia[] = {J[0], 0, 0, 0, J[1], 0, 0, 0, J[2]};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  dvi_system *system;
  ck_assert_msg(
      dvi_system_create(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1},
                        &system) == DVI_OK,
      "%s", dvi_last_error());
  return system;
}

/* ---- single steps against lie-verlet's small ones ---- */

static const struct {
  double J[3], v[3], from, to;
  int count;
  const char *method;
} rods[] = {
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "lie-galerkin:degree=3"},
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "lie-galerkin:degree=4"},
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "lie-galerkin:degree=4,solver=newton"},
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "lie-galerkin:degree=4,solver=certified"},
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "lie-galerkin:degree=5"},
    {{.00766734, 1.0076, 1.00007},
     {.040484, .964601, .260588},
     1.4,
     1.9,
     1001,
     "euler-poincare:degree=4"},
    {{.00223197, 1.00212, 1.00011},
     {.100981, .715101, .691689},
     .92,
     .926,
     13,
     "lie-galerkin:degree=3"},
};

/* Wrong ones err by 0.3 and more. */
START_TEST(steps_of_rods_find_the_motion)
{
  dvi_system *system = free_rod(rods[_i].J);
  dvi_integrator *made = create_integrator(system, rods[_i].method),
                 *fine = create_integrator(system, "lie-verlet");
  const double spacing = (rods[_i].to - rods[_i].from) / (rods[_i].count - 1);
  ck_assert_int_eq(dvi_integrator_start_velocity(fine, 0, unit, rods[_i].v), DVI_OK);
  advance(fine, rods[_i].from / 4000, 4000);
  for (int k = 0; k < rods[_i].count; k++) {
    ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, unit, rods[_i].v), DVI_OK);
    advance(made, rods[_i].from + k * spacing, 1);
    const double error = distance(9, dvi_integrator_q(made), dvi_integrator_q(fine));
    ck_assert_msg(error < .08, "h = %g: R errs by %.2g", rods[_i].from + k * spacing, error);
    advance(fine, spacing / 4, 4);
  }
  dvi_integrator_destroy(&made);
  dvi_integrator_destroy(&fine);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- runs ---- */

static const struct {
  double thin, h;
  long steps;
  const char *method;
} runs[] = {
    {.01, 1.5, 3000, "lie-galerkin:degree=3"},   {.001, .8, 3000, "lie-galerkin:degree=3"},
    {.003, 1, 3000, "lie-galerkin:degree=3"},    {.001, .5, 11000, "lie-galerkin:degree=2"},
    {1e-5, .1, 3000, "lie-galerkin:degree=3"},   {1e-9, .1, 1000, "lie-galerkin:degree=4"},
    {.01, 1.5, 3000, "euler-poincare:degree=3"}, {1e-4, .3, 3000, "euler-poincare:degree=2"}};

/* A step to another solution would change the energy by a thousandth. No step is refused. */
START_TEST(runs_of_rods_stay_with_the_motion)
{
  const double J[] = {runs[_i].thin, 1 + runs[_i].thin / 2, 1 + .3 * runs[_i].thin},
               v[] = {.4, .8, .447};
  double start, before, after;
  dvi_system *system = free_rod(J);
  dvi_integrator *made = create_integrator(system, runs[_i].method);
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, unit, v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(made, &start), DVI_OK);
  before = start;
  for (long k = 0; k < repeats((int)runs[_i].steps); k++) {
    advance(made, runs[_i].h, 1);
    ck_assert_int_eq(dvi_integrator_invariants(made, &after), DVI_OK);
    ck_assert_msg(fabs(after - before) < 3e-4 * start, "step %ld: energy from %.6f to %.6f", k + 1,
                  before, after);
    before = after;
  }
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* With forces the energy alone would not show the branch. */
START_TEST(steps_with_forces_find_the_motion)
{
  static const char *const methods[] = {"lie-galerkin:degree=1", "lie-galerkin:degree=2",
                                        "lie-galerkin:degree=3",
                                        "lie-galerkin:degree=3,solver=kinsol"};
  body model;
  make_body(PENDULUM_3D, &model);
  dvi_integrator *made = body_integrator(&model, methods[_i]),
                 *fine = body_integrator(&model, "lie-verlet");
  double worst = 0;
  for (int k = 1; k <= 100; k++) {
    ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, model.q, model.v), DVI_OK);
    advance(fine, 1e-5, 100);
    advance(made, 1e-3 * k, 1);
    worst = fmax(worst, distance(model.nq, dvi_integrator_q(made), dvi_integrator_q(fine)));
  }
  ck_assert_msg(worst < .3, "%.2g", worst);
  dvi_integrator_destroy(&made);
  dvi_integrator_destroy(&fine);
  destroy_body(&model);
}
END_TEST

/* ---- steps that cannot be taken ---- */

/* The path of such a body ends at a fold where it turns by less than 1.9. The next solution is
 * near, and errs by a third. */
START_TEST(steps_beyond_a_fold_are_refused)
{
  const double J[] = {1.6045548e-06, 1.0000007, 1.0000009}, v[] = {.574447, -.698831, -.4262};
  dvi_system *system = free_rod(J);
  dvi_integrator *made = create_integrator(
      system, _i == 0 ? "lie-galerkin:degree=5" : "euler-poincare:degree=5,solver=newton");
  for (int k = 0; k <= 100; k++) {
    ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, unit, v), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(made, 1.9 + .002 * k), DVI_STEP_TOO_LARGE);
    check_words("continues those of shorter steps up to h = 1.");
  }
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* The sentence has the path's angle, not that of an iterate that runs away, and no number is
 * nan. */
START_TEST(refusals_tell_how_far_a_step_may_go)
{
  static const struct {
    double h;
    const char *words;
  } places[] = {{9, "up to h = 4."},
                {9, "where it turns by 3."},
                {1e300, "not even that of h = 2.44e+296 has a path"}};
  body model;
  make_body(FREE_BODY, &model);
  dvi_integrator *made = body_integrator(&model, "lie-galerkin:degree=3");
  ck_assert_int_eq(dvi_integrator_step(made, places[_i].h), DVI_STEP_TOO_LARGE);
  check_words(places[_i].words);
  ck_assert_mem_eq(dvi_integrator_q(made), model.q, (size_t)model.nq * sizeof(double));
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

/* Steps below half a radian are near their guess. */
START_TEST(usual_steps_are_not_followed)
{
  const double J[][3] = {{.01, 1.005, 1.003}, {1.1, .8, .9}, {.01, 1.005, 1.003}},
               v[] = {.4, .8, .447};
  dvi_counters counters;
  dvi_system *system = free_rod(J[_i]);
  dvi_integrator *made = create_integrator(system, "lie-galerkin:degree=3");
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, unit, v), DVI_OK);
  advance(made, _i == 2 ? -.4 : .4, 2000);
  dvi_integrator_counters(made, &counters);
  /* the first one, whose guess is a straight line */
  ck_assert_msg(counters.followed <= 1, "%ld", (long)counters.followed);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* Fixed-point iteration has no determinant whose sign could tell that a solution is another one.
 * That of an odd number of unknowns changes its sign with h. */
START_TEST(iteration_backwards_follows_no_branch)
{
  static const double J[] = {1, 2, 2.5}, v[] = {.3, .2, -.4};
  dvi_system *system = free_rod(J);
  dvi_integrator *integrator = create_integrator(system,
                                                 "lie-galerkin:degree=3,solver=fixed-point");
  dvi_counters counters;
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, unit, v), DVI_OK);
  for (int i = 0; i < 8; i++) ck_assert_int_eq(dvi_integrator_step(integrator, -.05), DVI_OK);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.fixed_points, 8);
  ck_assert_int_eq(counters.followed, 0);
  ck_assert_int_eq(counters.jacobians, 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(lie_galerkin_branch)
{
  tcase_add_loop_test(tests, steps_of_rods_find_the_motion, 0, sizeof rods / sizeof *rods);
  tcase_add_loop_test(tests, runs_of_rods_stay_with_the_motion, 0, sizeof runs / sizeof *runs);
  tcase_add_loop_test(tests, steps_with_forces_find_the_motion, 0, 4);
  tcase_add_loop_test(tests, steps_beyond_a_fold_are_refused, 0, 2);
  tcase_add_loop_test(tests, refusals_tell_how_far_a_step_may_go, 0, 3);
  tcase_add_loop_test(tests, usual_steps_are_not_followed, 0, 3);
  tcase_add_test(tests, iteration_backwards_follows_no_branch);
}
