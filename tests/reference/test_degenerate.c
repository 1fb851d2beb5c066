/* labels: reference */
/* Judges of degenerate Lagrangians: the reduced equations and the system of index 2 agree with the
 * digits, and so with each other. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { CODES = 5, PROBLEMS = 10, COORDINATES_MOST = 4 };

static const char *const names[PROBLEMS] = {
    "lotka-volterra", "lotka-volterra-4d", "massless-particle", "vortices-linear", "vortices",
    "guiding-centre", "tokamak",           "circle-dirac",      "magnetic-pair",   "elastica"};

/* A code's own error is the distance of two runs. The bound is ten times that, or the error that
 * its tolerance leaves at a thousand steps. */
START_TEST(each_code_meets_the_digits_to_its_own_error)
{
  problem *model = create_problem(names[_i % PROBLEMS], NULL);
  const dvi_reference_code code = (dvi_reference_code)(_i / PROBLEMS);
  double q[COORDINATES_MOST], p[COORDINATES_MOST];
  dvi_reference_report report;
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nq * sizeof *p);
  const dvi_reference_options options = {.code = code};
  if (code == DVI_IDA_INDEX_2 && model->terms->hamiltonian != NULL &&
      model->terms->constraint == NULL) {
    ck_assert_int_eq(dvi_reference_solve(model->system, 0, 1, q, p, &options, NULL),
                     DVI_UNSUPPORTED);
    check_words("neither a one-form nor a Hamiltonian with constraints");
    problem_destroy(&model);
    return;
  }
  const dvi_status status = dvi_reference_judge(model->system, 0, model->order_t_end, q, p,
                                                &options, &report);
  ck_assert_msg(status == DVI_OK, "%s: %s", model->name, dvi_last_error());
  const double apart = distance(model->nq, q, model->digits_q),
               size = fmax(1, magnitude(model->nq, model->digits_q));
  ck_assert_msg(apart <= 10 * report.error + 1e-13 * size,
                "%s by %s: %g from the digits, states %g", model->name, dvi_reference_name(code),
                apart, report.error);
  ck_assert_msg(report.error <= (code == DVI_IDA_INDEX_2 ? 1e-5 : 1e-8) * size,
                "%s by %s: states %g", model->name, dvi_reference_name(code), report.error);
  ck_assert_double_le(distance(model->nq, p, model->digits_p), 100 * (report.error + 1e-13 * size));
  problem_destroy(&model);
}
END_TEST

START_TEST(index_2_is_for_constraints)
{
  problem *model = create_problem("kepler", NULL);
  double q[2] = {model->q[0], model->q[1]}, p[2] = {model->p[0], model->p[1]};
  const dvi_reference_options options = {.code = DVI_IDA_INDEX_2};
  ck_assert_int_eq(dvi_reference_solve(model->system, 0, 1, q, p, &options, NULL), DVI_UNSUPPORTED);
  check_words("neither a one-form nor a Hamiltonian");
  ck_assert_mem_eq(q, model->q, sizeof q);
  problem_destroy(&model);
}
END_TEST

SUITE(degenerate)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, each_code_meets_the_digits_to_its_own_error, 0, CODES * PROBLEMS);
  tcase_add_test(tests, index_2_is_for_constraints);
}
