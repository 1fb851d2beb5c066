/* labels: reference */
/* Whole paths against steps, against known orbits and against Morse's theory of the second
 * variation. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { NODES_MOST = 401, ROOM = NODES_MOST * 8 };

static const double pi = 3.14159265358979324;

/* The nodes of a run, point after point. */
typedef struct run {
  int n, steps;
  double span, t[NODES_MOST], q[ROOM], p[ROOM];
} run;

static void keep(run *r, int k, const dvi_integrator *integrator)
{
  r->t[k] = k * (r->span / r->steps);
  memcpy(r->q + (size_t)k * (size_t)r->n, dvi_integrator_q(integrator),
         (size_t)r->n * sizeof(double));
  memcpy(r->p + (size_t)k * (size_t)r->n, dvi_integrator_p(integrator),
         (size_t)r->n * sizeof(double));
}

static void record_run(const dvi_system *system, const double *q, const double *p,
                       const char *method, double span, int steps, run *r)
{
  *r = (run){.n = dvi_system_nq(system), .steps = steps, .span = span};
  ck_assert((steps + 1) * r->n <= ROOM);
  dvi_integrator *stepped = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(stepped, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  keep(r, 0, stepped);
  for (int k = 1; k <= steps; k++) {
    advance(stepped, span / steps, 1);
    keep(r, k, stepped);
  }
  dvi_integrator_destroy(&stepped);
}

static dvi_path *create_path(const dvi_system *system, const char *method,
                             const dvi_path_options *options)
{
  dvi_path *path = NULL;
  ck_assert_msg(dvi_path_create(system, method, options, &path) == DVI_OK, "%s", dvi_last_error());
  return path;
}

static dvi_path_report solve_path(dvi_path *path)
{
  dvi_path_report report;
  ck_assert_msg(dvi_path_solve(path, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(report.gradient < 1e-12, "gradient %g", report.gradient);
  return report;
}

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

/* ---- periodic ends ---- */

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
  tcase_add_loop_test(tests, a_two_point_problem_finds_the_run_between_its_ends, 0, PLACES);
  tcase_add_loop_test(tests, an_initial_value_problem_as_one_system_is_the_run, 0, PLACES);
  tcase_add_test(tests, time_dependent_systems_have_paths);
  tcase_add_test(tests, the_index_counts_conjugate_points);
  tcase_add_test(tests, paths_of_one_problem_are_told_apart_by_their_guess);
  tcase_add_test(tests, the_figure_eight_comes_from_three_points);
  tcase_add_test(tests, an_energy_has_its_period);
  tcase_add_test(tests, a_nearly_periodic_run_closes_to_roundoff);
  tcase_add_test(tests, long_steps_choose_their_time);
  tcase_add_test(tests, steps_that_do_not_resolve_a_symmetry_have_no_index);
  tcase_add_test(tests, a_pendulum_that_turns_over_is_periodic_up_to_a_shift);
  tcase_add_test(tests, a_circle_is_relatively_periodic);
  tcase_add_test(tests, a_driven_oscillator_follows_its_drive);
  tcase_add_test(tests, a_guess_along_two_paths_is_better_than_the_last_one);
}
