/* labels: unit */
#include <math.h>

#include "support/systems/bond.h"
#include "support/systems/oscillators.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

START_TEST(with_one_substep_it_is_verlet)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *split = start_integrator(chain, "respa:substeps=1"),
                 *whole = start_integrator(chain, "verlet");
  advance(split, 0.005, 200);
  advance(whole, 0.005, 200);
  /* roundings of 200 steps */
  ck_assert_double_le(distance(6, dvi_integrator_q(split), dvi_integrator_q(whole)), 1e-14);
  ck_assert_double_le(distance(6, dvi_integrator_p(split), dvi_integrator_p(whole)), 1e-13);
  dvi_integrator_destroy(&split);
  dvi_integrator_destroy(&whole);
  problem_destroy(&chain);
}
END_TEST

START_TEST(a_step_has_one_slow_gradient_and_one_of_the_fast_potentials_for_each_substep)
{
  const char *const method[] = {"respa:substeps=7", "respa:substeps=exact"};
  const long fast[] = {7, 1};
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *integrator = start_integrator(chain, method[_i]);
  dvi_counters first, after;
  advance(integrator, 0.01, 1);
  dvi_integrator_counters(integrator, &first);
  advance(integrator, 0.01, 50);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - first.gradients, 50 * (1 + fast[_i]));
  ck_assert_int_eq(after.factorizations + after.residuals, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
}
END_TEST

/* ---- exact motion ---- */

/* A saddle, a free direction, and springs between sites, under a constant force. The mass couples
 * all of them. */
static int hills(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 50 * (q[0] - q[1]) * (q[0] - q[1]) - 2 * q[2] * q[2] + 400 * q[3] * q[3] + 30 * q[5] * q[5] -
       3 * q[1] + q[4];
  return 0;
}

static int hills_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 100 * (q[0] - q[1]);
  V_q[1] = -V_q[0] - 3;
  V_q[2] = -4 * q[2];
  V_q[3] = 800 * q[3];
  V_q[4] = 1;
  V_q[5] = 60 * q[5];
  return 0;
}

START_TEST(exact_motion_is_exact_whatever_the_step)
{
  const dvi_potential potential = {
      .name = "hills", .value = hills, .gradient = hills_gradient, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(
      &(dvi_system_terms){.dimension = SITES,
                          .mass = {.values = tridiagonal_mass, .pattern = tridiagonal},
                          .potentials = &potential,
                          .potential_count = 1});
  dvi_integrator *exact = create_integrator(system, "respa:substeps=exact"),
                 *judge = create_integrator(system, "galerkin:degree=8");
  ck_assert_int_eq(dvi_integrator_start(exact, 0, generic_q, generic_v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(judge, 0, generic_q, generic_v), DVI_OK);
  advance(exact, 1.5, 1);
  advance(judge, 1.5 / 32, 32);
  /* K is differenced, to ten digits of its largest entry */
  ck_assert_double_le(distance(SITES, dvi_integrator_q(exact), dvi_integrator_q(judge)), 1e-9);
  ck_assert_double_le(distance(SITES, dvi_integrator_p(exact), dvi_integrator_p(judge)), 1e-7);
  dvi_integrator_destroy(&exact);
  dvi_integrator_destroy(&judge);
  dvi_system_destroy(&system);
}
END_TEST

static void check_refusal(const dvi_system *system, dvi_status status, const char *because)
{
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(system, "respa:substeps=exact", &integrator), status);
  ck_assert_ptr_null(integrator);
  check_words(because);
}

START_TEST(what_has_no_modes_is_refused)
{
  bond pair;
  const double mass[SITES] = {1, 1, 1, -1, 1, 1};
  const dvi_potential potential = {
      .name = "hills", .value = hills, .gradient = hills_gradient, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.diagonal = mass, .potentials = &potential, .potential_count = 1});
  check_refusal(system, DVI_SINGULAR, "is not positive definite");
  dvi_system_destroy(&system);
  make_bond(2500, 1, &pair);
  check_refusal(pair.system, DVI_UNSUPPORTED,
                "respa: a fast potential is not declared `quadratic`, and only such ones have "
                "modes; substeps=k takes any");
  destroy_bond(&pair);
  system = make_system(&(dvi_system_terms){
      .dimension = 2001, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  check_refusal(
      system, DVI_BAD_SIZE,
      "respa: polynomials: K has 2001 entries in a row on average, where 100 are possible");
  check_words("normal modes: 2001 coordinates are coupled; 2000 at most are possible");
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(substeps_are_a_number_or_exact)
{
  const char *const wrong[] = {"respa:substeps=0", "respa:substeps=many",
                               "respa:substeps=", "respa:substeps=-1"};
  problem *model = create_problem("oscillators", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "respa");
  ck_assert_str_eq(dvi_integrator_method(integrator), "respa:substeps=10");
  dvi_integrator_destroy(&integrator);
  integrator = create_integrator(model->system, "respa:substeps=exact");
  ck_assert_str_eq(dvi_integrator_method(integrator), "respa:substeps=exact");
  dvi_integrator_destroy(&integrator);
  for (int k = 0; k < 4; k++)
    ck_assert_int_eq(dvi_integrator_create(model->system, wrong[k], &integrator), DVI_BAD_OPTION);
  check_words("respa: substeps=-1; possible are exact and 1 to 1000000");
  problem_destroy(&model);
}
END_TEST

/* ---- resonance ---- */

/* Finds the place in (k - 0.004, k + 0.004) at which a step grows most. */
static double peak_near(const char *method, int k, double *growth)
{
  double peak = 0;
  *growth = 0;
  for (int i = -80; i <= 80; i++) {
    const double x = k + 5e-5 * i, found = oscillators_growth(method, 0.1, x);
    if (found > *growth) *growth = found, peak = x;
  }
  return peak;
}

/* The peaks of 100 substeps, whose own frequency is a little above omega. With exact motion they
 * stand higher up. In 10000 steps the amplitudes grow by 8e6, 2900, 200 and 54. */
START_TEST(kicks_in_phase_with_the_fast_motion_resonate)
{
  const double peak[] = {.99945, 1.99942, 2.99872, 3.99724}, least[] = {1e6, 1000, 100, 30};
  const int k = _i + 1;
  double growth;
  ck_assert_double_eq_tol(peak_near("respa:substeps=100", k, &growth), peak[_i], 1e-4);
  ck_assert_double_gt(pow(growth, 10000), least[_i]);
  ck_assert_double_gt(peak_near("respa:substeps=exact", k, &growth), peak[_i]);
  ck_assert_double_gt(pow(growth, 10000), least[_i]);
}
END_TEST

START_TEST(energy_grows_at_a_peak_and_not_beside_it)
{
  ck_assert_double_gt(oscillators_energy_error("respa:substeps=100", 0.1, 3.99724, 10000), 100);
  ck_assert_double_lt(oscillators_energy_error("respa:substeps=100", 0.1, 3.95, 10000), 1e-2);
}
END_TEST

SUITE(respa)
{
  tcase_add_test(tests, with_one_substep_it_is_verlet);
  tcase_add_loop_test(
      tests, a_step_has_one_slow_gradient_and_one_of_the_fast_potentials_for_each_substep, 0, 2);
  tcase_add_test(tests, exact_motion_is_exact_whatever_the_step);
  tcase_add_test(tests, what_has_no_modes_is_refused);
  tcase_add_test(tests, substeps_are_a_number_or_exact);
  tcase_add_loop_test(tests, kicks_in_phase_with_the_fast_motion_resonate, 0, 4);
  tcase_add_test(tests, energy_grows_at_a_peak_and_not_beside_it);
}
