/* labels: unit */
/* Runs that have no derivatives are refused with the reason, and failures leave no NaN. */
#include <dvi/dvi.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/machine.h"

static machine m;
static dvi_system *oscillating;

static void set_up(void)
{
  m = straight_machine;
  oscillating = machine_system(&m);
}

static void tear_down(void)
{
  dvi_system_destroy(&oscillating);
}

static void refused(const dvi_system *system, const char *method, const dvi_dependence *dependence,
                    dvi_status expected, const char *words)
{
  dvi_sensitivity *run = (dvi_sensitivity *)&m; /* must become NULL */
  const dvi_status status = dvi_sensitivity_create(system, method, dependence, &run);
  ck_assert_msg(status == expected, "%s: %s", dvi_status_name(status), dvi_last_error());
  ck_assert_ptr_null(run);
  check_words(words);
}

START_TEST(methods_without_derivatives_are_refused)
{
  refused(oscillating, "composition:order=4", NULL, DVI_BAD_OPTION, "no discrete action");
  refused(oscillating, "galerkin:degree=2,solver=kinsol", NULL, DVI_BAD_OPTION, "solver=kinsol");
  refused(oscillating, "nothing", NULL, DVI_BAD_OPTION, "nothing");
  refused(NULL, "midpoint", NULL, DVI_BAD_ARGUMENT, "NULL");
  ck_assert_int_eq(dvi_sensitivity_create(oscillating, "midpoint", NULL, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(other_terms_are_refused)
{
  static const struct {
    const char *problem, *method, *term;
  } others[] = {{"lotka-volterra", "vprk", "declares a one-form"},
                {"free-body", "lie-galerkin", "declares bodies, rotations, directions or angles"},
                {"slider-crank", "galerkin", "declares holonomic constraints"}};
  for (int k = 0; k < 3; k++) {
    problem *model = create_problem(others[k].problem, NULL);
    refused(model->system, others[k].method, NULL, DVI_UNSUPPORTED, others[k].term);
    problem_destroy(&model);
  }
}
END_TEST

START_TEST(dependences_without_callbacks_are_refused)
{
  refused(oscillating, "midpoint", &(dvi_dependence){.count = 1}, DVI_BAD_ARGUMENT,
          "without their derivative");
  refused(oscillating, "midpoint", &(dvi_dependence){.count = -1}, DVI_BAD_ARGUMENT,
          "-1 parameters");
}
END_TEST

static int answer;
static double number;

static int any_dependence(double t, const double *q, const double *v, double *in_q, double *in_v,
                          void *user)
{
  (void)t, (void)q, (void)v, (void)in_v, (void)user;
  in_q[0] = number;
  return answer;
}

static int any_end(double t, const double *q, const double *p, double *value, double *by_q,
                   double *by_p, double *by_theta, void *user)
{
  (void)t, (void)p, (void)by_p, (void)by_theta, (void)user;
  *value = q[0];
  by_q[0] = number;
  return answer;
}

/* A failing callback, or one that returns NaN, fails the step or the gradient, and the run has no
 * tangents until it is started again. */
START_TEST(failures_of_callbacks_are_told)
{
  static const struct {
    int answer;
    double number;
    dvi_status expected;
  } cases[] = {{1, 0, DVI_CALLBACK_RETRY}, {-1, 0, DVI_CALLBACK_FAILED}, {0, NAN, DVI_NOT_FINITE}};
  const dvi_dependence dependence = {1, any_dependence, NULL};
  const double q[] = {0.7, -0.3}, p[] = {0.4, 0.9};
  dvi_sensitivity *run = NULL;
  ck_assert_int_eq(dvi_sensitivity_create(oscillating, "midpoint", &dependence, &run), DVI_OK);
  ck_assert_int_eq(dvi_sensitivity_step(run, 0.1), DVI_BAD_STATE);
  ck_assert_ptr_null(dvi_sensitivity_tangent(run));
  for (int k = 0; k < 3; k++) {
    answer = 0, number = 1;
    ck_assert_int_eq(dvi_sensitivity_start(run, 0, q, p), DVI_OK);
    ck_assert_int_eq(dvi_sensitivity_step(run, 0.1), DVI_OK);
    answer = cases[k].answer, number = cases[k].number;
    ck_assert_int_eq(dvi_sensitivity_step(run, 0.1), cases[k].expected);
    ck_assert_ptr_null(dvi_sensitivity_tangent(run));
    ck_assert(isnan(dvi_sensitivity_time(run)));
  }
  const dvi_run_plan plan = {0, 0.1, 5, q, p};
  const dvi_objective objective = {.end = any_end};
  dvi_gradient gradient = {.value = 7};
  for (int k = 0; k < 3; k++) {
    answer = cases[k].answer, number = cases[k].number;
    ck_assert_int_eq(dvi_sensitivity_gradient(run, &plan, &objective, &gradient),
                     cases[k].expected);
    ck_assert_double_eq(gradient.value, 7);
  }
  const dvi_run_plan none = {0, 0.1, 0, q, p};
  ck_assert_int_eq(dvi_sensitivity_gradient(run, &none, &objective, &gradient), DVI_BAD_ARGUMENT);
  const dvi_run_plan still = {0, 0, 5, q, p};
  ck_assert_int_eq(dvi_sensitivity_gradient(run, &still, &objective, &gradient), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_sensitivity_gradient(run, NULL, &objective, &gradient), DVI_BAD_ARGUMENT);
  dvi_sensitivity_destroy(&run);
}
END_TEST

/* A failed step of the integrator leaves state and tangents as they were. */
START_TEST(a_failed_step_changes_nothing)
{
  const double q[] = {0.7, -0.3}, p[] = {0.4, 0.9};
  dvi_sensitivity *run = NULL;
  ck_assert_int_eq(dvi_sensitivity_create(oscillating, "midpoint", NULL, &run), DVI_OK);
  ck_assert_int_eq(dvi_sensitivity_start(run, 0, q, p), DVI_OK);
  ck_assert_int_ne(dvi_sensitivity_step(run, NAN), DVI_OK);
  ck_assert_int_ne(dvi_sensitivity_step(run, 0), DVI_OK);
  ck_assert_double_eq(dvi_sensitivity_q(run)[0], q[0]);
  ck_assert_double_eq(dvi_sensitivity_tangent(run)[0], 1);
  ck_assert_double_eq(dvi_sensitivity_time(run), 0);
  dvi_sensitivity_destroy(&run);
}
END_TEST

SUITE(refusals)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, methods_without_derivatives_are_refused);
  tcase_add_test(tests, other_terms_are_refused);
  tcase_add_test(tests, dependences_without_callbacks_are_refused);
  tcase_add_test(tests, failures_of_callbacks_are_told);
  tcase_add_test(tests, a_failed_step_changes_nothing);
}
