/* Equations whose callbacks fail or give NaN: every rung ends, says so, prints nothing, and works
 * again. */
#define _POSIX_C_SOURCE 200809L /* dup, fileno */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "support/equations.h"
#include "support/suite.h"

static const dvi_status answers[] = {DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED, DVI_NOT_FINITE};
enum { ANSWERS = sizeof answers / sizeof *answers };

/* A fatal answer comes through every rung as it is; one that a smaller step might mend may become
 * "not solved". */
static void comes_through(dvi_status status, dvi_status answer)
{
  if (answer < 0)
    ck_assert_int_eq(status, answer);
  else
    ck_assert_int_gt(status, 0);
}

START_TEST(a_residual_that_fails_ends_the_solve)
{
  const dvi_status answer = answers[_i % ANSWERS];
  for (long at = 1; at <= 3; at++) {
    chain c;
    bench b;
    double x[SIZE] = {0};
    make_chain(0.2, &c);
    c.residual_fault = (fault){at, answer, 0};
    for_chain(&c, &b);
    comes_through(run_rung(&b, rungs[_i / ANSWERS], x), answer);
    /* after a fatal answer nobody calls again */
    ck_assert_int_le(c.residuals, answer < 0 ? at : 100);
    free_bench(&b, &c);
  }
}
END_TEST

START_TEST(a_jacobian_that_fails_ends_the_solve)
{
  const dvi_status answer = answers[_i % ANSWERS];
  chain c;
  bench b;
  double x[SIZE] = {0};
  make_chain(0.2, &c);
  c.jacobian_fault = (fault){1, answer, 0};
  for_chain(&c, &b);
  comes_through(run_rung(&b, rungs[1 + _i / ANSWERS], x), answer);
  ck_assert_int_le(c.jacobians, 10);
  free_bench(&b, &c);
}
END_TEST

static double logarithm(double x)
{
  return log(x);
}

static double reciprocal(double x)
{
  return 1 / x;
}

/* A recoverable answer at a trial point makes the search shorten its step. */
START_TEST(line_search_steps_back_from_where_the_residual_does_not_exist)
{
  single s = {logarithm, reciprocal, 1, 0, 0};
  bench b;
  double x = 5; /* Newton's first point is 5 - 5 log 5 = -3.05 */
  for_single(&s, &b);
  ck_assert_int_gt(run_rung(&b, DVI__NEWTON, &x), 0);
  x = 5;
  ck_assert_msg(run_rung(&b, DVI__KINSOL, &x) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(x, 1, 2 * DBL_EPSILON);
  free_bench(&b, NULL);
}
END_TEST

/* The action's residual never gives NaN with DVI_OK, but the solvers must not take one for a
 * solution. */
START_TEST(nan_is_never_a_solution)
{
  for (long at = 1; at <= 3; at++) {
    chain c;
    bench b;
    double x[SIZE] = {0};
    make_chain(0.2, &c);
    c.residual_fault = (fault){at, DVI_OK, 1};
    for_chain(&c, &b);
    ck_assert_int_gt(run_rung(&b, rungs[_i], x), 0);
    ck_assert_int_le(c.residuals, 2000);
    free_bench(&b, &c);
  }
}
END_TEST

static double huge(double x)
{
  (void)x;
  return 1e300;
}

static double tiny_slope(double x)
{
  (void)x;
  return 1e-100;
}

START_TEST(a_correction_that_overflows_is_a_failure)
{
  single s = {huge, tiny_slope, 1e-100, -HUGE_VAL, 0};
  bench b;
  double x = 1;
  for_single(&s, &b);
  failed_with(run_rung(&b, rungs[_i], &x), DVI_NOT_CONVERGED);
  free_bench(&b, NULL);
}
END_TEST

START_TEST(nan_in_a_jacobian_is_a_failure)
{
  chain c;
  bench b;
  double x[SIZE] = {0};
  make_chain(0.2, &c);
  c.jacobian_fault = (fault){1, DVI_OK, 1};
  for_chain(&c, &b);
  ck_assert_int_gt(run_rung(&b, rungs[1 + _i], x), 0);
  free_bench(&b, &c);
}
END_TEST

START_TEST(a_solver_works_again_after_a_failure)
{
  chain c;
  bench b;
  double x[SIZE] = {0};
  make_chain(0.2, &c);
  c.residual_fault = (fault){1, answers[_i % ANSWERS], 1};
  for_chain(&c, &b);
  ck_assert_int_ne(run_rung(&b, rungs[_i / ANSWERS], x), DVI_OK);
  c.residual_fault.at = 0;
  memset(x, 0, sizeof x);
  ck_assert_msg(run_rung(&b, rungs[_i / ANSWERS], x) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < SIZE; i++) ck_assert_double_eq_tol(x[i], c.solution[i], 8 * DBL_EPSILON);
  free_bench(&b, &c);
}
END_TEST

/* ---- silence ---- */

/* All the ways to fail above, run in this test's process with its output caught. */
static void fail_in_every_way(void)
{
  for (int rung = 0; rung < 3; rung++)
    for (int way = 0; way < 6; way++) {
      single s = {way == 0 ? never_zero : arctangent, way == 1 ? flat_slope : arctangent_slope,
                  1e-3, -HUGE_VAL, 0};
      chain c;
      bench b;
      double x[SIZE] = {3, 3, 3, 3, 3};
      make_chain(0.2, &c);
      if (way >= 3) c.residual_fault = (fault){1 + way % 2, answers[way % ANSWERS], way == 5};
      if (way < 3)
        for_single(&s, &b);
      else
        for_chain(&c, &b);
      (void)run_rung(&b, rungs[rung], x);
      free_bench(&b, &c);
    }
}

START_TEST(nothing_is_printed)
{
  FILE *caught = tmpfile();
  ck_assert_ptr_nonnull(caught);
  (void)fflush(NULL);
  const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
  ck_assert(dup2(fileno(caught), STDOUT_FILENO) >= 0 && dup2(fileno(caught), STDERR_FILENO) >= 0);
  fail_in_every_way();
  (void)fflush(NULL);
  (void)dup2(out, STDOUT_FILENO);
  (void)dup2(err, STDERR_FILENO);
  ck_assert_int_eq(fseek(caught, 0, SEEK_END), 0);
  ck_assert_int_eq(ftell(caught), 0);
  (void)fclose(caught);
}
END_TEST

SUITE(failures)
{
  tcase_add_loop_test(tests, a_residual_that_fails_ends_the_solve, 0, 3 * ANSWERS);
  tcase_add_loop_test(tests, a_jacobian_that_fails_ends_the_solve, 0, 2 * ANSWERS);
  tcase_add_test(tests, line_search_steps_back_from_where_the_residual_does_not_exist);
  tcase_add_loop_test(tests, nan_is_never_a_solution, 0, 3);
  tcase_add_loop_test(tests, a_correction_that_overflows_is_a_failure, 0, 3);
  tcase_add_loop_test(tests, nan_in_a_jacobian_is_a_failure, 0, 2);
  tcase_add_loop_test(tests, a_solver_works_again_after_a_failure, 0, 3 * ANSWERS);
  tcase_add_test(tests, nothing_is_printed);
}
