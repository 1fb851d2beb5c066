/* labels: unit */
/* Steps in transformed time of systems with a constant diagonal mass find the solution of Newton's
 * method without a Jacobian, as long as they contract. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"

static const struct {
  const char *problem, *setting, *monitor, *method;
  int nodes;
  double h, most; /* most iterations a step */
} ways[] = {
    {"kepler", "e=0.9", "distance", "galerkin:degree=8", 8, 0.3, 5.2},
    {"kepler", "e=0.9", "distance", "galerkin:degree=8", 8, 0.7, 7.6},
    {"kepler", "e=0.9", "distance", "galerkin:degree=8", 8, 1.2, 10.6},
    {"kepler", "e=0.9", "distance:power=2", "midpoint", 1, 0.05, 7},
    {"kepler", "e=0.9", "distance", "galerkin:degree=5,basis=legendre", 5, 0.2, 6},
    {"kepler", "e=0.5", "distance", "galerkin:degree=9,basis=gauss", 9, 0.5, 8},
    {"kepler", "e=0.5", "arclength", "galerkin:degree=2", 2, 0.1, 8},
    {"kepler", "e=0.5", "distance", "galerkin:degree=3,quadrature=lobatto,nodes=3", 3, 0.2, 8},
    {"kepler", "e=0.5", "distance", "galerkin:degree=4,quadrature=radau-left,nodes=4", 4, 0.2, 8},
    {"pythagorean", NULL, "distance:bodies=3", "galerkin:degree=8", 8, 0.1, 6},
    {"henon-heiles", NULL, "arclength", "galerkin:degree=3", 3, 0.05, 6},
    {"figure-eight", NULL, "acceleration:power=0.1", "galerkin:degree=4", 4, 0.05, 6},
};
enum { WAYS = sizeof ways / sizeof *ways, MOST = 16 };

static problem *scene(int i)
{
  return create_problem(ways[i].problem, ways[i].setting);
}

static dvi_integrator *way(const problem *model, int i)
{
  return start_paced_integrator(model, create_transformed, ways[i].monitor, ways[i].method);
}

/* Every evaluation is one of the iteration's, but those of guesses that are replaced in long steps.
 * The first steps start from worse guesses. */
START_TEST(steps_that_contract_need_no_jacobian)
{
  enum { STEPS = 100 };
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  dvi_counters before, after;
  advance(integrator, ways[_i].h, 2);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, ways[_i].h, STEPS);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.fixed_points - before.fixed_points, STEPS);
  ck_assert_int_eq(after.jacobians, 0);
  const long iterations = after.residuals - before.residuals;
  ck_assert_msg((double)iterations <= ways[_i].most * STEPS, "%ld", iterations);
  if (strncmp(ways[_i].monitor, "distance", 8) == 0) { /* other monitors evaluate the system, too */
    ck_assert_int_eq(after.hessians, before.hessians);
    const long evaluations = after.gradients - before.gradients,
               replaced = evaluations - iterations * ways[_i].nodes;
    ck_assert_int_eq(after.values - before.values, evaluations);
    ck_assert_int_ge(replaced, 0);
    ck_assert_int_le(replaced, ways[_i].h > 1 ? evaluations / 50 : 0);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static void check_near(int n, const double *one, const double *other, const double *start,
                       double roundings)
{
  double size = 0;
  for (int i = 0; i < n; i++) size = fmax(size, fmax(fabs(start[i]), fabs(other[i])));
  for (int i = 0; i < n; i++)
    ck_assert_msg(fabs(one[i] - other[i]) <= roundings * DBL_EPSILON * size, "%g of %g",
                  one[i] - other[i], size);
}

/* Two steps from many states on the way, the second one from the continued first. */
START_TEST(their_solution_is_that_of_newtons_method)
{
  problem *model = scene(_i);
  char method[100];
  (void)snprintf(method, sizeof method, "%s%csolver=newton", ways[_i].method,
                 strchr(ways[_i].method, ':') != NULL ? ',' : ':');
  dvi_integrator *along = way(model, _i), *own = way(model, _i),
                 *newton = start_paced_integrator(model, create_transformed, ways[_i].monitor,
                                                  method);
  for (int k = 0; k < 20; k++) {
    const double *q = dvi_integrator_q(along), *p = dvi_integrator_p(along),
                 t = dvi_integrator_time(along);
    ck_assert_int_eq(dvi_integrator_start(own, t, q, p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(newton, t, q, p), DVI_OK);
    for (int step = 0; step < 2; step++) {
      advance(own, ways[_i].h, 1);
      advance(newton, ways[_i].h, 1);
      check_near(model->nq, dvi_integrator_q(own), dvi_integrator_q(newton), q, 64 << step);
      check_near(model->nq, dvi_integrator_p(own), dvi_integrator_p(newton), p, 64 << step);
      ck_assert_double_eq_tol(dvi_integrator_time(own), dvi_integrator_time(newton),
                              64 * DBL_EPSILON * (1 + t));
    }
    advance(along, ways[_i].h, 3);
  }
  dvi_integrator_destroy(&along);
  dvi_integrator_destroy(&own);
  dvi_integrator_destroy(&newton);
  problem_destroy(&model);
}
END_TEST

/* A step that leaps from the apocentre to the pericentre does not contract, and is solved all the
 * same. */
START_TEST(long_steps_go_to_newtons_method)
{
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=8");
  dvi_counters counters;
  advance(integrator, 2, 6);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_gt(counters.newtons, 0);
  ck_assert_int_eq(counters.newtons + counters.simplified + counters.fixed_points, 6);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

/* After a close encounter the forces of the last step, continued, lead nowhere. */
START_TEST(a_guess_that_leads_astray_is_replaced)
{
  enum { STEPS = 50 };
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=8");
  dvi_counters counters;
  advance(integrator, 1.4, STEPS);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_ge(counters.fixed_points, STEPS * 4 / 5);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

/* KINSOL has nothing to mend, and the solution of the iteration stays, its time as well. */
START_TEST(certified_steps_pass)
{
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=8,solver=certified"),
                 *plain = start_paced_integrator(kepler, create_transformed, "distance",
                                                 "galerkin:degree=8");
  dvi_counters counters;
  advance(integrator, 0.3, 50);
  advance(plain, 0.3, 50);
  ck_assert_double_eq(dvi_integrator_time(integrator), dvi_integrator_time(plain));
  ck_assert_mem_eq(dvi_integrator_q(integrator), dvi_integrator_q(plain), 2 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(integrator), dvi_integrator_p(plain), 2 * sizeof(double));
  dvi_integrator_destroy(&plain);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.fixed_points, 50);
  ck_assert_int_eq(counters.certified, 50);
  ck_assert_int_eq(counters.jacobians, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(steps_have_the_same_bits_at_every_level)
{
  problem *model = scene(_i);
  double q[MOST];
  ck_assert_int_le(model->nq, MOST);
  for (int level = 0; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    dvi_integrator *integrator = way(model, _i);
    advance(integrator, ways[_i].h, 30);
    if (level > 0)
      ck_assert_mem_eq(q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
    memcpy(q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
  dvi__lanes_choose(-1);
}
END_TEST

/* ---- many coordinates ---- */

/* The Hessians of a chain in steps by arclength, which takes one with each value or gradient of g,
 * and n times as many with a Hessian of g. */
static void check_hessians(const char *method, int nodes, dvi_counters *counters)
{
  enum { STEPS = 5 };
  problem *chain = create_problem("chain", "n=60");
  dvi_integrator *integrator = start_paced_integrator(chain, create_transformed, "arclength",
                                                      method),
                 *newton = start_paced_integrator(
                     chain, create_transformed, "arclength",
                     method_spec("%.17s,nodes=%d,solver=newton", method, nodes));
  advance(integrator, 0.02, STEPS);
  advance(newton, 0.02, STEPS);
  dvi_integrator_counters(integrator, counters);
  ck_assert_int_le(counters->hessians, nodes * counters->residuals + 2 * STEPS);
  check_near(chain->nq, dvi_integrator_q(integrator), dvi_integrator_q(newton), chain->q, 256);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&newton);
  problem_destroy(&chain);
}

START_TEST(the_mass_at_a_point_takes_no_hessian)
{
  dvi_counters counters;
  check_hessians("galerkin:degree=2,nodes=3,solver=fixed-point", 3, &counters);
  ck_assert_int_gt(counters.factorizations, 0);
}
END_TEST

/* The systems of simplified Newton's method are those of the chain, and two unknowns more. */
START_TEST(systems_of_a_sparse_lagrangian_take_no_hessian)
{
  dvi_counters counters;
  check_hessians("galerkin:degree=2,solver=simplified", 2, &counters);
  ck_assert_int_gt(counters.jacobians, 0);
}
END_TEST

/* They precondition the Jacobian's products where there are 200 unknowns or more. */
START_TEST(newtons_method_takes_products)
{
  static const char monitor[] = "acceleration:power=0.1", method[] = "galerkin:degree=2";
  problem *chain = create_problem("chain", "n=100");
  dvi_integrator *own = start_paced_integrator(chain, create_transformed, monitor, method),
                 *newton = start_paced_integrator(chain, create_transformed, monitor,
                                                  method_spec("%s,solver=newton", method));
  dvi_counters counters;
  advance(own, 0.05, 3);
  advance(newton, 0.05, 3);
  dvi_integrator_counters(newton, &counters);
  ck_assert_int_gt(counters.products, 0);
  ck_assert_int_le(counters.products, 12 * counters.newtons);
  check_near(chain->nq, dvi_integrator_q(own), dvi_integrator_q(newton), chain->q, 256);
  dvi_integrator_destroy(&own);
  dvi_integrator_destroy(&newton);
  problem_destroy(&chain);
}
END_TEST

SUITE(transform_solver)
{
  tcase_add_loop_test(tests, steps_that_contract_need_no_jacobian, 0, WAYS);
  tcase_add_loop_test(tests, their_solution_is_that_of_newtons_method, 0, WAYS);
  tcase_add_test(tests, long_steps_go_to_newtons_method);
  tcase_add_test(tests, a_guess_that_leads_astray_is_replaced);
  tcase_add_test(tests, certified_steps_pass);
  tcase_add_loop_test(tests, steps_have_the_same_bits_at_every_level, 0, WAYS);
  tcase_add_test(tests, the_mass_at_a_point_takes_no_hessian);
  tcase_add_test(tests, systems_of_a_sparse_lagrangian_take_no_hessian);
  tcase_add_test(tests, newtons_method_takes_products);
}
