/* labels: unit */
/* Potentials that are declared without a Hessian. The callback of the sine-Gordon equation ends the
 * test if one is formed. */
#include <dvi/method.h>
#include <math.h>
#include <string.h>

#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/spectral/sine_gordon.h"

static sine_gordon waves;

static void make_waves(void)
{
  sine_gordon_create(12, 32, 1, 1, &waves);
}

static void destroy_waves(void)
{
  sine_gordon_destroy(&waves);
}

/* Methods that take the waves and need no Hessian of the pull. */
static const char *const taking[] = {"galerkin",
                                     "galerkin:degree=3,solver=fixed-point",
                                     "midpoint",
                                     "trapezoidal",
                                     "hp",
                                     "hamiltonian",
                                     "composition:order=4,base=midpoint",
                                     "verlet",
                                     "imex",
                                     "imex:solver=newton",
                                     "respa",
                                     "mollified",
                                     "trig"};

START_TEST(methods_without_hessians_take_steps)
{
  dvi_integrator *run = create_integrator(waves.system, taking[_i]);
  ck_assert_int_eq(dvi_integrator_start(run, 0, waves.q, waves.p), DVI_OK);
  advance(run, 0.01, 3);
  dvi_integrator_destroy(&run);
}
END_TEST

/* The others say at create what they miss, and begin with their names. */
START_TEST(methods_with_hessians_refuse_by_name)
{
  int refused = 0;
  for (int k = 0; k < dvi_method_count(); k++) {
    dvi_integrator *made = NULL;
    const char *name = dvi_method_name(k);
    const dvi_status status = dvi_integrator_create(waves.system, name, &made);
    if (status != DVI_OK && strstr(dvi_last_error(), "'pull'") != NULL) {
      ck_assert_int_eq(status, DVI_UNSUPPORTED);
      ck_assert_int_eq(strncmp(dvi_last_error(), name, strlen(name)), 0);
      refused++;
    }
    if (status == DVI_OK) {
      ck_assert_int_eq(dvi_integrator_start(made, 0, waves.q, waves.p), DVI_OK);
      advance(made, 0.01, 1);
    }
    dvi_integrator_destroy(&made);
  }
  ck_assert_int_eq(refused, 2); /* sem, shooting */
}
END_TEST

static const char *const solvers[] = {"simplified", "newton", "kinsol", "certified"};

START_TEST(solvers_with_hessians_are_refused)
{
  dvi_integrator *made = NULL;
  const char *method = method_spec("midpoint:solver=%s", solvers[_i]);
  ck_assert_int_eq(dvi_integrator_create(waves.system, method, &made), DVI_UNSUPPORTED);
  check_words(
      method_spec("midpoint: solver=%s needs the Hessian of potential 'pull'", solvers[_i]));
  check_words("auto and fixed-point need none");
}
END_TEST

/* The pull has h omega = 20 here. The state stays, and a smaller step goes on. */
START_TEST(a_step_too_large_names_a_smaller_one)
{
  sine_gordon stiff;
  sine_gordon_create(12, 32, 400, 1, &stiff);
  dvi_integrator *run = create_integrator(stiff.system, "galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_start(run, 0, stiff.q, stiff.p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(run, 1), DVI_NOT_CONVERGED);
  check_words("fixed-point iteration does not converge");
  check_words("potential 'pull' is declared without the Hessian");
  check_words("try a step below 0.5");
  ck_assert_mem_eq(dvi_integrator_q(run), stiff.q, 25 * sizeof(double));
  advance(run, 0.02, 10);
  ck_assert_int_eq(read_counters(run).fixed_points, 10);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&stiff);
}
END_TEST

static int flat_value(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  for (int k = 0; k < count; k++) V[k] = 0;
  return 0;
}

/* The force at the node number *user of the second coordinate is not a number. */
static int spoilt_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const int *spoilt = user;
  (void)t, (void)q;
  for (int k = 0; k < 2 * count; k++) V_q[k] = 1;
  if (count > 1 && *spoilt >= 0) V_q[count + *spoilt] = *spoilt % 2 ? HUGE_VAL : (double)NAN;
  return 0;
}

/* The iteration sees such a force in its change. */
START_TEST(forces_that_are_not_finite_fail_the_step)
{
  enum { NODES = 9 };
  const double start[2] = {1, 2};
  int spoilt;
  const dvi_potential potential = {.name = "spoilt",
                                   .value_batch = flat_value,
                                   .gradient_batch = spoilt_gradient,
                                   .without_hessian = 1,
                                   .user = &spoilt};
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .potentials = &potential, .potential_count = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *run = create_integrator(system, _i ? "galerkin:degree=9" : "galerkin:degree=8");
  ck_assert_int_eq(dvi_integrator_start(run, 0, start, start), DVI_OK);
  for (spoilt = 0; spoilt < NODES - !_i; spoilt++) {
    ck_assert_int_eq(dvi_integrator_step(run, 0.1), DVI_NOT_FINITE);
    ck_assert_mem_eq(dvi_integrator_q(run), start, sizeof start);
    ck_assert_mem_eq(dvi_integrator_p(run), start, sizeof start);
  }
  spoilt = -1;
  advance(run, 0.1, 1);
  dvi_integrator_destroy(&run);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(the_ladder_is_explained)
{
  char text[2000];
  dvi_integrator *run = create_integrator(waves.system, "galerkin:degree=4");
  ck_assert_uint_lt(dvi_integrator_explain(run, text, sizeof text), sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "no Jacobian"));
  ck_assert_ptr_nonnull(strstr(text, "quadratic potentials with a diagonal Hessian are implicit"));
  ck_assert_ptr_nonnull(strstr(text, "fixed point alone, for potential 'pull' is declared"));
  dvi_integrator_destroy(&run);
}
END_TEST

/* A pattern of 4001^2 entries alone would take 64 MB. */
START_TEST(many_modes_take_memory_in_proportion)
{
  sine_gordon many;
  const long before = heap_bytes();
  sine_gordon_create(2000, 4096, 1, 1, &many);
  dvi_integrator *run = create_integrator(many.system, "galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_start(run, 0, many.q, many.p), DVI_OK);
  advance(run, 0.05, 2);
  ck_assert_int_eq(read_counters(run).fixed_points, 2);
  ck_assert_int_lt(heap_bytes() - before, 8000000);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&many);
}
END_TEST

START_TEST(the_check_leaves_the_hessian_out)
{
  dvi_derivative_check check;
  ck_assert_int_eq(dvi_system_check(waves.system, 0, waves.q, waves.p, 1e-6, &check), DVI_OK);
}
END_TEST

SUITE(without_hessian)
{
  tcase_add_checked_fixture(tests, make_waves, destroy_waves);
  tcase_add_loop_test(tests, methods_without_hessians_take_steps, 0,
                      sizeof taking / sizeof *taking);
  tcase_add_test(tests, methods_with_hessians_refuse_by_name);
  tcase_add_loop_test(tests, solvers_with_hessians_are_refused, 0,
                      sizeof solvers / sizeof *solvers);
  tcase_add_test(tests, a_step_too_large_names_a_smaller_one);
  tcase_add_loop_test(tests, forces_that_are_not_finite_fail_the_step, 0, 2);
  tcase_add_test(tests, the_ladder_is_explained);
  tcase_add_test(tests, many_modes_take_memory_in_proportion);
  tcase_add_test(tests, the_check_leaves_the_hessian_out);
}
