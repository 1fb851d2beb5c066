/* labels: order invariant */
/* One-step methods for degenerate Lagrangians whose one-form has constant components in one half:
 * the step of dvrk, and conserved quantities of all five. */
#include <math.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/suite.h"

START_TEST(it_is_galerkin_with_gauss_where_y_is_the_momentum)
{
  check_same_as_regular(method_spec("dvrk:nodes=%d", _i), method_spec("galerkin:degree=%d", _i));
}
END_TEST

START_TEST(gauss_stages_have_order_2s)
{
  check_degenerate_order("lotka-volterra", "gauge=singular", method_spec("dvrk:nodes=%d", _i), 0.5,
                         2 * _i);
  check_degenerate_order("massless-particle", "gauge=singular", method_spec("dvrk:nodes=%d", _i), 1,
                         2 * _i);
}
END_TEST

static const char *const family[] = {"dvi-a",           "dvi-b", "dvi-midpoint",
                                     "dvi-trapezoidal", "dvrk",  "dvrk:nodes=3"};
enum { FAMILY = sizeof family / sizeof *family };

/* A circle of starts moves with 600 steps of roundoff. vprk:projection=post is not symplectic, and
 * loses 1e-8 (test_vprk). */
START_TEST(loop_integrals_are_conserved)
{
  ck_assert_double_le(
      loop_integral_change("massless-particle", "gauge=singular", family[_i], 0.1, 600), 2e-12);
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
  check_long_run(runs[_i].problem, "gauge=singular", runs[_i].method, runs[_i].h, 15000,
                 runs[_i].bound, 0);
}
END_TEST

START_TEST(every_step_ends_on_the_constraint)
{
  problem *model = create_problem("massless-particle", "gauge=singular");
  dvi_integrator *integrator = start_integrator(model, family[_i]);
  for (int step = 0; step < 200; step++) {
    advance(integrator, 0.1, 1);
    ck_assert_double_eq(constraint_defect(model, integrator), 0);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* A step of -h undoes a step of h, up to what Newton's method leaves. */
START_TEST(symmetric_methods_return_and_the_two_eulers_are_adjoint)
{
  static const char *const back[] = {"dvi-b",           "dvi-a", "dvi-midpoint",
                                     "dvi-trapezoidal", "dvrk",  "dvrk:nodes=3"};
  problem *model = create_problem("massless-particle", "gauge=singular");
  dvi_integrator *there = start_integrator(model, family[_i]),
                 *home = create_integrator(model->system, back[_i]);
  for (int step = 0; step < 20; step++) {
    advance(there, 0.2, 1);
    double q[2];
    memcpy(q, dvi_integrator_q(there), sizeof q);
    ck_assert_int_eq(dvi_integrator_start(home, 0, q, dvi_integrator_p(there)), DVI_OK);
    advance(home, -0.2, 1);
    dvi_integrator *again = create_integrator(model->system, family[_i]);
    ck_assert_int_eq(dvi_integrator_start(again, 0, dvi_integrator_q(home), dvi_integrator_p(home)),
                     DVI_OK);
    advance(again, 0.2, 1);
    ck_assert_double_le(distance(2, dvi_integrator_q(again), q), 1e-14);
    dvi_integrator_destroy(&again);
  }
  dvi_integrator_destroy(&there);
  dvi_integrator_destroy(&home);
  problem_destroy(&model);
}
END_TEST

START_TEST(other_one_forms_are_refused)
{
  check_refused_one_forms("dvrk:nodes=3");
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
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &form, .potentials = &H, .potential_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "dvi-midpoint");
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
  dvi_one_form form = {
      .value = far_value, .gradient = far_gradient, .gradients = {full_start, row}};
  const dvi_potential H = {.value = square};
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &form, .potentials = &H, .potential_count = 1};
  dvi_integrator *integrator = NULL;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "dvi-a", &integrator), DVI_UNSUPPORTED);
  check_words("declare the pattern of its gradients");
  dvi_system_destroy(&system);
  form.gradients = (dvi_pattern){start, row};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_msg(dvi_integrator_create(system, "dvi-a", &integrator) == DVI_OK, "%s",
                dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- time ---- */

/* V = (1 + sin(3 t)/2) x^4/4 of a regular system of one coordinate, and H = y^2/2 + V of (y, x)
 * with alpha = (0, y). */
static int driven(double t, const double *x, double *V, void *user)
{
  (void)user;
  *V = (1 + 0.5 * sin(3 * t)) * x[0] * x[0] * x[0] * x[0] / 4;
  return 0;
}

static int driven_gradient(double t, const double *x, double *V_x, void *user)
{
  (void)user;
  V_x[0] = (1 + 0.5 * sin(3 * t)) * x[0] * x[0] * x[0];
  return 0;
}

static int driven_energy(double t, const double *q, double *H, void *user)
{
  const int returned = driven(t, q + 1, H, user);
  *H += 0.5 * q[0] * q[0];
  return returned;
}

static int driven_energy_gradient(double t, const double *q, double *H_q, void *user)
{
  H_q[0] = q[0];
  return driven_gradient(t, q + 1, H_q + 1, user);
}

static int kinetic_form(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = 0;
  alpha[1] = q[0];
  return 0;
}

static int kinetic_gradient(const double *q, double *alpha_q, void *user)
{
  const double entries[] = {0, 0, 1, 0};
  (void)q, (void)user;
  memcpy(alpha_q, entries, sizeof entries);
  return 0;
}

static const struct {
  const char *degenerate, *regular;
} pairs[] = {{"dvi-a", "hp:type=2"},       {"dvi-b", "hp:type=3"},
             {"dvi-midpoint", "midpoint"}, {"dvi-trapezoidal", "verlet"},
             {"dvrk", "galerkin"},         {"dvrk:nodes=5", "galerkin:degree=5"}};
enum { PAIRS = sizeof pairs / sizeof *pairs };

START_TEST(a_hamiltonian_that_depends_on_time_is_met_at_the_same_times)
{
  const dvi_potential V = {.value = driven, .gradient = driven_gradient};
  const dvi_potential H = {.value = driven_energy, .gradient = driven_energy_gradient};
  const dvi_one_form form = {.value = kinetic_form, .gradient = kinetic_gradient};
  const double x = 1.2, y = -0.3, q[] = {y, x}, p[] = {0, y};
  dvi_system *one = NULL, *other = NULL;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = 2,
                                                         .one_form = &form,
                                                         .potentials = &H,
                                                         .potential_count = 1},
                                     &one),
                   DVI_OK);
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = 1,
                                                         .mass.scalar = 1,
                                                         .potentials = &V,
                                                         .potential_count = 1},
                                     &other),
                   DVI_OK);
  dvi_integrator *a = create_integrator(one, pairs[_i].degenerate),
                 *b = create_integrator(other, pairs[_i].regular);
  ck_assert_int_eq(dvi_integrator_start(a, 0.4, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(b, 0.4, &x, &y), DVI_OK);
  advance(a, 0.1, 40);
  advance(b, 0.1, 40);
  ck_assert_double_eq_tol(dvi_integrator_q(a)[1], dvi_integrator_q(b)[0], 2e-13);
  ck_assert_double_eq_tol(dvi_integrator_q(a)[0], dvi_integrator_p(b)[0], 2e-13);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  dvi_system_destroy(&one);
  dvi_system_destroy(&other);
}
END_TEST

SUITE(dvrk)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, it_is_galerkin_with_gauss_where_y_is_the_momentum, 1, 7);
  tcase_add_loop_test(tests, gauss_stages_have_order_2s, 1, 5);
  tcase_add_loop_test(tests, loop_integrals_are_conserved, 0, FAMILY);
  tcase_add_loop_test(tests, energy_stays_bounded, 0, RUNS);
  tcase_add_loop_test(tests, every_step_ends_on_the_constraint, 0, FAMILY);
  tcase_add_loop_test(tests, symmetric_methods_return_and_the_two_eulers_are_adjoint, 0, FAMILY);
  tcase_add_loop_test(tests, a_hamiltonian_that_depends_on_time_is_met_at_the_same_times, 0, PAIRS);
  tcase_add_test(tests, other_one_forms_are_refused);
  tcase_add_test(tests, a_component_that_changes_after_all_stops_the_step);
  tcase_add_test(tests, a_pattern_tells_the_class_where_no_probe_reaches);
}
