/* labels: order */
/* Order studies by dvi_study_order. */
#include <dvi/study.h>
#include <math.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

enum { LEVELS = 5 };

static problem *model;
static dvi_study_level level[DVI_STUDY_LEVELS_MAX];
static dvi_study_order_result result;

static void set_up(void)
{
  model = create_problem("kepler", NULL);
}

static void tear_down(void)
{
  problem_destroy(&model);
}

static dvi_study_runs runs_to(double t_end)
{
  return (dvi_study_runs){
      .size = sizeof(dvi_study_runs), .t_end = t_end, .q = model->q, .p = model->p};
}

static const dvi_study_order_options usual = {
    .size = sizeof(dvi_study_order_options), .h = 0.05, .levels = LEVELS, .once = 1};

static dvi_status study(const char *method, const dvi_study_runs *runs)
{
  return dvi_study_order(model->system, method, runs, &usual, level, &result);
}

static int exact(double t, double *q, void *user)
{
  double p[2];
  (void)user;
  return model->exact(model, t, q, p);
}

static int failing(double t, double *q, void *user)
{
  (void)t;
  (void)q;
  (void)user;
  return 1;
}

static void check_order(int claimed)
{
  ck_assert_int_eq(result.levels, LEVELS);
  ck_assert_int_eq(result.claimed, claimed);
  ck_assert(result.settled && result.holds);
  ck_assert_double_le(fabs(result.order - claimed), 0.2);
  for (int k = 0; k < LEVELS; k++) {
    ck_assert_int_eq(level[k].steps, 20L << k);
    ck_assert_int_eq(level[k].counters.steps, level[k].steps);
    ck_assert_double_le(fabs(level[k].h * (double)level[k].steps - 1.0), 1e-15);
    ck_assert(level[k].error > 0.0 && level[k].seconds > 0.0 && level[k].energy_error > 0.0);
    if (k > 0) ck_assert_double_le(fabs(level[k].slope - claimed), 0.3);
  }
  ck_assert(level[0].slope == 0.0);
}

/* ---- what the errors are measured against ---- */

START_TEST(neighbouring_levels_show_the_order)
{
  const dvi_study_runs runs = runs_to(1.0);
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  check_order(2);
}
END_TEST

START_TEST(an_exact_solution_shows_the_order)
{
  dvi_study_runs runs = runs_to(1.0);
  runs.exact = exact;
  ck_assert_int_eq(study("galerkin:degree=2", &runs), DVI_OK);
  check_order(4);
  double q[2], p[2];
  ck_assert_int_eq(model->exact(model, 1.0, q, p), 0);
  const double error = level[1].error;
  runs.exact = NULL;
  runs.end = q;
  ck_assert_int_eq(study("galerkin:degree=2", &runs), DVI_OK);
  ck_assert_double_eq(level[1].error, error);
}
END_TEST

START_TEST(the_reference_shows_the_order_and_bounds_the_floor)
{
  dvi_study_runs runs = runs_to(1.0);
  runs.reference = 1;
  runs.p = NULL;
  runs.v = model->v;
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  check_order(2);
  ck_assert(result.judge_error > 0.0 && result.floor >= 10.0 * result.judge_error);
}
END_TEST

START_TEST(a_run_back_in_time_has_the_order)
{
  const dvi_study_runs runs = runs_to(-1.0);
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  check_order(2);
}
END_TEST

START_TEST(the_error_is_that_of_single_steps)
{
  dvi_study_runs runs = runs_to(1.0);
  runs.exact = exact;
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  double q[2], p[2], energy, first, change = 0.0;
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  for (int i = 0; i < 20; i++) {
    advance(integrator, 0.05, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
    change = fmax(change, fabs(energy - first));
  }
  ck_assert_int_eq(model->exact(model, 1.0, q, p), 0);
  ck_assert_double_le(fabs(level[0].error - distance(2, dvi_integrator_q(integrator), q)), 1e-13);
  ck_assert_double_le(fabs(level[0].energy_error - change), 1e-13);
  dvi_integrator_destroy(&integrator);
}
END_TEST

/* ---- the decision ---- */

START_TEST(errors_of_roundings_alone_show_no_order)
{
  const dvi_study_runs runs = runs_to(0.5);
  const dvi_study_order_options few = {
      .size = sizeof few, .h = 0.05, .ratio = 1.5, .levels = 4, .once = 1};
  ck_assert_int_eq(dvi_study_order(model->system, "galerkin:degree=8", &runs, &few, level, &result),
                   DVI_OK);
  ck_assert_int_eq(result.levels, 4);
  ck_assert(!result.settled && !result.holds && !isnan(result.order));
  ck_assert_int_eq(level[1].steps, 15);
}
END_TEST

START_TEST(a_run_that_fails_names_its_step_and_keeps_the_levels_before)
{
  const dvi_study_runs runs = runs_to(1.0);
  ck_assert_int_eq(study("midpoint:solver=no", &runs), DVI_BAD_OPTION);
  ck_assert_int_eq(result.levels, 0);
  ck_assert_int_eq(result.first, -1);
  const dvi_study_order_options rough = {.size = sizeof rough, .h = 100.0, .once = 1};
  const dvi_study_runs far = runs_to(500.0);
  const dvi_status status = dvi_study_order(model->system, "midpoint", &far, &rough, level,
                                            &result);
  ck_assert_int_gt(status, 0);
  check_words("study of midpoint at h = ");
  ck_assert_int_lt(result.levels, 6);
  ck_assert(!result.settled && result.order == 0.0);
}
END_TEST

/* ---- bad input ---- */

START_TEST(bad_runs_are_refused)
{
  dvi_study_runs runs = runs_to(1.0);
  ck_assert_int_eq(study("verlet", NULL), DVI_BAD_ARGUMENT);
  runs.size = 1;
  ck_assert_int_eq(study("verlet", &runs), DVI_BAD_ARGUMENT);
  check_words("sizeof(dvi_study_runs)");
  runs = runs_to(0.0);
  ck_assert_int_eq(study("verlet", &runs), DVI_BAD_ARGUMENT);
  check_words("another end");
  runs = runs_to((double)NAN);
  ck_assert_int_eq(study("verlet", &runs), DVI_NOT_FINITE);
  runs = runs_to(1.0);
  runs.v = model->v;
  ck_assert_int_eq(study("verlet", &runs), DVI_BAD_ARGUMENT);
  check_words("either p or v");
  runs = runs_to(1.0);
  runs.end = model->q;
  runs.reference = 1;
  ck_assert_int_eq(study("verlet", &runs), DVI_BAD_ARGUMENT);
  check_words("one of end, exact and reference");
}
END_TEST

START_TEST(a_solution_that_fails_or_is_not_finite_is_refused)
{
  const double end[2] = {1.0, (double)NAN};
  dvi_study_runs runs = runs_to(1.0);
  runs.exact = failing;
  ck_assert_int_eq(study("verlet", &runs), DVI_CALLBACK_FAILED);
  runs.exact = NULL;
  runs.end = end;
  ck_assert_int_eq(study("verlet", &runs), DVI_NOT_FINITE);
  check_words("q[1]");
}
END_TEST

START_TEST(without_a_step_the_levels_are_searched_for)
{
  static const char *const method[] = {"verlet", "galerkin:degree=2", "galerkin:degree=4"};
  static const int claimed[] = {2, 4, 8};
  const dvi_study_order_options search = {.size = sizeof search, .levels = LEVELS, .once = 1};
  dvi_study_runs runs = runs_to(1.0);
  runs.exact = exact;
  for (int i = 0; i < 3; i++) {
    ck_assert_int_eq(dvi_study_order(model->system, method[i], &runs, &search, level, &result),
                     DVI_OK);
    ck_assert(result.levels == LEVELS && result.holds && result.claimed == claimed[i]);
    ck_assert_double_le(fabs(result.order - claimed[i]), 0.2);
    for (int k = 0; k < LEVELS; k++)
      ck_assert(level[k].error > result.floor && level[k].error < result.ceiling);
  }
  runs.exact = NULL;
  ck_assert_int_eq(dvi_study_order(model->system, "verlet", &runs, &search, level, &result),
                   DVI_BAD_ARGUMENT);
  check_words("a search for steps needs one of end, exact and reference");
}
END_TEST

/* Set when the solution is asked for. */
static volatile int cancelling;

static int exact_and_cancel(double t, double *q, void *user)
{
  cancelling = 1;
  return exact(t, q, user);
}

START_TEST(a_cancelled_study_keeps_no_fit)
{
  const dvi_study_order_options search = {.size = sizeof search, .once = 1};
  dvi_study_runs runs = runs_to(1.0);
  runs.cancel = &cancelling;
  runs.exact = exact;
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  ck_assert(!result.cancelled && result.levels == LEVELS);
  runs.exact = exact_and_cancel;
  ck_assert_int_eq(study("verlet", &runs), DVI_OK);
  ck_assert(result.cancelled && result.levels == 0 && result.first == -1 && !result.holds);
  ck_assert_int_eq(dvi_study_order(model->system, "verlet", &runs, &search, level, &result),
                   DVI_OK);
  ck_assert(result.cancelled && result.levels == 0);
  dvi_study_job job[2] = {{.method = "verlet", .h = 0.1}, {.method = "midpoint", .h = 0.1}};
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 2, job, 3), DVI_OK);
  for (int i = 0; i < 2; i++)
    ck_assert(job[i].cancelled && job[i].error == 0.0 && job[i].seconds.upper == 0.0);
  cancelling = 0;
}
END_TEST

/* A rule whose error is that of an order, but with more than 100 parts. */
static dvi_status failing_rule(double parts, double *error, void *user)
{
  const int *order = user;
  *error = pow(parts, -*order);
  return parts > 100.0 ? DVI_CALLBACK_FAILED : DVI_OK;
}

START_TEST(levels_of_anything_are_searched_for)
{
  int order = 6;
  dvi_study_search wanted = {.size = sizeof wanted,
                             .levels = 5,
                             .order = order,
                             .span = 1.0,
                             .size_of_result = 1.0,
                             .run = failing_rule,
                             .user = &order};
  dvi_study_levels found;
  ck_assert_int_eq(dvi_study_search_levels(&wanted, &found), DVI_OK);
  ck_assert_int_ne(found.room, 0);
  for (int k = 0; k < 5; k++) {
    ck_assert(k == 0 || found.parts[k] > found.parts[k - 1]);
    ck_assert_double_gt(pow((double)found.parts[k], -order), found.floor);
  }
  wanted.order = order = 1;
  ck_assert_int_eq(dvi_study_search_levels(&wanted, &found), DVI_CALLBACK_FAILED);
  wanted.size_of_result = (double)NAN;
  ck_assert_int_eq(dvi_study_search_levels(&wanted, &found), DVI_BAD_ARGUMENT);
  wanted.size_of_result = 1.0;
  wanted.levels = DVI_STUDY_LEVELS_MAX + 1;
  ck_assert_int_eq(dvi_study_search_levels(&wanted, &found), DVI_BAD_ARGUMENT);
  wanted.levels = 5;
  wanted.length = -1.0;
  ck_assert_int_eq(dvi_study_search_levels(&wanted, &found), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_search_levels(NULL, &found), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(bad_options_are_refused)
{
  static const dvi_study_order_options bad[] = {
      {.size = 1, .h = 0.1},
      {.size = sizeof *bad},
      {.size = sizeof *bad, .h = -0.1},
      {.size = sizeof *bad, .h = (double)NAN},
      {.size = sizeof *bad, .h = 0.1, .ratio = 1.0},
      {.size = sizeof *bad, .h = 0.1, .ratio = (double)INFINITY},
      {.size = sizeof *bad, .h = 0.1, .levels = 1},
      {.size = sizeof *bad, .h = 0.1, .levels = DVI_STUDY_LEVELS_MAX + 1},
      {.size = sizeof *bad, .h = 0.1, .levels = DVI_STUDY_LEVELS_MAX},
      {.size = sizeof *bad, .h = 1e-300}};
  const dvi_study_runs runs = runs_to(1.0);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    ck_assert_int_eq(dvi_study_order(model->system, "verlet", &runs, &bad[i], level, &result),
                     DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_order(model->system, NULL, &runs, &usual, level, &result),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_order(NULL, "verlet", &runs, &usual, level, &result),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_order(model->system, "verlet", &runs, &usual, NULL, &result),
                   DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(lack_of_memory_anywhere_is_a_status)
{
  dvi_study_runs runs = runs_to(0.1);
  const dvi_study_order_options two = {.size = sizeof two, .h = 0.05, .levels = 2, .once = 1};
  dvi_status status = DVI_NO_MEMORY;
  int without = 0;
  runs.exact = exact;
  for (; status != DVI_OK; without++) {
    dvi__fail_allocations_after(without);
    status = dvi_study_order(model->system, "verlet", &runs, &two, level, &result);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
  }
  ck_assert_int_gt(without, 3);
}
END_TEST

SUITE(study_order)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, neighbouring_levels_show_the_order);
  tcase_add_test(tests, an_exact_solution_shows_the_order);
  tcase_add_test(tests, the_reference_shows_the_order_and_bounds_the_floor);
  tcase_add_test(tests, a_run_back_in_time_has_the_order);
  tcase_add_test(tests, the_error_is_that_of_single_steps);
  tcase_add_test(tests, errors_of_roundings_alone_show_no_order);
  tcase_add_test(tests, a_run_that_fails_names_its_step_and_keeps_the_levels_before);
  tcase_add_test(tests, bad_runs_are_refused);
  tcase_add_test(tests, a_solution_that_fails_or_is_not_finite_is_refused);
  tcase_add_test(tests, without_a_step_the_levels_are_searched_for);
  tcase_add_test(tests, a_cancelled_study_keeps_no_fit);
  tcase_add_test(tests, levels_of_anything_are_searched_for);
  tcase_add_test(tests, bad_options_are_refused);
  tcase_add_test(tests, lack_of_memory_anywhere_is_a_status);
}
