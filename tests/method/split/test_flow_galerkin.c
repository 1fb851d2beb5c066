/* labels: unit invariant */
#include <dvi/dvi.h>
#include <math.h>

#include "core/memory.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

/* ---- without a rest ---- */

/* Creates the system of a problem whose only potential is declared fast, and maybe quadratic. */
static dvi_system *create_fast(const problem *model, int quadratic)
{
  dvi_system *system;
  dvi_potential potential = model->terms->potentials[0];
  dvi_system_terms terms = *model->terms;
  potential.fast = 1;
  potential.quadratic = quadratic;
  terms.potentials = &potential;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *start_at(const dvi_system *system, const char *method, const double *q,
                                const double *p)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* Steps of any length, forward and backward, are exact. The roundings of the start count by
 * 1/(1 - e). */
START_TEST(eccentric_kepler_motions_are_exact)
{
  static const struct {
    const char *setting;
    double error; /* in a unit of time */
  } cases[] = {{"e=0", 1e-14}, {"e=0.6", 6e-14}, {"e=0.9", 5e-13}, {"e=0.99", 5e-12}};
  static const double h[] = {0.3, 2, -1.1, 11};
  problem *model = create_problem("kepler", cases[_i].setting);
  dvi_system *system = create_fast(model, 0);
  for (int k = 0; k < 4; k++) {
    dvi_integrator *integrator = start_at(system, "flow-galerkin:stages=2", model->q, model->p);
    double q[2], p[2];
    for (int step = 0; step < 40; step++) {
      advance(integrator, h[k], 1);
      const double t = dvi_integrator_time(integrator);
      ck_assert_int_eq(model->exact(model, t, q, p), 0);
      ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q),
                          cases[_i].error * (1 + fabs(t)));
    }
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(oscillations_are_exact)
{
  problem *model = create_problem("oscillator", "k=4");
  dvi_system *system = create_fast(model, 1);
  dvi_integrator *integrator = start_at(system, "flow-galerkin:stages=1", model->q, model->p);
  for (int step = 0; step < 50; step++) {
    double q, p;
    advance(integrator, 7, 1);
    ck_assert_int_eq(model->exact(model, dvi_integrator_time(integrator), &q, &p), 0);
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q, 2e-14 * (step + 1));
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* One step of a hyperbola is two halves, and goes back. */
START_TEST(hyperbolas_are_exact)
{
  const double q[] = {1, 0.5}, p[] = {-1.5, 1};
  problem *model = create_problem("kepler", NULL);
  dvi_system *system = create_fast(model, 0);
  dvi_integrator *whole = start_at(system, "flow-galerkin", q, p),
                 *halves = start_at(system, "flow-galerkin", q, p);
  advance(whole, 6, 1);
  advance(halves, 3, 2);
  ck_assert_double_le(distance(2, dvi_integrator_q(whole), dvi_integrator_q(halves)), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(whole), dvi_integrator_p(halves)), 1e-13);
  advance(whole, -6, 1);
  ck_assert_double_le(distance(2, dvi_integrator_q(whole), q), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(whole), p), 1e-13);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&halves);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* ---- time ---- */

/* V = q^2/2 - q cos 2t. */
static int driven_value(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = 0.5 * q[0] * q[0] - q[0] * cos(2 * t);
  return 0;
}

static int driven_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  V_q[0] = q[0] - cos(2 * t);
  return 0;
}

/* The solution from rest at 0 is (cos t - cos 2t)/3. */
START_TEST(a_rest_may_depend_on_the_time_and_a_fast_potential_may_not)
{
  const double q = 0, p = 0;
  dvi_potential drive = {.name = "drive", .value = driven_value, .gradient = driven_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &drive, .potential_count = 1};
  dvi_system *system;
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  integrator = start_at(system, "flow-galerkin:stages=6", &q, &p);
  advance(integrator, 0.3, 40);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], (cos(12) - cos(24)) / 3, 1e-12);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  drive.fast = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "flow-galerkin", &integrator), DVI_UNSUPPORTED);
  check_words("declare the system autonomous");
  dvi_system_destroy(&system);
}
END_TEST

/* ---- structure ---- */

static const struct {
  const char *problem;
  double h, defect;
} places[] = {{"pendulum", 0.4, 1e-10},
              {"fpu", 0.05, 1e-10},
              {"outer-solar-jacobi", 400, 1e-10},
              {"outer-solar", 100, 1e-10}};
enum { PLACES = sizeof places / sizeof *places };

START_TEST(steps_are_symplectic_and_reversible)
{
  const int place = _i / 4;
  problem *model = create_problem(places[place].problem, NULL);
  dvi_integrator *integrator = create_integrator(
      model->system, method_spec("flow-galerkin:stages=%d", 1 + _i % 4));
  double defect;
  ck_assert_msg(dvi_symplecticity(integrator, 0, model->q, model->p, places[place].h, &defect) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_double_le(defect, places[place].defect);
  ck_assert_msg(
      dvi_reversibility(integrator, 0, model->q, model->p, places[place].h, 20, &defect) == DVI_OK,
      "%s", dvi_last_error());
  ck_assert_double_le(defect, 1e-11);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The energy is that of H, of which a step sees the rest alone. */
START_TEST(energy_and_angular_momenta_stay_over_many_steps)
{
  const int steps = repeats(20000);
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4");
  double first[4], now[4];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  for (int k = 0; k < 10; k++) {
    advance(integrator, 200, steps / 10);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    for (int i = 0; i < 4; i++)
      ck_assert_double_eq_tol(now[i], first[i], (i == 0 ? 2e-11 : 1e-13) * fabs(first[i]));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Five years of Jupiter and the others in 8 steps. */
START_TEST(the_path_follows_the_flow_inside_of_a_step)
{
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4"),
                 *fine = start_integrator(model, "galerkin:degree=8");
  double q[15], v[15];
  for (int step = 0; step < 8; step++) {
    advance(integrator, 400, 1);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 400 * (step + 1), q, v), DVI_OK);
    ck_assert_double_le(distance(15, q, dvi_integrator_q(integrator)), 1e-13);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 400 * step + 160, q, v), DVI_OK);
    advance(fine, 40, 4);
    ck_assert_double_le(distance(15, q, dvi_integrator_q(fine)), 3e-7);
    advance(fine, 40, 6);
  }
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&fine);
  problem_destroy(&model);
}
END_TEST

/* ---- cost ---- */

/* The first step has more iterations, because it does not know the forces before. */
START_TEST(a_small_rest_takes_two_iterations_a_step)
{
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4");
  dvi_counters before, after;
  advance(integrator, 100, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 100, 100);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.fixed_points - before.fixed_points, 100);
  ck_assert_int_le(after.residuals - before.residuals, 240);
  ck_assert_int_eq(after.gradients - before.gradients, 4 * (after.residuals - before.residuals));
  ck_assert_int_eq(after.jacobians, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static const char *const kinds[] = {"pendulum", "fpu", "outer-solar-jacobi"};
enum { KINDS = sizeof kinds / sizeof *kinds };

START_TEST(a_step_takes_no_memory)
{
  problem *model = create_problem(kinds[_i], NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin");
  double q[64], v[64];
  advance(integrator, model->h, 1);
  const long before = heap_calls();
  dvi__fail_allocations_after(0);
  advance(integrator, model->h, 3);
  advance(integrator, -0.5 * model->h, 3);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 2.7 * model->h, q, v), DVI_OK);
  dvi__fail_allocations_after(-1);
  ck_assert_int_eq(heap_calls(), before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- states ---- */

/* Whatever the restored integrator did before. */
START_TEST(a_restored_run_has_the_same_bits)
{
  problem *model = create_problem(kinds[_i], NULL);
  dvi_integrator *saved = start_integrator(model, "flow-galerkin:stages=3"),
                 *restored = start_integrator(model, "flow-galerkin:stages=3");
  for (int k = 0; k < repeats(40); k++) {
    advance(saved, model->h, 1);
    advance(restored, 0.3 * model->h, 1);
    ck_assert_int_eq(dvi_integrator_save(saved, path_in_folder("state")), DVI_OK);
    ck_assert_int_eq(dvi_integrator_restore(restored, path_in_folder("state")), DVI_OK);
    advance(saved, -0.7 * model->h, 1);
    advance(restored, -0.7 * model->h, 1);
    check_same_state(saved, restored);
  }
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&restored);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_step_that_is_too_long_leaves_the_state)
{
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *tried = start_integrator(model, "flow-galerkin"),
                 *plain = start_integrator(model, "flow-galerkin");
  advance(tried, 0.1, 3);
  advance(plain, 0.1, 3);
  ck_assert_int_lt(0, dvi_integrator_step(tried, 50));
  check_words("the state is unchanged");
  ck_assert_int_eq(dvi_integrator_step(tried, 0), DVI_BAD_ARGUMENT);
  check_same_state(tried, plain);
  advance(tried, 0.1, 2);
  advance(plain, 0.1, 2);
  check_same_state(tried, plain);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&plain);
  problem_destroy(&model);
}
END_TEST

/* ---- what is refused ---- */

static void check_refused(const dvi_system *system, const char *words)
{
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(system, "flow-galerkin", &integrator), DVI_UNSUPPORTED);
  check_words(words);
  ck_assert_ptr_null(integrator);
}

START_TEST(fast_potentials_without_a_known_flow_are_refused)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_system *system = create_fast(model, 0);
  check_refused(system, "flow-galerkin: the flow of the fast potentials is not known");
  dvi_system_destroy(&system);
  problem_destroy(&model);
  model = create_problem("figure-eight", NULL);
  system = create_fast(model, 0);
  check_refused(system, "their sum is not -k/|q|");
  dvi_system_destroy(&system);
  problem_destroy(&model);
  model = create_problem("double-pendulum", NULL);
  check_refused(model->system, "flow-galerkin");
  problem_destroy(&model);
}
END_TEST

SUITE(flow_galerkin)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, eccentric_kepler_motions_are_exact, 0, 4);
  tcase_add_test(tests, oscillations_are_exact);
  tcase_add_test(tests, hyperbolas_are_exact);
  tcase_add_test(tests, a_rest_may_depend_on_the_time_and_a_fast_potential_may_not);
  tcase_add_loop_test(tests, steps_are_symplectic_and_reversible, 0, 4 * PLACES);
  tcase_add_test(tests, energy_and_angular_momenta_stay_over_many_steps);
  tcase_add_test(tests, the_path_follows_the_flow_inside_of_a_step);
  tcase_add_test(tests, a_small_rest_takes_two_iterations_a_step);
  tcase_add_loop_test(tests, a_step_takes_no_memory, 0, KINDS);
  tcase_add_loop_test(tests, a_restored_run_has_the_same_bits, 0, KINDS);
  tcase_add_test(tests, a_step_that_is_too_long_leaves_the_state);
  tcase_add_test(tests, fast_potentials_without_a_known_flow_are_refused);
}
