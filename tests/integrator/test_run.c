/* labels: unit */
/* The driver of a run: its end, its observers and its report. Events are in test_event.c. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

enum { VISITS_MOST = 256 };

/* The observer's notes, and its planned answers. */
typedef struct diary {
  int visits;
  double t[VISITS_MOST];
  int answer_at, answer; /* return this on this visit, counted from 1 */
  int cancel_at;         /* on this visit set the flag */
  volatile int cancel;
} diary;

static int write_down(dvi_integrator *integrator, void *user)
{
  diary *d = user;
  ck_assert_int_lt(d->visits, VISITS_MOST);
  d->t[d->visits++] = dvi_integrator_time(integrator);
  if (d->visits == d->cancel_at) d->cancel = 1;
  return d->visits == d->answer_at ? d->answer : 0;
}

static problem *model;
static dvi_integrator *integrator;

static void set_up(void)
{
  make_folder();
  model = create_problem("oscillator", NULL);
  integrator = start_integrator(model, "galerkin:degree=4");
}

static void tear_down(void)
{
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  remove_folder();
}

/* ---- the way ---- */

static const char *const methods[] = {"galerkin:degree=4", "verlet", "midpoint",
                                      "composition:order=4,base=trapezoidal"};
enum { METHODS = sizeof methods / sizeof *methods };

/* 0.125 and its multiples are exact, so the last step needs no shortening. */
START_TEST(a_run_is_its_steps_bit_for_bit)
{
  dvi_run_report report;
  dvi_integrator *runner = start_integrator(model, methods[_i]),
                 *walker = start_integrator(model, methods[_i]);
  ck_assert_int_eq(dvi_run(runner, &(dvi_run_options){.h = 0.125, .t_end = 2}, &report), DVI_OK);
  advance(walker, 0.125, 16);
  check_same_state(runner, walker);
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
  ck_assert_int_eq(report.steps, 16);
  ck_assert_int_eq(report.events, 0);
  ck_assert_int_eq(report.event, -1);
  ck_assert(isnan(report.event_time));
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
}
END_TEST

START_TEST(a_last_shorter_step_ends_the_run_at_t_end)
{
  dvi_run_report report;
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.3, .t_end = 1}, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 4);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 1, DBL_EPSILON);
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 5, .t_end = 1.5}, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 1);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 1.5, 2 * DBL_EPSILON);
}
END_TEST

/* Ten times 0.1 is not quite 1, and there must be no eleventh step of 1e-16. */
START_TEST(rounding_makes_no_extra_step)
{
  dvi_run_report report;
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 1}, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 10);
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 100}, &report),
                   DVI_OK);
  ck_assert_int_eq(report.steps, 990);
}
END_TEST

START_TEST(a_run_leads_backward_to_where_it_began)
{
  diary d = {0};
  dvi_run_report report;
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 0.75}, NULL), DVI_OK);
  const dvi_run_options back = {.h = -0.1, .t_end = 0, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &back, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 8);
  ck_assert_int_eq(d.visits, 9);
  for (int k = 1; k < 9; k++) ck_assert_double_lt(d.t[k], d.t[k - 1]);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 0, DBL_EPSILON);
  /* Forth and back the steps differ, 0.1 and 0.05 at either end, so only the error of order 8 is
   * left. */
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], model->q[0], 1e-13);
}
END_TEST

START_TEST(at_the_end_there_is_nothing_to_do)
{
  diary d = {0};
  dvi_run_report report;
  const bytes before = read_state(integrator);
  const dvi_run_options options = {.h = -0.1, .t_end = 0, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
  ck_assert_int_eq(report.steps, 0);
  ck_assert_int_eq(d.visits, 1);
  check_state(integrator, before);
}
END_TEST

/* ---- observers ---- */

START_TEST(the_observer_sees_the_start_every_third_step_and_the_end)
{
  const double seen[] = {0, 0.375, 0.75, 1.125, 1.25};
  diary d = {0};
  const dvi_run_options options = {
      .h = 0.125, .t_end = 1.25, .every = 3, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &options, NULL), DVI_OK);
  ck_assert_int_eq(d.visits, 5);
  for (int k = 0; k < 5; k++) ck_assert_double_eq(d.t[k], seen[k]);
}
END_TEST

START_TEST(the_observer_sees_the_end_once)
{
  diary d = {0};
  const dvi_run_options options = {
      .h = 0.125, .t_end = 0.5, .every = 2, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &options, NULL), DVI_OK);
  ck_assert_int_eq(d.visits, 3);
}
END_TEST

START_TEST(the_observer_may_end_the_run_at_any_visit)
{
  diary d = {.answer_at = _i, .answer = 7};
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125, .t_end = 0.5, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_STOPPED);
  ck_assert_int_eq(report.steps, _i - 1);
  ck_assert_int_eq(d.visits, _i);
  ck_assert_double_eq(dvi_integrator_time(integrator), 0.125 * (_i - 1));
}
END_TEST

START_TEST(an_observer_that_fails_fails_the_run)
{
  diary d = {.answer_at = _i, .answer = -7};
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125, .t_end = 0.5, .observe = write_down, .user = &d};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_CALLBACK_FAILED);
  check_words(method_spec("the observer failed with -7 at t = %.9g", 0.125 * (_i - 1)));
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  ck_assert_int_eq(report.steps, _i - 1);
}
END_TEST

/* ---- cancelling ---- */

static int step_on(dvi_integrator *moved, void *user)
{
  (void)user;
  return dvi_integrator_step(moved, 0.125) == DVI_OK ? 0 : -1;
}

/* Else a run whose observer steps past t_end would never end. */
START_TEST(an_observer_that_steps_is_refused)
{
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125, .t_end = 1, .observe = step_on};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_BAD_STATE);
  check_words("the observer has moved the integrator from t = 0");
}
END_TEST

/* Only verlet takes steps in one pass, which looks at no flag. */
START_TEST(a_flag_set_before_the_run_ends_it_after_one_step)
{
  diary d = {.cancel = 1};
  const int passes = strcmp(methods[_i], "verlet") == 0;
  dvi_integrator *run = start_integrator(model, methods[_i]);
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125,
                                   .t_end = 12,
                                   .every = 100,
                                   .observe = write_down,
                                   .user = &d,
                                   .cancel = &d.cancel};
  ck_assert_int_eq(dvi_run(run, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_CANCELLED);
  ck_assert_int_eq(report.steps, passes ? 33 : 1);
  ck_assert_int_eq(d.visits, 2); /* the start and the end, wherever that is */
  dvi_integrator_destroy(&run);
}
END_TEST

/* The observer is called after the look at the flag, so the flag is seen in the step after it. */
START_TEST(a_flag_set_in_mid_run_ends_it_with_the_next_step)
{
  diary d = {.cancel_at = 3};
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125,
                                   .t_end = 2,
                                   .observe = write_down,
                                   .user = &d,
                                   .cancel = &d.cancel,
                                   .checkpoint = path_in_folder("checkpoint")};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_CANCELLED);
  ck_assert_int_eq(report.steps, 3);
  ck_assert_int_eq(dvi_integrator_restore(integrator, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_double_eq(dvi_integrator_time(integrator), 0.375);
}
END_TEST

/* ---- checkpoints ---- */

/* Reads after every step the time of the checkpoint on the disk, -1 if there is none. */
static int read_checkpoint(dvi_integrator *running, void *user)
{
  diary *d = user;
  dvi_integrator *reader = create_integrator(model->system, dvi_integrator_method(running));
  const int found = dvi_integrator_restore(reader, path_in_folder("checkpoint")) == DVI_OK;
  d->t[d->visits++] = found ? dvi_integrator_time(reader) : -1;
  dvi_integrator_destroy(&reader);
  return d->visits == d->answer_at ? d->answer : 0;
}

START_TEST(checkpoints_are_written_every_third_step_and_at_the_end)
{
  const double seen[] = {-1, -1, -1, -1, 0.375, 0.375, 0.375, 0.75, 0.75};
  diary d = {0};
  const dvi_run_options options = {.h = 0.125,
                                   .t_end = 1,
                                   .observe = read_checkpoint,
                                   .user = &d,
                                   .checkpoint = path_in_folder("checkpoint"),
                                   .checkpoint_every = 3};
  ck_assert_int_eq(dvi_run(integrator, &options, NULL), DVI_OK);
  ck_assert_int_eq(d.visits, 9);
  for (int k = 0; k < 9; k++) ck_assert_double_eq(d.t[k], seen[k]);
  dvi_integrator *reader = create_integrator(model->system, "galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_restore(reader, options.checkpoint), DVI_OK);
  check_same_state(integrator, reader);
  dvi_integrator_destroy(&reader);
}
END_TEST

START_TEST(a_run_in_two_parts_is_the_whole_run_bit_for_bit)
{
  dvi_integrator *whole = start_integrator(model, methods[_i]),
                 *part = start_integrator(model, methods[_i]),
                 *rest = create_integrator(model->system, methods[_i]);
  const char *file = path_in_folder("checkpoint");
  ck_assert_int_eq(dvi_run(whole, &(dvi_run_options){.h = 0.1, .t_end = 3}, NULL), DVI_OK);
  diary d = {.answer_at = 12, .answer = 1};
  const dvi_run_options first = {
      .h = 0.1, .t_end = 3, .observe = write_down, .user = &d, .checkpoint = file};
  ck_assert_int_eq(dvi_run(part, &first, NULL), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(rest, file), DVI_OK);
  ck_assert_int_eq(dvi_run(rest, &(dvi_run_options){.h = 0.1, .t_end = 3}, NULL), DVI_OK);
  check_same_state(whole, rest);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&part);
  dvi_integrator_destroy(&rest);
}
END_TEST

START_TEST(a_checkpoint_that_cannot_be_written_fails_the_run)
{
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125,
                                   .t_end = 1,
                                   .checkpoint = path_in_folder("missing/checkpoint"),
                                   .checkpoint_every = _i};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_IO_ERROR);
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  ck_assert_int_eq(report.steps, _i > 0 ? _i : 8);
  check_words("No such file");
}
END_TEST

/* ---- steps that fail ---- */

static int wall_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] * q[0] / 2;
  return 0;
}

static int wall_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  V_q[0] = t > 0.55 ? (double)NAN : q[0];
  return 0;
}

/* The step from 0.5 fails. The report, the state and the checkpoint are those of 0.5, and so is the
 * sentence. If the checkpoint cannot be written, the sentence says that, too. */
START_TEST(a_step_that_fails_ends_the_run_at_the_last_good_state)
{
  const dvi_potential potential = {.name = "wall", .value = wall_value, .gradient = wall_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  const char *const file = path_in_folder(_i % 2 == 0 ? "checkpoint" : "missing/checkpoint");
  diary d = {0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *runner = create_integrator(system, methods[_i / 2]);
  ck_assert_int_eq(dvi_integrator_start(runner, 0, &(double){1}, &(double){0}), DVI_OK);
  dvi_run_report report;
  const dvi_run_options options = {
      .h = 0.125, .t_end = 1, .observe = write_down, .user = &d, .checkpoint = file};
  ck_assert_int_eq(dvi_run(runner, &options, &report), DVI_NOT_FINITE);
  check_words("step 5 from t = 0.5");
  check_words("wall: the gradient callback gave nan");
  if (_i % 2 == 1) check_words("; and then: checkpoint: cannot write");
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  ck_assert_int_eq(report.steps, 4);
  ck_assert_int_eq(d.visits, 5);
  /* the substeps of a composition round */
  ck_assert_double_eq_tol(dvi_integrator_time(runner), 0.5, DBL_EPSILON);
  if (_i % 2 == 0) {
    dvi_integrator *reader = create_integrator(system, methods[_i / 2]);
    ck_assert_int_eq(dvi_integrator_restore(reader, path_in_folder("checkpoint")), DVI_OK);
    check_same_state(runner, reader);
    dvi_integrator_destroy(&reader);
  }
  dvi_integrator_destroy(&runner);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- options that cannot be ---- */

static const struct {
  dvi_run_options options;
  const char *because;
} refused[] = {
    {{.h = 0, .t_end = 1}, "h = 0; a finite step other than 0"},
    {{.h = (double)NAN, .t_end = 1}, "a finite step other than 0"},
    {{.h = HUGE_VAL, .t_end = 1}, "h = inf"},
    {{.h = 0.1, .t_end = (double)NAN}, "is not finite"},
    {{.h = 0.1, .t_end = HUGE_VAL}, "t_end = inf is not finite"},
    {{.h = -0.1, .t_end = 1}, "h = -0.1 leads away from t_end = 1; the time is 0"},
    {{.h = 0.1, .t_end = -1}, "leads away"},
    {{.h = 1e-16, .t_end = 1},
     "1e+16 steps to t_end = 1; at most 2^53 can be counted; take a longer step or a nearer end"},
    {{.h = 1e-300, .t_end = 1e300}, "inf steps"},
    {{.h = 1e-300, .t_end = -1e-300}, "leads away"}, /* the product of the two is rounded to zero */
    {{.h = 0.1, .t_end = 1, .every = -1}, "every = -1"},
    {{.h = 0.1, .t_end = 1, .checkpoint_every = -5}, "checkpoint_every = -5"},
    {{.h = 0.1, .t_end = 1, .event_count = -2}, "-2 events"},
    {{.h = 0.1, .t_end = 1, .events = &(const dvi_event){.name = "none"}},
     "a list of events is given, but their count is 0"},
    {{.h = 0.1, .t_end = 1, .event_count = 2}, "2 events declared, but their list is NULL"},
    {{.h = 0.1, .t_end = 1, .event_count = 1, .events = &(const dvi_event){.name = "none"}},
     "event 0 has no value callback"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(bad_options_are_refused_with_their_reason)
{
  diary d = {0};
  dvi_run_options options = refused[_i].options;
  dvi_run_report report = {.end = DVI_RUN_COMPLETE, .steps = 5};
  const bytes before = read_state(integrator);
  options.observe = write_down;
  options.user = &d;
  options.checkpoint = path_in_folder("checkpoint");
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_BAD_ARGUMENT);
  check_words(refused[_i].because);
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  ck_assert_int_eq(report.steps, 0);
  ck_assert_int_eq(d.visits, 0);
  ck_assert_int_eq(count_files_in_folder(), 0);
  check_state(integrator, before);
}
END_TEST

START_TEST(checkpoints_on_the_way_need_a_file)
{
  const dvi_run_options options = {.h = 0.1, .t_end = 1, .checkpoint_every = 3};
  ck_assert_int_eq(dvi_run(integrator, &options, NULL), DVI_BAD_ARGUMENT);
  check_words("checkpoint_every = 3, but no checkpoint file is named");
}
END_TEST

/* With Julian days the rounded time misses t by up to 2e-10, but a shorter last step must not. q =
 * cos(t - t0)/2 at the end. */
START_TEST(a_last_shorter_step_is_right_at_large_times)
{
  const double t0 = 2451545, way = 1.0625;
  ck_assert_int_eq(dvi_integrator_start(integrator, t0, model->q, model->p), DVI_OK);
  dvi_integrator *beside = start_integrator(model, "galerkin:degree=4");
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.01, .t_end = t0 + way}, NULL),
                   DVI_OK);
  ck_assert_int_eq(dvi_run(beside, &(dvi_run_options){.h = 0.01, .t_end = way}, NULL), DVI_OK);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], dvi_integrator_q(beside)[0], 1e-14);
  dvi_integrator_destroy(&beside);
}
END_TEST

START_TEST(a_step_that_time_does_not_feel_fails_the_run)
{
  dvi_run_report report;
  ck_assert_int_eq(dvi_integrator_start(integrator, 1e9, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 1e-9, .t_end = 1e9 + 1}, &report),
                   DVI_BAD_ARGUMENT);
  check_words("does not move the time");
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
}
END_TEST

/* However long h is, the run ends at t_end. A second run to t_end does nothing. */
START_TEST(a_step_longer_than_the_way_is_cut_to_it)
{
  const double lengths[] = {1e300, 1e10, 1.0000001};
  dvi_run_report report;
  const dvi_run_options options = {.h = lengths[_i], .t_end = 1};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 1);
  ck_assert_double_eq(dvi_integrator_time(integrator), 1);
}
END_TEST

/* The rounded weights of a composition do not sum to 1. A thousand steps must not show it. */
START_TEST(a_composition_ends_at_t_end_and_may_be_asked_again)
{
  const char *const order[] = {"4", "6", "8"};
  dvi_integrator *composed = start_integrator(model,
                                              method_spec("composition:order=%s", order[_i]));
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.01, .t_end = 10};
  ck_assert_int_eq(dvi_run(composed, &options, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 1000);
  ck_assert_double_eq(dvi_integrator_time(composed), 10);
  ck_assert_int_eq(dvi_run(composed, &options, &report), DVI_OK);
  ck_assert_int_eq(report.steps, 0);
  dvi_integrator_destroy(&composed);
}
END_TEST

SUITE(run)
{
  tcase_set_timeout(tests, 120); /* checkpoints are flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_loop_test(tests, a_run_is_its_steps_bit_for_bit, 0, METHODS);
  tcase_add_test(tests, a_last_shorter_step_ends_the_run_at_t_end);
  tcase_add_test(tests, rounding_makes_no_extra_step);
  tcase_add_test(tests, a_run_leads_backward_to_where_it_began);
  tcase_add_test(tests, at_the_end_there_is_nothing_to_do);
  tcase_add_test(tests, the_observer_sees_the_start_every_third_step_and_the_end);
  tcase_add_test(tests, the_observer_sees_the_end_once);
  tcase_add_loop_test(tests, the_observer_may_end_the_run_at_any_visit, 1, 6);
  tcase_add_loop_test(tests, an_observer_that_fails_fails_the_run, 1, 6);
  tcase_add_loop_test(tests, a_flag_set_before_the_run_ends_it_after_one_step, 0, METHODS);
  tcase_add_test(tests, a_flag_set_in_mid_run_ends_it_with_the_next_step);
  tcase_add_test(tests, checkpoints_are_written_every_third_step_and_at_the_end);
  tcase_add_loop_test(tests, a_run_in_two_parts_is_the_whole_run_bit_for_bit, 0, METHODS);
  tcase_add_loop_test(tests, a_checkpoint_that_cannot_be_written_fails_the_run, 0, 3);
  tcase_add_loop_test(tests, a_step_that_fails_ends_the_run_at_the_last_good_state, 0, 2 * METHODS);
  tcase_add_loop_test(tests, bad_options_are_refused_with_their_reason, 0, REFUSED);
  tcase_add_test(tests, checkpoints_on_the_way_need_a_file);
  tcase_add_test(tests, an_observer_that_steps_is_refused);
  tcase_add_test(tests, a_last_shorter_step_is_right_at_large_times);
  tcase_add_test(tests, a_step_that_time_does_not_feel_fails_the_run);
  tcase_add_loop_test(tests, a_step_longer_than_the_way_is_cut_to_it, 0, 3);
  tcase_add_loop_test(tests, a_composition_ends_at_t_end_and_may_be_asked_again, 0, 3);
}
