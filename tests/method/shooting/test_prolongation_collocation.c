/* labels: order invariant */
/* prolongation-collocation: its orders, conserved quantities, refusals and failures. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/heap.h"
#include "support/prepared.h"
#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

/* Gives the order of the quadrature, which has [m/2] terms of Euler and Maclaurin beside the
 * trapezoid. */
static int order_of(int m)
{
  return 2 * (m / 2) + 2;
}

/* The spans are short, because errors of order 4 come to roundoff after some hundred steps. */
static const struct {
  const char *problem, *setting;
  double length;
  int first;
} places[] = {{"kepler", "e=0.3", 1, 8},
              {"pendulum", NULL, 2, 4},
              {"double-pendulum", NULL, 0.5, 5},
              {"toda", "N=5", 1, 3}};
enum { PLACES = sizeof places / sizeof *places, LARGEST = 4 };

START_TEST(the_order_is_that_of_the_quadrature)
{
  const int place = _i % PLACES, m = _i / PLACES + 1;
  check_order_over(places[place].problem, places[place].setting, places[place].length,
                   places[place].first, method_spec("prolongation-collocation:derivatives=%d", m),
                   order_of(m));
}
END_TEST

START_TEST(it_goes_on_to_order_10)
{
  static const struct {
    int place, m;
  } some[] = {{0, 8}, {1, 8}, {1, 6}, {DOUBLE_PENDULUM, 6}};
  check_order(some[_i].place, method_spec("prolongation-collocation:derivatives=%d", some[_i].m),
              order_of(some[_i].m));
}
END_TEST

START_TEST(time_may_stand_in_the_lagrangian)
{
  check_order_over("driven-pendulum", NULL, 2.5, 12, "prolongation-collocation:derivatives=2", 4);
  check_order_over("driven-pendulum", NULL, 5, 25, "prolongation-collocation:derivatives=4", 6);
}
END_TEST

/* The line through the ends and the trapezoid give the same steps over 20 steps of an orbit that
 * amplifies roundings little. */
START_TEST(one_derivative_makes_it_verlet)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "prolongation-collocation:derivatives=1"),
                 *verlet = start_integrator(model, "verlet");
  advance(integrator, 0.05, 20);
  advance(verlet, 0.05, 20);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), dvi_integrator_q(verlet)), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(integrator), dvi_integrator_p(verlet)), 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&verlet);
  problem_destroy(&model);
}
END_TEST

/* Rotations act on the path as they do on its ends. Roundings of a step stray like the square root
 * of the steps, a trend of one epsilon a step by 100 times more. */
START_TEST(angular_momentum_of_kepler_stays_at_roundoff)
{
  const int steps = repeats(5000);
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *integrator = start_integrator(
      model, method_spec("prolongation-collocation:derivatives=%d", _i));
  double start[4], now[4], largest = 0;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  for (int step = 0; step < steps; step += 100) {
    advance(integrator, 0.1, 100);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    largest = fmax(largest, fabs(now[1] - start[1]));
  }
  ck_assert_double_le(largest, 3 * sqrt((double)steps) * DBL_EPSILON);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The error bounds are twice the measured errors. */
START_TEST(energy_does_not_drift)
{
  static const struct {
    int m;
    double bound;
  } run[] = {{1, 4e-3}, {2, 8e-6}, {3, 1e-5}, {4, 4e-8}};
  const int steps = repeats(10000);
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(
      model, method_spec("prolongation-collocation:derivatives=%d", run[_i].m));
  dvi_drift energy;
  dvi_drift_fit fit;
  double value[2];
  dvi_drift_init(&energy);
  for (int step = 0; step <= steps; step += 20) {
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    dvi_drift_add(&energy, dvi_integrator_time(integrator), value[0]);
    advance(integrator, 0.1, 20);
  }
  dvi_drift_result(&energy, &fit);
  ck_assert_msg(fit.largest <= run[_i].bound, "energy error %g", fit.largest);
  ck_assert_msg(fit.significance < 3 || fabs(fit.change) < 1e-3 * fit.largest,
                "change %g, significance %g", fit.change, fit.significance);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(no_step_takes_memory_but_to_prepare_a_solver)
{
  static const char *const names[] = {"pendulum", "kepler", "double-pendulum", "toda"};
  problem *model = create_problem(names[_i], _i == 3 ? "N=5" : NULL);
  dvi_integrator *integrator = start_integrator(model, "prolongation-collocation:derivatives=4");
  long calls = 0;
  for (int i = 0; i < 30; i++) {
    dvi_status status;
    calls += count_calls_of_step(integrator, i % 3 == 2 ? 0.018 : 0.02, &status);
    ck_assert_int_eq(status, DVI_OK);
  }
  ck_assert_int_eq(calls, 0);
  ck_assert_int_le(read_counters(integrator).preparations, PREPARATIONS_MOST);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_step_that_is_too_long_leaves_the_state)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "prolongation-collocation:derivatives=4");
  ck_assert_int_gt(dvi_integrator_step(integrator, 3), 0);
  check_words("prolongation-collocation: step 1 from t = 0 with h = 3 failed; the state is "
              "unchanged, try a smaller step");
  ck_assert_mem_eq(dvi_integrator_q(integrator), model->q, 2 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(integrator), model->p, 2 * sizeof(double));
  advance(integrator, 0.05, 10);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_term_without_taylor_coefficients_is_named)
{
  problem *model = create_problem(_i == 0 ? "kepler" : "double-pendulum", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_potential potential = {0};
  dvi_lagrangian lagrangian = {0};
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  if (_i == 0) {
    potential = terms.potentials[0];
    potential.taylor = NULL;
    terms.potentials = &potential;
  } else {
    lagrangian = *terms.lagrangian;
    lagrangian.taylor = NULL;
    terms.lagrangian = &lagrangian;
  }
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "prolongation-collocation", &integrator),
                   DVI_UNSUPPORTED);
  check_words(_i == 0 ? "prolongation-collocation: 'gravity' has no taylor callback"
                      : "prolongation-collocation: 'Lagrangian' has no taylor callback");
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(what_it_cannot_use_is_refused)
{
  dvi_integrator *integrator = NULL;
  problem *vortices = create_problem("vortices", NULL), *of = create_problem("pendulum", NULL),
          *large = create_problem("toda", "N=501");
  ck_assert_int_eq(dvi_integrator_create(vortices->system, "prolongation-collocation", &integrator),
                   DVI_UNSUPPORTED);
  check_words("the system declares a one-form");
  ck_assert_int_eq(
      dvi_integrator_create(of->system, "prolongation-collocation:derivatives=0", &integrator),
      DVI_BAD_OPTION);
  check_words("derivatives=0; 1 to 10 are possible");
  ck_assert_int_eq(
      dvi_integrator_create(of->system, "prolongation-collocation:derivatives=11", &integrator),
      DVI_BAD_OPTION);
  ck_assert_int_eq(dvi_integrator_create(large->system, "prolongation-collocation", &integrator),
                   DVI_UNSUPPORTED);
  check_words("501 coordinates, and its matrices are full: at most 500 are possible");
  problem_destroy(&large);
  problem_destroy(&vortices);
  problem_destroy(&of);
}
END_TEST

SUITE(prolongation_collocation)
{
  tcase_add_loop_test(tests, the_order_is_that_of_the_quadrature, 0, LARGEST * PLACES);
  tcase_add_loop_test(tests, it_goes_on_to_order_10, 0, 4);
  tcase_add_test(tests, time_may_stand_in_the_lagrangian);
  tcase_add_test(tests, one_derivative_makes_it_verlet);
  tcase_add_loop_test(tests, angular_momentum_of_kepler_stays_at_roundoff, 2, 5);
  tcase_add_loop_test(tests, energy_does_not_drift, 0, 4);
  tcase_add_loop_test(tests, no_step_takes_memory_but_to_prepare_a_solver, 0, 4);
  tcase_add_test(tests, a_step_that_is_too_long_leaves_the_state);
  tcase_add_loop_test(tests, a_term_without_taylor_coefficients_is_named, 0, 2);
  tcase_add_test(tests, what_it_cannot_use_is_refused);
}
