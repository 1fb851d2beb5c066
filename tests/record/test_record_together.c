/* labels: unit */
/* Recordings of runs that take steps together have the rows of single steps. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 150, H_PARTS = 64 };

static const struct {
  const char *problem, *method;
} cases[] = {{"kepler", "verlet"},
             {"kepler", "galerkin:degree=3"},
             {"kepler", "galerkin:degree=8,solver=certified"},
             {"kepler", "composition:order=4"},
             {"fpu", "galerkin:degree=2"},
             {"chain", "verlet"},
             {"double-pendulum", "galerkin:degree=2"},
             {"massless-particle", "vprk:nodes=2"}};
enum { CASES = sizeof cases / sizeof *cases };

static problem *model;
static dvi_integrator *runner, *walker;
static dvi_recording *recording;

static void set_up_case(int i)
{
  model = create_problem(cases[i].problem, NULL);
  runner = start_integrator(model, cases[i].method);
  walker = start_integrator(model, cases[i].method);
}

static void tear_down(void)
{
  dvi_recording_destroy(&recording);
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
  problem_destroy(&model);
}

static void check_row(dvi_record_part part, int64_t row, const double *numbers)
{
  int width = 0;
  const double *rows = dvi_recording_part(recording, part, &width);
  ck_assert_mem_eq(rows + row * width, numbers, (size_t)width * sizeof *numbers);
}

/* Walk the steps of the recording one by one, and check a row after every `every`. */
static void check_walk(double h, int every)
{
  double invariants[16];
  int64_t row = 0;
  for (int step = 0; step <= STEPS; step++) {
    if (step > 0) advance(walker, h, 1);
    if (step % every != 0 && step != STEPS) continue;
    const double t = dvi_integrator_time(walker);
    ck_assert_int_eq(dvi_integrator_invariants(walker, invariants), DVI_OK);
    check_row(DVI_RECORD_T, row, &t);
    check_row(DVI_RECORD_Q, row, dvi_integrator_q(walker));
    check_row(DVI_RECORD_P, row, dvi_integrator_p(walker));
    check_row(DVI_RECORD_INVARIANTS, row++, invariants);
  }
  ck_assert_int_eq(dvi_recording_rows(recording), row);
}

START_TEST(rows_are_those_of_single_steps)
{
  const int every[] = {1, 7, 40};
  const double h = 1. / H_PARTS;
  const dvi_run_options run = {.h = h, .t_end = STEPS * h, .every = every[_i % 3]};
  const dvi_record_options options = {.size = sizeof options,
                                      .parts = DVI_RECORD_Q | DVI_RECORD_P | DVI_RECORD_INVARIANTS};
  set_up_case(_i / 3);
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  check_walk(h, every[_i % 3]);
}
END_TEST

/* A recorded run may be cancelled, and takes its steps together all the same: the counters are
 * those of a bare run. */
START_TEST(rows_cost_no_evaluations)
{
  const volatile int cancel = 0;
  dvi_counters bare, recorded;
  const dvi_run_options run = {.h = 1. / H_PARTS, .t_end = 1};
  dvi_run_options watched = run;
  watched.cancel = &cancel;
  set_up_case(_i);
  ck_assert_int_eq(dvi_record(runner, &watched, NULL, &recording), DVI_OK);
  ck_assert_int_eq(dvi_run(walker, &run, NULL), DVI_OK);
  dvi_integrator_counters(runner, &recorded);
  dvi_integrator_counters(walker, &bare);
  bare.allocations = recorded.allocations; /* the first integrator of a system completes it */
  ck_assert_mem_eq(&bare, &recorded, sizeof bare);
}
END_TEST

/* One system has to search its velocity, and its derived numbers agree to a few roundings. */
START_TEST(velocities_and_invariants_follow_from_recorded_states)
{
  const dvi_run_options run = {.h = 1. / H_PARTS, .t_end = 1};
  int width = 0, count = 0;
  double energy[H_PARTS + 1];
  const dvi_record_options options = {.size = sizeof options,
                                      .parts = DVI_RECORD_INVARIANTS | DVI_RECORD_V};
  set_up_case(_i);
  ck_assert_int_eq(dvi_record(walker, &run, &options, &recording), DVI_OK);
  const double *value = dvi_recording_part(recording, DVI_RECORD_INVARIANTS, &width);
  for (int k = 0; k <= H_PARTS; k++) energy[k] = value[k * width];
  dvi_recording_destroy(&recording);
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_derive(recording, DVI_RECORD_INVARIANTS | DVI_RECORD_V), DVI_OK);
  value = dvi_recording_part(recording, DVI_RECORD_INVARIANTS, &count);
  ck_assert_int_eq(count, width);
  for (int k = 0; k <= H_PARTS; k++)
    ck_assert_double_eq_tol(value[k * width], energy[k], 1e-14 * (1 + fabs(energy[k])));
  (void)dvi_recording_part(recording, DVI_RECORD_V, &width);
  ck_assert_int_eq(width, dvi_system_nv(model->system));
}
END_TEST

START_TEST(nothing_follows_from_half_a_state)
{
  const dvi_run_options run = {.h = 1. / H_PARTS, .t_end = 1};
  const dvi_record_options options = {.size = sizeof options, .parts = DVI_RECORD_Q};
  set_up_case(0);
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_derive(recording, DVI_RECORD_V), DVI_BAD_ARGUMENT);
  check_words("it has no coordinates or no momenta");
  ck_assert_int_eq(dvi_recording_derive(recording, DVI_RECORD_STEP), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_recording_derive(NULL, DVI_RECORD_V), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(dvi_recording_part(recording, DVI_RECORD_V, NULL));
}
END_TEST

START_TEST(a_cancelled_run_has_a_row_for_each_step)
{
  const volatile int cancel = 1;
  const dvi_run_options run = {.h = 1. / H_PARTS, .t_end = 100, .cancel = &cancel};
  set_up_case(_i);
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  const dvi_run_report *report = dvi_recording_report(recording);
  ck_assert_int_eq(report->end, DVI_RUN_CANCELLED);
  ck_assert_int_le(report->steps, 33);
  ck_assert_int_eq(dvi_recording_rows(recording), report->steps + 1);
  check_row(DVI_RECORD_Q, report->steps, dvi_integrator_q(runner));
}
END_TEST

SUITE(record_together)
{
  tcase_add_checked_fixture(tests, NULL, tear_down);
  tcase_add_loop_test(tests, rows_are_those_of_single_steps, 0, 3 * CASES);
  tcase_add_loop_test(tests, rows_cost_no_evaluations, 0, CASES);
  tcase_add_loop_test(tests, velocities_and_invariants_follow_from_recorded_states, 0, CASES);
  tcase_add_test(tests, nothing_follows_from_half_a_state);
  tcase_add_loop_test(tests, a_cancelled_run_has_a_row_for_each_step, 0, CASES);
}
