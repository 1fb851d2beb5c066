/* labels: unit invariant */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dvi/diagnostics.h>
#include <problem.h>

#include "core/memory.h"

static problem *find(const char *name)
{
  char message[256];
  problem *found = NULL;
  ck_assert_msg(problem_create(name, 0, NULL, &found, message, sizeof message) == DVI_OK, "%s", message);
  return found;
}

static dvi_integrator *make(const dvi_system *system, const char *method)
{
  dvi_integrator *integrator = NULL;
  ck_assert_msg(dvi_integrator_create(system, method, &integrator) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

static double defect_of(const char *name, const char *method, double step_factor)
{
  problem *p = find(name);
  dvi_integrator *integrator = make(p->system, method);
  double defect = -1;
  const dvi_status status = dvi_symplecticity(integrator, 0, p->q, p->p, step_factor * p->h, &defect);
  ck_assert_msg(status == DVI_OK, "%s %s: %s", name, method, dvi_last_error());
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
  return defect;
}

/* outer-solar holds masses of 1 and of 1e-8, pythagorean and figure-eight start with zeros among coordinates and momenta, and the
 * chains have momenta that are nearly all zero. The last two have no constant mass, which verlet needs. */
static const char *const problems[] = {"oscillator", "pendulum",     "kepler",      "henon-heiles",   "outer-solar",
                                       "fpu",        "figure-eight", "pythagorean", "stiff-pendulum", "double-pendulum"};
enum { PROBLEMS = sizeof problems / sizeof *problems, WITH_MASS = PROBLEMS - 2 };

START_TEST(verlet_is_symplectic_to_the_floor_of_the_differences)
{
  const double defect = defect_of(problems[_i], "verlet", 1);
  printf("%-16s verlet   %.1e\n", problems[_i], defect);
  ck_assert_double_ge(defect, 0);
  ck_assert_double_le(defect, 1e-11); /* the floor of 1e-12 and a margin for the size of M */
}
END_TEST

START_TEST(galerkin_is_symplectic_to_the_floor_of_the_differences)
{
  const double defect = defect_of(problems[_i], "galerkin", 1);
  printf("%-16s galerkin %.1e\n", problems[_i], defect);
  ck_assert_double_ge(defect, 0);
  ck_assert_double_le(defect, 1e-10); /* the solver's roundoff is added */
}
END_TEST

START_TEST(a_step_backward_is_symplectic_too)
{
  ck_assert_double_le(defect_of("pendulum", "verlet", -1), 1e-11);
}
END_TEST

/* A force c (y, -x) with curl, declared as a gradient: no potential has it, and verlet with it is not symplectic. */
static const double curl = 0.1;

static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  *V = 0;
  return 0;
}

static int turning_force(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = -curl * q[1];
  V_q[1] = curl * q[0];
  return 0;
}

static dvi_system *turning_system(void)
{
  dvi_system *system = NULL;
  const dvi_potential potential = {.value = value, .gradient = turning_force};
  const dvi_system_terms terms = {.dimension = 2, .mass = {.scalar = 1}, .potentials = &potential, .potential_count = 1};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

START_TEST(a_force_with_curl_is_found_in_its_size)
{
  /* The kicks add h c dq1^dq2 at both ends; at h = 1 the end is q1 = q + p - F q / 2 with the turning F = c ((0,-1),(1,0)), so
   * that dq1^dq2 there = (1 + c^2/4) dq1^dq2 + dp1^dp2 + the mixed terms dq1^dp2 - dq2^dp1 + c/2 (dq1^dp1 + dq2^dp2). Their
   * largest factor is that of dq1^dq2 at both ends. With h = m = 1 and |q1| = |q2| the scaled coordinates are the given ones. */
  const double q[] = {1, -1}, p[] = {0.3, 0.2};
  dvi_system *system = turning_system();
  dvi_integrator *integrator = make(system, "verlet");
  double defect = 0;
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, q, p, 1, &defect), DVI_OK);
  ck_assert_double_eq_tol(defect, curl * (2 + curl * curl / 4), 1e-12); /* roundoff of a linear map's differences */
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(the_integrator_goes_on_as_if_nothing_had_happened)
{
  problem *p = find("kepler");
  dvi_integrator *probed = make(p->system, "galerkin:degree=3"), *alone = make(p->system, "galerkin:degree=3");
  dvi_counters before, after;
  double defect;
  ck_assert_int_eq(dvi_integrator_start(probed, 0, p->q, p->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(alone, 0, p->q, p->p), DVI_OK);
  for (int i = 0; i < 20; i++) {
    dvi_integrator_counters(probed, &before);
    if (i % 5 == 3) /* from its own state */
      ck_assert_int_eq(
          dvi_symplecticity(probed, dvi_integrator_time(probed), dvi_integrator_q(probed), dvi_integrator_p(probed), p->h, &defect),
          DVI_OK);
    dvi_integrator_counters(probed, &after);
    ck_assert_mem_eq(&before, &after, sizeof before);
    ck_assert_int_eq(dvi_integrator_step(probed, p->h), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(alone, p->h), DVI_OK);
    ck_assert(dvi_integrator_time(probed) == dvi_integrator_time(alone));
    ck_assert_mem_eq(dvi_integrator_q(probed), dvi_integrator_q(alone), (size_t)p->n * sizeof(double));
    ck_assert_mem_eq(dvi_integrator_p(probed), dvi_integrator_p(alone), (size_t)p->n * sizeof(double));
  }
  dvi_integrator_destroy(&probed);
  dvi_integrator_destroy(&alone);
  problem_destroy(&p);
}
END_TEST

START_TEST(a_start_in_a_singularity_is_reported_and_nothing_is_written)
{
  const double origin[] = {0, 0};
  problem *p = find("kepler");
  dvi_integrator *integrator = make(p->system, "verlet");
  double defect = 7;
  ck_assert_int_ne(dvi_symplecticity(integrator, 0, origin, p->p, p->h, &defect), DVI_OK);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

START_TEST(missing_arguments_and_a_step_of_0_are_refused)
{
  problem *p = find("pendulum");
  dvi_integrator *integrator = make(p->system, "verlet");
  double defect = 7;
  ck_assert_int_eq(dvi_symplecticity(NULL, 0, p->q, p->p, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, NULL, p->p, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, NULL, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, p->h, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, 0, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, (double)NAN, &defect), DVI_BAD_ARGUMENT);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

START_TEST(every_failing_allocation_is_reported)
{
  problem *p = find("pendulum");
  dvi_integrator *integrator = make(p->system, "verlet");
  double defect = 7;
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_symplecticity(integrator, 0, p->q, p->p, p->h, &defect);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "%s", dvi_last_error());
    ck_assert((status == DVI_OK) == (defect != 7));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *suite = suite_create("diagnostics/symplecticity");
  TCase *tests = tcase_create("symplecticity");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, verlet_is_symplectic_to_the_floor_of_the_differences, 0, WITH_MASS);
  tcase_add_loop_test(tests, galerkin_is_symplectic_to_the_floor_of_the_differences, 0, PROBLEMS);
  tcase_add_test(tests, a_step_backward_is_symplectic_too);
  tcase_add_test(tests, a_force_with_curl_is_found_in_its_size);
  tcase_add_test(tests, the_integrator_goes_on_as_if_nothing_had_happened);
  tcase_add_test(tests, a_start_in_a_singularity_is_reported_and_nothing_is_written);
  tcase_add_test(tests, missing_arguments_and_a_step_of_0_are_refused);
  tcase_add_test(tests, every_failing_allocation_is_reported);
  suite_add_tcase(suite, tests);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
