/* labels: invariant */
/* Time transforms serve eccentric orbits over a thousand periods, and close encounters. */
#include <math.h>

#include "support/paced.h"
#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/suite.h"

static const double period = 6.2831853071795865;

/* ---- a thousand periods of eccentricity 0.99 ---- */

static int watch_energy(dvi_integrator *integrator, void *user)
{
  double invariants[8];
  if (dvi_integrator_invariants(integrator, invariants) != DVI_OK) return -1;
  dvi_drift_add(user, dvi_integrator_time(integrator), invariants[0]);
  return 0;
}

/* The energy oscillates along the orbit with the errors of the method. Its trend over the run must
 * be negligible beside that. */
static void check_no_drift(paced_create create, const char *method, double h, double bound)
{
  problem *kepler = create_problem("kepler", "e=0.99");
  dvi_integrator *integrator = start_paced_integrator(kepler, create, "distance", method);
  dvi_drift energy;
  dvi_drift_fit fit;
  dvi_drift_init(&energy);
  const dvi_run_options options = {
      .h = h, .t_end = 1000 * period, .observe = watch_energy, .user = &energy};
  ck_assert_msg(dvi_run(integrator, &options, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_drift_result(&energy, &fit);
  ck_assert_msg(fit.largest < bound, "%s: energy error %g", method, fit.largest);
  ck_assert_msg(fabs(fit.change) < 0.02 * fit.largest && fit.significance < 4,
                "%s: change %g of %g, significance %g", method, fit.change, fit.largest,
                fit.significance);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}

START_TEST(the_energy_of_a_transformed_run_does_not_drift)
{
  check_no_drift(create_transformed, "galerkin:degree=2", 0.2, 0.05);
  check_no_drift(create_transformed, "galerkin:degree=4", 0.4, 1e-7);
}
END_TEST

START_TEST(nor_does_that_of_a_controlled_run)
{
  check_no_drift(create_controlled, "verlet", 0.02, 0.05);
}
END_TEST

/* ---- fewer evaluations at equal error ---- */

/* The error after one period, and what it cost. */
static double error_of(const problem *kepler, dvi_integrator *integrator, double h, long *gradients)
{
  double q[2], p[2];
  dvi_counters counters;
  run_to(integrator, h, period);
  dvi_integrator_counters(integrator, &counters);
  *gradients = counters.gradients;
  ck_assert_int_eq(kepler->exact(kepler, period, q, p), 0);
  const double error = distance(2, dvi_integrator_q(integrator), q);
  dvi_integrator_destroy(&integrator);
  return error;
}

START_TEST(a_transformed_run_needs_a_tenth_of_the_evaluations_of_fixed_steps)
{
  static const struct {
    const char *method;
    double h, fixed;
  } at[] = {{"galerkin:degree=2", 0.05, 1e-4},
            {"galerkin:degree=4", 0.3, 1e-3},
            {"galerkin:degree=8", 0.8, 2e-3}};
  problem *kepler = create_problem("kepler", "e=0.99");
  long transformed, fixed;
  const double error = error_of(
      kepler, start_paced_integrator(kepler, create_transformed, "distance", at[_i].method),
      at[_i].h, &transformed);
  /* The fixed steps have the larger error and yet need ten times as much. */
  ck_assert_double_gt(error_of(kepler, start_integrator(kepler, at[_i].method),
                               period / ceil(period / at[_i].fixed), &fixed),
                      error);
  ck_assert_msg(fixed > 10 * transformed, "%s: %ld against %ld", at[_i].method, fixed, transformed);
  problem_destroy(&kepler);
}
END_TEST

/* ---- close encounters ---- */

/* A pair of bodies, and how close they came. */
typedef struct encounter {
  int a, b;
  double *closest, *at;
} encounter;

static double coordinate_of_path(const encounter *e, const double *x, int i)
{
  return x[2 * e->a + i] - x[2 * e->b + i];
}

/* The rate at which half the squared distance grows. */
static int leaves(double t, const double *q, const double *v, double *rate, void *user)
{
  const encounter *e = user;
  (void)t;
  *rate = coordinate_of_path(e, q, 0) * coordinate_of_path(e, v, 0) +
          coordinate_of_path(e, q, 1) * coordinate_of_path(e, v, 1);
  return 0;
}

static int nearest(double t, const double *q, const double *v, void *user)
{
  const encounter *e = user;
  const double apart = hypot(coordinate_of_path(e, q, 0), coordinate_of_path(e, q, 1));
  (void)v;
  if (apart < *e->closest) *e->closest = apart, *e->at = t;
  return 0;
}

/* The energy of the first body (mass 3) beside the others, which are far below it and close
 * together. */
static double energy_of_the_first(const double *q, const double *p)
{
  const double mass[3] = {3, 4, 5},
               d = hypot((4 * q[2] + 5 * q[4]) / 9 - q[0], (4 * q[3] + 5 * q[5]) / 9 - q[1]);
  const double speed = hypot(p[0] / mass[0] - (p[2] + p[4]) / 9,
                             p[1] / mass[0] - (p[3] + p[5]) / 9);
  return speed * speed / 2 - 12 / d;
}

/* Gives the distance of bodies 2 and 3, in quadruple precision. */
static double distance_by_the_judge(const problem *model, double t)
{
  double q[6], p[6];
  for (int i = 0; i < 6; i++) q[i] = model->q[i], p[i] = model->p[i];
  ck_assert_double_lt(quad_solve("pythagorean", 0, NULL, t, q, p), 1e-15);
  return hypot(q[2] - q[4], q[3] - q[5]);
}

START_TEST(burraus_three_bodies_meet_and_part_as_they_must)
{
  problem *model = create_problem("pythagorean", NULL);
  dvi_integrator *integrator = start_paced_integrator(
      model, create_transformed, "distance:bodies=3,dimension=2", "galerkin:degree=8");
  double closest = HUGE_VAL, at = 0, before[8], after[8];
  encounter pairs[] = {{0, 1, &closest, &at}, {0, 2, &closest, &at}, {1, 2, &closest, &at}};
  dvi_event events[3];
  for (int k = 0; k < 3; k++)
    events[k] = (dvi_event){
        .value = leaves, .direction = 1, .occurred = nearest, .user = &pairs[k]};
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  ck_assert_msg(
      dvi_run(integrator,
              &(dvi_run_options){.h = 0.1, .t_end = 63, .events = events, .event_count = 3},
              NULL) == DVI_OK,
      "%s", dvi_last_error());
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  const double *q = dvi_integrator_q(integrator);
  ck_assert_double_eq_tol(closest, 4.14e-4, 1e-6); /* docs/problems.md */
  ck_assert_double_eq_tol(at, 15.8299, 1e-4);
  /* At the least distance an error of the time counts by its square. This is the orbit's loss since
   * the start. */
  ck_assert_double_eq_tol(closest, distance_by_the_judge(model, at), 1e-10);
  ck_assert_double_eq_tol(after[0], before[0], 1e-11 * fabs(before[0]));
  /* Body 1 goes upwards for good, and 2 and 3 are a pair. */
  ck_assert_double_gt(energy_of_the_first(q, dvi_integrator_p(integrator)), 0);
  ck_assert_double_gt(q[1], 8);
  ck_assert_double_lt(hypot(q[2] - q[4], q[3] - q[5]), 1.5);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(transform_long)
{
  tcase_add_test(tests, the_energy_of_a_transformed_run_does_not_drift);
  tcase_add_test(tests, nor_does_that_of_a_controlled_run);
  tcase_add_loop_test(tests, a_transformed_run_needs_a_tenth_of_the_evaluations_of_fixed_steps, 0,
                      3);
  tcase_add_test(tests, burraus_three_bodies_meet_and_part_as_they_must);
}
