/* labels: reference */
/* Tests the reference codes on rotations, directions and angles against exact solutions and digits,
 * and against the errors that they state. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/catalogue.h"
#include "support/runs.h"
#include "support/suite.h"

static const char *const problems[] = {
    "free-body",       "pendulum-3d", "heavy-top", "kovalevskaya", "spherical-double-pendulum",
    "spherical-chain", "two-body",    "satellite"};

/* At 1e-9 every code is within 1e-5 of the digits (BDF of the fast top loses most), on the manifold
 * to rounding, with a momentum on it. */
START_TEST(every_code_meets_the_digits)
{
  problem *model = make(problems[_i / CODES], NULL);
  const dvi_reference_options options = option(_i % CODES, 1e-9);
  const double size = fmax(1, magnitude(model->nv, model->digits_p));
  double q[MOST], p[MOST];
  start(model, q, p);
  const dvi_status status = dvi_reference_solve(model->system, 0, model->order_t_end, q, p,
                                                &options, NULL);
  ck_assert_msg(status == DVI_OK, "%s: %s", model->name, dvi_last_error());
  ck_assert_msg(distance(model->nq, q, model->digits_q) <= 1e-5, "%s, %s: q is %g away",
                model->name, dvi_reference_name(options.code),
                distance(model->nq, q, model->digits_q));
  ck_assert_msg(distance(model->nv, p, model->digits_p) <= 1e-5 * size, "%s, %s: p is %g away",
                model->name, dvi_reference_name(options.code),
                distance(model->nv, p, model->digits_p));
  ck_assert_double_le(dvi_system_distance(model->system, q), 1e-15);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "lie-galerkin", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, model->order_t_end, q, p), DVI_OK);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The judge's error is above a tenth of the true one, and below 1e-8. */
START_TEST(the_judge_knows_its_error_on_the_free_body)
{
  problem *model = make("free-body", NULL);
  double q[MOST], p[MOST], exact_q[9], exact_p[3];
  for (double t = 2; t <= 50; t += 16) {
    dvi_reference_report report;
    start(model, q, p);
    ck_assert_int_eq(dvi_reference_judge(model->system, 0, t, q, p, NULL, &report), DVI_OK);
    ck_assert_int_eq(model->exact(model, t, exact_q, exact_p), 0);
    ck_assert_msg(distance(9, q, exact_q) <= 10 * report.error && report.error < 1e-8,
                  "t = %g: %g away, states %g", t, distance(9, q, exact_q), report.error);
  }
  problem_destroy(&model);
}
END_TEST

/* The free body moves as before if it is rotated in space as a whole, from attitudes at which each
 * of a quaternion's four numbers is the largest. */
START_TEST(every_attitude_is_a_start)
{
  static const double turned[4][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},
                                      {1, 0, 0, 0, -1, 0, 0, 0, -1},
                                      {-1, 0, 0, 0, 1, 0, 0, 0, -1},
                                      {-1, 0, 0, 0, -1, 0, 0, 0, 1}};
  problem *model = make("free-body", NULL);
  const dvi_reference_options options = option(DVI_ARKODE, 1e-12);
  double q[9], p[3];
  memcpy(q, turned[_i], sizeof q);
  memcpy(p, model->p, sizeof p);
  ck_assert_int_eq(dvi_reference_solve(model->system, 0, 10, q, p, &options, NULL), DVI_OK);
  for (int k = 0; k < 9; k++)
    ck_assert_double_eq_tol(q[k], turned[_i][4 * (k / 3)] * model->digits_q[k], 1e-11);
  problem_destroy(&model);
}
END_TEST

static int circle_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0];
  return 0;
}

static int circle_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  V_q[0] = 1;
  V_q[1] = 0;
  return 0;
}

/* A pendulum by its angle and one on the circle, V = cos q. */
START_TEST(an_angle_on_the_circle_moves_as_a_number)
{
  problem *model = make("pendulum", NULL);
  const dvi_factor circle = {.kind = DVI_U1, .mass = 1};
  const dvi_potential weight = {.value = circle_value, .gradient = circle_gradient};
  const dvi_system_terms terms = {
      .factors = &circle, .factor_count = 1, .potentials = &weight, .potential_count = 1};
  const dvi_reference_options options = option(_i, 1e-10);
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  double q[2] = {cos(model->q[0]), sin(model->q[0])}, p[1] = {0};
  ck_assert_int_eq(dvi_reference_solve(system, 0, model->order_t_end, q, p, &options, NULL),
                   DVI_OK);
  ck_assert_double_eq_tol(q[0], cos(model->digits_q[0]), 1e-6);
  ck_assert_double_eq_tol(q[1], sin(model->digits_q[0]), 1e-6);
  ck_assert_double_eq_tol(p[0], model->digits_p[0], 1e-6);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(what_is_off_the_manifold_or_too_large_is_refused)
{
  problem *model = make("free-body", NULL);
  double q[9], p[3];
  start(model, q, p);
  q[0] += 1e-6;
  ck_assert_int_eq(dvi_reference_solve(model->system, 0, 1, q, p, NULL, NULL), DVI_BAD_ARGUMENT);
  problem_destroy(&model);
  problem *chain = NULL;
  char message[256] = "";
  const char *setting = "n=300";
  ck_assert_int_eq(problem_create("spherical-chain", 1, &setting, &chain, message, sizeof message),
                   DVI_OK);
  ck_assert_int_eq(dvi_reference_solve(chain->system, 0, 1, chain->q, chain->p, NULL, NULL),
                   DVI_UNSUPPORTED);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "2000 are possible"));
  problem_destroy(&chain);
}
END_TEST

SUITE(factors)
{
  tcase_add_loop_test(tests, every_code_meets_the_digits, 0, CODES * 8);
  tcase_add_test(tests, the_judge_knows_its_error_on_the_free_body);
  tcase_add_loop_test(tests, every_attitude_is_a_start, 0, 4);
  tcase_add_loop_test(tests, an_angle_on_the_circle_moves_as_a_number, 0, CODES);
  tcase_add_test(tests, what_is_off_the_manifold_or_too_large_is_refused);
}
