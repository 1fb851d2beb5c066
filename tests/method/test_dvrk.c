/* labels: order invariant */
/* One-step methods for degenerate Lagrangians with half of the one-form's components constant: what dvrk is, and what all five conserve. */
#include <math.h>
#include <string.h>

#include "support/degenerate.h"
#include "support/suite.h"

START_TEST(it_is_galerkin_with_gauss_where_y_is_the_momentum)
{
  check_same_as_regular(spec("dvrk:nodes=%d", _i), spec("galerkin:degree=%d", _i));
}
END_TEST

START_TEST(gauss_stages_have_order_2s)
{
  check_degenerate_order("lotka-volterra", "gauge=singular", spec("dvrk:nodes=%d", _i), 0.5, 2 * _i);
  check_degenerate_order("massless-particle", "gauge=singular", spec("dvrk:nodes=%d", _i), 1, 2 * _i);
}
END_TEST

static const char *const family[] = {"dvi-a", "dvi-b", "dvi-midpoint", "dvi-trapezoidal", "dvrk", "dvrk:nodes=3"};
enum { FAMILY = sizeof family / sizeof *family };

/* A circle of starts; 600 steps of roundoff. vprk:projection=post is not symplectic, and loses 1e-8 (test_vprk). */
START_TEST(loop_integrals_are_conserved)
{
  ck_assert_double_le(change_of_loop("massless-particle", "gauge=singular", family[_i], 0.1, 600), 2e-12);
}
END_TEST

static const struct {
  const char *problem, *method;
  double h, bound;
} runs[] = {{"massless-particle", "dvi-a", 0.2, 4.1e-2},
            {"massless-particle", "dvi-b", 0.2, 3.7e-2},
            {"massless-particle", "dvi-midpoint", 0.2, 1.3e-3},
            {"massless-particle", "dvi-trapezoidal", 0.2, 2.7e-3},
            {"massless-particle", "dvrk", 0.2, 1.6e-6},
            {"massless-particle", "dvrk:nodes=3", 0.2, 3.5e-9},
            {"lotka-volterra", "dvi-a", 0.05, 5e-2},
            {"lotka-volterra", "dvi-b", 0.05, 5e-2},
            {"lotka-volterra", "dvrk", 0.1, 2.1e-6},
            {"lotka-volterra", "dvrk:nodes=3", 0.1, 2.5e-9}};
enum { RUNS = sizeof runs / sizeof *runs };

START_TEST(energy_stays_bounded)
{
  check_long_run(runs[_i].problem, "gauge=singular", runs[_i].method, runs[_i].h, 15000, runs[_i].bound, 0);
}
END_TEST

START_TEST(every_step_ends_on_the_constraint)
{
  problem *of = made_problem("massless-particle", "gauge=singular");
  dvi_integrator *integrator = started(of, family[_i]);
  for (int step = 0; step < 200; step++) {
    advance(integrator, 0.1, 1);
    ck_assert_double_eq(off_constraint(of, integrator), 0);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}
END_TEST

/* A step of -h undoes a step of h, up to what Newton's method leaves. */
START_TEST(symmetric_methods_return_and_the_two_eulers_are_adjoint)
{
  static const char *const back[] = {"dvi-b", "dvi-a", "dvi-midpoint", "dvi-trapezoidal", "dvrk", "dvrk:nodes=3"};
  problem *of = made_problem("massless-particle", "gauge=singular");
  dvi_integrator *there = started(of, family[_i]), *home = made_integrator(of->system, back[_i]);
  for (int step = 0; step < 20; step++) {
    advance(there, 0.2, 1);
    double q[2];
    memcpy(q, dvi_integrator_q(there), sizeof q);
    ck_assert_int_eq(dvi_integrator_start(home, 0, q, dvi_integrator_p(there)), DVI_OK);
    advance(home, -0.2, 1);
    dvi_integrator *again = made_integrator(of->system, family[_i]);
    ck_assert_int_eq(dvi_integrator_start(again, 0, dvi_integrator_q(home), dvi_integrator_p(home)), DVI_OK);
    advance(again, 0.2, 1);
    ck_assert_double_le(distance(2, dvi_integrator_q(again), q), 1e-14);
    dvi_integrator_destroy(&again);
  }
  dvi_integrator_destroy(&there);
  dvi_integrator_destroy(&home);
  problem_destroy(&of);
}
END_TEST

START_TEST(other_one_forms_are_refused)
{
  check_class("dvrk:nodes=3");
}
END_TEST

/* ---- a one-form that hides what it is ---- */

/* alpha = (y, 0) up to |y| = 200, from where on its second component is not constant. */
static int bent_value(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = q[1];
  alpha[1] = fabs(q[1]) > 200 ? q[0] : 0;
  return 0;
}

static int bent_gradient(const double *q, double *alpha_q, void *user)
{
  (void)user;
  const double entries[] = {0, 1, fabs(q[1]) > 200, 0};
  memcpy(alpha_q, entries, sizeof entries);
  return 0;
}

static int square(double t, const double *q, double *H, void *user)
{
  (void)t, (void)user;
  *H = 0.5 * (q[0] * q[0] + q[1] * q[1]);
  return 0;
}

START_TEST(a_component_that_changes_after_all_stops_the_step)
{
  const dvi_one_form form = {.value = bent_value, .gradient = bent_gradient};
  const dvi_potential H = {.value = square};
  dvi_system *system = NULL;
  const dvi_system_terms terms = {.dimension = 2, .one_form = &form, .potentials = &H, .potential_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = made_integrator(system, "dvi-midpoint");
  const double q[] = {-300, 190}, p[] = {190, 0};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_UNSUPPORTED);
  check_words("component 1 of the one-form, which was constant at all points probed, changes here");
  ck_assert_mem_eq(dvi_integrator_q(integrator), q, sizeof q);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* A domain far from the probes: empty columns of the pattern tell the class. */
static int far_value(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = q[1];
  alpha[1] = 0;
  return q[0] < 1e6;
}

static int far_gradient(const double *q, double *alpha_q, void *user)
{
  (void)user;
  if (q[0] < 1e6) return 1;
  alpha_q[0] = 0;
  alpha_q[1] = 1;
  return 0;
}

START_TEST(a_pattern_tells_the_class_where_no_probe_reaches)
{
  static const int start[] = {0, 2, 2}, full_start[] = {0, 2, 4}, row[] = {0, 1, 0, 1};
  dvi_one_form form = {.value = far_value, .gradient = far_gradient, .gradients = {full_start, row}};
  const dvi_potential H = {.value = square};
  const dvi_system_terms terms = {.dimension = 2, .one_form = &form, .potentials = &H, .potential_count = 1};
  dvi_integrator *integrator = NULL;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "dvi-a", &integrator), DVI_UNSUPPORTED);
  check_words("declare the pattern of its gradients");
  dvi_system_destroy(&system);
  form.gradients = (dvi_pattern){start, row};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_msg(dvi_integrator_create(system, "dvi-a", &integrator) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("dvrk");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, it_is_galerkin_with_gauss_where_y_is_the_momentum, 1, 7);
  tcase_add_loop_test(tests, gauss_stages_have_order_2s, 1, 5);
  tcase_add_loop_test(tests, loop_integrals_are_conserved, 0, FAMILY);
  tcase_add_loop_test(tests, energy_stays_bounded, 0, RUNS);
  tcase_add_loop_test(tests, every_step_ends_on_the_constraint, 0, FAMILY);
  tcase_add_loop_test(tests, symmetric_methods_return_and_the_two_eulers_are_adjoint, 0, FAMILY);
  tcase_add_test(tests, other_one_forms_are_refused);
  tcase_add_test(tests, a_component_that_changes_after_all_stops_the_step);
  tcase_add_test(tests, a_pattern_tells_the_class_where_no_probe_reaches);
  return run_tests("method/dvrk", tests);
}
