/* labels: invariant slow */
/* The discrete action promises, beside its order, a symplectic and reversible step, and momenta
 * conserved up to roundoff. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/accepted.h"
#include "support/runs.h"
#include "support/suite.h"

/* How many problems of the catalogue each method takes. 22 of them have a mass or a Lagrangian, and
 * no factors. Of these 17 have a constant mass without a vector potential, as verlet wants, and 8
 * have the callbacks for Taylor coefficients that prolongation wants. */
static const struct {
  const char *name;
  int problems;
} methods[] = {
    {"verlet", 17},
    {"midpoint", 22},
    {"trapezoidal", 22},
    {"galerkin", 22},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 22},
    {"galerkin:degree=4,quadrature=radau-right,basis=legendre", 22},
    {"galerkin:degree=5,quadrature=clenshaw-curtis,nodes=7,basis=chebyshev", 22},
    {"galerkin:degree=8", 22},
    {"composition:order=4,base=verlet", 17},
    {"composition:order=6,base=midpoint", 22},
    {"composition:order=8,base=galerkin,degree=1,quadrature=trapezoid", 22},
    {"prolongation-collocation:derivatives=1", 8},
    {"prolongation-collocation", 8},
    {"prolongation-collocation:derivatives=3", 8},
    {"prolongation-collocation:derivatives=6", 8},
};
enum { METHODS = sizeof methods / sizeof *methods, RADAU = 5 };

/* Case number `which` is one method on one problem. */
static accepted_cases pairs, symmetric_pairs;

/* Forces change areas and momenta. */
static int pair_is_accepted(int which)
{
  return strcmp(problem_name(which / METHODS), "damped-driven") != 0 &&
         method_accepts_problem(problem_name(which / METHODS), NULL, methods[which % METHODS].name);
}

static int symmetric_pair_is_accepted(int which)
{
  return which % METHODS != RADAU && pair_is_accepted(which);
}

START_TEST(no_method_refuses_more_problems_than_it_must)
{
  int accepted[METHODS] = {0};
  for (int i = 0; i < pairs.count; i++) accepted[pairs.which[i] % METHODS]++;
  for (int m = 0; m < METHODS; m++)
    ck_assert_msg(accepted[m] == methods[m].problems, "%s takes %d problems, not %d",
                  methods[m].name, accepted[m], methods[m].problems);
  ck_assert_int_eq(symmetric_pairs.count, pairs.count - methods[RADAU].problems);
}
END_TEST

/* Differences of 10th order resolve defects of about 1e-12. */
START_TEST(every_method_is_symplectic_on_every_problem)
{
  problem *model = create_problem(problem_name(pairs.which[sampled_case(_i)] / METHODS), NULL);
  const char *method = methods[pairs.which[sampled_case(_i)] % METHODS].name;
  dvi_integrator *integrator = create_integrator(model->system, method);
  double defect = 0;
  const dvi_status status = dvi_symplecticity(integrator, 0, model->q, model->p, model->h, &defect);
  ck_assert_msg(status == DVI_OK, "%s, %s: %s", model->name, method, dvi_last_error());
  ck_assert_msg(defect < 1e-10, "%s, %s: defect %g", model->name, method, defect);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Roundings of 200 steps, amplified by the flow. A user may rely on this bound, which is larger
 * than the measured errors (1e-15 to 1e-12). */
START_TEST(symmetric_methods_return_to_the_start)
{
  problem *model = create_problem(problem_name(symmetric_pairs.which[sampled_case(_i)] / METHODS),
                                  NULL);
  const char *method = methods[symmetric_pairs.which[sampled_case(_i)] % METHODS].name;
  dvi_integrator *integrator = create_integrator(model->system, method);
  double defect = 0;
  const dvi_status status = dvi_reversibility(integrator, 0, model->q, model->p, model->h, 100,
                                              &defect);
  ck_assert_msg(status == DVI_OK, "%s, %s: %s", model->name, method, dvi_last_error());
  ck_assert_msg(defect < 1e-11, "%s, %s: defect %g", model->name, method, defect);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Gives the largest possible size of each momentum, the sum of the absolute terms of p.xi. It
 * bounds the effect of one rounding. */
static void momentum_sizes(const problem *solar, double size[6])
{
  double linear = 0, angular = 0;
  for (int i = 0; i < solar->nq; i++) {
    linear += fabs(solar->p[i]);
    angular += fabs(solar->p[i]) * magnitude(solar->nq, solar->q);
  }
  for (int i = 0; i < 3; i++) size[i] = linear, size[3 + i] = angular;
}

/* A sum that N roundings of half an epsilon disturb at random strays by about sqrt(N)/2 epsilons, a
 * trend of one epsilon a step by N: 300 times more. A walk has a fitted slope, too, so the distance
 * is what tells the two apart. Three deviations are allowed. */
static void check_momenta(const char *method, double h)
{
  const int steps = repeats(100000);
  problem *solar = create_problem("outer-solar", NULL);
  dvi_integrator *integrator = start_integrator(solar, method);
  double start[7], now[7], size[6], largest[6] = {0};
  momentum_sizes(solar, size);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  for (int step = 0; step < steps; step += 10) {
    advance(integrator, h, 10);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    for (int i = 0; i < 6; i++) largest[i] = fmax(largest[i], fabs(now[1 + i] - start[1 + i]));
  }
  for (int i = 0; i < 6; i++)
    ck_assert_msg(largest[i] <= 3 * sqrt((double)steps) / 2 * DBL_EPSILON * size[i],
                  "%s: %s strayed by %g of %g", method,
                  dvi_system_invariant_name(solar->system, 1 + i), largest[i], size[i]);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&solar);
}

START_TEST(linear_and_angular_momentum_of_the_planets_stay_at_roundoff)
{
  check_momenta("verlet", 20);
  check_momenta("galerkin", 50);
  check_momenta("galerkin:degree=5,quadrature=lobatto", 100);
  check_momenta("composition:order=6", 100);
}
END_TEST

SUITE(structure)
{
  tcase_set_timeout(tests, 120);
  find_accepted_cases(METHODS * problem_count(), pair_is_accepted, &pairs);
  find_accepted_cases(METHODS * problem_count(), symmetric_pair_is_accepted, &symmetric_pairs);
  tcase_add_test(tests, no_method_refuses_more_problems_than_it_must);
  tcase_add_loop_test(tests, every_method_is_symplectic_on_every_problem, 0,
                      sampled_count(pairs.count));
  tcase_add_loop_test(tests, symmetric_methods_return_to_the_start, 0,
                      sampled_count(symmetric_pairs.count));
  tcase_add_test(tests, linear_and_angular_momentum_of_the_planets_stay_at_roundoff);
}
