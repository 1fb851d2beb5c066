/* Galerkin steps where charts are hard: fast tops, steps of nearly and of more than half a turn,
 * thin bodies. Also tested are the duties of every method. */
#include <dvi/group.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

/* The top turns about its axis by 1 in every step, 1e3 radians in all. */
START_TEST(fast_tops_keep_energy_and_spin)
{
  body model;
  double before[2], after[2];
  make_body(HEAVY_TOP, &model);
  model.v[1] = 1000;
  dvi_integrator *made = body_integrator(&model, "lie-galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_invariants(made, before), DVI_OK);
  advance(made, 1e-3, 1000);
  ck_assert_int_eq(dvi_integrator_invariants(made, after), DVI_OK);
  ck_assert_double_le(fabs(dvi_integrator_p(made)[1] / .46875 - 1000), 1e-10);
  ck_assert_msg(fabs(after[0] - before[0]) < 1e-9 * before[0], "%.1e", after[0] / before[0] - 1);
  ck_assert_double_le(fabs(after[1] - before[1]), 1e-10);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

/* A turn about a principal axis by 3.1 in every step is that of a one-parameter subgroup,
 * exactly. */
START_TEST(steps_of_nearly_half_a_turn_are_taken)
{
  static const char *const methods[] = {"lie-galerkin:degree=1", "lie-galerkin:degree=3",
                                        "euler-poincare:degree=3"};
  const double v[] = {0, 0, 3.1}, all[] = {0, 0, 31};
  double R[9];
  body model;
  make_body(FREE_BODY, &model);
  memcpy(model.v, v, sizeof v);
  dvi_integrator *made = body_integrator(&model, methods[_i]);
  advance(made, 1, 10);
  dvi_so3_exp(all, R);
  ck_assert_double_le(distance(9, R, dvi_integrator_q(made)), 1e-13);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

static problem *fast_heavy_top(void)
{
  static const char *const settings[] = {"Omega1=18.269642407955835", "Omega2=0.019925691908389956",
                                         "Omega3=0.005365253040629534"};
  char message[256];
  problem *made = NULL;
  ck_assert_int_eq(problem_create("heavy-top", 3, settings, &made, message, sizeof message),
                   DVI_OK);
  return made;
}

/* The top turns by 2.9 in every step. Corrections by kept Jacobians that do not shrink tell nothing
 * of what is left, and a step that remembers the last ones is that of a fresh start. */
START_TEST(steps_are_those_of_a_fresh_start)
{
  static const double h = 0.15873316430668183;
  static const char *const method = "lie-galerkin:degree=6";
  problem *model = fast_heavy_top();
  dvi_integrator *warm = start_integrator(model, method), *cold = start_integrator(model, method);
  for (int k = 0; k < 12; k++) {
    ck_assert_int_eq(dvi_integrator_start(cold, dvi_integrator_time(warm), dvi_integrator_q(warm),
                                          dvi_integrator_p(warm)),
                     DVI_OK);
    advance(warm, h, 1);
    advance(cold, h, 1);
    const double apart = distance(model->nq, dvi_integrator_q(warm), dvi_integrator_q(cold));
    ck_assert_msg(apart < 1e-13, "step %d: apart by %.1e", k, apart);
  }
  dvi_integrator_destroy(&warm);
  dvi_integrator_destroy(&cold);
  problem_destroy(&model);
}
END_TEST

START_TEST(more_than_half_a_turn_is_a_step_too_large)
{
  static const struct {
    body_kind kind;
    const char *method;
    double h, faster;
  } places[] = {{FREE_BODY, "lie-galerkin:degree=2", 4, 2},
                {HEAVY_TOP, "lie-galerkin:degree=2,solver=newton", .05, 1},
                {DIRECTIONS, "sphere-galerkin:degree=2", 3, 1},
                {ANGLE, "lie-galerkin:degree=2", .5, 6},
                {FREE_BODY, "lie-galerkin:degree=1,solver=kinsol", 9, 1}};
  body model;
  double p[BODY_V];
  make_body(places[_i].kind, &model);
  for (int i = 0; i < model.nv; i++) model.v[i] *= places[_i].faster;
  dvi_integrator *made = body_integrator(&model, places[_i].method);
  memcpy(p, dvi_integrator_p(made), (size_t)model.nv * sizeof *p);
  const dvi_status status = dvi_integrator_step(made, places[_i].h);
  ck_assert_msg(status == DVI_STEP_TOO_LARGE, "%s: %s: %s", model.name, dvi_status_name(status),
                dvi_last_error());
  check_words("half a turn");
  check_words("try a smaller step");
  ck_assert_mem_eq(dvi_integrator_q(made), model.q, (size_t)model.nq * sizeof *p);
  ck_assert_mem_eq(dvi_integrator_p(made), p, (size_t)model.nv * sizeof *p);
  ck_assert_double_eq(dvi_integrator_time(made), 0);
  advance(made, places[_i].h / 200, 3);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

/* A rod, a needle's millionth, and a plate. */
START_TEST(nearly_degenerate_bodies_keep_energy_and_momentum)
{
  static const double inertia[][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1e-6},
                                      {1, 0, 0, 0, 1 + 1e-6, 0, 0, 0, 2e-6},
                                      {1, 0, 0, 0, 1, 0, 0, 0, 2}};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia[_i]};
  const double q[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, v[] = {.5, .3, 2};
  double before, after;
  dvi_system *system;
  ck_assert_msg(
      dvi_system_create(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1},
                        &system) == DVI_OK,
      "%s", dvi_last_error());
  dvi_integrator *made = create_integrator(system, "lie-galerkin:degree=3");
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, q, v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(made, &before), DVI_OK);
  advance(made, 0.02, repeats(1000));
  ck_assert_int_eq(dvi_integrator_invariants(made, &after), DVI_OK);
  ck_assert_msg(fabs(after - before) < 1e-9, "%.1e", after - before);
  const double *R = dvi_integrator_q(made), *p = dvi_integrator_p(made),
               start[] = {inertia[_i][0] * v[0], inertia[_i][4] * v[1], inertia[_i][8] * v[2]};
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2], start[i],
                            1e-12);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* A body that is a million times lighter about one axis, or half as heavy about two. The momentum
 * about that axis is rounded as that about the others, so no iteration knows its unknowns to more
 * than 1e-10 of their size. Newton's method must notice that. */
static const struct {
  double J[3];
  const char *method;
} thin[] = {
    {{1e-6, 1, 1}, "lie-galerkin:degree=%d"},
    {{1, 1e-6, 1}, "lie-galerkin:degree=%d"},
    {{1, 1, 1e-6}, "lie-galerkin:degree=%d"},
    {{1, 1, 1e-6}, "lie-galerkin:degree=%d,solver=newton"},
    {{1e-6, 1, 1}, "lie-galerkin:degree=%d,solver=kinsol"},
    {{1e-6, 1, 1}, "euler-poincare:degree=%d"},
    {{1, 1e-6, 1}, "euler-poincare:degree=%d"},
    {{1, 1, 1e-6}, "euler-poincare:degree=%d,quadrature=lobatto"},
    {{1, 1, 1e-6}, "euler-poincare:degree=%d,solver=newton"},
    {{2, 1, 1}, "lie-galerkin:degree=%d"},
    {{1, 1, 2}, "euler-poincare:degree=%d"},
    {{1e-6, 1e-6, 2e-6}, "lie-galerkin:degree=%d"},
};
enum { THIN = sizeof thin / sizeof *thin, DEGREES = 5 };

static void check_momentum(const dvi_integrator *made, const double *start)
{
  const double *R = dvi_integrator_q(made), *p = dvi_integrator_p(made);
  const double size = fmax(fabs(start[0]), fmax(fabs(start[1]), fabs(start[2])));
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2], start[i],
                            1e-12 * size);
}

START_TEST(steps_of_thin_bodies_are_solved)
{
  const double *J = thin[_i / DEGREES].J, v[] = {.3, .2, .5},
               start[] = {J[0] * v[0], J[1] * v[1], J[2] * v[2]};
  const double inertia[] = {J[0], 0, 0, 0, J[1], 0, 0, 0, J[2]}, q[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = inertia};
  char method[64];
  dvi_counters counters;
  dvi_system *system;
  (void)snprintf(method, sizeof method, thin[_i / DEGREES].method, 1 + _i % DEGREES);
  ck_assert_msg(
      dvi_system_create(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1},
                        &system) == DVI_OK,
      "%s", dvi_last_error());
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, q, v), DVI_OK);
  advance(made, 0.05, repeats(2000));
  check_momentum(made, start);
  dvi_integrator_counters(made, &counters);
  ck_assert_int_eq(counters.followed, 0);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- failing callbacks ---- */

/* V = q_3 of a direction, whose gradient fails on demand. */
typedef struct trap {
  int returned;
  double last;
} trap;

static int height(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[2];
  return 0;
}

static int height_gradient(double t, const double *q, double *V_q, void *user)
{
  const trap *set = user;
  (void)t, (void)q;
  V_q[0] = V_q[1] = 0;
  V_q[2] = set->last;
  return set->returned;
}

static const struct {
  const char *method;
  trap set;
  dvi_status status;
  const char *words;
} traps[] = {
    {"lie-galerkin:degree=2", {0, NAN}, DVI_NOT_FINITE, "height: the gradient callback gave nan"},
    {"lie-galerkin:degree=2",
     {1, 1},
     DVI_CALLBACK_RETRY,
     "height: the gradient callback asked for a smaller step (1)"},
    {"sphere-galerkin:degree=2",
     {-1, 1},
     DVI_CALLBACK_FAILED,
     "height: the gradient callback failed with -1"},
    {"sphere-galerkin:degree=2,solver=newton",
     {0, INFINITY},
     DVI_NOT_FINITE,
     "height: the gradient callback gave inf"},
    {"lie-galerkin:degree=1,solver=kinsol",
     {-7, 1},
     DVI_CALLBACK_FAILED,
     "height: the gradient callback failed with -7"},
};

/* Checks the method's name and its status, of the start and of the step, and that it goes on
 * afterwards. */
START_TEST(failing_callbacks_are_named)
{
  const double q[] = {1, 0, 0}, v[] = {0, 1, .5};
  const dvi_factor factor = {.kind = DVI_S2, .mass = 1};
  trap set = {0, 1};
  const dvi_potential potential = {
      .name = "height", .value = height, .gradient = height_gradient, .user = &set};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.factors = &factor,
                                                         .factor_count = 1,
                                                         .potentials = &potential,
                                                         .potential_count = 1,
                                                         .autonomous = 1},
                                     &system),
                   DVI_OK);
  dvi_integrator *made = create_integrator(system, traps[_i].method);
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, q, v), DVI_OK);
  advance(made, .05, 2);
  set = traps[_i].set;
  ck_assert_int_eq(dvi_integrator_step(made, .05), traps[_i].status);
  check_words(traps[_i].words);
  ck_assert_int_eq(dvi_integrator_start(made, 0, q, v), traps[_i].status);
  check_words(traps[_i].words);
  set = (trap){0, 1};
  advance(made, .05, 2);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* It is the square of the velocity. */
START_TEST(a_start_too_fast_for_its_energy_is_refused)
{
  static const char *const names[] = {"lie-galerkin:degree=2", "euler-poincare:degree=2"};
  body model;
  make_body(FREE_BODY, &model);
  model.v[0] = 1e200;
  dvi_integrator *made = create_integrator(model.system, names[_i]);
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, model.q, model.v), DVI_NOT_FINITE);
  check_words("the Lagrangian's value is not finite");
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

/* ---- what every method owes ---- */

static const char *const methods[] = {
    "lie-galerkin:degree=2", "lie-galerkin:degree=3,solver=newton", "euler-poincare:degree=3",
    "sphere-galerkin:degree=2", "lie-galerkin:degree=3"};
enum { METHODS = sizeof methods / sizeof *methods };

static void take_body_for(int method, body *model)
{
  static const body_kind kinds[METHODS] = {PRODUCT, PRODUCT, FREE_MOTION, DIRECTIONS, PENDULUM_3D};
  make_body(kinds[method], model);
}

START_TEST(checkpoints_continue_bit_for_bit)
{
  body model;
  char path[64];
  take_body_for(_i, &model);
  (void)snprintf(path, sizeof path, "lie_galerkin_%d.dvi", _i);
  dvi_integrator *whole = body_integrator(&model, methods[_i]),
                 *later = body_integrator(&model, methods[_i]);
  advance(whole, 0.02, 7);
  ck_assert_msg(dvi_integrator_save(whole, path) == DVI_OK, "%s", dvi_last_error());
  advance(whole, 0.02, 9);
  ck_assert_msg(dvi_integrator_restore(later, path) == DVI_OK, "%s", dvi_last_error());
  (void)remove(path);
  advance(later, 0.02, 9);
  ck_assert_mem_eq(dvi_integrator_q(whole), dvi_integrator_q(later),
                   (size_t)model.nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(whole), dvi_integrator_p(later),
                   (size_t)model.nv * sizeof(double));
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&later);
  destroy_body(&model);
}
END_TEST

START_TEST(no_step_allocates_but_to_prepare_a_solver)
{
  body model;
  take_body_for(_i, &model);
  dvi_integrator *made = body_integrator(&model, methods[_i]);
  long calls = 0;
  for (int i = 0; i < 40; i++) {
    dvi_status status;
    calls += count_calls_of_step(made, i < 20 ? 0.02 : 0.013, &status);
    ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  }
  ck_assert_int_eq(calls, 0);
  ck_assert_int_le(read_counters(made).preparations, PREPARATIONS_MOST);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

/* On the group, at the ends the states themselves, and between them right to the path's order. */
START_TEST(paths_between_states_are_those_of_the_group)
{
  body model;
  double q[BODY_Q], v[BODY_V];
  take_body_for(_i, &model);
  dvi_integrator *made = body_integrator(&model, methods[_i]),
                 *fine = body_integrator(&model, methods[_i]);
  advance(made, 0.02, 3);
  advance(fine, 0.01, 5);
  ck_assert_int_eq(dvi_integrator_interpolate(made, 0.06, q, v), DVI_OK);
  ck_assert_double_le(distance(model.nq, q, dvi_integrator_q(made)), 1e-14);
  ck_assert_int_eq(dvi_integrator_interpolate(made, 0.05, q, v), DVI_OK);
  ck_assert_double_le(dvi_system_distance(model.system, q), 1e-14);
  ck_assert_msg(distance(model.nq, q, dvi_integrator_q(fine)) < 1e-4, "%.1e",
                distance(model.nq, q, dvi_integrator_q(fine)));
  double found[BODY_V] = {0};
  ck_assert_int_eq(dvi_system_velocity(model.system, 0.05, dvi_integrator_q(fine),
                                       dvi_integrator_p(fine), found),
                   DVI_OK);
  ck_assert_msg(distance(model.nv, v, found) < 5e-2, "%.1e", distance(model.nv, v, found));
  dvi_integrator_destroy(&made);
  dvi_integrator_destroy(&fine);
  destroy_body(&model);
}
END_TEST

/* A step of the pendulum turns by about a tenth of a radian. The kept blocks serve for three steps
 * and more, and there are no more residuals than 17 digits take. */
START_TEST(steps_cost_what_they_did)
{
  body model;
  dvi_counters counters;
  make_body(PENDULUM_3D, &model);
  dvi_integrator *made = body_integrator(&model, "lie-galerkin:degree=3");
  advance(made, 0.01, 1000);
  dvi_integrator_counters(made, &counters);
  ck_assert_int_eq(counters.simplified, 1000);
  ck_assert_int_eq(counters.fixed_points, 0);
  ck_assert_msg(counters.jacobians <= 300, "%ld", (long)counters.jacobians);
  ck_assert_msg(counters.residuals <= 5600, "%ld", (long)counters.residuals);
  /* three nodes a residual, and starts */
  ck_assert_msg(counters.gradients <= 19000, "%ld", (long)counters.gradients);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

SUITE(lie_galerkin_hard)
{
  tcase_add_test(tests, fast_tops_keep_energy_and_spin);
  tcase_add_loop_test(tests, steps_of_nearly_half_a_turn_are_taken, 0, 3);
  tcase_add_test(tests, steps_are_those_of_a_fresh_start);
  tcase_add_loop_test(tests, more_than_half_a_turn_is_a_step_too_large, 0, 5);
  tcase_add_loop_test(tests, nearly_degenerate_bodies_keep_energy_and_momentum, 0, 3);
  tcase_add_loop_test(tests, steps_of_thin_bodies_are_solved, 0, THIN * DEGREES);
  tcase_add_loop_test(tests, failing_callbacks_are_named, 0, sizeof traps / sizeof *traps);
  tcase_add_loop_test(tests, a_start_too_fast_for_its_energy_is_refused, 0, 2);
  tcase_add_loop_test(tests, checkpoints_continue_bit_for_bit, 0, METHODS);
  tcase_add_loop_test(tests, no_step_allocates_but_to_prepare_a_solver, 0, METHODS);
  tcase_add_loop_test(tests, paths_between_states_are_those_of_the_group, 0, METHODS);
  tcase_add_test(tests, steps_cost_what_they_did);
}
