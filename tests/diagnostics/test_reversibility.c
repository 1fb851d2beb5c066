/* labels: unit invariant */
#include <check.h>
#include <math.h>

#include <dvi/diagnostics.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

START_TEST(verlet_returns_to_its_start)
{
  problem *p = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = -1;
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, p->p, p->h, 100, &defect), DVI_OK);
  ck_assert_double_ge(defect, 0);
  ck_assert_double_le(defect, 1e-13); /* roundoff of 200 steps on a regular orbit */
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

START_TEST(the_start_may_be_the_integrators_own_state)
{
  problem *p = create_problem("kepler", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = -1;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, p->q, p->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, p->h), DVI_OK);
  ck_assert_int_eq(dvi_reversibility(integrator, p->h, dvi_integrator_q(integrator),
                                     dvi_integrator_p(integrator), p->h, 10, &defect),
                   DVI_OK);
  ck_assert_double_le(defect, 1e-13);
  /* left at the end of the way back */
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), p->h, 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

/* A force that is stronger on the way back, because time runs on between the first and the last
 * call of a gradient. */
static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * q[0] * q[0];
  return 0;
}

static int growing_force(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  int *calls = (int *)user;
  V_q[0] = q[0] * (1 + 1e-3 * ++*calls);
  return 0;
}

START_TEST(a_force_that_changes_between_the_ways_is_found)
{
  int calls = 0;
  const dvi_potential potential = {.value = value, .gradient = growing_force, .user = &calls};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &potential, .potential_count = 1};
  const double q = 1, p = 0;
  dvi_system *system = NULL;
  double defect = 0;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "verlet");
  ck_assert_int_eq(dvi_reversibility(integrator, 0, &q, &p, 0.1, 20, &defect), DVI_OK);
  ck_assert_double_gt(defect, 1e-3); /* the force grew by about 20 per mille over a time of 2 */
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(bad_arguments_are_refused_and_nothing_is_written)
{
  problem *p = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = 7;
  ck_assert_int_eq(dvi_reversibility(NULL, 0, p->q, p->p, p->h, 1, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, NULL, p->p, p->h, 1, &defect),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, NULL, p->h, 1, &defect),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, p->p, p->h, 1, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, p->p, p->h, 0, &defect), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, p->p, 0, 1, &defect), DVI_BAD_ARGUMENT);
  dvi__fail_allocations_after(0);
  ck_assert_int_eq(dvi_reversibility(integrator, 0, p->q, p->p, p->h, 1, &defect), DVI_NO_MEMORY);
  dvi__fail_allocations_after(-1);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

SUITE(reversibility)
{
  tcase_set_timeout(tests, 60);
  tcase_add_test(tests, verlet_returns_to_its_start);
  tcase_add_test(tests, the_start_may_be_the_integrators_own_state);
  tcase_add_test(tests, a_force_that_changes_between_the_ways_is_found);
  tcase_add_test(tests, bad_arguments_are_refused_and_nothing_is_written);
}
