/* labels: judge slow long */
/* The digits of long spans are those of the quadruple-precision judge, and the roundings of the
 * start move them no farther than is said. A short run takes one of the three problems. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/suite.h"

/* The largest own error of the judge where 1e-17 is wanted. */
static const double judge_error = 1e-20;

static const char *const names[] = {"double-pendulum", "fpu", "outer-solar"};
enum { NAMES = sizeof names / sizeof *names, N_MAX = 18 };

START_TEST(far_digits_are_those_of_the_judge)
{
  problem *model = create_problem(names[_i], NULL);
  char q[QUAD_N_MAX][QUAD_TEXT], p[QUAD_N_MAX][QUAD_TEXT];
  int n = 0;
  ck_assert_ptr_nonnull(model->far_q);
  ck_assert_double_lt(quad_digits(model->name, 0, NULL, model->far_t_end, &n, q, p), judge_error);
  ck_assert_int_eq(n, model->nq);
  for (int i = 0; i < n; i++) {
    const double judged = strtod(q[i], NULL);
    /* half an ulp of each of the two roundings */
    ck_assert_msg(fabs(model->far_q[i] - judged) <= 2.3e-16 * fabs(judged),
                  "%s: number %d is %.17g, the judge says %s", model->name, i, model->far_q[i],
                  q[i]);
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(the_rounded_start_ends_where_is_said)
{
  problem *model = create_problem(names[_i], NULL);
  double q[N_MAX], p[N_MAX];
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nq * sizeof *p);
  ck_assert_double_lt(quad_solve(model->name, 0, NULL, model->far_t_end, q, p), judge_error);
  const double moved = distance(model->nq, q, model->far_q);
  ck_assert_msg(moved <= model->far_error && moved > 0.1 * model->far_error, "%s: moved by %g",
                model->name, moved);
  problem_destroy(&model);
}
END_TEST

START_TEST(other_parameters_and_problems_have_no_far_digits)
{
  problem *model = create_problem("fpu", "ell=4");
  ck_assert_ptr_null(model->far_q);
  problem_destroy(&model);
  model = create_problem("kepler", NULL);
  ck_assert_ptr_null(model->far_q);
  problem_destroy(&model);
}
END_TEST

SUITE(far_digits)
{
  tcase_set_timeout(tests, 600);
  tcase_add_loop_test(tests, far_digits_are_those_of_the_judge, 0, sampled_count(NAMES));
  tcase_add_loop_test(tests, the_rounded_start_ends_where_is_said, 0, sampled_count(NAMES));
  tcase_add_test(tests, other_parameters_and_problems_have_no_far_digits);
}
