/* labels: reference */
/* The SUNDIALS codes against exact solutions and printed digits, and their behaviour when they fail. */
#define _POSIX_C_SOURCE 200809L /* dup, fileno */
#include <check.h>
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "problem.h"

enum { CODES = 4, MOST = 40 };

static problem *make(const char *name, const char *setting)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create(name, setting != NULL, &setting, &made, message, sizeof message) == DVI_OK, "%s", message);
  ck_assert_int_le(made->n, MOST);
  return made;
}

static dvi_reference_options option(int code, double tolerance)
{
  return (dvi_reference_options){.code = (dvi_reference_code)code, .relative_tolerance = tolerance};
}

static double distance(int n, const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i] - b[i]));
  return largest;
}

static void start(const problem *of, double *q, double *p)
{
  memcpy(q, of->q, (size_t)of->n * sizeof *q);
  memcpy(p, of->p, (size_t)of->n * sizeof *p);
}

/* Distance from the exact state at t_end after a run of one code. */
static double exact_error(const problem *of, dvi_reference_options options, double t_end, dvi_reference_report *report)
{
  double q[MOST], p[MOST], exact_q[MOST], exact_p[MOST];
  start(of, q, p);
  ck_assert_msg(dvi_reference_solve(of->system, 0, t_end, q, p, &options, report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(of->exact(of, t_end, exact_q, exact_p), 0);
  return fmax(distance(of->n, q, exact_q), distance(of->n, p, exact_p));
}

/* The codes bound the error of each step, so the errors after all steps lie above the tolerance: over one period of the oscillator
 * by some 10 times, over kepler's ten time units with close passages by some 1000 (BDF, the worst: 5e-9). */
START_TEST(each_code_meets_the_exact_oscillator)
{
  problem *oscillator = make("oscillator", NULL);
  ck_assert_double_lt(exact_error(oscillator, option(_i, 1e-12), 1, NULL), 2e-10);
  problem_destroy(&oscillator);
}
END_TEST

START_TEST(each_code_meets_the_exact_kepler)
{
  problem *kepler = make("kepler", NULL);
  ck_assert_double_lt(exact_error(kepler, option(_i, 1e-12), 10, NULL), 2e-8);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(each_code_goes_backward)
{
  problem *kepler = make("kepler", NULL);
  ck_assert_double_lt(exact_error(kepler, option(_i, 1e-12), -10, NULL), 2e-8);
  problem_destroy(&kepler);
}
END_TEST

/* Four orders in the tolerance give at least three in the error: variable-order codes are not exactly proportional. */
START_TEST(the_error_follows_the_tolerance)
{
  problem *kepler = make("kepler", NULL);
  const double loose = exact_error(kepler, option(_i, 1e-6), 10, NULL), tight = exact_error(kepler, option(_i, 1e-10), 10, NULL);
  ck_assert_double_lt(tight, 1e-3 * loose);
  problem_destroy(&kepler);
}
END_TEST

/* Its mass depends on q: the inverse Legendre map and the blocks L_qv and L_vv are at work. */
START_TEST(each_code_meets_the_digits_of_the_double_pendulum)
{
  static const double digits[] = {0.614904069579215873, 0.379818946939410850};
  problem *pendulum = make("double-pendulum", NULL);
  double q[2], p[2];
  start(pendulum, q, p);
  const dvi_reference_options options = option(_i, 1e-12);
  ck_assert_int_eq(dvi_reference_solve(pendulum->system, 0, 1, q, p, &options, NULL), DVI_OK);
  ck_assert_double_lt(distance(2, q, digits), 1e-9); /* 100 to 1000 steps of 1e-12 each */
  problem_destroy(&pendulum);
}
END_TEST

/* ---- charged particles in a trap: sparse, with an unsymmetric L_qv ---- */

/* Particle k has coordinates x = q[2k], y = q[2k+1]; L = v.v/2 + B (x vy - y vx)/2 - K q.q/2. */
static const double B = 2, K = 3;

static int trap_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t;
  *L = 0;
  for (int i = 0; i < *(int *)user; i += 2)
    *L += 0.5 *
          (v[i] * v[i] + v[i + 1] * v[i + 1] + B * (q[i] * v[i + 1] - q[i + 1] * v[i]) - K * (q[i] * q[i] + q[i + 1] * q[i + 1]));
  return 0;
}

static int trap_gradient(double t, const double *q, const double *v, double *L_q, double *L_v, void *user)
{
  (void)t;
  for (int i = 0; i < *(int *)user; i += 2) {
    L_q[i] = 0.5 * B * v[i + 1] - K * q[i];
    L_q[i + 1] = -0.5 * B * v[i] - K * q[i + 1];
    L_v[i] = v[i] - 0.5 * B * q[i + 1];
    L_v[i + 1] = v[i + 1] + 0.5 * B * q[i];
  }
  return 0;
}

static int trap_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv, double *L_vv, void *user)
{
  (void)t, (void)q, (void)v;
  for (int i = 0; i < *(int *)user; i++) {
    L_qq[i] = -K;
    L_qv[i] = i % 2 == 0 ? -0.5 * B : 0.5 * B; /* columns vx, vy: rows y, x */
    L_vv[i] = 1;
  }
  return 0;
}

static dvi_system *trap(int *n)
{
  int begin[MOST + 1], diagonal[MOST], partner[MOST];
  for (int i = 0; i <= *n; i++) begin[i] = i;
  for (int i = 0; i < *n; i++) {
    diagonal[i] = i;
    partner[i] = i % 2 == 0 ? i + 1 : i - 1;
  }
  const dvi_lagrangian lagrangian = {.value = trap_value,
                                     .gradient = trap_gradient,
                                     .hessian = trap_hessian,
                                     .qq = {begin, diagonal},
                                     .qv = {begin, partner},
                                     .vv = {begin, diagonal},
                                     .user = n};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = *n, .lagrangian = &lagrangian}, &system), DVI_OK);
  return system;
}

/* From rest at (1,0): z = x + iy solves z" + i B z' + K z = 0, a sum of exp(i a t) with the two roots a of a^2 + B a = K. */
static void trap_exact(double t, double *x, double *y)
{
  const double root = sqrt(B * B + 4 * K), a = 0.5 * (root - B), b = -0.5 * (root + B);
  *x = (a * cos(b * t) - b * cos(a * t)) / (a - b);
  *y = (a * sin(b * t) - b * sin(a * t)) / (a - b);
}

/* Two particles take the dense path, twenty KLU. */
START_TEST(each_code_meets_the_exact_motion_in_a_magnetic_field)
{
  for (int n = 4; n <= MOST; n *= 10) {
    dvi_system *system = trap(&n);
    double q[MOST], p[MOST], exact[2];
    for (int i = 0; i < n; i++) {
      q[i] = i % 2 == 0;
      p[i] = i % 2 == 0 ? 0 : 0.5 * B;
    }
    const dvi_reference_options options = option(_i, 1e-11);
    dvi_reference_report report;
    ck_assert_msg(dvi_reference_solve(system, 0, 3, q, p, &options, &report) == DVI_OK, "%s", dvi_last_error());
    trap_exact(3, &exact[0], &exact[1]);
    for (int i = 0; i < n; i += 2) ck_assert_double_lt(distance(2, q + i, exact), 2e-8);
    /* A right Jacobian needs one or two residuals a step; a wrong one fails to converge, and many steps are tried again. */
    if (_i == DVI_IDA) ck_assert_double_lt((double)report.evaluations, 1.5 * (double)report.steps);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* ---- time in the Lagrangian, and no derivatives given ---- */

/* L = exp(t) (v^2 - 2 q^2)/2, that is q" + q' + 2 q = 0: p = exp(t) v. */
static int damped_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)user;
  *L = 0.5 * exp(t) * (v[0] * v[0] - 2 * q[0] * q[0]);
  return 0;
}

START_TEST(each_code_takes_a_lagrangian_with_time_and_without_derivatives)
{
  const dvi_lagrangian lagrangian = {.value = damped_value};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = 1, .lagrangian = &lagrangian}, &system), DVI_OK);
  double q = 1, p = 1;
  const dvi_reference_options options = option(_i, 1e-7); /* differences of differences: about 1e-8 is their floor */
  ck_assert_msg(dvi_reference_solve(system, 0, 0.5, &q, &p, &options, NULL) == DVI_OK, "%s", dvi_last_error());
  const double rate = sqrt(1.75), exact = exp(-0.25) * (cos(0.5 * rate) + 1.5 / rate * sin(0.5 * rate));
  ck_assert_double_lt(fabs(q - exact), 1e-5);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- the judge ---- */

/* The claim is the distance of the two runs: an upper estimate of the second run's error where the error falls with the tolerance.
 * The codes choose steps and orders anew in each run, so a tenth of the tolerance need not halve the error (on the oscillator at
 * 1e-12: claimed 4.4e-12, true 7.2e-12): hence the factor 5. 1e-14 is for roundoff. The codes that are not the judge are worse: two
 * inaccurate runs of Adams may err alike (1e-6: claimed 1.1e-7, true 9.4e-7). */
START_TEST(ida_bounds_its_own_error)
{
  const char *const names[] = {"oscillator", "kepler"};
  for (int k = 0; k < 2; k++) {
    problem *of = make(names[k], NULL);
    for (double tolerance = 1e-6; tolerance > 1e-13; tolerance /= 10) {
      double q[2], p[2], exact_q[2], exact_p[2];
      dvi_reference_report report;
      const dvi_reference_options options = option(DVI_IDA, tolerance);
      start(of, q, p);
      ck_assert_int_eq(dvi_reference_judge(of->system, 0, 5, q, p, &options, &report), DVI_OK);
      ck_assert_int_eq(of->exact(of, 5, exact_q, exact_p), 0);
      ck_assert_msg(distance(of->n, q, exact_q) <= 5 * report.error + 1e-14, "%s at %g: error %g, claimed %g", names[k], tolerance,
                    distance(of->n, q, exact_q), report.error);
    }
    problem_destroy(&of);
  }
}
END_TEST

START_TEST(the_judge_is_two_runs)
{
  problem *kepler = make("kepler", NULL);
  const dvi_reference_options loose = option(_i, 1e-8);
  dvi_reference_options tight = option(_i, 1e-8 / 10);
  tight.absolute_tolerance = tight.relative_tolerance;
  double loose_q[2], loose_p[2], tight_q[2], tight_p[2], q[2], p[2];
  dvi_reference_report tight_report, report;
  start(kepler, loose_q, loose_p);
  start(kepler, tight_q, tight_p);
  start(kepler, q, p);
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 3, loose_q, loose_p, &loose, NULL), DVI_OK);
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 3, tight_q, tight_p, &tight, &tight_report), DVI_OK);
  ck_assert_int_eq(dvi_reference_judge(kepler->system, 0, 3, q, p, &loose, &report), DVI_OK);
  ck_assert_mem_eq(q, tight_q, sizeof q);
  ck_assert_mem_eq(p, tight_p, sizeof p);
  ck_assert(report.error == distance(2, loose_q, tight_q) && report.error > 0);
  ck_assert_int_eq(report.steps, tight_report.steps);
  problem_destroy(&kepler);
}
END_TEST

/* ---- reports, names, edges ---- */

START_TEST(no_time_leaves_the_state)
{
  problem *kepler = make("kepler", NULL);
  double q[2], p[2];
  start(kepler, q, p);
  dvi_reference_report report;
  const dvi_reference_options options = option(_i, 0);
  ck_assert_int_eq(dvi_reference_judge(kepler->system, 2, 2, q, p, &options, &report), DVI_OK);
  ck_assert_mem_eq(q, kepler->q, sizeof q);
  ck_assert_mem_eq(p, kepler->p, sizeof p);
  ck_assert(report.error == 0 && report.steps == 0);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(the_report_says_what_was_done)
{
  problem *kepler = make("kepler", NULL);
  dvi_reference_report report;
  (void)exact_error(kepler, option(_i, 0), 1, &report);
  ck_assert_int_gt(report.steps, 10);
  ck_assert_int_gt(report.evaluations, report.steps);
  ck_assert(report.cpu_seconds > 0 && report.cpu_seconds < 60 && isnan(report.error));
  problem_destroy(&kepler);
}
END_TEST

START_TEST(left_out_options_are_ida_at_1e_12)
{
  problem *kepler = make("kepler", NULL);
  dvi_reference_options all = option(DVI_IDA, 1e-12);
  all.absolute_tolerance = 1e-12;
  double q[2], p[2], default_q[2], default_p[2];
  start(kepler, q, p);
  start(kepler, default_q, default_p);
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 1, q, p, &all, NULL), DVI_OK);
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 1, default_q, default_p, NULL, NULL), DVI_OK);
  ck_assert_mem_eq(q, default_q, sizeof q);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(codes_have_names_and_sundials_a_version)
{
  const char *const names[] = {"ida", "cvode-adams", "cvode-bdf", "arkode"};
  for (int code = 0; code < CODES; code++) ck_assert_str_eq(dvi_reference_name((dvi_reference_code)code), names[code]);
  ck_assert_ptr_null(dvi_reference_name((dvi_reference_code)CODES));
  int major = 0, minor = 0;
  ck_assert_int_eq(sscanf(dvi_reference_version(), "%d.%d", &major, &minor), 2);
  ck_assert((major == 6 && minor >= 4) || major == 7);
}
END_TEST

START_TEST(tolerances_down_to_1e_14_work_or_are_refused_in_words)
{
  const char *const names[] = {"oscillator", "kepler", "double-pendulum", "stiff-pendulum"};
  for (int k = 0; k < 4; k++) {
    problem *of = make(names[k], NULL);
    double q[2], p[2];
    start(of, q, p);
    const dvi_reference_options options = option(_i, 1e-14);
    const dvi_status status = dvi_reference_judge(of->system, 0, 1, q, p, &options, NULL);
    ck_assert(status == DVI_OK || (status == DVI_REFERENCE_FAILED && strstr(dvi_last_error(), "stopped at t = ") != NULL));
    problem_destroy(&of);
  }
}
END_TEST

/* ---- bad input ---- */

static void refuse(const dvi_system *system, double t_end, const double *q, const double *p, dvi_reference_options options,
                   dvi_status expected, const char *word)
{
  double kept_q[2], kept_p[2];
  memcpy(kept_q, q, sizeof kept_q);
  memcpy(kept_p, p, sizeof kept_p);
  ck_assert_int_eq(dvi_reference_solve(system, 0, t_end, kept_q, kept_p, &options, NULL), expected);
  ck_assert_msg(strstr(dvi_last_error(), word) != NULL, "'%s' is not in: %s", word, dvi_last_error());
  ck_assert_int_eq(dvi_reference_judge(system, 0, t_end, kept_q, kept_p, &options, NULL), expected);
  ck_assert_msg(strstr(dvi_last_error(), word) != NULL, "'%s' is not in: %s", word, dvi_last_error());
  ck_assert_mem_eq(kept_q, q, sizeof kept_q);
  ck_assert_mem_eq(kept_p, p, sizeof kept_p);
}

START_TEST(bad_input_is_refused_by_name)
{
  problem *kepler = make("kepler", NULL);
  const dvi_system *system = kepler->system;
  const double *q = kepler->q, *p = kepler->p, nan_q[] = {0.4, (double)NAN}, inf_p[] = {(double)INFINITY, 1};
  const dvi_reference_options good = {.code = DVI_IDA};
  refuse(NULL, 1, q, p, good, DVI_BAD_ARGUMENT, "system");
  refuse(system, (double)INFINITY, q, p, good, DVI_NOT_FINITE, "inf");
  refuse(system, (double)NAN, q, p, good, DVI_NOT_FINITE, "nan");
  refuse(system, 1, nan_q, p, good, DVI_NOT_FINITE, "q[1]");
  refuse(system, 1, q, inf_p, good, DVI_NOT_FINITE, "p[0]");
  refuse(system, 1, q, p, (dvi_reference_options){.code = (dvi_reference_code)CODES}, DVI_BAD_ARGUMENT, "code");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = -1e-3}, DVI_BAD_ARGUMENT, "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = (double)NAN}, DVI_BAD_ARGUMENT, "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.relative_tolerance = 1}, DVI_BAD_ARGUMENT, "relative_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.absolute_tolerance = -1}, DVI_BAD_ARGUMENT, "absolute_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.absolute_tolerance = (double)NAN}, DVI_BAD_ARGUMENT, "absolute_tolerance");
  refuse(system, 1, q, p, (dvi_reference_options){.max_steps = -1}, DVI_BAD_ARGUMENT, "max_steps");
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
         (dvi_reference_options){.code = (dvi_reference_code)_i, .relative_tolerance = 1e-8, .max_steps = 7}, DVI_REFERENCE_FAILED,
         "after 7 steps");
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "TOO_MUCH_WORK"));
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "allow more steps"));
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

/* A spring whose force misbehaves once q falls below a half: at about t = 1.05. */
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
  const dvi_potential potential = {.name = "spring", .value = spring_value, .gradient = spring_gradient, .user = &bad};
  const dvi_system_terms terms = {.dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  const double q[2] = {1, 0}, p[2] = {0, 0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  refuse(system, 3, q, p, option(code, 1e-6), expected, word);
  double reached = -1;
  ck_assert_int_eq(sscanf(strstr(dvi_last_error(), "stopped at"), "stopped at t = %lf", &reached), 1);
  ck_assert_msg(reached > 0 && reached < 1.3, "%s", dvi_last_error()); /* a step of this tolerance is at most 0.3 */
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

/* Every allocation of a run fails once; leaks are for valgrind and the sanitizers to see. */
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

static Suite *reference(void)
{
  Suite *suite = suite_create("reference");
  TCase *answers = tcase_create("answers"), *edges = tcase_create("edges"), *failures = tcase_create("failures");
  tcase_add_loop_test(answers, each_code_meets_the_exact_oscillator, 0, CODES);
  tcase_add_loop_test(answers, each_code_meets_the_exact_kepler, 0, CODES);
  tcase_add_loop_test(answers, each_code_goes_backward, 0, CODES);
  tcase_add_loop_test(answers, the_error_follows_the_tolerance, 0, CODES);
  tcase_add_loop_test(answers, each_code_meets_the_digits_of_the_double_pendulum, 0, CODES);
  tcase_add_loop_test(answers, each_code_meets_the_exact_motion_in_a_magnetic_field, 0, CODES);
  tcase_add_loop_test(answers, each_code_takes_a_lagrangian_with_time_and_without_derivatives, 0, CODES);
  tcase_add_test(answers, ida_bounds_its_own_error);
  tcase_add_loop_test(answers, the_judge_is_two_runs, 0, CODES);
  tcase_add_loop_test(edges, no_time_leaves_the_state, 0, CODES);
  tcase_add_loop_test(edges, the_report_says_what_was_done, 0, CODES);
  tcase_add_test(edges, left_out_options_are_ida_at_1e_12);
  tcase_add_test(edges, codes_have_names_and_sundials_a_version);
  tcase_add_loop_test(edges, tolerances_down_to_1e_14_work_or_are_refused_in_words, 0, CODES);
  tcase_add_test(failures, bad_input_is_refused_by_name);
  tcase_add_loop_test(failures, too_few_steps_stop_with_the_time_reached, 0, CODES);
  tcase_add_loop_test(failures, a_start_in_the_singularity_is_refused, 0, CODES);
  tcase_add_loop_test(failures, a_collision_ends_the_run_in_words, 0, CODES);
  tcase_add_loop_test(failures, nan_from_a_callback_stops_the_code, 0, CODES);
  tcase_add_loop_test(failures, a_callback_that_keeps_asking_for_smaller_steps_stops_the_code, 0, CODES);
  tcase_add_loop_test(failures, a_callback_that_fails_for_good_gives_its_own_status, 0, CODES);
  tcase_add_loop_test(failures, failures_print_nothing, 0, CODES);
  tcase_add_loop_test(failures, no_memory_is_a_status, 0, CODES);
  suite_add_tcase(suite, answers);
  suite_add_tcase(suite, edges);
  suite_add_tcase(suite, failures);
  return suite;
}

int main(void)
{
  SRunner *runner = srunner_create(reference());
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
