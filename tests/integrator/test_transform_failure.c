/* labels: unit */
/* A system or method that cannot be transformed or controlled is refused with a sentence, and a
 * step that fails leaves the state as it was. */
#include <math.h>
#include <stdint.h>

#include "core/memory.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"

static const paced_create both[] = {create_transformed, create_controlled};

static void refused(dvi_status found, dvi_status expected, const char *words)
{
  ck_assert_msg(found == expected, "%s: %s", dvi_status_name(found), dvi_last_error());
  check_words(words);
}

/* ---- systems and methods ---- */

static int drive(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = q[0] * q[0] / 2 - q[0] * cos(t);
  return 0;
}

START_TEST(a_system_that_may_depend_on_time_is_not_transformed)
{
  const dvi_potential driven = {.name = "drive", .value = drive};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &driven, .potential_count = 1};
  const dvi_monitor distance = read_monitor("distance"), arclength = read_monitor("arclength");
  dvi_system *system;
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  refused(create_transformed(system, &distance, "midpoint", &integrator), DVI_UNSUPPORTED,
          "not declared autonomous");
  ck_assert_ptr_null(integrator);
  refused(create_controlled(system, &arclength, "midpoint", &integrator), DVI_UNSUPPORTED,
          "not declared autonomous");
  ck_assert_int_eq(create_controlled(system, &distance, "midpoint", &integrator), DVI_OK);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(explicit_methods_are_not_transformed)
{
  problem *kepler = create_problem("kepler", NULL);
  const dvi_monitor distance = read_monitor("distance");
  dvi_integrator *integrator;
  refused(create_transformed(kepler->system, &distance, "verlet", &integrator), DVI_UNSUPPORTED,
          "time transform");
  check_words("verlet: the system declares a general Lagrangian");
  refused(create_transformed(kepler->system, &distance, "composition", &integrator),
          DVI_UNSUPPORTED, "verlet");
  ck_assert_ptr_null(integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(control_wants_a_symmetric_method)
{
  problem *kepler = create_problem("kepler", NULL);
  const dvi_monitor distance = read_monitor("distance");
  dvi_integrator *integrator;
  refused(create_controlled(kepler->system, &distance, "galerkin:degree=2,quadrature=radau-left",
                            &integrator),
          DVI_UNSUPPORTED, "step control");
  check_words("is not symmetric");
  ck_assert_ptr_null(integrator);
  problem_destroy(&kepler);
}
END_TEST

/* A one-form has no mass to divide by the monitor. Symmetric methods for it take control, to their
 * order: halved steps divide the error by 64. */
START_TEST(a_one_form_takes_control_alone)
{
  static const double h = 0.2;
  problem *prey = create_problem("lotka-volterra", NULL);
  const dvi_monitor distance_to_origin = read_monitor("distance");
  double error[2];
  dvi_integrator *integrator;
  refused(create_transformed(prey->system, &distance_to_origin, "dg", &integrator), DVI_UNSUPPORTED,
          "has no mass");
  refused(create_controlled(prey->system, &distance_to_origin, "vprk:projection=post", &integrator),
          DVI_UNSUPPORTED, "choose dg, dg-phase, dvrk, or vprk with its symmetric projection");
  for (int k = 0; k < 2; k++) {
    integrator = start_paced_integrator(prey, create_controlled, "distance", "vprk:nodes=3");
    run_to(integrator, ldexp(h, -k), prey->order_t_end);
    error[k] = distance(2, dvi_integrator_q(integrator), prey->digits_q);
    dvi_integrator_destroy(&integrator);
  }
  ck_assert_msg(fabs(log2(error[0] / error[1]) - 6) <= 0.5, "%g, %g", error[0], error[1]);
  problem_destroy(&prey);
}
END_TEST

/* Neither by galerkin, which would take the stored coordinates for those of R^n, nor by a method in
 * charts. */
START_TEST(factors_have_no_monitor)
{
  static const char *const method[] = {"galerkin", "lie-galerkin:degree=1", "lie-verlet"};
  problem *body = create_problem("free-body", NULL);
  const dvi_monitor given[] = {read_monitor("arclength"), read_monitor("acceleration"),
                               read_monitor("distance")};
  dvi_integrator *integrator;
  for (int k = 0; k < 9; k++) {
    refused(create_transformed(body->system, &given[k / 3], method[k % 3], &integrator),
            DVI_UNSUPPORTED, "has factors");
    refused(create_controlled(body->system, &given[k / 3], method[k % 3], &integrator),
            DVI_UNSUPPORTED, "has factors");
  }
  problem_destroy(&body);
}
END_TEST

START_TEST(methods_that_choose_their_steps_have_no_monitor_beside_them)
{
  problem *kepler = create_problem("kepler", NULL);
  const dvi_monitor distance = read_monitor("distance");
  dvi_integrator *integrator;
  refused(both[_i](kepler->system, &distance, "sem", &integrator), DVI_UNSUPPORTED,
          "chooses the lengths of its steps itself");
  problem_destroy(&kepler);
}
END_TEST

START_TEST(monitors_of_the_motion_want_a_constant_mass)
{
  problem *pendulum = create_problem("double-pendulum", NULL);
  const dvi_monitor monitors[] = {read_monitor("arclength"), read_monitor("acceleration")};
  dvi_integrator *integrator;
  refused(both[_i](pendulum->system, &monitors[0], "midpoint", &integrator), DVI_UNSUPPORTED,
          "a constant mass is needed");
  refused(both[_i](pendulum->system, &monitors[1], "midpoint", &integrator), DVI_UNSUPPORTED,
          "a constant mass is needed");
  problem_destroy(&pendulum);
}
END_TEST

/* ---- what is declared ---- */

static int constant_one(double t, const double *q, double *g, void *user)
{
  (void)t, (void)q, (void)user;
  *g = 1;
  return 0;
}

static const int two_columns[] = {0, 1, 2};

static const struct {
  dvi_monitor monitor;
  const char *words;
} wrong[] = {
    {{0}, "no value callback"},
    {{.kind = (dvi_monitor_kind)17}, "no kind 17"},
    {{.kind = DVI_MONITOR_DISTANCE, .power = -1}, "power -1"},
    {{.kind = DVI_MONITOR_DISTANCE, .bodies = 3}, "3 points"},
    {{.kind = DVI_MONITOR_DISTANCE, .bodies = 1, .dimension = 3}, "1 points of 3 coordinates"},
    {{.kind = DVI_MONITOR_DISTANCE, .bodies = -2}, "-2 points"},
    {{.kind = DVI_MONITOR_ACCELERATION, .power = HUGE_VAL}, "power inf"},
    {{.kind = DVI_MONITOR_ACCELERATION, .bodies = 2}, "belong to distance alone"},
    {{.kind = DVI_MONITOR_ARCLENGTH, .power = 1}, "belongs to distance or acceleration"},
    {{.function = {.value = constant_one}, .power = 1}, "belongs to distance or acceleration"},
    {{.kind = DVI_MONITOR_ARCLENGTH, .function = {.value = constant_one}},
     "beside a built-in monitor"},
    {{.function = {.value = constant_one, .qq = {two_columns, two_columns}}}, "a pattern is given"},
};
enum { WRONG = sizeof wrong / sizeof *wrong };

START_TEST(a_monitor_that_is_not_well_declared_is_refused)
{
  problem *kepler = create_problem("kepler", NULL);
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = (dvi_integrator *)kepler;
    refused(both[k](kepler->system, &wrong[_i].monitor, "midpoint", &integrator), DVI_BAD_ARGUMENT,
            wrong[_i].words);
    ck_assert_ptr_null(integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

START_TEST(null_arguments_are_refused)
{
  problem *kepler = create_problem("kepler", NULL);
  const dvi_monitor distance = read_monitor("distance");
  dvi_integrator *integrator;
  ck_assert_int_eq(both[_i](kepler->system, NULL, "midpoint", &integrator), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(both[_i](NULL, &distance, "midpoint", &integrator), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(both[_i](kepler->system, &distance, NULL, &integrator), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(both[_i](kepler->system, &distance, "midpoint", NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(both[_i](kepler->system, &distance, "mitpoint", &integrator), DVI_BAD_OPTION);
  ck_assert_int_eq(dvi_integrator_create_like(NULL, &integrator), DVI_BAD_ARGUMENT);
  problem_destroy(&kepler);
}
END_TEST

/* ---- monitors that are not positive ---- */

/* 1 to the right of `edge`, beyond it what is asked for. */
typedef struct cliff {
  double edge, beyond;
} cliff;

static int cliff_value(double t, const double *q, double *g, void *user)
{
  const cliff *c = user;
  (void)t;
  *g = q[0] > c->edge ? 1 : c->beyond;
  return 0;
}

static int cliff_gradient(double t, const double *q, double *g_q, void *user)
{
  (void)t, (void)q, (void)user;
  g_q[0] = g_q[1] = 0;
  return 0;
}

static const double not_positive[] = {0, -1, (double)NAN, (double)INFINITY, 1e-320, -0.0};
enum { NOT_POSITIVE = sizeof not_positive / sizeof *not_positive };

static dvi_integrator *at_cliff(const problem *kepler, paced_create create, cliff *c)
{
  dvi_integrator *integrator;
  const dvi_monitor monitor = {
      .function = {.name = "cliff", .value = cliff_value, .gradient = cliff_gradient, .user = c}};
  ck_assert_msg(create(kepler->system, &monitor, "galerkin", &integrator) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}

START_TEST(a_start_where_the_monitor_is_not_positive_is_refused)
{
  problem *kepler = create_problem("kepler", NULL);
  for (int k = 0; k < 2; k++) {
    cliff c = {1, not_positive[_i]}; /* the start is at x = 0.4 */
    dvi_integrator *integrator = at_cliff(kepler, both[k], &c);
    refused(dvi_integrator_start(integrator, 0, kepler->q, kepler->p), DVI_NOT_FINITE, "cliff");
    refused(dvi_integrator_step(integrator, 0.1), DVI_BAD_STATE, "start");
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

START_TEST(a_step_where_the_monitor_is_not_positive_leaves_the_state_untouched)
{
  problem *kepler = create_problem("kepler", NULL);
  for (int k = 0; k < 2; k++) {
    cliff c = {-0.5, not_positive[_i]};
    dvi_integrator *integrator = at_cliff(kepler, both[k], &c);
    dvi_run_report report;
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, kepler->q, kepler->p), DVI_OK);
    const dvi_status status = dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 6},
                                      &report);
    refused(status, DVI_NOT_FINITE, "cliff");
    check_words("the state is unchanged");
    ck_assert_int_eq(report.end, DVI_RUN_FAILED);
    ck_assert_double_gt(dvi_integrator_q(integrator)[0], -0.5);
    ck_assert_double_gt(dvi_integrator_time(integrator), 0.5);
    const bytes before = read_state(integrator);
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_NOT_FINITE);
    check_state(integrator, before);
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

/* The step past the end evaluates points that the run never reaches. A step that ends beyond the
 * cliff cannot be taken. */
START_TEST(a_failure_past_the_end_does_not_matter)
{
  problem *kepler = create_problem("kepler", NULL);
  double q[2], p[2];
  ck_assert_int_eq(kepler->exact(kepler, 2, q, p), 0);
  for (int k = 0; k < 2; k++) {
    cliff c = {q[0] - 0.01, (double)NAN};
    dvi_integrator *integrator = at_cliff(kepler, both[k], &c);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, kepler->q, kepler->p), DVI_OK);
    run_to(integrator, 0.15, 2);
    ck_assert_double_eq(dvi_integrator_time(integrator), 2);
    ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q), 1e-2);
    refused(dvi_run(integrator, &(dvi_run_options){.h = 0.15, .t_end = 2.1}, NULL), DVI_NOT_FINITE,
            "cliff");
    check_words("the state is unchanged");
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

/* The callback's code counts: a smaller step may mend a positive one, but not a negative one. */
static int moody(double t, const double *q, double *g, void *user)
{
  (void)t;
  *g = 1;
  return q[0] < 0 ? *(const int *)user : 0;
}

START_TEST(what_the_monitor_returns_is_passed_on)
{
  problem *kepler = create_problem("kepler", NULL);
  int answer = _i == 0 ? 1 : -1;
  const dvi_monitor monitor = {.function = {.name = "moody", .value = moody, .user = &answer}};
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(both[k](kepler->system, &monitor, "midpoint", &integrator), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, kepler->q, kepler->p), DVI_OK);
    const dvi_status status = dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 6}, NULL);
    refused(status, answer > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED, "moody");
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

START_TEST(a_control_step_too_large_for_the_monitor_is_refused)
{
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_controlled, "distance:power=4",
                                                      "verlet");
  dvi_run_report report;
  const dvi_status status = dvi_run(integrator, &(dvi_run_options){.h = 500, .t_end = 6}, &report);
  refused(status, DVI_NOT_CONVERGED, "step control: the steps' density z went from");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

/* A failing start leaves E0, too, and the next step is as it would have been. */
START_TEST(a_start_that_fails_leaves_the_state)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_paced_integrator(kepler, both[_i], "distance", "midpoint");
  const double origin[2] = {0, 0};
  advance(integrator, 0.1, 3);
  const bytes before = read_state(integrator);
  ck_assert_int_ne(dvi_integrator_start(integrator, 0, origin, kepler->p), DVI_OK);
  check_state(integrator, before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(steps_of_no_length_are_refused)
{
  static const double lengths[] = {0, (double)NAN, (double)INFINITY, 1e-310};
  problem *kepler = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_paced_integrator(kepler, both[_i], "distance", "midpoint");
  for (int k = 0; k < 4; k++)
    ck_assert_int_eq(dvi_integrator_step(integrator, lengths[k]), DVI_BAD_ARGUMENT);
  refused(dvi_run(integrator, &(dvi_run_options){.h = -0.1, .t_end = 1}, NULL), DVI_BAD_ARGUMENT,
          "leads away");
  dvi_integrator_destroy(&integrator);
  ck_assert_int_eq(both[_i](kepler->system, &(dvi_monitor){.kind = DVI_MONITOR_DISTANCE},
                            "midpoint", &integrator),
                   DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 1e9, kepler->q, kepler->p), DVI_OK);
  /* by less than a rounding */
  refused(dvi_integrator_step(integrator, 1e-9), DVI_BAD_ARGUMENT, "does not move the time");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

/* ---- memory ---- */

static void check_survives(const problem *model, paced_create create, const char *monitor,
                           const char *method)
{
  const dvi_monitor chosen = read_monitor(monitor);
  /* the first one completes the system */
  dvi_integrator *integrator = start_paced_integrator(model, create, monitor, method);
  dvi_integrator_destroy(&integrator);
  const long before = dvi__allocation_count();
  integrator = start_paced_integrator(model, create, monitor, method);
  const long needed = dvi__allocation_count() - before;
  dvi_integrator_destroy(&integrator);
  const long bytes_before = heap_bytes();
  for (long successes = 0; successes < needed; successes++) {
    integrator = (dvi_integrator *)(uintptr_t)model;
    dvi__fail_allocations_after(successes);
    const dvi_status status = create(model->system, &chosen, method, &integrator);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_NO_MEMORY, "%ld of %ld: %s", successes, needed, dvi_last_error());
    ck_assert_ptr_null(integrator);
  }
  ck_assert_int_eq(heap_bytes(), bytes_before);
}

START_TEST(creation_survives_every_failure_of_memory)
{
  problem *kepler = create_problem("kepler", NULL);
  check_survives(kepler, create_transformed, "distance", "galerkin");
  check_survives(kepler, create_transformed, "arclength", "composition:base=midpoint");
  check_survives(kepler, create_controlled, "acceleration", "verlet");
  problem_destroy(&kepler);
}
END_TEST

SUITE(transform_failure)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, a_system_that_may_depend_on_time_is_not_transformed);
  tcase_add_test(tests, explicit_methods_are_not_transformed);
  tcase_add_test(tests, control_wants_a_symmetric_method);
  tcase_add_test(tests, a_one_form_takes_control_alone);
  tcase_add_test(tests, factors_have_no_monitor);
  tcase_add_loop_test(tests, methods_that_choose_their_steps_have_no_monitor_beside_them, 0, 2);
  tcase_add_loop_test(tests, monitors_of_the_motion_want_a_constant_mass, 0, 2);
  tcase_add_loop_test(tests, a_monitor_that_is_not_well_declared_is_refused, 0, WRONG);
  tcase_add_loop_test(tests, null_arguments_are_refused, 0, 2);
  tcase_add_loop_test(tests, a_start_where_the_monitor_is_not_positive_is_refused, 0, NOT_POSITIVE);
  tcase_add_loop_test(tests, a_step_where_the_monitor_is_not_positive_leaves_the_state_untouched, 0,
                      NOT_POSITIVE);
  tcase_add_test(tests, a_failure_past_the_end_does_not_matter);
  tcase_add_loop_test(tests, what_the_monitor_returns_is_passed_on, 0, 2);
  tcase_add_test(tests, a_control_step_too_large_for_the_monitor_is_refused);
  tcase_add_loop_test(tests, a_start_that_fails_leaves_the_state, 0, 2);
  tcase_add_loop_test(tests, steps_of_no_length_are_refused, 0, 2);
  tcase_add_test(tests, creation_survives_every_failure_of_memory);
}
