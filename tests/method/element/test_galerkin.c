/* labels: unit */
#include <check.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

static const char *const bases[] = {"gauss", "chebyshev-lobatto", "equispaced", "legendre",
                                    "chebyshev"};
enum { BASES = sizeof bases / sizeof *bases, DEGREES = 8 };

/* All bases of one degree span the same polynomials, so they have the same discrete action and the
 * same trajectory. */
static void check_bases_agree(const char *problem_name, int degree, const char *basis)
{
  problem *model = create_problem(problem_name, NULL);
  dvi_integrator *lobatto = start_integrator(model, method_spec("galerkin:degree=%d", degree));
  dvi_integrator *other = start_integrator(
      model, method_spec("galerkin:degree=%d,basis=%s", degree, basis));
  advance(lobatto, model->h, 100);
  advance(other, model->h, 100);
  const double apart = distance(model->nq, dvi_integrator_q(lobatto), dvi_integrator_q(other));
  /* 100 steps' roundings, with the basis' Lebesgue constant (10 at most here), far below what users
   * can see */
  ck_assert_msg(apart <= 1e-12, "%s: degree %d, basis %s: %g apart", problem_name, degree, basis,
                apart);
  dvi_integrator_destroy(&lobatto);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}

START_TEST(all_bases_of_a_degree_give_one_trajectory)
{
  const int degree = 1 + _i / BASES;
  check_bases_agree("kepler", degree, bases[_i % BASES]);
  check_bases_agree("double-pendulum", degree, bases[_i % BASES]);
  check_bases_agree("toda", degree, bases[_i % BASES]);
}
END_TEST

static void check_order(const char *method, int order)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = create_integrator(oscillator->system, method);
  ck_assert_msg(dvi_integrator_order(integrator) == order, "%s claims order %d", method,
                dvi_integrator_order(integrator));
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}

START_TEST(the_claimed_order_is_the_lesser_of_twice_the_degree_and_the_quadratures)
{
  check_order("galerkin", 4);
  check_order("galerkin:degree=3", 6);
  check_order("galerkin:degree=3,nodes=6", 6);
  check_order("galerkin:degree=3,quadrature=lobatto", 6);
  check_order("galerkin:degree=3,quadrature=lobatto,nodes=3", 4);
  check_order("galerkin:degree=3,quadrature=radau-left,nodes=3", 5);
  check_order("galerkin:degree=2,quadrature=simpson", 4);
  check_order("galerkin:degree=1,quadrature=trapezoid", 2);
  check_order("galerkin:degree=4,quadrature=clenshaw-curtis,nodes=5", 6);
}
END_TEST

START_TEST(nodes_left_out_are_the_fewest_of_full_order)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = create_integrator(oscillator->system,
                                                 "galerkin:degree=5,quadrature=lobatto");
  ck_assert_str_eq(dvi_integrator_method(integrator),
                   "galerkin:degree=5,basis=lobatto,quadrature=lobatto,nodes=6,solver=auto");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

/* A specification, and a word that the refusal must hold. */
static const struct {
  const char *method, *because;
} refused[] = {
    {"galerkin:degree=3,nodes=2", "singular"},
    {"galerkin:degree=3,quadrature=midpoint", "nodes must be at least degree"},
    {"galerkin:degree=2,quadrature=lobatto,nodes=1", "at least 2"},
    {"galerkin:quadrature=simpson,nodes=4", "leave nodes out"},
    {"galerkin:degree=0", "1 to 40"},
    {"galerkin:degree=41", "1 to 40"},
    {"galerkin:degree=99999999999999999999", "1 to 40"},
    {"galerkin:degree=2.5", "whole number"},
    {"galerkin:degree=", "whole number"},
    {"galerkin:degree", "key=value"},
    {"galerkin:", "key=value"},
    {"galerkin:degree=2,", "key=value"},
    {"galerkin:degree=2,degree=2", "twice"},
    {"galerkin:dgree=2", "dgree"},
    {"galerkin:basis=hermite", "legendre"},
    {"galerkin:solver=magic", "kinsol"},
    {"galerking", "verlet"},
    {"", "unknown method"},
    {" galerkin", "unknown method"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(a_wrong_specification_is_refused_with_its_reason)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(oscillator->system, refused[_i].method, &integrator),
                   DVI_BAD_OPTION);
  ck_assert_ptr_null(integrator);
  ck_assert_msg(strstr(dvi_last_error(), refused[_i].because) != NULL, "%s: '%s'",
                refused[_i].method, dvi_last_error());
  problem_destroy(&oscillator);
}
END_TEST

/* Slow forces need only fixed-point iteration, and a stiff spring at h omega = 5 needs Newton's
 * method. The counters tell which one ran. */
START_TEST(the_contraction_chooses_the_solver)
{
  problem *chain = create_undeclared_problem("fpu", NULL);
  dvi_integrator *slow = start_integrator(chain, "galerkin"),
                 *stiff = start_integrator(chain, "galerkin");
  dvi_counters counters;
  advance(slow, 0.001, 20);
  dvi_integrator_counters(slow, &counters);
  ck_assert_int_eq(counters.fixed_points, 20);
  ck_assert_int_eq(counters.jacobians + counters.kinsols, 0);
  advance(stiff, 0.1, 20);
  dvi_integrator_counters(stiff, &counters);
  ck_assert_int_eq(counters.simplified, 20);
  ck_assert_int_eq(counters.newtons, 0);
  ck_assert_int_eq(counters.kinsols, 0);
  dvi_integrator_destroy(&slow);
  dvi_integrator_destroy(&stiff);
  problem_destroy(&chain);
}
END_TEST

/* One discrete action has one stationary path near the true one, and every solver finds it up to
 * roundoff. */
START_TEST(all_solvers_find_the_same_step)
{
  const char *const solvers[] = {"fixed-point", "newton", "kinsol"};
  problem *pendula = create_problem("double-pendulum", NULL);
  dvi_integrator *automatic = start_integrator(pendula, "galerkin:degree=3"),
                 *other = start_integrator(pendula,
                                           method_spec("galerkin:degree=3,solver=%s", solvers[_i]));
  advance(automatic, 0.02, 20);
  advance(other, 0.02, 20);
  /* 20 steps of a rounding each */
  ck_assert_double_le(distance(2, dvi_integrator_q(automatic), dvi_integrator_q(other)), 1e-14);
  dvi_integrator_destroy(&automatic);
  dvi_integrator_destroy(&other);
  problem_destroy(&pendula);
}
END_TEST

/* Two oscillators, the second in a unit a billion times longer. V = (w x)^2/2 + (w y/unit)^2/2 with
 * masses 1 and 1/unit^2. */
static const double unit = 1e-9, stiffness = 1e4;

static int two_springs(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * stiffness * (q[0] * q[0] + q[1] * q[1] / (unit * unit));
  return 0;
}

static int two_forces(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = stiffness * q[0];
  V_q[1] = stiffness * q[1] / (unit * unit);
  return 0;
}

/* Newton's method must not stop when only the large coordinate is at roundoff. Both oscillators are
 * the same, and must stay so. */
START_TEST(a_small_coordinate_is_solved_to_its_own_roundoff)
{
  const double masses[] = {1, 1 / (unit * unit)}, q[] = {1, unit}, p[] = {0, 0};
  /* the Hessian is differenced and slightly wrong */
  const dvi_potential springs = {.value = two_springs, .gradient = two_forces};
  const dvi_system_terms terms = {
      .dimension = 2, .mass.diagonal = masses, .potentials = &springs, .potential_count = 1};
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "galerkin:degree=3,solver=newton", &integrator),
                   DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  advance(integrator, 0.05, 200);
  const double *end = dvi_integrator_q(integrator);
  /* 200 steps of a few roundings each, on an oscillator that keeps them */
  ck_assert_double_eq_tol(end[1] / unit, end[0], 1e-12);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* KINSOL's own test accepts the result of the iterations at every step, and the trajectory is the
 * same up to roundings, in easy steps, in stiff ones and for a general Lagrangian. */
START_TEST(kinsol_certifies_every_step)
{
  static const struct {
    const char *problem;
    int degree;
    double h;
  } runs[] = {{"kepler", 1, 0.05},     {"kepler", 8, 0.2},           {"fpu", 6, 0.1},
              {"outer-solar", 8, 300}, {"double-pendulum", 5, 0.05}, {"toda", 12, 0.5}};
  enum { STEPS = 40 };
  problem *model = create_problem(runs[_i].problem, NULL);
  dvi_integrator *plain = start_integrator(model,
                                           method_spec("galerkin:degree=%d", runs[_i].degree));
  dvi_integrator *certified = start_integrator(
      model, method_spec("galerkin:degree=%d,solver=certified", runs[_i].degree));
  dvi_counters counters;
  advance(plain, runs[_i].h, STEPS);
  advance(certified, runs[_i].h, STEPS);
  dvi_integrator_counters(certified, &counters);
  ck_assert_int_ge(counters.certified, STEPS); /* one more for each step that is taken again */
  ck_assert_int_le(counters.certified, STEPS + counters.followed);
  ck_assert_int_eq(counters.kinsols, 0);
  ck_assert_double_le(distance(model->nq, dvi_integrator_q(plain), dvi_integrator_q(certified)),
                      1e-11 * magnitude(model->nq, dvi_integrator_q(plain)));
  dvi_integrator_destroy(&plain);
  dvi_integrator_destroy(&certified);
  problem_destroy(&model);
}
END_TEST

SUITE(galerkin)
{
  tcase_add_loop_test(tests, all_bases_of_a_degree_give_one_trajectory, 0, DEGREES * BASES);
  tcase_add_test(tests, the_claimed_order_is_the_lesser_of_twice_the_degree_and_the_quadratures);
  tcase_add_test(tests, nodes_left_out_are_the_fewest_of_full_order);
  tcase_add_loop_test(tests, a_wrong_specification_is_refused_with_its_reason, 0, REFUSED);
  tcase_add_test(tests, the_contraction_chooses_the_solver);
  tcase_add_loop_test(tests, all_solvers_find_the_same_step, 0, 3);
  tcase_add_test(tests, a_small_coordinate_is_solved_to_its_own_roundoff);
  tcase_add_loop_test(tests, kinsol_certifies_every_step, 0, 6);
}
