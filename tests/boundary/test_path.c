/* labels: reference */
/* Whole paths against steps, against known orbits and against Morse's theory of the second
 * variation. */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "path_runs.h"

/* The largest differences in q and p, relative to the largest of each. */
static double distance_from_run(const dvi_path *path, const run *r)
{
  double worst = 0;
  const int all = (r->steps + 1) * r->n;
  for (int k = 0; k <= r->steps; k++) {
    worst = fmax(worst,
                 distance(r->n, dvi_path_q(path, k), r->q + k * r->n) / magnitude(all, r->q));
    worst = fmax(worst,
                 distance(r->n, dvi_path_p(path, k), r->p + k * r->n) / magnitude(all, r->p));
  }
  return worst;
}

/* ---- mixed ends ---- */

/* x begins at its place and ends with its momentum, y begins with its momentum and ends at its
 * place, as in the run from which these numbers are. */
START_TEST(mixed_ends_give_the_run)
{
  static const char *const methods[] = {"midpoint", "galerkin:degree=3"};
  static run r;
  problem *model = create_problem("kepler", "e=0.3");
  const char free0[] = {0, 1}, free1[] = {1, 0};
  const int steps = 30;
  record_run(model->system, model->q, model->p, methods[_i], 1.5, steps, &r);
  const dvi_path_options options = {.ends = DVI_ENDS_MIXED,
                                    .steps = steps,
                                    .span = 1.5,
                                    .dimension = 2,
                                    .q0 = r.q,
                                    .p0 = r.p,
                                    .q1 = r.q + 2 * steps,
                                    .p1 = r.p + 2 * steps,
                                    .free0 = free0,
                                    .free1 = free1};
  dvi_path *path = NULL;
  dvi_path_report report;
  ck_assert_msg(dvi_path_create(model->system, methods[_i], &options, &path) == DVI_OK, "%s",
                dvi_last_error());
  static double moved[ROOM];
  for (int i = 0; i < 2 * (steps + 1); i++) moved[i] = r.q[i] * (1 + 0.01 * sin(3 * i));
  ck_assert_int_eq(dvi_path_guess(path, steps + 1, 2, r.t, moved), DVI_OK);
  ck_assert_msg(dvi_path_solve(path, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_lt(distance_from_run(path, &r), 1e-12);
  ck_assert_int_eq(report.zero, 0);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* ---- fixed and initial ends ---- */

static const struct {
  const char *problem, *setting, *method;
  double span;
  /* 1 for the straight line, 0 for the run with each number moved by a per cent */
  int steps, rough;
} places[] = {
    {"pendulum", NULL, "midpoint", 2, 50, 1},
    {"pendulum", NULL, "trapezoidal", 2, 50, 1},
    {"pendulum", NULL, "galerkin:degree=4", 2, 5, 1},
    {"pendulum", NULL, "galerkin:degree=3,quadrature=lobatto,nodes=4", 8, 40, 0},
    {"kepler", "e=0.3", "galerkin:degree=4", 2, 20, 1},
    {"kepler", "e=0.6", "galerkin:degree=4", 2, 40, 1},
    {"kepler", "e=0.6", "galerkin:degree=5,basis=legendre,quadrature=radau-right", 5, 60, 0},
    {"kepler", "e=0.6", "midpoint", 2, 400, 1},
    {"double-pendulum", NULL, "galerkin:degree=3", 1, 20, 0},
    {"henon-heiles", NULL, "galerkin:degree=6,basis=chebyshev", 3, 10, 1},
    {"oscillator", NULL, "galerkin:degree=2", 20, 100, 1},
};
enum { PLACES = sizeof places / sizeof *places };

static void check_place(int index, dvi_ends ends)
{
  static run r;
  problem *model = create_problem(places[index].problem, places[index].setting);
  const int steps = places[index].steps, n = model->nq;
  record_run(model->system, model->q, model->p, places[index].method, places[index].span, steps,
             &r);
  const dvi_path_options options = {.ends = ends,
                                    .steps = steps,
                                    .span = places[index].span,
                                    .dimension = n,
                                    .q0 = r.q,
                                    .q1 = ends == DVI_ENDS_FIXED ? r.q + steps * n : NULL,
                                    .p0 = ends == DVI_ENDS_INITIAL ? r.p : NULL};
  dvi_path *path = create_path(model->system, places[index].method, &options);
  if (!places[index].rough || ends == DVI_ENDS_INITIAL) {
    static double moved[ROOM];
    for (int i = 0; i < (steps + 1) * n; i++) moved[i] = r.q[i] * (1 + 0.01 * sin(3 * i));
    ck_assert_int_eq(dvi_path_guess(path, steps + 1, n, r.t, moved), DVI_OK);
  }
  const dvi_path_report report = solve_path(path);
  /* Two-point problems and steps agree as far as both are at roundoff, which these spans multiply
   * by less than 1e3. */
  const double worst = distance_from_run(path, &r);
  ck_assert_msg(worst < 1e-12, "%s %s: %g", places[index].problem, places[index].method, worst);
  ck_assert_int_eq(report.negative < 0, ends == DVI_ENDS_INITIAL);
  ck_assert(dvi_path_time(path, steps) == places[index].span ||
            fabs(dvi_path_time(path, steps) / places[index].span - 1) < 1e-15);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}

START_TEST(a_two_point_problem_finds_the_run_between_its_ends)
{
  check_place(_i, DVI_ENDS_FIXED);
}
END_TEST

START_TEST(an_initial_value_problem_as_one_system_is_the_run)
{
  check_place(_i, DVI_ENDS_INITIAL);
}
END_TEST

/* Rotors have a general Lagrangian that depends on time, wells a potential that does. */
START_TEST(time_dependent_systems_have_paths)
{
  static run r;
  static behaviour quiet;
  const dvi_lagrangian lagrangian = rotors(&quiet, BATCH);
  const dvi_potential potential = wells(&quiet, BATCH);
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = SITES,
                                                       .lagrangian = &lagrangian,
                                                       .potentials = &potential,
                                                       .potential_count = 1});
  const double start = 0.5;
  r = (run){.n = SITES, .steps = 10, .span = 1};
  dvi_integrator *stepped = create_integrator(system, "galerkin:degree=3");
  ck_assert_int_eq(dvi_integrator_start_velocity(stepped, start, generic_q, generic_v), DVI_OK);
  keep(&r, 0, stepped);
  for (int k = 1; k <= r.steps; k++) {
    advance(stepped, 0.1, 1);
    keep(&r, k, stepped);
  }
  const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                    .steps = r.steps,
                                    .start = start,
                                    .span = r.span,
                                    .dimension = SITES,
                                    .q0 = r.q,
                                    .q1 = r.q + r.steps * SITES};
  dvi_path *path = create_path(system, "galerkin:degree=3", &options);
  const dvi_path_report report = solve_path(path);
  ck_assert_double_lt(distance_from_run(path, &r), 1e-12);
  ck_assert(isnan(report.energy));
  dvi_path_destroy(&path);
  dvi_integrator_destroy(&stepped);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- signs of the second variation ---- */

/* L = v^2/2 - q^2/4 has conjugate points at multiples of pi sqrt 2 = 4.44 (Morse). */
START_TEST(the_index_counts_conjugate_points)
{
  const double q0[] = {0}, q1[] = {1}, spans[] = {1, 4.4, 4.5, 8.8, 8.9, 13.3, 13.4, 38};
  const int conjugate[] = {0, 0, 1, 1, 2, 2, 3, 8};
  problem *model = create_problem("oscillator", NULL);
  for (int k = 0; k < 8; k++)
    for (int degree = 1; degree <= 4; degree++) {
      const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                        .steps = degree > 1 ? 40 : 400,
                                        .span = spans[k],
                                        .dimension = 1,
                                        .q0 = q0,
                                        .q1 = q1};
      dvi_path *path = create_path(model->system, method_spec("galerkin:degree=%d", degree),
                                   &options);
      const dvi_path_report report = solve_path(path);
      ck_assert_msg(report.negative == conjugate[k] && report.zero == 0,
                    "degree %d, span %g: %ld negative, %ld zero", degree, spans[k], report.negative,
                    report.zero);
      dvi_path_destroy(&path);
    }
  problem_destroy(&model);
}
END_TEST

/* From (1,0) to (0,1) in the time of three quarters of the unit circle. That circle, clockwise, has
 * L = 1/2 + 1. Counterclockwise there is an ellipse, whose far end lies between. Both are minima,
 * because a path in the plane cannot cross the centre to become the other. */
START_TEST(paths_of_one_problem_are_told_apart_by_their_guess)
{
  enum { POINTS = 13 };
  const double q0[] = {1, 0}, q1[] = {0, 1}, there[] = {1, 0, 1.2, 1.2, 0, 1};
  double t[POINTS], round[2 * POINTS];
  for (int k = 0; k < POINTS; k++) {
    t[k] = k;
    round[2 * k] = 0.9 * cos(pi * k / 8);
    round[2 * k + 1] = -0.9 * sin(pi * k / 8);
  }
  problem *model = create_problem("kepler", NULL);
  const dvi_path_options options = {
      .ends = DVI_ENDS_FIXED, .steps = 40, .span = 1.5 * pi, .dimension = 2, .q0 = q0, .q1 = q1};
  dvi_path *path = create_path(model->system, "galerkin:degree=4", &options);
  ck_assert_int_eq(dvi_path_guess(path, POINTS, 2, t, round), DVI_OK);
  dvi_path_report report = solve_path(path);
  ck_assert_double_eq_tol(report.action, 2.25 * pi, 1e-11);
  ck_assert_double_lt(dvi_path_q(path, 20)[0], 0);
  ck_assert_int_eq(report.negative, 0);
  ck_assert_int_eq(dvi_path_guess(path, 3, 2, t, there), DVI_OK);
  report = solve_path(path);
  ck_assert_double_gt(dvi_path_q(path, 20)[0], 1);
  ck_assert_int_eq(report.negative, 0);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* ---- continuation ---- */

static double path_distance(const dvi_path *a, const dvi_path *b)
{
  double worst = 0;
  for (int k = 0; k <= dvi_path_steps(a); k++)
    worst = fmax(worst, distance(2, dvi_path_q(a, k), dvi_path_q(b, k)));
  return worst;
}

/* The tangent's prediction errs by the square of the step, the last path by the step. */
START_TEST(a_guess_along_two_paths_is_better_than_the_last_one)
{
  problem *model[3];
  dvi_path *path[3];
  for (int k = 0; k < 3; k++) {
    model[k] = create_problem("kepler", method_spec("e=%g", 0.3 + 0.02 * k));
    const dvi_path_options options = {.ends = DVI_ENDS_INITIAL,
                                      .steps = 20,
                                      .span = 2,
                                      .dimension = 2,
                                      .q0 = model[k]->q,
                                      .p0 = model[k]->p};
    path[k] = create_path(model[k]->system, "galerkin:degree=3", &options);
    if (k > 0)
      ck_assert_int_eq(dvi_path_guess_along(path[k], path[k - 1], k > 1 ? path[k - 2] : NULL, 1),
                       DVI_OK);
    if (k < 2) (void)solve_path(path[k]);
  }
  dvi_path *last = create_path(model[2]->system, "galerkin:degree=3",
                               &(dvi_path_options){.ends = DVI_ENDS_INITIAL,
                                                   .steps = 20,
                                                   .span = 2,
                                                   .dimension = 2,
                                                   .q0 = model[2]->q,
                                                   .p0 = model[2]->p});
  ck_assert_int_eq(dvi_path_guess_along(last, path[1], NULL, 1), DVI_OK);
  (void)solve_path(last);
  ck_assert_double_gt(path_distance(path[1], last), 0.01);
  ck_assert_double_lt(path_distance(path[2], last), 0.1 * path_distance(path[1], last));
  (void)solve_path(path[2]);
  ck_assert_double_lt(path_distance(path[2], last), 1e-13);
  dvi_path_destroy(&last);
  for (int k = 0; k < 3; k++) {
    dvi_path_destroy(&path[k]);
    problem_destroy(&model[k]);
  }
}
END_TEST

SUITE(path)
{
  tcase_add_loop_test(tests, mixed_ends_give_the_run, 0, 2);
  tcase_add_loop_test(tests, a_two_point_problem_finds_the_run_between_its_ends, 0, PLACES);
  tcase_add_loop_test(tests, an_initial_value_problem_as_one_system_is_the_run, 0, PLACES);
  tcase_add_test(tests, time_dependent_systems_have_paths);
  tcase_add_test(tests, the_index_counts_conjugate_points);
  tcase_add_test(tests, paths_of_one_problem_are_told_apart_by_their_guess);
  tcase_add_test(tests, a_guess_along_two_paths_is_better_than_the_last_one);
}
