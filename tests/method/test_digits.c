/* labels: order reference */
/* The catalogue's digits were made in quadruple precision (tests/reference/test_digits.c makes them
 * again). */
#include <check.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

static const double close_enough = 1e-12;

/* Digits of problems with noise are those without. */
static problem *with_digits(int index)
{
  problem *model = create_problem(problem_name(index), NULL);
  if (model->terms->noise != NULL) {
    const double *q = model->digits_q;
    ck_assert_ptr_nonnull(q);
    problem_destroy(&model);
    model = create_problem(problem_name(index), "gamma=0");
    model->digits_q = q;
  }
  ck_assert_msg(model->digits_q != NULL, "%s has no digits", problem_name(index));
  return model;
}

static const char *good_method(const problem *model)
{
  const dvi_system_terms *terms = model->terms;
  if (terms->hamiltonian != NULL)
    return terms->constraint != NULL ? "dg-phase:degree=6" : "hamiltonian:degree=6";
  if (terms->factors != NULL) return "lie-galerkin:degree=8";
  if (terms->nonholonomic_count > 0) return "composition:order=8";
  return terms->one_form != NULL ? "vprk:nodes=6" : "galerkin:degree=8";
}

/* Gives a step so small that the method's own error is far below: a tenth of the first step of an
 * order study of order 2. */
START_TEST(a_method_of_high_order_meets_the_digits)
{
  problem *model = with_digits(_i);
  dvi_integrator *integrator = start_integrator(model, good_method(model));
  const long steps = lround(ceil(model->order_t_end / model->order_h)) * 2;
  advance(integrator, model->order_t_end / (double)steps, steps);
  const double apart = distance(model->nq, dvi_integrator_q(integrator), model->digits_q);
  ck_assert_msg(apart <= close_enough * fmax(1, magnitude(model->nq, model->digits_q)),
                "%s: %g from the digits", model->name, apart);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* IDA meets them to ten times the error that its second, tighter run makes it state, and states
 * less than 1e-6 of the solution. The five rows of three-cranks that IDA takes are dependent where
 * the cranks hang down, and stop it there at tighter tolerances. */
START_TEST(ida_meets_the_digits_to_its_own_error)
{
  problem *model = with_digits(_i);
  double q[64], p[64];
  ck_assert_int_le(model->nq, 64);
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nv * sizeof *p);
  dvi_reference_report report;
  const int dependent = strcmp(model->name, "three-cranks") == 0;
  const dvi_reference_options loose = {.relative_tolerance = 1e-7};
  const dvi_status status = dvi_reference_judge(model->system, 0, model->order_t_end, q, p,
                                                dependent ? &loose : NULL, &report);
  ck_assert_msg(status == DVI_OK, "%s: %s", model->name, dvi_last_error());
  const double apart = distance(model->nq, q, model->digits_q),
               size = fmax(1, magnitude(model->nq, model->digits_q));
  ck_assert_msg(apart <= 10 * report.error + 1e-13 * size, "%s: %g from the digits, states %g",
                model->name, apart, report.error);
  ck_assert_msg(report.error <= (dependent ? 3e-6 : 1e-6) * size, "%s: states %g", model->name,
                report.error);
  problem_destroy(&model);
}
END_TEST

SUITE(digits)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, a_method_of_high_order_meets_the_digits, 0, problem_count());
  tcase_add_loop_test(tests, ida_meets_the_digits_to_its_own_error, 0, problem_count());
}
