/* labels: reference */
/* Paths with periodic ends: closed orbits, up to a symmetry or not, with a given period or a given
 * energy. */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "path_runs.h"

static const double exchange[] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0,
                                  0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0};

/* Gives three points of each body on x = sin, y = 0.4 sin 2, rounded to one digit, a third of the
 * figure, body after body. */
static const double sketch_t[] = {0, 1, 2};
static const double sketch[] = {0, 0,    0.9,  -0.3, -0.9, 0.3,  0.9, 0.3, 0,
                                0, -0.9, -0.3, 0.9,  -0.3, -0.9, 0.3, 0,   0};

/* Action and energy as printed by an earlier, separate implementation for T = 6.32591398; the orbit
 * of Chenciner and Montgomery (2000). */
static const double eight_period = 6.32591398, eight_action = 24.4270486407709,
                    eight_energy = -1.28714199602879;

/* Steps of the method from the path's first state must come back to it. The orbit is stable, and
 * roundoff grows slowly. */
static void check_closes(const problem *model, const char *method, const dvi_path *path,
                         const double *turn)
{
  static run r;
  const int n = model->nq, steps = dvi_path_steps(path);
  double q[8] = {0}, p[8] = {0};
  record_run(model->system, dvi_path_q(path, 0), dvi_path_p(path, 0), method,
             dvi_path_time(path, steps) - dvi_path_time(path, 0), steps, &r);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double entry = turn != NULL ? turn[j * n + i] : i == j;
      q[i] += entry * r.q[j];
      p[i] += entry * r.p[j];
    }
  ck_assert_double_lt(distance(n, r.q + steps * n, q), 1e-13);
  ck_assert_double_lt(distance(n, r.p + steps * n, p), 1e-12);
}

START_TEST(the_figure_eight_comes_from_three_points)
{
  const char *method = "galerkin:degree=8";
  problem *model = create_problem("figure-eight", NULL);
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                    .steps = 10,
                                    .span = eight_period / 3,
                                    .dimension = 6,
                                    .symmetry = exchange};
  dvi_path *path = create_path(model->system, method, &options);
  ck_assert_int_eq(dvi_path_guess(path, 3, 6, sketch_t, sketch), DVI_OK);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_lt(report.gradient, 2e-14);
  ck_assert_double_eq_tol(3 * report.action, eight_action, 1e-11);
  ck_assert_double_eq_tol(report.energy, eight_energy, 1e-11);
  /* The path is a minimum among choreographies. It may be moved in the plane, rotated, and shifted
   * in time. */
  ck_assert_int_eq(report.negative, 0);
  ck_assert_int_eq(report.zero, 4);
  ck_assert_int_eq(report.symmetries, 4);
  check_closes(model, method, path, exchange);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

START_TEST(an_energy_has_its_period)
{
  problem *model = create_problem("figure-eight", NULL);
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                    .steps = 10,
                                    .span = 2.3,
                                    .dimension = 6,
                                    .symmetry = exchange,
                                    .free_span = 1,
                                    .energy = eight_energy};
  dvi_path *path = create_path(model->system, "galerkin:degree=8", &options);
  ck_assert_int_eq(dvi_path_guess(path, 3, 6, sketch_t, sketch), DVI_OK);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_eq_tol(3 * report.span, eight_period, 1e-11);
  ck_assert_double_eq_tol(report.energy, eight_energy, 1e-14);
  ck_assert(dvi_path_time(path, 10) == report.span);
  /* From itself it goes nowhere. */
  const double before = dvi_path_q(path, 3)[0];
  const dvi_path_report again = solve_path(path);
  ck_assert_double_eq_tol(dvi_path_q(path, 3)[0], before, 1e-14);
  ck_assert_double_eq_tol(again.span, report.span, 1e-14);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* The whole loop from the catalogue's start, which closes to 3e-8. */
START_TEST(a_nearly_periodic_run_closes_to_roundoff)
{
  static run r;
  const char *method = "galerkin:degree=8";
  problem *model = create_problem("figure-eight", NULL);
  record_run(model->system, model->q, model->p, method, eight_period, 24, &r);
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC, .steps = 24, .span = eight_period};
  dvi_path *path = create_path(model->system, method, &options);
  ck_assert_int_eq(dvi_path_guess(path, 25, 6, r.t, r.q), DVI_OK);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_lt(report.gradient, 2e-14);
  ck_assert_double_eq_tol(report.action, eight_action, 1e-12);
  ck_assert_double_eq_tol(report.energy, eight_energy, 1e-13);
  ck_assert_int_eq(report.zero, 4);
  check_closes(model, method, path, NULL);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* 12 steps of order 8 make the discrete motion prefer some times. Held at another one, it keeps
 * 7e-9 of the gradient. */
START_TEST(long_steps_choose_their_time)
{
  static run r;
  const char *method = "galerkin:degree=4";
  problem *model = create_problem("figure-eight", NULL);
  record_run(model->system, model->q, model->p, method, eight_period, 12, &r);
  dvi_path *path = create_path(
      model->system, method,
      &(dvi_path_options){.ends = DVI_ENDS_PERIODIC, .steps = 12, .span = eight_period});
  ck_assert_int_eq(dvi_path_guess(path, 13, 6, r.t, r.q), DVI_OK);
  ck_assert_double_lt(solve_path(path).gradient, 1e-13);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* Few steps move the zero of time to either side of 0. */
START_TEST(steps_that_do_not_resolve_a_symmetry_have_no_index)
{
  static run r;
  const int steps[] = {8, 30};
  problem *model = create_problem("pendulum", NULL);
  for (int k = 0; k < 2; k++) {
    record_run(model->system, model->q, model->p, "midpoint", 7, steps[k], &r);
    dvi_path *path = create_path(
        model->system, "midpoint",
        &(dvi_path_options){.ends = DVI_ENDS_PERIODIC, .steps = steps[k], .span = 7});
    ck_assert_int_eq(dvi_path_guess(path, steps[k] + 1, 1, r.t, r.q), DVI_OK);
    const dvi_path_report report = solve_path(path);
    ck_assert_int_eq(report.symmetries, 1);
    ck_assert_int_eq(report.zero, k);
    ck_assert_int_eq(report.negative, k == 0 ? -1 : 1);
    dvi_path_destroy(&path);
  }
  problem_destroy(&model);
}
END_TEST

/* q_N = q_0 + 2 pi, so the pendulum turns over. Its period with energy E = 2, by the
 * arithmetic-geometric mean, is T = 2 pi / agm(sqrt(2 (E+1)), sqrt(2 (E-1))). */
START_TEST(a_pendulum_that_turns_over_is_periodic_up_to_a_shift)
{
  const double shift[] = {2 * pi}, t[] = {0, 1}, line[] = {0.3, 0.3 + 2 * pi};
  double a = sqrt(6), g = sqrt(2);
  for (int k = 0; k < 8; k++) {
    const double mean = (a + g) / 2;
    g = sqrt(a * g);
    a = mean;
  }
  problem *model = create_problem("pendulum", NULL);
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                    .steps = 20,
                                    .span = 3,
                                    .dimension = 1,
                                    .shift = shift,
                                    .free_span = 1,
                                    .energy = 2};
  dvi_path *path = create_path(model->system, "galerkin:degree=8", &options);
  ck_assert_int_eq(dvi_path_guess(path, 2, 1, t, line), DVI_OK);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_eq_tol(report.span, 2 * pi / a, 1e-11);
  ck_assert_double_eq_tol(dvi_path_q(path, 20)[0] - dvi_path_q(path, 0)[0], 2 * pi, 1e-15);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* A circle rotated by any angle is the same circle. Time and rotation move it in one direction. */
START_TEST(a_circle_is_relatively_periodic)
{
  const double turn[] = {cos(1), sin(1), -sin(1), cos(1)}, t[] = {0, 0.5, 1},
               q[] = {1.1, 0, 0.8, 0.5, 0.5, 0.9};
  problem *model = create_problem("kepler", "e=0");
  const dvi_path_options options = {
      .ends = DVI_ENDS_PERIODIC, .steps = 5, .span = 1, .dimension = 2, .symmetry = turn};
  dvi_path *path = create_path(model->system, "galerkin:degree=6", &options);
  ck_assert_int_eq(dvi_path_guess(path, 3, 2, t, q), DVI_OK);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_eq_tol(report.action, 1.5, 1e-12);
  ck_assert_double_eq_tol(report.energy, -0.5, 1e-11);
  for (int k = 0; k <= 5; k++)
    ck_assert_double_eq_tol(hypot(dvi_path_q(path, k)[0], dvi_path_q(path, k)[1]), 1, 1e-12);
  check_closes(model, "galerkin:degree=6", path, turn);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* With V = q^2/2 - q cos 2t the equation q'' + q = cos 2t has the solution -cos(2t)/3 of the
 * drive's period, and no other. */
static int swing(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = q[0] * q[0] / 2 - q[0] * cos(2 * t);
  return 0;
}

static int push(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  V_q[0] = q[0] - cos(2 * t);
  return 0;
}

START_TEST(a_driven_oscillator_follows_its_drive)
{
  const dvi_potential potential = {.value = swing, .gradient = push};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  const dvi_path_options options = {
      .ends = DVI_ENDS_PERIODIC, .steps = 12, .start = 0.4, .span = pi};
  dvi_path *path = create_path(system, "galerkin:degree=6", &options);
  const dvi_path_report report = solve_path(path);
  for (int k = 0; k <= 12; k++)
    ck_assert_double_eq_tol(dvi_path_q(path, k)[0], -cos(2 * dvi_path_time(path, k)) / 3, 1e-11);
  dvi_path_destroy(&path);
  path = create_path(system, "galerkin:degree=6",
                     &(dvi_path_options){.ends = DVI_ENDS_PERIODIC, .steps = 12, .span = 3});
  ck_assert_int_eq(dvi_path_guess(path, 2, 1, (const double[]){0, 1}, (const double[]){0.3, 0.3}),
                   DVI_OK);
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_BAD_ARGUMENT);
  check_words("the period is none of the Lagrangian's");
  /* The modes cos(2 m t) and sin(2 m t) have (2m)^2 - 1, and the constant alone is negative. The
   * drive sets the phase. */
  ck_assert_int_eq(report.negative, 1);
  ck_assert_int_eq(report.zero, 0);
  ck_assert_int_eq(report.symmetries, 0);
  dvi_path_destroy(&path);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(path_periodic)
{
  tcase_add_test(tests, the_figure_eight_comes_from_three_points);
  tcase_add_test(tests, an_energy_has_its_period);
  tcase_add_test(tests, a_nearly_periodic_run_closes_to_roundoff);
  tcase_add_test(tests, long_steps_choose_their_time);
  tcase_add_test(tests, steps_that_do_not_resolve_a_symmetry_have_no_index);
  tcase_add_test(tests, a_pendulum_that_turns_over_is_periodic_up_to_a_shift);
  tcase_add_test(tests, a_circle_is_relatively_periodic);
  tcase_add_test(tests, a_driven_oscillator_follows_its_drive);
}
