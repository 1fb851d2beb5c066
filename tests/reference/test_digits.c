/* labels: judge long */
/* The quadruple-precision judge, the digits that the problems store, and the catalogue's printed
 * digits: all three agree. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"
#include "support/quad/quad.h"
#include "support/quad/quad_real.h"
#include "support/suite.h"

/* The largest own error of the judge where 1e-17 is wanted. 1e-20 leaves three digits. */
#define JUDGE_ERROR 1e-20

typedef char text[QUAD_TEXT];

typedef struct result {
  int n;
  double error;
  text q[QUAD_N_MAX], p[QUAD_N_MAX];
} result;

static result run_judge(const char *name, double t)
{
  result r;
  r.error = quad_digits(name, 0, NULL, t, &r.n, r.q, r.p);
  ck_assert_msg(r.error < JUDGE_ERROR, "%s: the judge's error is %g", name, r.error);
  return r;
}

/* 17 digits are the number itself, to half an ulp of each of the two roundings. */
static void check_stored(const char *name, const double *stored, int n, const text *digits)
{
  for (int i = 0; i < n; i++) {
    const double exact = strtod(digits[i], NULL);
    ck_assert_msg(fabs(stored[i] - exact) <= 2.3e-16 * fabs(exact),
                  "%s: number %d is %.17g, the judge says %s", name, i, stored[i], digits[i]);
  }
}

START_TEST(stored_digits_are_those_of_the_judge)
{
  problem *made = NULL;
  char message[256];
  ck_assert_int_eq(problem_create(problem_name(_i), 0, NULL, &made, message, sizeof message),
                   DVI_OK);
  const result r = run_judge(made->name, made->order_t_end);
  ck_assert_int_eq(r.n, made->nq);
  check_stored(made->name, made->digits_q, r.n, (const text *)r.q);
  check_stored(made->name, made->digits_p, made->nv, (const text *)r.p);
  problem_destroy(&made);
}
END_TEST

/* Runs the judge from the rounded start, as a method sees it. Roundoff of the start grows at most
 * thirtyfold (kepler, T = 10). */
START_TEST(the_judge_agrees_with_itself_from_the_rounded_start)
{
  problem *made = NULL;
  char message[256];
  const char *name = problem_name(sampled_case(_i));
  ck_assert_int_eq(problem_create(name, 0, NULL, &made, message, sizeof message), DVI_OK);
  ck_assert_double_lt(quad_solve(made->name, 0, NULL, made->order_t_end, made->q, made->p),
                      JUDGE_ERROR);
  double largest = 0.0;
  for (int i = 0; i < made->nq; i++) largest = fmax(largest, fabs(made->digits_q[i]));
  for (int i = 0; i < made->nq; i++)
    ck_assert_double_eq_tol(made->q[i], made->digits_q[i], 30 * 2.2e-16 * largest);
  problem_destroy(&made);
}
END_TEST

/* Distance of the judge's number from a printed one, in units of its last digit. */
static double units_apart(quad number, const char *printed)
{
  const char *point = strchr(printed, '.');
  quad unit = 1;
  for (size_t i = 1; i < strlen(point); i++) unit /= 10;
  return (double)(quad_abs(number - quad_parse(printed, NULL)) / unit);
}

/* A digit is rounded right to its last place, by half a unit, and the printed number has its own
 * rounding in quadruple precision. */
static void check_printed(const char *name, quad number, const char *printed)
{
  const double apart = units_apart(number, printed);
  ck_assert_msg(apart <= 0.5 + 1e-9, "%s: %s is %g units off", name, printed, apart);
}

START_TEST(printed_digits_are_right_to_the_last_one)
{
  static const struct {
    const char *name;
    double t;
    const char *q[2], *p[2];
  } cases[] = {
      {"oscillator", 1.0, {"0.3801222985378151"}, {"-0.2296813424663921"}},
      {"pendulum", 1.0, {"1.62958488051157425"}, {"0.957867106063749538"}},
      {"kepler", 10.0, {"-1.53502359190981369", "-0.283668406499780862"}, {NULL}},
      {"double-pendulum", 1.0, {"0.614904069579215873", "0.379818946939410850"}, {NULL}},
      {"toda", 10.0, {"0.418897027547266404"}, {NULL}},
      {"stiff-pendulum", 1.0, {"0.04488223267139529", "-0.9807016161913268"}, {NULL}},
  };
  const result r = run_judge(cases[_i].name, cases[_i].t);
  for (int i = 0; i < 2; i++) {
    if (cases[_i].q[i]) check_printed(cases[_i].name, quad_parse(r.q[i], NULL), cases[_i].q[i]);
    if (cases[_i].p[i]) check_printed(cases[_i].name, quad_parse(r.p[i], NULL), cases[_i].p[i]);
  }
}
END_TEST

START_TEST(fpu_has_the_printed_stiff_energies_at_50)
{
  static const char *const printed[3] = {".5585378601", ".3672150824", ".0697391044"};
  const result r = run_judge("fpu", 50.0);
  for (int i = 0; i < 3; i++) {
    const quad x = quad_parse(r.q[3 + i], NULL), y = quad_parse(r.p[3 + i], NULL);
    check_printed("fpu", (y * y + 2500 * x * x) / 2, printed[i]);
  }
}
END_TEST

START_TEST(the_judge_meets_an_exact_solution)
{
  const result r = run_judge("oscillators", 1.0);
  const quad w = quad_sqrt(2501);
  ck_assert((double)quad_abs(quad_parse(r.q[0], NULL) - quad_cos(w)) < 1e-25);
  ck_assert((double)quad_abs(quad_parse(r.p[0], NULL) + w * quad_sin(w)) < 1e-24);
}
END_TEST

/* The orbit's eight-digit start lets it close to 3e-8. */
START_TEST(the_figure_eight_closes)
{
  double q[6] = {0.97000436, -0.24308753, -0.97000436, 0.24308753, 0.0, 0.0}, start[6];
  double p[6] = {0.466203685, 0.432365730, 0.466203685, 0.432365730, -0.93240737, -0.86473146};
  memcpy(start, q, sizeof q);
  ck_assert_double_lt(quad_solve("figure-eight", 0, NULL, 6.32591398, q, p), JUDGE_ERROR);
  for (int i = 0; i < 6; i++) ck_assert_double_eq_tol(q[i], start[i], 4e-8);
}
END_TEST

START_TEST(the_judge_reads_settings_and_goes_backward)
{
  const char *setting = "e=0.9";
  double q[2] = {0.1, 0.0}, p[2] = {0.0, sqrt(19.0)};
  ck_assert_double_lt(quad_solve("kepler", 1, &setting, 1.0, q, p), JUDGE_ERROR);
  ck_assert_double_gt(fabs(q[1]), 0.1);
  ck_assert_double_lt(quad_solve("kepler", 1, &setting, -1.0, q, p), JUDGE_ERROR);
  /* rounding of the state at t = 1, grown by the fall to the pericentre */
  ck_assert_double_eq_tol(q[0], 0.1, 1e-14);
  ck_assert_double_eq_tol(q[1], 0.0, 1e-14);
  /* another eccentricity, another start */
  int n;
  text from_q[QUAD_N_MAX], from_p[QUAD_N_MAX];
  ck_assert_double_eq(quad_digits("kepler", 1, &setting, 0.0, &n, from_q, from_p), 0.0);
  ck_assert_double_eq(strtod(from_q[0], NULL), 0.1);
}
END_TEST

START_TEST(the_judge_refuses_what_it_does_not_know)
{
  static const char *const settings[] = {"f=1", "e", "ell=33", "N=65"};
  double q[2] = {1.0, 0.0}, p[2] = {0.0, 1.0};
  ck_assert_double_nan(quad_solve("nonsense", 0, NULL, 1.0, q, p));
  ck_assert_double_nan(quad_solve("kepler", 1, &settings[0], 1.0, q, p));
  ck_assert_double_nan(quad_solve("kepler", 1, &settings[1], 1.0, q, p));
  ck_assert_double_nan(quad_solve("fpu", 1, &settings[2], 1.0, q, p));
  ck_assert_double_nan(quad_solve("toda", 1, &settings[3], 1.0, q, p));
  ck_assert(q[0] == 1.0 && p[1] == 1.0);
}
END_TEST

/* fpu at T = 200 is sensitive. From 1/50 rounded to a double, as here, x0_1 differs by 5e-14 from
 * the result for exact 1/50. The printed digits are those of the rounded start. */
START_TEST(fpu_has_the_printed_state_at_200)
{
  static const double printed[6] = {0.0568458230701694,  0.797913189042865,  0.229526402291378,
                                    0.00251963934996296, 0.0112354204569455, -0.0097345812522916};
  static const double unit[6] = {1e-16, 1e-15, 1e-15, 1e-17, 1e-16, 1e-16};
  double q[6] = {1.0, 0.0, 0.0, 1.0 / 50.0, 0.0, 0.0}, p[6] = {1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  ck_assert_double_lt(quad_solve("fpu", 0, NULL, 200.0, q, p), 1e-20);
  /* half a unit of the last printed digit, and one rounding */
  for (int i = 0; i < 6; i++)
    ck_assert_double_eq_tol(q[i], printed[i], 0.5 * unit[i] + 2.2e-16 * fabs(q[i]));
}
END_TEST

SUITE(digits)
{
  tcase_set_timeout(tests, 600);
  tcase_add_loop_test(tests, stored_digits_are_those_of_the_judge, 0, problem_count());
  tcase_add_loop_test(tests, the_judge_agrees_with_itself_from_the_rounded_start, 0,
                      sampled_count(problem_count()));
  tcase_add_loop_test(tests, printed_digits_are_right_to_the_last_one, 0, 6);
  tcase_add_test(tests, fpu_has_the_printed_stiff_energies_at_50);
  if (!is_short_run()) tcase_add_test(tests, fpu_has_the_printed_state_at_200);
  tcase_add_test(tests, the_judge_meets_an_exact_solution);
  tcase_add_test(tests, the_figure_eight_closes);
  tcase_add_test(tests, the_judge_reads_settings_and_goes_backward);
  tcase_add_test(tests, the_judge_refuses_what_it_does_not_know);
}
