/* labels: order reference */
/* The catalogue's digits were made in quadruple precision (tests/reference/test_digits.c makes them
 * again). */
#include <check.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

static const double close_enough = 1e-12;

static problem *with_digits(int index)
{
  problem *of = made_problem(problem_name(index), NULL);
  ck_assert_msg(of->digits_q != NULL, "%s has no digits", problem_name(index));
  return of;
}

static const char *good_method(const problem *of)
{
  const dvi_system_terms *terms = of->terms;
  if (terms->hamiltonian != NULL)
    return terms->constraint != NULL ? "dg-phase:degree=6" : "hamiltonian:degree=6";
  if (terms->factors != NULL) return "lie-galerkin:degree=8";
  return terms->one_form != NULL ? "vprk:nodes=6" : "galerkin:degree=8";
}

/* Small enough that the method's own error is far below: a tenth of the step that an order study of
 * order 2 starts with. */
START_TEST(a_method_of_high_order_meets_the_digits)
{
  problem *of = with_digits(_i);
  dvi_integrator *integrator = started(of, good_method(of));
  const long steps = lround(ceil(of->order_t_end / of->order_h)) * 2;
  advance(integrator, of->order_t_end / (double)steps, steps);
  const double apart = distance(of->nq, dvi_integrator_q(integrator), of->digits_q);
  ck_assert_msg(apart <= close_enough * fmax(1, magnitude(of->nq, of->digits_q)),
                "%s: %g from the digits", of->name, apart);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}
END_TEST

/* IDA meets them to ten times the error that its second, tighter run makes it state, and states
 * less than 1e-6 of the solution. */
START_TEST(ida_meets_the_digits_to_its_own_error)
{
  problem *of = with_digits(_i);
  double q[64], p[64];
  ck_assert_int_le(of->nq, 64);
  memcpy(q, of->q, (size_t)of->nq * sizeof *q);
  memcpy(p, of->p, (size_t)of->nv * sizeof *p);
  dvi_reference_report report;
  const dvi_status status = dvi_reference_judge(of->system, 0, of->order_t_end, q, p, NULL,
                                                &report);
  ck_assert_msg(status == DVI_OK, "%s: %s", of->name, dvi_last_error());
  const double apart = distance(of->nq, q, of->digits_q),
               size = fmax(1, magnitude(of->nq, of->digits_q));
  ck_assert_msg(apart <= 10 * report.error + 1e-13 * size, "%s: %g from the digits, states %g",
                of->name, apart, report.error);
  ck_assert_msg(report.error <= 1e-6 * size, "%s: states %g", of->name, report.error);
  problem_destroy(&of);
}
END_TEST

SUITE(digits)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, a_method_of_high_order_meets_the_digits, 0, problem_count());
  tcase_add_loop_test(tests, ida_meets_the_digits_to_its_own_error, 0, problem_count());
}
