/* Runs at all points of a grid by dvi_study_sweep. */
#include <dvi/study.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STARTS = 3, STEPS = 4, POINTS = STARTS * STEPS };

/* What a sweep of the pendulum found. */
typedef struct findings {
  problem *model;
  dvi_study_sweep_options options;
  int rows, count[POINTS];
  double t[POINTS], end[POINTS], momentum[POINTS], energy[POINTS], error[POINTS];
  double least[POINTS], most[POINTS];
  dvi_status status[POINTS];
  long steps[POINTS];
  int refuse_from;     /* `found` refuses rows from this one on. 0: it does not */
  int spoilt;          /* point that cannot be opened */
  volatile int cancel; /* set by `found` after `cancel_after` rows, if that is not 0 */
  int cancel_after;
} findings;

static const double start[STARTS] = {0.5, 1.0, 3.0}, step[STEPS] = {0.01, 0.02, 0.05, 0.1};
static const dvi_study_axis axes[] = {{.count = STARTS, .value = start},
                                      {.count = STEPS, .value = step}};
static findings found;

static dvi_status open_point(const dvi_study_point *point, dvi_study_run *run, void *user)
{
  const findings *f = user;
  const double p = 0.1;
  if (point->number == f->spoilt) return DVI_BAD_SIZE;
  run->options = (dvi_run_options){.h = point->value[1], .t_end = 1.0};
  const dvi_status status = dvi_integrator_create(f->model->system, "verlet", &run->integrator);
  return status == DVI_OK ? dvi_integrator_start(run->integrator, 0.0, &point->value[0], &p)
                          : status;
}

static int take_row(const dvi_study_point *point, const dvi_study_run *run,
                    const dvi_study_row *row, void *user)
{
  findings *f = user;
  const int k = (int)point->number;
  (void)run;
  if (f->refuse_from > 0 && f->rows + 1 >= f->refuse_from) return 1;
  f->rows++;
  f->count[k]++;
  f->status[k] = row->status;
  f->steps[k] = row->report.steps;
  f->t[k] = row->t;
  f->error[k] = row->energy_error;
  if (row->q == NULL) return 0;
  f->end[k] = row->q[0];
  f->momentum[k] = row->p[0];
  if (row->invariant != NULL) f->energy[k] = row->invariant[0];
  if (row->least != NULL) f->least[k] = row->least[0];
  if (row->most != NULL) f->most[k] = row->most[0];
  if (f->rows == f->cancel_after) f->cancel = 1;
  return 0;
}

static void reset(findings *f, problem *model)
{
  *f = (findings){.model = model,
                  .spoilt = -1,
                  .options = {.size = sizeof f->options,
                              .axes = 2,
                              .axis = axes,
                              .open = open_point,
                              .found = take_row,
                              .user = f,
                              .cancel = &f->cancel}};
}

static void set_up(void)
{
  reset(&found, create_problem("pendulum", NULL));
}

static void tear_down(void)
{
  problem_destroy(&found.model);
}

/* Require that a point has the bits of a run by itself. */
static void check_alone(int k)
{
  const double p = 0.1, h = step[k % STEPS];
  dvi_integrator *alone = NULL;
  ck_assert_int_eq(dvi_integrator_create(found.model->system, "verlet", &alone), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(alone, 0.0, &start[k / STEPS], &p), DVI_OK);
  const dvi_run_options run = {.h = h, .t_end = 1.0};
  ck_assert_int_eq(dvi_run(alone, &run, NULL), DVI_OK);
  ck_assert(dvi_integrator_q(alone)[0] == found.end[k]);
  ck_assert(dvi_integrator_p(alone)[0] == found.momentum[k]);
  ck_assert(dvi_integrator_time(alone) == found.t[k]);
  dvi_integrator_destroy(&alone);
}

START_TEST(points_have_the_bits_of_runs_by_themselves)
{
  dvi_study_sweep_report report;
  found.options.extremes = 1;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, POINTS);
  ck_assert_int_eq(report.failed, 0);
  ck_assert_int_eq(report.cancelled, 0);
  for (int k = 0; k < POINTS; k++) {
    ck_assert_int_eq(found.count[k], 1);
    check_alone(k);
    ck_assert(found.error[k] > 0.0 && found.error[k] < 1e-2);
    ck_assert(found.least[k] <= found.end[k] && found.end[k] <= found.most[k]);
    ck_assert(found.least[k] <= start[k / STEPS] && start[k / STEPS] <= found.most[k]);
  }
  ck_assert_double_lt(found.error[0], found.error[3]);
}
END_TEST

START_TEST(threads_and_parts_change_no_bit)
{
  static findings other;
  ck_assert_int_eq(dvi_study_sweep(&found.options, NULL), DVI_OK);
  reset(&other, found.model);
  other.options.threads = 3;
  other.options.parts = 5;
  for (int part = 0; part < 5; part++) {
    other.options.part = part;
    ck_assert_int_eq(dvi_study_sweep(&other.options, NULL), DVI_OK);
    for (int k = 0; k < POINTS; k++) ck_assert_int_eq(other.count[k], k % 5 <= part);
  }
  ck_assert_mem_eq(other.end, found.end, sizeof found.end);
  ck_assert_mem_eq(other.momentum, found.momentum, sizeof found.momentum);
  ck_assert_mem_eq(other.energy, found.energy, sizeof found.energy);
  ck_assert_mem_eq(other.error, found.error, sizeof found.error);
}
END_TEST

START_TEST(points_are_left_out)
{
  char skip[POINTS] = {[1] = 1, [2] = 1, [11] = 1};
  dvi_study_sweep_report report;
  found.options.skip = skip;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, POINTS - 3);
  for (int k = 0; k < POINTS; k++) ck_assert_int_eq(found.count[k], !skip[k]);
}
END_TEST

START_TEST(a_point_that_cannot_be_opened_leaves_the_others)
{
  dvi_study_sweep_report report;
  found.spoilt = 4;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, POINTS);
  ck_assert_int_eq(report.failed, 1);
  for (int k = 0; k < POINTS; k++)
    ck_assert_int_eq(found.status[k], k == 4 ? DVI_BAD_SIZE : DVI_OK);
  ck_assert(isnan(found.t[4]) && isnan(found.error[4]) && found.steps[4] == 0);
  check_alone(5);
}
END_TEST

START_TEST(a_run_that_fails_has_its_status_in_its_row)
{
  const double away[] = {0.05, -0.05};
  const dvi_study_axis spoilt[] = {{.count = 1, .value = start}, {.count = 2, .value = away}};
  dvi_study_sweep_report report;
  found.options.axis = spoilt;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, 2);
  ck_assert_int_eq(report.failed, 1);
  ck_assert_int_eq(found.status[0], DVI_OK);
  ck_assert_int_eq(found.status[1], DVI_BAD_ARGUMENT);
  ck_assert(found.t[1] == 0.0 && found.steps[1] == 0);
}
END_TEST

START_TEST(a_row_that_is_refused_ends_the_sweep)
{
  dvi_study_sweep_report report;
  found.refuse_from = 3;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_CALLBACK_FAILED);
  check_words("the row of point 2");
  ck_assert_int_eq(found.rows, 2);
}
END_TEST

START_TEST(a_cancelled_sweep_keeps_the_rows_before)
{
  dvi_study_sweep_report report;
  found.cancel_after = 5;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, 5);
  ck_assert_int_ne(report.cancelled, 0);
  found.cancel_after = 0;
  found.options.skip = NULL;
  ck_assert_int_eq(dvi_study_sweep(&found.options, &report), DVI_OK);
  ck_assert_int_eq(report.rows, 0);
  ck_assert_int_ne(report.cancelled, 0);
}
END_TEST

START_TEST(lack_of_memory_anywhere_is_a_status)
{
  int without = 0;
  dvi_study_sweep_report report = {.failed = 1};
  for (; report.failed > 0 || report.rows < POINTS; without++) {
    reset(&found, found.model);
    found.options.extremes = 1;
    dvi__fail_allocations_after(without);
    const dvi_status status = dvi_study_sweep(&found.options, &report);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    for (int k = 0; k < POINTS; k++)
      ck_assert(found.status[k] == DVI_OK || found.status[k] == DVI_NO_MEMORY);
  }
  ck_assert_int_gt(without, POINTS * 3);
}
END_TEST

static void refuse(const char *words)
{
  ck_assert_int_eq(dvi_study_sweep(&found.options, NULL), DVI_BAD_ARGUMENT);
  check_words(words);
  ck_assert_int_eq(found.rows, 0);
  reset(&found, found.model);
}

START_TEST(bad_input_is_refused)
{
  ck_assert_int_eq(dvi_study_sweep(NULL, NULL), DVI_BAD_ARGUMENT);
  found.options.size = 1;
  refuse("sizeof");
  found.options.open = NULL;
  refuse("open and found");
  found.options.found = NULL;
  refuse("open and found");
  found.options.axes = DVI_STUDY_AXES_MAX + 1;
  refuse("axes");
  found.options.axis = NULL;
  refuse("axes");
  const dvi_study_axis empty[] = {{.count = 1, .value = start}, {.count = 0}},
                       vast[] = {{.count = INT64_MAX / 2}, {.count = 3}};
  found.options.axis = empty;
  refuse("at least one value");
  found.options.axis = vast;
  refuse("2^63 - 1");
  found.options.part = 1;
  refuse("part 1 is not from 0 to 0");
  found.options.parts = -2;
  refuse("part 0");
  found.options.threads = DVI_STUDY_THREADS_MAX + 1;
  refuse("threads");
  found.options.threads = -1;
  refuse("threads");
}
END_TEST

static dvi_status open_nothing(const dvi_study_point *point, dvi_study_run *run, void *user)
{
  (void)point;
  (void)run;
  (void)user;
  return DVI_OK;
}

START_TEST(a_point_without_an_integrator_is_an_error)
{
  found.options.open = open_nothing;
  ck_assert_int_eq(dvi_study_sweep(&found.options, NULL), DVI_BAD_STATE);
  check_words("point 0");
}
END_TEST

START_TEST(ranges_have_their_ends)
{
  double value[4] = {7.0, 7.0, 7.0, 7.0};
  ck_assert_int_eq(dvi_study_range(0.0, 1e308, 1, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_range(-1e308, 1e308, 4, value), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_study_range((double)NAN, 1.0, 4, value), DVI_BAD_ARGUMENT);
  ck_assert_double_eq(value[0], 7.0);
  ck_assert_int_eq(dvi_study_range(0.1, 0.7, 4, value), DVI_OK);
  ck_assert(value[0] == 0.1 && value[3] == 0.7);
  ck_assert_double_le(fabs(value[1] - 0.3), 1e-16);
}
END_TEST

SUITE(study_sweep)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, points_have_the_bits_of_runs_by_themselves);
  tcase_add_test(tests, threads_and_parts_change_no_bit);
  tcase_add_test(tests, points_are_left_out);
  tcase_add_test(tests, a_point_that_cannot_be_opened_leaves_the_others);
  tcase_add_test(tests, a_run_that_fails_has_its_status_in_its_row);
  tcase_add_test(tests, a_row_that_is_refused_ends_the_sweep);
  tcase_add_test(tests, a_cancelled_sweep_keeps_the_rows_before);
  tcase_add_test(tests, lack_of_memory_anywhere_is_a_status);
  tcase_add_test(tests, bad_input_is_refused);
  tcase_add_test(tests, a_point_without_an_integrator_is_an_error);
  tcase_add_test(tests, ranges_have_their_ends);
}
