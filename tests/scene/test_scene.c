/* Scenes give the systems of the catalogue, which were written by hand, with the same Lagrangians
 * and momenta, and the same trajectories up to rounding. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "problem.h"
#include "support/scene/parsed.h"
#include "support/suite.h"

enum { STEPS = 50, SIZE_MAX_OF_STATE = 64 };

static problem *hand;

static void release(void)
{
  release_scene();
  problem_destroy(&hand);
}

static void open_both(const char *text, const char *name)
{
  (void)open_scene(text);
  ck_assert_msg(problem_create(name, 0, NULL, &hand, message, sizeof message) == DVI_OK, "%s",
                message);
  ck_assert_int_eq(dvi_system_nq(dvi_scene_system(scene)), hand->nq);
}

/* A point near the start in general position. */
static void general_point(double *q, double *v)
{
  for (int i = 0; i < hand->nq; i++) {
    q[i] = hand->q[i] + 0.01 * (1 + i % 7);
    v[i] = hand->v[i] + 0.03 * (1 + i % 5);
  }
}

/* Ten roundings of the larger one. */
static void check_same_numbers(int count, const double *a, const double *b, double roundings,
                               const char *what)
{
  for (int i = 0; i < count; i++)
    ck_assert_msg(fabs(a[i] - b[i]) <= roundings * 2.3e-16 * fmax(1, fabs(b[i])),
                  "%s %d: %.17g instead of %.17g", what, i, a[i], b[i]);
}

static void starts_agree(void)
{
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  check_same_numbers(hand->nq, q, hand->q, 10, "q");
  check_same_numbers(hand->nv, v, hand->v, 10, "v");
  check_same_numbers(hand->nv, p, hand->p, 10, "p");
}

static void systems_agree(void)
{
  double q[SIZE_MAX_OF_STATE], v[SIZE_MAX_OF_STATE], p[2][SIZE_MAX_OF_STATE], L[2];
  general_point(q, v);
  ck_assert_int_eq(dvi_system_autonomous(dvi_scene_system(scene)),
                   dvi_system_autonomous(hand->system));
  ck_assert_int_eq(dvi_system_check(dvi_scene_system(scene), 0.3, q, v, 0, NULL), DVI_OK);
  ck_assert_int_eq(dvi_system_lagrangian(dvi_scene_system(scene), 0.3, q, v, &L[0]), DVI_OK);
  ck_assert_int_eq(dvi_system_lagrangian(hand->system, 0.3, q, v, &L[1]), DVI_OK);
  check_same_numbers(1, &L[0], &L[1], 100, "L");
  ck_assert_int_eq(dvi_system_momentum(dvi_scene_system(scene), 0.3, q, v, p[0]), DVI_OK);
  ck_assert_int_eq(dvi_system_momentum(hand->system, 0.3, q, v, p[1]), DVI_OK);
  check_same_numbers(hand->nv, p[0], p[1], 100, "p");
}

static dvi_integrator *start_integrator(const dvi_system *system, const char *method)
{
  dvi_integrator *integrator;
  ck_assert_msg(dvi_integrator_create(system, method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_integrator_start(integrator, 0, hand->q, hand->p) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}

/* Both take each step from the same point, so only the step differs. */
static void step_agrees(dvi_integrator *mine, dvi_integrator *theirs, double t, double h, double *q,
                        double *p)
{
  ck_assert_int_eq(dvi_integrator_start(mine, t, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(theirs, t, q, p), DVI_OK);
  ck_assert_msg(dvi_integrator_step(mine, h) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_integrator_step(theirs, h) == DVI_OK, "%s", dvi_last_error());
  memcpy(q, dvi_integrator_q(theirs), (size_t)hand->nq * sizeof *q);
  memcpy(p, dvi_integrator_p(theirs), (size_t)hand->nv * sizeof *p);
  check_same_numbers(hand->nq, dvi_integrator_q(mine), q, 450, "q after a step"); /* 1e-13 */
  check_same_numbers(hand->nv, dvi_integrator_p(mine), p, 450, "p after a step");
}

static void steps_agree(const char *method, double h)
{
  double q[SIZE_MAX_OF_STATE], p[SIZE_MAX_OF_STATE];
  dvi_integrator *mine = start_integrator(dvi_scene_system(scene), method),
                 *theirs = start_integrator(hand->system, method);
  memcpy(q, hand->q, (size_t)hand->nq * sizeof *q);
  memcpy(p, hand->p, (size_t)hand->nv * sizeof *p);
  for (int k = 0; k < STEPS; k++) step_agrees(mine, theirs, k * h, h, q, p);
  dvi_integrator_destroy(&mine);
  dvi_integrator_destroy(&theirs);
}

static const dvi_scene_facts *facts(void)
{
  static dvi_scene_facts found;
  dvi_scene_facts_of(scene, &found);
  return &found;
}

#define RUN "step: 0.1\nuntil: 1\n"

static const char kepler[] = "parameters: {e: 0.6}\n"
                             "coordinates: {x: scalar, y: scalar}\n"
                             "lagrangian: (x'^2 + y'^2)/2 + 1/sqrt(x^2 + y^2)\n"
                             "symmetries:\n  angular_momentum: {x: -y, y: x}\n"
                             "invariants:\n"
                             "  laplace_x: p(y)*(x*p(y) - y*p(x)) - x/hypot(x, y)\n"
                             "  laplace_y: -x'*(x*y' - y*x') - y/hypot(x, y)\n"
                             "initial:\n  x: 1 - e\n  y: 0\n  y': sqrt((1 + e)/(1 - e))\n" RUN;

START_TEST(kepler_is_that_of_the_catalogue)
{
  open_both(kepler, "kepler");
  starts_agree();
  systems_agree();
  steps_agree("verlet", 0.05);
  steps_agree("galerkin:degree=2", 0.05);
  ck_assert_str_eq(facts()->form, "separable");
  ck_assert_str_eq(facts()->mass, "identity");
}
END_TEST

START_TEST(invariants_are_those_of_the_catalogue)
{
  double q[2], p[2], mine[4], theirs[4];
  open_both(kepler, "kepler");
  general_point(q, p);
  ck_assert_int_eq(dvi_system_invariant_count(dvi_scene_system(scene)), 4);
  for (int i = 0; i < 4; i++)
    ck_assert_str_eq(dvi_system_invariant_name(dvi_scene_system(scene), i),
                     dvi_system_invariant_name(hand->system, i));
  ck_assert_int_eq(dvi_system_invariants(dvi_scene_system(scene), 0, q, p, mine), DVI_OK);
  ck_assert_int_eq(dvi_system_invariants(hand->system, 0, q, p, theirs), DVI_OK);
  check_same_numbers(4, mine, theirs, 10, "invariant");
}
END_TEST

START_TEST(verlet_asks_for_one_gradient_a_step_and_nothing_else)
{
  dvi_counters counters;
  open_both(kepler, "kepler");
  dvi_integrator *integrator = start_integrator(dvi_scene_system(scene), "verlet");
  const long before = facts()->gradient_points;
  for (int k = 0; k < STEPS; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_OK);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_le(facts()->gradient_points - before, STEPS + 1);
  ck_assert_int_eq(facts()->hessian_operations, -1);
  ck_assert_int_eq(counters.jacobians + counters.newtons + counters.fixed_points, 0);
  dvi_integrator_destroy(&integrator);
}
END_TEST

/* Neither are there multipliers where nothing is constrained, nor second derivatives where nothing
 * is solved. */
START_TEST(explicit_methods_derive_nothing_twice_and_have_no_multiplier)
{
  static const char *const method[] = {"verlet", "composition:order=4,base=verlet"};
  dvi_counters counters;
  open_both(kepler, "kepler");
  ck_assert_int_eq(dvi_system_constraint_count(dvi_scene_system(scene)), 0);
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = start_integrator(dvi_scene_system(scene), method[k]);
    for (int i = 0; i < STEPS; i++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_OK);
    dvi_integrator_counters(integrator, &counters);
    ck_assert_int_eq(
        counters.residuals + counters.jacobians + counters.factorizations + counters.symbolic, 0);
    ck_assert_ptr_null(dvi_integrator_multiplier(integrator));
    dvi_integrator_destroy(&integrator);
  }
  ck_assert_int_eq(facts()->hessian_operations, -1);
  ck_assert_int_eq(facts()->hessian_points, 0);
}
END_TEST

START_TEST(the_energy_is_evaluated_where_it_is_asked_for)
{
  static const char *const method[] = {"verlet", "galerkin:degree=2", "midpoint"};
  double value[4], one;
  open_both(kepler, "kepler");
  for (int k = 0; k < 3; k++) {
    dvi_integrator *integrator = start_integrator(dvi_scene_system(scene), method[k]);
    const long before = facts()->value_points;
    for (int i = 0; i < STEPS; i++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_OK);
    for (int i = 1; i < 4; i++)
      ck_assert_int_eq(dvi_integrator_invariant(integrator, i, &one), DVI_OK);
    ck_assert_int_eq(facts()->value_points, before);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &one), DVI_OK);
    ck_assert_int_eq(facts()->value_points, before + 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    ck_assert_double_eq(value[0], one);
    dvi_integrator_destroy(&integrator);
  }
}
END_TEST

START_TEST(pendulum_is_that_of_the_catalogue)
{
  open_both("coordinates: {q: scalar}\nlagrangian: q'^2/2 - cos(q)\ninitial: {q: 2.5}\n" RUN,
            "pendulum");
  systems_agree();
  steps_agree("midpoint", 0.1);
}
END_TEST

START_TEST(fpu_is_that_of_the_catalogue)
{
  open_both(
      "parameters: {ell: 3, omega: 50}\n"
      "coordinates:\n  x0[ell]: scalar\n  x1[ell]: scalar\n"
      "kinetic: (sum(i, x0[i]'^2) + sum(i, x1[i]'^2))/2\n"
      "potentials:\n"
      "  slow: ((x0[1] - x1[1])^4 + sum(i=1..ell-1, (x0[i+1] - x1[i+1] - x0[i] - x1[i])^4) + "
      "(x0[ell] + x1[ell])^4)/4\n"
      "  fast: omega^2/2*sum(i, x1[i]^2)\n"
      "initial:\n  x0: [1, 0, 0]\n  x1[i]: 0\n  x1[1]: 1/omega\n  x0[1]': 1\n  x1[1]': 1\n" RUN,
      "fpu");
  starts_agree();
  systems_agree();
  steps_agree("verlet", 0.005);
  steps_agree("galerkin:degree=2", 0.005);
  ck_assert_int_eq(facts()->quadratic_potentials, 1);
  for (int k = 0; k < 2; k++) {
    ck_assert_int_eq(dvi_scene_terms(scene)->potentials[k].fast, k);
    ck_assert_int_eq(dvi_scene_terms(scene)->potentials[k].quadratic, k);
  }
  ck_assert_str_eq(dvi_scene_coordinate(scene, 3), "x1_1");
  ck_assert_str_eq(dvi_scene_momentum(scene, 2), "p_x0_3");
}
END_TEST

/* The term is 0/0 for the first member, which is given by itself. The others have their own
 * values. */
START_TEST(one_member_may_stand_beside_a_formula_that_is_no_number_there)
{
  const double *q, *v, *p, expected[] = {5, 1, 1, 2, 3, 4.5};
  (void)open_scene("coordinates: {\"x[3]\": scalar}\nlagrangian: sum(i, x[i]'^2/2)\n"
                   "initial: {\"x[1]\": 5, \"x[i]\": \"(i - 1)/(i - 1)\", \"x[1]'\": 2, \"x[i]'\": "
                   "\"3/2*i*(i - 1)/(i - 1)\"}\n" RUN);
  dvi_scene_start(scene, &q, &v, &p);
  check_same_numbers(3, q, expected, 1, "q");
  check_same_numbers(3, v, expected + 3, 1, "v");
}
END_TEST

/* Right derivatives are not called wrong, those of terms that cancel, and of a power that bends
 * within the differences' steps. */
START_TEST(right_derivatives_are_found_right)
{
  static const char *const right[] = {"(x*x')^2/x^2", "x'^2/2 + x^100*x' - x^100",
                                      "x'^2/2 + (x^100)'^2/2"};
  const double q = 1.3, v = 0.5;
  char text[256];
  for (int k = 0; k < 3; k++) {
    (void)snprintf(text, sizeof text,
                   "coordinates: {x: scalar}\nlagrangian: %s\ninitial: {x: 1}\n" RUN, right[k]);
    open_scene(text);
    ck_assert_msg(dvi_system_check(dvi_scene_system(scene), 0, &q, &v, 0, NULL) == DVI_OK, "%s: %s",
                  right[k], dvi_last_error());
  }
}
END_TEST

START_TEST(outer_solar_is_that_of_the_catalogue)
{
  open_both(
      "parameters:\n"
      "  G: 2.95912208286e-4\n"
      "  m: [0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, "
      "1/1.3e8, 1.00000597682]\n"
      "coordinates: {\"q[6]\": vector(3)}\n"
      "lagrangian: sum(i, m[i]/2*dot(q[i]', q[i]')) + G*sum(i<j, m[i]*m[j]/norm(q[i] - q[j]))\n"
      "initial:\n  q:\n"
      "    - [-3.5023653, -3.8169847, -1.5507963]\n    - [9.0755314, -3.0458353, -1.6483708] # "
      "saturn\n"
      "    - [8.3101420, -16.2901086, -7.2521278]\n    - [11.4707666, -25.7294829, -10.8169456]\n"
      "    - [-15.5387357, -25.2225594, -3.1902382]\n    - [0, 0, 0]\n"
      "  q': [[0.00565429, -0.00412490, -0.00190589], [0.00168318, 0.00483525, 0.00192462],\n"
      "       [0.00354178, 0.00137102, 0.00055029], [0.00288930, 0.00114527, 0.00039677],\n"
      "       [0.00276725, -0.00170702, -0.00136504], [0, 0, 0]]\n" RUN,
      "outer-solar");
  starts_agree();
  systems_agree();
  steps_agree("verlet", 100);
  ck_assert_int_eq(dvi_scene_bodies(scene), 6);
  ck_assert_str_eq(facts()->mass, "diagonal");
  ck_assert_int_eq(facts()->elements, 15);
  ck_assert_str_eq(dvi_scene_velocity(scene, 4), "v_q_2_y");
}
END_TEST

START_TEST(double_pendulum_is_that_of_the_catalogue)
{
  open_both("parameters: {l1: 2, l2: 3, m1: 1, m2: 2, g: 9.80665}\n"
            "coordinates:\n  [theta_1, theta_2]: scalar\n"
            "definitions:\n"
            "  upper: [l1*sin(theta_1), -l1*cos(theta_1)]\n"
            "  lower: upper + [l2*sin(theta_2), -l2*cos(theta_2)]\n"
            "lagrangian: m1/2*dot(upper', upper') + m2/2*dot(lower', lower') - m1*g*upper[2] - "
            "m2*g*lower[2]\n"
            "initial: {theta_1: pi/4, theta_2: pi/2, theta_2': pi/8}\n" RUN,
            "double-pendulum");
  starts_agree();
  systems_agree();
  steps_agree("galerkin:degree=2", 0.02);
  ck_assert_str_eq(facts()->form, "general Lagrangian");
}
END_TEST

START_TEST(driven_pendulum_is_that_of_the_catalogue)
{
  open_both("parameters: {a: 0.25, omega: 2}\ncoordinates: {q: scalar}\n"
            "lagrangian: q'^2/2 + a*omega*cos(omega*t)*q'*cos(q) - cos(q)\ninitial: {q: 2}\n" RUN,
            "driven-pendulum");
  starts_agree();
  systems_agree();
  steps_agree("galerkin:degree=3", 0.05);
}
END_TEST

START_TEST(toda_is_that_of_the_catalogue)
{
  open_both("parameters: {N: 20}\ncoordinates:\n  q[N]: scalar\n"
            "definitions:\n  bonds: 0.64*(sum(i=1..N-1, exp(q[i] - q[i+1])) + exp(q[N] - q[1]))\n"
            "lagrangian: sum(i, q[i]'^2)/2 - bonds\n"
            "symmetries:\n  momentum:\n    q[i]: 1\ninitial:\n  q[i]: 0\n" RUN,
            "toda");
  systems_agree();
  steps_agree("verlet", 0.1);
  steps_agree("midpoint", 0.1);
  ck_assert_int_eq(dvi_scene_bodies(scene), 0);
}
END_TEST

START_TEST(lotka_volterra_is_that_of_the_catalogue_in_both_spellings)
{
  static const char *const spelling[] = {
      "one_form:\n  prey: predators + log(predators)/prey\n  predators: prey\n"
      "hamiltonian: prey + predators - log(prey) - 2*log(predators)\n",
      "lagrangian: (predators + log(predators)/prey)*prey' + prey*predators'\n"
      "  - (prey + predators - log(prey) - 2*log(predators))\n"};
  for (int k = 0; k < 2; k++) {
    char text[512];
    (void)snprintf(
        text, sizeof text,
        "coordinates:\n  [prey, predators]: scalar\n%sinitial: {prey: 1, predators: 1}\n" RUN,
        spelling[k]);
    release();
    open_both(text, "lotka-volterra");
    starts_agree();
    systems_agree();
    steps_agree("vprk:nodes=2", 0.1);
    ck_assert_str_eq(facts()->form, "one-form");
  }
}
END_TEST

START_TEST(circle_dirac_is_that_of_the_catalogue)
{
  double q[2] = {0.7, 0.4}, p[2] = {0.3, -0.2};
  open_both("coordinates: {x: scalar, y: scalar}\nhamiltonian: (p(x)^2 + p(y)^2)/2 + y\n"
            "constraints:\n  circle: (x^2 + y^2 - 1)/2\n  tangent: x*p(x) + y*p(y)\n"
            "initial: {x: 0.8, y: 0.6, p(x): 0.3, p(y): -0.4}\n" RUN,
            "circle-dirac");
  starts_agree();
  ck_assert_int_eq(dvi_system_check(dvi_scene_system(scene), 0, q, p, 0, NULL), DVI_OK);
  ck_assert_int_eq(dvi_system_constraint_count(dvi_scene_system(scene)), 2);
  steps_agree("dg-phase", 0.1);
}
END_TEST

START_TEST(elastica_is_that_of_the_catalogue)
{
  double q[3] = {0.7, 0.4, -1.1}, p[3] = {0.3, -0.2, 0.5};
  open_both("coordinates: {x: scalar, y: scalar, theta: scalar}\n"
            "hamiltonian: p(x)*cos(theta) + p(y)*sin(theta) + p(theta)^2/2\n"
            "initial: {x: 0, y: 0, theta: 0, p(x): -1, p(y): 0, p(theta): 1}\n" RUN,
            "elastica");
  starts_agree();
  ck_assert_int_eq(dvi_system_check(dvi_scene_system(scene), 0, q, p, 0, NULL), DVI_OK);
  ck_assert_int_eq(dvi_system_constraint_count(dvi_scene_system(scene)), 0);
  ck_assert_str_eq(facts()->form, "Hamiltonian");
  steps_agree("hamiltonian:type=3", 0.1);
}
END_TEST

SUITE(scene)
{
  tcase_add_checked_fixture(tests, NULL, release);
  tcase_add_test(tests, kepler_is_that_of_the_catalogue);
  tcase_add_test(tests, invariants_are_those_of_the_catalogue);
  tcase_add_test(tests, verlet_asks_for_one_gradient_a_step_and_nothing_else);
  tcase_add_test(tests, explicit_methods_derive_nothing_twice_and_have_no_multiplier);
  tcase_add_test(tests, the_energy_is_evaluated_where_it_is_asked_for);
  tcase_add_test(tests, pendulum_is_that_of_the_catalogue);
  tcase_add_test(tests, fpu_is_that_of_the_catalogue);
  tcase_add_test(tests, one_member_may_stand_beside_a_formula_that_is_no_number_there);
  tcase_add_test(tests, right_derivatives_are_found_right);
  tcase_add_test(tests, outer_solar_is_that_of_the_catalogue);
  tcase_add_test(tests, double_pendulum_is_that_of_the_catalogue);
  tcase_add_test(tests, driven_pendulum_is_that_of_the_catalogue);
  tcase_add_test(tests, toda_is_that_of_the_catalogue);
  tcase_add_test(tests, lotka_volterra_is_that_of_the_catalogue_in_both_spellings);
  tcase_add_test(tests, circle_dirac_is_that_of_the_catalogue);
  tcase_add_test(tests, elastica_is_that_of_the_catalogue);
}
