/* Work against error by dvi_study_work, and the parts that studies share. */
#include <dvi/study.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

static problem *model;
static double end[2], momentum[2];
static dvi_study_runs runs;

static void set_up(void)
{
  model = create_problem("kepler", NULL);
  ck_assert_int_eq(model->exact(model, 1.0, end, momentum), 0);
  runs = (dvi_study_runs){
      .size = sizeof runs, .t_end = 1.0, .q = model->q, .p = model->p, .end = end};
}

static void tear_down(void)
{
  problem_destroy(&model);
}

START_TEST(jobs_have_errors_work_and_times)
{
  dvi_study_job job[] = {{.method = "verlet", .h = 0.05},
                         {.method = "verlet", .h = 0.025},
                         {.method = "galerkin:degree=2", .h = 0.05}};
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 3, job, 2), DVI_OK);
  for (int i = 0; i < 3; i++) {
    ck_assert_int_eq(job[i].status, DVI_OK);
    ck_assert(job[i].error > 0.0);
    ck_assert(job[i].seconds.least > 0.0 && job[i].seconds.least <= job[i].seconds.median);
    ck_assert(job[i].seconds.lower <= job[i].seconds.upper);
    ck_assert_int_eq(job[i].counters.steps, i == 1 ? 40 : 20);
  }
  ck_assert_double_le(fabs(log2(job[0].error / job[1].error) - 2.0), 0.1);
  ck_assert_double_lt(job[2].error, job[1].error);
}
END_TEST

START_TEST(a_job_without_a_result_leaves_the_others)
{
  dvi_study_job job[] = {{.method = "midpoint", .h = 1.5625}, {.method = "midpoint", .h = 5.0}};
  runs.t_end = 500.0;
  const dvi_status status = dvi_study_work(model->system, &runs, 2, job, 1);
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(job[0].status, 0);
  ck_assert(job[0].error == 0.0 && job[0].seconds.least == 0.0 && job[0].counters.steps == 0);
}
END_TEST

START_TEST(bad_input_is_refused)
{
  dvi_study_job job = {.method = "verlet", .h = 0.1};
  ck_assert_int_eq(dvi_study_work(NULL, &runs, 1, &job, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_work(model->system, NULL, 1, &job, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 0, &job, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, NULL, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, &job, 0), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, &job, DVI_STUDY_ROUNDS_MAX + 1),
                   DVI_BAD_ARGUMENT);
  static const double bad[] = {0.0, -0.1, (double)NAN, (double)INFINITY, 1e-300};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    job.h = bad[i];
    ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, &job, 1), DVI_BAD_ARGUMENT);
    check_words("job 0");
  }
  job = (dvi_study_job){.method = "nothing", .h = 0.1};
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, &job, 1), DVI_BAD_OPTION);
  runs.end = NULL;
  ck_assert_int_eq(dvi_study_work(model->system, &runs, 1, &job, 1), DVI_BAD_ARGUMENT);
  check_words("one of end, exact and reference");
}
END_TEST

START_TEST(lack_of_memory_anywhere_is_a_status)
{
  dvi_status status = DVI_NO_MEMORY;
  int without = 0;
  runs.end = NULL;
  runs.reference = 1;
  runs.t_end = 0.1;
  for (; status != DVI_OK; without++) {
    dvi_study_job job = {.method = "verlet", .h = 0.05};
    dvi__fail_allocations_after(without);
    status = dvi_study_work(model->system, &runs, 1, &job, 1);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
  }
  ck_assert_int_gt(without, 4);
}
END_TEST

/* ---- shared parts ---- */

START_TEST(a_fit_leaves_out_levels_without_the_slope)
{
  double h[8], error[8];
  dvi_order_fit fit;
  for (int k = 0; k < 8; k++) {
    h[k] = pow(2.0, -k);
    error[k] = pow(h[k], 3.0) * (k < 2 ? 3.0 : 1.0) + 1e-12;
  }
  ck_assert_int_ne(dvi_study_fit(8, h, error, 1e-15, 1e3, &fit), 0);
  ck_assert_int_eq(fit.first, 2);
  ck_assert_int_eq(fit.last, 7);
  ck_assert_double_le(fabs(fit.slope - 3.0), 1e-4);
  ck_assert_int_eq(dvi_study_fit(3, h, error, 1e-15, 1e3, &fit), 0);
}
END_TEST

START_TEST(an_odd_number_of_measurements)
{
  double sample[] = {5, 1, 4, 2, 3};
  const dvi_study_spread s = dvi_study_spread_of(5, sample);
  ck_assert_double_eq(s.lower, 2);
  ck_assert_double_eq(s.median, 3);
  ck_assert_double_eq(s.upper, 4);
}
END_TEST

START_TEST(between_two_measurements_they_are_interpolated)
{
  double sample[] = {40, 10, 30, 20};
  const dvi_study_spread s = dvi_study_spread_of(4, sample);
  ck_assert_double_eq(s.least, 10);
  ck_assert_double_eq(s.lower, 17.5);
  ck_assert_double_eq(s.median, 25);
  ck_assert_double_eq(s.upper, 32.5);
}
END_TEST

START_TEST(one_measurement_is_all_of_them)
{
  double sample[] = {7};
  const dvi_study_spread s = dvi_study_spread_of(1, sample);
  ck_assert_double_eq(s.lower, 7);
  ck_assert_double_eq(s.median, 7);
  ck_assert_double_eq(s.upper, 7);
}
END_TEST

START_TEST(an_outlier_moves_neither_median_nor_quartiles)
{
  double sample[] = {1, 2, 3, 4, 1e9};
  const dvi_study_spread s = dvi_study_spread_of(5, sample);
  ck_assert_double_eq(s.median, 3);
  ck_assert_double_eq(s.upper, 4);
}
END_TEST

START_TEST(short_runs_are_repeated_for_the_clock)
{
  ck_assert_int_eq(dvi_study_repeats(1.0), 1);
  ck_assert_int_eq(dvi_study_repeats(0.01), 2);
  ck_assert_int_eq(dvi_study_repeats(0.0), 1000000);
}
END_TEST

SUITE(study_work)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, jobs_have_errors_work_and_times);
  tcase_add_test(tests, a_job_without_a_result_leaves_the_others);
  tcase_add_test(tests, bad_input_is_refused);
  tcase_add_test(tests, lack_of_memory_anywhere_is_a_status);
  tcase_add_test(tests, a_fit_leaves_out_levels_without_the_slope);
  tcase_add_test(tests, an_odd_number_of_measurements);
  tcase_add_test(tests, between_two_measurements_they_are_interpolated);
  tcase_add_test(tests, one_measurement_is_all_of_them);
  tcase_add_test(tests, an_outlier_moves_neither_median_nor_quartiles);
  tcase_add_test(tests, short_runs_are_repeated_for_the_clock);
}
