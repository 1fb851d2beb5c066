/* Marches of Schroedinger's equation: cuts, files, observables, and what is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/function_spaces.h"
#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/files.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846, start_at[] = {1, 0.5};

static quantum make_oscillator(double interaction)
{
  return quantum_on_line("fem:degree=5,cells=20,lumped=yes", -8, 8, 0, harmonic, interaction);
}

static dvi_march *started(const quantum *q, const char *method)
{
  dvi_march *march = quantum_march(q, method, 0.05);
  start_wave(march, q, packet, start_at);
  return march;
}

static void check_same_psi(const dvi_march *a, const dvi_march *b)
{
  double *x = sample_march(a, DVI_FORM_A), *y = sample_march(b, DVI_FORM_A);
  ck_assert(memcmp(x, y, (size_t)dvi_march_size(a, DVI_FORM_A) * sizeof *x) == 0);
  free(x);
  free(y);
}

static const char *const methods[] = {"midpoint", "gauss:stages=2", "split:order=4"};
enum { METHODS = sizeof methods / sizeof *methods };

/* ---- bits ---- */

START_TEST(cuts_and_observations_change_no_bit)
{
  quantum q = make_oscillator(1);
  for (int i = 0; i < METHODS; i++) {
    dvi_march *whole = started(&q, methods[i]), *cut = started(&q, methods[i]);
    advance_march(whole, 1);
    for (int k = 1; k <= 7; k++) {
      advance_march(cut, k / 7.0);
      ck_assert(observe_march(cut, "norm") > 0);
    }
    check_same_psi(whole, cut);
    dvi_march_destroy(&whole);
    dvi_march_destroy(&cut);
  }
  free_quantum(&q);
}
END_TEST

/* A shorter step has the norm, and the error of a step. */
START_TEST(psi_between_steps_is_that_of_a_shorter_step)
{
  quantum q = make_oscillator(0);
  dvi_march *march = started(&q, "gauss:stages=3");
  const double norm = observe_march(march, "norm"), end[] = {1, 0.5, 0.73};
  advance_march(march, 0.73);
  ck_assert(dvi_march_time(march) == 0.73);
  ck_assert(fabs(observe_march(march, "norm") - norm) < 1e-14);
  ck_assert(distance_from(march, &q, moved_packet, end) < 1e-4);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

START_TEST(a_loaded_march_goes_on_with_the_same_bits)
{
  quantum q = make_oscillator(1);
  for (int i = 0; i < METHODS; i++) {
    const char *path = path_in_folder("psi");
    dvi_march *march = started(&q, methods[i]), *loaded = quantum_march(&q, methods[i], 0.05);
    advance_march(march, 0.52);
    ck_assert(dvi_march_save(march, path) == DVI_OK);
    ck_assert_msg(dvi_march_load(loaded, path) == DVI_OK, "%s", dvi_last_error());
    advance_march(march, 1);
    advance_march(loaded, 1);
    check_same_psi(march, loaded);
    dvi_march_destroy(&march);
    dvi_march_destroy(&loaded);
  }
  free_quantum(&q);
}
END_TEST

START_TEST(files_that_are_cut_or_of_another_march_are_refused)
{
  quantum q = make_oscillator(0), other = make_oscillator(1);
  const char *path = path_in_folder("psi"), *part = path_in_folder("part");
  dvi_march *march = started(&q, "midpoint"), *split = started(&q, "split"),
            *longer = quantum_march(&q, "midpoint", 0.1),
            *interacting = quantum_march(&other, "midpoint", 0.05);
  advance_march(march, 0.5);
  ck_assert(dvi_march_save(march, path) == DVI_OK);
  bytes file = read_bytes(path);
  for (size_t count = 0; count < file.count; count += 1 + file.count / 37) {
    write_bytes(part, file.at, count);
    ck_assert(dvi_march_load(march, part) == DVI_BAD_FILE);
  }
  file.at[file.count / 2] ^= 1;
  write_bytes(part, file.at, file.count);
  ck_assert(dvi_march_load(march, part) == DVI_BAD_FILE);
  ck_assert(dvi_march_time(march) == 0.5);
  ck_assert(dvi_march_load(split, path) == DVI_BAD_FILE);
  ck_assert(dvi_march_load(longer, path) == DVI_BAD_FILE);
  check_words("same terms");
  ck_assert(dvi_march_load(interacting, path) == DVI_BAD_FILE);
  free(file.at);
  dvi_march_destroy(&march);
  dvi_march_destroy(&split);
  dvi_march_destroy(&longer);
  dvi_march_destroy(&interacting);
  free_quantum(&q);
  free_quantum(&other);
}
END_TEST

/* ---- observables ---- */

/* At rest after the start: density and current of exp(i p x) times a real function. */
START_TEST(probes_see_density_and_current)
{
  quantum q = make_oscillator(0);
  const double probe[] = {1, 0.3};
  const dvi_schroedinger_march_options options = {
      .size = sizeof options, .step = 0.05, .probe = probe, .probes = 2};
  dvi_march *march = NULL;
  ck_assert(dvi_schroedinger_march(q.equation, &options, &march) == DVI_OK);
  start_wave(march, &q, packet, start_at);
  for (int i = 0; i < 2; i++) {
    const double density = exp(-(probe[i] - 1) * (probe[i] - 1)) / sqrt(3.14159265358979);
    ck_assert(fabs(observe_march(march, i == 0 ? "density_0" : "density_1") - density) < 1e-4);
    ck_assert(fabs(observe_march(march, i == 0 ? "current_x_0" : "current_x_1") - 0.5 * density) <
              1e-3);
  }
  ck_assert(fabs(observe_march(march, "position_x") - 1) < 1e-10);
  ck_assert(fabs(observe_march(march, "momentum_x") - 0.5) < 1e-6);
  ck_assert(fabs(observe_march(march, "energy") - 0.5 - 0.5 - 0.125) < 1e-5);
  ck_assert(dvi_march_observable(march, 11) == NULL);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* ---- refusals ---- */

static void check_method(const char *kind, int periodic, const char *method, dvi_status expected,
                         const char *words)
{
  quantum q = quantum_on_line(kind, -8, 8, periodic, harmonic, 0);
  const dvi_schroedinger_march_options options = {
      .size = sizeof options, .step = 0.05, .method = method};
  dvi_march *march = NULL;
  ck_assert(dvi_schroedinger_march(q.equation, &options, &march) == expected);
  check_words(words);
  ck_assert(march == NULL);
  free_quantum(&q);
}

START_TEST(methods_that_do_not_fit_are_refused_with_those_that_do)
{
  const char fem[] = "fem:degree=2,cells=10";
  check_method(fem, 0, "verlet", DVI_UNSUPPORTED, "does not keep the norm");
  check_method(fem, 0, "leapfrog", DVI_BAD_OPTION, "midpoint, gauss:stages=2 and split:order=4");
  check_method(fem, 0, "gauss:stages=9", DVI_BAD_OPTION, "from 1 to 8");
  check_method(fem, 0, "gauss:stages=2.5", DVI_BAD_OPTION, "stages=");
  check_method(fem, 0, "gauss:order=4", DVI_BAD_OPTION, "stages=");
  check_method(fem, 0, "midpoint:stages=1", DVI_BAD_OPTION, "no options");
  check_method(fem, 0, "split", DVI_UNSUPPORTED, "lumped=yes");
  check_method("fourier:modes=8,points=25", 1, "split", DVI_UNSUPPORTED, "points=2K+1");
  check_method("fourier:modes=8,points=17", 1, "split:order=3", DVI_BAD_OPTION, "an even number");
}
END_TEST

static void check_options(dvi_schroedinger_march_options options, dvi_status expected,
                          const char *words)
{
  quantum q = make_oscillator(0);
  dvi_march *march = NULL;
  options.size = sizeof options;
  ck_assert(dvi_schroedinger_march(q.equation, &options, &march) == expected);
  check_words(words);
  free_quantum(&q);
}

START_TEST(steps_and_probes_are_checked)
{
  const double outside = 9;
  check_options((dvi_schroedinger_march_options){0}, DVI_BAD_ARGUMENT, "the step is 0");
  check_options((dvi_schroedinger_march_options){.step = NAN}, DVI_BAD_ARGUMENT, "the step is");
  check_options((dvi_schroedinger_march_options){.step = 1, .span = -1}, DVI_BAD_ARGUMENT,
                "the span is -1");
  check_options((dvi_schroedinger_march_options){.step = 1, .probes = 1}, DVI_BAD_ARGUMENT,
                "probes");
  check_options((dvi_schroedinger_march_options){.step = 1, .probe = &outside, .probes = 1},
                DVI_BAD_ARGUMENT, "probe 0");
}
END_TEST

static int undefined(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = sqrt(x[i]);
  return 0;
}

static int enormous(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = x[i] < 0 ? -1e200 : 0;
  return 0;
}

static int late(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = t < 0.32 ? 0 : INFINITY;
  return 0;
}

static int failing(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)count, (void)t, (void)x, (void)V, (void)user;
  return 7;
}

static int bad_interaction(int64_t count, const double *x, double *beta, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) beta[i] = NAN;
  return 0;
}

static void check_terms(const char *kind, int periodic, dvi_schroedinger_terms terms,
                        dvi_status expected, const char *words)
{
  dvi_space *space = space_on_line(kind, -1, 1, periodic);
  dvi_schroedinger *equation = NULL;
  if (terms.size == 0) terms.size = sizeof terms;
  terms.space = space;
  ck_assert(dvi_schroedinger_create(&terms, &equation) == expected);
  check_words(words);
  ck_assert(equation == NULL);
  dvi_space_destroy(&space);
}

START_TEST(terms_are_refused_with_a_reason)
{
  const char fem[] = "fem:degree=2,cells=10";
  typedef dvi_schroedinger_terms terms;
  check_terms(fem, 0, (terms){.size = 1}, DVI_BAD_ARGUMENT, "terms.size");
  check_terms(fem, 0, (terms){.hbar = -1}, DVI_BAD_ARGUMENT, "hbar = -1");
  check_terms(fem, 0, (terms){.mass = NAN}, DVI_BAD_ARGUMENT, "mass");
  check_terms(fem, 0, (terms){.hbar = 1e-300}, DVI_BAD_ARGUMENT, "hbar^2/(2 mass) = 0");
  check_terms(fem, 0, (terms){.mass = 1e-300}, DVI_BAD_ARGUMENT, "units in which");
  check_terms(fem, 0, (terms){.interaction = INFINITY}, DVI_NOT_FINITE, "interaction is inf");
  check_terms(fem, 0, (terms){.potential = undefined}, DVI_NOT_FINITE, "at (-0.9");
  check_terms(fem, 0, (terms){.potential = enormous}, DVI_NOT_FINITE, "is -1e+200 at (-0.9");
  check_terms(fem, 0, (terms){.potential = failing}, DVI_CALLBACK_FAILED, "failed with 7");
  check_terms(fem, 0, (terms){.interaction_at = bad_interaction}, DVI_NOT_FINITE, "interaction");
  check_terms(fem, 0, (terms){.fixed = "left, top"}, DVI_BAD_ARGUMENT, "\"top\"");
  check_terms(fem, 0, (terms){.radial = 4}, DVI_BAD_ARGUMENT, "radial = 4");
  check_terms(fem, 0, (terms){.radial = 2}, DVI_BAD_ARGUMENT, "begin at 0");
  check_terms("fourier:modes=3", 1, (terms){.radial = 2}, DVI_UNSUPPORTED, "not periodic");
  check_terms("fem:degree=1,cells=1", 0, (terms){0}, DVI_BAD_ARGUMENT, "all 2 functions");
}
END_TEST

START_TEST(a_potential_that_becomes_infinite_stops_the_march_before)
{
  const dvi_schroedinger_terms terms = {.potential = late, .depends_on_time = 1};
  quantum q = quantum_with(space_on_line("fem:degree=3,cells=10", -5, 5, 0), &terms);
  dvi_march *march = started(&q, "midpoint");
  ck_assert(dvi_march_advance(march, 1) == DVI_NOT_FINITE);
  check_words("the potential is inf at (-");
  ck_assert(fabs(dvi_march_time(march) - 0.3) < 1e-14);
  ck_assert(fabs(observe_march(march, "norm") - 1) < 1e-3);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

START_TEST(steps_that_do_not_converge_leave_psi)
{
  quantum q = make_oscillator(-400);
  dvi_march *march = quantum_march(&q, "midpoint", 0.5);
  start_wave(march, &q, packet, start_at);
  double *before = sample_march(march, DVI_FORM_A);
  ck_assert(dvi_march_advance(march, 1) == DVI_NOT_CONVERGED);
  check_words("Newton's method leaves an error of ");
  double *after = sample_march(march, DVI_FORM_A);
  ck_assert(memcmp(before, after, 2 * (size_t)q.functions * sizeof *before) == 0);
  free(before);
  free(after);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

START_TEST(starts_are_psi_alone_and_finite)
{
  quantum q = make_oscillator(0);
  dvi_march *march = quantum_march(&q, "midpoint", 0.1);
  double *psi = wave_on(&q, packet, start_at);
  ck_assert(dvi_march_start(march, &(dvi_march_state){sizeof(dvi_march_state), .E = psi}) ==
            DVI_BAD_ARGUMENT);
  psi[q.functions + 3] = NAN;
  ck_assert(dvi_march_start(march, &(dvi_march_state){sizeof(dvi_march_state), .A = psi}) ==
            DVI_NOT_FINITE);
  check_words("imaginary part of function 3");
  free(psi);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

START_TEST(stationary_states_are_refused_with_a_reason)
{
  quantum q = make_oscillator(0),
          free_particle = quantum_on_line("fourier:modes=3", 0, 1, 1, NULL, 0);
  double energy[64];
  dvi_schroedinger_ground_report state;
  ck_assert(dvi_schroedinger_modes(q.equation, 60, energy, NULL) == DVI_BAD_SIZE);
  ck_assert(dvi_schroedinger_modes(q.equation, 0, energy, NULL) == DVI_BAD_SIZE);
  ck_assert(dvi_schroedinger_ground(q.equation, 0, NULL, NULL) == DVI_BAD_ARGUMENT);
  check_words("the norm is 0");
  ck_assert(dvi_schroedinger_ground(free_particle.equation, 1, &state, NULL) == DVI_OK);
  ck_assert(fabs(state.mu) < 1e-15 && state.followed == 1);
  free_quantum(&q);
  free_quantum(&free_particle);
}
END_TEST

/* ---- words ---- */

START_TEST(equations_are_explained)
{
  char text[400];
  quantum q = make_oscillator(1), circle = quantum_on_line("fourier:modes=3", 0, 1, 1, NULL, 0);
  dvi_schroedinger_explain(q.equation, text, sizeof text);
  ck_assert(strstr(text, "99 free of 101 functions, 120 points") != NULL);
  ck_assert(strstr(text, "a potential of x, an interaction") != NULL);
  ck_assert(strstr(text, "sparse matrices with ") != NULL);
  dvi_schroedinger_explain(circle.equation, text, sizeof text);
  ck_assert(strstr(text, "no potential, no interaction\ndiagonal kinetic energy") != NULL);
  dvi_schroedinger_explain(circle.equation, text, 9);
  ck_assert_str_eq(text, "hbar = 1");
  free_quantum(&q);
  free_quantum(&circle);
}
END_TEST

static double complex still_wave(double x, const double *parameter)
{
  (void)x, (void)parameter;
  return 1;
}

/* Start a wave of density 1 with noise of 1e-6, and give the largest kinetic energy of a thousand
 * steps. */
static double noise_after(const char *kind, const char *method, double beta, double step,
                          double *bound)
{
  const dvi_schroedinger_terms terms = {.interaction = beta, .fixed = "none"};
  quantum q = quantum_with(space_on_line(kind, 0, 2 * pi, 1), &terms);
  dvi_march *march = quantum_march(&q, method, step);
  dvi_march_facts facts;
  double *psi = wave_on(&q, still_wave, NULL), most = 0;
  for (int64_t i = 0; i < 2 * q.functions; i++)
    psi[i] += 1e-6 * sin(7.3 * (double)(i + 1) * (double)(i + 2));
  ck_assert(dvi_march_start(march, &(dvi_march_state){sizeof(dvi_march_state), .A = psi}) ==
            DVI_OK);
  dvi_march_facts_of(march, &facts);
  for (int i = 1; i <= 10; i++) {
    advance_march(march, 100 * i * step);
    most = fmax(most, observe_march(march, "kinetic"));
  }
  *bound = facts.bound;
  free(psi);
  dvi_march_destroy(&march);
  free_quantum(&q);
  return most;
}

/* 1.5 % below a bound, and above it by 1.5 % in order 2, where it is sharp. */
START_TEST(resonances_grow_beyond_the_bound)
{
  static const struct {
    const char *kind, *method;
    double above;
  } cases[] = {{"fourier:modes=8,points=17", "split", 1.015},
               {"fourier:modes=8,points=17", "split:order=4", 1.035},
               {"fem:degree=2,cells=20,lumped=yes", "split", 1.015},
               {"legendre:degree=12", "split", 1.015},
               {"legendre:degree=16", "split:order=4", 1.1}};
  double bound, unused;
  (void)noise_after(cases[_i].kind, cases[_i].method, 4, 1e-3, &bound);
  ck_assert_double_lt(noise_after(cases[_i].kind, cases[_i].method, 4, 0.985 * bound, &unused),
                      1e-7);
  ck_assert_double_gt(
      noise_after(cases[_i].kind, cases[_i].method, 4, cases[_i].above * bound, &unused), 1e-7);
}
END_TEST

/* T = 32 and beta |psi|^2 = 4 on the circle. */
START_TEST(only_resonances_bound_the_step)
{
  const char fourier[] = "fourier:modes=8,points=17", fem[] = "fem:degree=2,cells=20,lumped=yes";
  double bound;
  (void)noise_after(fourier, "split", 4, 1e-3, &bound);
  ck_assert_double_eq_tol(32 * bound + 2 * atan(4 * bound), pi, 1e-5);
  (void)noise_after(fourier, "split", -1, 1e-3, &bound);
  ck_assert_double_eq_tol(bound, pi / 32, 1e-14);
  (void)noise_after(fourier, "gauss", 4, 1e-3, &bound);
  ck_assert(isinf(bound));
  (void)noise_after(fem, "split", -1, 1e-3, &bound);
  ck_assert(isinf(bound));
}
END_TEST

/* ---- memory ---- */

static void check_no_allocation(const quantum *q, const char *method)
{
  dvi_march *march = started(q, method);
  advance_march(march, 0.05);
  const long before = dvi__allocation_count();
  advance_march(march, 0.3);
  ck_assert(dvi__allocation_count() == before);
  dvi_march_destroy(&march);
}

START_TEST(steps_take_no_memory)
{
  const dvi_schroedinger_terms moving = {.potential = late, .depends_on_time = 1};
  quantum still = make_oscillator(1),
          moved = quantum_with(space_on_line("fem:degree=3,cells=10", -5, 5, 0), &moving),
          circle = quantum_on_line("fourier:modes=20,points=41", -8, 8, 1, harmonic, 1),
          strong = make_oscillator(400);
  for (int i = 0; i < METHODS; i++) {
    check_no_allocation(&still, methods[i]);
    check_no_allocation(&circle, methods[i]);
  }
  check_no_allocation(&moved, "midpoint");
  check_no_allocation(&strong, "midpoint");
  free_quantum(&strong);
  free_quantum(&still);
  free_quantum(&moved);
  free_quantum(&circle);
}
END_TEST

static dvi_status make_all(dvi_space *space, const char *method)
{
  const dvi_schroedinger_terms terms = {
      .size = sizeof terms, .space = space, .potential = harmonic, .interaction = 1};
  const dvi_schroedinger_march_options options = {
      .size = sizeof options, .step = 0.05, .method = method};
  dvi_schroedinger *equation = NULL;
  dvi_march *march = NULL;
  dvi_status status = dvi_schroedinger_create(&terms, &equation);
  if (status == DVI_OK) status = dvi_schroedinger_march(equation, &options, &march);
  if (status == DVI_OK) status = dvi_schroedinger_ground(equation, 1, NULL, NULL);
  dvi_march_destroy(&march);
  dvi_schroedinger_destroy(&equation);
  return status;
}

static void check_every_allocation(const char *kind, int periodic, const char *method)
{
  dvi_space *space = space_on_line(kind, -6, 6, periodic);
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status == DVI_NO_MEMORY; successes++) {
    dvi__fail_allocations_after(successes);
    status = make_all(space, method);
    dvi__fail_allocations_after(-1);
  }
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  dvi_space_destroy(&space);
}

START_TEST(every_lack_of_memory_is_reported)
{
  check_every_allocation("fem:degree=2,cells=12,lumped=yes", 0, "split:order=4");
  check_every_allocation("fem:degree=2,cells=12", 0, "gauss:stages=2");
  check_every_allocation("fourier:modes=16,points=33", 1, "split");
}
END_TEST

SUITE(schroedinger_march)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, cuts_and_observations_change_no_bit);
  tcase_add_test(tests, psi_between_steps_is_that_of_a_shorter_step);
  tcase_add_test(tests, a_loaded_march_goes_on_with_the_same_bits);
  tcase_add_test(tests, files_that_are_cut_or_of_another_march_are_refused);
  tcase_add_test(tests, probes_see_density_and_current);
  tcase_add_test(tests, methods_that_do_not_fit_are_refused_with_those_that_do);
  tcase_add_test(tests, steps_and_probes_are_checked);
  tcase_add_test(tests, terms_are_refused_with_a_reason);
  tcase_add_test(tests, a_potential_that_becomes_infinite_stops_the_march_before);
  tcase_add_test(tests, steps_that_do_not_converge_leave_psi);
  tcase_add_test(tests, starts_are_psi_alone_and_finite);
  tcase_add_test(tests, stationary_states_are_refused_with_a_reason);
  tcase_add_test(tests, equations_are_explained);
  tcase_add_test(tests, only_resonances_bound_the_step);
  tcase_add_loop_test(tests, resonances_grow_beyond_the_bound, 0, 5);
  tcase_add_test(tests, steps_take_no_memory);
  tcase_add_test(tests, every_lack_of_memory_is_reported);
}
