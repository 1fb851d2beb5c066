/* labels: unit */
/* Recordings: the rows are the states of a run, in arrays. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

static problem *model;
static dvi_integrator *runner, *walker;
static dvi_recording *recording;

static void set_up(void)
{
  model = create_problem("kepler", NULL);
  runner = start_integrator(model, "galerkin:degree=3");
  walker = start_integrator(model, "galerkin:degree=3");
}

static void tear_down(void)
{
  dvi_recording_destroy(&recording);
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
  problem_destroy(&model);
}

static dvi_record_options parts(unsigned parts)
{
  return (dvi_record_options){.size = sizeof(dvi_record_options), .parts = parts};
}

/* Check one row of a part. */
static void check_row(dvi_record_part part, int64_t row, int count, const double *numbers)
{
  int width = 0;
  const double *rows = dvi_recording_part(recording, part, &width);
  ck_assert_ptr_nonnull(rows);
  ck_assert_int_eq(width, count);
  ck_assert_mem_eq(rows + row * width, numbers, (size_t)count * sizeof *numbers);
}

static void check_state_row(int64_t row)
{
  const double t = dvi_integrator_time(walker);
  check_row(DVI_RECORD_T, row, 1, &t);
  check_row(DVI_RECORD_Q, row, 2, dvi_integrator_q(walker));
  check_row(DVI_RECORD_P, row, 2, dvi_integrator_p(walker));
}

/* ---- rows after steps ---- */

START_TEST(rows_are_the_states_of_single_steps_bit_for_bit)
{
  const dvi_run_options run = {.h = 0.125, .t_end = 1.25, .every = _i};
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  int64_t row = 0;
  for (int step = 0; step <= 10; step++) {
    if (step > 0) advance(walker, 0.125, 1);
    if (step % _i == 0 || step == 10) check_state_row(row++);
  }
  ck_assert_int_eq(dvi_recording_rows(recording), row);
  ck_assert_int_eq(dvi_recording_report(recording)->steps, 10);
}
END_TEST

START_TEST(a_part_that_was_not_asked_for_has_no_rows)
{
  const dvi_run_options run = {.h = 0.125, .t_end = 1};
  const dvi_record_options options = parts(DVI_RECORD_Q);
  int width = 7;
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  ck_assert_ptr_null(dvi_recording_part(recording, DVI_RECORD_P, &width));
  ck_assert_int_eq(width, 0);
  ck_assert_ptr_nonnull(dvi_recording_part(recording, DVI_RECORD_T, NULL));
}
END_TEST

START_TEST(measured_parts_are_those_of_the_integrator)
{
  const dvi_run_options run = {.h = 0.125, .t_end = 1};
  const dvi_record_options options = parts(DVI_RECORD_V | DVI_RECORD_INVARIANTS | DVI_RECORD_STEP |
                                           DVI_RECORD_P);
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  for (int step = 0; step <= 8; step++) {
    double invariant[8];
    const double length = step > 0 ? 0.125 : 0;
    if (step > 0) advance(walker, 0.125, 1);
    ck_assert_int_eq(dvi_integrator_invariants(walker, invariant), DVI_OK);
    check_row(DVI_RECORD_INVARIANTS, step, dvi_system_invariant_count(model->system), invariant);
    check_row(DVI_RECORD_STEP, step, 1, &length);
    check_row(DVI_RECORD_V, step, 2, dvi_integrator_p(walker)); /* the masses are 1 */
  }
}
END_TEST

/* A recording must not make the run slower by evaluations of its own. */
START_TEST(rows_of_states_take_no_evaluations)
{
  dvi_counters bare, recorded;
  const dvi_run_options run = {.h = 0.125, .t_end = 1};
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  ck_assert_int_eq(dvi_run(walker, &run, NULL), DVI_OK);
  dvi_integrator_counters(runner, &recorded);
  dvi_integrator_counters(walker, &bare);
  ck_assert_mem_eq(&bare, &recorded, sizeof bare);
}
END_TEST

/* Steps whose number is not known before make the arrays grow. */
START_TEST(arrays_grow_with_steps_of_chosen_lengths)
{
  dvi_integrator *sem = start_integrator(model, "sem:degree=2");
  const dvi_run_options run = {.h = 0.01, .t_end = 20};
  ck_assert_int_eq(dvi_record(sem, &run, NULL, &recording), DVI_OK);
  const int64_t rows = dvi_recording_rows(recording);
  const double *t = dvi_recording_part(recording, DVI_RECORD_T, NULL);
  ck_assert_int_eq(rows, dvi_recording_report(recording)->steps + 1);
  ck_assert_int_gt(rows, 256);
  for (int64_t k = 1; k < rows; k++) ck_assert_double_gt(t[k], t[k - 1]);
  check_row(DVI_RECORD_Q, rows - 1, 2, dvi_integrator_q(sem));
  dvi_integrator_destroy(&sem);
}
END_TEST

/* ---- rows at given times ---- */

START_TEST(rows_at_given_times_lie_on_the_path)
{
  const double times[] = {0, 0.0625, 0.1, 0.125, 0.9, 1};
  const double way = _i, h = 0.125 * way;
  double t[6], q[2], v[2];
  for (int k = 0; k < 6; k++) t[k] = way * times[k];
  dvi_record_options options = parts(DVI_RECORD_Q | DVI_RECORD_V | DVI_RECORD_P);
  options.times = t;
  options.time_count = 6;
  const dvi_run_options run = {.h = h, .t_end = way, .every = 100};
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_rows(recording), 6);
  check_state_row(0);
  advance(walker, h, 1);
  for (int k = 1; k < 3; k++) {
    ck_assert_int_eq(dvi_integrator_interpolate(walker, t[k], q, v), DVI_OK);
    check_row(DVI_RECORD_T, k, 1, &t[k]);
    check_row(DVI_RECORD_Q, k, 2, q);
    check_row(DVI_RECORD_V, k, 2, v);
    check_row(DVI_RECORD_P, k, 2, v);
  }
  check_state_row(3);
  advance(walker, h, 7);
  ck_assert_int_eq(dvi_integrator_interpolate(walker, t[4], q, v), DVI_OK);
  check_row(DVI_RECORD_Q, 4, 2, q);
  check_state_row(5);
}
END_TEST

/* The sum of the steps, 3 * 0.1, misses these ends by a rounding, to both sides. */
START_TEST(a_row_at_the_end_is_kept_where_steps_miss_it_by_roundings)
{
  const double end[] = {3 * 0.1 + 0x1p-54, 3 * 0.1 - 0x1p-54};
  const double times[] = {0, 0.05, end[_i], end[_i]};
  dvi_record_options options = parts(DVI_RECORD_Q | DVI_RECORD_P);
  options.times = times;
  options.time_count = 4;
  const dvi_run_options run = {.h = 0.1, .t_end = end[_i]};
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  ck_assert_double_ne(dvi_integrator_time(runner), end[_i]);
  ck_assert_int_eq(dvi_recording_rows(recording), 4);
  check_row(DVI_RECORD_T, 2, 1, &end[_i]);
  const double *q = dvi_recording_part(recording, DVI_RECORD_Q, NULL);
  ck_assert_double_le(distance(2, q + 6, dvi_integrator_q(runner)), 1e-15);
}
END_TEST

START_TEST(times_that_the_run_does_not_reach_are_refused)
{
  const double bad[][2] = {{-0.1, 0.5}, {0.5, 0.4}, {0.5, 1.1}, {0.5, (double)NAN}};
  dvi_record_options options = parts(0);
  options.times = bad[_i];
  options.time_count = 2;
  const dvi_run_options run = {.h = 0.125, .t_end = 1};
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_BAD_ARGUMENT);
  check_words("times must go on from");
  ck_assert_ptr_null(recording);
  ck_assert_double_eq(dvi_integrator_time(runner), 0);
}
END_TEST

/* ---- events and observers ---- */

static int height(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)v;
  *g = q[1] - *(const double *)user;
  return 0;
}

static int count_visits(double t, const double *q, const double *v, void *user)
{
  (void)t, (void)q, (void)v;
  *(double *)user += 0; /* the level stays */
  return 0;
}

START_TEST(events_are_kept_with_their_points)
{
  double level[] = {0.3, -0.3};
  const dvi_event events[] = {{.name = "up", .value = height, .direction = 1, .user = &level[0]},
                              {.value = height, .occurred = count_visits, .user = &level[1]}};
  const dvi_run_options run = {.h = 0.0625, .t_end = 12.5, .events = events, .event_count = 2};
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  const int64_t found = dvi_recording_report(recording)->events;
  ck_assert_int_eq(found, 6);
  for (int64_t k = 0; k < found; k++) {
    const dvi_recorded_event *event = dvi_recording_event(recording, k);
    ck_assert_double_eq_tol(event->q[1], level[event->event], 1e-12);
    if (event->event == 0) ck_assert_double_gt(event->v[1], 0);
  }
  ck_assert_ptr_null(dvi_recording_event(recording, found));
  ck_assert_ptr_null(dvi_recording_event(recording, -1));
}
END_TEST

static int clock_value(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v;
  *g = t - *(const double *)user;
  return 0;
}

static int count_calls(dvi_integrator *integrator, void *user)
{
  (void)integrator;
  ++*(int *)user;
  return 0;
}

/* With given times the observer is called as without, also where an event ends the run. */
START_TEST(the_programs_observer_is_called_at_every_end)
{
  double level = 0.5;
  const double times[] = {0, 0.3};
  const volatile int cancel = _i == 1;
  int visits = 0;
  const dvi_event event = {.value = clock_value, .terminal = 1, .user = &level};
  dvi_record_options options = parts(0);
  options.times = times;
  options.time_count = 2;
  const dvi_run_options run = {.h = 0.1,
                               .t_end = _i == 2 ? 3 * 0.1 + 0x1p-54 : 1,
                               .every = 100,
                               .observe = count_calls,
                               .user = &visits,
                               .events = _i == 0 ? &event : NULL,
                               .event_count = _i == 0,
                               .cancel = &cancel};
  ck_assert_int_eq(dvi_record(runner, &run, &options, &recording), DVI_OK);
  ck_assert_int_eq(visits, 2);
}
END_TEST

START_TEST(an_event_at_the_end_of_a_step_leaves_one_row_there)
{
  double level = 3 * 0.1 + 0x1p-54;
  const dvi_event event = {.value = clock_value, .terminal = 1, .user = &level};
  const dvi_run_options run = {.h = 0.1, .t_end = 1, .events = &event, .event_count = 1};
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_report(recording)->end, DVI_RUN_EVENT);
  ck_assert_int_eq(dvi_recording_rows(recording), dvi_recording_report(recording)->steps + 1);
}
END_TEST

static int stop_late(dvi_integrator *integrator, void *user)
{
  ++*(int *)user;
  return dvi_integrator_time(integrator) >= 0.5 ? 1 : 0;
}

START_TEST(the_programs_observer_may_end_the_run)
{
  int visits = 0;
  const dvi_run_options run = {.h = 0.125, .t_end = 1, .observe = stop_late, .user = &visits};
  ck_assert_int_eq(dvi_record(runner, &run, NULL, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_report(recording)->end, DVI_RUN_STOPPED);
  ck_assert_int_eq(dvi_recording_rows(recording), 5);
  ck_assert_int_eq(visits, 5);
}
END_TEST

/* ---- failures ---- */

START_TEST(a_failed_run_has_its_rows)
{
  const dvi_run_options run = {.h = 3, .t_end = 300};
  const dvi_status status = dvi_record(runner, &run, NULL, &recording);
  ck_assert_int_ne(status, DVI_OK);
  ck_assert_int_eq(dvi_recording_rows(recording), dvi_recording_report(recording)->steps + 1);
  check_row(DVI_RECORD_Q, dvi_recording_rows(recording) - 1, 2, dvi_integrator_q(runner));
}
END_TEST

START_TEST(missing_parts_are_refused)
{
  const dvi_run_options run = {.h = 0.125, .t_end = 1};
  const dvi_record_options constraint = parts(DVI_RECORD_CONSTRAINT), unknown = parts(1u << 20),
                           reactions = parts(DVI_RECORD_REACTIONS);
  ck_assert_int_eq(dvi_record(runner, &run, &constraint, &recording), DVI_UNSUPPORTED);
  check_words("record: no row at t = 0: constraint: the system declares no one-form");
  dvi_recording_destroy(&recording);
  ck_assert_int_eq(dvi_record(runner, &run, &reactions, &recording), DVI_UNSUPPORTED);
  check_words("reactions: the system has neither holonomic nor nonholonomic constraints");
  ck_assert_int_eq(dvi_record(runner, &run, &unknown, &recording), DVI_BAD_ARGUMENT);
  check_words("has unknown ones");
  ck_assert_int_eq(dvi_record(NULL, &run, NULL, &recording), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_record(runner, &run, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_recording_rows(NULL), 0);
  ck_assert_ptr_null(dvi_recording_part(NULL, DVI_RECORD_T, NULL));
  ck_assert_ptr_null(dvi_recording_report(NULL));
}
END_TEST

START_TEST(momenta_of_a_hamiltonian_at_given_times_are_refused_before_the_run)
{
  problem *held = create_problem("circle-dirac", NULL);
  dvi_integrator *stepper = start_integrator(held, "dg-phase:degree=2");
  const double times[] = {0.05, 0.25};
  dvi_record_options options = parts(0);
  options.times = times;
  options.time_count = 2;
  const dvi_run_options run = {.h = 0.1, .t_end = 1};
  ck_assert_int_eq(dvi_record(stepper, &run, &options, &recording), DVI_UNSUPPORTED);
  check_words("momenta and invariants of a Hamiltonian have no rows at given times");
  ck_assert_double_eq(dvi_integrator_time(stepper), 0);
  options.parts = DVI_RECORD_Q | DVI_RECORD_V;
  ck_assert_int_eq(dvi_record(stepper, &run, &options, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_rows(recording), 2);
  dvi_integrator_destroy(&stepper);
  problem_destroy(&held);
}
END_TEST

START_TEST(a_recording_without_memory_fails_and_leaks_nothing)
{
  const double level = 0.3;
  const dvi_event event = {.value = height, .user = (void *)&level};
  const dvi_run_options run = {.h = 0.01, .t_end = 20, .events = &event, .event_count = 1};
  const dvi_record_options options = parts(DVI_RECORD_Q | DVI_RECORD_INVARIANTS);
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status != DVI_OK && successes < 64; successes++) {
    dvi_integrator *fresh = start_integrator(model, "galerkin:degree=3");
    dvi__fail_allocations_after(successes);
    status = dvi_record(fresh, &run, &options, &recording);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) ck_assert_int_eq(status, DVI_NO_MEMORY);
    dvi_recording_destroy(&recording);
    dvi_integrator_destroy(&fresh);
  }
  ck_assert_int_eq(status, DVI_OK);
}
END_TEST

SUITE(record)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_loop_test(tests, rows_are_the_states_of_single_steps_bit_for_bit, 1, 5);
  tcase_add_test(tests, a_part_that_was_not_asked_for_has_no_rows);
  tcase_add_test(tests, measured_parts_are_those_of_the_integrator);
  tcase_add_test(tests, rows_of_states_take_no_evaluations);
  tcase_add_test(tests, arrays_grow_with_steps_of_chosen_lengths);
  tcase_add_loop_test(tests, rows_at_given_times_lie_on_the_path, 1, 2);
  tcase_add_loop_test(tests, rows_at_given_times_lie_on_the_path, -1, 0);
  tcase_add_loop_test(tests, a_row_at_the_end_is_kept_where_steps_miss_it_by_roundings, 0, 2);
  tcase_add_loop_test(tests, times_that_the_run_does_not_reach_are_refused, 0, 4);
  tcase_add_test(tests, events_are_kept_with_their_points);
  tcase_add_test(tests, the_programs_observer_may_end_the_run);
  tcase_add_loop_test(tests, the_programs_observer_is_called_at_every_end, 0, 3);
  tcase_add_test(tests, an_event_at_the_end_of_a_step_leaves_one_row_there);
  tcase_add_test(tests, a_failed_run_has_its_rows);
  tcase_add_test(tests, missing_parts_are_refused);
  tcase_add_test(tests, momenta_of_a_hamiltonian_at_given_times_are_refused_before_the_run);
  tcase_add_test(tests, a_recording_without_memory_fails_and_leaks_nothing);
}
