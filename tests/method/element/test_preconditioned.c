/* labels: order long */
/* Fixed-point iteration in which quadratic potentials with a diagonal Hessian are implicit
 * (step/element/preconditioner.c), on the sine-Gordon equation in Fourier's modes. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/spectral/sine_gordon.h"

static dvi_integrator *start_waves(const sine_gordon *waves, const char *method)
{
  dvi_integrator *made = create_integrator(waves->system, method);
  ck_assert_int_eq(dvi_integrator_start(made, 0, waves->q, waves->p), DVI_OK);
  return made;
}

static double invariant(dvi_integrator *integrator, int i)
{
  double value;
  ck_assert_int_eq(dvi_integrator_invariant(integrator, i, &value), DVI_OK);
  return value;
}

static double sum_at_origin(int n, const double *q)
{
  double u = q[0];
  for (int i = 1; i < n; i += 2) u += q[i];
  return u;
}

/* ---- one element over all of the time ---- */

/* Errors of the coefficients in the orthonormal basis cos kx/sqrt(pi), and u(0,4), from a
 * prototype with dense linear algebra. */
static const struct {
  int degree;
  double error;
} elements[] = {{8, 1.7e-3}, {12, 1.7e-5}, {16, 2.2e-7}, {20, 2.2e-9}};
static const double u_at_4 = -1.445122382059;

static void find_solution_at_4(const sine_gordon *waves, double *q)
{
  dvi_integrator *fine = start_waves(waves, "galerkin:degree=12");
  advance(fine, 0.5, 8);
  memcpy(q, dvi_integrator_q(fine), (size_t)waves->n * sizeof(double));
  dvi_integrator_destroy(&fine);
}

/* The error of u at the point is that of the coefficients, of which it sums some. */
START_TEST(one_element_solves_sine_gordon_over_all_of_the_time)
{
  sine_gordon waves;
  double exact[2 * SINE_GORDON_MODES + 1];
  sine_gordon_create(12, 32, 1, 1, &waves);
  find_solution_at_4(&waves, exact);
  ck_assert_double_eq_tol(sum_at_origin(waves.n, exact), u_at_4, 1e-12);
  dvi_integrator *one = start_waves(&waves, method_spec("galerkin:degree=%d", elements[_i].degree));
  const double momentum = invariant(one, 1);
  advance(one, 4, 1);
  const double error = sqrt(acos(-1)) * distance(waves.n, dvi_integrator_q(one), exact);
  ck_assert_double_eq_tol(error / elements[_i].error, 1, 0.05);
  ck_assert_double_le(fabs(invariant(one, 1) - momentum), 5e-15);
  dvi_integrator_destroy(&one);
  sine_gordon_destroy(&waves);
}
END_TEST

/* h omega = 48 for the fastest mode. After 12 iterations of degree 16 the corrections are below
 * 1e-11, after 14 they are roundings, and the criteria want to see that. */
START_TEST(one_element_takes_few_iterations)
{
  sine_gordon waves;
  sine_gordon_create(12, 32, 1, 1, &waves);
  dvi_integrator *one = start_waves(&waves, "galerkin:degree=16");
  advance(one, 4, 1);
  const dvi_counters counters = read_counters(one);
  ck_assert_int_le(counters.residuals, 18);
  ck_assert_int_eq(counters.gradients, 16 * counters.residuals + 1);
  ck_assert_int_eq(counters.fixed_points, 1);
  ck_assert_int_eq(counters.hessians + counters.jacobians + counters.factorizations, 0);
  dvi_integrator_destroy(&one);
  sine_gordon_destroy(&waves);
}
END_TEST

/* ---- order ---- */

enum { LEVELS = 4 };

/* Fast modes of a smooth solution are small, and go with the slow ones. Gauss' order 2s shows at
 * h omega = 30 and less. */
START_TEST(smooth_waves_keep_the_order_at_large_frequencies)
{
  enum { K = 60 };
  const int degree = _i;
  double q[LEVELS + 1][2 * SINE_GORDON_MODES + 1], error[LEVELS];
  const int first[] = {0, 4, 2, 2, 2};
  sine_gordon waves;
  sine_gordon_create(K, 128, 1, 1, &waves);
  for (int level = 0; level <= LEVELS; level++) {
    const int last = level == LEVELS, steps = first[degree] << level;
    dvi_integrator *run = start_waves(&waves,
                                      method_spec("galerkin:degree=%d", last ? 12 : degree));
    advance(run, 1.0 / steps, steps);
    ck_assert_int_eq(read_counters(run).fixed_points, steps);
    memcpy(q[level], dvi_integrator_q(run), (size_t)waves.n * sizeof(double));
    dvi_integrator_destroy(&run);
  }
  for (int level = 0; level < LEVELS; level++)
    error[level] = distance(waves.n, q[level], q[LEVELS]);
  for (int level = 1; level < LEVELS; level++)
    ck_assert_double_eq_tol(log2(error[level - 1] / error[level]), 2 * degree, 0.2);
  sine_gordon_destroy(&waves);
}
END_TEST

/* ---- the equations are those of the other rungs ---- */

/* Stiff springs at h omega = 5. Twenty steps of a rounding of h omega in p each. */
START_TEST(newtons_method_finds_the_same_steps)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *iterated = start_integrator(chain, method_spec("galerkin:degree=%d", _i)),
                 *newton = start_integrator(chain,
                                            method_spec("galerkin:degree=%d,solver=newton", _i));
  advance(iterated, 0.1, 20);
  advance(newton, 0.1, 20);
  ck_assert_int_eq(read_counters(iterated).fixed_points, 20);
  ck_assert_int_eq(read_counters(newton).newtons, 20);
  ck_assert_double_le(distance(chain->nq, dvi_integrator_q(iterated), dvi_integrator_q(newton)),
                      5e-14);
  ck_assert_double_le(distance(chain->nq, dvi_integrator_p(iterated), dvi_integrator_p(newton)),
                      5e-14 * 50);
  dvi_integrator_destroy(&iterated);
  dvi_integrator_destroy(&newton);
  problem_destroy(&chain);
}
END_TEST

/* The defect is that of differences. */
START_TEST(steps_are_symplectic)
{
  sine_gordon waves;
  double defect;
  sine_gordon_create(6, 16, 1, 1, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=2");
  ck_assert_int_eq(dvi_symplecticity(run, 0, waves.q, waves.p, 1, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-8);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&waves);
}
END_TEST

/* A linear system is solved by one iteration, and the criteria want to see two or three
 * corrections that are roundings. */
START_TEST(linear_waves_take_the_fewest_iterations)
{
  sine_gordon waves;
  sine_gordon_create(12, 32, 0, 1, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=3");
  advance(run, 2, 50);
  ck_assert_int_le(read_counters(run).residuals, 4 * 50);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&waves);
}
END_TEST

/* The largest distance of the energy from its mean over parts of the run. */
static double spread_of_energy(dvi_integrator *run, double h, int steps, double *first)
{
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (int i = 0; i < steps; i++) {
    advance(run, h, 1);
    const double E = invariant(run, 0);
    least = fmin(least, E);
    most = fmax(most, E);
  }
  *first = least;
  return most - least;
}

/* h omega = 6 for the fastest mode. The energy of the last tenth stays in the band of the first
 * one, up to a hundredth of its width. */
START_TEST(the_energy_of_waves_does_not_drift)
{
  const int part = repeats(100000) / 10;
  double least, later;
  sine_gordon waves;
  sine_gordon_create(12, 32, 1, 1, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=2");
  const double start = invariant(run, 0), width = spread_of_energy(run, 0.5, part, &least);
  ck_assert_double_le(width, 2e-3 * start);
  advance(run, 0.5, 8L * part);
  const double width_later = spread_of_energy(run, 0.5, part, &later);
  ck_assert_double_le(fabs(later - least), 0.1 * width);
  ck_assert_double_le(fabs(width_later - width), 0.1 * width);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&waves);
}
END_TEST

/* ---- bits and memory ---- */

static void best_again(void)
{
  dvi__lanes_choose(-1);
}

START_TEST(every_instruction_set_finds_the_same_bits)
{
  static const char *const methods[] = {"midpoint", "galerkin:degree=3", "galerkin:degree=8",
                                        "galerkin:degree=12,quadrature=lobatto",
                                        "composition:order=6,base=galerkin,degree=2"};
  double q[3][25];
  sine_gordon waves;
  sine_gordon_create(12, 32, 1, 1, &waves);
  for (int level = 0; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    dvi_integrator *run = start_waves(&waves, methods[_i]);
    advance(run, 0.3, 20);
    memcpy(q[level], dvi_integrator_q(run), (size_t)waves.n * sizeof(double));
    dvi_integrator_destroy(&run);
    ck_assert_mem_eq(q[level], q[0], sizeof q[0]);
  }
  sine_gordon_destroy(&waves);
}
END_TEST

/* Continued forces, and inverses that a run finds again, are all that a step has of others. */
START_TEST(a_restored_run_finds_the_same_bits)
{
  unsigned char saved[20000];
  size_t size = 0;
  sine_gordon waves;
  sine_gordon_create(12, 32, 1, 1, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=3"),
                 *other = create_integrator(waves.system, "galerkin:degree=3");
  advance(run, 0.3, 5);
  ck_assert_int_eq(dvi_integrator_save_memory(run, saved, sizeof saved, &size), DVI_OK);
  advance(run, 0.4, 5);
  ck_assert_int_eq(dvi_integrator_restore_memory(other, saved, size), DVI_OK);
  advance(other, 0.4, 5);
  ck_assert_mem_eq(dvi_integrator_q(other), dvi_integrator_q(run), 25 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(other), dvi_integrator_p(run), 25 * sizeof(double));
  dvi_integrator_destroy(&run);
  dvi_integrator_destroy(&other);
  sine_gordon_destroy(&waves);
}
END_TEST

/* The inverses of all of its lengths are kept, and those of one are never taken for another's.
 * Else the parts would not converge in the iterations that they take alone, or at all. */
START_TEST(a_composition_keeps_the_inverses_of_its_lengths)
{
  problem *chain = create_problem("fpu", NULL);
  dvi_integrator *iterated = start_integrator(chain, "composition:order=4,base=midpoint"),
                 *newton = start_integrator(chain, "composition:order=4,base=midpoint,"
                                                   "solver=newton");
  advance(iterated, 0.1, 20);
  advance(newton, 0.1, 20);
  const dvi_counters counters = read_counters(iterated);
  ck_assert_int_eq(counters.jacobians, 0);
  ck_assert_int_le(counters.residuals, 12 * counters.fixed_points);
  ck_assert_double_le(distance(chain->nq, dvi_integrator_q(iterated), dvi_integrator_q(newton)),
                      1e-13);
  dvi_integrator_destroy(&iterated);
  dvi_integrator_destroy(&newton);
  problem_destroy(&chain);
}
END_TEST

START_TEST(steps_take_no_memory)
{
  sine_gordon waves;
  sine_gordon_create(12, 32, 1, 1, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=4");
  const long calls = heap_calls();
  for (int i = 0; i < 20; i++) advance(run, i % 3 == 0 ? 0.2 : 0.3, 1);
  ck_assert_int_eq(heap_calls() - calls, 0);
  ck_assert_int_eq(read_counters(run).preparations, 0);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&waves);
}
END_TEST

/* Members with systems of their own have integrators of their own, which keep the stiffness. */
START_TEST(members_of_an_ensemble_keep_their_own_stiffness)
{
  enum { MEMBERS = 6 };
  problem *chain[MEMBERS];
  const dvi_system *systems[MEMBERS];
  double q[16 * MEMBERS], p[16 * MEMBERS];
  for (int k = 0; k < MEMBERS; k++) {
    chain[k] = create_problem("fpu", method_spec("omega=%d", 30 + 5 * k));
    systems[k] = chain[k]->system;
  }
  const int n = chain[0]->nq;
  for (int i = 0; i < n * MEMBERS; i++) {
    q[i] = chain[i % MEMBERS]->q[i / MEMBERS];
    p[i] = chain[i % MEMBERS]->p[i / MEMBERS];
  }
  dvi_ensemble *all = create_ensemble(
      NULL, "galerkin", (dvi_ensemble_options){.members = MEMBERS, .systems = systems});
  ck_assert_int_eq(dvi_ensemble_start(all, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(all, 0.1, 20), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(all, NULL, q, NULL), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    dvi_integrator *one = start_integrator(chain[k], "galerkin");
    advance(one, 0.1, 20);
    for (int i = 0; i < n; i++) ck_assert_double_eq(q[i * MEMBERS + k], dvi_integrator_q(one)[i]);
    dvi_integrator_destroy(&one);
  }
  dvi_ensemble_destroy(&all);
  for (int k = 0; k < MEMBERS; k++) problem_destroy(&chain[k]);
}
END_TEST

/* ---- other forces that are stiff ---- */

/* The pull alone has h omega = 6, and Newton's method solves. */
START_TEST(a_stiff_pull_goes_to_the_next_rung)
{
  sine_gordon waves;
  sine_gordon_create(4, 16, 36, 0, &waves);
  dvi_integrator *run = start_waves(&waves, "galerkin:degree=2");
  advance(run, 1, 1);
  const dvi_counters counters = read_counters(run);
  ck_assert_int_eq(counters.fixed_points, 0);
  ck_assert_int_eq(counters.simplified + counters.newtons, 1);
  dvi_integrator_destroy(&run);
  sine_gordon_destroy(&waves);
}
END_TEST

SUITE(preconditioned)
{
  tcase_add_loop_test(tests, one_element_solves_sine_gordon_over_all_of_the_time, 0,
                      sizeof elements / sizeof *elements);
  tcase_add_test(tests, one_element_takes_few_iterations);
  tcase_add_loop_test(tests, smooth_waves_keep_the_order_at_large_frequencies, 1, 5);
  tcase_add_loop_test(tests, newtons_method_finds_the_same_steps, 1, 5);
  tcase_add_test(tests, steps_are_symplectic);
  tcase_add_test(tests, linear_waves_take_the_fewest_iterations);
  tcase_add_test(tests, the_energy_of_waves_does_not_drift);
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_loop_test(tests, every_instruction_set_finds_the_same_bits, 0, 5);
  tcase_add_test(tests, a_restored_run_finds_the_same_bits);
  tcase_add_test(tests, a_composition_keeps_the_inverses_of_its_lengths);
  tcase_add_test(tests, steps_take_no_memory);
  tcase_add_test(tests, members_of_an_ensemble_keep_their_own_stiffness);
  tcase_add_test(tests, a_stiff_pull_goes_to_the_next_rung);
}
