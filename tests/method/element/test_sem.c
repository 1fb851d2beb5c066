/* labels: invariant */
/* Symplectic-energy-momentum integrators: conserved quantities, steps without a solution of the
 * energy equation, and refusals. */
#include <math.h>
#include <string.h>

#include <dvi/ensemble.h>
#include <dvi/run.h>

#include "support/runs.h"
#include "support/suite.h"

static dvi_energy_balance balance_of(const dvi_integrator *integrator)
{
  dvi_energy_balance energy;
  ck_assert_msg(dvi_integrator_energy_balance(integrator, &energy) == DVI_OK, "%s",
                dvi_last_error());
  return energy;
}

/* Gives the part of the energy that is not accounted for. It is 0 up to roundings. */
static double defect_of(const dvi_energy_balance *e)
{
  return fabs(e->energy - (e->first + e->work + e->jumps));
}

/* ---- conservation ---- */

typedef struct place {
  const char *problem, *setting, *method;
  double h;
} place;

/* Without a fallback. Every step solves its energy row to 16 roundings of T + |V|, below 1e-13 of
 * the energy; 1e-12 is what is asked. Angular momentum: p is advanced by compensated sums of
 * central forces, 1e-15 each, that are right to a rounding. */
static void check_conservation(const place *at, long steps)
{
  problem *model = create_problem(at->problem, at->setting);
  dvi_integrator *integrator = start_integrator(model, at->method);
  double start[8], end[8];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  double worst = 0;
  for (long i = 0; i < steps; i++) {
    advance(integrator, at->h, 1);
    const dvi_energy_balance energy = balance_of(integrator);
    worst = fmax(worst, fabs(energy.energy - energy.first));
  }
  const dvi_energy_balance energy = balance_of(integrator);
  ck_assert_int_eq(energy.fallbacks, 0);
  ck_assert_msg(worst <= 1e-12 * fabs(energy.first), "%s on %s: energy moves by %g", at->method,
                at->problem, worst);
  ck_assert(energy.work == 0 && energy.jumps == 0 && energy.given_steps == 0);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, end), DVI_OK);
  if (strcmp(at->problem, "kepler") == 0) ck_assert_double_eq_tol(end[1], start[1], 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

static const place conserving[] = {
    {"kepler", "e=0.2", "sem", 0.05},
    {"kepler", "e=0.2", "sem:degree=1,quadrature=lobatto", 0.05},
    {"kepler", "e=0.2", "sem:degree=2", 0.1},
    {"kepler", "e=0.2", "sem:degree=2,quadrature=lobatto", 0.1},
    {"kepler", "e=0.2", "sem:degree=3", 0.2},
    {"kepler", "e=0.2", "sem:degree=3,quadrature=lobatto", 0.2},
    {"kepler", "e=0.2", "sem:degree=4", 0.2},
    {"kepler", "e=0.1", "sem:degree=4,quadrature=lobatto", 0.3},
    {"oscillator", NULL, "sem", 0.1},
    {"oscillator", NULL, "sem:degree=2", 0.3},
    {"kepler", "e=0.2", "sem:degree=2,solver=kinsol", 0.1},
};
enum { CONSERVING = sizeof conserving / sizeof *conserving };

START_TEST(energy_and_angular_momentum_are_conserved)
{
  check_conservation(&conserving[_i], 2000);
}
END_TEST

/* A step of h solves the ordinary rows, so q and p are those of the Galerkin method with the same
 * steps. */
START_TEST(the_steps_are_galerkin_steps_of_other_lengths)
{
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *sem = start_integrator(model, "sem:degree=2"),
                 *galerkin = start_integrator(model, "galerkin:degree=2");
  int lengths = 0;
  for (int i = 0; i < 200; i++) {
    advance(sem, 0.05, 1);
    lengths += fabs(dvi_integrator_last_step(sem) - 0.05) > 1e-3;
    advance(galerkin, dvi_integrator_last_step(sem), 1);
    ck_assert_double_eq_tol(distance(model->nq, dvi_integrator_q(sem), dvi_integrator_q(galerkin)),
                            0, 1e-12);
  }
  ck_assert_int_gt(lengths, 100);
  dvi_integrator_destroy(&sem);
  dvi_integrator_destroy(&galerkin);
  problem_destroy(&model);
}
END_TEST

/* ---- fallbacks ---- */

/* Solvable everywhere below e = sqrt(5/8) = 0.79 (Leok 2004, sec. 5.5, for small h). */
START_TEST(kepler_at_78_needs_no_fallback)
{
  const place at = {"kepler", "e=0.78", "sem", 0.001};
  check_conservation(&at, 5000);
}
END_TEST

/* Duffing's double well, V = q^4/4 - q^2/2. */
static int duffing_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] * q[0] * q[0] * q[0] / 4 - q[0] * q[0] / 2;
  return 0;
}

static int duffing_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0] * q[0] * q[0] - q[0];
  return 0;
}

static int duffing_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  V_qq[0] = 3 * q[0] * q[0] - 1;
  return 0;
}

typedef struct hard_place {
  const char *problem, *setting, *method;
  double h, q[2], p[2]; /* the start (default 0, the problem's start) */
  double most;          /* length of a step over h (default 0, without bounds) */
} hard_place;

/* henon-heiles at H = 0.166, just below the escape energy 1/6. */
static const hard_place hard[] = {
    {"kepler", "e=0.80", "sem", 0.01, {0}, {0}, 0},
    {"kepler", "e=0.9", "sem", 0.003, {0}, {0}, 0},
    {"kepler", "e=0.99", "sem", 0.0002, {0}, {0}, 0},
    {"pendulum", NULL, "sem", 0.1, {1}, {2.5}, 0},
    {"pendulum", NULL, "sem:degree=2", 0.1, {1}, {2.5}, 0},
    {"pendulum", "q0=1e-3", "sem", 0.1, {0}, {0}, 0},
    {"pendulum", "q0=1e-3", "sem:degree=2,quadrature=lobatto", 0.1, {0}, {0}, 0},
    {"oscillator", NULL, "sem", 0.1, {0}, {0}, 0},
    {"oscillator", NULL, "sem:degree=3", 0.1, {0}, {0}, 0},
    {"duffing", NULL, "sem", 0.1, {1.5}, {0.2}, 0},
    {"duffing", NULL, "sem:degree=2", 0.1, {0.001}, {0}, 0},
    {"henon-heiles", NULL, "sem", 0.1, {0, -0.1}, {0.5649188730}, 0},
    {"henon-heiles", NULL, "sem:degree=2", 0.1, {0, -0.1}, {0.5649188730}, 0},
    {"henon-heiles", NULL, "sem:degree=3,quadrature=lobatto", 0.1, {0}, {0}, 0},
    {"driven-pendulum", NULL, "sem:hmin=0.01,hmax=0.3", 0.1, {0}, {0}, 3},
    {"driven-pendulum", NULL, "sem:degree=2,hmin=0.01,hmax=0.3", 0.1, {0}, {0}, 3},
};
enum { HARD = sizeof hard / sizeof *hard, HARD_STEPS = 10000 };

static dvi_system *duffing(void)
{
  const dvi_potential well = {.name = "well",
                              .value = duffing_value,
                              .gradient = duffing_gradient,
                              .hessian = duffing_hessian};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &well, .potential_count = 1, .autonomous = 1};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

/* In 1e4 steps each one goes forward, within its bounds, to a finite state, and each jump is
 * counted. The balance with the jumps is at roundoff, so none is silent. */
static void check_hard(dvi_integrator *integrator, const char *what, double h, double most)
{
  double size = 0;
  for (int i = 0; i < HARD_STEPS; i++) {
    const double before = dvi_integrator_time(integrator);
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s: %s", what, dvi_last_error());
    const double length = dvi_integrator_last_step(integrator);
    ck_assert_msg(length >= 0.1 * h * (1 - 1e-15) && length <= most * h * (1 + 1e-15),
                  "%s: a step of %g", what, length);
    ck_assert(dvi_integrator_time(integrator) > before);
    const dvi_energy_balance energy = balance_of(integrator);
    size = fmax(size, fmax(fabs(energy.energy), fabs(energy.work)));
  }
  const dvi_energy_balance energy = balance_of(integrator);
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.energy_fallbacks, energy.fallbacks);
  ck_assert((energy.fallbacks > 0) == (fabs(energy.largest_jump) > 0));
  ck_assert_double_ge(fabs(energy.largest_jump), fabs(energy.last_jump));
  ck_assert_msg(defect_of(&energy) <= 1e-11 * fmax(1, size),
                "%s: %g of energy is not accounted for", what, defect_of(&energy));
}

START_TEST(hard_places_are_passed_with_every_jump_counted)
{
  const hard_place *at = &hard[_i];
  const int own = strcmp(at->problem, "duffing") == 0;
  problem *model = own ? NULL : create_problem(at->problem, at->setting);
  dvi_system *system = own ? duffing() : model->system;
  dvi_integrator *integrator = create_integrator(system, at->method);
  const int given = own || at->q[0] != 0 || at->p[0] != 0;
  ck_assert_int_eq(
      dvi_integrator_start(integrator, 0, given ? at->q : model->q, given ? at->p : model->p),
      DVI_OK);
  check_hard(integrator, at->problem, at->h, at->most > 0 ? at->most : 30);
  dvi_integrator_destroy(&integrator);
  if (own)
    dvi_system_destroy(&system);
  else
    problem_destroy(&model);
}
END_TEST

/* A rotating pendulum fails on each turn, because f = v^2 V'' + V'^2 changes its sign. */
START_TEST(a_rotating_pendulum_falls_back)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "sem");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, (double[]){1}, (double[]){2.5}), DVI_OK);
  advance(integrator, 0.1, 1000);
  const dvi_energy_balance energy = balance_of(integrator);
  ck_assert_int_gt(energy.fallbacks, 0);
  ck_assert(energy.largest_jump != 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- time dependence ---- */

/* E+ - E- of all steps is the work. Along the exact solution it is the integral of -L_t, by which
 * the energy p v - L changes. */
START_TEST(the_driven_pendulum_keeps_the_extended_energy_balance)
{
  problem *model = create_problem("driven-pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, "sem:degree=3,hmin=0.05,hmax=0.2");
  double start[1], end[1];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  for (int i = 0; i < 100; i++) {
    advance(integrator, 0.1, 1);
    const dvi_energy_balance energy = balance_of(integrator);
    ck_assert_double_le(defect_of(&energy), 1e-12);
  }
  ck_assert_int_eq(dvi_integrator_invariants(integrator, end), DVI_OK);
  const dvi_energy_balance energy = balance_of(integrator);
  ck_assert_double_gt(fabs(energy.work), 0.1);
  /* steps of up to 0.2, degree 3: the method's own error */
  ck_assert_double_eq_tol(energy.energy, end[0], 1e-5);
  ck_assert_double_eq_tol(energy.work + energy.jumps, end[0] - start[0], 1e-5);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- runs ---- */

START_TEST(a_run_ends_on_time_by_an_ordinary_step)
{
  problem *model = create_problem("kepler", "e=0.3");
  for (int direction = -1; direction <= 1; direction += 2) {
    dvi_integrator *integrator = start_integrator(model, "sem:degree=2");
    dvi_run_report report;
    const dvi_run_options options = {.h = 0.1 * direction, .t_end = 10.0 * direction};
    ck_assert_msg(dvi_run(integrator, &options, &report) == DVI_OK, "%s", dvi_last_error());
    ck_assert_double_eq_tol(dvi_integrator_time(integrator), 10.0 * direction, 1e-14);
    ck_assert_int_eq(balance_of(integrator).given_steps, 1);
    ck_assert_int_lt(report.steps, 100);
    double q[2], p[2];
    ck_assert_int_eq(model->exact(model, 10.0 * direction, q, p), 0);
    ck_assert_double_le(distance(2, q, dvi_integrator_q(integrator)), 1e-3); /* h^4, times 30 */
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
}
END_TEST

static int at_pericentre(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)user;
  *g = q[0] * v[0] + q[1] * v[1];
  return 0;
}

START_TEST(events_are_found_in_steps_of_any_length)
{
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *integrator = start_integrator(model, "sem:degree=4");
  const dvi_event event = {
      .name = "pericentre", .value = at_pericentre, .direction = 1, .terminal = 1};
  dvi_run_report report;
  advance(integrator, 0.1, 1);
  ck_assert_int_eq(
      dvi_run(integrator,
              &(dvi_run_options){.h = 0.1, .t_end = 20, .events = &event, .event_count = 1},
              &report),
      DVI_OK);
  ck_assert_int_eq(report.end, DVI_RUN_EVENT);
  /* the path's own order, s + 1 */
  ck_assert_double_eq_tol(report.event_time, 6.283185307179586, 1e-4);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), report.event_time, 1e-14);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Another h begins a new sequence by an ordinary step of that length. */
START_TEST(another_length_begins_anew)
{
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *integrator = start_integrator(model, "sem");
  advance(integrator, 0.01, 10);
  ck_assert(dvi_integrator_last_step(integrator) > 0.01);
  advance(integrator, 0.02, 1);
  ck_assert(dvi_integrator_last_step(integrator) == 0.02);
  const dvi_energy_balance energy = balance_of(integrator);
  ck_assert_int_eq(energy.given_steps, 1);
  ck_assert(energy.given_jumps != 0 && energy.fallbacks == 0);
  ck_assert_double_le(defect_of(&energy), 1e-14);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- refusals ---- */

static void refused(const problem *model, const char *method, double h, dvi_status status,
                    const char *words)
{
  dvi_integrator *integrator = NULL;
  dvi_status found = dvi_integrator_create(model->system, method, &integrator);
  if (found == DVI_OK) found = dvi_integrator_start(integrator, 0, model->q, model->p);
  if (found == DVI_OK) found = dvi_integrator_step(integrator, h);
  ck_assert_msg(found == status, "%s: %s, %s", method, dvi_status_name(found), dvi_last_error());
  check_words(words);
  dvi_integrator_destroy(&integrator);
}

START_TEST(bounds_that_cannot_be_are_refused)
{
  problem *model = create_problem("kepler", NULL);
  refused(model, "sem:hmin=0.2,hmax=0.1", 0.1, DVI_BAD_OPTION, "sem: hmin=0.2 is above hmax=0.1");
  refused(model, "sem:hmin=-1", 0.1, DVI_BAD_OPTION,
          "sem: hmin=-1; a positive number is possible, or auto");
  refused(model, "sem:hmax=0", 0.1, DVI_BAD_OPTION,
          "sem: hmax=0; a positive number is possible, or auto");
  refused(model, "sem:hmax=nan", 0.1, DVI_BAD_OPTION, "sem: hmax=nan; a positive number");
  refused(model, "sem:hmax=1e400", 0.1, DVI_BAD_OPTION, "sem: hmax=1e400; a positive number");
  refused(model, "sem:hmin=0.2", 0.1, DVI_BAD_OPTION,
          "the first step h = 0.1 is below hmin=0.2; the bounds must include it");
  refused(model, "sem:hmax=0.05", -0.1, DVI_BAD_OPTION,
          "the first step h = -0.1 is above hmax=0.05; the bounds must include it");
  refused(model, "sem", 0, DVI_BAD_ARGUMENT, "a finite step other than 0 is needed");
  problem_destroy(&model);
}
END_TEST

START_TEST(bounds_are_spelled_out_and_kept)
{
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *integrator = start_integrator(model, "sem:hmax=0.0125");
  ck_assert_str_eq(dvi_integrator_method(integrator),
                   "sem:degree=1,quadrature=gauss,hmin=auto,hmax=0.0125,solver=newton");
  double longest = 0;
  for (int i = 0; i < 300; i++) {
    advance(integrator, 0.01, 1);
    longest = fmax(longest, dvi_integrator_last_step(integrator));
  }
  ck_assert(longest == 0.0125); /* without the bound: above 0.02 */
  ck_assert_int_gt(balance_of(integrator).fallbacks, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_run_away_from_its_end_is_refused)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "sem");
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = -0.1, .t_end = 1}, NULL),
                   DVI_BAD_ARGUMENT);
  check_words("leads away from");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_system_that_may_depend_on_time_needs_rates)
{
  const dvi_potential well = {.name = "well", .value = duffing_value};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &well, .potential_count = 1};
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "sem", &integrator), DVI_UNSUPPORTED);
  check_words("sem: well has no rate callback, and the system is not declared autonomous");
  ck_assert_ptr_null(integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(ensembles_refuse_it)
{
  problem *model = create_problem("kepler", NULL);
  dvi_ensemble *ensemble = NULL;
  ck_assert_int_eq(
      dvi_ensemble_create(model->system, "sem", &(dvi_ensemble_options){.members = 2}, &ensemble),
      DVI_UNSUPPORTED);
  check_words("sem chooses its steps");
  ck_assert_ptr_null(ensemble);
  problem_destroy(&model);
}
END_TEST

START_TEST(queries_answer_for_methods_of_fixed_steps)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet"),
                 *sem = start_integrator(model, "sem");
  dvi_energy_balance energy;
  ck_assert_int_eq(dvi_integrator_chooses_steps(integrator), 0);
  ck_assert_int_eq(dvi_integrator_chooses_steps(sem), 1);
  ck_assert_int_eq(dvi_integrator_chooses_steps(NULL), 0);
  ck_assert(dvi_integrator_last_step(integrator) == 0 && dvi_integrator_last_step(NULL) == 0);
  advance(integrator, 0.1, 1);
  ck_assert(dvi_integrator_last_step(integrator) == 0.1);
  ck_assert_int_eq(dvi_integrator_energy_balance(integrator, &energy), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_integrator_energy_balance(sem, &energy), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_energy_balance(NULL, &energy), DVI_BAD_ARGUMENT);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&sem);
  problem_destroy(&model);
}
END_TEST

SUITE(sem)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, energy_and_angular_momentum_are_conserved, 0, CONSERVING);
  tcase_add_test(tests, the_steps_are_galerkin_steps_of_other_lengths);
  tcase_add_test(tests, kepler_at_78_needs_no_fallback);
  tcase_add_loop_test(tests, hard_places_are_passed_with_every_jump_counted, 0, HARD);
  tcase_add_test(tests, a_rotating_pendulum_falls_back);
  tcase_add_test(tests, the_driven_pendulum_keeps_the_extended_energy_balance);
  tcase_add_test(tests, a_run_ends_on_time_by_an_ordinary_step);
  tcase_add_test(tests, events_are_found_in_steps_of_any_length);
  tcase_add_test(tests, another_length_begins_anew);
  tcase_add_test(tests, bounds_that_cannot_be_are_refused);
  tcase_add_test(tests, bounds_are_spelled_out_and_kept);
  tcase_add_test(tests, a_run_away_from_its_end_is_refused);
  tcase_add_test(tests, a_system_that_may_depend_on_time_needs_rates);
  tcase_add_test(tests, ensembles_refuse_it);
  tcase_add_test(tests, queries_answer_for_methods_of_fixed_steps);
}
