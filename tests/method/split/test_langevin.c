/* labels: unit order invariant */
#include <check.h>
#include <math.h>
#include <string.h>

#include "num/normal.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/noisy.h"

static const double m = 1.7, k = 2.3;
static const dvi_noise bath = {.temperature = 0.8, .friction = 0.7, .seed = 20260101};

/* <q^2> k/kT, <p^2>/(m kT) and the reported temperature, all over kT, of the stationary state. */
static void check_covariance(const char *method, double x, int draws, double q2, double p2)
{
  const double h = x * sqrt(m / k), kT = bath.temperature;
  const noisy_covariance s = find_covariance(method, m, k, bath, h, draws);
  ck_assert_double_eq_tol(s.qq * k / kT, q2, 1e-12 * fmax(1, q2));
  ck_assert_double_eq_tol(s.pp / (m * kT), p2, 1e-12);
  ck_assert_double_eq_tol(s.temperature / kT, 1, 1e-12);
}

/* Leimkuhler and Matthews 2013, sec. 3, and the ellipse that Verlet's method leaves invariant. */
START_TEST(averages_of_the_harmonic_oscillator_are_those_of_theory)
{
  static const double x[] = {0.1, 0.5, 1, 1.5, 1.9};
  for (int i = 0; i < 5; i++) {
    const double falls = 1 - x[i] * x[i] / 4;
    check_covariance("langevin", x[i], 1, 1, falls);
    check_covariance("langevin:scheme=obabo", x[i], 2, 1 / falls, 1);
    for (int s = 1; s <= 3; s++)
      check_covariance(method_spec("langevin:scheme=ovio,degree=%d", s), x[i], 2, 1, 1);
  }
}
END_TEST

/* The error of <q^2> falls as h^2s for Lobatto with r = s + 1. Without the factor of the sum of
 * higher powers, slopes over two of four steps are within 0.1 of it (2.00, 4.01, 6.02 at the
 * last). */
START_TEST(the_stationary_error_of_ovio_has_the_order_of_galerkin)
{
  static const double least[3] = {0.05, 0.1, 0.15};
  for (int s = 1; s <= 3; s++) {
    const char *method = method_spec("langevin:scheme=ovio,degree=%d,quadrature=lobatto,nodes=%d",
                                     s, s + 1);
    double last = 0;
    for (int level = 3; level >= 0; level--) {
      const double h = ldexp(least[s - 1], level);
      const noisy_covariance c = find_covariance(method, m, k, bath, h, 2);
      const double error = fabs(c.qq * k / bath.temperature - 1);
      if (level < 2) ck_assert_double_eq_tol(log2(last / error), 2 * s, 0.1);
      ck_assert_double_eq_tol(c.temperature / bath.temperature, 1, 1e-12);
      last = error;
    }
  }
}
END_TEST

/* One step from rest at the origin, without a spring, gives the momenta e^{-gamma h/2} or 1 times
 * sqrt(kT (1 - c^2)) C N with C C^T = M. Their covariance follows from four independent N. */
START_TEST(a_mass_that_is_not_diagonal_gives_its_covariance)
{
  enum { N = 3 };
  const double h = 0.4, c = exp(-bath.friction * h), zero[N] = {0};
  double normal[N][N], p[N][N], sum[N][N] = {{0}};
  for (int s = 0; s < N; s++) { /* N seeds give the columns of C by N equations */
    const double draw = 0, stream = 0;
    double fourth;
    dvi_noise noise = bath;
    noisy_oscillators noisy;
    noise.seed = (unsigned long long)s;
    make_noisy(N, m, 0, 1, noise, &noisy);
    dvi__normals(1, noise.seed, 0, &draw, &stream, &normal[s][0], &normal[s][1]);
    dvi__normals(1, noise.seed, 1, &draw, &stream, &normal[s][2], &fourth);
    dvi_integrator *integrator = create_integrator(noisy.system, "langevin");
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, zero, zero), DVI_OK);
    advance(integrator, h, 1);
    memcpy(p[s], dvi_integrator_p(integrator), sizeof p[s]);
    dvi_integrator_destroy(&integrator);
    destroy_noisy(&noisy);
  }
  /* p_s = r C N_s with the rows s: C = P^T (N^T)^{-1}/r, by elimination of N */
  for (int i = 0; i < N; i++)
    for (int s = 0; s < N; s++) {
      const double factor = normal[s][i] / normal[i][i];
      for (int j = 0; j < N && s != i; j++) normal[s][j] -= factor * normal[i][j];
      for (int j = 0; j < N && s != i; j++) p[s][j] -= factor * p[i][j];
    }
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      for (int s = 0; s < N; s++) sum[i][j] += p[s][i] / normal[s][s] * p[s][j] / normal[s][s];
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      ck_assert_double_eq_tol(sum[i][j] / (bath.temperature * (1 - c * c)), i == j ? m : 0.3 * m,
                              1e-13);
}
END_TEST

/* Without friction the bath does nothing. The drift in two halves may round otherwise. */
START_TEST(without_friction_steps_are_those_of_verlet_and_galerkin)
{
  static const char *const pairs[][2] = {{"langevin", "verlet"},
                                         {"langevin:scheme=obabo", "verlet"},
                                         {"langevin:scheme=ovio,degree=3", "galerkin:degree=3"}};
  problem *well = create_problem("henon-heiles", NULL);
  dvi_system_terms terms = *well->terms;
  terms.noise = &(dvi_noise){.temperature = 1};
  dvi_system *noisy = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &noisy), DVI_OK);
  for (int i = 0; i < 3; i++) {
    dvi_integrator *one = create_integrator(noisy, pairs[i][0]),
                   *other = start_integrator(well, pairs[i][1]);
    ck_assert_int_eq(dvi_integrator_start(one, 0, well->q, well->p), DVI_OK);
    advance(one, 0.1, 100);
    advance(other, 0.1, 100);
    ck_assert_double_le(distance(2, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-13);
    ck_assert_double_le(distance(2, dvi_integrator_p(one), dvi_integrator_p(other)), 1e-13);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
  }
  dvi_system_destroy(&noisy);
  problem_destroy(&well);
}
END_TEST

START_TEST(explicit_schemes_cost_one_gradient_a_step_and_nothing_else)
{
  static const char *const methods[] = {"langevin", "langevin:scheme=obabo"};
  const double q[] = {1, 0, 2}, p[] = {0, 1, 0};
  noisy_oscillators noisy;
  make_noisy(3, m, k, 0, bath, &noisy);
  for (int i = 0; i < 2; i++) {
    dvi_integrator *integrator = create_integrator(noisy.system, methods[i]);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    const dvi_counters before = read_counters(integrator);
    advance(integrator, 0.1, 1);
    const dvi_counters first = read_counters(integrator);
    ck_assert_int_eq(first.gradients - before.gradients, 2);
    advance(integrator, 0.1, 100);
    const dvi_counters after = read_counters(integrator);
    ck_assert_int_eq(after.gradients - first.gradients, 100);
    ck_assert_int_eq(after.hessians + after.jacobians + after.residuals + after.factorizations, 0);
    ck_assert_int_eq(after.allocations, before.allocations);
    dvi_integrator_destroy(&integrator);
  }
  destroy_noisy(&noisy);
}
END_TEST

/* Dense output joins both ends of the step. */
START_TEST(the_path_of_a_step_leads_from_end_to_end)
{
  static const char *const methods[] = {"langevin", "langevin:scheme=obabo",
                                        "langevin:scheme=ovio,degree=2"};
  const double p = 1;
  double q0 = 1, q, v[2];
  noisy_oscillators noisy;
  make_noisy(1, m, k, 0, bath, &noisy);
  for (int i = 0; i < 3; i++) {
    dvi_integrator *integrator = create_integrator(noisy.system, methods[i]);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q0, &p), DVI_OK);
    advance(integrator, 0.3, 1);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, &q, &v[0]), DVI_OK);
    ck_assert_double_eq_tol(q, q0, 1e-15);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.3, &q, &v[1]), DVI_OK);
    ck_assert_double_eq_tol(q, dvi_integrator_q(integrator)[0], 1e-15);
    /* the bath acts in the middle of baoab alone */
    if (i < 2) ck_assert_int_eq(v[0] == v[1], i == 1);
    dvi_integrator_destroy(&integrator);
  }
  destroy_noisy(&noisy);
}
END_TEST

/* ---- single paths ---- */

enum { PATHS = 100, FINEST = 9 };

/* Ends of the paths of noise that all levels see, after 2^(level + 4) steps. */
static void end_of_paths(const dvi_system *system, const char *scheme, int level, double *q)
{
  double zero[PATHS] = {0};
  const char *method = method_spec("langevin:scheme=%s,refinement=%d", scheme, FINEST - level);
  dvi_ensemble *e = create_ensemble(system, method,
                                    (dvi_ensemble_options){.members = PATHS, .threads = 1});
  ck_assert_int_eq(dvi_ensemble_start(e, 0, zero, zero), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, ldexp(0.25, -level), 16L << level), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, NULL), DVI_OK);
  dvi_ensemble_destroy(&e);
}

static double root_mean_square(const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < PATHS; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum / PATHS);
}

/* The distance from the finest paths falls as h. */
START_TEST(paths_converge_with_order_1)
{
  static const char *const schemes[] = {"baoab", "obabo", "ovio,degree=1", "ovio,degree=3"};
  enum { LEVELS = 5 };
  double finest[PATHS], q[PATHS], error[LEVELS];
  noisy_oscillators noisy;
  make_noisy(1, m, k, 0, bath, &noisy);
  end_of_paths(noisy.system, schemes[_i], FINEST, finest);
  for (int level = 0; level < LEVELS; level++) {
    end_of_paths(noisy.system, schemes[_i], level, q);
    error[level] = root_mean_square(q, finest);
    if (level > 0) ck_assert_double_eq_tol(log2(error[level - 1] / error[level]), 1, 0.3);
  }
  ck_assert_double_eq_tol(log2(error[0] / error[LEVELS - 1]) / (LEVELS - 1), 1, 0.1);
  destroy_noisy(&noisy);
}
END_TEST

/* What the bath supplies is heat. Gauss collocation keeps a quadratic energy, so that the balance
 * of ovio is a sum of roundings. */
START_TEST(the_energy_is_balanced_by_the_heat)
{
  const double q[] = {1, -0.5, 2}, p[] = {0, 1, 0};
  noisy_oscillators noisy;
  double defect;
  make_noisy(3, m, k, 1, bath, &noisy);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "langevin:scheme=ovio,degree=2", .balances = 1};
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create_with(noisy.system, &options, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  advance(integrator, 0.2, 1000);
  ck_assert_double_gt(fabs(dvi_integrator_supplied(integrator, 0)), 0.1);
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
  ck_assert_double_eq_tol(defect, 0, 1e-12);
  /* the branch of a step is judged between its meetings with the bath, and not one was followed */
  ck_assert_int_eq(read_counters(integrator).followed, 0);
  dvi_integrator_destroy(&integrator);
  destroy_noisy(&noisy);
}
END_TEST

static void check_refusal(const dvi_system *system, const char *method, dvi_status status,
                          const char *words)
{
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(system, method, &integrator), status);
  ck_assert_ptr_null(integrator);
  check_words(words);
}

static int drag(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  F[0] = -v[0];
  return 0;
}

START_TEST(options_and_systems_that_do_not_go_together_are_refused)
{
  const double negative[] = {1, -1};
  const dvi_force force = {.name = "drag", .value = drag};
  dvi_system *dragged = NULL, *indefinite = NULL, *still = NULL;
  dvi_system_terms terms = {.dimension = 1,
                            .mass.scalar = 1,
                            .noise = &bath,
                            .autonomous = 1,
                            .forces = &force,
                            .force_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &dragged), DVI_OK);
  check_refusal(dragged, "langevin", DVI_UNSUPPORTED, "choose scheme=ovio");
  check_refusal(dragged, "langevin:degree=3", DVI_BAD_OPTION, "degree=3 is for galerkin");
  check_refusal(dragged, "langevin:scheme=ovio,degree=3,nodes=2", DVI_BAD_OPTION, "nodes");
  check_refusal(dragged, "langevin:scheme=gla", DVI_BAD_OPTION, "baoab, obabo, ovio");
  check_refusal(dragged, "composition:base=langevin", DVI_BAD_OPTION, "langevin");
  dvi_integrator *integrator = create_integrator(dragged, "langevin:scheme=ovio");
  dvi_integrator_destroy(&integrator);
  terms = (dvi_system_terms){.dimension = 2, .mass.diagonal = negative, .noise = &bath};
  ck_assert_int_eq(dvi_system_create(&terms, &indefinite), DVI_OK);
  check_refusal(indefinite, "langevin", DVI_SINGULAR, "that of coordinate 1 is -1");
  terms.noise = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &still), DVI_OK);
  check_refusal(still, "langevin", DVI_UNSUPPORTED, "needs noise");
  dvi_system_destroy(&dragged);
  dvi_system_destroy(&indefinite);
  dvi_system_destroy(&still);
}
END_TEST

START_TEST(steps_back_in_time_are_refused_and_leave_the_state)
{
  static const char *const methods[] = {"langevin", "langevin:scheme=obabo",
                                        "langevin:scheme=ovio"};
  const double q = 1, p = 1;
  noisy_oscillators noisy;
  make_noisy(1, m, k, 0, bath, &noisy);
  for (int i = 0; i < 3; i++) {
    dvi_integrator *integrator = create_integrator(noisy.system, methods[i]);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(integrator, -0.1), DVI_BAD_ARGUMENT);
    check_words("no steps back in time");
    ck_assert_double_eq(dvi_integrator_q(integrator)[0], q);
    ck_assert_double_eq(dvi_integrator_p(integrator)[0], p);
    dvi_integrator_destroy(&integrator);
  }
  destroy_noisy(&noisy);
}
END_TEST

SUITE(langevin)
{
  tcase_add_test(tests, averages_of_the_harmonic_oscillator_are_those_of_theory);
  tcase_add_test(tests, the_stationary_error_of_ovio_has_the_order_of_galerkin);
  tcase_add_test(tests, a_mass_that_is_not_diagonal_gives_its_covariance);
  tcase_add_test(tests, without_friction_steps_are_those_of_verlet_and_galerkin);
  tcase_add_test(tests, explicit_schemes_cost_one_gradient_a_step_and_nothing_else);
  tcase_add_test(tests, the_path_of_a_step_leads_from_end_to_end);
  tcase_add_loop_test(tests, paths_converge_with_order_1, 0, 4);
  tcase_add_test(tests, the_energy_is_balanced_by_the_heat);
  tcase_add_test(tests, options_and_systems_that_do_not_go_together_are_refused);
  tcase_add_test(tests, steps_back_in_time_are_refused_and_leave_the_state);
}
