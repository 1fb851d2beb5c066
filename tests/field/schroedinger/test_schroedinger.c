/* labels: unit slow */
/* Methods in time for Schroedinger's equation: phases, orders, norms, and solitons. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/function_spaces.h"
#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- phases ---- */

/* a exp(i (k x - omega t)), parameters a, k, omega t. */
static double complex plane_wave(double x, const double *parameter)
{
  return parameter[0] * turned_by(parameter[1] * x - parameter[2]);
}

/* Follow a plane wave with a = 0.7, k = 2 for 40 steps. */
static double error_of_plane_wave(const char *method, double interaction, double step,
                                  double phase_of_step)
{
  quantum q = quantum_on_line("fourier:modes=8", 0, 2 * pi, 1, NULL, interaction);
  dvi_march *march = quantum_march(&q, method, step);
  double wave[] = {0.7, 2, 0};
  start_wave(march, &q, plane_wave, wave);
  advance_march(march, 40 * step);
  wave[2] = 40 * phase_of_step;
  const double error = distance_from(march, &q, plane_wave, wave);
  dvi_march_destroy(&march);
  free_quantum(&q);
  return error;
}

/* theta = omega dt/2 solves (2/dt) tan theta = k^2/2 + beta a^2 cos^2 theta. */
static double half_phase_of_midpoint(double beta, double step)
{
  double least = 0, most = 0.5 * pi;
  for (int i = 0; i < 100; i++) {
    const double theta = 0.5 * (least + most), c = cos(theta);
    *(tan(theta) < 0.5 * step * (2 + beta * 0.49 * c * c) ? &least : &most) = theta;
  }
  return 0.5 * (least + most);
}

/* The 15 digits of omega alone would leave 9e-15 after 40 steps. Steps leave 1.3e-15 in all. */
START_TEST(midpoint_turns_a_plane_wave_by_its_own_frequency)
{
  const double theta = half_phase_of_midpoint(1.5, 0.05);
  ck_assert(fabs(2 * theta / 0.05 - 2.72735385249666) < 5e-15);
  ck_assert(error_of_plane_wave("midpoint", 1.5, 0.05, 2 * theta) < 1e-14);
}
END_TEST

/* beta a^2 dt is 0.7, 5, 98 and 245. Interactions beyond 1 let the iteration diverge, and Newton's
 * method finds the steps, whose phases are as exact. */
START_TEST(steps_beyond_the_iteration_are_those_of_the_midpoint_rule)
{
  static const double beta[] = {1.5, 100, 1000, 10}, step[] = {1, 0.1, 0.2, 50};
  const double theta = half_phase_of_midpoint(beta[_i], step[_i]);
  ck_assert_double_lt(error_of_plane_wave("midpoint", beta[_i], step[_i], 2 * theta), 3e-13);
}
END_TEST

/* As the exact frequency, k^2/2 + beta a^2. */
START_TEST(split_turns_a_plane_wave_exactly)
{
  quantum q = quantum_on_line("fourier:modes=8,points=17", 0, 2 * pi, 1, NULL, 1.5);
  dvi_march *march = quantum_march(&q, "split", 0.05);
  double wave[] = {0.7, 2, 0};
  start_wave(march, &q, plane_wave, wave);
  advance_march(march, 2);
  wave[2] = 2 * (2 + 1.5 * 0.49);
  ck_assert(distance_from(march, &q, plane_wave, wave) < 1e-14);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* A mode with E = k^2/2 = 2 turns by 2 atan(z/2), and by 2 atan((z/2)/(1 - z^2/12)), z = E dt. */
START_TEST(gauss_turns_modes_by_diagonal_pade_approximants)
{
  const double z = 2 * 0.05;
  ck_assert(error_of_plane_wave("midpoint", 0, 0.05, 2 * atan(z / 2)) < 1e-14);
  ck_assert(error_of_plane_wave("gauss:stages=1", 0, 0.05, 2 * atan(z / 2)) < 1e-14);
  const double both = 2 * atan(z / 2 / (1 - z * z / 12));
  ck_assert(error_of_plane_wave("gauss:stages=2", 0, 0.05, both) < 1e-14);
  ck_assert(error_of_plane_wave("gauss:stages=8", 0, 0.05, z) < 1e-14);
}
END_TEST

/* ---- orders ---- */

static double error_of_packet(const char *kind, int periodic, const char *method, double step)
{
  quantum q = quantum_on_line(kind, -9, 9, periodic, harmonic, 0);
  dvi_march *march = quantum_march(&q, method, step);
  const double start[] = {1, 0.5}, end[] = {1, 0.5, 1.6};
  start_wave(march, &q, packet, start);
  advance_march(march, 1.6);
  const double error = distance_from(march, &q, moved_packet, end);
  dvi_march_destroy(&march);
  free_quantum(&q);
  return error;
}

/* Four steps, each half of the one before. Errors above 1e-11 are those of the steps. */
static void check_order(const char *kind, int periodic, const char *method, double step, int order)
{
  double before = error_of_packet(kind, periodic, method, step);
  for (int i = 1; i < 4; i++) {
    const double error = error_of_packet(kind, periodic, method, step / (1 << i));
    ck_assert_msg(fabs(log2(before / error) - order) < 0.2, "%s on %s: %g, %g at step %g", method,
                  kind, before, error, step / (1 << i));
    before = error;
  }
}

static const char fourier[] = "fourier:modes=40,points=81";

START_TEST(orders_are_those_that_the_methods_claim)
{
  check_order(fourier, 1, "midpoint", 0.1, 2);
  check_order(fourier, 1, "gauss:stages=2", 0.1, 4);
  check_order(fourier, 1, "gauss:stages=3", 0.1, 6);
  check_order(fourier, 1, "split", 0.1, 2);
  check_order(fourier, 1, "split:order=4", 0.1, 4);
  check_order(fourier, 1, "split:order=6", 0.1, 6);
  check_order("fem:degree=8,cells=24", 0, "midpoint", 0.1, 2);
  check_order("fem:degree=8,cells=24", 0, "gauss:stages=2", 0.1, 4);
  check_order("spline:degree=8,cells=150", 0, "gauss:stages=2", 0.1, 4);
}
END_TEST

/* Cayley's kinetic step needs steps that resolve the kinetic energies of the packet. */
START_TEST(split_on_lumped_elements_has_the_same_orders)
{
  check_order("fem:degree=8,cells=24,lumped=yes", 0, "split", 0.05, 2);
  check_order("fem:degree=8,cells=24,lumped=yes", 0, "split:order=4", 0.025, 4);
}
END_TEST

/* ---- the norm ---- */

static int strongly_pulled(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = 0.5 * x[i] * x[i] - 1000 * sin(2 * t) * x[i];
  return 0;
}

static double norm_drift(const char *kind, int periodic, double interaction, const char *method,
                         int steps)
{
  quantum q = quantum_on_line(kind, -8, 8, periodic, harmonic, interaction);
  dvi_march *march = quantum_march(&q, method, 0.05);
  const double start[] = {1, 0};
  double worst = 0;
  start_wave(march, &q, packet, start);
  const double norm = observe_march(march, "norm");
  for (int i = 1; i <= 10; i++) {
    advance_march(march, 0.05 * steps / 10 * i);
    worst = fmax(worst, fabs(observe_march(march, "norm") / norm - 1));
  }
  dvi_march_destroy(&march);
  free_quantum(&q);
  return worst;
}

/* Roundings that do not add up in one direction make 1e-16 sqrt(1e4). Millions of steps are in the
 * suite schroedinger_long. */
START_TEST(norm_stays_for_ten_thousand_steps)
{
  const int steps = repeats(10000);
  ck_assert(norm_drift("fem:degree=6,cells=20", 0, 0, "midpoint", steps) < 5e-14);
  ck_assert(norm_drift("fem:degree=6,cells=20,lumped=yes", 0, 0, "split", steps) < 5e-14);
  ck_assert(norm_drift("fourier:modes=30,points=61", 1, 0, "split", steps) < 5e-14);
  ck_assert(norm_drift("fourier:modes=30", 1, 0, "midpoint", steps / 5) < 5e-14);
}
END_TEST

/* Cosines and sines of one mode are rounded alike in each step, by up to 1e-16. */
START_TEST(roundings_of_phases_do_not_add_up)
{
  for (int k = 1; k <= 8; k++) {
    const double wave[] = {1, k, 0};
    quantum q = quantum_on_line("fourier:modes=8,points=17", 0, 2 * pi, 1, NULL, 0);
    dvi_march *march = quantum_march(&q, "split", 0.05);
    start_wave(march, &q, plane_wave, wave);
    const double norm = observe_march(march, "norm");
    advance_march(march, 0.05 * repeats(20000));
    ck_assert(fabs(observe_march(march, "norm") / norm - 1) < 5e-14);
    dvi_march_destroy(&march);
    free_quantum(&q);
  }
}
END_TEST

START_TEST(norm_stays_with_an_interaction)
{
  const int steps = repeats(500);
  ck_assert(norm_drift("fem:degree=6,cells=20", 0, 2, "midpoint", steps) < 2e-14);
  ck_assert(norm_drift("fem:degree=6,cells=20", 0, 2, "gauss:stages=3", steps) < 2e-14);
  ck_assert(norm_drift("fourier:modes=30", 1, 2, "gauss:stages=2", steps) < 2e-14);
  ck_assert(norm_drift("fem:degree=6,cells=20,lumped=yes", 0, 2, "split:order=4", steps) < 2e-14);
}
END_TEST

/* Coefficients that are rounded would change the norm by 2e-17 in each of these long steps. */
START_TEST(roundings_of_coefficients_do_not_add_up)
{
  const double start[] = {1, 0};
  quantum q = quantum_on_line("fem:degree=6,cells=10", -8, 8, 0, harmonic, 0);
  dvi_march *march = quantum_march(&q, _i == 0 ? "gauss:stages=2" : "gauss:stages=4", 0.3);
  start_wave(march, &q, packet, start);
  const double norm = observe_march(march, "norm");
  advance_march(march, 0.3 * repeats(20000));
  ck_assert_double_lt(fabs(observe_march(march, "norm") / norm - 1), 1e-13);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* On fourier h range(V)/2 is 5, 16, and 800 with a spring that is pulled. */
START_TEST(norm_stays_in_steps_beyond_the_iteration)
{
  static const char *const method[] = {"midpoint", "gauss:stages=2", "midpoint"};
  static const double step[] = {0.3, 1, 0.2};
  const dvi_schroedinger_terms terms = {.potential = strongly_pulled, .depends_on_time = 1};
  const double start[] = {1, 0};
  quantum q = _i < 2 ? quantum_on_line("fourier:modes=16", -8, 8, 1, harmonic, 3)
                     : quantum_with(space_on_line("fourier:modes=16", -8, 8, 1), &terms);
  dvi_march *march = quantum_march(&q, method[_i], step[_i]);
  start_wave(march, &q, packet, start);
  const double norm = observe_march(march, "norm");
  advance_march(march, 100 * step[_i]);
  ck_assert_double_lt(fabs(observe_march(march, "norm") / norm - 1), 1e-14);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* A state of energy E turns by 2 atan(E h/2) even in steps of 50. */
START_TEST(states_turn_by_cayley_phases_in_long_steps)
{
  quantum q = quantum_on_line("fourier:modes=30", -8, 8, 1, harmonic, 0);
  double energy[2], *psi = calloc(4 * (size_t)q.functions, sizeof *psi), *state = psi + q.functions;
  ck_assert(dvi_schroedinger_modes(q.equation, 2, energy, psi) == DVI_OK);
  memset(state + q.functions, 0, (size_t)q.functions * sizeof *psi);
  dvi_march *march = quantum_march(&q, "midpoint", 50);
  const dvi_march_state start = {.size = sizeof start, .A = state};
  ck_assert(dvi_march_start(march, &start) == DVI_OK);
  advance_march(march, 100);
  const double turn = 4 * atan(25 * energy[1]);
  double *now = sample_march(march, DVI_FORM_A);
  for (int64_t i = 0; i < q.functions; i++) {
    ck_assert(fabs(now[i] - cos(turn) * state[i]) < 1e-12);
    ck_assert(fabs(now[q.functions + i] + sin(turn) * state[i]) < 1e-12);
  }
  free(now);
  free(psi);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* H commutes with a function of itself. */
START_TEST(gauss_keeps_the_energy_of_linear_equations)
{
  quantum q = quantum_on_line("spline:degree=4,cells=60", -8, 8, 0, harmonic, 0);
  dvi_march *march = quantum_march(&q, "gauss:stages=2", 0.3);
  const double start[] = {1, 0.7};
  start_wave(march, &q, packet, start);
  const double energy = observe_march(march, "energy");
  advance_march(march, 60);
  ck_assert(fabs(observe_march(march, "energy") - energy) < 1e-13);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* ---- two solitons ---- */

/* Satsuma and Yajima 1974: 2 sech x splits and comes together, with a peak of 4 at pi/4. */
static double complex two_solitons(double x, const double *parameter)
{
  const double t = parameter[0];
  return 4 * turned_by(0.5 * t) * (cosh(3 * x) + 3 * turned_by(4 * t) * cosh(x)) /
         (cosh(4 * x) + 4 * cosh(2 * x) + 3 * cos(4 * t));
}

static double error_of_solitons(const char *method, double step)
{
  quantum q = quantum_on_line("fourier:modes=256,points=513", -20, 20, 1, NULL, -1);
  dvi_march *march = quantum_march(&q, method, step);
  const double start = 0, end = 0.8;
  start_wave(march, &q, two_solitons, &start);
  ck_assert(fabs(observe_march(march, "norm") - 8) < 1e-13);
  ck_assert(fabs(observe_march(march, "energy") + 28.0 / 3) < 1e-12);
  advance_march(march, end);
  ck_assert(fabs(observe_march(march, "norm") - 8) < 3e-13);
  const double error = distance_from(march, &q, two_solitons, &end);
  dvi_march_destroy(&march);
  free_quantum(&q);
  return error;
}

static void check_error_of_solitons(const char *method, double step, double expected)
{
  const double error = error_of_solitons(method, step);
  ck_assert_msg(fabs(error / expected - 1) < 5e-3, "%s at %g: %.4g", method, step, error);
}

/* Errors of an independent program with 512 points, whose last digit is half of the tolerance.
 * Longer steps are in tests/apps/test_schroedinger.sh. */
START_TEST(solitons_go_through_their_peak_as_an_independent_program_finds)
{
  check_error_of_solitons("split", 0.001, 1.77e-4);
  check_error_of_solitons("midpoint", 0.001, 1.42e-4);
  check_error_of_solitons("split:order=4", 0.001, 4.45e-7);
}
END_TEST

/* ---- potentials of time ---- */

/* An oscillator that is pulled by sin 2t. The mean place obeys Newton's law (Ehrenfest 1927). */
static int pulled(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = 0.5 * x[i] * x[i] - sin(2 * t) * x[i];
  return 0;
}

static double error_of_place(const char *kind, int periodic, const char *method, double step)
{
  const dvi_schroedinger_terms terms = {.potential = pulled, .depends_on_time = 1};
  quantum q = quantum_with(space_on_line(kind, -8, 8, periodic), &terms);
  dvi_march *march = quantum_march(&q, method, step);
  const double start[] = {0, 0}, t = 2;
  start_wave(march, &q, packet, start);
  advance_march(march, t);
  const double place = observe_march(march, "position_x"), expected = (2 * sin(t) - sin(2 * t)) / 3;
  dvi_march_destroy(&march);
  free_quantum(&q);
  return fabs(place - expected);
}

START_TEST(potentials_of_time_keep_the_orders)
{
  static const struct {
    const char *kind;
    int periodic;
    const char *method;
    double step;
    int order;
  } cases[] = {{"fem:degree=8,cells=20", 0, "midpoint", 0.1, 2},
               {"fem:degree=8,cells=20", 0, "gauss:stages=2", 0.1, 4},
               {"fourier:modes=40", 1, "gauss:stages=2", 0.1, 4},
               {"fourier:modes=40,points=81", 1, "split", 0.1, 2},
               {"fourier:modes=40,points=81", 1, "split:order=4", 0.1, 4}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double before = error_of_place(cases[i].kind, cases[i].periodic, cases[i].method,
                                   cases[i].step);
    for (int k = 1; k < 4; k++) {
      const double error = error_of_place(cases[i].kind, cases[i].periodic, cases[i].method,
                                          cases[i].step / (1 << k));
      ck_assert_msg(fabs(log2(before / error) - cases[i].order) < 0.25, "%s: %g, %g",
                    cases[i].method, before, error);
      before = error;
    }
  }
}
END_TEST

/* ---- units, axes ---- */

static int stiff_spring(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = 4 * x[i] * x[i];
  return 0;
}

/* m = 2 and a spring of 8 have omega = 2, whatever hbar is. */
START_TEST(hbar_and_mass_make_the_classical_motion)
{
  const dvi_schroedinger_terms terms = {.potential = stiff_spring, .hbar = 0.5, .mass = 2};
  quantum q = quantum_with(space_on_line("fem:degree=8,cells=130", -9, 9, 0), &terms);
  dvi_march *march = quantum_march(&q, "gauss:stages=4", 0.005);
  const double start[] = {1, 0}, t = 0.7;
  start_wave(march, &q, packet, start);
  advance_march(march, t);
  ck_assert(fabs(observe_march(march, "position_x") - cos(2 * t)) < 1e-9);
  ck_assert(fabs(observe_march(march, "momentum_x") + 2 * 2 * sin(2 * t)) < 1e-8);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

static int gaussian_in_space(int64_t count, const double *x, double *f, void *user)
{
  const int axes = *(const int *)user;
  for (int64_t i = 0; i < count; i++) {
    f[i] = 1;
    for (int d = 0; d < axes; d++)
      f[i] *= pow(pi, -0.25) * exp(-0.5 * pow(x[d * count + i] - (d == 0), 2));
  }
  return 0;
}

static int harmonic_in_space(int64_t count, double t, const double *x, double *V, void *user)
{
  const int axes = *(const int *)user;
  (void)t;
  for (int64_t i = 0; i < count; i++) {
    V[i] = 0;
    for (int d = 0; d < axes; d++) V[i] += 0.5 * x[d * count + i] * x[d * count + i];
  }
  return 0;
}

static void check_motion_in_space(const char *kind, int periodic, int axes, const char *method,
                                  double tolerance)
{
  const dvi_axis one = {.from = -5.5, .to = 5.5, .periodic = periodic}, axis[] = {one, one, one};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = axis, .axes = axes};
  const dvi_schroedinger_terms terms = {.potential = harmonic_in_space, .user = &axes};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  quantum q = quantum_with(space, &terms);
  dvi_march *march = quantum_march(&q, method, 0.02);
  double *psi = calloc(2 * (size_t)q.functions, sizeof *psi);
  ck_assert(dvi_space_interpolate(space, gaussian_in_space, &axes, psi) == DVI_OK);
  const dvi_march_state state = {.size = sizeof state, .A = psi};
  ck_assert(dvi_march_start(march, &state) == DVI_OK);
  advance_march(march, 0.4);
  ck_assert_msg(fabs(observe_march(march, "position_x") - cos(0.4)) < tolerance, "%s: %.3g", kind,
                observe_march(march, "position_x") - cos(0.4));
  ck_assert(fabs(observe_march(march, axes == 3 ? "position_z" : "position_y")) < 1e-12);
  ck_assert(fabs(observe_march(march, "momentum_x") + sin(0.4)) < tolerance);
  free(psi);
  dvi_march_destroy(&march);
  free_quantum(&q);
}

START_TEST(packets_swing_in_two_and_three_dimensions)
{
  check_motion_in_space("fourier:modes=12,points=25", 1, 2, "split:order=4", 1e-6);
  check_motion_in_space("fem:degree=4,cells=8", 0, 2, "gauss:stages=2", 1e-4);
  check_motion_in_space("fourier:modes=8,points=17", 1, 3, "split", 1e-3);
}
END_TEST

SUITE(schroedinger)
{
  tcase_add_test(tests, midpoint_turns_a_plane_wave_by_its_own_frequency);
  tcase_add_loop_test(tests, steps_beyond_the_iteration_are_those_of_the_midpoint_rule, 0, 4);
  tcase_add_test(tests, split_turns_a_plane_wave_exactly);
  tcase_add_test(tests, gauss_turns_modes_by_diagonal_pade_approximants);
  tcase_add_test(tests, orders_are_those_that_the_methods_claim);
  tcase_add_test(tests, split_on_lumped_elements_has_the_same_orders);
  tcase_add_test(tests, norm_stays_for_ten_thousand_steps);
  tcase_add_test(tests, roundings_of_phases_do_not_add_up);
  tcase_add_test(tests, norm_stays_with_an_interaction);
  tcase_add_loop_test(tests, roundings_of_coefficients_do_not_add_up, 0, 2);
  tcase_add_loop_test(tests, norm_stays_in_steps_beyond_the_iteration, 0, 3);
  tcase_add_test(tests, states_turn_by_cayley_phases_in_long_steps);
  tcase_add_test(tests, gauss_keeps_the_energy_of_linear_equations);
  tcase_add_test(tests, solitons_go_through_their_peak_as_an_independent_program_finds);
  tcase_add_test(tests, potentials_of_time_keep_the_orders);
  tcase_add_test(tests, hbar_and_mass_make_the_classical_motion);
  tcase_add_test(tests, packets_swing_in_two_and_three_dimensions);
}
