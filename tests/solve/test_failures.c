/* If callbacks of equations fail or give NaN, every rung ends with a sentence, prints nothing, and
 * works again. */
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

/* Every rung returns a fatal status as it is. A failure that a smaller step might mend may become
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
    equation_chain chain;
    solver_bench bench;
    double x[CHAIN_SIZE] = {0};
    make_chain(0.2, &chain);
    chain.residual_fault = (callback_fault){at, answer, 0};
    create_chain_solver(&chain, &bench);
    comes_through(solve_by_rung(&bench, rungs[_i / ANSWERS], x), answer);
    /* after a fatal answer nobody calls again */
    ck_assert_int_le(chain.residuals, answer < 0 ? at : 100);
    destroy_solver_bench(&bench, &chain);
  }
}
END_TEST

START_TEST(a_jacobian_that_fails_ends_the_solve)
{
  const dvi_status answer = answers[_i % ANSWERS];
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE] = {0};
  make_chain(0.2, &chain);
  chain.jacobian_fault = (callback_fault){1, answer, 0};
  create_chain_solver(&chain, &bench);
  comes_through(solve_by_rung(&bench, rungs[1 + _i / ANSWERS], x), answer);
  ck_assert_int_le(chain.jacobians, 10);
  destroy_solver_bench(&bench, &chain);
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
  single_equation equation = {logarithm, reciprocal, 1, 0, 0};
  solver_bench bench;
  double x = 5; /* Newton's first point is 5 - 5 log 5 = -3.05 */
  create_single_solver(&equation, &bench);
  ck_assert_int_gt(solve_by_rung(&bench, DVI__NEWTON, &x), 0);
  x = 5;
  ck_assert_msg(solve_by_rung(&bench, DVI__KINSOL, &x) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(x, 1, 2 * DBL_EPSILON);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* The action's residual never gives NaN with DVI_OK, but the solvers must not take one for a
 * solution. */
START_TEST(nan_is_never_a_solution)
{
  for (long at = 1; at <= 3; at++) {
    equation_chain chain;
    solver_bench bench;
    double x[CHAIN_SIZE] = {0};
    make_chain(0.2, &chain);
    chain.residual_fault = (callback_fault){at, DVI_OK, 1};
    create_chain_solver(&chain, &bench);
    ck_assert_int_gt(solve_by_rung(&bench, rungs[_i], x), 0);
    ck_assert_int_le(chain.residuals, 2000);
    destroy_solver_bench(&bench, &chain);
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
  single_equation equation = {huge, tiny_slope, 1e-100, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 1;
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, rungs[_i], &x), DVI_NOT_CONVERGED);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

START_TEST(nan_in_a_jacobian_is_a_failure)
{
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE] = {0};
  make_chain(0.2, &chain);
  chain.jacobian_fault = (callback_fault){1, DVI_OK, 1};
  create_chain_solver(&chain, &bench);
  ck_assert_int_gt(solve_by_rung(&bench, rungs[1 + _i], x), 0);
  destroy_solver_bench(&bench, &chain);
}
END_TEST

START_TEST(a_solver_works_again_after_a_failure)
{
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE] = {0};
  make_chain(0.2, &chain);
  chain.residual_fault = (callback_fault){1, answers[_i % ANSWERS], 1};
  create_chain_solver(&chain, &bench);
  ck_assert_int_ne(solve_by_rung(&bench, rungs[_i / ANSWERS], x), DVI_OK);
  chain.residual_fault.at = 0;
  memset(x, 0, sizeof x);
  ck_assert_msg(solve_by_rung(&bench, rungs[_i / ANSWERS], x) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < CHAIN_SIZE; i++)
    ck_assert_double_eq_tol(x[i], chain.solution[i], 8 * DBL_EPSILON);
  destroy_solver_bench(&bench, &chain);
}
END_TEST

/* ---- silence ---- */

/* All the ways to fail above, run in this test's process with its output caught. */
static void fail_in_every_way(void)
{
  for (int rung = 0; rung < 3; rung++)
    for (int way = 0; way < 6; way++) {
      single_equation equation = {way == 0 ? never_zero : arctangent,
                                  way == 1 ? flat_slope : arctangent_slope, 1e-3, -HUGE_VAL, 0};
      equation_chain chain;
      solver_bench bench;
      double x[CHAIN_SIZE] = {3, 3, 3, 3, 3};
      make_chain(0.2, &chain);
      if (way >= 3)
        chain.residual_fault = (callback_fault){1 + way % 2, answers[way % ANSWERS], way == 5};
      if (way < 3)
        create_single_solver(&equation, &bench);
      else
        create_chain_solver(&chain, &bench);
      (void)solve_by_rung(&bench, rungs[rung], x);
      destroy_solver_bench(&bench, &chain);
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
