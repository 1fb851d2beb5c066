/* labels: unit */
/* Events are found at the right time, in the order of the run, once. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

static const double pi = 3.14159265358979324;

enum { MARKS_MOST = 64 };

/* Zeros of the clock at up to three times, and a place in the common record. */
typedef struct mark {
  int count;
  double time[3];
  int answer;       /* of the callback */
  int value_answer; /* of g, once its time is over value_after */
  double value_after, value;
} mark;

/* The reported events, in this order. */
static struct {
  int count;
  const mark *watched[MARKS_MOST];
  double t[MARKS_MOST], q[MARKS_MOST];
} record;

static int clock_value(double t, const double *q, const double *v, double *g, void *user)
{
  const mark *m = user;
  (void)q, (void)v;
  *g = 1;
  for (int k = 0; k < m->count; k++) *g *= t - m->time[k];
  if (m->value_after > 0 && t > m->value_after) {
    *g = m->value;
    return m->value_answer;
  }
  return 0;
}

static int take_down(double t, const double *q, const double *v, void *user)
{
  const mark *m = user;
  (void)v;
  ck_assert_int_lt(record.count, MARKS_MOST);
  record.watched[record.count] = m;
  record.t[record.count] = t;
  record.q[record.count++] = q[0];
  return m->answer;
}

static dvi_event at_times(mark *m)
{
  return (dvi_event){.name = "alarm", .value = clock_value, .occurred = take_down, .user = m};
}

static problem *model;
static dvi_integrator *integrator;

static void set_up(void)
{
  model = create_problem("oscillator", NULL);
  integrator = start_integrator(model, "galerkin:degree=8");
}

static void tear_down(void)
{
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

static dvi_run_report watch(double h, double t_end, const dvi_event *events, int count)
{
  dvi_run_report report;
  const dvi_run_options options = {.h = h, .t_end = t_end, .events = events, .event_count = count};
  ck_assert_msg(dvi_run(integrator, &options, &report) == DVI_OK, "%s", dvi_last_error());
  return report;
}

/* ---- located ---- */

static int position(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)v;
  *g = q[0] - *(const double *)user;
  return 0;
}

static struct {
  int count;
  double t[MARKS_MOST];
} times;

static int note_time(double t, const double *q, const double *v, void *user)
{
  (void)q, (void)v, (void)user;
  ck_assert_int_lt(times.count, MARKS_MOST);
  times.t[times.count++] = t;
  return 0;
}

/* q = cos(w t)/2 vanishes at (k + 1/2) pi/w. With degree 8 and h = 0.1 the path's own error (w
 * h/2)^9/9! is negligible. The promise is 1e-12 max(1,|t|). */
START_TEST(zeros_of_an_oscillator_are_where_theory_says)
{
  double zero = 0;
  const double w = sqrt(0.5);
  const int direction = _i - 1, first = direction > 0 ? 1 : 0, stride = direction == 0 ? 1 : 2;
  const dvi_event event = {
      .value = position, .direction = direction, .occurred = note_time, .user = &zero};
  const dvi_run_report report = watch(0.1, 100, &event, 1);
  ck_assert_int_eq(times.count, direction == 0 ? 23 : direction > 0 ? 11 : 12);
  for (int k = 0; k < times.count; k++) {
    const double expected = (first + stride * k + 0.5) * pi / w;
    ck_assert_double_eq_tol(times.t[k], expected, 1e-12 * expected);
  }
  ck_assert_int_eq(report.events, times.count);
  ck_assert_int_eq(report.event, 0);
  ck_assert_double_eq(report.event_time, times.t[times.count - 1]);
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
}
END_TEST

START_TEST(directions_are_those_of_the_run_also_backward)
{
  double zero = 0;
  const double w = sqrt(0.5);
  const dvi_event event = {.value = position, .direction = 1, .occurred = note_time, .user = &zero};
  (void)watch(-0.1, -10, &event, 1);
  /* Backward in time cos(w t) falls first, at -pi/(2w), and rises at -3 pi/(2w). */
  ck_assert_int_eq(times.count, 1);
  ck_assert_double_eq_tol(times.t[0], -1.5 * pi / w, 1e-12 * 10);
}
END_TEST

static int radial_speed(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)user;
  *g = q[0] * v[0] + q[1] * v[1];
  return 0;
}

/* The apsides of a Kepler orbit from its pericentre are at k pi. With degree 12 and h = 0.05 the
 * velocity inside a step, at an eccentricity of 0.6, is right to 24^-12, which is roundoff (the
 * nearest singularity is 0.3 away in complex time). The run's roundoff changes the phase by less
 * than 1e-13 over five turns. The start, itself a pericentre, is none of the run's events. */
START_TEST(apsides_of_a_kepler_orbit_are_where_theory_says)
{
  const int direction = _i - 1;
  problem *kepler = create_problem("kepler", "e=0.6");
  dvi_integrator *orbit = start_integrator(kepler, "galerkin:degree=12");
  const dvi_event event = {
      .name = "apsis", .value = radial_speed, .direction = direction, .occurred = note_time};
  const dvi_run_options options = {.h = 0.05, .t_end = 32, .events = &event, .event_count = 1};
  ck_assert_msg(dvi_run(orbit, &options, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(times.count, direction == 0 ? 10 : 5);
  for (int k = 0; k < times.count; k++) {
    const double expected = pi * (direction == 0 ? k + 1 : 2 * k + (direction > 0 ? 2 : 1));
    ck_assert_double_eq_tol(times.t[k], expected, 1e-12 * expected);
  }
  dvi_integrator_destroy(&orbit);
  problem_destroy(&kepler);
}
END_TEST

/* A function of time alone is known to the last digit, so only the search can err. The cube is flat
 * at its zero, the sign has no useful slope, the values of the steep one left and right of it
 * differ by 10^17, and the product of two values of the tiny one is zero in floating point. */
static int cube(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = pow(t - 0.73, 3);
  return 0;
}

static int sign(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = t < 0.73 ? -1 : 1;
  return 0;
}

static int steep(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = 1 - exp(fmin(2000 * (t - 0.73), 300));
  return 0;
}

static int tiny(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = 1e-200 * (t - 0.73);
  return 0;
}

static int huge(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = 1e300 * (t - 0.73);
  return 0;
}

START_TEST(awkward_functions_are_located_as_well)
{
  int (*const values[])(double, const double *, const double *, double *,
                        void *) = {cube, sign, steep, tiny, huge};
  const dvi_event event = {.value = values[_i], .occurred = note_time};
  (void)watch(0.5, 2, &event, 1);
  ck_assert_int_eq(times.count, 1);
  ck_assert_double_eq_tol(times.t[0], 0.73, 1e-12);
}
END_TEST

START_TEST(the_callback_gets_the_path_at_the_event)
{
  mark m = {.count = 1, .time = {1.2345}};
  const dvi_event event = at_times(&m);
  double q, p;
  (void)watch(0.1, 2, &event, 1);
  ck_assert_int_eq(record.count, 1);
  ck_assert_int_eq(model->exact(model, 1.2345, &q, &p), 0);
  ck_assert_double_eq_tol(record.q[0], q, 1e-12);
}
END_TEST

/* ---- once, or not at all ---- */

START_TEST(touching_zero_is_no_event)
{
  const double top = 0.5 + 1e-9; /* just above the amplitude */
  const dvi_event event = {.value = position, .occurred = note_time, .user = (void *)&top};
  const dvi_run_report report = watch(0.1, 30, &event, 1);
  ck_assert_int_eq(report.events, 0);
  ck_assert(isnan(report.event_time));
}
END_TEST

START_TEST(a_double_zero_inside_a_quarter_is_no_event)
{
  mark m = {.count = 2, .time = {0.53, 0.53}};
  const dvi_event event = at_times(&m);
  ck_assert_int_eq(watch(0.125, 1, &event, 1).events, 0);
}
END_TEST

/* With h = 0.125 the search evaluates exactly these times: the end of a step, a quarter, the end of
 * the run. */
START_TEST(a_zero_on_a_point_of_the_search_is_reported_once)
{
  const double exact[] = {0.5, 0.53125, 1};
  mark m = {.count = 1, .time = {exact[_i]}};
  const dvi_event event = at_times(&m);
  const dvi_run_report report = watch(0.125, 1, &event, 1);
  ck_assert_int_eq(report.events, 1);
  ck_assert_double_eq(report.event_time, exact[_i]);
  ck_assert_int_eq(watch(0.125, 2, &event, 1).events, 0);
  ck_assert_int_eq(record.count, 1);
}
END_TEST

START_TEST(directions_hold_on_a_point_of_the_search_too)
{
  mark m = {.count = 1, .time = {0.5}};
  dvi_event event = at_times(&m);
  event.direction = _i;
  ck_assert_int_eq(watch(0.125, 1, &event, 1).events, _i >= 0);
}
END_TEST

START_TEST(runs_that_end_between_events_find_each_once)
{
  double zero = 0;
  const dvi_event event = {.value = position, .occurred = note_time, .user = &zero};
  for (int k = 1; k <= 90; k++) (void)watch(0.37, k / 3.0, &event, 1);
  const int in_parts = times.count;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  (void)watch(0.37, 30, &event, 1);
  ck_assert_int_eq(times.count, 2 * in_parts);
}
END_TEST

/* ---- in order ---- */

/* Six zeros in one step, from three events, in two quarters of it, listed late to early. Backward
 * the order is reversed. */
START_TEST(events_of_one_step_come_in_the_order_of_the_run)
{
  mark late = {.count = 2, .time = {0.31, 0.71}}, middle = {.count = 2, .time = {0.30, 0.55}},
       early = {.count = 2, .time = {0.29, 0.70}};
  const dvi_event events[] = {at_times(&late), at_times(&middle), at_times(&early)};
  const double forward[] = {0.29, 0.30, 0.31, 0.55, 0.70, 0.71};
  const mark *const whose[] = {&early, &middle, &late, &middle, &early, &late};
  if (_i == 1) ck_assert_int_eq(dvi_integrator_start(integrator, 1, model->q, model->p), DVI_OK);
  const dvi_run_report report = watch(_i == 0 ? 1 : -1, _i == 0 ? 1 : 0, events, 3);
  ck_assert_int_eq(report.steps, 1);
  ck_assert_int_eq(report.events, 6);
  ck_assert_int_eq(record.count, 6);
  for (int k = 0; k < 6; k++) {
    const int j = _i == 0 ? k : 5 - k;
    ck_assert_double_eq_tol(record.t[k], forward[j], 1e-12);
    ck_assert_ptr_eq(record.watched[k], whose[j]);
  }
  ck_assert_int_eq(report.event, _i == 0 ? 0 : 2);
  ck_assert_double_eq(report.event_time, record.t[5]);
}
END_TEST

START_TEST(of_two_events_at_one_time_the_first_of_the_list_comes_first)
{
  mark one = {.count = 1, .time = {0.5}}, two = {.count = 1, .time = {0.5}};
  const dvi_event events[] = {at_times(&one), at_times(&two)};
  ck_assert_int_eq(watch(0.125, 1, events, 2).events, 2);
  ck_assert_ptr_eq(record.watched[0], &one);
  ck_assert_ptr_eq(record.watched[1], &two);
}
END_TEST

/* ---- ending the run ---- */

START_TEST(the_earliest_terminal_event_ends_the_run)
{
  mark last = {.count = 1, .time = {0.96}}, first = {.count = 1, .time = {0.92}},
       middle = {.count = 1, .time = {0.94}};
  dvi_event events[] = {at_times(&last), at_times(&first), at_times(&middle)};
  events[0].terminal = events[2].terminal = 1;
  const dvi_run_report report = watch(0.1, 5, events, 3);
  ck_assert_int_eq(report.end, DVI_RUN_EVENT);
  ck_assert_int_eq(report.event, 2);
  ck_assert_double_eq_tol(report.event_time, 0.94, 1e-12);
  ck_assert_int_eq(report.events, 2);
  ck_assert_int_eq(record.count, 2);
  ck_assert_int_eq(report.steps, 10);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), report.event_time, 2 * DBL_EPSILON);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], record.q[1],
                          1e-12); /* the shorter step's end is on the longer one's path */
}
END_TEST

START_TEST(a_callback_may_end_the_run)
{
  mark stopper = {.count = 1, .time = {0.45}, .answer = 1}, later = {.count = 1, .time = {0.47}};
  const dvi_event events[] = {at_times(&later), at_times(&stopper)};
  const dvi_run_report report = watch(0.1, 5, events, 2);
  ck_assert_int_eq(report.end, DVI_RUN_STOPPED);
  ck_assert_int_eq(report.steps, 5);
  ck_assert_int_eq(report.events, 1);
}
END_TEST

/* A flag that goes up inside a step ends the run with this step. */
static volatile int flag;

static int raise_flag(double t, const double *q, const double *v, void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  flag = 1;
  return 0;
}

START_TEST(a_run_may_be_cancelled_in_an_event)
{
  mark m = {.count = 1, .time = {0.45}};
  const dvi_event event = {.value = clock_value, .occurred = raise_flag, .user = &m};
  const dvi_run_options options = {
      .h = 0.1, .t_end = 5, .events = &event, .event_count = 1, .cancel = &flag};
  dvi_run_report report;
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_CANCELLED);
  ck_assert_int_eq(report.steps, 5);
}
END_TEST

/* ---- failing ---- */

static dvi_run_report failing(dvi_status status, const dvi_event *event)
{
  dvi_run_report report;
  const dvi_run_options options = {.h = 0.125, .t_end = 5, .events = event, .event_count = 1};
  ck_assert_int_eq(dvi_run(integrator, &options, &report), status);
  ck_assert_int_eq(report.end, DVI_RUN_FAILED);
  return report;
}

static const struct {
  int answer;
  double value;
  dvi_status status;
  const char *words;
} ailments[] = {
    {-2, 1, DVI_CALLBACK_FAILED, "event 'alarm': the callback returned -2"},
    {2, 1, DVI_CALLBACK_RETRY, "event 'alarm': the callback returned 2"},
    {0, (double)NAN, DVI_NOT_FINITE, "event 'alarm' is nan at t = "},
    {0, -HUGE_VAL, DVI_NOT_FINITE, "event 'alarm' is -inf at t = "},
};
enum { AILMENTS = sizeof ailments / sizeof *ailments };

/* Its step is taken back, so that a smaller one may be tried. Later steps are as if it had not
 * been. */
START_TEST(a_function_that_fails_in_mid_run_fails_the_run)
{
  mark m = {.value_after = 0.45, .value_answer = ailments[_i].answer, .value = ailments[_i].value};
  const dvi_event event = at_times(&m);
  const dvi_run_report report = failing(ailments[_i].status, &event);
  check_words(ailments[_i].words);
  ck_assert_int_eq(report.steps, 3);
  ck_assert_int_eq(report.events, 0);
  ck_assert_double_eq(dvi_integrator_time(integrator), 0.375);
  dvi_integrator *other = start_integrator(model, dvi_integrator_method(integrator));
  advance(other, 0.125, 3);
  check_same_state(integrator, other);
  advance(integrator, 0.1, 4);
  advance(other, 0.1, 4);
  check_same_state(integrator, other);
  dvi_integrator_destroy(&other);
}
END_TEST

/* Nothing of a step that is taken back is reported. */
START_TEST(a_failing_function_keeps_earlier_events_of_its_step_unreported)
{
  mark ill = {.value_after = 0.45, .value_answer = 1}, well = {.count = 1, .time = {0.4}};
  const dvi_event events[] = {at_times(&well), at_times(&ill)};
  const dvi_run_options options = {.h = 0.125, .t_end = 5, .events = events, .event_count = 2};
  dvi_run_report report;
  ck_assert_int_eq(dvi_run(integrator, &options, &report), DVI_CALLBACK_RETRY);
  check_words("the step from t = 0.375 is taken back");
  ck_assert_int_eq(report.events, 0);
  ck_assert_int_eq(record.count, 0);
}
END_TEST

START_TEST(a_direction_that_is_none_is_refused)
{
  mark m = {.count = 1, .time = {0.4}};
  dvi_event event = at_times(&m);
  event.direction = _i == 0 ? 7 : -2;
  const dvi_run_options options = {.h = 0.125, .t_end = 5, .events = &event, .event_count = 1};
  ck_assert_int_eq(dvi_run(integrator, &options, NULL), DVI_BAD_ARGUMENT);
  check_words("-1, 0 or 1 are possible");
}
END_TEST

START_TEST(a_function_that_fails_at_the_start_fails_the_run)
{
  mark m = {.value_after = 0.45, .value_answer = ailments[_i].answer, .value = ailments[_i].value};
  const dvi_event event = at_times(&m);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0.5, model->q, model->p), DVI_OK);
  const dvi_run_report report = failing(ailments[_i].status, &event);
  check_words(ailments[_i].words);
  ck_assert_int_eq(report.steps, 0);
}
END_TEST

START_TEST(a_callback_that_fails_fails_the_run)
{
  mark m = {.count = 1, .time = {0.45}, .answer = -4};
  const dvi_event event = at_times(&m);
  ck_assert_int_eq(failing(DVI_CALLBACK_FAILED, &event).steps, 4);
  check_words("event 'alarm': the callback at t = 0.45 failed with -4");
}
END_TEST

SUITE(event)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_loop_test(tests, zeros_of_an_oscillator_are_where_theory_says, 0, 3);
  tcase_add_test(tests, directions_are_those_of_the_run_also_backward);
  tcase_add_loop_test(tests, apsides_of_a_kepler_orbit_are_where_theory_says, 0, 3);
  tcase_add_loop_test(tests, awkward_functions_are_located_as_well, 0, 5);
  tcase_add_test(tests, the_callback_gets_the_path_at_the_event);
  tcase_add_test(tests, touching_zero_is_no_event);
  tcase_add_test(tests, a_double_zero_inside_a_quarter_is_no_event);
  tcase_add_loop_test(tests, a_zero_on_a_point_of_the_search_is_reported_once, 0, 3);
  tcase_add_loop_test(tests, directions_hold_on_a_point_of_the_search_too, -1, 2);
  tcase_add_test(tests, runs_that_end_between_events_find_each_once);
  tcase_add_loop_test(tests, events_of_one_step_come_in_the_order_of_the_run, 0, 2);
  tcase_add_test(tests, of_two_events_at_one_time_the_first_of_the_list_comes_first);
  tcase_add_test(tests, the_earliest_terminal_event_ends_the_run);
  tcase_add_test(tests, a_callback_may_end_the_run);
  tcase_add_test(tests, a_run_may_be_cancelled_in_an_event);
  tcase_add_loop_test(tests, a_function_that_fails_in_mid_run_fails_the_run, 0, AILMENTS);
  tcase_add_test(tests, a_failing_function_keeps_earlier_events_of_its_step_unreported);
  tcase_add_loop_test(tests, a_direction_that_is_none_is_refused, 0, 2);
  tcase_add_loop_test(tests, a_function_that_fails_at_the_start_fails_the_run, 0, AILMENTS);
  tcase_add_test(tests, a_callback_that_fails_fails_the_run);
}
