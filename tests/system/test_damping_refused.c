/* labels: unit */
/* What damping may be declared, and who refuses it. */
#include <dvi/contact.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/friction/damped.h"
#include "support/systems/forced.h"

static void refused(dvi_system_terms terms, dvi_status status, const char *words)
{
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(rates_are_finite_and_not_negative)
{
  const double bad[] = {-0.1, (double)NAN, HUGE_VAL};
  for (int k = 0; k < 3; k++)
    refused((dvi_system_terms){.dimension = 1, .mass = {.scalar = 1}, .damping = bad[k]},
            DVI_BAD_ARGUMENT, "a finite rate, 0 or more, is needed");
}
END_TEST

static int on_row(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  *phi = q[0];
  return 0;
}

static int on_row_gradients(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)q, (void)user;
  phi_q[0] = 1;
  phi_q[1] = 0;
  return 0;
}

START_TEST(other_terms_refuse_it_beside_them)
{
  const dvi_holonomic row = {
      .name = "row", .count = 1, .value = on_row, .gradient = on_row_gradients};
  const dvi_contact gap = {.name = "floor", .gap = on_row, .gradient = on_row_gradients};
  const dvi_vector_potential A = {.value = on_row};
  const dvi_nonholonomic rolls = {.name = "wheel", .count = 1, .value = on_row_gradients};
  const dvi_system_terms base = {.dimension = 2, .mass = {.scalar = 1}, .damping = 0.1};
  dvi_system_terms terms = base;
  terms.holonomics = &row;
  terms.holonomic_count = 1;
  refused(terms, DVI_UNSUPPORTED, "damping does not stand beside holonomic constraints");
  terms = base;
  terms.contacts = &gap;
  terms.contact_count = 1;
  refused(terms, DVI_UNSUPPORTED, "damping does not stand beside contacts");
  terms = base;
  terms.vector_potential = &A;
  refused(terms, DVI_UNSUPPORTED, "damping does not stand beside a vector potential");
  terms = base;
  terms.nonholonomics = &rolls;
  terms.nonholonomic_count = 1;
  refused(terms, DVI_UNSUPPORTED, "damping does not stand beside nonholonomic constraints");
}
END_TEST

static void refused_beside(const char *name, const char *words)
{
  problem *model = create_problem(name, NULL);
  dvi_system_terms terms = *model->terms;
  terms.damping = 0.1;
  refused(terms, DVI_UNSUPPORTED, words);
  problem_destroy(&model);
}

START_TEST(other_kinds_of_dynamics_refuse_it)
{
  refused_beside("vortices", "damping does not stand beside a one-form");
  refused_beside("elastica", "damping does not stand beside a Hamiltonian");
}
END_TEST

/* Every method takes damping, or names it. */
START_TEST(methods_take_it_or_say_so)
{
  static const char *const takers[] = {"galerkin",        "midpoint",    "trapezoidal",
                                       "verlet",          "composition", "lie-galerkin",
                                       "sphere-galerkin", "lie-verlet"};
  enum { TAKERS = sizeof takers / sizeof *takers };
  static const damped_kind kinds[] = {DAMPED_OSCILLATOR, DAMPED_TOP};
  for (int k = 0; k < 2; k++) {
    damped model;
    make_damped(kinds[k], 0.1, &model);
    for (int m = 0; m < dvi_method_count(); m++) {
      dvi_integrator *integrator;
      const char *name = dvi_method_name(m);
      int takes = 0;
      for (int i = 0; i < TAKERS; i++) takes |= strcmp(takers[i], name) == 0;
      if (takes) continue;
      ck_assert_msg(dvi_integrator_create(model.system, name, &integrator) < 0, "%s", name);
      ck_assert_msg(strstr(dvi_last_error(), name) != NULL, "%s: %s", name, dvi_last_error());
    }
    destroy_damped(&model);
  }
}
END_TEST

START_TEST(methods_without_it_name_it)
{
  static const char *const methods[] = {"sem", "shooting",    "prolongation-collocation",
                                        "hp",  "hamiltonian", "nonholonomic"};
  damped model;
  make_damped(DAMPED_OSCILLATOR, 0.1, &model);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(model.system, methods[m], &integrator), DVI_UNSUPPORTED);
    check_words("damping, uniform friction -gamma p");
  }
  destroy_damped(&model);
}
END_TEST

START_TEST(other_users_of_a_system_say_so)
{
  const dvi_monitor distance = {.kind = DVI_MONITOR_ARCLENGTH};
  const dvi_integrator_options transformed = {.size = sizeof transformed,
                                              .method = "galerkin",
                                              .pacing = DVI_TIME_TRANSFORM,
                                              .monitor = &distance};
  const dvi_path_options ends = {.ends = DVI_ENDS_FIXED, .steps = 4, .span = 1};
  dvi_integrator *integrator;
  dvi_sensitivity *sensitivity;
  dvi_path *path;
  damped model;
  const dvi_system_terms still = {
      .dimension = 1, .mass = {.scalar = 1}, .autonomous = 1, .damping = 0.1};
  make_damped(DAMPED_OSCILLATOR, 0.1, &model);
  destroy_damped(&model);
  ck_assert_int_eq(dvi_system_create(&still, &model.system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create_with(model.system, &transformed, &integrator),
                   DVI_UNSUPPORTED);
  check_words("the system declares damping");
  ck_assert_int_eq(dvi_path_create(model.system, "galerkin", &ends, &path), DVI_UNSUPPORTED);
  check_words("path: the system declares damping");
  ck_assert_int_eq(dvi_sensitivity_create(model.system, "galerkin", NULL, &sensitivity),
                   DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_integrator_create(model.system, "verlet:blocking=temporal", &integrator),
                   DVI_UNSUPPORTED);
  check_words("blocking=temporal is not possible");
  destroy_damped(&model);
}
END_TEST

/* Files of a run and members of an ensemble belong to one rate. */
START_TEST(other_rates_are_other_systems)
{
  static unsigned char bytes[1 << 14];
  size_t size;
  damped one, other;
  make_damped(DAMPED_OSCILLATOR, 0.1, &one);
  make_damped(DAMPED_OSCILLATOR, 0.2, &other);
  dvi_integrator *first = damped_integrator(&one, "galerkin"),
                 *second = damped_integrator(&other, "galerkin");
  advance(first, 0.1, 3);
  ck_assert_int_eq(dvi_integrator_save_memory(first, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(second, bytes, size), DVI_BAD_FILE);
  check_words("damping");
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  destroy_damped(&one);
  destroy_damped(&other);
}
END_TEST

static int failing_after(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  V_q[0] = t > 0.35 ? (double)NAN : q[0];
  return 0;
}

static int spring_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] * q[0] / 2;
  return 0;
}

/* The first half of the friction is undone, too. */
START_TEST(a_failed_step_leaves_the_state)
{
  static const char *const methods[] = {"verlet", "galerkin", "composition:order=4"};
  const dvi_potential spring = {.name = "spring", .value = spring_value, .gradient = failing_after};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = 1},
                                  .potentials = &spring,
                                  .potential_count = 1,
                                  .damping = 0.3};
  damped model = {.q = {1}, .v = {0.5}};
  ck_assert_int_eq(dvi_system_create(&terms, &model.system), DVI_OK);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator = damped_integrator(&model, methods[m]);
    advance(integrator, 0.1, 3);
    const double p = *dvi_integrator_p(integrator), E = dvi_integrator_supplied(integrator, 0);
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_NOT_FINITE);
    ck_assert_double_eq(*dvi_integrator_p(integrator), p);
    ck_assert_double_eq(dvi_integrator_supplied(integrator, 0), E);
    dvi_integrator_destroy(&integrator);
  }
  destroy_damped(&model);
}
END_TEST

SUITE(damping_refused)
{
  tcase_add_test(tests, rates_are_finite_and_not_negative);
  tcase_add_test(tests, other_terms_refuse_it_beside_them);
  tcase_add_test(tests, other_kinds_of_dynamics_refuse_it);
  tcase_add_test(tests, methods_take_it_or_say_so);
  tcase_add_test(tests, methods_without_it_name_it);
  tcase_add_test(tests, other_users_of_a_system_say_so);
  tcase_add_test(tests, other_rates_are_other_systems);
  tcase_add_test(tests, a_failed_step_leaves_the_state);
}
