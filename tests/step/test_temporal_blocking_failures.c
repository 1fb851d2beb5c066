/* labels: unit */
/* Temporal blocking when something fails, and with all that stands around a step: starts, dense
 * output, events and checkpoints. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"
#include "blocking_pair.h"

/* ---- failures ---- */

typedef struct trouble {
  int site, returned;
  double number;
} trouble;

static const trouble troubles[] = {{0, 1, 0},    {700, -3, 0},        {1499, 2, 0},
                                   {733, 0, -1}, {1200, 0, HUGE_VAL}, {5, 0, 1e308 * 10}};
enum { TROUBLES = 6 };

static void make_trouble(pair *p, const trouble *what)
{
  p->lattice.bad_site = what->site;
  p->lattice.bad_return = what->returned;
  p->lattice.bad_number = what->number < 0 ? (double)NAN : what->number;
  /* in the midst of the third step, for compositions of order 8 too */
  p->lattice.bad_time = 0.25 + 0.2 + 0.05;
}

/* Both give one status and one sentence, and go on as if nothing had happened. */
START_TEST(a_failure_in_mid_wave_is_that_of_the_plain_sweep_and_leaves_no_trace)
{
  for (int threads = 1; threads <= THREADS_MOST; threads++) {
    char words[512];
    pair p;
    dvi_counters counters;
    make_pair(&p, 1500, 3, 2, threads, method_of(_i / TROUBLES), threads, 16);
    for (int i = 0; i < 2; i++) step_both(&p, 0.1);
    make_trouble(&p, &troubles[_i % TROUBLES]);
    const dvi_status plain = dvi_integrator_step(p.plain, 0.1);
    (void)snprintf(words, sizeof words, "%s", dvi_last_error());
    ck_assert_int_ne(plain, DVI_OK);
    check_same(p.wave, p.plain, "before the failure");
    ck_assert_int_eq(dvi_integrator_step(p.wave, 0.1), plain);
    ck_assert_str_eq(dvi_last_error(), words);
    /* what a callback gave is looked at before the next is asked */
    ck_assert_int_eq(p.lattice.blind, 0);
    check_same(p.wave, p.plain, "after the failure");
    dvi_integrator_counters(p.wave, &counters);
    ck_assert_int_eq(counters.failed_steps, 1);
    ck_assert_int_eq(counters.steps, 2);
    p.lattice.bad_site = -1;
    step_both(&p, 0.1);
    check_same(p.wave, p.plain, "after going on");
    destroy_pair(&p);
  }
}
END_TEST

/* All callbacks succeed, but the numbers run away. */
START_TEST(a_state_that_is_not_finite_is_refused_by_both)
{
  for (int threads = 1; threads <= 2; threads++) {
    pair p;
    make_pair(&p, 300, 1, 1, 0, method_of(_i), threads, 8);
    step_both(&p, 0.1);
    ck_assert_int_eq(dvi_integrator_step(p.plain, 1e200), DVI_NOT_FINITE);
    ck_assert_int_eq(dvi_integrator_step(p.wave, 1e200), DVI_NOT_FINITE);
    check_same(p.wave, p.plain, "after running away");
    destroy_pair(&p);
  }
}
END_TEST

/* The last gradient is finite, and its kick is not. No callback sees it. */
START_TEST(a_last_kick_that_overflows_is_refused_by_both)
{
  for (int threads = 1; threads <= 2; threads++) {
    pair p;
    make_pair(&p, 300, 0, 1, 0, method_of(_i), threads, 8);
    step_both(&p, 0.1);
    p.lattice.bad_site = 277;
    p.lattice.bad_number = 1.7e308;
    p.lattice.bad_time = 0.35 + 0.98 * 20;
    ck_assert_int_eq(dvi_integrator_step(p.plain, 20), DVI_NOT_FINITE);
    check_words("the new state is not finite");
    ck_assert_int_eq(dvi_integrator_step(p.wave, 20), DVI_NOT_FINITE);
    check_words("the new state is not finite");
    check_same(p.wave, p.plain, "after an overflow");
    destroy_pair(&p);
  }
}
END_TEST

/* ---- what stands around a step ---- */

START_TEST(a_step_can_be_taken_back)
{
  pair p;
  make_pair(&p, 600, 2, 2, 4, method_of(_i), 2, 16);
  step_both(&p, 0.1);
  advance(p.wave, 0.07, 1);
  ck_assert_int_eq(dvi__integrator_undo(p.wave, DVI_CALLBACK_RETRY), DVI_CALLBACK_RETRY);
  check_same(p.wave, p.plain, "after it is taken back");
  step_both(&p, 0.1);
  check_same(p.wave, p.plain, "after another step");
  destroy_pair(&p);
}
END_TEST

START_TEST(dense_output_is_that_of_the_plain_sweep)
{
  enum { LENGTH = 200 };
  double q[2][LENGTH], v[2][LENGTH];
  pair p;
  make_pair(&p, LENGTH, 2, 1, 2, method_of(_i), 2, 8);
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  ck_assert_int_eq(dvi_integrator_interpolate(p.wave, 0.25 + 0.23, q[0], v[0]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(p.plain, 0.25 + 0.23, q[1], v[1]), DVI_OK);
  ck_assert_mem_eq(q[0], q[1], sizeof q[0]);
  ck_assert_mem_eq(v[0], v[1], sizeof v[0]);
  destroy_pair(&p);
}
END_TEST

/* A new start forgets the gradient that was kept, wherever it was. */
START_TEST(a_new_start_begins_anew)
{
  pair p;
  make_pair(&p, 100, 1, 1, 0, method_of(_i), 1, 0);
  for (int i = 0; i < 3; i++) advance(p.wave, 0.1, 1);
  start_alike(&p);
  for (int i = 0; i < 2; i++) step_both(&p, 0.1);
  check_same(p.wave, p.plain, "after a new start");
  destroy_pair(&p);
}
END_TEST

START_TEST(a_checkpoint_continues_bit_for_bit)
{
  pair p;
  make_pair(&p, 777, 3, 2, 4, method_of(_i), 2, 16);
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  ck_assert_msg(dvi_integrator_save(p.wave, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  dvi_integrator *restored = create_integrator(p.system, dvi_integrator_method(p.wave));
  ck_assert_msg(dvi_integrator_restore(restored, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < 3; i++) step_both(&p, 0.1);
  advance(restored, 0.1, 3);
  check_same(restored, p.wave, "restored");
  check_same(restored, p.plain, "restored, plain");
  dvi_integrator_destroy(&restored);
  destroy_pair(&p);
}
END_TEST

/* The zero is located, and the run's last step is a shorter one. */
static int first_site(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)v, (void)user;
  *g = q[0];
  return 0;
}

START_TEST(runs_with_events_are_those_of_the_plain_sweep)
{
  const dvi_event event = {.name = "first", .value = first_site};
  const dvi_run_options options = {.h = 0.1, .t_end = 7.33, .events = &event, .event_count = 1};
  dvi_run_report wave, plain;
  pair p;
  make_pair(&p, 150, 1, 2, 0, method_of(_i), 2, 8);
  ck_assert_int_eq(dvi_run(p.wave, &options, &wave), DVI_OK);
  ck_assert_int_eq(dvi_run(p.plain, &options, &plain), DVI_OK);
  ck_assert_int_gt(wave.events, 0);
  ck_assert_int_eq(wave.events, plain.events);
  ck_assert_double_eq(wave.event_time, plain.event_time);
  check_same(p.wave, p.plain, "after a run");
  destroy_pair(&p);
}
END_TEST

SUITE(temporal_blocking_failures)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, a_failure_in_mid_wave_is_that_of_the_plain_sweep_and_leaves_no_trace,
                      0, METHODS * TROUBLES);
  tcase_add_loop_test(tests, a_state_that_is_not_finite_is_refused_by_both, 0, METHODS);
  tcase_add_loop_test(tests, a_last_kick_that_overflows_is_refused_by_both, 0, METHODS);
  tcase_add_loop_test(tests, a_step_can_be_taken_back, 0, METHODS);
  tcase_add_loop_test(tests, dense_output_is_that_of_the_plain_sweep, 0, METHODS);
  tcase_add_loop_test(tests, a_new_start_begins_anew, 0, METHODS);
  tcase_add_loop_test(tests, a_checkpoint_continues_bit_for_bit, 0, METHODS);
  tcase_add_loop_test(tests, runs_with_events_are_those_of_the_plain_sweep, 0, METHODS);
}
