/* labels: unit */
/* Runs of scenes by one call, and columns of their recordings. */
#include <math.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

static const char orbit[] =
    "parameters: {e: 0.3}\n"
    "coordinates: {x: scalar, y: scalar}\n"
    "lagrangian: (x'^2 + y'^2)/2 + 1/hypot(x, y)\n"
    "initial: {x: 1 - e, y: 0, x': 0, y': sqrt((1 + e)/(1 - e))}\n"
    "events: {crossing: {zero: y, direction: falling, stop: yes}}\n"
    "method: galerkin:degree=3\nstep: 0.0625\nuntil: 20\nreport: {every: 4}\n";

static dvi_recording *recording;

static void set_up(void)
{
  (void)open_scene(orbit);
}

static void tear_down(void)
{
  dvi_recording_destroy(&recording);
  release_scene();
}

static dvi_scene_run_options options_of(unsigned parts)
{
  return (dvi_scene_run_options){.size = sizeof(dvi_scene_run_options), .parts = parts};
}

START_TEST(a_scene_runs_as_it_says_up_to_its_terminal_event)
{
  int stride = 0;
  ck_assert_int_eq(dvi_scene_run(scene, NULL, &recording), DVI_OK);
  const dvi_run_report *report = dvi_recording_report(recording);
  const int64_t last = dvi_recording_rows(recording) - 1;
  ck_assert_int_eq(report->end, DVI_RUN_EVENT);
  ck_assert_double_eq_tol(report->event_time, acos(-1), 1e-5);
  const double *y = dvi_scene_column(scene, recording, "y", &stride);
  ck_assert_double_eq_tol(y[last * stride], 0, 1e-10);
  const double *t = dvi_scene_column(scene, recording, "t", &stride);
  ck_assert_double_eq(t[stride], 0.25);
}
END_TEST

START_TEST(options_take_the_place_of_what_the_scene_says)
{
  const double q[] = {1, 0}, v[] = {0, 1};
  int stride = 0;
  dvi_scene_run_options options = options_of(DVI_RECORD_INVARIANTS | DVI_RECORD_V | DVI_RECORD_Q);
  options.method = "verlet";
  options.h = 0.125;
  options.t_end = 1;
  options.every = 1;
  options.q = q;
  options.v = v;
  ck_assert_int_eq(dvi_scene_run(scene, &options, &recording), DVI_OK);
  ck_assert_int_eq(dvi_recording_rows(recording), 9);
  ck_assert_double_eq(dvi_scene_column(scene, recording, "energy", &stride)[0], -0.5);
  ck_assert_double_eq(dvi_scene_column(scene, recording, "x", &stride)[0], 1);
  ck_assert_double_eq(*dvi_scene_column(scene, recording, dvi_scene_velocity(scene, 1), &stride),
                      1);
  ck_assert_ptr_null(dvi_scene_column(scene, recording, "p_x", &stride));
  ck_assert_ptr_null(dvi_scene_column(scene, recording, "z", &stride));
}
END_TEST

START_TEST(wrong_options_are_refused)
{
  const double q[] = {1, 0};
  dvi_scene_run_options options = options_of(0);
  options.q = q;
  ck_assert_int_eq(dvi_scene_run(scene, &options, &recording), DVI_BAD_ARGUMENT);
  options = options_of(0);
  options.v = options.p = q;
  ck_assert_int_eq(dvi_scene_run(scene, &options, &recording), DVI_BAD_ARGUMENT);
  options = options_of(0);
  options.method = "galerkn";
  ck_assert_int_eq(dvi_scene_run(scene, &options, &recording), DVI_BAD_OPTION);
  options.size = 1;
  ck_assert_int_eq(dvi_scene_run(scene, &options, &recording), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_run(NULL, NULL, &recording), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_run(scene, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(recording);
}
END_TEST

SUITE(scene_run)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, a_scene_runs_as_it_says_up_to_its_terminal_event);
  tcase_add_test(tests, options_take_the_place_of_what_the_scene_says);
  tcase_add_test(tests, wrong_options_are_refused);
}
