/* labels: unit */
/* What forces may be declared, where they are refused, and how the check compares them. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/forced.h"

static int push(double t, const double *q, const double *v, double *F, void *user)
{
  const double *c = user;
  F[0] = c[0] * v[0] + c[1] * q[1] + c[2] * t;
  F[1] = c[0] * v[1];
  return 0;
}

static int push_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                         void *user)
{
  const double *c = user;
  (void)t, (void)q, (void)v;
  F_q[0] = F_q[1] = F_q[3] = F_v[1] = F_v[2] = 0;
  F_q[2] = c[1];
  F_v[0] = F_v[3] = c[0];
  return 0;
}

static int wrong_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                          void *user)
{
  const int returned = push_jacobian(t, q, v, F_q, F_v, user);
  F_v[3] *= 1.01;
  return returned;
}

static int push_batch(int count, const double *t, const double *q, const double *v, double *F,
                      void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  for (int k = 0; k < 2 * count; k++) F[k] = 0;
  return 0;
}

static double numbers[3] = {-0.5, 0.25, 0};
static const double q[2] = {0.3, -0.4}, v[2] = {0.7, 0.2};

static dvi_status create_with(dvi_force force, dvi_system **system)
{
  force.user = numbers;
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .forces = &force, .force_count = 1, .autonomous = 1};
  return dvi_system_create(&terms, system);
}

static void refused(dvi_force force, dvi_status status, const char *words)
{
  dvi_system *system;
  ck_assert_int_eq(create_with(force, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(forces_that_are_not_well_declared_are_refused)
{
  static const int start[] = {0, 1, 2}, row[] = {0, 1}, beyond[] = {0, 2};
  refused((dvi_force){.name = "F"}, DVI_BAD_ARGUMENT, "force 'F' has no value callback");
  refused((dvi_force){.value = push, .value_batch = push_batch}, DVI_BAD_ARGUMENT,
          "force 'force' has its value callback in two shapes");
  refused(
      (dvi_force){
          .name = "F", .value = push, .without_velocity = 1, .by_v = {.start = start, .row = row}},
      DVI_BAD_ARGUMENT, "pattern of dF/dv, but is declared without velocity");
  refused((dvi_force){.name = "F", .value = push, .by_q = {.start = start, .row = beyond}},
          DVI_BAD_ARGUMENT, "F");
}
END_TEST

START_TEST(lists_of_forces_and_their_counts_go_together)
{
  const dvi_force force = {.value = push, .user = numbers};
  dvi_system *system;
  dvi_system_terms terms = {.dimension = 2, .mass = {.scalar = 1}, .force_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("1 forces declared, but their list is NULL");
  terms.force_count = -1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_SIZE);
  terms.force_count = 0;
  terms.forces = &force;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
}
END_TEST

/* Declares a force beside the terms of a problem of the catalogue. */
static void refused_beside(const char *problem_name, const char *words)
{
  const dvi_force force = {.value = push, .user = numbers};
  problem *model = create_problem(problem_name, NULL);
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  terms.forces = &force;
  terms.force_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words(words);
  problem_destroy(&model);
}

START_TEST(forces_are_refused_beside_other_kinds_of_dynamics)
{
  refused_beside("vortices", "not with a one-form");
  refused_beside("elastica", "not with a Hamiltonian");
}
END_TEST

/* ---- the check ---- */

static void check_says(dvi_force force, double last, dvi_status status, const char *words)
{
  dvi_system *system;
  dvi_derivative_check found;
  numbers[2] = last;
  ck_assert_msg(create_with(force, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_check(system, 0.3, q, v, 0, &found), status);
  if (status != DVI_OK) check_words(words);
  dvi_system_destroy(&system);
  numbers[2] = 0;
}

START_TEST(the_check_compares_jacobians_patterns_and_time)
{
  static const int start[] = {0, 1, 2}, row[] = {0, 1};
  const dvi_force good = {.name = "push", .value = push, .jacobian = push_jacobian};
  dvi_force wrong = good, narrow = {.name = "push", .value = push};
  wrong.jacobian = wrong_jacobian;
  narrow.by_q = (dvi_pattern){start, row};
  check_says(good, 0, DVI_OK, NULL);
  check_says(wrong, 0, DVI_BAD_ARGUMENT, "force 'push': dF/dv (1,1) is");
  check_says(narrow, 0, DVI_BAD_ARGUMENT, "force 'push': dF/dq (0,1) is not in the pattern");
  check_says(good, 0.1, DVI_BAD_ARGUMENT, "force 'push': its value");
}
END_TEST

/* ---- methods and other users of a system ---- */

START_TEST(methods_that_take_no_forces_say_so)
{
  static const char *const methods[] = {"sem", "shooting", "prolongation-collocation",
                                        "multiscale:fast=0,omega=3", "hp:type=4"};
  forced model;
  make_forced(DRIVEN_OSCILLATOR, FORCED_POINT, &model);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(model.system, methods[m], &integrator), DVI_UNSUPPORTED);
    check_words("forces without a potential");
  }
  destroy_forced(&model);
}
END_TEST

START_TEST(paths_and_time_transforms_take_no_forces)
{
  const dvi_monitor distance = {.kind = DVI_MONITOR_ARCLENGTH};
  const dvi_integrator_options transformed = {.size = sizeof transformed,
                                              .method = "galerkin",
                                              .pacing = DVI_TIME_TRANSFORM,
                                              .monitor = &distance};
  const dvi_path_options ends = {.ends = DVI_ENDS_FIXED, .steps = 4, .span = 1};
  dvi_integrator *integrator;
  dvi_path *path;
  forced model;
  make_forced(CURVED_LINE, FORCED_POINT, &model);
  ck_assert_int_eq(dvi_integrator_create_with(model.system, &transformed, &integrator),
                   DVI_UNSUPPORTED);
  check_words("forces without a potential");
  ck_assert_int_eq(dvi_path_create(model.system, "galerkin", &ends, &path), DVI_UNSUPPORTED);
  check_words("forces without a potential");
  destroy_forced(&model);
}
END_TEST

/* ---- failures in a step ---- */

static int failing_after(double t, const double *x, const double *w, double *F, void *user)
{
  (void)x;
  F[0] = t > 0.35 ? *(const double *)user : -w[0];
  return 0;
}

static int failing_jacobian(double t, const double *x, const double *w, double *F_q, double *F_v,
                            void *user)
{
  (void)t, (void)x, (void)w, (void)user;
  F_q[0] = 0;
  F_v[0] = -1;
  return 0;
}

START_TEST(a_force_that_is_not_finite_leaves_the_state)
{
  static const char *const methods[] = {"verlet", "galerkin", "composition:order=4"};
  double bad = (double)NAN;
  const dvi_force force = {
      .name = "push", .value = failing_after, .jacobian = failing_jacobian, .user = &bad};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = 1},
                                  .potentials = &unit_spring,
                                  .potential_count = 1,
                                  .forces = &force,
                                  .force_count = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    const dvi_integrator_options options = {
        .size = sizeof options, .method = methods[m], .balances = 1};
    dvi_integrator *integrator;
    const double one = 1, none = 0;
    ck_assert_int_eq(dvi_integrator_create_with(system, &options, &integrator), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, &one, &none), DVI_OK);
    advance(integrator, 0.1, 3);
    const double x = *dvi_integrator_q(integrator),
                 supplied = dvi_integrator_supplied(integrator, 0);
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_NOT_FINITE);
    check_words("push: the value callback gave nan");
    ck_assert_double_eq(*dvi_integrator_q(integrator), x);
    ck_assert_double_eq(dvi_integrator_supplied(integrator, 0), supplied);
    ck_assert_double_eq_tol(dvi_integrator_time(integrator), 0.3, 1e-15);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- balances ---- */

START_TEST(balances_are_kept_when_they_are_asked_for)
{
  forced model;
  double defect;
  make_forced(STIRRED_SPRING, FORCED_POINT, &model);
  dvi_integrator *plain = create_integrator(model.system, "galerkin"),
                 *keeping = forced_integrator(&model, "galerkin");
  ck_assert_double_nan(dvi_integrator_supplied(plain, 0));
  ck_assert_int_eq(dvi_integrator_balance(plain, 0, &defect), DVI_BAD_STATE);
  check_words("create it with the option balances");
  ck_assert_double_eq(dvi_integrator_supplied(keeping, 0), 0);
  ck_assert_double_eq(dvi_integrator_supplied(keeping, 1), 0);
  ck_assert_double_nan(dvi_integrator_supplied(keeping, 2));
  ck_assert_int_eq(dvi_integrator_balance(keeping, 2, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_balance(keeping, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_balance(NULL, 0, &defect), DVI_BAD_ARGUMENT);
  dvi_integrator_destroy(&plain);
  dvi_integrator_destroy(&keeping);
  destroy_forced(&model);
}
END_TEST

/* A restored run goes on with the same bits, supplies included. */
START_TEST(checkpoints_hold_balances)
{
  static unsigned char bytes[1 << 16];
  static const char *const methods[] = {"verlet", "galerkin:degree=3"};
  size_t size;
  forced model;
  make_forced(STIRRED_SPRING, FORCED_POINT, &model);
  for (int m = 0; m < 2; m++) {
    dvi_integrator *first = forced_integrator(&model, methods[m]),
                   *second = forced_integrator(&model, methods[m]),
                   *plain = create_integrator(model.system, methods[m]);
    advance(first, 0.1, 50);
    ck_assert_int_eq(dvi_integrator_save_memory(first, bytes, sizeof bytes, &size), DVI_OK);
    advance(first, 0.1, 50);
    ck_assert_int_eq(dvi_integrator_restore_memory(second, bytes, size), DVI_OK);
    advance(second, 0.1, 50);
    for (int i = 0; i < 2; i++) {
      double one, other;
      ck_assert_double_eq(dvi_integrator_q(first)[i], dvi_integrator_q(second)[i]);
      ck_assert_double_eq(dvi_integrator_supplied(first, i), dvi_integrator_supplied(second, i));
      ck_assert_int_eq(dvi_integrator_balance(first, i, &one), DVI_OK);
      ck_assert_int_eq(dvi_integrator_balance(second, i, &other), DVI_OK);
      ck_assert_double_eq(one, other);
    }
    ck_assert_int_eq(dvi_integrator_restore_memory(plain, bytes, size), DVI_OK);
    ck_assert_int_eq(dvi_integrator_save_memory(plain, bytes, sizeof bytes, &size), DVI_OK);
    ck_assert_int_eq(dvi_integrator_restore_memory(second, bytes, size), DVI_BAD_FILE);
    check_words("balances");
    dvi_integrator_destroy(&first);
    dvi_integrator_destroy(&second);
    dvi_integrator_destroy(&plain);
  }
  destroy_forced(&model);
}
END_TEST

SUITE(forces)
{
  tcase_add_test(tests, forces_that_are_not_well_declared_are_refused);
  tcase_add_test(tests, lists_of_forces_and_their_counts_go_together);
  tcase_add_test(tests, forces_are_refused_beside_other_kinds_of_dynamics);
  tcase_add_test(tests, the_check_compares_jacobians_patterns_and_time);
  tcase_add_test(tests, methods_that_take_no_forces_say_so);
  tcase_add_test(tests, paths_and_time_transforms_take_no_forces);
  tcase_add_test(tests, a_force_that_is_not_finite_leaves_the_state);
  tcase_add_test(tests, balances_are_kept_when_they_are_asked_for);
  tcase_add_test(tests, checkpoints_hold_balances);
}
