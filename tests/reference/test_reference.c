/* labels: reference */
/* The SUNDIALS codes against exact solutions and printed digits. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/catalogue.h"
#include "support/suite.h"

static double distance(int n, const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i] - b[i]));
  return largest;
}

/* Distance from the exact state at t_end after a run of one code. */
static double exact_error(const problem *model, dvi_reference_options options, double t_end,
                          dvi_reference_report *report)
{
  double q[MOST], p[MOST], exact_q[MOST], exact_p[MOST];
  start(model, q, p);
  ck_assert_msg(dvi_reference_solve(model->system, 0, t_end, q, p, &options, report) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_eq(model->exact(model, t_end, exact_q, exact_p), 0);
  return fmax(distance(model->nq, q, exact_q), distance(model->nq, p, exact_p));
}

/* The codes bound the error of each step, so the errors after all steps lie above the tolerance:
 * over one period of the oscillator by some 10 times, over kepler's ten time units with close
 * passages by some 1000 (BDF, the worst: 5e-9). */
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

/* Four orders in the tolerance give at least three in the error, because variable-order codes are
 * not exactly proportional. */
START_TEST(the_error_follows_the_tolerance)
{
  problem *kepler = make("kepler", NULL);
  const double loose = exact_error(kepler, option(_i, 1e-6), 10, NULL),
               tight = exact_error(kepler, option(_i, 1e-10), 10, NULL);
  ck_assert_double_lt(tight, 1e-3 * loose);
  problem_destroy(&kepler);
}
END_TEST

/* Its mass depends on q, so the inverse Legendre map and the blocks L_qv and L_vv are used. */
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

/* Particle k has coordinates x = q[2k], y = q[2k+1], with L = v.v/2 + B (x vy - y vx)/2 - K
 * q.q/2. */
typedef struct trap {
  int n;
  double B, K;
} trap;

static int trap_value(double t, const double *q, const double *v, double *L, void *user)
{
  const trap *own = user;
  (void)t;
  *L = 0;
  for (int i = 0; i < own->n; i++) *L += 0.5 * (v[i] * v[i] - own->K * q[i] * q[i]);
  for (int i = 0; i < own->n; i += 2) *L += 0.5 * own->B * (q[i] * v[i + 1] - q[i + 1] * v[i]);
  return 0;
}

static int trap_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  const trap *own = user;
  (void)t;
  for (int i = 0; i < own->n; i += 2) {
    L_q[i] = 0.5 * own->B * v[i + 1] - own->K * q[i];
    L_q[i + 1] = -0.5 * own->B * v[i] - own->K * q[i + 1];
    L_v[i] = v[i] - 0.5 * own->B * q[i + 1];
    L_v[i + 1] = v[i + 1] + 0.5 * own->B * q[i];
  }
  return 0;
}

static int trap_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                        double *L_vv, void *user)
{
  const trap *own = user;
  (void)t, (void)q, (void)v;
  for (int i = 0; i < own->n; i++) {
    L_qq[i] = -own->K;
    L_qv[i] = i % 2 == 0 ? -0.5 * own->B : 0.5 * own->B; /* columns vx, vy with rows y, x */
    L_vv[i] = 1;
  }
  return 0;
}

static dvi_system *trapped(trap *own)
{
  int begin[MOST + 1], diagonal[MOST], partner[MOST];
  for (int i = 0; i <= own->n; i++) begin[i] = i;
  for (int i = 0; i < own->n; i++) {
    diagonal[i] = i;
    partner[i] = i % 2 == 0 ? i + 1 : i - 1;
  }
  const dvi_lagrangian lagrangian = {.value = trap_value,
                                     .gradient = trap_gradient,
                                     .hessian = trap_hessian,
                                     .qq = {begin, diagonal},
                                     .qv = {begin, partner},
                                     .vv = {begin, diagonal},
                                     .user = own};
  dvi_system *system = NULL;
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.dimension = own->n, .lagrangian = &lagrangian},
                        &system),
      DVI_OK);
  return system;
}

/* z = x + iy solves z" + i B z' + K z = 0. The start is on the slow circle z = exp(i a t), a^2 + B
 * a = K, where all particles stay. */
static double circle(const trap *own, double *q, double *p)
{
  const double a = 0.5 * (sqrt(own->B * own->B + 4 * own->K) - own->B);
  for (int i = 0; i < own->n; i++) {
    q[i] = i % 2 == 0;
    p[i] = i % 2 == 0 ? 0 : a + 0.5 * own->B;
  }
  return a;
}

/* Two particles take the dense path, twenty KLU. */
START_TEST(each_code_meets_the_exact_motion_in_a_magnetic_field)
{
  for (int n = 4; n <= MOST; n *= 10) {
    trap own = {.n = n, .B = 2, .K = 3};
    dvi_system *system = trapped(&own);
    double q[MOST], p[MOST];
    const double a = circle(&own, q, p), exact[2] = {cos(3 * a), sin(3 * a)};
    const dvi_reference_options options = option(_i, 1e-11);
    ck_assert_msg(dvi_reference_solve(system, 0, 3, q, p, &options, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    /* some 1000 steps of 1e-11 each */
    for (int i = 0; i < n; i += 2) ck_assert_double_lt(distance(2, q + i, exact), 2e-8);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* A strong field is stiff: the other root, about -B, is far beyond the steps that the slow circle
 * needs, so Newton's method converges with the right Jacobian only: about 100 residuals; a wrong
 * block makes it 10^5. */
START_TEST(ida_has_the_right_jacobian)
{
  for (int n = 4; n <= MOST; n *= 10) {
    trap own = {.n = n, .B = 1e4, .K = 1e4};
    dvi_system *system = trapped(&own);
    double q[MOST], p[MOST];
    (void)circle(&own, q, p);
    const dvi_reference_options options = option(DVI_IDA, 1e-5);
    dvi_reference_report report;
    ck_assert_msg(dvi_reference_solve(system, 0, 3, q, p, &options, &report) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_lt(report.evaluations, 1000);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* For BDF the stiff springs are at rest, and only the slow ones push them. The right Jacobian takes
 * about 120 evaluations. */
START_TEST(bdf_has_the_right_jacobian)
{
  problem *fpu = make("fpu", "omega=1e4");
  double q[MOST], p[MOST];
  start(fpu, q, p);
  for (int i = fpu->nq / 2; i < fpu->nq; i++) q[i] = p[i] = 0;
  const dvi_reference_options options = option(DVI_CVODE_BDF, 1e-5);
  dvi_reference_report report;
  ck_assert_msg(dvi_reference_solve(fpu->system, 0, 3, q, p, &options, &report) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_lt(report.evaluations, 1000);
  problem_destroy(&fpu);
}
END_TEST

/* Forty coordinates, with KLU in IDA and BDF. */
START_TEST(sparse_systems_agree_with_the_explicit_code)
{
  problem *fpu = make("fpu", "ell=20");
  double q[MOST], p[MOST], explicit_q[MOST], explicit_p[MOST];
  const dvi_reference_options options = option(_i, 1e-9), tight = option(DVI_ARKODE, 1e-12);
  start(fpu, q, p);
  start(fpu, explicit_q, explicit_p);
  ck_assert_int_eq(dvi_reference_solve(fpu->system, 0, 1, explicit_q, explicit_p, &tight, NULL),
                   DVI_OK);
  ck_assert_int_eq(dvi_reference_solve(fpu->system, 0, 1, q, p, &options, NULL), DVI_OK);
  ck_assert_double_lt(distance(fpu->nq, q, explicit_q), 1e-6); /* some 1000 steps of 1e-9 each */
  problem_destroy(&fpu);
}
END_TEST

/* ---- time in the Lagrangian, and no derivatives given ---- */

/* L = exp(t) (v^2 - 2 q^2)/2, with q" + q' + 2 q = 0 and p = exp(t) v. */
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
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.dimension = 1, .lagrangian = &lagrangian}, &system),
      DVI_OK);
  double q = 1, p = 1;
  /* differences of differences have a floor of about 1e-8 */
  const dvi_reference_options options = option(_i, 1e-7);
  ck_assert_msg(dvi_reference_solve(system, 0, 0.5, &q, &p, &options, NULL) == DVI_OK, "%s",
                dvi_last_error());
  const double rate = sqrt(1.75),
               exact = exp(-0.25) * (cos(0.5 * rate) + 1.5 / rate * sin(0.5 * rate));
  ck_assert_double_lt(fabs(q - exact), 1e-5);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(the_judge_at_its_defaults_takes_a_lagrangian_without_derivatives)
{
  const dvi_lagrangian lagrangian = {.value = damped_value};
  dvi_system *system = NULL;
  dvi_reference_report report;
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.dimension = 1, .lagrangian = &lagrangian}, &system),
      DVI_OK);
  double q = 1, p = 1;
  ck_assert_msg(dvi_reference_judge(system, 0, 0.5, &q, &p, NULL, &report) == DVI_OK, "%s",
                dvi_last_error());
  const double rate = sqrt(1.75),
               exact = exp(-0.25) * (cos(0.5 * rate) + 1.5 / rate * sin(0.5 * rate));
  /* the factor of the test below, and the differences' own noise */
  ck_assert_double_lt(fabs(q - exact), 5 * report.error + 1e-10);
  ck_assert_double_lt(report.error, 1e-6);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- the judge ---- */

/* The claim is the distance of the two runs: an upper estimate of the second run's error where the
 * error falls with the tolerance. The codes choose steps and orders anew in each run, so a tenth of
 * the tolerance need not halve the error (on the oscillator at 1e-12: claimed 4.4e-12, true
 * 7.2e-12): hence the factor 5. 1e-14 is for roundoff. The codes that are not the judge are worse:
 * two inaccurate runs of Adams may err alike (1e-6: claimed 1.1e-7, true 9.4e-7). */
START_TEST(ida_bounds_its_own_error)
{
  const char *const names[] = {"oscillator", "kepler"};
  for (int k = 0; k < 2; k++) {
    problem *model = make(names[k], NULL);
    for (int digits = 6; digits <= 12; digits++) {
      const double tolerance = pow(10, -digits);
      double q[2], p[2], exact_q[2], exact_p[2];
      dvi_reference_report report;
      const dvi_reference_options options = option(DVI_IDA, tolerance);
      start(model, q, p);
      ck_assert_int_eq(dvi_reference_judge(model->system, 0, 5, q, p, &options, &report), DVI_OK);
      ck_assert_int_eq(model->exact(model, 5, exact_q, exact_p), 0);
      ck_assert_msg(distance(model->nq, q, exact_q) <= 5 * report.error + 1e-14,
                    "%s at %g: error %g, claimed %g", names[k], tolerance,
                    distance(model->nq, q, exact_q), report.error);
    }
    problem_destroy(&model);
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
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 3, loose_q, loose_p, &loose, NULL),
                   DVI_OK);
  ck_assert_int_eq(
      dvi_reference_solve(kepler->system, 0, 3, tight_q, tight_p, &tight, &tight_report), DVI_OK);
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
  ck_assert_int_eq(dvi_reference_solve(kepler->system, 0, 1, default_q, default_p, NULL, NULL),
                   DVI_OK);
  ck_assert_mem_eq(q, default_q, sizeof q);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(codes_have_names_and_sundials_a_version)
{
  const char *const names[] = {"ida", "cvode-adams", "cvode-bdf", "arkode", "ida-index-2"};
  for (int code = 0; code <= CODES; code++)
    ck_assert_str_eq(dvi_reference_name((dvi_reference_code)code), names[code]);
  ck_assert_ptr_null(dvi_reference_name((dvi_reference_code)(CODES + 1)));
  const double version = strtod(dvi_reference_version(), NULL); /* major.minor */
  ck_assert_msg(version >= 6.4 && version < 8, "%s", dvi_reference_version());
}
END_TEST

START_TEST(tolerances_down_to_1e_14_work_or_are_refused_in_words)
{
  const char *const names[] = {"oscillator", "kepler", "double-pendulum", "stiff-pendulum"};
  int worked = 0;
  for (int k = 0; k < 4; k++) {
    problem *model = make(names[k], NULL);
    double q[2], p[2];
    start(model, q, p);
    const dvi_reference_options options = option(_i, 1e-14);
    const dvi_status status = dvi_reference_judge(model->system, 0, 1, q, p, &options, NULL);
    ck_assert(status == DVI_OK || (status == DVI_REFERENCE_FAILED &&
                                   strstr(dvi_last_error(), "stopped at t = ") != NULL));
    worked += status == DVI_OK;
    problem_destroy(&model);
  }
  ck_assert_int_ge(worked, 3); /* IDA refuses the double pendulum */
}
END_TEST

SUITE(reference)
{
  tcase_add_loop_test(tests, each_code_meets_the_exact_oscillator, 0, CODES);
  tcase_add_loop_test(tests, each_code_meets_the_exact_kepler, 0, CODES);
  tcase_add_loop_test(tests, each_code_goes_backward, 0, CODES);
  tcase_add_loop_test(tests, the_error_follows_the_tolerance, 0, CODES);
  tcase_add_loop_test(tests, each_code_meets_the_digits_of_the_double_pendulum, 0, CODES);
  tcase_add_loop_test(tests, each_code_meets_the_exact_motion_in_a_magnetic_field, 0, CODES);
  tcase_add_test(tests, ida_has_the_right_jacobian);
  tcase_add_test(tests, bdf_has_the_right_jacobian);
  tcase_add_loop_test(tests, sparse_systems_agree_with_the_explicit_code, 0, CODES);
  tcase_add_loop_test(tests, each_code_takes_a_lagrangian_with_time_and_without_derivatives, 0,
                      CODES);
  tcase_add_test(tests, the_judge_at_its_defaults_takes_a_lagrangian_without_derivatives);
  tcase_add_test(tests, ida_bounds_its_own_error);
  tcase_add_loop_test(tests, the_judge_is_two_runs, 0, CODES);
  tcase_add_loop_test(tests, no_time_leaves_the_state, 0, CODES);
  tcase_add_loop_test(tests, the_report_says_what_was_done, 0, CODES);
  tcase_add_test(tests, left_out_options_are_ida_at_1e_12);
  tcase_add_test(tests, codes_have_names_and_sundials_a_version);
  tcase_add_loop_test(tests, tolerances_down_to_1e_14_work_or_are_refused_in_words, 0, CODES);
}
