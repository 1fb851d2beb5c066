/* labels: unit */
#include <math.h>

#include "support/systems/bond.h"
#include "support/systems/oscillators.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

static dvi_counters read_counters(const dvi_integrator *integrator)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  return counters;
}

/* Both take the same step, up to roundings of forces that are 25 times as large as the momenta. */
START_TEST(one_linear_system_a_step_does_what_newtons_method_does)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *linear = start_integrator(chain, "imex"),
                 *newton = start_integrator(chain, "imex:solver=newton");
  advance(linear, 0.1, 100);
  advance(newton, 0.1, 100);
  ck_assert_double_le(distance(6, dvi_integrator_q(linear), dvi_integrator_q(newton)), 1e-13);
  ck_assert_double_le(distance(6, dvi_integrator_p(linear), dvi_integrator_p(newton)), 1e-12);
  dvi_integrator_destroy(&linear);
  dvi_integrator_destroy(&newton);
  problem_destroy(&chain);
}
END_TEST

START_TEST(a_quadratic_fast_potential_takes_one_factorisation_a_run_and_one_gradient_a_step)
{
  problem *chain = create_problem("fpu", "ell=100");
  dvi_integrator *integrator = start_integrator(chain, "imex");
  advance(integrator, 0.1, 500);
  const dvi_counters c = read_counters(integrator);
  ck_assert_int_eq(c.factorizations, 1);
  ck_assert_int_eq(c.symbolic, 1);
  ck_assert_int_eq(c.solves, 500);
  ck_assert_int_eq(c.gradients, 1 + 1 + 500); /* the start asks for forces, too */
  ck_assert_int_eq(c.hessians, 1);
  ck_assert_int_eq(c.jacobians + c.residuals + c.newtons, 0);
  advance(integrator, 0.05, 1);
  ck_assert_int_eq(read_counters(integrator).factorizations, 2);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
}
END_TEST

/* Suzuki's 5 substeps have 2 lengths, Kahan and Li's 9 and 17 have 5 and 9. */
START_TEST(a_composition_takes_one_analysis_and_factor_for_each_length_of_its_substeps)
{
  static const struct {
    const char *method;
    long lengths, substeps;
  } of[] = {{"composition:order=4,base=imex", 2, 5},
            {"composition:order=6,base=imex", 5, 9},
            {"composition:order=8,base=imex", 9, 17}};
  problem *chain = create_problem("fpu", "ell=100");
  dvi_integrator *integrator = start_integrator(chain, of[_i].method);
  advance(integrator, 0.05, 100);
  dvi_counters c = read_counters(integrator);
  ck_assert_int_eq(c.factorizations, of[_i].lengths);
  ck_assert_int_eq(c.symbolic, of[_i].lengths);
  ck_assert_int_eq(c.solves, 100 * of[_i].substeps);
  advance(integrator, 0.04, 100);
  c = read_counters(integrator);
  ck_assert_int_eq(c.factorizations, 2 * of[_i].lengths);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
}
END_TEST

START_TEST(another_fast_potential_goes_to_the_midpoint_rules_solvers)
{
  bond pair;
  make_bond(2500, 0.5, &pair);
  dvi_integrator *integrator = bond_integrator(&pair, "imex");
  advance(integrator, 0.1, 50);
  const dvi_counters c = read_counters(integrator);
  ck_assert_int_ge(c.fixed_points + c.simplified + c.newtons, 50);
  ck_assert_int_gt(c.jacobians, 0);
  dvi_integrator_destroy(&integrator);
  destroy_bond(&pair);
}
END_TEST

/* ---- a full matrix, for LAPACK: V = 50 (sum q)^2 ---- */

enum { MASSES = 80 };

static int pull(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  double sum = 0;
  for (int i = 0; i < MASSES; i++) sum += q[i];
  *V = 50 * sum * sum;
  return 0;
}

static int pull_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  double sum = 0;
  for (int i = 0; i < MASSES; i++) sum += q[i];
  for (int i = 0; i < MASSES; i++) V_q[i] = 100 * sum;
  return 0;
}

START_TEST(full_matrices_are_kept_too)
{
  const dvi_potential potential = {
      .name = "pull", .value = pull, .gradient = pull_gradient, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = MASSES, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator = create_integrator(system, "composition:order=4,base=imex");
  const double q[MASSES] = {1}, p[MASSES] = {0};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  advance(integrator, 0.01, 50);
  ck_assert_int_eq(read_counters(integrator).factorizations, 2);
  ck_assert_int_eq(read_counters(integrator).symbolic, 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- a saddle: V = -k q^2/2 in one direction, k = 4 ---- */

static int saddle(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 50 * q[0] * q[0] - 2 * q[1] * q[1];
  return 0;
}

static int saddle_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 100 * q[0];
  V_q[1] = -4 * q[1];
  return 0;
}

/* The midpoint rule turns e^{2h} into (1 + h)/(1 - h). */
START_TEST(along_a_saddle_the_motion_grows_and_steps_beyond_its_pole_are_refused)
{
  const dvi_potential potential = {
      .name = "saddle", .value = saddle, .gradient = saddle_gradient, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator = create_integrator(system, "imex");
  const double q[] = {0, 1}, p[] = {0, 2};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  advance(integrator, 0.5, 1);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 3, 1e-14);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[1], 6, 1e-14);
  for (int k = 0; k < 2; k++) {
    ck_assert_int_eq(dvi_integrator_step(integrator, k == 0 ? 1.0 : 1.5), DVI_NOT_CONVERGED);
    check_words("imex: step 2 from t = 0.5 with h = 1");
    check_words("the state is unchanged, try a smaller step: M + h^2/4 K is singular at this "
                "length or at a shorter one");
    check_words("K of the fast potentials has negative directions");
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 3, 1e-14);
  }
  advance(integrator, 0.5, 1);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 9, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

static int cup(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 2 * q[0] * q[0] + 2 * q[1] * q[1];
  return 0;
}

static int cup_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 4 * q[0];
  V_q[1] = 4 * q[1];
  return 0;
}

/* V = -k |q|^2/2 for any number of coordinates. The determinant changes its sign as often as there
 * are coordinates, at h = 1. */

enum { HILLS = 80 };

static int hill(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = 0;
  for (int i = 0; i < *(const int *)user; i++) *V -= 2 * q[i] * q[i];
  return 0;
}

static int hill_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  for (int i = 0; i < *(const int *)user; i++) V_q[i] = -4 * q[i];
  return 0;
}

START_TEST(steps_beyond_two_poles_are_refused_too)
{
  static const int start[] = {0, 1, 2}, row[] = {0, 1}, sizes[] = {2, 2, HILLS};
  int n = sizes[_i];
  const double q[HILLS] = {1, 1}, p[HILLS] = {2, 2}, mass[] = {1, 1};
  const dvi_potential potential = {.name = "hill",
                                   .value = hill,
                                   .gradient = hill_gradient,
                                   .user = &n,
                                   .fast = 1,
                                   .quadratic = 1,
                                   .qq = _i == 0 ? (dvi_pattern){start, row} : (dvi_pattern){0}};
  const dvi_mass scalar = {.scalar = 1}, sparse = {.values = mass, .pattern = {start, row}};
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = n,
                                                       .mass = _i == 0 ? sparse : scalar,
                                                       .potentials = &potential,
                                                       .potential_count = 1});
  dvi_integrator *integrator = create_integrator(system, "imex");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  for (int k = 0; k < 2; k++) {
    ck_assert_int_eq(dvi_integrator_step(integrator, k == 0 ? 1.0 : -1.5), DVI_NOT_CONVERGED);
    check_words("K of the fast potentials has negative directions");
  }
  advance(integrator, 0.5, 1);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 3, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_pattern_that_is_too_large_is_that_of_a_potential)
{
  int n = 50000;
  const dvi_potential potential = {.name = "hill",
                                   .value = hill,
                                   .gradient = hill_gradient,
                                   .user = &n,
                                   .fast = 1,
                                   .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = n, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(system, "imex", &integrator), DVI_BAD_SIZE);
  check_words(
      "the Hessian of 'hill': pattern: 2500000000 entries are too many; declare a sparse pattern");
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(of_an_indefinite_mass_the_sentence_says_so)
{
  const double mass[] = {1, -1};
  const dvi_potential potential = {
      .name = "cup", .value = cup, .gradient = cup_gradient, .fast = 1, .quadratic = 1};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 2, .mass.diagonal = mass, .potentials = &potential, .potential_count = 1});
  dvi_integrator *integrator = create_integrator(system, "imex");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, (double[]){0, 1}, (double[]){0, -2}),
                   DVI_OK);
  advance(integrator, 0.5, 1);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[1], 3, 1e-13);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1.5), DVI_NOT_CONVERGED);
  check_words("the mass M is indefinite");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_step_without_a_solution_says_how_far_it_came)
{
  dvi_system *system = runaway(1);
  dvi_integrator *integrator = create_integrator(system, "imex");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &(double){0}, &(double){0}), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1.5), DVI_STEP_TOO_LARGE);
  const char *const words[] = {"imex: step 1 from t = 0 with h = 1.5 failed",
                               "the state is unchanged, try a smaller step", "iterations",
                               "ends at h = 1.41"};
  for (int k = 0; k < 4; k++) check_words(words[k]);
  ck_assert_double_eq(dvi_integrator_q(integrator)[0], 0);
  advance(integrator, 0.7, 1);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- oscillators: slow q^2/2, fast omega^2 q^2/2 ---- */

/* Steps where substeps resonate (test_respa.c), and in between. */
START_TEST(no_fast_frequency_resonates)
{
  const double peak[] = {.99945, 1.99942, 2.99872, 3.99724};
  for (int k = 1; k <= 45; k++)
    ck_assert_double_le(oscillators_energy_error("imex", 0.1, 0.1 * k, 10000), 3e-3);
  for (int k = 0; k < 4; k++)
    ck_assert_double_le(oscillators_energy_error("imex", 0.1, peak[k], 10000), 3e-3);
  for (int k = 1; k <= 450; k++) ck_assert_double_eq(oscillators_growth("imex", 0.1, 0.01 * k), 1);
}
END_TEST

START_TEST(steps_are_stable_exactly_below_the_slow_limit_of_2)
{
  const double x[] = {0.1, 1, 10, 100};
  for (int k = 0; k < 4; k++) {
    ck_assert_double_eq(oscillators_growth("imex", 1.999, x[k]), 1);
    ck_assert_double_gt(oscillators_growth("imex", 2.001, x[k]), 1 + 1e-5);
  }
}
END_TEST

/* ---- fpu ---- */

/* The largest |I - 1| of the stiff springs' energies until then. */
static double exchange_error(double t_end)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *integrator = start_integrator(chain, "imex");
  double worst = 0, I = 0;
  for (long step = 0; step < lround(t_end / 0.1); step++) {
    advance(integrator, 0.1, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &I), DVI_OK);
    worst = fmax(worst, fabs(I - 1));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&chain);
  return worst;
}

START_TEST(the_stiff_springs_keep_their_energy_over_long_times_at_steps_beyond_their_period)
{
  ck_assert_double_le(exchange_error(200), 0.08);
  ck_assert_double_le(exchange_error(4000), 0.11);
}
END_TEST

SUITE(imex)
{
  tcase_add_test(tests, one_linear_system_a_step_does_what_newtons_method_does);
  tcase_add_test(tests,
                 a_quadratic_fast_potential_takes_one_factorisation_a_run_and_one_gradient_a_step);
  tcase_add_loop_test(
      tests, a_composition_takes_one_analysis_and_factor_for_each_length_of_its_substeps, 0, 3);
  tcase_add_test(tests, full_matrices_are_kept_too);
  tcase_add_test(tests, another_fast_potential_goes_to_the_midpoint_rules_solvers);
  tcase_add_loop_test(tests, steps_beyond_two_poles_are_refused_too, 0, 3);
  tcase_add_test(tests, a_pattern_that_is_too_large_is_that_of_a_potential);
  tcase_add_test(tests, of_an_indefinite_mass_the_sentence_says_so);
  tcase_add_test(tests, along_a_saddle_the_motion_grows_and_steps_beyond_its_pole_are_refused);
  tcase_add_test(tests, a_step_without_a_solution_says_how_far_it_came);
  tcase_add_test(tests, no_fast_frequency_resonates);
  tcase_add_test(tests, steps_are_stable_exactly_below_the_slow_limit_of_2);
  tcase_add_test(tests,
                 the_stiff_springs_keep_their_energy_over_long_times_at_steps_beyond_their_period);
}
