/* labels: order slow */
/* Bodies in joints: orders, known digits, what is kept, the judge, starts and refusals. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dvi/diagnostics.h>
#include <dvi/reference.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/machines.h"
#include "system/chart/charted.h"

static machine model;

static void forget_machine(void)
{
  destroy_machine(&model);
}

static void take_machine(int kind)
{
  make_machine((machine_kind)kind, &model);
}

typedef struct state {
  double q[BODY_Q], p[BODY_V];
} state;

static void read_end(const dvi_integrator *made, state *end)
{
  memcpy(end->q, dvi_integrator_q(made), (size_t)model.body.nq * sizeof *end->q);
  memcpy(end->p, dvi_integrator_p(made), (size_t)model.body.nv * sizeof *end->p);
}

static void run(const char *method, double span, long steps, state *end)
{
  dvi_integrator *made = body_integrator(&model.body, method);
  advance(made, span / (double)steps, steps);
  read_end(made, end);
  dvi_integrator_destroy(&made);
}

/* ---- orders ---- */

/* Judges by galerkin of degree 6 in one chart that stays where it is, with the constraints as
 * ordinary ones of R^n. */
static void advance_by_judge(state *end)
{
  dvi_counters counters = {0};
  dvi__charted *charts;
  double zero[BODY_V] = {0}, rate[BODY_V], v[BODY_V];
  ck_assert_int_eq(dvi__charted_create(model.body.system, 0, &counters, &charts), DVI_OK);
  dvi__charted_centre(charts, model.body.q);
  dvi__charted_enter(charts, model.body.v, rate);
  dvi_integrator *made = create_integrator(dvi__charted_system(charts), "galerkin:degree=6");
  ck_assert_msg(dvi_integrator_start_velocity(made, 0, zero, rate) == DVI_OK, "%s",
                dvi_last_error());
  advance(made, model.span / 24, 24);
  ck_assert_int_eq(dvi_system_velocity(dvi__charted_system(charts), model.span,
                                       dvi_integrator_q(made), dvi_integrator_p(made), rate),
                   DVI_OK);
  dvi__charted_point(charts, dvi_integrator_q(made), rate, end->q, v);
  ck_assert_int_eq(dvi_system_momentum(model.body.system, model.span, end->q, v, end->p), DVI_OK);
  dvi_integrator_destroy(&made);
  dvi__charted_destroy(&charts);
}

static double state_distance(const state *a, const state *b)
{
  return fmax(distance(model.body.nq, a->q, b->q),
              distance(model.body.nv, a->p, b->p) / magnitude(model.body.nv, b->p));
}

static void check_order_of(const char *method, int order, const state *exact)
{
  static const int steps[] = {4, 6, 8, 12, 16, 24, 32, 48, 64, 96};
  enum { COUNT = sizeof steps / sizeof *steps };
  double h[COUNT], error[COUNT];
  dvi_order_fit fit;
  for (int k = 0; k < COUNT; k++) {
    state end;
    h[k] = model.span / steps[k];
    run(method, model.span, steps[k], &end);
    error[k] = state_distance(&end, exact);
    if (getenv("DVI_SHOW_ORDERS") != NULL)
      printf("%s, %s: h = %.4g, error %.2e\n", model.body.name, method, h[k], error[k]);
  }
  ck_assert_msg(dvi_order(COUNT, h, error, 2e-12, 1e-3, &fit) == DVI_OK, "%s, %s: no window",
                model.body.name, method);
  ck_assert_msg(fabs(fit.slope - order) < 0.4, "%s, %s: order %.2f, not %d", model.body.name,
                method, fit.slope, order);
}

START_TEST(steps_have_order_2s)
{
  state exact;
  take_machine(_i);
  advance_by_judge(&exact);
  for (int s = 1; s <= 3; s++) {
    check_order_of(method_spec("lie-galerkin:degree=%d", s), 2 * s, &exact);
    check_order_of(method_spec("lie-galerkin:degree=%d,quadrature=lobatto,nodes=%d", s, s + 1),
                   2 * s, &exact);
  }
}
END_TEST

START_TEST(steps_of_verlet_have_order_2_and_compose)
{
  state exact;
  take_machine(_i);
  advance_by_judge(&exact);
  check_order_of("lie-verlet", 2, &exact);
  check_order_of("composition:order=4,base=lie-verlet", 4, &exact);
}
END_TEST

/* ---- digits ---- */

/* The same pendulums without joints: an angle, and a rotation. */
START_TEST(pendulums_have_the_digits_of_those_without_joints)
{
  state end;
  take_machine(HINGE_PENDULUM);
  memset(model.body.v, 0, sizeof model.body.v);
  run("lie-galerkin:degree=3", 3, 2048, &end);
  ck_assert_double_eq_tol(atan2(end.q[7], end.q[8]), 1.34272056960873, 2e-13);
  run("composition:order=8,base=lie-verlet", 3, 1024, &end);
  ck_assert_double_eq_tol(atan2(end.q[7], end.q[8]), 1.34272056960873, 2e-12);
  destroy_machine(&model);
  take_machine(BALL_PENDULUM);
  run("lie-galerkin:degree=4", 1, 200, &end);
  body rotation;
  make_body(PENDULUM_3D, &rotation);
  dvi_integrator *other = create_integrator(rotation.system, "lie-galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start_velocity(other, 0, model.body.q, model.body.v), DVI_OK);
  advance(other, 1.0 / 200, 200);
  ck_assert_double_le(distance(9, end.q, dvi_integrator_q(other)), 1e-12);
  dvi_integrator_destroy(&other);
  destroy_body(&rotation);
}
END_TEST

/* IDA shares neither charts nor solvers with the methods. */
START_TEST(ida_ends_where_steps_do)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-12};
  state exact, by_ida;
  take_machine(_i);
  run("lie-galerkin:degree=4", model.span, 64, &exact);
  memcpy(by_ida.q, model.body.q, sizeof by_ida.q);
  ck_assert_int_eq(dvi_system_momentum(model.body.system, 0, by_ida.q, model.body.v, by_ida.p),
                   DVI_OK);
  ck_assert_msg(dvi_reference_solve(model.body.system, 0, model.span, by_ida.q, by_ida.p, &tight,
                                    NULL) == DVI_OK,
                "%s: %s", model.body.name, dvi_last_error());
  ck_assert_msg(state_distance(&by_ida, &exact) < 1e-8, "%s: IDA is %.1e away", model.body.name,
                state_distance(&by_ida, &exact));
}
END_TEST

/* ---- what is kept ---- */

START_TEST(steps_are_symplectic)
{
  take_machine(_i);
  for (int s = 1; s <= 3; s++) {
    const double defect = symplectic_defect(&model.body, method_spec("lie-galerkin:degree=%d", s),
                                            model.span / 8);
    ck_assert_msg(defect < 1e-8, "%s, degree %d: %.1e", model.body.name, s, defect);
  }
  const double by_verlet = symplectic_defect(&model.body, "lie-verlet", model.span / 16);
  ck_assert_msg(by_verlet < 1e-8, "%s, lie-verlet: %.1e", model.body.name, by_verlet);
}
END_TEST

static void check_long_run(const char *method, double span, double bound)
{
  double first, energy, off, worst = 0, farthest = 0, apart = 0;
  dvi_integrator *made = body_integrator(&model.body, method);
  ck_assert_int_eq(dvi_integrator_invariant(made, 0, &first), DVI_OK);
  for (int k = 0; k < repeats(2000); k++) {
    advance(made, span, 1);
    ck_assert_int_eq(dvi_integrator_constraint(made, &off), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariant(made, 0, &energy), DVI_OK);
    farthest = fmax(farthest, off / (1 + magnitude(model.body.nq, dvi_integrator_q(made))));
    worst = fmax(worst, fabs(energy - first));
    apart = fmax(apart, dvi_system_distance(model.body.system, dvi_integrator_q(made)));
  }
  ck_assert_msg(farthest < 3e-15, "%s: |phi| = %.1e", model.body.name, farthest);
  ck_assert_msg(apart < 2e-15, "%s: %.1e from the manifold", model.body.name, apart);
  ck_assert_msg(worst < bound * (1 + fabs(first)), "%s: the energy is off by %.1e", model.body.name,
                worst);
  dvi_integrator_destroy(&made);
}

START_TEST(constraints_hold_to_rounding_and_the_energy_is_bounded)
{
  take_machine(_i);
  check_long_run("lie-galerkin:degree=2", model.span / 32, 1e-3);
  check_long_run("lie-verlet", model.span / 64, 2e-2);
}
END_TEST

/* Adds the linear and the angular momentum in space. */
static void momenta_of_pair(const dvi_integrator *made, double *total)
{
  const double *q = dvi_integrator_q(made), *p = dvi_integrator_p(made);
  memset(total, 0, 6 * sizeof *total);
  for (int k = 0; k < 2; k++, q += 12, p += 6)
    for (int i = 0; i < 3; i++) {
      const double *x = q + 9, *linear = p + 3;
      total[i] += linear[i];
      total[3 + i] += q[3 * i] * p[0] + q[3 * i + 1] * p[1] + q[3 * i + 2] * p[2] +
                      x[(i + 1) % 3] * linear[(i + 2) % 3] - x[(i + 2) % 3] * linear[(i + 1) % 3];
    }
}

START_TEST(momenta_of_a_free_pair_are_kept)
{
  double first[6], last[6];
  take_machine(FREE_PAIR);
  dvi_integrator *made = body_integrator(
      &model.body, _i == 0 ? "lie-verlet" : method_spec("lie-galerkin:degree=%d", _i));
  momenta_of_pair(made, first);
  for (int k = 0; k < repeats(2000); k++) {
    advance(made, 0.05, 1);
    momenta_of_pair(made, last);
    ck_assert_msg(distance(6, first, last) < 1e-12, "step %d: %.1e", k, distance(6, first, last));
  }
  dvi_integrator_destroy(&made);
}
END_TEST

START_TEST(symmetric_steps_lead_back)
{
  state there;
  take_machine(_i / 2);
  dvi_integrator *made = body_integrator(&model.body,
                                         _i % 2 ? "lie-verlet" : "lie-galerkin:degree=1");
  advance(made, model.span / 16, 1);
  read_end(made, &there);
  ck_assert_int_eq(dvi_integrator_start(made, 0, there.q, there.p), DVI_OK);
  advance(made, -model.span / 16, 1);
  ck_assert_double_le(distance(model.body.nq, dvi_integrator_q(made), model.body.q), 1e-13);
  dvi_integrator_destroy(&made);
}
END_TEST

/* ---- multipliers, starts, refusals ---- */

/* A pendulum that hangs at rest pulls by its weight. */
START_TEST(reactions_are_forces)
{
  double lambda[3];
  take_machine(BALL_PENDULUM);
  dvi_integrator *made = create_integrator(model.body.system, "lie-galerkin:degree=2");
  const double q[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -.3}, p[6] = {0};
  ck_assert_int_eq(dvi_integrator_start(made, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_reactions(made, lambda), DVI_OK);
  ck_assert_double_eq_tol(lambda[0], 0, 1e-12);
  ck_assert_double_eq_tol(lambda[1], 0, 1e-12);
  ck_assert_double_eq_tol(lambda[2], -9.81, 1e-9);
  dvi_integrator_destroy(&made);
}
END_TEST

START_TEST(starts_off_a_joint_are_refused_by_its_name_or_projected)
{
  const dvi_start_options project = {.project = 1};
  double off, q[BODY_Q], p[BODY_V] = {.1, .2, .3, .4};
  take_machine(HINGE_PENDULUM);
  memcpy(q, model.body.q, sizeof q);
  dvi_integrator *made = create_integrator(model.body.system, "lie-galerkin:degree=2");
  q[9] += 1e-3;
  ck_assert_int_eq(dvi_integrator_start(made, 0, q, p), DVI_BAD_ARGUMENT);
  check_words("hinge");
  q[9] -= 1e-3;
  ck_assert_int_eq(dvi_integrator_start(made, 0, q, p), DVI_BAD_ARGUMENT);
  check_words("its rate along the velocity");
  q[10] += 1e-2;
  ck_assert_int_eq(dvi_integrator_start_with(made, 0, q, p, &project), DVI_OK);
  ck_assert_int_eq(dvi_integrator_constraint(made, &off), DVI_OK);
  ck_assert_double_le(off, 1e-15);
  advance(made, 0.01, 10);
  dvi_integrator_destroy(&made);
}
END_TEST

START_TEST(other_methods_refuse_joints)
{
  static const char *const methods[] = {"euler-poincare", "lie-rk", "verlet", "galerkin"};
  take_machine(BALL_PENDULUM);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    dvi_integrator *made;
    ck_assert_int_eq(dvi_integrator_create(model.body.system, methods[k], &made), DVI_UNSUPPORTED);
    ck_assert_ptr_null(made);
  }
  double q[12], p[6] = {0};
  const dvi_reference_options cvode = {.code = DVI_CVODE_BDF};
  memcpy(q, model.body.q, sizeof q);
  ck_assert_int_eq(dvi_reference_solve(model.body.system, 0, 1, q, p, &cvode, NULL),
                   DVI_UNSUPPORTED);
}
END_TEST

SUITE(lie_galerkin_joints)
{
  tcase_add_checked_fixture(tests, NULL, forget_machine);
  tcase_add_loop_test(tests, steps_have_order_2s, 0, MACHINES);
  tcase_add_loop_test(tests, steps_of_verlet_have_order_2_and_compose, 0, MACHINES);
  tcase_add_test(tests, pendulums_have_the_digits_of_those_without_joints);
  tcase_add_loop_test(tests, ida_ends_where_steps_do, 0, MACHINES);
  tcase_add_loop_test(tests, steps_are_symplectic, 0, MACHINES);
  tcase_add_loop_test(tests, constraints_hold_to_rounding_and_the_energy_is_bounded, 0, MACHINES);
  tcase_add_loop_test(tests, momenta_of_a_free_pair_are_kept, 0, 4);
  tcase_add_loop_test(tests, symmetric_steps_lead_back, 0, 2 * MACHINES);
  tcase_add_test(tests, reactions_are_forces);
  tcase_add_test(tests, starts_off_a_joint_are_refused_by_its_name_or_projected);
  tcase_add_test(tests, other_methods_refuse_joints);
}
