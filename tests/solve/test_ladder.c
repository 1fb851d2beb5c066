/* The rungs of the ladder on small equations: the ones that each solves, and when each gives up. */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "solve/certify.h"
#include "support/equations.h"
#include "support/suite.h"

START_TEST(every_rung_finds_the_solution_to_roundoff)
{
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE] = {0};
  make_chain(0.2, &chain);
  create_chain_solver(&chain, &bench);
  ck_assert_msg(solve_by_rung(&bench, rungs[_i], x) == DVI_OK, "%s", dvi_last_error());
  /* numbers up to 2 */
  for (int i = 0; i < CHAIN_SIZE; i++)
    ck_assert_double_eq_tol(x[i], chain.solution[i], 8 * DBL_EPSILON);
  ck_assert_int_ge(bench.report.iterations, 2);
  destroy_solver_bench(&bench, &chain);
}
END_TEST

START_TEST(counters_count_what_was_called)
{
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE] = {0};
  make_chain(0.2, &chain);
  create_chain_solver(&chain, &bench);
  ck_assert_int_eq(bench.counters.symbolic, 0); /* nothing is made before it is needed */
  ck_assert_int_eq(solve_by_rung(&bench, rungs[_i], x), DVI_OK);
  ck_assert_int_eq(bench.counters.residuals, chain.residuals);
  ck_assert_int_eq(bench.counters.jacobians, chain.jacobians);
  ck_assert_int_eq(bench.counters.factorizations, chain.jacobians);
  ck_assert_int_eq(bench.counters.symbolic, rungs[_i] != DVI__FIXED_POINT);
  ck_assert_int_eq(bench.counters.preparations, rungs[_i] == DVI__FIXED_POINT ? 0
                                                : rungs[_i] == DVI__KINSOL    ? 2
                                                                              : 1);
  ck_assert_int_eq(bench.counters.kinsols, rungs[_i] == DVI__KINSOL);
  if (rungs[_i] == DVI__FIXED_POINT) {
    ck_assert_int_eq(chain.jacobians, 0);
    ck_assert_int_eq(bench.report.iterations, chain.residuals);
    ck_assert_int_eq(chain.chords, chain.residuals);
  } else {
    ck_assert_int_ge(chain.jacobians, 1);
    ck_assert_int_eq(chain.chords, 0);
    ck_assert_int_ge(bench.counters.solves, 2);
  }
  destroy_solver_bench(&bench, &chain);
}
END_TEST

/* The Jacobian of these equations hardly changes, so the factor of the first iteration serves the
 * others. */
START_TEST(newton_keeps_a_factor_that_works)
{
  equation_chain chain;
  solver_bench bench;
  double x[CHAIN_SIZE];
  make_chain(0.2, &chain);
  for (int i = 0; i < CHAIN_SIZE; i++) x[i] = chain.solution[i] + 1e-3 * (1 + i % 2);
  create_chain_solver(&chain, &bench);
  ck_assert_int_eq(solve_by_rung(&bench, DVI__NEWTON, x), DVI_OK);
  ck_assert_int_ge(chain.residuals, 4);
  ck_assert_int_le(chain.jacobians, 2);
  destroy_solver_bench(&bench, &chain);
}
END_TEST

/* From |x| > 1.39 on Newton's iteration for atan x = 0 jumps from side to side, farther each
 * time. */
START_TEST(line_search_finds_what_newton_overshoots)
{
  single_equation equation = {arctangent, arctangent_slope, 1, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 3;
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, DVI__NEWTON, &x), DVI_NOT_CONVERGED);
  ck_assert_int_eq(bench.counters.kinsols, 0);
  x = 3;
  ck_assert_msg(solve_by_rung(&bench, DVI__KINSOL, &x) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(x, 0, 1e-15);
  ck_assert_int_eq(bench.counters.kinsols, 1);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* From this start Newton's method might end at another solution. For R = x^2 - 1 from 0.3 it jumps
 * to 1.8, and then farther. */
START_TEST(a_wary_newton_refuses_a_misleading_guess)
{
  single_equation equation = {parabola, parabola_slope, 1, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 0.3;
  create_single_solver(&equation, &bench);
  check_failure(dvi__solve(bench.solver, DVI__NEWTON, 1.0, 1, 0, &x, &bench.report),
                DVI_NOT_CONVERGED);
  ck_assert_int_le(equation.residuals, 3);
  x = 0.3;
  ck_assert_int_eq(dvi__solve(bench.solver, DVI__NEWTON, 1.0, 0, 0, &x, &bench.report), DVI_OK);
  ck_assert_double_eq_tol(x, -1, 2 * DBL_EPSILON); /* the farther one of the two */
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* ---- slow contraction ---- */

/* With chord 10 the contraction is 1 - 1.77/10, for the slope at the solution 0.28 is 1.77. */
static double slow(double x)
{
  return x + 0.8 * sin(x) - 0.5;
}

static double slow_slope(double x)
{
  return 1 + 0.8 * cos(x);
}

START_TEST(slow_contraction_is_given_up_unless_patient)
{
  single_equation equation = {slow, slow_slope, 10, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 0, judge = 0;
  create_single_solver(&equation, &bench);
  check_failure(dvi__solve(bench.solver, DVI__FIXED_POINT, 1.0, 0, 0, &x, &bench.report),
                DVI_NOT_CONVERGED);
  ck_assert_int_le(equation.residuals, 5); /* the first ratio of two corrections tells */
  x = 0;
  ck_assert_msg(dvi__solve(bench.solver, DVI__FIXED_POINT, 1.0, 0, 1, &x, &bench.report) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_gt(bench.report.iterations, 60);
  ck_assert_int_eq(solve_by_rung(&bench, DVI__NEWTON, &judge), DVI_OK);
  /* The last correction, 4 epsilons of x or less, is 0.177 of the distance that is left. */
  ck_assert_double_eq_tol(x, judge, 4 / 0.177 * DBL_EPSILON);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

START_TEST(divergence_ends_even_patience)
{
  single_equation equation = {slow, slow_slope, 0.5, -HUGE_VAL,
                              0}; /* 1 - 1.77/0.5, so it grows 2.5 times an iteration */
  solver_bench bench;
  double x = 0;
  create_single_solver(&equation, &bench);
  check_failure(dvi__solve(bench.solver, DVI__FIXED_POINT, 1.0, 0, 1, &x, &bench.report),
                DVI_NOT_CONVERGED);
  ck_assert_int_le(equation.residuals, 1000);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* ---- no solution ---- */

START_TEST(no_solution_is_a_failure_after_a_bounded_number_of_iterations)
{
  single_equation equation = {never_zero, parabola_slope, 2, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 0.7;
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, rungs[_i], &x), DVI_NOT_CONVERGED);
  /* KINSOL takes 100 iterations with up to a dozen points on each line, then 40 by Newton */
  ck_assert_int_le(equation.residuals, 2000);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

START_TEST(a_singular_jacobian_is_a_step_s_failure)
{
  single_equation equation = {never_zero, flat_slope, 1, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 0.7;
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, rungs[1 + _i], &x), DVI_NOT_CONVERGED);
  check_words("singular");
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* The slope vanishes at the start alone. KINSOL cannot begin there, either, and no rung may claim a
 * solution. */
START_TEST(a_start_on_a_critical_point_is_a_failure)
{
  single_equation equation = {parabola, parabola_slope, 1, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 0;
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, rungs[1 + _i], &x), DVI_NOT_CONVERGED);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* No correction becomes small. If the row is known to be rounding, the solution is, too. Without
 * that, or with a row above it, there is no solution. */
START_TEST(a_row_that_is_rounding_is_solved)
{
  single_equation equation = {faint, faint_slope, 1, -HUGE_VAL, 0},
                  none = {never_zero, parabola_slope, 1, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 1.3;
  create_sum_solver(&equation, &bench);
  ck_assert_msg(solve_by_rung(&bench, rungs[1 + _i], &x) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(x, 1, 1e-9);
  destroy_solver_bench(&bench, NULL);
  create_single_solver(&equation, &bench);
  check_failure(solve_by_rung(&bench, rungs[1 + _i], &x), DVI_NOT_CONVERGED);
  destroy_solver_bench(&bench, NULL);
  create_sum_solver(&none, &bench);
  check_failure(solve_by_rung(&bench, rungs[1 + _i], &x), DVI_NOT_CONVERGED);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* The rows are looked at after the first correction, which may be the only one. If it is not, the
 * next one is of this residual. */
START_TEST(the_first_correction_may_be_the_last)
{
  single_equation equation = {parabola, parabola_slope, 0.5, -HUGE_VAL, 0};
  solver_bench bench;
  double x = 1 + 1e-9;
  create_sum_solver(&equation, &bench);
  ck_assert_int_eq(solve_by_rung(&bench, DVI__NEWTON, &x), DVI_OK);
  ck_assert_int_eq(bench.report.iterations, 1);
  ck_assert_int_eq(equation.residuals, 2);
  x = 1.5;
  equation.residuals = 0;
  ck_assert_int_eq(solve_by_rung(&bench, DVI__NEWTON, &x), DVI_OK);
  ck_assert_double_eq_tol(x, 1, 2 * DBL_EPSILON);
  ck_assert_int_eq(equation.residuals, bench.report.iterations);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* ---- complex Jacobians ---- */

/* Both rows are (x + y)^2 - 4, whose Jacobian is singular everywhere. */
static dvi_status square_rows(void *of, const double *x, double *r)
{
  (void)of;
  r[0] = r[1] = (x[0] + x[1]) * (x[0] + x[1]) - 4;
  return DVI_OK;
}

static dvi_status shifted_jacobian(void *of, const double *x, double *values)
{
  (void)of;
  for (int e = 0; e < 4; e++) {
    values[2 * e] = 2 * (x[0] + x[1]);
    values[2 * e + 1] = e % 3 == 0 ? 1e-7 : 0;
  }
  return DVI_OK;
}

static dvi_status unit_rows(void *of, double *scale, int *unchanged)
{
  (void)of;
  (void)unchanged;
  scale[0] = scale[1] = 1;
  return DVI_OK;
}

/* The shift's steps are those of least norm, up to a rounding over 1e-7: x - y stays. */
START_TEST(shifts_of_singular_jacobians_give_steps_of_least_norm)
{
  int start[] = {0, 2, 4}, row[] = {0, 1, 0, 1};
  const dvi__pattern pattern = {.rows = 2, .columns = 2, .start = start, .row = row};
  const dvi__equations equations = {.unknowns = 2,
                                    .pattern = &pattern,
                                    .linear = DVI__LINEAR_COMPLEX,
                                    .residual = square_rows,
                                    .jacobian = shifted_jacobian,
                                    .row_scale = unit_rows,
                                    .renewed = 1};
  solver_bench bench = {0};
  double x[] = {1.5, 0.1};
  ck_assert_int_eq(dvi__solver_create(&equations, &bench.counters, &bench.solver), DVI_OK);
  ck_assert_msg(solve_by_rung(&bench, rungs[1 + _i], x) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq_tol(x[0] + x[1], 2, 1e-14);
  ck_assert_double_eq_tol(x[0] - x[1], 1.4, 1e-7);
  destroy_solver_bench(&bench, NULL);
}
END_TEST

/* ---- certificates ---- */

/* Equations that iterate in two variables of their own, and are at the solution at once. `part` is
 * what is left of the residual there, beside the variables. */
typedef struct own_variables {
  double z[2], part;
  dvi_status status;
  int residuals;
  double moves; /* how far an iteration moves the second variable */
} own_variables;

static void begin_own(void *of, const double *x)
{
  (void)of, (void)x;
}

static dvi_status iterate_own(void *of, double *change, double *largest)
{
  own_variables *own = of;
  own->z[1] += own->moves;
  *change = 0;
  *largest = fabs(own->z[1]);
  return DVI_OK;
}

static void end_own(void *of, double *x)
{
  *x = ((const own_variables *)of)->z[0];
}

static const double *own_point(void *of)
{
  return ((const own_variables *)of)->z;
}

static dvi_status own_residual(void *of, const double *z, double *r)
{
  own_variables *own = of;
  own->residuals++;
  for (int i = 0; i < 2; i++) {
    ck_assert_double_eq(z[i], own->z[i]);
    r[i] = own->part * z[i];
  }
  return own->status == DVI_OK ? DVI_OK : dvi__fail(own->status, "asked to fail");
}

static dvi__equations equations_in(own_variables *own)
{
  return (dvi__equations){.unknowns = 1,
                          .of = own,
                          .fixed_point_begin = begin_own,
                          .fixed_point_iterate = iterate_own,
                          .fixed_point_end = end_own,
                          .own_unknowns = 2,
                          .own_point = own_point,
                          .own_residual = own_residual};
}

/* KINSOL tests the variables by one residual, and searches no other solution. */
START_TEST(own_variables_are_certified_by_one_residual)
{
  static const struct {
    double part;
    dvi_status status, verdict;
  } cases[] = {{0, DVI_OK, DVI_OK},
               {1e-14, DVI_OK, DVI_OK},
               {1e-10, DVI_OK, DVI_NOT_CONVERGED},
               {(double)NAN, DVI_OK, DVI_NOT_CONVERGED},
               {HUGE_VAL, DVI_OK, DVI_NOT_CONVERGED},
               {0, DVI_CALLBACK_RETRY, DVI_NOT_CONVERGED},
               {0, DVI_CALLBACK_FAILED, DVI_CALLBACK_FAILED}};
  own_variables own = {{0.25, -3}, cases[_i].part, cases[_i].status, 0, 0};
  const dvi__equations equations = equations_in(&own);
  dvi_counters counters = {0};
  dvi__solver *solver;
  dvi__solve_report report;
  double x = 0;
  ck_assert_int_eq(dvi__solver_create(&equations, &counters, &solver), DVI_OK);
  ck_assert_int_eq(dvi__solve(solver, DVI__FIXED_POINT, 1.0, 0, 0, &x, &report), DVI_OK);
  const long before = counters.residuals;
  for (int again = 1; again <= 2; again++) {
    ck_assert_int_eq(dvi__certify(solver, 1.0, NULL, &report), cases[_i].verdict);
    ck_assert_int_eq(own.residuals, again);
    ck_assert_int_eq(counters.residuals - before, again);
    ck_assert_int_eq(counters.certified, cases[_i].verdict == DVI_OK ? again : 0);
  }
  ck_assert_int_eq(counters.preparations, 1);
  dvi__solver_destroy(&solver);
}
END_TEST

/* A solver that is prepared knows the residual before the last iteration, and evaluates the next
 * one only if that does not pass, or has been tested already. */
START_TEST(the_last_iteration_certifies_a_solution)
{
  static const struct {
    double moves, part;
    int residuals;
    dvi_status verdict;
  } cases[] = {{0, 1, 0, DVI_OK},
               {-1e-12, 1, 0, DVI_OK},
               {1e-11, 1e-14, 1, DVI_OK},
               {1e-11, 1e-10, 1, DVI_NOT_CONVERGED}};
  own_variables own = {{0.25, -3}, cases[_i].part, DVI_OK, 0, cases[_i].moves};
  const dvi__equations equations = equations_in(&own);
  dvi_counters counters = {0};
  dvi__solver *solver;
  dvi__solve_report report;
  double x = 0;
  ck_assert_int_eq(dvi__solver_create(&equations, &counters, &solver), DVI_OK);
  ck_assert_int_eq(dvi__certify_prepare(solver, 1), DVI_OK);
  for (int again = 1; again <= 2; again++) {
    ck_assert_int_eq(dvi__solve(solver, DVI__FIXED_POINT, 1.0, 0, 0, &x, &report), DVI_OK);
    ck_assert_int_eq(dvi__certify(solver, 1.0, NULL, &report), cases[_i].verdict);
    ck_assert_int_eq(own.residuals, again * cases[_i].residuals);
    ck_assert_int_eq(counters.certified, cases[_i].verdict == DVI_OK ? again : 0);
  }
  (void)dvi__certify(solver, 1.0, NULL, &report);
  ck_assert_int_eq(own.residuals, 2 * cases[_i].residuals + 1);
  dvi__solver_destroy(&solver);
}
END_TEST

/* Solutions of different sizes are tested together, and only those that were noted. */
START_TEST(many_solutions_are_certified_at_once)
{
  static const double sizes[] = {1, 1e6, 1e-6};
  own_variables own = {{0.25, -3}, 0, DVI_OK, 0, 0};
  const dvi__equations equations = equations_in(&own);
  dvi_counters counters = {0};
  dvi__solver *solver;
  ck_assert_int_eq(dvi__solver_create(&equations, &counters, &solver), DVI_OK);
  ck_assert_int_eq(dvi__certify_prepare(solver, 3), DVI_OK);
  for (int spoilt = 0; spoilt < 4; spoilt++) {
    for (int i = 0; i < 3; i++) {
      double *point = dvi__certify_point(solver, i);
      const double next[] = {0.5 * sizes[i], -sizes[i]};
      point[0] = next[0] * (1 + 1e-13);
      point[1] = next[1] * (i == spoilt ? 1 + 1e-10 : 1);
      ck_assert_int_eq(dvi__certify_note(solver, i, next, sizes[i], 1.0), DVI_OK);
    }
    const long before = counters.certified;
    ck_assert_int_eq(dvi__certify_noted(solver, 3), spoilt == 3);
    ck_assert_int_eq(dvi__certify_noted(solver, 2), spoilt >= 2);
    ck_assert_int_eq(counters.certified - before, (spoilt == 3 ? 3 : 0) + (spoilt >= 2 ? 2 : 0));
  }
  ck_assert_int_eq(dvi__certify_note(solver, 0, (double[]){0, 0}, 1e-320, 1.0), DVI_NOT_FINITE);
  ck_assert_int_eq(own.residuals, 0);
  dvi__solver_destroy(&solver);
}
END_TEST

SUITE(ladder)
{
  tcase_add_loop_test(tests, every_rung_finds_the_solution_to_roundoff, 0, 3);
  tcase_add_loop_test(tests, counters_count_what_was_called, 0, 3);
  tcase_add_test(tests, newton_keeps_a_factor_that_works);
  tcase_add_test(tests, line_search_finds_what_newton_overshoots);
  tcase_add_test(tests, a_wary_newton_refuses_a_misleading_guess);
  tcase_add_test(tests, slow_contraction_is_given_up_unless_patient);
  tcase_add_test(tests, divergence_ends_even_patience);
  tcase_add_loop_test(tests, no_solution_is_a_failure_after_a_bounded_number_of_iterations, 0, 3);
  tcase_add_loop_test(tests, a_singular_jacobian_is_a_step_s_failure, 0, 2);
  tcase_add_loop_test(tests, a_start_on_a_critical_point_is_a_failure, 0, 2);
  tcase_add_loop_test(tests, a_row_that_is_rounding_is_solved, 0, 2);
  tcase_add_test(tests, the_first_correction_may_be_the_last);
  tcase_add_loop_test(tests, shifts_of_singular_jacobians_give_steps_of_least_norm, 0, 2);
  tcase_add_loop_test(tests, own_variables_are_certified_by_one_residual, 0, 7);
  tcase_add_loop_test(tests, the_last_iteration_certifies_a_solution, 0, 4);
  tcase_add_test(tests, many_solutions_are_certified_at_once);
}
