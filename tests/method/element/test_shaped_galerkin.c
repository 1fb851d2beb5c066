/* labels: invariant */
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/spaces.h"
#include "support/suite.h"
#include "support/systems/systems.h"

/* ---- a space that the library has, too ---- */

static void check_same_run(const char *name, const char *method, const dvi_shapes *shapes,
                           const char *shaped, double h, double tolerance)
{
  problem *model = create_problem(name, NULL);
  const int n = dvi_system_nq(model->system);
  dvi_integrator *galerkin = start_integrator(model, method),
                 *given = start_integrator_with_shapes(model, shapes, shaped);
  advance(galerkin, h, 50);
  advance(given, h, 50);
  ck_assert_double_le(distance(n, dvi_integrator_q(galerkin), dvi_integrator_q(given)), tolerance);
  ck_assert_double_le(distance(n, dvi_integrator_p(galerkin), dvi_integrator_p(given)), tolerance);
  dvi_integrator_destroy(&galerkin);
  dvi_integrator_destroy(&given);
  problem_destroy(&model);
}

START_TEST(polynomials_given_as_functions_are_galerkin)
{
  const dvi_shapes three = powers(3), one = powers(1);
  check_same_run("pendulum", "galerkin:degree=4", &three, "shaped-galerkin", 0.3, 1e-13);
  check_same_run("kepler", "galerkin:degree=4,nodes=6", &three, "shaped-galerkin:nodes=6", 0.05,
                 1e-12);
  check_same_run("double-pendulum", "galerkin:degree=4", &three, "shaped-galerkin", 0.05, 1e-11);
  check_same_run("toda", "galerkin:degree=2,quadrature=lobatto", &one,
                 "shaped-galerkin:quadrature=lobatto,nodes=3", 0.1, 1e-12);
  check_same_run("kepler", "composition:order=6,base=galerkin,degree=2", &one,
                 "composition:order=6,base=shaped-galerkin", 0.1, 1e-12);
}
END_TEST

/* All bases of one space give the same trajectory. */
static int mixed(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h, (void)user;
  value[0] = 1e6 + 1e3 * (tau * tau - 5 * tau);
  derivative[0] = 1e3 * (2 * tau - 5);
  value[1] = 1e-5 * (tau * tau * tau + 2 * tau * tau - 1);
  derivative[1] = 1e-5 * (3 * tau * tau + 4 * tau);
  return 0;
}

START_TEST(scales_constants_and_mixtures_of_functions_do_not_matter)
{
  const dvi_shapes shapes = {.name = "mixed", .functions = 2, .evaluate = mixed};
  check_same_run("pendulum", "galerkin:degree=3", &shapes, "shaped-galerkin", 0.3,
                 1e-9); /* 1e6 rounds away six digits of 1e3 tau^2 */
}
END_TEST

/* ---- oscillations ---- */

static const double omega_of_oscillators = 50.009999000199950014;

START_TEST(an_oscillator_of_the_given_frequency_is_exact)
{
  static const double h[] = {1e-3, 0.01, 0.1, 0.3, -0.1};
  problem *model = create_problem("oscillators", NULL);
  const dvi_shapes shapes = oscillation(&omega_of_oscillators);
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes,
                                                            "shaped-galerkin:nodes=30");
  advance(integrator, h[_i], 10);
  double q, p, path, v;
  ck_assert_int_eq(model->exact(model, dvi_integrator_time(integrator), &q, &p), 0);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q, 1e-12);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], p, 5e-11);
  ck_assert_int_eq(model->exact(model, 9.3 * h[_i], &q, &p), 0);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 9.3 * h[_i], &path, &v), DVI_OK);
  ck_assert_double_eq_tol(path, q, 1e-12);
  ck_assert_double_eq_tol(v, p, 1e-9);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* At so small an omega h sine and cosine are polynomials but for less than 1e-8 of themselves. */
START_TEST(functions_that_become_polynomials_are_left_out)
{
  static const double slow = 1e-7;
  const dvi_shapes shapes = oscillation(&slow);
  problem *model = create_problem("pendulum", NULL);
  dvi_shapes fast = shapes;
  fast.h = 1e7;
  dvi_integrator *integrator = start_integrator_with_shapes(model, &fast,
                                                            "shaped-galerkin:degree=3,nodes=8"),
                 *galerkin = start_integrator(model, "galerkin:degree=3,nodes=8");
  advance(integrator, 0.2, 50);
  advance(galerkin, 0.2, 50);
  ck_assert_double_eq_tol(*dvi_integrator_q(integrator), *dvi_integrator_q(galerkin), 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&galerkin);
  ck_assert_int_eq(
      create_with_shapes(model->system, &shapes, "shaped-galerkin:degree=3,nodes=8", &integrator),
      DVI_BAD_ARGUMENT);
  check_words("function 0 is a combination of a constant, polynomials up to degree 3");
  problem_destroy(&model);
}
END_TEST

/* ---- coordinates ---- */

/* An oscillator of frequency 20 beside a pendulum that does not feel it. */
static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 200 * q[0] * q[0] - cos(q[1]);
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 400 * q[0];
  V_q[1] = sin(q[1]);
  return 0;
}

START_TEST(coordinates_that_are_not_listed_have_polynomials)
{
  static const double omega = 20, q[] = {0.3, 1}, p[] = {1, 0.5};
  static const int first = 0;
  const dvi_potential potential = {.name = "V", .value = value, .gradient = gradient};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_shapes shapes = oscillation(&omega);
  shapes.coordinates = &first, shapes.coordinate_count = 1;
  dvi_integrator *given = create_integrator_with_shapes(system, &shapes,
                                                        "shaped-galerkin:degree=3,nodes=20"),
                 *galerkin = create_integrator(system, "galerkin:degree=3,nodes=20");
  ck_assert_int_eq(dvi_integrator_start(given, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(galerkin, 0, q, p), DVI_OK);
  advance(given, 0.2, 20);
  advance(galerkin, 0.2, 20);
  ck_assert_double_eq_tol(dvi_integrator_q(given)[0], 0.3 * cos(80) + sin(80) / 20, 1e-12);
  ck_assert_double_eq_tol(dvi_integrator_q(given)[1], dvi_integrator_q(galerkin)[1], 1e-13);
  char text[1000];
  (void)dvi_integrator_explain(given, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "polynomials of degree 3, and in 1 of 2 coordinates 2 "
                                     "functions of the program's, oscillation\n"));
  dvi_integrator_destroy(&given);
  dvi_integrator_destroy(&galerkin);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- structure ---- */

static const double sixth = 6;

static const struct structure {
  const char *keys;
  int symmetric;
} structures[] = {{"nodes=6", 1},
                  {"degree=2,nodes=5", 1},
                  {"degree=2,nodes=5", 0},
                  {"degree=3", 1},
                  {"degree=2,quadrature=radau-left,nodes=4", 0},
                  {"degree=1", 0},
                  {"degree=3,nodes=4", 0}};
enum { STRUCTURES = sizeof structures / sizeof *structures };

static dvi_shapes shapes_of(int i)
{
  const dvi_shapes shapes[] = {oscillation(&sixth), decay, lopsided, spline,
                               oscillation(&sixth), milne, steep};
  return shapes[i];
}

START_TEST(steps_are_symplectic_and_keep_momenta_in_every_space)
{
  problem *model = create_problem("kepler", NULL);
  const dvi_shapes shapes = shapes_of(_i);
  dvi_integrator *integrator = start_integrator_with_shapes(
      model, &shapes, method_spec("shaped-galerkin:%s", structures[_i].keys));
  double defect, before[8], after[8];
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, 0.1, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-10);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  advance(integrator, 0.1, repeats(2000));
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  ck_assert_double_eq_tol(after[0], before[0], 1e-2); /* the energy does not drift */
  ck_assert_str_eq(dvi_system_invariant_name(model->system, 1), "angular_momentum");
  ck_assert_double_eq_tol(after[1], before[1], 1e-12);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(symmetry_is_found_out)
{
  problem *model = create_problem("kepler", NULL);
  const dvi_shapes shapes = shapes_of(_i);
  dvi_integrator *integrator = start_integrator_with_shapes(
                     model, &shapes, method_spec("shaped-galerkin:%s", structures[_i].keys)),
                 *composed = NULL;
  char text[1000];
  double defect;
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_int_eq(strstr(text, ", symmetric\n") != NULL, structures[_i].symmetric);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, model->q, model->p, 0.1, 10, &defect), DVI_OK);
  ck_assert_int_eq(defect < 1e-11, structures[_i].symmetric);
  const dvi_status status = create_with_shapes(
      model->system, &shapes,
      method_spec("composition:order=4,base=shaped-galerkin,%s", structures[_i].keys), &composed);
  ck_assert_int_eq(status, structures[_i].symmetric ? DVI_OK : DVI_BAD_OPTION);
  if (status != DVI_OK) check_words("is not symmetric");
  dvi_integrator_destroy(&composed);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- orders ---- */

static double slope_of(const dvi_shapes *shapes, const char *method, int first, int *claimed)
{
  enum { LEVELS = 5 };
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *judge = start_integrator(model, "galerkin:degree=10"),
                 *integrator = create_integrator_with_shapes(model->system, shapes, method);
  double h[LEVELS], error[LEVELS];
  advance(judge, 0.05, 40);
  for (int k = 0; k < LEVELS; k++) {
    const int steps = first << k;
    h[k] = 2.0 / steps;
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
    advance(integrator, h[k], steps);
    error[k] = hypot(*dvi_integrator_q(integrator) - *dvi_integrator_q(judge),
                     *dvi_integrator_p(integrator) - *dvi_integrator_p(judge));
  }
  dvi_order_fit fit;
  ck_assert_msg(dvi_order(LEVELS, h, error, 1e-13, 0, &fit) == DVI_OK, "%s", dvi_last_error());
  *claimed = dvi_integrator_order(integrator);
  dvi_integrator_destroy(&judge);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return fit.slope;
}

/* Even where the quadrature has the functions' integrals wrong by a part of ten. */
START_TEST(the_order_is_that_of_the_polynomials)
{
  static const struct {
    const dvi_shapes *shapes;
    int degree, nodes;
  } few[] = {{&lopsided, 1, 3}, {&lopsided, 1, 6}, {&lopsided, 2, 4}, {&lopsided, 2, 8},
             {&steep, 1, 2},    {&steep, 2, 4},    {&steep, 2, 3},    {&milne, 1, 3}};
  int claimed;
  const double slope = slope_of(
      few[_i].shapes,
      method_spec("shaped-galerkin:degree=%d,nodes=%d", few[_i].degree, few[_i].nodes), 20,
      &claimed);
  ck_assert_int_eq(claimed, 2 * few[_i].degree);
  ck_assert_double_ge(slope, claimed - 0.2);
}
END_TEST

START_TEST(straight_motion_is_exact)
{
  const double q = 1, p = -3;
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = 1, .mass.scalar = 2});
  dvi_integrator *integrator = create_integrator_with_shapes(system, &steep,
                                                             "shaped-galerkin:nodes=2");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
  advance(integrator, 0.5, 100);
  double between, v;
  ck_assert_double_eq_tol(*dvi_integrator_q(integrator), -74, 1e-12);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 49.8, &between, &v), DVI_OK);
  ck_assert_double_eq_tol(between, 1 - 1.5 * 49.8, 1e-12);
  ck_assert_double_eq_tol(v, -1.5, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(cubic_splines_have_order_6)
{
  int claimed;
  const double slope = slope_of(&spline, "shaped-galerkin:degree=3", 5, &claimed);
  ck_assert_int_eq(claimed, 6);
  ck_assert_double_eq_tol(slope, 6, 0.2);
}
END_TEST

START_TEST(a_basis_of_b_splines_has_the_same_paths)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *powers_of_it = start_integrator_with_shapes(model, &spline,
                                                              "shaped-galerkin:degree=3"),
                 *basis = start_integrator_with_shapes(model, &b_splines, "shaped-galerkin");
  ck_assert_int_eq(dvi_integrator_order(basis), dvi_integrator_order(powers_of_it));
  advance(powers_of_it, 0.1, 50);
  advance(basis, 0.1, 50);
  ck_assert_double_le(distance(2, dvi_integrator_q(powers_of_it), dvi_integrator_q(basis)), 1e-12);
  ck_assert_double_le(distance(2, dvi_integrator_p(powers_of_it), dvi_integrator_p(basis)), 1e-12);
  dvi_integrator_destroy(&powers_of_it);
  dvi_integrator_destroy(&basis);
  problem_destroy(&model);
}
END_TEST

/* Sine and cosine are worth two degrees. */
START_TEST(an_order_of_ones_own_may_be_claimed)
{
  static const double omega = 1;
  int claimed;
  dvi_shapes shapes = oscillation(&omega);
  shapes.order = 6;
  const double slope = slope_of(&shapes, "shaped-galerkin:nodes=6", 5, &claimed);
  ck_assert_int_eq(claimed, 6);
  ck_assert_double_eq_tol(slope, 6, 0.2);
}
END_TEST

SUITE(shaped_galerkin)
{
  tcase_add_test(tests, polynomials_given_as_functions_are_galerkin);
  tcase_add_test(tests, scales_constants_and_mixtures_of_functions_do_not_matter);
  tcase_add_loop_test(tests, an_oscillator_of_the_given_frequency_is_exact, 0, 5);
  tcase_add_test(tests, functions_that_become_polynomials_are_left_out);
  tcase_add_test(tests, coordinates_that_are_not_listed_have_polynomials);
  tcase_add_loop_test(tests, steps_are_symplectic_and_keep_momenta_in_every_space, 0, STRUCTURES);
  tcase_add_loop_test(tests, symmetry_is_found_out, 0, STRUCTURES);
  tcase_add_loop_test(tests, the_order_is_that_of_the_polynomials, 0, 8);
  tcase_add_test(tests, straight_motion_is_exact);
  tcase_add_test(tests, cubic_splines_have_order_6);
  tcase_add_test(tests, a_basis_of_b_splines_has_the_same_paths);
  tcase_add_test(tests, an_order_of_ones_own_may_be_claimed);
}
