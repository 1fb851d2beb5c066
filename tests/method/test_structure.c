/* labels: invariant */
/* What the discrete action promises beside its order: a symplectic and reversible step, and momenta conserved to roundoff. */
#include <check.h>
#include <float.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

static const char *const methods[] = {
    "verlet",
    "midpoint",
    "trapezoidal",
    "galerkin",
    "galerkin:degree=3,quadrature=lobatto,nodes=3",
    "galerkin:degree=4,quadrature=radau-right,basis=legendre",
    "galerkin:degree=5,quadrature=clenshaw-curtis,nodes=7,basis=chebyshev",
    "galerkin:degree=8",
    "composition:order=4,base=verlet",
    "composition:order=6,base=midpoint",
    "composition:order=8,base=galerkin,degree=1,quadrature=trapezoid",
    "prolongation-collocation:derivatives=1",
    "prolongation-collocation",
    "prolongation-collocation:derivatives=3",
    "prolongation-collocation:derivatives=6",
};
enum { METHODS = sizeof methods / sizeof *methods, RADAU = 5 };

/* verlet, and compositions of it, need a constant mass; those pairs are refused, which other tests check. */
static dvi_integrator *if_possible(const problem *of, const char *method)
{
  dvi_integrator *integrator = NULL;
  const dvi_status status = dvi_integrator_create(of->system, method, &integrator);
  ck_assert_msg(status == DVI_OK || status == DVI_UNSUPPORTED, "%s", dvi_last_error());
  return integrator;
}

/* Differences of 10th order resolve defects of about 1e-12. */
START_TEST(every_method_is_symplectic_on_every_problem)
{
  problem *of = made_problem(problem_name(_i / METHODS), NULL);
  const char *method = methods[_i % METHODS];
  dvi_integrator *integrator = if_possible(of, method);
  double defect = 0;
  if (integrator != NULL) {
    const dvi_status status = dvi_symplecticity(integrator, 0, of->q, of->p, of->h, &defect);
    ck_assert_msg(status == DVI_OK, "%s, %s: %s", of->name, method, dvi_last_error());
  }
  ck_assert_msg(defect < 1e-10, "%s, %s: defect %g", of->name, method, defect);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}
END_TEST

/* Roundings of 200 steps, amplified by the flow: the bound is what a user may rely on, not what is measured (1e-15 to 1e-12). */
START_TEST(symmetric_methods_return_to_the_start)
{
  problem *of = made_problem(problem_name(_i / METHODS), NULL);
  const char *method = methods[_i % METHODS];
  dvi_integrator *integrator = _i % METHODS == RADAU ? NULL : if_possible(of, method);
  double defect = 0;
  if (integrator != NULL) {
    const dvi_status status = dvi_reversibility(integrator, 0, of->q, of->p, of->h, 100, &defect);
    ck_assert_msg(status == DVI_OK, "%s, %s: %s", of->name, method, dvi_last_error());
  }
  ck_assert_msg(defect < 1e-11, "%s, %s: defect %g", of->name, method, defect);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}
END_TEST

/* Largest possible size of each momentum: the sum of the absolute terms of p.xi, which bounds what one rounding can do to it. */
static void momentum_sizes(const problem *solar, double size[6])
{
  double linear = 0, angular = 0;
  for (int i = 0; i < solar->nq; i++) {
    linear += fabs(solar->p[i]);
    angular += fabs(solar->p[i]) * magnitude(solar->nq, solar->q);
  }
  for (int i = 0; i < 3; i++) size[i] = linear, size[3 + i] = angular;
}

/* A sum that N roundings of half an epsilon disturb at random strays by about sqrt(N)/2 epsilons, a trend of one epsilon a step by N: 300
 * times more. A walk has a fitted slope, too, so the distance is what tells the two apart. Three deviations are allowed. */
static void check_momenta(const char *method, double h)
{
  const int steps = repeats(100000);
  problem *solar = made_problem("outer-solar", NULL);
  dvi_integrator *integrator = started(solar, method);
  double start[7], now[7], size[6], largest[6] = {0};
  momentum_sizes(solar, size);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  for (int step = 0; step < steps; step += 10) {
    advance(integrator, h, 10);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    for (int i = 0; i < 6; i++) largest[i] = fmax(largest[i], fabs(now[1 + i] - start[1 + i]));
  }
  for (int i = 0; i < 6; i++)
    ck_assert_msg(largest[i] <= 3 * sqrt((double)steps) / 2 * DBL_EPSILON * size[i], "%s: %s strayed by %g of %g", method,
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
  tcase_add_loop_test(tests, every_method_is_symplectic_on_every_problem, 0, METHODS * problem_count());
  tcase_add_loop_test(tests, symmetric_methods_return_to_the_start, 0, METHODS * problem_count());
  tcase_add_test(tests, linear_and_angular_momentum_of_the_planets_stay_at_roundoff);
}
