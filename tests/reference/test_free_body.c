/* labels: reference */
/* The free body's exact solution, Jacobi's elliptic functions and the attitude, against the
 * quadruple-precision judge. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/catalogue.h"
#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/suite.h"

enum { SETTINGS = 6 };

static problem *create_free_body(const char *const *settings)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create("free-body", SETTINGS, settings, &made, message, sizeof message) ==
                    DVI_OK,
                "%s", message);
  return made;
}

/* Roundings of the start in double, and a few ulp of R and Pi. Where the modulus is near 1 both
 * grow. */
static void check_at(const char *const *settings, double t, double tolerance)
{
  problem *model = create_free_body(settings);
  double q[9], p[3], exact_q[9], exact_p[3];
  start(model, q, p);
  ck_assert_double_lt(quad_solve("free-body", SETTINGS, settings, t, q, p), 1e-20);
  ck_assert_int_eq(model->exact(model, t, exact_q, exact_p), 0);
  ck_assert_msg(distance(9, q, exact_q) <= tolerance, "%s, %s at %g: R is %g away", settings[3],
                settings[4], t, distance(9, q, exact_q));
  ck_assert_msg(distance(3, p, exact_p) <= tolerance * fmax(1, magnitude(3, p)),
                "%s, %s at %g: Pi is %g away", settings[3], settings[4], t,
                distance(3, p, exact_p));
  problem_destroy(&model);
}

START_TEST(the_attitude_is_exact_whatever_the_axes_and_signs)
{
  static const char *const cases[][SETTINGS] = {
      {"J1=3", "J2=2", "J3=1.5", "Omega1=0.5", "Omega2=-0.5", "Omega3=0.4"},
      {"J1=3", "J2=2", "J3=1.5", "Omega1=-2", "Omega2=0.1", "Omega3=0.3"},
      {"J1=3", "J2=2", "J3=1.5", "Omega1=0.2", "Omega2=0.1", "Omega3=-2"},
      {"J1=1.5", "J2=3", "J3=2", "Omega1=-0.3", "Omega2=0.2", "Omega3=0.7"},
      {"J1=2", "J2=1.5", "J3=3", "Omega1=0.7", "Omega2=-0.6", "Omega3=0.5"},
      {"J1=1.5", "J2=2", "J3=3", "Omega1=1", "Omega2=0", "Omega3=0.7"},
      {"J1=2", "J2=2", "J3=1", "Omega1=1", "Omega2=-0.5", "Omega3=0.5"},
      {"J1=1", "J2=2", "J3=2", "Omega1=1", "Omega2=-0.5", "Omega3=0.5"},
      {"J1=2", "J2=1", "J3=2", "Omega1=1e-7", "Omega2=1", "Omega3=0"},
      {"J1=1", "J2=2", "J3=3", "Omega1=1e-9", "Omega2=1e-9", "Omega3=1"},
  };
  check_at(cases[_i], 0.3, 1e-14);
  check_at(cases[_i], 10, 1e-14);
  check_at(cases[_i], -7, 1e-14);
}
END_TEST

/* A rotation about the middle axis, disturbed by 1e-4, tumbles, and disturbances of the start grow
 * by 1e4. */
START_TEST(it_is_exact_near_the_separatrix)
{
  static const char *const settings[SETTINGS] = {"J1=1",        "J2=2",     "J3=3",
                                                 "Omega1=1e-4", "Omega2=1", "Omega3=1e-4"};
  check_at(settings, 5, 1e-14);
  check_at(settings, 30, 1e-10);
}
END_TEST

START_TEST(steady_turns_go_on)
{
  static const char *const cases[][SETTINGS] = {
      {"J1=1", "J2=2", "J3=3", "Omega1=0", "Omega2=1", "Omega3=0"},
      {"J1=1", "J2=2", "J3=3", "Omega1=0", "Omega2=0", "Omega3=-1"},
      {"J1=2", "J2=2", "J3=2", "Omega1=1", "Omega2=2", "Omega3=-1"},
      {"J1=1", "J2=2", "J3=3", "Omega1=0", "Omega2=0", "Omega3=0"},
  };
  check_at(cases[_i], 6, 1e-14);
}
END_TEST

/* There the period is infinite, and the exact solution is none. */
START_TEST(on_the_separatrix_there_is_none)
{
  static const char *const settings[SETTINGS] = {"J1=9",     "J2=8",       "J3=4",
                                                 "Omega1=4", "Omega2=0.5", "Omega3=3"};
  problem *model = create_free_body(settings);
  double q[9], p[3];
  ck_assert_int_ne(model->exact(model, 1, q, p), 0);
  problem_destroy(&model);
}
END_TEST

/* 16000 turns of axis 3. The bound is the effect of a rounding of J or Omega on the phase, 1e4
 * radians. */
START_TEST(long_times_cost_only_the_roundings_of_the_phase)
{
  problem *model = make("free-body", NULL);
  double q[9], p[3], later_q[9], later_p[3];
  ck_assert_int_eq(model->exact(model, 1e5, q, p), 0);
  ck_assert_int_eq(model->exact(model, 1e5 * (1 + 2.3e-16), later_q, later_p), 0);
  ck_assert_double_le(distance(9, q, later_q), 1e-10);
  double value[4];
  ck_assert_int_eq(dvi_system_invariants(model->system, 1e5, q, p, value), DVI_OK);
  ck_assert_double_eq_tol(value[0], 0.745, 1e-15);
  ck_assert_double_eq_tol(value[1], 1.5, 2e-15);
  ck_assert_double_eq_tol(value[2], -1, 2e-15);
  ck_assert_double_eq_tol(value[3], 0.6, 1e-15);
  problem_destroy(&model);
}
END_TEST

SUITE(free_body)
{
  tcase_add_loop_test(tests, the_attitude_is_exact_whatever_the_axes_and_signs, 0, 10);
  tcase_add_test(tests, it_is_exact_near_the_separatrix);
  tcase_add_loop_test(tests, steady_turns_go_on, 0, 4);
  tcase_add_test(tests, on_the_separatrix_there_is_none);
  tcase_add_test(tests, long_times_cost_only_the_roundings_of_the_phase);
}
