/* labels: unit */
/* A step or a start that cannot be is refused with a sentence that says why, and leaves everything
 * as it was. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

/* ---- callbacks that spring in mid-step ---- */

typedef enum ailment { RETRY, FAIL, NOT_A_NUMBER, INFINITE, AILMENTS } ailment;

static const dvi_status status_of[] = {DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED, DVI_NOT_FINITE,
                                       DVI_NOT_FINITE};

/* From this time on the callbacks are ill. */
typedef struct trap {
  double after;
  ailment with;
  int hessian_only;
} trap;

static int spring(const trap *set, double t, double *entry)
{
  if (t <= set->after) return 0;
  if (set->with == NOT_A_NUMBER) *entry = (double)NAN;
  if (set->with == INFINITE) *entry = -HUGE_VAL;
  return set->with == RETRY ? 3 : set->with == FAIL ? -3 : 0;
}

static int well_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] * q[0] / 2 + q[1] * q[1] * q[1] * q[1] / 4;
  return 0;
}

static int well_gradient(double t, const double *q, double *V_q, void *user)
{
  const trap *set = user;
  V_q[0] = q[0];
  V_q[1] = q[1] * q[1] * q[1];
  return set->hessian_only ? 0 : spring(set, t, V_q + 1);
}

static int well_hessian(double t, const double *q, double *V_qq, void *user)
{
  V_qq[0] = 1, V_qq[1] = V_qq[2] = 0;
  V_qq[3] = 3 * q[1] * q[1];
  return spring(user, t, V_qq + 3);
}

static dvi_system *well(trap *set)
{
  const dvi_potential potential = {.name = "pit",
                                   .value = well_value,
                                   .gradient = well_gradient,
                                   .hessian = well_hessian,
                                   .user = set};
  return make_system(&(dvi_system_terms){
      .dimension = 2, .mass.scalar = 2, .potentials = &potential, .potential_count = 1});
}

/* L = (2 + cos q_0) v_0^2/2 + v_1^2/2 - q_0^2/2 - q_1^2/2. */
static int bend_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = ((2 + cos(q[0])) * v[0] * v[0] + v[1] * v[1] - q[0] * q[0] - q[1] * q[1]) / 2;
  return 0;
}

static int bend_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  const trap *set = user;
  L_q[0] = -sin(q[0]) * v[0] * v[0] / 2 - q[0];
  L_q[1] = -q[1];
  L_v[0] = (2 + cos(q[0])) * v[0];
  L_v[1] = v[1];
  return set->hessian_only ? 0 : spring(set, t, L_v + 1);
}

static dvi_system *bend(trap *set)
{
  const dvi_lagrangian lagrangian = {.value = bend_value, .gradient = bend_gradient, .user = set};
  return make_system(&(dvi_system_terms){.dimension = 2, .lagrangian = &lagrangian});
}

static dvi_integrator *launched(const dvi_system *system, const char *method)
{
  const double q[] = {0.7, -0.4}, p[] = {0.3, 0.5};
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return made;
}

static void check_same_path(dvi_integrator *a, dvi_integrator *b, double t)
{
  double found[2][4];
  ck_assert_int_eq(dvi_integrator_interpolate(a, t, found[0], found[0] + 2), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(b, t, found[1], found[1] + 2), DVI_OK);
  ck_assert_mem_eq(found[0], found[1], sizeof found[0]);
}

/* Three good steps, one of another length (so that nothing can be kept) that the trap spoils, and
 * three good ones again: the state after the failure, and after each later step, is that of an
 * integrator that never failed, bit for bit. */
static void check_survives(dvi_system *(*make)(trap *), const char *method, int hessian_only,
                           ailment with, const char *culprit)
{
  trap set = {HUGE_VAL, with, hessian_only};
  dvi_system *system = make(&set);
  dvi_integrator *tried = launched(system, method), *spared = launched(system, method);
  advance(tried, 0.1, 3);
  advance(spared, 0.1, 3);
  set.after = 0.32;
  ck_assert_msg(dvi_integrator_step(tried, 0.08) == status_of[with], "%s: %s", method,
                dvi_last_error());
  check_words("step 4 from t = 0.3 with h = 0.08 failed; the state is unchanged");
  check_words(culprit);
  set.after = HUGE_VAL;
  check_same_state(tried, spared);
  check_same_path(tried, spared, 0.27);
  for (int step = 0; step < 3; step++) {
    advance(tried, 0.1, 1);
    advance(spared, 0.1, 1);
    check_same_state(tried, spared);
  }
  dvi_counters counters;
  dvi_integrator_counters(tried, &counters);
  ck_assert_int_eq(counters.failed_steps, 1);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&spared);
  dvi_system_destroy(&system);
}

static const char *const methods[] = {
    "midpoint",
    "trapezoidal",
    "galerkin:degree=3",
    "galerkin:degree=3,solver=newton",
    "galerkin:degree=3,solver=kinsol",
    "galerkin:degree=3,solver=fixed-point",
    "galerkin:degree=2,basis=legendre,quadrature=lobatto,nodes=4",
    "composition:order=6,base=midpoint",
    "verlet",
    "composition:order=4,base=verlet",
};
enum { METHODS = sizeof methods / sizeof *methods, GENERAL_METHODS = METHODS - 2 };

START_TEST(gradients_that_fail_in_mid_run_leave_the_state_alone)
{
  check_survives(well, methods[_i / AILMENTS], 0, (ailment)(_i % AILMENTS), ": pit: the ");
}
END_TEST

START_TEST(lagrangians_that_fail_in_mid_run_leave_the_state_alone)
{
  check_survives(bend, methods[_i / AILMENTS], 0, (ailment)(_i % AILMENTS),
                 ": Lagrangian: the gradient callback ");
}
END_TEST

START_TEST(hessians_that_fail_in_mid_run_leave_the_state_alone)
{
  check_survives(well, "galerkin:degree=3,solver=newton", 1, (ailment)_i, ": pit: the ");
  check_survives(well, "midpoint:solver=kinsol", 1, (ailment)_i, ": pit: the ");
  check_survives(well, "midpoint:solver=simplified", 1, (ailment)_i, ": pit: the ");
}
END_TEST

/* ---- steps that cannot be taken ---- */

START_TEST(steps_that_do_not_move_the_time_are_refused)
{
  const double lengths[] = {0, -0.0, (double)NAN, HUGE_VAL, -HUGE_VAL, 1e-17, -1e-320};
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  advance(integrator, 0.5, 2);
  const bytes before = read_state(integrator);
  for (int k = 0; k < 7; k++) {
    ck_assert_int_eq(dvi_integrator_step(integrator, lengths[k]), DVI_BAD_ARGUMENT);
    check_words("does not move the time");
  }
  check_state(integrator, before);
  /* here even the smallest number moves the time */
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1e-320), DVI_BAD_ARGUMENT);
  check_words("so small that 1/h cannot be computed");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* At rest and free the coordinates stay 0, and the time overflows. A step later the coordinate
 * does. */
START_TEST(a_step_beyond_the_largest_number_fails)
{
  static const char *const some[] = {"verlet", "midpoint"};
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = 1, .mass.scalar = 1});
  dvi_integrator *integrator = create_integrator(system, some[_i]);
  ck_assert_int_eq(dvi_integrator_start(integrator, 1e308, &(double){0}, &(double){0}), DVI_OK);
  const bytes before = read_state(integrator);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1.7e308), DVI_NOT_FINITE);
  check_state(integrator, before);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &(double){1e308}, &(double){1e150}), DVI_OK);
  ck_assert_int_gt(dvi_integrator_step(integrator, 1e200), 0);
  ck_assert_double_eq(dvi_integrator_q(integrator)[0], 1e308);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(nothing_works_before_the_start)
{
  double out[8];
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(model->system, methods[_i]);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_BAD_STATE);
  check_words("dvi_integrator_start");
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = 0.1, .t_end = 1}, NULL),
                   DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, out), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, out, out), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_save(integrator, path_in_folder("none")), DVI_BAD_STATE);
  ck_assert_int_eq(count_files_in_folder(), 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(equations_without_a_solution_are_reported_and_a_smaller_step_goes_on)
{
  static const char *const choices[] = {"auto", "newton", "kinsol", "fixed-point"};
  dvi_system *system = runaway(0);
  const char *method = method_spec("midpoint:solver=%s", choices[_i]);
  dvi_integrator *tried = create_integrator(system, method),
                 *spared = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(tried, 0, &(double){0}, &(double){0}), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(spared, 0, &(double){0}, &(double){0}), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(tried, 1.5), DVI_STEP_TOO_LARGE);
  const char *const words[] = {"midpoint: step 1 ",      "from t = 0 ",        "h = 1.5",
                               "the state is unchanged", "try a smaller step", "iterations",
                               "ends at h = 1.41"};
  for (int k = 0; k < 7; k++) check_words(words[k]);
  check_same_state(tried, spared);
  advance(tried, 0.7, 1);
  advance(spared, 0.7, 1);
  check_same_state(tried, spared);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&spared);
  dvi_system_destroy(&system);
}
END_TEST

/* At 1.87 two of the three bodies are about to meet, and the path of degree 8 turns within the
 * step. */
START_TEST(a_step_through_a_close_encounter_is_reported_and_smaller_ones_go_on)
{
  problem *model = create_problem("pythagorean", NULL);
  dvi_integrator *tried = start_integrator(model, "galerkin:degree=8"),
                 *spared = start_integrator(model, "galerkin:degree=8");
  advance(tried, 0.01, 187);
  advance(spared, 0.01, 187);
  ck_assert_int_eq(dvi_integrator_step(tried, 0.01), DVI_STEP_TOO_LARGE);
  check_words("galerkin: step 188 from t = 1.87 with h = 0.01 failed");
  check_words("try a smaller step: a step too large: the solution that continues those of shorter "
              "steps ends at h = 0.00");
  check_same_state(tried, spared);
  for (int step = 0; step < 20; step++) {
    advance(tried, 0.0005, 1);
    advance(spared, 0.0005, 1);
    check_same_state(tried, spared);
  }
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&spared);
  problem_destroy(&model);
}
END_TEST

/* ---- starts that cannot be ---- */

START_TEST(a_bad_start_leaves_the_old_state)
{
  const double nan = (double)NAN, fine[] = {1, 1}, bad_q[] = {1, nan}, bad_p[] = {HUGE_VAL, 0},
               centre[] = {0, 0}, near[] = {1e-180, 0};
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  advance(integrator, 0.05, 3);
  const bytes before = read_state(integrator);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, bad_q, fine), DVI_NOT_FINITE);
  check_words("the start's q[1] = ");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, fine, bad_p), DVI_NOT_FINITE);
  check_words("the start's p[0] = inf");
  ck_assert_int_eq(dvi_integrator_start(integrator, nan, fine, fine), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, centre, fine), DVI_NOT_FINITE);
  check_words("cannot start at t = 0");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, near, fine), DVI_NOT_FINITE);
  check_state(integrator, before);
  advance(integrator, 0.05, 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* L = q_1 v_0 - |q|^2/2, whose velocity Hessian vanishes. */
static int linear_in_v(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = q[1] * v[0] - (q[0] * q[0] + q[1] * q[1]) / 2;
  return 0;
}

static int linear_in_v_gradient(double t, const double *q, const double *v, double *L_q,
                                double *L_v, void *user)
{
  (void)t, (void)user;
  L_q[0] = -q[0];
  L_q[1] = v[0] - q[1];
  L_v[0] = q[1];
  L_v[1] = 0;
  return 0;
}

static int linear_in_v_hessian(double t, const double *q, const double *v, double *L_qq,
                               double *L_qv, double *L_vv, void *user)
{
  (void)t, (void)q, (void)v, (void)user;
  memset(L_vv, 0, 4 * sizeof(double));
  memset(L_qv, 0, 4 * sizeof(double));
  memset(L_qq, 0, 4 * sizeof(double));
  L_qq[0] = L_qq[3] = -1;
  L_qv[1] = 1;
  return 0;
}

START_TEST(a_degenerate_lagrangian_is_refused_at_the_start_by_name)
{
  const dvi_lagrangian lagrangian = {
      .value = linear_in_v, .gradient = linear_in_v_gradient, .hessian = linear_in_v_hessian};
  const double q[] = {1, 0}, p[] = {0, 0};
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = 2, .lagrangian = &lagrangian});
  dvi_integrator *integrator = create_integrator(system, methods[_i]);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_SINGULAR);
  check_words(method_spec("%.*s: cannot start at t = 0: the Lagrangian is degenerate",
                          (int)strcspn(methods[_i], ":"), methods[_i]));
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_BAD_STATE);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(arguments_that_are_missing_are_refused)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]), *none = integrator;
  const dvi_run_options options = {.h = 0.1, .t_end = 1};
  double out[8];
  advance(integrator, 0.1, 2);
  const bytes before = read_state(integrator);
  ck_assert_int_eq(dvi_integrator_create(NULL, "verlet", &none), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(none);
  none = integrator;
  ck_assert_int_eq(dvi_integrator_create(model->system, NULL, &none), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(none);
  ck_assert_int_eq(dvi_integrator_create(model->system, "verlet", NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start(NULL, 0, model->q, model->p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, NULL, model->p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_step(NULL, 0.1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_invariants(NULL, out), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_interpolate(NULL, 0.2, out, out), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.2, NULL, NULL), DVI_OK);
  ck_assert_int_eq(dvi_integrator_save(NULL, path_in_folder("none")), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_save(integrator, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_restore(NULL, path_in_folder("none")), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_restore(integrator, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_run(NULL, &options, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_run(integrator, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_uint_gt(dvi_integrator_explain(integrator, NULL, 0), 0);
  check_state(integrator, before);
  none = NULL;
  dvi_integrator_destroy(&none);
  dvi_integrator_destroy(NULL);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(failure)
{
  tcase_set_timeout(tests, 120); /* states are compared by files, which are flushed to the disk */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, gradients_that_fail_in_mid_run_leave_the_state_alone, 0,
                      METHODS * AILMENTS);
  tcase_add_loop_test(tests, lagrangians_that_fail_in_mid_run_leave_the_state_alone, 0,
                      GENERAL_METHODS * AILMENTS);
  tcase_add_loop_test(tests, hessians_that_fail_in_mid_run_leave_the_state_alone, 0, AILMENTS);
  tcase_add_loop_test(tests, steps_that_do_not_move_the_time_are_refused, 0, METHODS);
  tcase_add_loop_test(tests, a_step_beyond_the_largest_number_fails, 0, 2);
  tcase_add_loop_test(tests, nothing_works_before_the_start, 0, METHODS);
  tcase_add_loop_test(tests, equations_without_a_solution_are_reported_and_a_smaller_step_goes_on,
                      0, 4);
  tcase_add_test(tests, a_step_through_a_close_encounter_is_reported_and_smaller_ones_go_on);
  tcase_add_loop_test(tests, a_bad_start_leaves_the_old_state, 0, METHODS);
  tcase_add_loop_test(tests, a_degenerate_lagrangian_is_refused_at_the_start_by_name, 0,
                      GENERAL_METHODS);
  tcase_add_loop_test(tests, arguments_that_are_missing_are_refused, 0, METHODS);
}
