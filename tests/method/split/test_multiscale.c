/* labels: invariant */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

/* stiff-pendulum at k, with the path as oscillations of the spring's frequency in both coordinates,
 * and more keys. */
static const char *spring(double k, const char *keys)
{
  return method_spec("multiscale:fast=0:1,omega=%.17g%s", sqrt(k), keys);
}

/* ---- linear oscillators ---- */

START_TEST(a_linear_oscillator_is_exact_whatever_h_omega)
{
  static const double h[] = {1e-9, 1e-5, 1e-3, 0.01, 0.05, 0.19, 0.2, 0.21, 0.6, 1, 3.3, 20};
  problem *model = create_problem("oscillators", NULL);
  dvi_integrator *integrator = start_integrator(
      model, method_spec("multiscale:fast=0,amplitude=%d,omega=%.17g", _i / 12, sqrt(2501)));
  advance(integrator, h[_i % 12], 10);
  double q, p;
  ck_assert_int_eq(model->exact(model, dvi_integrator_time(integrator), &q, &p), 0);
  const double phase = sqrt(2501) * dvi_integrator_time(integrator), error = 1e-12 + 1e-15 * phase;
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q, error);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], p, 50 * error);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(between_its_steps_too)
{
  problem *model = create_problem("oscillators", NULL);
  dvi_integrator *integrator = start_integrator(
      model, method_spec("multiscale:fast=0,omega=%.17g", sqrt(2501)));
  advance(integrator, 0.7, 3);
  double q, p, path, v;
  for (int k = 1; k < 8; k++) {
    ck_assert_int_eq(model->exact(model, 1.4 + 0.7 * k / 8, &q, &p), 0);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 1.4 + 0.7 * k / 8, &path, &v), DVI_OK);
    ck_assert_double_eq_tol(path, q, 1e-12);
    ck_assert_double_eq_tol(v, p, 1e-10);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- far below the period it is galerkin ---- */

START_TEST(where_the_oscillation_is_a_polynomial_it_is_galerkin_with_as_many_nodes)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *multiscale = start_integrator(model, "multiscale:fast=0:1,omega=1e-7"),
                 *galerkin = start_integrator(model, "galerkin:degree=3,nodes=25");
  advance(multiscale, 0.1, 50);
  advance(galerkin, 0.1, 50);
  ck_assert_double_le(distance(2, dvi_integrator_q(multiscale), dvi_integrator_q(galerkin)), 1e-12);
  ck_assert_double_le(distance(2, dvi_integrator_p(multiscale), dvi_integrator_p(galerkin)), 1e-12);
  dvi_integrator_destroy(&multiscale);
  dvi_integrator_destroy(&galerkin);
  problem_destroy(&model);
}
END_TEST

/* ---- the pendulum on a stiff spring ---- */

/* galerkin:degree=8 with h omega = 1, which for k = 1e4 is 3e-12 from the runs of h omega = 0.5. */
static const struct stiffness {
  double k, theta;
} stiffnesses[] = {{1e2, 0.029870602158808268}, {1e3, -0.67372586093096465},
                   {1e4, -0.44519819285370654}, {1e5, -0.41672294313293817},
                   {1e6, -0.41315619234509354}, {1e7, -0.41295298776305340},
                   {1e8, -0.41296487524618558}};

/* At t = 10. */
static double error_of_theta(const struct stiffness *at, const char *keys, double h,
                             dvi_counters *counters)
{
  problem *model = create_problem("stiff-pendulum", method_spec("k=%.17g", at->k));
  dvi_integrator *integrator = start_integrator(model, spring(at->k, keys));
  advance(integrator, h, lround(10 / h));
  const double error = fabs(dvi_integrator_q(integrator)[1] - at->theta);
  dvi_integrator_counters(integrator, counters);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return error;
}

/* 25 points take 3 or 4 iterations for every k, and 5 where roundings of k a show. */
START_TEST(steps_of_a_tenth_have_four_digits_at_every_stiffness)
{
  dvi_counters counters;
  ck_assert_double_le(error_of_theta(&stiffnesses[_i], "", 0.1, &counters), 1.2e-4);
  ck_assert_int_le(counters.gradients, 2500 * 11 / 2);
  ck_assert_int_le(counters.hessians, 2500 * 7 / 2);
}
END_TEST

START_TEST(with_the_second_harmonic_they_have_nearly_six)
{
  dvi_counters counters;
  ck_assert_double_le(error_of_theta(&stiffnesses[_i], ",harmonics=2", 0.1, &counters), 2e-6);
}
END_TEST

START_TEST(steps_of_several_periods_have_an_error_below_one_in_ten_thousand)
{
  static const double h[] = {0.1, 0.125, 0.2};
  for (int k = 0; k < 3; k++) {
    dvi_counters counters;
    ck_assert_double_le(error_of_theta(&stiffnesses[2], "", h[k], &counters), 1e-4);
    ck_assert_int_le(counters.gradients, lround(10 / h[k] * 25 * 4.2));
  }
}
END_TEST

/* The neglected terms have the fourth power of the amplitude, so half the amplitude has a sixteenth
 * of the error. The second harmonic takes all but a hundredth of that. */
START_TEST(the_error_of_long_steps_is_the_second_harmonic)
{
  static const double theta[] = {-0.253079547133848, -0.41315619234509354, -0.45107746698721923},
                      a[] = {0.1, 0.05, 0.025};
  problem *model = create_problem("stiff-pendulum", "k=1e6");
  double error[2][3];
  for (int k = 0; k < 6; k++) {
    dvi_integrator *integrator = create_integrator(
        model->system, spring(1e6, method_spec(",degree=4,amplitude=2,harmonics=%d", 1 + k / 3)));
    const double q[] = {a[k % 3], 1}, p[] = {0, 0};
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    advance(integrator, 0.1, 100);
    error[k / 3][k % 3] = fabs(dvi_integrator_q(integrator)[1] - theta[k % 3]);
    dvi_integrator_destroy(&integrator);
  }
  for (int k = 0; k < 3; k++) ck_assert_double_le(error[1][k], 0.011 * error[0][k]);
  for (int k = 1; k < 3; k++) ck_assert_double_eq_tol(error[0][k - 1] / error[0][k], 16, 1.5);
  problem_destroy(&model);
}
END_TEST

START_TEST(no_length_of_steps_resonates)
{
  for (int steps = 50; steps <= 200; steps += 10) {
    dvi_counters counters;
    ck_assert_double_le(error_of_theta(&stiffnesses[2], "", 10.0 / steps, &counters), 3e-4);
  }
}
END_TEST

START_TEST(small_and_vanishing_amplitudes_are_starts_like_any_other)
{
  static const double a[] = {0, 1e-300, 1e-12, 1e-4};
  problem *model = create_problem("stiff-pendulum", NULL);
  dvi_integrator *integrator = create_integrator(model->system, spring(1e4, ""));
  for (int k = 0; k < 4; k++) {
    const double q[] = {a[k], 1}, p[] = {0, 0};
    double before, after;
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, &before), DVI_OK);
    advance(integrator, 0.1, 50);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, &after), DVI_OK);
    ck_assert_double_eq_tol(after, before, 1e-5);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(the_step_is_symplectic_and_reversible)
{
  static const double h[] = {0.01, 0.1, 0.2};
  problem *model = create_problem("stiff-pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, spring(1e4, _i ? ",harmonics=2" : ""));
  for (int k = 0; k < 3; k++) {
    double defect;
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, h[k], &defect), DVI_OK);
    ck_assert_double_le(defect, 1e-10);
    ck_assert_int_eq(dvi_reversibility(integrator, 0, model->q, model->p, h[k], 10, &defect),
                     DVI_OK);
    ck_assert_double_le(defect, 1e-10);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- what is fast ---- */

static void check_spelled(const char *name, const char *given, const char *spelled)
{
  problem *model = create_problem(name, NULL);
  dvi_integrator *integrator = create_integrator(model->system, given);
  ck_assert_str_eq(dvi_integrator_method(integrator), spelled);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

/* 3 slow coordinates of degree 3, 3 fast ones with 4 functions more. */
START_TEST(slow_coordinates_have_the_unknowns_of_their_polynomials)
{
  char text[1024];
  double defect;
  problem *model = create_problem("fpu", NULL);
  dvi_integrator *integrator = start_integrator(model, "multiscale");
  ck_assert_uint_lt(dvi_integrator_explain(integrator, text, sizeof text), sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "30 unknowns a step"));
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, 0.3, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-10);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(fast_potentials_tell_the_frequency)
{
  check_spelled("fpu", "multiscale", "multiscale:degree=3,amplitude=1,harmonics=1,omega=50");
  check_spelled("fpu", "multiscale:omega=auto,fast=3:4:5",
                "multiscale:degree=3,amplitude=1,harmonics=1,omega=50,fast=3:4:5");
}
END_TEST

/* ---- the frequency, found ---- */

/* Reads omega from the explanation. 0 means that there is none yet. */
static double found_omega(const dvi_integrator *integrator)
{
  char text[1024];
  ck_assert_uint_lt(dvi_integrator_explain(integrator, text, sizeof text), sizeof text);
  const char *line = strstr(text, "omega: ");
  ck_assert_ptr_nonnull(line);
  return strtod(line + strlen("omega: "), NULL);
}

/* At rest the energy is the spring's up to the weight's part, 70/k of its square. In motion the
 * swing adds at most 40/k to that. */
START_TEST(a_frequency_that_is_not_known_is_found_at_the_first_step)
{
  const struct stiffness *at = &stiffnesses[_i];
  problem *model = create_problem("stiff-pendulum", method_spec("k=%.17g", at->k));
  dvi_integrator *integrator = start_integrator(model, "multiscale:fast=0:1");
  dvi_counters created, counters;
  ck_assert_double_eq(found_omega(integrator), 0);
  advance(integrator, 0.1, 1);
  dvi_integrator_counters(integrator, &created);
  advance(integrator, 0.1, 99);
  ck_assert_double_eq_tol(found_omega(integrator), sqrt(at->k),
                          (1e-5 + 70 / at->k / at->k) * sqrt(at->k));
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], at->theta, 1.2e-4);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.allocations, created.allocations);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* A pendulum at an angle of 0.3 from its rest. Linear oscillations about that angle have cos 0.3
 * times the square of its small frequency, its own have 1 - 0.3^2/8. */
START_TEST(of_a_large_oscillation_it_is_that_at_its_start)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "multiscale:fast=0");
  const double down = 4 * atan(1), p = 0;
  double angle = down - 0.3, small;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &down, &p), DVI_OK);
  advance(integrator, 0.5, 1);
  small = found_omega(integrator);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &angle, &p), DVI_OK);
  advance(integrator, 0.5, 1);
  ck_assert_double_eq_tol(found_omega(integrator), sqrt(cos(0.3)) * small, 1e-5 * small);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(about_an_unstable_state_nothing_oscillates)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, "multiscale:fast=0");
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_BAD_STATE);
  check_words(
      "the state is unchanged: the fast coordinates do not oscillate about this state; give omega");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static void check_refused(const char *name, const char *method, const char *words)
{
  problem *model = create_problem(name, NULL);
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(model->system, method, &integrator), DVI_BAD_OPTION);
  check_words(words);
  problem_destroy(&model);
}

START_TEST(what_is_not_known_is_asked_for)
{
  check_refused(
      "stiff-pendulum", "multiscale",
      "no coordinate is known to be fast: list them, as fast=0:1, or declare a fast potential");
  check_refused("stiff-pendulum", "multiscale:omega=100", "no coordinate is known to be fast");
  check_refused("stiff-pendulum", "multiscale:fast=0,omega=0",
                "omega=0; a positive number is possible, or auto");
  check_refused("stiff-pendulum", "multiscale:fast=0:2,omega=1",
                "there is no coordinate 2; they are counted from 0 to 1");
  check_refused("stiff-pendulum", "multiscale:fast=1:0:1,omega=1", "coordinate 1 is listed twice");
  check_refused("stiff-pendulum", "multiscale:fast=0.5,omega=1", "there is no coordinate 0.5");
  check_refused("stiff-pendulum", "multiscale:fast=0,omega=1,amplitude=4",
                "amplitude=4 is above degree=3; 0 to degree are possible");
}
END_TEST

static int two_springs(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 50 * q[0] * q[0] + 200 * q[1] * q[1];
  return 0;
}

START_TEST(of_two_fast_frequencies_one_must_be_chosen)
{
  const dvi_potential potential = {
      .name = "springs", .value = two_springs, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(system, "multiscale", &integrator), DVI_BAD_OPTION);
  check_words(
      "the fast potentials have frequencies from 10 to 20; give the one that matters as omega");
  integrator = create_integrator(system, "multiscale:omega=20");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

enum { STEEP = 17 };

static int steep(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i < STEEP; i++) *V += cosh(10 * q[i]);
  return 0;
}

START_TEST(of_many_fast_coordinates_it_is_asked_for)
{
  const dvi_potential potential = {.name = "steep", .value = steep, .fast = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = STEEP, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(system, "multiscale", &integrator), DVI_BAD_OPTION);
  check_words("of 17 fast coordinates the frequency is not found, of up to 16 it is: give omega");
  dvi_system_destroy(&system);
}
END_TEST

SUITE(multiscale)
{
  tcase_add_loop_test(tests, a_linear_oscillator_is_exact_whatever_h_omega, 0, 36);
  tcase_add_test(tests, between_its_steps_too);
  tcase_add_test(tests, where_the_oscillation_is_a_polynomial_it_is_galerkin_with_as_many_nodes);
  tcase_add_loop_test(tests, steps_of_a_tenth_have_four_digits_at_every_stiffness, 0, 7);
  tcase_add_loop_test(tests, with_the_second_harmonic_they_have_nearly_six, 0, 7);
  tcase_add_test(tests, the_error_of_long_steps_is_the_second_harmonic);
  tcase_add_test(tests, steps_of_several_periods_have_an_error_below_one_in_ten_thousand);
  tcase_add_test(tests, no_length_of_steps_resonates);
  tcase_add_test(tests, small_and_vanishing_amplitudes_are_starts_like_any_other);
  tcase_add_loop_test(tests, the_step_is_symplectic_and_reversible, 0, 2);
  tcase_add_test(tests, slow_coordinates_have_the_unknowns_of_their_polynomials);
  tcase_add_test(tests, fast_potentials_tell_the_frequency);
  tcase_add_loop_test(tests, a_frequency_that_is_not_known_is_found_at_the_first_step, 0, 7);
  tcase_add_test(tests, of_a_large_oscillation_it_is_that_at_its_start);
  tcase_add_test(tests, about_an_unstable_state_nothing_oscillates);
  tcase_add_test(tests, what_is_not_known_is_asked_for);
  tcase_add_test(tests, of_two_fast_frequencies_one_must_be_chosen);
  tcase_add_test(tests, of_many_fast_coordinates_it_is_asked_for);
}
