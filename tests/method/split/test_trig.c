/* labels: unit */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

static const char *const filters[] = {"exact",        "deuflhard",        "garcia-archilla",
                                      "gautschi",     "hochbruck-lubich", "grimm-hochbruck",
                                      "hairer-lubich"};
enum { FILTERS = sizeof filters / sizeof *filters, VARIATIONAL = 3 };

/* psi and phi of the two-step form q_{+} - 2 cos x q + q_{-} = h^2 psi g(phi q). */
static double sinc(double x)
{
  return sin(x) / x;
}

static double psi(int number, double x)
{
  const double by_half[] = {
      sinc(x / 2) * sqrt(sinc(x)), sinc(x),         sinc(x) * sinc(x), pow(sinc(x / 2), 2),
      pow(sinc(x / 2), 2),         pow(sinc(x), 3), pow(sinc(x), 2)};
  return by_half[number];
}

static double phi(int number, double x)
{
  const double of[] = {sinc(x / 2) / sqrt(sinc(x)),
                       1,
                       sinc(x),
                       1,
                       sinc(x) * (1 + pow(sin(x / 2), 2) / 3),
                       sinc(x),
                       1};
  return of[number];
}

/* On the oscillators g(q) = -q. */
START_TEST(two_steps_have_the_filters_of_their_name)
{
  const double h = 0.05, x[] = {0.3, 2.5, 4};
  for (int k = _i == 0 ? 1 : 2; k >= 0; k--) {
    problem *model = create_problem("oscillators", method_spec("omega=%.17g", x[k] / h));
    dvi_integrator *integrator = start_integrator(model,
                                                  method_spec("trig:filter=%s", filters[_i]));
    double q[3] = {1};
    for (int i = 1; i < 3; i++) {
      advance(integrator, h, 1);
      q[i] = dvi_integrator_q(integrator)[0];
    }
    ck_assert_double_eq_tol(q[2] - 2 * cos(x[k]) * q[1] + q[0],
                            -h * h * psi(_i, x[k]) * phi(_i, x[k]) * q[1], 2e-15);
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
}
END_TEST

START_TEST(methods_with_one_filter_are_symplectic_and_the_others_are_not)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *integrator = start_integrator(chain, method_spec("trig:filter=%s", filters[_i]));
  double defect;
  advance(integrator, 0.03, 20);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, dvi_integrator_q(integrator),
                                     dvi_integrator_p(integrator), 0.03, &defect),
                   DVI_OK);
  if (_i < VARIATIONAL)
    ck_assert_double_le(defect, 2e-10);
  else
    ck_assert_double_gt(defect, 1e-6);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
}
END_TEST

START_TEST(two_of_them_are_known_by_other_names)
{
  const char *const pair[][2] = {{"trig:filter=deuflhard", "respa:substeps=exact"},
                                 {"trig:filter=garcia-archilla", "mollified:filter=average"}};
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *one = start_integrator(chain, pair[_i][0]),
                 *other = start_integrator(chain, pair[_i][1]);
  advance(one, 0.1, 50);
  advance(other, 0.1, 50);
  ck_assert_double_le(distance(6, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-13);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  problem_destroy(&chain);
}
END_TEST

/* The filter and the motion ask for the fast gradient at one place. */
START_TEST(a_step_has_one_slow_gradient_and_one_fast_one)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *integrator = start_integrator(
      chain, _i < FILTERS ? method_spec("trig:filter=%s", filters[_i]) : "mollified");
  dvi_counters first, after;
  advance(integrator, 0.02, 1);
  dvi_integrator_counters(integrator, &first);
  advance(integrator, 0.02, 50);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - first.gradients, 50 * 2);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
}
END_TEST

/* exact needs sinc x > 0, and gautschi divides by it. */
START_TEST(a_step_at_which_a_filter_does_not_exist_fails_and_a_smaller_one_goes_on)
{
  static const struct {
    const char *method;
    double x;
  } bad[] = {{"trig:filter=exact", 4},
             {"trig:filter=exact", 3.14159265358979323846},
             {"trig:filter=gautschi", 3.14159265358979323846}};
  problem *model = create_problem("oscillators", "omega=1");
  dvi_integrator *integrator = start_integrator(model, bad[_i].method);
  ck_assert_int_eq(dvi_integrator_step(integrator, bad[_i].x), DVI_NOT_CONVERGED);
  check_words("trig: step 1 from t = 0");
  check_words("the state is unchanged, try a smaller step: h omega = ");
  ck_assert_double_eq(dvi_integrator_q(integrator)[0], 1);
  advance(integrator, 0.5, 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(trig)
{
  tcase_add_loop_test(tests, two_steps_have_the_filters_of_their_name, 0, FILTERS);
  tcase_add_loop_test(tests, methods_with_one_filter_are_symplectic_and_the_others_are_not, 0,
                      FILTERS);
  tcase_add_loop_test(tests, two_of_them_are_known_by_other_names, 0, 2);
  tcase_add_loop_test(tests, a_step_has_one_slow_gradient_and_one_fast_one, 0, FILTERS + 1);
  tcase_add_loop_test(
      tests, a_step_at_which_a_filter_does_not_exist_fails_and_a_smaller_one_goes_on, 0, 3);
}
