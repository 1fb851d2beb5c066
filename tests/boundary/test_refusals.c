/* labels: unit */
/* Options that cannot be solved are refused with a sentence that gives the reason, and the path
 * stays as it was. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

static problem *kepler;
static const double first[] = {1, 0}, last[] = {0, 1};
static const dvi_path_options good = {
    .ends = DVI_ENDS_FIXED, .steps = 10, .span = 1, .dimension = 2, .q0 = first, .q1 = last};

static void set_up(void)
{
  kepler = create_problem("kepler", NULL);
}

static void tear_down(void)
{
  problem_destroy(&kepler);
}

static void refused(dvi_path_options options, const char *method, dvi_status expected,
                    const char *words)
{
  dvi_path *path = (dvi_path *)&options; /* must become NULL */
  const dvi_status status = dvi_path_create(kepler->system, method, &options, &path);
  ck_assert_msg(status == expected, "%s: %s", dvi_status_name(status), dvi_last_error());
  ck_assert_ptr_null(path);
  check_words(words);
}

static dvi_path *create_path(dvi_path_options options)
{
  dvi_path *path = NULL;
  ck_assert_msg(dvi_path_create(kepler->system, "galerkin:degree=8", &options, &path) == DVI_OK,
                "%s", dvi_last_error());
  return path;
}

START_TEST(spans_are_positive_times)
{
  const double bad[] = {0, -1, NAN, INFINITY, -0.0};
  for (int k = 0; k < 5; k++) {
    dvi_path_options options = good;
    options.span = bad[k];
    refused(options, "midpoint", DVI_BAD_ARGUMENT, "is not a positive time");
    refused((dvi_path_options){.ends = DVI_ENDS_PERIODIC, .steps = 3, .span = bad[k]}, "midpoint",
            DVI_BAD_ARGUMENT, "period");
  }
  dvi_path_options options = good;
  options.start = NAN;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "is no time");
  options.start = 1e20;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "too short for the clock");
}
END_TEST

START_TEST(mixed_ends_need_all_numbers)
{
  dvi_path_options options = good;
  options.free1 = "\1";
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "coordinates are free");
  options.free1 = NULL;
  options.p1 = last;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "the last momentum p1 is given");
  options.ends = DVI_ENDS_MIXED;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "the first momentum p0 is missing");
}
END_TEST

START_TEST(steps_can_be_counted)
{
  dvi_path_options options = good;
  const int bad[] = {0, -3};
  for (int k = 0; k < 2; k++) {
    options.steps = bad[k];
    refused(options, "midpoint", DVI_BAD_SIZE, "at least 1 is needed");
  }
  options.steps = 1;
  refused(options, "midpoint", DVI_BAD_SIZE, "nothing to vary");
  options.steps = 0x7fffffff;
  refused(options, "midpoint", DVI_BAD_SIZE, "more than an int can count");
}
END_TEST

START_TEST(entries_can_be_counted)
{
  dvi_path_options options = good;
  options.steps = 1000000;
  refused(options, "galerkin:degree=30", DVI_BAD_SIZE, "entries in the Jacobian");
}
END_TEST

START_TEST(one_step_of_degree_two_has_something_to_vary)
{
  dvi_path_options options = good;
  options.steps = 1;
  dvi_path *path = create_path(options);
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_OK);
  dvi_path_destroy(&path);
}
END_TEST

START_TEST(ends_have_what_they_need_and_no_more)
{
  const double nowhere[] = {0, NAN};
  const int pair[] = {0, 1, 2};
  dvi_path_options options = good;
  options.dimension = 3;
  refused(options, "midpoint", DVI_BAD_SIZE, "the ends have 3 coordinates, the system 2");
  options = good;
  options.q0 = NULL;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "the first node q0 is missing");
  options = good;
  options.q1 = NULL;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "the last node q1 is missing");
  options.q1 = nowhere;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "number 1 of the last node q1 is nan");
  options = good;
  options.p0 = last;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "the first momentum p0 is given");
  options = good;
  options.symmetry_pattern = (dvi_pattern){pair, pair};
  refused(options, "midpoint", DVI_BAD_ARGUMENT,
          "a pattern of the symmetry is given, but no symmetry");
  options = good;
  options.energy = -0.5;
  refused(options, "midpoint", DVI_BAD_ARGUMENT,
          "the energy -0.5 is given, but the period is not free");
  options = good;
  options.symmetry = last;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "only periodic ends");
  options = good;
  options.ends = DVI_ENDS_INITIAL;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "q1 is given");
  options.ends = (dvi_ends)0;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "unknown ends 0");
  options.ends = DVI_ENDS_PERIODIC;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "q0 is given");
}
END_TEST

START_TEST(a_free_period_is_for_closed_paths_of_autonomous_systems)
{
  static behaviour quiet;
  dvi_path *path = NULL;
  dvi_path_options options = good;
  options.free_span = 1;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "only periodic ends can have a free period");
  options = (dvi_path_options){
      .ends = DVI_ENDS_PERIODIC, .steps = 9, .span = 1, .free_span = 1, .energy = NAN};
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "energy nan");
  options.energy = 1;
  const dvi_potential potential = wells(&quiet, BATCH);
  dvi_system *driven = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
  ck_assert_int_eq(dvi_path_create(driven, "midpoint", &options, &path), DVI_BAD_ARGUMENT);
  check_words("declared autonomous");
  dvi_system_destroy(&driven);
}
END_TEST

START_TEST(methods_are_elements_of_an_action)
{
  refused(good, "verlet", DVI_BAD_OPTION, "verlet is no discrete action with a polynomial path");
  refused(good, "composition", DVI_BAD_OPTION,
          "galerkin, midpoint, trapezoidal, and hp and hamiltonian of types 1 to 3 are");
  refused(good, "sem", DVI_BAD_OPTION, "sem is no discrete action");
  refused(good, "galerkin:solver=newton", DVI_BAD_OPTION, "solver=newton is for steps");
  refused(good, "galerkin:degree=0", DVI_BAD_OPTION, "degree=0");
  refused(good, "galileo", DVI_BAD_OPTION, "unknown method 'galileo'");
}
END_TEST

START_TEST(nothing_is_made_of_nothing)
{
  dvi_path *path = NULL;
  dvi_counters counters = {.steps = 1};
  ck_assert_int_eq(dvi_path_create(kepler->system, "midpoint", &good, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_create(NULL, "midpoint", &good, &path), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_create(kepler->system, NULL, &good, &path), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_create(kepler->system, "midpoint", NULL, &path), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_solve(NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_guess(NULL, 2, 2, first, first), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_guess_along(NULL, NULL, NULL, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_path_steps(NULL), 0);
  ck_assert(isnan(dvi_path_time(NULL, 0)));
  ck_assert_ptr_null(dvi_path_q(NULL, 0));
  ck_assert_ptr_null(dvi_path_p(NULL, 0));
  ck_assert_ptr_null(dvi_path_method(NULL));
  dvi_path_counters(NULL, &counters);
  ck_assert_int_eq(counters.steps, 0);
  dvi_path_destroy(&path);
  dvi_path_destroy(NULL);
}
END_TEST

START_TEST(nodes_are_numbered_from_0_to_N)
{
  dvi_path *path = create_path(good);
  ck_assert_int_eq(dvi_path_steps(path), 10);
  ck_assert_ptr_null(dvi_path_q(path, -1));
  ck_assert_ptr_null(dvi_path_q(path, 11));
  ck_assert(isnan(dvi_path_time(path, 11)));
  ck_assert_double_eq_tol(dvi_path_q(path, 5)[0], 0.5, 1e-15);
  ck_assert_ptr_null(dvi_path_p(path, 0)); /* a guess has no momenta */
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_OK);
  ck_assert_ptr_nonnull(dvi_path_p(path, 10));
  ck_assert_ptr_null(dvi_path_p(path, 11));
  dvi_path_destroy(&path);
}
END_TEST

START_TEST(guesses_are_points_in_the_order_of_time)
{
  const double t[] = {0, 1, 1}, late[] = {0, 1, NAN}, q[] = {1, 0, 0.7, 0.7, 0, 1},
               hole[] = {1, 0, 0.7, INFINITY, 0, 1};
  dvi_path *path = create_path(good), *longer;
  dvi_path_options options = good;
  ck_assert_int_eq(dvi_path_guess(path, 3, 2, t, q), DVI_BAD_ARGUMENT);
  check_words("not ascending (1 after 1)");
  ck_assert_int_eq(dvi_path_guess(path, 3, 2, late, q), DVI_BAD_ARGUMENT);
  check_words("point 2 of the guess has the time nan");
  ck_assert_int_eq(dvi_path_guess(path, 2, 2, t, hole), DVI_BAD_ARGUMENT);
  check_words("point 1 of the guess has the coordinate inf");
  ck_assert_int_eq(dvi_path_guess(path, 1, 2, t, q), DVI_BAD_SIZE);
  check_words("1 points");
  ck_assert_int_eq(dvi_path_guess(path, 2, 3, t, q), DVI_BAD_SIZE);
  check_words("the guess has 3 coordinates, the system 2");
  ck_assert_int_eq(dvi_path_guess(path, 2, 2, NULL, q), DVI_BAD_ARGUMENT);
  options.steps = 11;
  longer = create_path(options);
  ck_assert_int_eq(dvi_path_guess_along(path, longer, NULL, 1), DVI_BAD_SIZE);
  ck_assert_int_eq(dvi_path_guess_along(path, path, longer, 1), DVI_BAD_SIZE);
  check_words("another dimension, degree, number of steps or kind of ends");
  ck_assert_int_eq(dvi_path_guess_along(path, path, path, NAN), DVI_BAD_ARGUMENT);
  ck_assert_double_eq_tol(dvi_path_q(path, 5)[0], 0.5, 1e-15);
  dvi_path_destroy(&path);
  dvi_path_destroy(&longer);
}
END_TEST

/* ---- problems without a solution ---- */

/* A solve that fails, and leaves nodes, momenta and report. */
static void unsolvable(const dvi_system *system, dvi_path_options options, dvi_status expected,
                       const char *words)
{
  dvi_path *path = NULL;
  dvi_path_report report = {.iterations = -7};
  ck_assert_msg(dvi_path_create(system, "galerkin:degree=4", &options, &path) == DVI_OK, "%s",
                dvi_last_error());
  const double before = dvi_path_q(path, options.steps / 2)[0];
  const dvi_status status = dvi_path_solve(path, &report);
  ck_assert_msg(status == expected, "%s: %s", dvi_status_name(status), dvi_last_error());
  check_words(words);
  check_words("the path is unchanged; try");
  ck_assert(dvi_path_q(path, options.steps / 2)[0] == before);
  ck_assert_ptr_null(dvi_path_p(path, 0));
  ck_assert_int_eq(report.iterations, -7);
  dvi_path_destroy(&path);
}

/* In half a period all paths from 0 come to 0 (many), none to 1, and many lead from q0 to -q0. */
START_TEST(conjugate_ends_are_named)
{
  const double from[] = {0, 0, 0.5}, to[] = {0, 1, -0.5};
  problem *model = create_problem("oscillator", NULL);
  for (int k = 0; k < 3; k++) {
    const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                      .steps = 20,
                                      .span = 4.44288293815836625,
                                      .dimension = 1,
                                      .q0 = from + k,
                                      .q1 = to + k};
    unsolvable(model->system, options, DVI_SINGULAR, "its ends are conjugate");
  }
  problem_destroy(&model);
}
END_TEST

/* Through the centre, where the quadrature of any number of steps has no node. */
START_TEST(a_path_through_the_centre_is_none)
{
  const double q0[] = {1, 0}, q1[] = {-1, 0};
  for (int steps = 20; steps <= 21; steps++) {
    const dvi_path_options options = {
        .ends = DVI_ENDS_FIXED, .steps = steps, .span = 0.1, .dimension = 2, .q0 = q0, .q1 = q1};
    unsolvable(kepler->system, options, DVI_NOT_CONVERGED, "goes through a singularity");
  }
}
END_TEST

/* The oscillator's periods are all 8.886. */
START_TEST(a_period_that_no_path_has_is_named)
{
  static const double t[] = {0, 1, 2}, q[] = {1, -1, 1};
  problem *model = create_problem("oscillator", NULL);
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC, .steps = 20, .span = 7};
  dvi_path *path = NULL;
  ck_assert_int_eq(dvi_path_create(model->system, "galerkin:degree=4", &options, &path), DVI_OK);
  ck_assert_int_eq(dvi_path_guess(path, 3, 1, t, q), DVI_OK);
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_NOT_CONVERGED);
  check_words("no path of this period");
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

/* All of Kepler's ellipses have one period, so each is one of a family that no declared symmetry
 * explains. Steps of a low order give each a slightly different period. */
START_TEST(a_family_of_closed_paths_is_named)
{
  static const struct {
    const char *method;
    dvi_status expected;
    const char *words;
  } cases[] = {{"galerkin:degree=8", DVI_SINGULAR, "not isolated"},
               {"galerkin:degree=4", DVI_NOT_CONVERGED,
                "many have it, which 40 steps tell apart by too little"}};
  double t[41], q[82], p[2];
  for (int k = 0; k <= 40; k++) {
    t[k] = 2 * 3.14159265358979324 * k / 40;
    ck_assert_int_eq(kepler->exact(kepler, t[k], q + 2 * k, p), 0);
  }
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC, .steps = 40, .span = t[40]};
  for (int m = 0; m < 2; m++) {
    dvi_path *path = NULL;
    ck_assert_int_eq(dvi_path_create(kepler->system, cases[m].method, &options, &path), DVI_OK);
    ck_assert_int_eq(dvi_path_guess(path, 41, 2, t, q), DVI_OK);
    const dvi_status status = dvi_path_solve(path, NULL);
    ck_assert_msg(status == cases[m].expected, "%s: %s", dvi_status_name(status), dvi_last_error());
    check_words(cases[m].words);
    dvi_path_destroy(&path);
  }
}
END_TEST

START_TEST(what_the_lagrangian_does_not_have_is_no_symmetry)
{
  const double stretch[] = {2, 0, 0, 2}, nothing[] = {NAN, 0, 0, 1}, t[] = {0, 1, 2},
               q[] = {1, 0, 0, 1, -1, 0};
  dvi_path_options options = {
      .ends = DVI_ENDS_PERIODIC, .steps = 20, .span = 6, .dimension = 2, .symmetry = stretch};
  dvi_path *path = create_path(options);
  ck_assert_int_eq(dvi_path_guess(path, 3, 2, t, q), DVI_OK);
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_BAD_ARGUMENT);
  check_words("the symmetry is none of the Lagrangian's");
  dvi_path_destroy(&path);
  options.symmetry = nothing;
  refused(options, "midpoint", DVI_BAD_ARGUMENT, "entry 0 of the symmetry is nan");
}
END_TEST

/* V = q^2/2 - q f. At the guess, at rest in 0, V vanishes for any f. `user` is the frequency of f =
 * cos, or 0. */
static int pushed_value(double t, const double *q, double *value, void *user)
{
  *value = q[0] * q[0] / 2 - q[0] * cos(*(const double *)user * t);
  return 0;
}

static int pushed_gradient(double t, const double *q, double *gradient, void *user)
{
  gradient[0] = q[0] - cos(*(const double *)user * t);
  return 0;
}

/* A period of 6 under a drive of 8.976, and a mirror that turns a constant push round. */
START_TEST(a_path_at_rest_hides_no_force)
{
  static const double mirror[] = {-1};
  double frequency[] = {0.7, 0};
  const char *const words[] = {"the period is none of the Lagrangian's: it changes L_q",
                               "the symmetry is none of the Lagrangian's: it changes L_q"};
  for (int k = 0; k < 2; k++) {
    const dvi_potential push = {
        .name = "push", .value = pushed_value, .gradient = pushed_gradient, .user = frequency + k};
    dvi_system *system = make_system(&(dvi_system_terms){.dimension = 1,
                                                         .mass.scalar = 1,
                                                         .potentials = &push,
                                                         .potential_count = 1,
                                                         .autonomous = frequency[k] == 0});
    const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                      .steps = 40,
                                      .span = 6,
                                      .dimension = 1,
                                      .symmetry = k == 1 ? mirror : NULL};
    dvi_path *path = NULL;
    ck_assert_int_eq(dvi_path_create(system, "galerkin:degree=5", &options, &path), DVI_OK);
    const dvi_status status = dvi_path_solve(path, NULL);
    ck_assert_msg(status == DVI_BAD_ARGUMENT, "%s: %s", dvi_status_name(status), dvi_last_error());
    check_words(words[k]);
    ck_assert_ptr_null(dvi_path_p(path, 0));
    dvi_path_destroy(&path);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* V = q^2/2 + q^3 sin t - q cos(2 pi t). At the guess, at rest in 0, it looks as if 1 were its
 * period, but the solution depends on more. */
static int hidden_value(double t, const double *q, double *value, void *user)
{
  (void)user;
  *value = q[0] * q[0] * q[0] * sin(t) - q[0] * cos(2 * 3.14159265358979324 * t) + q[0] * q[0] / 2;
  return 0;
}

static int hidden_gradient(double t, const double *q, double *gradient, void *user)
{
  (void)user;
  gradient[0] = 3 * q[0] * q[0] * sin(t) - cos(2 * 3.14159265358979324 * t) + q[0];
  return 0;
}

START_TEST(a_period_is_tested_on_the_path_that_is_found)
{
  const dvi_potential hidden = {
      .name = "hidden", .value = hidden_value, .gradient = hidden_gradient};
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 1, .mass.scalar = 1, .potentials = &hidden, .potential_count = 1});
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC, .steps = 20, .span = 1};
  dvi_path *path = NULL;
  ck_assert_int_eq(dvi_path_create(system, "galerkin:degree=4", &options, &path), DVI_OK);
  for (int attempt = 0; attempt < 2; attempt++) {
    const dvi_status status = dvi_path_solve(path, NULL);
    ck_assert_msg(status == DVI_BAD_ARGUMENT, "%s: %s", dvi_status_name(status), dvi_last_error());
    check_words("the period is none of the Lagrangian's");
  }
  dvi_path_destroy(&path);
  dvi_system_destroy(&system);
}
END_TEST

/* At rest in the centre. */
START_TEST(a_guess_where_the_lagrangian_is_infinite_fails)
{
  dvi_path *path = create_path(
      (dvi_path_options){.ends = DVI_ENDS_PERIODIC, .steps = 20, .span = 6});
  const dvi_status status = dvi_path_solve(path, NULL);
  ck_assert_msg(status == DVI_NOT_FINITE, "%s: %s", dvi_status_name(status), dvi_last_error());
  check_words("the path is unchanged");
  dvi_path_destroy(&path);
}
END_TEST

START_TEST(callbacks_have_the_last_word)
{
  const int answers[] = {-1, 1};
  const dvi_status expected[] = {DVI_CALLBACK_FAILED, DVI_CALLBACK_RETRY};
  for (int k = 0; k < 2; k++) {
    behaviour well = {0};
    const dvi_potential potential = springs(&well, ONE_POINT);
    dvi_system *system = make_system(&(dvi_system_terms){
        .dimension = SITES, .mass.scalar = 1, .potentials = &potential, .potential_count = 1});
    const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                      .steps = 5,
                                      .span = 0.2,
                                      .dimension = SITES,
                                      .q0 = generic_q,
                                      .q1 = generic_v};
    dvi_path *path = NULL;
    ck_assert_int_eq(dvi_path_create(system, "midpoint", &options, &path), DVI_OK);
    well.answer = answers[k];
    const dvi_status status = dvi_path_solve(path, NULL);
    ck_assert_msg(status == expected[k], "%s: %s", dvi_status_name(status), dvi_last_error());
    check_words("path: ");
    well.answer = 0;
    ck_assert_msg(dvi_path_solve(path, NULL) == DVI_OK, "%s", dvi_last_error());
    dvi_path_destroy(&path);
    dvi_system_destroy(&system);
  }
}
END_TEST

SUITE(refusals)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, spans_are_positive_times);
  tcase_add_test(tests, mixed_ends_need_all_numbers);
  tcase_add_test(tests, steps_can_be_counted);
  tcase_add_test(tests, entries_can_be_counted);
  tcase_add_test(tests, one_step_of_degree_two_has_something_to_vary);
  tcase_add_test(tests, ends_have_what_they_need_and_no_more);
  tcase_add_test(tests, a_free_period_is_for_closed_paths_of_autonomous_systems);
  tcase_add_test(tests, methods_are_elements_of_an_action);
  tcase_add_test(tests, nothing_is_made_of_nothing);
  tcase_add_test(tests, nodes_are_numbered_from_0_to_N);
  tcase_add_test(tests, guesses_are_points_in_the_order_of_time);
  tcase_add_test(tests, conjugate_ends_are_named);
  tcase_add_test(tests, a_path_through_the_centre_is_none);
  tcase_add_test(tests, a_period_that_no_path_has_is_named);
  tcase_add_test(tests, a_family_of_closed_paths_is_named);
  tcase_add_test(tests, what_the_lagrangian_does_not_have_is_no_symmetry);
  tcase_add_test(tests, a_path_at_rest_hides_no_force);
  tcase_add_test(tests, a_period_is_tested_on_the_path_that_is_found);
  tcase_add_test(tests, a_guess_where_the_lagrangian_is_infinite_fails);
  tcase_add_test(tests, callbacks_have_the_last_word);
}
