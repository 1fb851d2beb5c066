/* labels: unit */
/* What noise may be declared, and who refuses it. */
#include <check.h>
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/noisy.h"

static const dvi_noise bath = {.temperature = 1, .friction = 1};

static void refused(dvi_system_terms terms, dvi_noise noise, dvi_status status, const char *words)
{
  dvi_system *system;
  terms.noise = &noise;
  ck_assert_int_eq(dvi_system_create(&terms, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(noise_that_is_none_is_refused)
{
  const dvi_system_terms mass = {.dimension = 1, .mass.scalar = 1};
  refused(mass, (dvi_noise){.temperature = -1}, DVI_BAD_ARGUMENT,
          "the temperature of the noise is -1");
  refused(mass, (dvi_noise){.friction = -0.5}, DVI_BAD_ARGUMENT,
          "the friction of the noise is -0.5");
  refused(mass, (dvi_noise){.temperature = (double)NAN}, DVI_BAD_ARGUMENT, "temperature");
  refused(mass, (dvi_noise){.friction = (double)INFINITY}, DVI_BAD_ARGUMENT, "friction");
}
END_TEST

START_TEST(noise_beside_other_than_a_constant_mass_is_refused)
{
  static const char *const problems[] = {"double-pendulum", "lotka-volterra", "free-body",
                                         "knife-edge", "magnetic-bottle"};
  static const char *const words[] = {"a general Lagrangian", "a one-form", "factors",
                                      "nonholonomic constraints", "a vector potential"};
  for (int i = 0; i < 5; i++) {
    problem *made = create_problem(problems[i], NULL);
    refused(*made->terms, bath, DVI_UNSUPPORTED, words[i]);
    problem_destroy(&made);
  }
  refused((dvi_system_terms){.dimension = 2, .mass.scalar = 1, .damping = 0.1}, bath,
          DVI_UNSUPPORTED, "damping");
}
END_TEST

START_TEST(every_method_but_langevin_refuses_it_by_name)
{
  noisy_oscillators noisy;
  make_noisy(2, 1, 1, 0, bath, &noisy);
  for (int i = 0; i < dvi_method_count(); i++) {
    dvi_integrator *integrator = NULL;
    const int is_langevin = strcmp(dvi_method_name(i), "langevin") == 0;
    const dvi_status status = dvi_integrator_create(noisy.system, dvi_method_name(i), &integrator);
    ck_assert_msg(status == (is_langevin ? DVI_OK : DVI_UNSUPPORTED), "%s: %s", dvi_method_name(i),
                  dvi_last_error());
    if (!is_langevin) check_words(dvi_method_name(i));
    if (!is_langevin) check_words("methods for this system: langevin");
    dvi_integrator_destroy(&integrator);
  }
  destroy_noisy(&noisy);
}
END_TEST

START_TEST(judges_paths_and_other_times_refuse_it)
{
  static const dvi_reference_code codes[] = {DVI_IDA, DVI_CVODE_ADAMS, DVI_CVODE_BDF, DVI_ARKODE};
  noisy_oscillators noisy;
  double q[] = {1, 0}, p[] = {0, 0};
  dvi_path *path = NULL;
  dvi_integrator *integrator = NULL;
  make_noisy(2, 1, 1, 0, bath, &noisy);
  for (int i = 0; i < 4; i++) {
    const dvi_reference_options options = {.code = codes[i]};
    ck_assert_int_eq(dvi_reference_solve(noisy.system, 0, 1, q, p, &options, NULL),
                     DVI_UNSUPPORTED);
    check_words("noise");
    check_words(dvi_reference_name(codes[i]));
  }
  const dvi_path_options ends = {.ends = DVI_ENDS_FIXED, .steps = 4, .span = 1};
  ck_assert_int_eq(dvi_path_create(noisy.system, "galerkin", &ends, &path), DVI_UNSUPPORTED);
  check_words("the system declares noise");
  dvi_monitor monitor;
  ck_assert_int_eq(dvi_monitor_read("arclength", &monitor), DVI_OK);
  dvi_integrator_options options = {.size = sizeof options,
                                    .method = "langevin",
                                    .pacing = DVI_TIME_TRANSFORM,
                                    .monitor = &monitor};
  ck_assert_int_eq(dvi_integrator_create_with(noisy.system, &options, &integrator),
                   DVI_UNSUPPORTED);
  check_words("noise");
  options.pacing = DVI_STEP_CONTROL;
  ck_assert_int_eq(dvi_integrator_create_with(noisy.system, &options, &integrator),
                   DVI_UNSUPPORTED);
  check_words("not symmetric");
  destroy_noisy(&noisy);
}
END_TEST

START_TEST(the_two_form_and_the_way_back_of_noisy_steps_are_not_measured)
{
  noisy_oscillators noisy;
  const double q[] = {1, 0}, p[] = {0, 0};
  double defect;
  make_noisy(2, 1, 1, 0, bath, &noisy);
  dvi_integrator *integrator = create_integrator(noisy.system, "langevin");
  ck_assert_int_ne(dvi_symplecticity(integrator, 0, q, p, 0.1, &defect), DVI_OK);
  check_words("noise");
  ck_assert_int_ne(dvi_reversibility(integrator, 0, q, p, 0.1, 3, &defect), DVI_OK);
  check_words("noise");
  dvi_integrator_destroy(&integrator);
  destroy_noisy(&noisy);
}
END_TEST

START_TEST(a_temperature_is_told_of_systems_with_noise_alone)
{
  double T;
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator, "verlet");
  ck_assert_int_eq(dvi_integrator_temperature(integrator, &T), DVI_UNSUPPORTED);
  check_words("no noise");
  ck_assert_int_eq(dvi_integrator_temperature(NULL, &T), DVI_BAD_ARGUMENT);
  dvi_integrator_destroy(&integrator);
  noisy_oscillators noisy;
  make_noisy(2, 2, 1, 0, bath, &noisy);
  integrator = create_integrator(noisy.system, "langevin");
  ck_assert_int_eq(dvi_integrator_temperature(integrator, &T), DVI_BAD_STATE);
  const double q[2] = {0}, p[2] = {3, 4};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_temperature(integrator, &T), DVI_OK);
  ck_assert_double_eq(T, 25 / 2.0 / 2);
  dvi_integrator_destroy(&integrator);
  destroy_noisy(&noisy);
  problem_destroy(&oscillator);
}
END_TEST

SUITE(noise)
{
  tcase_add_test(tests, noise_that_is_none_is_refused);
  tcase_add_test(tests, noise_beside_other_than_a_constant_mass_is_refused);
  tcase_add_test(tests, every_method_but_langevin_refuses_it_by_name);
  tcase_add_test(tests, judges_paths_and_other_times_refuse_it);
  tcase_add_test(tests, the_two_form_and_the_way_back_of_noisy_steps_are_not_measured);
  tcase_add_test(tests, a_temperature_is_told_of_systems_with_noise_alone);
}
