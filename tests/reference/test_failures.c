/* labels: reference */
/* The SUNDIALS codes when the input is bad, a callback fails, or the end cannot be reached. */
#define _POSIX_C_SOURCE 200809L /* dup, fileno */
#include <check.h>
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "reference/catalogue.h"
#include "support/suite.h"

static void refuse(const dvi_system *system, double t_end, const double *q, const double *p,
                   dvi_reference_options options, dvi_status expected, const char *word)
{
  double kept_q[2], kept_p[2];
  memcpy(kept_q, q, sizeof kept_q);
  memcpy(kept_p, p, sizeof kept_p);
  ck_assert_int_eq(dvi_reference_solve(system, 0, t_end, kept_q, kept_p, &options, NULL), expected);
  check_words(word);
  ck_assert_int_eq(dvi_reference_judge(system, 0, t_end, kept_q, kept_p, &options, NULL), expected);
  check_words(word);
  ck_assert_mem_eq(kept_q, q, sizeof kept_q);
  ck_assert_mem_eq(kept_p, p, sizeof kept_p);
}

START_TEST(bad_input_is_refused_by_name)
{
  problem *kepler = make("kepler", NULL);
  const dvi_system *system = kepler->system;
  const double *q = kepler->q, *p = kepler->p, nan_q[] = {0.4, (double)NAN},
               inf_p[] = {(double)INFINITY, 1};
  const dvi_reference_options good = {.code = DVI_IDA};
  refuse(NULL, 1, q, p, good, DVI_BAD_ARGUMENT, "system");
  refuse(system, (double)INFINITY, q, p, good, DVI_NOT_FINITE, "inf");
  refuse(system, (double)NAN, q, p, good, DVI_NOT_FINITE, "nan");
  refuse(system, 1, nan_q, p, good, DVI_NOT_FINITE, "q[1]");
  refuse(system, 1, q, inf_p, good, DVI_NOT_FINITE, "p[0]");
  refuse(system, 1, q, p, (dvi_reference_options){.code = (dvi_reference_code)(CODES + 1)},
         DVI_BAD_ARGUMENT, "code");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = -1e-3}, DVI_BAD_ARGUMENT,
         "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = (double)NAN},
         DVI_BAD_ARGUMENT, "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = 1}, DVI_BAD_ARGUMENT,
         "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.absolute_tolerance = -1}, DVI_BAD_ARGUMENT,
         "absolute_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.absolute_tolerance = (double)NAN},
         DVI_BAD_ARGUMENT, "absolute_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.max_steps = -1}, DVI_BAD_ARGUMENT, "max_steps");
  refuse(system, 1, q, p, (dvi_reference_options){.max_seconds = -1}, DVI_BAD_ARGUMENT,
         "max_seconds");
  double state[2] = {0.4, 0};
  ck_assert_int_eq(dvi_reference_solve(system, 0, 1, NULL, state, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_reference_judge(system, 0, 1, state, NULL, NULL, NULL), DVI_BAD_ARGUMENT);
  problem_destroy(&kepler);
}
END_TEST

/* ---- failures on the way ---- */

START_TEST(too_few_steps_stop_with_the_time_reached)
{
  problem *kepler = make("kepler", NULL);
  refuse(kepler->system, 10, kepler->q, kepler->p,
         (dvi_reference_options){
             .code = (dvi_reference_code)_i, .relative_tolerance = 1e-8, .max_steps = 7},
         DVI_REFERENCE_FAILED, "after 7 steps");
  check_words("TOO_MUCH_WORK");
  check_words("allow more steps");
  problem_destroy(&kepler);
}
END_TEST

START_TEST(too_little_time_stops)
{
  problem *kepler = make("kepler", NULL);
  const dvi_reference_options options = {
      .code = (dvi_reference_code)_i, .relative_tolerance = 1e-8, .max_seconds = 0.02};
  refuse(kepler->system, 1e7, kepler->q, kepler->p, options, DVI_REFERENCE_FAILED,
         "max_seconds, 0.02");
  problem_destroy(&kepler);
}
END_TEST

START_TEST(a_start_in_the_singularity_is_refused)
{
  problem *kepler = make("kepler", NULL);
  const double centre[2] = {0, 0};
  refuse(kepler->system, 1, centre, kepler->p, option(_i, 0), DVI_NOT_FINITE, "t = 0");
  problem_destroy(&kepler);
}
END_TEST

/* Falling from rest at r = 1 the bodies meet at t = pi / sqrt(8) = 1.11. */
START_TEST(a_collision_ends_the_run_in_words)
{
  problem *kepler = make("kepler", NULL);
  const double q[2] = {1, 0}, rest[2] = {0, 0};
  dvi_reference_options options = option(_i, 1e-8);
  options.max_steps = 100000;
  refuse(kepler->system, 2, q, rest, options, DVI_REFERENCE_FAILED, "stopped at t = 1.11");
  problem_destroy(&kepler);
}
END_TEST

/* A spring whose force fails once q falls below a half, at about t = 1.05. */
typedef struct bad_spring {
  int returned;
  double force;
} bad_spring;

static int spring_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * (q[0] * q[0] + q[1] * q[1]);
  return 0;
}

static int spring_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  const bad_spring *bad = user;
  V_q[0] = q[0] < 0.5 ? bad->force : q[0];
  V_q[1] = q[1];
  return q[0] < 0.5 ? bad->returned : 0;
}

static void spring_fails(bad_spring bad, int code, dvi_status expected, const char *word)
{
  const dvi_potential potential = {
      .name = "spring", .value = spring_value, .gradient = spring_gradient, .user = &bad};
  const dvi_system_terms terms = {
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  const double q[2] = {1, 0}, p[2] = {0, 0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  refuse(system, 3, q, p, option(code, 1e-6), expected, word);
  double reached = -1;
  ck_assert_int_eq(sscanf(strstr(dvi_last_error(), "stopped at"), "stopped at t = %lf", &reached),
                   1);
  /* a step of this tolerance is at most 0.3 */
  ck_assert_msg(reached > 0 && reached < 1.3, "%s", dvi_last_error());
  dvi_system_destroy(&system);
}

START_TEST(nan_from_a_callback_stops_the_code)
{
  spring_fails((bad_spring){0, (double)NAN}, _i, DVI_REFERENCE_FAILED, "spring");
}
END_TEST

START_TEST(a_callback_that_keeps_asking_for_smaller_steps_stops_the_code)
{
  spring_fails((bad_spring){1, 0}, _i, DVI_REFERENCE_FAILED, "smaller step");
}
END_TEST

START_TEST(a_callback_that_fails_for_good_gives_its_own_status)
{
  spring_fails((bad_spring){-3, 0}, _i, DVI_CALLBACK_FAILED, "-3");
}
END_TEST

/* SUNDIALS' own messages go to both streams unless they are stopped. */
START_TEST(failures_print_nothing)
{
  FILE *seen = tmpfile();
  ck_assert_ptr_nonnull(seen);
  fflush(stdout);
  const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
  dup2(fileno(seen), STDOUT_FILENO);
  dup2(fileno(seen), STDERR_FILENO);
  problem *kepler = make("kepler", NULL);
  double q[2] = {1, 0}, p[2] = {0, 0};
  dvi_reference_options options = option(_i, 1e-8);
  options.max_steps = 100000;
  const dvi_status collision = dvi_reference_solve(kepler->system, 0, 2, q, p, &options, NULL);
  options.max_steps = 2;
  const dvi_status work = dvi_reference_solve(kepler->system, 0, 2, q, p, &options, NULL);
  problem_destroy(&kepler);
  fflush(stdout);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  close(out);
  close(err);
  fseek(seen, 0, SEEK_END);
  ck_assert_int_eq(ftell(seen), 0);
  fclose(seen);
  ck_assert(collision == DVI_REFERENCE_FAILED && work == DVI_REFERENCE_FAILED);
}
END_TEST

/* Every allocation of a run fails once. valgrind and the sanitizers look for leaks. */
START_TEST(no_memory_is_a_status)
{
  problem *kepler = make("kepler", NULL);
  double q[2], p[2];
  const dvi_reference_options options = option(_i, 1e-6);
  dvi_status status = DVI_NO_MEMORY;
  long successes = 0;
  for (; status != DVI_OK && successes < 1000; successes++) {
    start(kepler, q, p);
    dvi__fail_allocations_after(successes);
    status = dvi_reference_judge(kepler->system, 0, 1, q, p, &options, NULL);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    ck_assert(status == DVI_OK || memcmp(q, kepler->q, sizeof q) == 0);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(successes, 5);
  problem_destroy(&kepler);
}
END_TEST

SUITE(failures)
{
  tcase_add_test(tests, bad_input_is_refused_by_name);
  tcase_add_loop_test(tests, too_few_steps_stop_with_the_time_reached, 0, CODES);
  tcase_add_loop_test(tests, too_little_time_stops, 0, CODES);
  tcase_add_loop_test(tests, a_start_in_the_singularity_is_refused, 0, CODES);
  tcase_add_loop_test(tests, a_collision_ends_the_run_in_words, 0, CODES);
  tcase_add_loop_test(tests, nan_from_a_callback_stops_the_code, 0, CODES);
  tcase_add_loop_test(tests, a_callback_that_keeps_asking_for_smaller_steps_stops_the_code, 0,
                      CODES);
  tcase_add_loop_test(tests, a_callback_that_fails_for_good_gives_its_own_status, 0, CODES);
  tcase_add_loop_test(tests, failures_print_nothing, 0, CODES);
  tcase_add_loop_test(tests, no_memory_is_a_status, 0, CODES);
}
