/* labels: unit order */
/* The trajectory inside the last step is right at the ends, has the promised order between them,
 * and exists only there. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

/* ---- the ends ---- */

static const char *const methods[] = {
    "galerkin:degree=1",
    "galerkin:degree=3,basis=gauss",
    "galerkin:degree=6,basis=chebyshev,quadrature=lobatto",
    "galerkin:degree=20,basis=legendre",
    "midpoint",
    "trapezoidal",
    "verlet",
    "composition:order=4,base=verlet",
    "composition:order=6,base=galerkin,degree=2",
    "prolongation-collocation:derivatives=1",
    "prolongation-collocation:derivatives=4",
};
enum { METHODS = sizeof methods / sizeof *methods };

/* The path's ends are sums of the same few numbers as the states, in another order, and differ by a
 * few roundings of numbers of size 1. Times are odd, so that t0 + h is rounded. */
START_TEST(the_path_passes_through_both_ends)
{
  const double rounding = 8 * DBL_EPSILON;
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  for (int step = 0; step < 20; step++) {
    const double from = dvi_integrator_time(integrator);
    double before[2], q[2];
    memcpy(before, dvi_integrator_q(integrator), sizeof before);
    advance(integrator, step % 2 == 0 ? 0.0317 : 0.0123, 1);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, from, q, NULL), DVI_OK);
    ck_assert_double_le(distance(2, q, before), rounding);
    ck_assert_int_eq(
        dvi_integrator_interpolate(integrator, dvi_integrator_time(integrator), q, NULL), DVI_OK);
    ck_assert_double_le(distance(2, q, dvi_integrator_q(integrator)), rounding);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* A step by fixed-point iteration leaves its path to those who ask, who may ask again. */
START_TEST(the_path_is_made_of_the_forces_of_the_step)
{
  static const struct {
    const char *problem, *method;
    double h, size;
  } runs[] = {{"outer-solar", "galerkin:degree=8", 50, 50},
              {"magnetic-bottle", "galerkin:degree=4", 0.05, 2},
              {"fpu", "galerkin:degree=5", 0.01, 2}};
  problem *model = create_problem(runs[_i].problem, NULL);
  dvi_integrator *integrator = start_integrator(model, runs[_i].method);
  dvi_counters counters;
  for (int step = 0; step < 4; step++) {
    const double from = dvi_integrator_time(integrator);
    double before[18], q[2][18];
    memcpy(before, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
    advance(integrator, runs[_i].h, 1);
    for (int again = 0; again < 2; again++) {
      ck_assert_int_eq(dvi_integrator_interpolate(integrator, from, q[again], NULL), DVI_OK);
      ck_assert_double_le(distance(model->nq, q[again], before), 1e-14 * runs[_i].size);
    }
    ck_assert_mem_eq(q[0], q[1], (size_t)model->nq * sizeof(double));
    ck_assert_int_eq(
        dvi_integrator_interpolate(integrator, dvi_integrator_time(integrator), q[0], NULL),
        DVI_OK);
    ck_assert_double_le(distance(model->nq, q[0], dvi_integrator_q(integrator)),
                        1e-14 * runs[_i].size);
  }
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.fixed_points, 4);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Hermite's cubic has the velocities that belong to the momenta at its ends. The mass is 1. */
START_TEST(the_cubic_has_the_velocities_of_the_ends)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  double v[2];
  advance(integrator, -0.05, 1);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, -0.05, NULL, v), DVI_OK);
  ck_assert_double_le(distance(2, v, dvi_integrator_p(integrator)), 1e-14);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, NULL, v), DVI_OK);
  ck_assert_double_le(distance(2, v, model->p), 1e-14);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(position_and_velocity_may_be_asked_for_alone)
{
  problem *model = create_problem("double-pendulum", NULL);
  const char *method = _i == 0 ? "galerkin:degree=3" : "composition:order=4,base=midpoint";
  dvi_integrator *integrator = start_integrator(model, method);
  double q[2], v[2], q_alone[2], v_alone[2];
  advance(integrator, 0.02, 3);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.047, q, v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.047, q_alone, NULL), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.047, NULL, v_alone), DVI_OK);
  ck_assert_mem_eq(q, q_alone, sizeof q);
  ck_assert_mem_eq(v, v_alone, sizeof v);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- the order between them ---- */

enum { LEVELS = 5, INSIDE = 8 };

/* Gives the largest error of q and v inside one step of h around t = 1, from the exact solution.
 * The middle stays, and so does the derivative that makes the error. */
static void errors_inside(const problem *model, dvi_integrator *integrator, double h,
                          double *q_error, double *v_error)
{
  double q[2], p[2], found_q[2], found_v[2];
  const double from = 1 - h / 2;
  ck_assert_int_eq(model->exact(model, from, q, p), 0);
  ck_assert_int_eq(dvi_integrator_start(integrator, from, q, p), DVI_OK);
  advance(integrator, h, 1);
  *q_error = *v_error = 0;
  for (int k = 1; k < INSIDE; k++) {
    const double t = from + h * k / (double)INSIDE;
    ck_assert_int_eq(model->exact(model, t, q, p), 0);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, t, found_q, found_v), DVI_OK);
    *q_error = fmax(*q_error, distance(model->nq, found_q, q));
    *v_error = fmax(*v_error, distance(model->nq, found_v, p));
  }
}

/* First steps for errors between 1e-3 and the floor of 1e-14, at which roundoff takes over. A path
 * of degree s is right to h^(s+1), its velocity to h^s, if the quadrature is of order 2s-1 or more;
 * one of a lower order u leaves h^(u-s+2). The composition's own error, h^5, lies below that of the
 * cubic, h^4, whose velocity is right to h^3; verlet's own, h^3 and h^2, lies above. */
static const struct {
  const char *method;
  int order;
  double h;
} paths[] = {
    {"midpoint", 2, 0.1},
    {"galerkin:degree=2", 3, 0.2},
    {"galerkin:degree=3", 4, 0.3},
    {"galerkin:degree=3,quadrature=lobatto", 4, 0.3},
    {"galerkin:degree=4,basis=chebyshev", 5, 0.4},
    {"galerkin:degree=5", 6, 0.35},
    {"galerkin:degree=6,basis=legendre", 7, 0.4},
    {"galerkin:degree=3,quadrature=radau-left,nodes=3", 4, 0.3},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 3, 0.2},
    {"galerkin:degree=4,quadrature=lobatto,nodes=4", 4, 0.3},
    {"galerkin:degree=3,quadrature=simpson", 3, 0.2},
    {"galerkin:degree=4,quadrature=clenshaw-curtis,nodes=4", 2, 0.05},
    {"trapezoidal", 2, 0.1},
    {"verlet", 3, 0.1},
    {"prolongation-collocation:derivatives=1", 2, 0.1},
    {"prolongation-collocation", 4, 0.1},
    {"prolongation-collocation:derivatives=4", 7, 0.2},
    {"composition:order=4,base=verlet", 4, 0.1},
    {"composition:order=8,base=midpoint", 4, 0.1},
};
enum { PATHS = sizeof paths / sizeof *paths };

static void check_order(const char *what, const double *h, const double *error, int order)
{
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(LEVELS, h, error, 1e-14, 0, &fit), DVI_OK);
  ck_assert_msg(fit.last - fit.first + 1 >= 4 && fabs(fit.slope - order) <= 0.2,
                "%s: %d levels, slope %.3f instead of %d", what, fit.last - fit.first + 1,
                fit.slope, order);
}

START_TEST(the_error_inside_a_step_has_the_order_of_the_path)
{
  double h[LEVELS], q_error[LEVELS], v_error[LEVELS];
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = create_integrator(model->system, paths[_i].method);
  for (int level = 0; level < LEVELS; level++) {
    h[level] = paths[_i].h * pow(0.5, 1 + 0.5 * level);
    errors_inside(model, integrator, h[level], &q_error[level], &v_error[level]);
  }
  check_order(method_spec("the path of %s", paths[_i].method), h, q_error, paths[_i].order);
  check_order(method_spec("the velocity of %s", paths[_i].method), h, v_error, paths[_i].order - 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- only there ---- */

START_TEST(times_outside_of_the_last_step_are_refused)
{
  const double outside[] = {0.29, 0.2999, 0.4001, 0.5, -1, (double)NAN, HUGE_VAL, -HUGE_VAL};
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  double q, v;
  advance(integrator, 0.1, 4);
  for (int k = 0; k < 8; k++) {
    q = v = 77;
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, outside[k], &q, &v), DVI_BAD_ARGUMENT);
    check_words("outside of the last step");
    ck_assert_double_eq(q, 77);
    ck_assert_double_eq(v, 77);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(without_a_step_there_is_no_path)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(model->system, methods[_i]);
  double q;
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, &q, NULL), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, &q, NULL), DVI_BAD_STATE);
  check_words("no step was taken yet");
  advance(integrator, 0.1, 1);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.05, &q, NULL), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, &q, NULL), DVI_BAD_STATE);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Compares the answers of another integrator about the middle of the last step. */
static void check_same_path(dvi_integrator *a, dvi_integrator *b, double t)
{
  double found[2][2];
  ck_assert_int_eq(dvi_integrator_interpolate(a, t, &found[0][0], &found[0][1]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(b, t, &found[1][0], &found[1][1]), DVI_OK);
  ck_assert_mem_eq(found[0], found[1], sizeof found[0]);
}

START_TEST(the_path_is_in_the_checkpoint)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *first = start_integrator(model, methods[_i]),
                 *second = create_integrator(model->system, methods[_i]);
  advance(first, 0.1, 4);
  ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(second, path_in_folder("checkpoint")), DVI_OK);
  for (int k = 0; k <= 10; k++) check_same_path(first, second, 0.3 + 0.01 * k);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}
END_TEST

SUITE(dense_output)
{
  tcase_set_timeout(tests, 60);
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, the_path_passes_through_both_ends, 0, METHODS);
  tcase_add_loop_test(tests, the_path_is_made_of_the_forces_of_the_step, 0, 3);
  tcase_add_test(tests, the_cubic_has_the_velocities_of_the_ends);
  tcase_add_loop_test(tests, position_and_velocity_may_be_asked_for_alone, 0, 2);
  tcase_add_loop_test(tests, the_error_inside_a_step_has_the_order_of_the_path, 0, PATHS);
  tcase_add_loop_test(tests, times_outside_of_the_last_step_are_refused, 0, METHODS);
  tcase_add_loop_test(tests, without_a_step_there_is_no_path, 0, METHODS);
  tcase_add_loop_test(tests, the_path_is_in_the_checkpoint, 0, METHODS);
}
