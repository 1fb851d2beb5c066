/* labels: unit */
/* Steps in a fictitious time: conserved quantities, ends of runs, checkpoints. */
#include <math.h>
#include <string.h>

#include "support/files.h"
#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"

/* Every way to have them. */
static const struct {
  const char *problem, *setting, *monitor, *method;
  paced_create create;
  double h;
} ways[] = {
    {"kepler", "e=0.9", "distance", "midpoint", create_transformed, 0.1},
    {"kepler", "e=0.9", "distance", "trapezoidal", create_transformed, 0.1},
    {"kepler", "e=0.9", "distance", "galerkin:degree=4", create_transformed, 0.4},
    {"kepler", "e=0.9", "distance", "galerkin:degree=4,solver=newton", create_transformed, 0.6},
    {"kepler", "e=0.9", "distance", "composition:order=4,base=midpoint", create_transformed, 0.3},
    {"kepler", "e=0.9", "distance", "shooting:onestep=gauss", create_transformed, 0.1},
    {"kepler", "e=0.9", "distance", "shooting:onestep=gauss,solve=stages", create_transformed, 0.1},
    {"kepler", "e=0.9", "distance", "multiscale:fast=0:1,omega=1", create_transformed, 0.2},
    {"kepler", NULL, "arclength", "galerkin", create_transformed, 0.2},
    {"kepler", NULL, "acceleration", "galerkin", create_transformed, 0.2},
    {"pythagorean", NULL, "distance:bodies=3", "galerkin:degree=8", create_transformed, 0.2},
    {"kepler", "e=0.9", "distance", "verlet", create_controlled, 0.05},
    {"kepler", "e=0.9", "distance", "galerkin", create_controlled, 0.1},
    {"kepler", NULL, "arclength", "composition:order=6", create_controlled, 0.2},
    {"chain", "n=50", "acceleration:power=0.2", "verlet:blocking=temporal", create_controlled, 0.1},
};
enum { WAYS = sizeof ways / sizeof *ways, MOST = 64 };

static problem *scene(int i)
{
  return create_problem(ways[i].problem, ways[i].setting);
}

static dvi_integrator *way(const problem *model, int i)
{
  return start_paced_integrator(model, ways[i].create, ways[i].monitor, ways[i].method);
}

/* ---- what is conserved ---- */

/* 16 to 27 n steps, with a floor below which differences resolve nothing */
START_TEST(a_step_in_tau_is_symplectic)
{
  static const char *const methods[] = {"midpoint",
                                        "trapezoidal",
                                        "galerkin:degree=3",
                                        "galerkin:degree=2,quadrature=radau-left",
                                        "composition:order=4,base=midpoint",
                                        "shooting",
                                        "shooting:type=2",
                                        "shooting:type=3",
                                        "multiscale:fast=0:1,omega=1"};
  static const char *const monitors[] = {"distance", "distance:power=1", "arclength",
                                         "acceleration"};
  problem *kepler = create_problem("kepler", "e=0.6");
  for (int m = 0; m < 4; m++) {
    dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, monitors[m],
                                                        methods[_i]);
    double defect;
    advance(integrator, 0.3, 3);
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, dvi_integrator_q(integrator),
                                       dvi_integrator_p(integrator), 0.3, &defect),
                     DVI_OK);
    ck_assert_msg(defect < 1e-10, "%s, %s: %g", methods[_i], monitors[m], defect);
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&kepler);
}
END_TEST

/* The test above can fail, as the method's page says. */
START_TEST(a_controlled_step_is_not_symplectic)
{
  problem *kepler = create_problem("kepler", "e=0.6");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_controlled, "distance",
                                                      "midpoint");
  double defect;
  advance(integrator, 0.3, 3);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, dvi_integrator_q(integrator),
                                     dvi_integrator_p(integrator), 0.3, &defect),
                   DVI_OK);
  ck_assert_double_gt(defect, 1e-3);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

/* A hundred steps through the pericentre and back, which amplify roundoff. */
START_TEST(steps_back_undo_steps)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  double defect;
  ck_assert_msg(dvi_reversibility(integrator, 0, model->q, model->p, ways[_i].h, repeats(100),
                                  &defect) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(defect < 1e-9, "%s: %g", ways[_i].method, defect);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 0, 1e-9);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Distances do not change under rotations, so the momentum of the new system is that of the old. */
START_TEST(angular_momentum_is_conserved)
{
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=2");
  double before[4], after[4];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  advance(integrator, 0.1, 2000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  /* 2000 roundings that walk at random, twice over */
  ck_assert_double_eq_tol(after[1], before[1], 1e-13 * before[1]);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(a_step_takes_no_memory)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  dvi_counters before, after;
  advance(integrator, ways[_i].h, 1);
  for (int i = 0; i < 40; i++) {
    dvi_integrator_counters(integrator, &before);
    advance(integrator, ways[_i].h, 1);
    dvi_integrator_counters(integrator, &after);
    if (after.preparations == before.preparations)
      ck_assert_int_eq(after.allocations, before.allocations);
  }
  ck_assert_int_le(after.preparations, 8);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- runs ---- */

static int clock_goes_on(dvi_integrator *integrator, void *user)
{
  double *last = user;
  if (!(dvi_integrator_time(integrator) > *last) || !(dvi_integrator_time(integrator) <= 3))
    return -1;
  *last = dvi_integrator_time(integrator);
  return 0;
}

START_TEST(a_run_ends_at_its_physical_time)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  double last = -1;
  dvi_run_report report;
  const dvi_run_options options = {
      .h = ways[_i].h, .t_end = 3, .observe = clock_goes_on, .user = &last};
  ck_assert_msg(dvi_run(integrator, &options, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
  ck_assert_double_eq(dvi_integrator_time(integrator), 3);
  run_to(integrator, -ways[_i].h, 1);
  ck_assert_double_eq(dvi_integrator_time(integrator), 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static int clock_value(double t, const double *q, const double *v, double *g, void *user)
{
  (void)q, (void)v, (void)user;
  *g = t - 3;
  return 0;
}

START_TEST(an_event_at_the_end_is_seen)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  dvi_run_report report;
  const dvi_event at_end = {.value = clock_value};
  const dvi_run_options options = {
      .h = ways[_i].h, .t_end = 3, .events = &at_end, .event_count = 1};
  ck_assert_msg(dvi_run(integrator, &options, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(report.events, 1);
  ck_assert_double_eq(report.event_time, 3);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_terminal_event_ends_the_run_at_its_time)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  dvi_run_report report;
  const dvi_event end = {.value = clock_value, .terminal = 1};
  const dvi_run_options options = {.h = ways[_i].h, .t_end = 5, .events = &end, .event_count = 1};
  ck_assert_msg(dvi_run(integrator, &options, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(report.end, DVI_RUN_EVENT);
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 3, 1e-12);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Compares with the exact solution. Degree 8 with short steps has a negligible error at the ends
 * and inside. */
START_TEST(dense_output_is_in_physical_time)
{
  problem *kepler = create_problem("kepler", "e=0.9");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=8");
  double q[2], v[2], exact_q[2], exact_p[2];
  for (int step = 0; step < 60; step++) {
    const double from = dvi_integrator_time(integrator);
    advance(integrator, 0.1, 1);
    for (int part = 0; part <= 5; part++) {
      const double t = part == 5 ? dvi_integrator_time(integrator)
                                 : from + 0.2 * part * (dvi_integrator_time(integrator) - from);
      ck_assert_int_eq(dvi_integrator_interpolate(integrator, t, q, v), DVI_OK);
      ck_assert_int_eq(kepler->exact(kepler, t, exact_q, exact_p), 0);
      ck_assert_double_le(distance(2, q, exact_q), 1e-11);
      /* velocities up to 4.4, their times right to some 1e-13 */
      ck_assert_double_le(distance(2, v, exact_p), 1e-9);
    }
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(dense_output_meets_the_ends_of_a_step)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i);
  double q[MOST];
  ck_assert_int_le(model->nq, MOST);
  advance(integrator, ways[_i].h, 5);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, dvi_integrator_time(integrator), q, NULL),
                   DVI_OK);
  ck_assert_double_le(distance(model->nq, q, dvi_integrator_q(integrator)),
                      4e-16 * magnitude(model->nq, q) * model->nq);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- checkpoints ---- */

START_TEST(a_restored_run_continues_bit_for_bit)
{
  problem *model = scene(_i);
  dvi_integrator *first = way(model, _i), *second = way(model, _i);
  advance(second, 0.5 * ways[_i].h, 2);
  for (int step = 0; step < 30; step++) {
    ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("checkpoint")), DVI_OK);
    ck_assert_msg(dvi_integrator_restore(second, path_in_folder("checkpoint")) == DVI_OK, "%s",
                  dvi_last_error());
    advance(first, ways[_i].h, 1);
    advance(second, ways[_i].h, 1);
    check_same_state(first, second);
  }
  run_to(first, ways[_i].h, dvi_integrator_time(first) + 1);
  run_to(second, ways[_i].h, dvi_integrator_time(second) + 1);
  check_same_state(first, second);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_checkpoint_of_another_monitor_is_refused)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_integrator *others[] = {
      start_paced_integrator(kepler, create_transformed, "distance", "midpoint"),
      start_paced_integrator(kepler, create_transformed, "distance:power=1", "midpoint"),
      start_paced_integrator(kepler, create_controlled, "distance", "midpoint"),
      start_integrator(kepler, "midpoint")};
  for (int i = 0; i < 4; i++) {
    ck_assert_int_eq(dvi_integrator_save(others[i], path_in_folder("checkpoint")), DVI_OK);
    for (int k = 0; k < 4; k++) {
      const dvi_status status = dvi_integrator_restore(others[k], path_in_folder("checkpoint"));
      ck_assert_int_eq(status, i == k ? DVI_OK : DVI_BAD_FILE);
    }
  }
  for (int i = 0; i < 4; i++) dvi_integrator_destroy(&others[i]);
  problem_destroy(&kepler);
}
END_TEST

/* ---- queries ---- */

START_TEST(one_like_another_takes_the_same_steps)
{
  problem *model = scene(_i);
  dvi_integrator *integrator = way(model, _i), *like;
  ck_assert_msg(dvi_integrator_create_like(integrator, &like) == DVI_OK, "%s", dvi_last_error());
  ck_assert_str_eq(dvi_integrator_method(like), dvi_integrator_method(integrator));
  ck_assert_str_eq(dvi_integrator_monitor(like), dvi_integrator_monitor(integrator));
  ck_assert_int_eq(dvi_integrator_start(like, 0, model->q, model->p), DVI_OK);
  advance(like, ways[_i].h, 3);
  advance(integrator, ways[_i].h, 3);
  check_same_state(like, integrator);
  dvi_integrator_destroy(&like);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* By how much ten steps from a start of another energy change the energy. */
static double energy_change(dvi_integrator *integrator, const double *q, const double *p)
{
  double before[4], after[4];
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  advance(integrator, 0.1, 10);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  return fabs(after[0] - before[0]);
}

/* The docstring warns of this. An integrator of its own takes every start's own energy. */
START_TEST(one_like_another_keeps_its_E0)
{
  problem *kepler = create_problem("kepler", "e=0.5");
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "galerkin:degree=8"),
                 *like;
  const double q[] = {1.2, 0}, p[] = {0, 1};
  ck_assert_int_eq(dvi_integrator_create_like(integrator, &like), DVI_OK);
  ck_assert_double_gt(energy_change(like, q, p), 1e-3);
  ck_assert_double_le(energy_change(integrator, q, p), 1e-12);
  dvi_integrator_destroy(&like);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(explain_says_what_a_step_is)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_paced_integrator(kepler, create_transformed, "distance",
                                                      "midpoint");
  char text[2000];
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "time: transformed, dt/dtau = g(q), distance:power=1.5"));
  ck_assert_str_eq(dvi_integrator_monitor(integrator), "distance:power=1.5,bodies=1,dimension=2");
  ck_assert_ptr_eq(dvi_integrator_system(integrator), kepler->system);
  dvi_integrator_destroy(&integrator);
  integrator = create_integrator(kepler->system, "midpoint");
  ck_assert_ptr_null(dvi_integrator_monitor(integrator));
  ck_assert_ptr_null(dvi_integrator_monitor(NULL));
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

SUITE(transform)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_step_in_tau_is_symplectic, 0, 9);
  tcase_add_test(tests, a_controlled_step_is_not_symplectic);
  tcase_add_loop_test(tests, steps_back_undo_steps, 0, WAYS);
  tcase_add_test(tests, angular_momentum_is_conserved);
  tcase_add_loop_test(tests, a_step_takes_no_memory, 0, WAYS);
  tcase_add_loop_test(tests, a_run_ends_at_its_physical_time, 0, WAYS);
  tcase_add_loop_test(tests, an_event_at_the_end_is_seen, 0, WAYS);
  tcase_add_loop_test(tests, a_terminal_event_ends_the_run_at_its_time, 0, WAYS);
  tcase_add_test(tests, dense_output_is_in_physical_time);
  tcase_add_loop_test(tests, dense_output_meets_the_ends_of_a_step, 0, WAYS);
  tcase_add_loop_test(tests, a_restored_run_continues_bit_for_bit, 0, WAYS);
  tcase_add_test(tests, a_checkpoint_of_another_monitor_is_refused);
  tcase_add_loop_test(tests, one_like_another_takes_the_same_steps, 0, WAYS);
  tcase_add_test(tests, one_like_another_keeps_its_E0);
  tcase_add_test(tests, explain_says_what_a_step_is);
}
