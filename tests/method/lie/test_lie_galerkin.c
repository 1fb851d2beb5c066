/* labels: order */
/* Galerkin steps in natural charts: orders, agreement of bases, symmetry under rotations, known
 * digits, refusals, and structures that steps keep. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dvi/diagnostics.h>
#include <dvi/group.h>

#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"
#include "system/chart/charted.h"

static body model;

static void forget_body(void)
{
  destroy_body(&model);
}

/* ---- an independent judge: the ordinary method in one chart that stays where it is ---- */

/* No factor turns by half a turn in this time. */
static const double spans[BODIES] = {3, 0.25, 0.018, 1.5, 1, 0.2, 1.5, 0.6};
static double span;

/* The body of a looped test. */
static void take_body(int kind)
{
  make_body((body_kind)kind, &model);
  span = spans[kind];
}

typedef struct state {
  double q[BODY_Q], p[BODY_V];
} state;

/* Judges by galerkin of degree 8, with the Lagrangian in one chart as an ordinary one. The chart
 * stays where it is. */
static void advance_by_judge(state *end)
{
  dvi_counters counters = {0};
  dvi__charted *charts;
  dvi_integrator *made;
  double zero[BODY_V] = {0}, rate[BODY_V], v[BODY_V];
  ck_assert_msg(dvi__charted_create(model.system, 0, &counters, &charts) == DVI_OK, "%s",
                dvi_last_error());
  dvi__charted_centre(charts, model.q);
  dvi__charted_enter(charts, model.v, rate);
  made = create_integrator(dvi__charted_system(charts), "galerkin:degree=8");
  ck_assert_msg(dvi_integrator_start_velocity(made, 0, zero, rate) == DVI_OK, "%s",
                dvi_last_error());
  advance(made, span / 16, 16);
  ck_assert_int_eq(dvi_system_velocity(dvi__charted_system(charts), span, dvi_integrator_q(made),
                                       dvi_integrator_p(made), rate),
                   DVI_OK);
  dvi__charted_point(charts, dvi_integrator_q(made), rate, end->q, v);
  ck_assert_int_eq(dvi_system_momentum(model.system, span, end->q, v, end->p), DVI_OK);
  dvi_integrator_destroy(&made);
  dvi__charted_destroy(&charts);
}

static void run(const char *method, double h, long steps, state *end)
{
  dvi_integrator *made = body_integrator(&model, method);
  advance(made, h, steps);
  memcpy(end->q, dvi_integrator_q(made), (size_t)model.nq * sizeof *end->q);
  memcpy(end->p, dvi_integrator_p(made), (size_t)model.nv * sizeof *end->p);
  dvi_integrator_destroy(&made);
}

static double state_distance(const state *a, const state *b)
{
  return fmax(distance(model.nq, a->q, b->q),
              distance(model.nv, a->p, b->p) / magnitude(model.nv, b->p));
}

/* The judge errs by roundoff of 16 steps and of the comparison. */
static void check_order_of(const char *method, int order)
{
  static const int steps[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192};
  enum { COUNT = sizeof steps / sizeof *steps };
  double h[COUNT], error[COUNT];
  state exact, end;
  dvi_order_fit fit;
  advance_by_judge(&exact);
  for (int k = 0; k < COUNT; k++) {
    h[k] = span / steps[k];
    run(method, h[k], steps[k], &end);
    error[k] = state_distance(&end, &exact);
    if (getenv("DVI_SHOW_ORDERS") != NULL)
      printf("%s, %s: h = %.4g, error %.2e\n", model.name, method, h[k], error[k]);
  }
  ck_assert_msg(dvi_order(COUNT, h, error, 4e-13, fmax(pow(10, -order - 1), 1e-9), &fit) == DVI_OK,
                "%s, %s: no window", model.name, method);
  ck_assert_msg(fabs(fit.slope - order) < 0.4, "%s, %s: order %.2f, not %d", model.name, method,
                fit.slope, order);
}

START_TEST(gauss_has_order_2s)
{
  take_body(_i);
  for (int s = 1; s <= 4; s++) check_order_of(method_spec("lie-galerkin:degree=%d", s), 2 * s);
}
END_TEST

/* Between the chart's bound and roundoff errors leave a window of a factor of two in h. */
START_TEST(degree_5_has_order_10)
{
  take_body(_i == 0 ? FREE_BODY : MOTION);
  check_order_of("lie-galerkin:degree=5", 10);
}
END_TEST

START_TEST(lobatto_with_one_node_more_has_order_2s)
{
  take_body(_i);
  for (int s = 1; s <= 4; s++)
    check_order_of(method_spec("lie-galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1),
                   2 * s);
}
END_TEST

/* ---- what does not depend on how it is computed ---- */

START_TEST(all_bases_and_solvers_agree)
{
  static const char *const basis[] = {"chebyshev", "legendre", "lobatto"}, *const solver[] = {
                                                                               "fixed-point",
                                                                               "newton", "kinsol",
                                                                               "certified"};
  state first, other;
  take_body(_i);
  run("lie-galerkin:degree=4", span / 10, 10, &first);
  for (size_t k = 0; k < sizeof basis / sizeof *basis; k++) {
    run(method_spec("lie-galerkin:degree=4,basis=%s", basis[k]), span / 10, 10, &other);
    ck_assert_msg(state_distance(&first, &other) < 1e-12, "%s, %s: %.1e", model.name, basis[k],
                  state_distance(&first, &other));
  }
  for (size_t k = 0; k < sizeof solver / sizeof *solver; k++) {
    run(method_spec("lie-galerkin:degree=4,solver=%s", solver[k]), span / 10, 10, &other);
    ck_assert_msg(state_distance(&first, &other) < 1e-12, "%s, %s: %.1e", model.name, solver[k],
                  state_distance(&first, &other));
  }
}
END_TEST

/* ---- symmetries ---- */

/* Turn a stored state in space. Body components stay. */
static void turn_vector(const double *A, double *x)
{
  const double y[] = {x[0], x[1], x[2]};
  for (int i = 0; i < 3; i++) x[i] = A[3 * i] * y[0] + A[3 * i + 1] * y[1] + A[3 * i + 2] * y[2];
}

static void turn_state(const double *A, double *q, double *second)
{
  int v = 0;
  for (int f = 0; f < model.factor_count; f++) {
    const dvi_factor_kind kind = model.factors[f].kind;
    const int body_turns = kind == DVI_SO3 || kind == DVI_SE3;
    for (int j = 0; j < 3 && body_turns; j++) {
      double column[] = {q[j], q[3 + j], q[6 + j]};
      turn_vector(A, column);
      for (int i = 0; i < 3; i++) q[3 * i + j] = column[i];
    }
    if (kind == DVI_SE3) turn_vector(A, q + 9), turn_vector(A, second + v + 3);
    if (kind == DVI_S2) turn_vector(A, q), turn_vector(A, second + v);
    q += kind == DVI_SE3 ? 12 : kind == DVI_SO3 ? 9 : 3;
    v += kind == DVI_SE3 ? 6 : 3;
  }
}

/* Turns about the vertical, and any turn where there is no weight. */
START_TEST(turned_starts_have_turned_trajectories)
{
  static const int kinds[] = {FREE_BODY, PENDULUM_3D, HEAVY_TOP, FREE_MOTION, DIRECTIONS};
  take_body(kinds[_i]);
  const double any[] = {0.7, -1.1, 2.1}, vertical[] = {0, 0, 2.3};
  double A[9];
  state end, turned;
  dvi_so3_exp(kinds[_i] == FREE_BODY || kinds[_i] == FREE_MOTION ? any : vertical, A);
  run("lie-galerkin:degree=3", span / 5, 5, &end);
  turn_state(A, model.q, model.v);
  run("lie-galerkin:degree=3", span / 5, 5, &turned);
  turn_state(A, end.q, end.p);
  ck_assert_msg(state_distance(&end, &turned) < 1e-13, "%s: %.1e", model.name,
                state_distance(&end, &turned));
}
END_TEST

/* Gives the momentum in space of free bodies, R Pi, and x x p + R Pi. */
static void space_momentum(const state *at, double *mu)
{
  const double *R = at->q, *p = at->p, *x = at->q + 9;
  for (int i = 0; i < 3; i++) mu[i] = R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2];
  if (model.nq < 12) return;
  mu[0] += x[1] * p[5] - x[2] * p[4];
  mu[1] += x[2] * p[3] - x[0] * p[5];
  mu[2] += x[0] * p[4] - x[1] * p[3];
}

START_TEST(free_bodies_keep_all_of_their_momenta)
{
  take_body(_i == 0 ? FREE_BODY : FREE_MOTION);
  state start, end;
  double before[3], after[3];
  run("lie-galerkin:degree=2", 0.1, 1, &start);
  run("lie-galerkin:degree=2", 0.1, 1000, &end);
  space_momentum(&start, before);
  space_momentum(&end, after);
  ck_assert_msg(distance(3, before, after) < 1e-13 * magnitude(3, before) * 10, "%.1e",
                distance(3, before, after));
  if (model.nq == 12) ck_assert_double_le(distance(3, start.p + 3, end.p + 3), 1e-14);
}
END_TEST

/* With weight the momentum about the vertical is kept. The steps are so long that a centre that
 * does not move (system/chart/centring.h) would lose 1e-6. */
START_TEST(vertical_momentum_is_kept)
{
  static const int kinds[] = {PENDULUM_3D, HEAVY_TOP, DIRECTIONS};
  take_body(kinds[_i]);
  dvi_integrator *made = body_integrator(&model, "lie-galerkin:degree=2");
  double before[2], after[2];
  ck_assert_int_eq(dvi_integrator_invariants(made, before), DVI_OK);
  advance(made, span / 16, 1000);
  ck_assert_int_eq(dvi_integrator_invariants(made, after), DVI_OK);
  ck_assert_msg(fabs(after[1] - before[1]) < 1e-13 * fmax(1, fabs(before[1])), "%s: %.1e",
                model.name, after[1] - before[1]);
  ck_assert_double_le(dvi_system_distance(model.system, dvi_integrator_q(made)), 1e-13);
  dvi_integrator_destroy(&made);
}
END_TEST

/* A path of degree 1 is the same from its other end, because it is a one-parameter subgroup or a
 * great circle. A polynomial of higher degree in the chart at its start is none in the chart at its
 * end, unless the chart is that of a line or a circle. */
START_TEST(steps_back_undo_steps_of_degree_1)
{
  take_body(_i);
  dvi_integrator *made = body_integrator(&model, _i == ANGLE ? "lie-galerkin:degree=3"
                                                             : "lie-galerkin:degree=1");
  advance(made, span / 8, 8);
  advance(made, -span / 8, 8);
  ck_assert_msg(distance(model.nq, dvi_integrator_q(made), model.q) < 1e-13, "%s: %.1e", model.name,
                distance(model.nq, dvi_integrator_q(made), model.q));
  dvi_integrator_destroy(&made);
}
END_TEST

/* Differences err by 1e-10, by more for motions that turn far in the step. */
START_TEST(steps_are_symplectic)
{
  take_body(_i);
  for (int s = 1; s <= 3; s++) {
    const double defect = symplectic_defect(&model, method_spec("lie-galerkin:degree=%d", s),
                                            span / 4);
    ck_assert_msg(defect < 1e-8, "%s, degree %d: %.1e", model.name, s, defect);
  }
}
END_TEST

/* ---- digits ---- */

static void check_digits(const double *found, const double *known, double tolerance)
{
  ck_assert_msg(distance(3, found, known) < tolerance, "%s: (%.15g, %.15g, %.15g)", model.name,
                found[0], found[1], found[2]);
}

/* The digits of the free body come from its Taylor series in 40 digits, the others from
 * Gauss-Legendre of order 12 at two steps, which agree. */
START_TEST(known_digits_are_met)
{
  const double pendulum[] = {-6.751473860336227, .1484346732487297, 3.362315606396518},
               free[] = {.4671205340262394, .6269711557238373, -.1811252970621062},
               axis[] = {.1733439640983860, .6400885920705688, -.7484907911335813};
  state end;
  take_body(PENDULUM_3D);
  run("lie-galerkin:degree=6", 0.02, 50, &end);
  const double Omega[] = {end.p[0] / .13, end.p[1] / .28, end.p[2] / .17};
  check_digits(Omega, pendulum, 1e-12);
  forget_body();
  take_body(FREE_BODY);
  run("lie-galerkin:degree=8", 0.2, 50, &end);
  const double of_free[] = {end.p[0] / 3, end.p[1] / 2, end.p[2] / 1.5};
  check_digits(of_free, free, 1e-13);
  forget_body();
  take_body(HEAVY_TOP);
  run("lie-galerkin:degree=6", 0.005, 200, &end);
  const double e2[] = {end.q[1], end.q[4], end.q[7]};
  check_digits(e2, axis, 1e-12);
  ck_assert_double_eq_tol(end.p[1] / .46875, 150, 1e-12);
}
END_TEST

SUITE(lie_galerkin)
{
  tcase_add_checked_fixture(tests, NULL, forget_body);
  tcase_add_loop_test(tests, gauss_has_order_2s, 0, BODIES);
  tcase_add_loop_test(tests, degree_5_has_order_10, 0, 2);
  tcase_add_loop_test(tests, lobatto_with_one_node_more_has_order_2s, 0, BODIES);
  tcase_add_loop_test(tests, all_bases_and_solvers_agree, 0, BODIES);
  tcase_add_loop_test(tests, turned_starts_have_turned_trajectories, 0, 5);
  tcase_add_loop_test(tests, free_bodies_keep_all_of_their_momenta, 0, 2);
  tcase_add_loop_test(tests, vertical_momentum_is_kept, 0, 3);
  tcase_add_loop_test(tests, steps_back_undo_steps_of_degree_1, 0, BODIES);
  tcase_add_loop_test(tests, steps_are_symplectic, 0, BODIES);
  tcase_add_test(tests, known_digits_are_met);
}
