/* labels: order */
/* Hamilton-Pontryagin integrators: the steps of the four types, in lowest and in higher degrees. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N_MOST = 2, STEPS = 40 };

/* ---- what they coincide with ---- */

static void check_same(const char *name, const char *one, const char *other, double h)
{
  problem *model = create_problem(name, NULL);
  dvi_integrator *a = start_integrator(model, one), *b = start_integrator(model, other);
  advance(a, h, STEPS);
  advance(b, h, STEPS);
  ck_assert_int_eq(dvi_integrator_order(a), dvi_integrator_order(b));
  ck_assert_mem_eq(dvi_integrator_q(a), dvi_integrator_q(b), (size_t)model->nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(a), dvi_integrator_p(b), (size_t)model->nq * sizeof(double));
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  problem_destroy(&model);
}

START_TEST(type_1_is_galerkin_with_lobattos_points)
{
  check_same("kepler", method_spec("hp:type=1,degree=%d", _i),
             method_spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", _i, _i + 1), 0.05);
  check_same("double-pendulum", method_spec("hp:degree=%d", _i),
             method_spec("galerkin:degree=%d,quadrature=lobatto,nodes=%d", _i, _i + 1), 0.02);
}
END_TEST

START_TEST(with_the_same_quadrature_types_1_to_3_are_the_same)
{
  for (int type = 1; type <= 3; type++) {
    check_same("double-pendulum", method_spec("hp:type=%d,degree=%d,quadrature=gauss", type, _i),
               method_spec("galerkin:degree=%d", _i), 0.02);
    check_same("kepler", method_spec("hp:type=%d,degree=%d,quadrature=clenshaw-curtis", type, _i),
               method_spec("galerkin:degree=%d,quadrature=clenshaw-curtis", _i), 0.05);
    check_same("kepler", method_spec("hp:type=%d,degree=%d,quadrature=radau-right", type, _i),
               method_spec("galerkin:degree=%d,quadrature=radau-right,nodes=%d", _i, _i), 0.05);
  }
}
END_TEST

static const double h = 0.1;

/* Gauss's tableau is its own conjugate. The tolerance allows some roundings a step. */
START_TEST(type_4_with_gauss_points_is_gauss_collocation)
{
  problem *model = create_problem("double-pendulum", NULL);
  dvi_integrator *a = start_integrator(model,
                                       method_spec("hp:type=4,degree=%d,quadrature=gauss", _i)),
                 *b = start_integrator(model, method_spec("galerkin:degree=%d", _i));
  advance(a, h / 5, STEPS);
  advance(b, h / 5, STEPS);
  ck_assert_int_eq(dvi_integrator_order(a), dvi_integrator_order(b));
  ck_assert_double_le(distance(model->nq, dvi_integrator_q(a), dvi_integrator_q(b)), 1e-12);
  ck_assert_double_le(distance(model->nq, dvi_integrator_p(a), dvi_integrator_p(b)),
                      1e-12 * magnitude(model->nq, model->p) + 1e-11);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  problem_destroy(&model);
}
END_TEST

/* p = p + length times the well's force at x, of the Henon-Heiles system. */
static void kick_momentum(const problem *model, double length, const double *x, double *p)
{
  double slope[N_MOST];
  const dvi_potential *well = model->terms->potentials;
  ck_assert_int_eq(well->gradient_batch(1, &(double){0}, x, slope, well->user), 0);
  for (int i = 0; i < N_MOST; i++) p[i] -= length * slope[i];
}

static void drift(double length, const double *p, double *x)
{
  for (int i = 0; i < N_MOST; i++) x[i] += length * p[i];
}

/* The steps are kick and drift, drift and kick, or half a drift, kick and half a drift. */
static void explicit_step(const problem *model, int type, double *x, double *p)
{
  if (type == 4) drift(h / 2, p, x);
  if (type == 3) drift(h, p, x);
  kick_momentum(model, h, x, p);
  if (type == 2) drift(h, p, x);
  if (type == 4) drift(h / 2, p, x);
}

/* The tolerance allows a rounding or two of numbers below 1 a step. */
START_TEST(lowest_degrees_are_the_explicit_formulae)
{
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = start_integrator(model, method_spec("hp:type=%d", _i));
  double x[N_MOST], p[N_MOST];
  memcpy(x, model->q, sizeof x);
  memcpy(p, model->p, sizeof p);
  for (int step = 0; step < STEPS; step++) explicit_step(model, _i, x, p);
  advance(integrator, h, STEPS);
  ck_assert_double_le(distance(N_MOST, dvi_integrator_q(integrator), x), 1e-13);
  ck_assert_double_le(distance(N_MOST, dvi_integrator_p(integrator), p), 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static void velocity(const problem *model, const double *q, const double *p, double *v)
{
  memcpy(v, model->v, N_MOST * sizeof *v);
  ck_assert_int_eq(dvi_system_velocity(model->system, 0, q, p, v), DVI_OK);
}

/* Gives the generalised formulae where the mass depends on q: p1 = L_v(q0,v) or p0 = L_v(q1,v)
 * with v = (q1-q0)/h. Type 4 has the half-way point q0 + h/2 v0, v0 = v(q,p0), and q1 = q + h/2
 * v(q,p1). */
START_TEST(lowest_degrees_are_the_generalised_formulae_with_any_lagrangian)
{
  problem *model = create_problem("double-pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, method_spec("hp:type=%d", _i));
  const double short_h = 0.01;
  advance(integrator, short_h, 1);
  const double *q1 = dvi_integrator_q(integrator), *p1 = dvi_integrator_p(integrator);
  double v[N_MOST], p[N_MOST], half[N_MOST];
  for (int i = 0; i < N_MOST; i++) v[i] = (q1[i] - model->q[i]) / short_h;
  if (_i < 4) {
    ck_assert_int_eq(dvi_system_momentum(model->system, 0, _i == 2 ? model->q : q1, v, p), DVI_OK);
    ck_assert_double_le(distance(N_MOST, p, _i == 2 ? p1 : model->p), 1e-12 * magnitude(N_MOST, p));
  } else {
    memcpy(half, model->q, sizeof half);
    for (int iteration = 0; iteration < 60; iteration++) {
      velocity(model, half, model->p, v);
      for (int i = 0; i < N_MOST; i++) half[i] = model->q[i] + short_h / 2 * v[i];
    }
    velocity(model, half, p1, v);
    for (int i = 0; i < N_MOST; i++)
      ck_assert_double_eq_tol(q1[i], half[i] + short_h / 2 * v[i], 1e-13);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- order and structure ---- */

static const struct {
  const char *problem, *setting;
  int order;
  double h;
} claims[] = {{"henon-heiles", "type=1", 2, 0.125},
              {"henon-heiles", "type=2", 1, 0.03125},
              {"henon-heiles", "type=3", 1, 0.03125},
              {"henon-heiles", "type=4", 2, 0.125},
              {"henon-heiles", "type=2,degree=2", 3, 0.25},
              {"henon-heiles", "type=3,degree=2", 3, 0.25},
              {"henon-heiles", "type=4,degree=2", 4, 0.25},
              {"henon-heiles", "type=4,degree=3", 6, 0.5},
              {"henon-heiles", "type=3,degree=3", 5, 0.5},
              {"double-pendulum", "type=2,degree=2", 3, 0.02},
              {"double-pendulum", "type=3,degree=2", 3, 0.02},
              {"double-pendulum", "type=4", 2, 0.005},
              {"double-pendulum", "type=4,degree=2", 4, 0.02},
              {"double-pendulum", "type=4,degree=3", 6, 0.05},
              {"double-pendulum", "type=3", 1, 0.0003125},
              {"double-pendulum", "type=2", 1, 0.0003125},
              {"double-pendulum", "type=4,degree=2,quadrature=gauss", 4, 0.02},
              {"double-pendulum", "type=2,degree=2,quadrature=gauss", 4, 0.02},
              {"henon-heiles", "type=1,degree=2,quadrature=trapezoid", 2, 0.125},
              {"henon-heiles", "type=1,degree=3,quadrature=simpson", 4, 0.25}};
enum { CLAIMS = sizeof claims / sizeof *claims };

/* Measures errors at t = 1 against quadruple precision, and the slope between the last two of four
 * steps. */
START_TEST(orders_are_those_claimed)
{
  problem *model = create_problem(claims[_i].problem, NULL);
  const char *method = method_spec("hp:%s", claims[_i].setting);
  double error[4];
  for (int level = 0; level < 4; level++) {
    const double step = claims[_i].h / (1 << level);
    dvi_integrator *integrator = start_integrator(model, method);
    ck_assert_int_eq(dvi_integrator_order(integrator), claims[_i].order);
    advance(integrator, step, lround(model->order_t_end / step));
    error[level] = distance(model->nq, dvi_integrator_q(integrator), model->digits_q);
    ck_assert_double_gt(error[level], 3e-14);
    dvi_integrator_destroy(&integrator);
  }
  for (int level = 1; level < 4; level++) {
    const double slope = log2(error[level - 1] / error[level]), within = level == 1 ? 0.6 : 0.2;
    ck_assert_msg(fabs(slope - claims[_i].order) <= within, "%s %s: slope %.2f at level %d",
                  claims[_i].problem, method, slope, level);
  }
  problem_destroy(&model);
}
END_TEST

/* 1e-10 is the floor of differences, see dvi_symplecticity. */
START_TEST(all_types_are_symplectic_and_types_1_and_4_symmetric)
{
  problem *model = create_problem("double-pendulum", NULL);
  for (int degree = 1; degree <= 3; degree++) {
    dvi_integrator *integrator = start_integrator(model,
                                                  method_spec("hp:type=%d,degree=%d", _i, degree));
    double defect;
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, 0.02, &defect), DVI_OK);
    ck_assert_double_le(defect, 1e-10);
    ck_assert_int_eq(dvi_reversibility(integrator, 0, model->q, model->p, 0.02, 20, &defect),
                     DVI_OK);
    if (_i == 1 || _i == 4)
      ck_assert_double_le(defect, 1e-13);
    else
      ck_assert_double_ge(defect, 1e-11);
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(what_does_not_go_is_refused)
{
  problem *model = create_problem("kepler", NULL), *degenerate = create_problem("vortices", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "hp:type=4,degree=8", &none),
                   DVI_BAD_OPTION);
  check_words("degree=1 to 7 is possible");
  ck_assert_int_eq(dvi_integrator_create(model->system, "hp:type=5", &none), DVI_BAD_OPTION);
  ck_assert_int_eq(dvi_integrator_create(degenerate->system, "hp:type=1", &none), DVI_UNSUPPORTED);
  check_words("q given at both ends");
  ck_assert_int_eq(dvi_integrator_create(degenerate->system, "hp:type=4", &none), DVI_UNSUPPORTED);
  check_words("is not consistent");
  ck_assert_int_eq(dvi_integrator_create(model->system, "hp:type=4,quadrature=radau-left", &none),
                   DVI_BAD_OPTION);
  check_words("for lobatto and gauss");
  ck_assert_int_eq(
      dvi_integrator_create(model->system, "hp:type=2,degree=2,quadrature=midpoint", &none),
      DVI_BAD_OPTION);
  check_words("degree=1 is possible");
  ck_assert_ptr_null(none);
  problem_destroy(&model);
  problem_destroy(&degenerate);
}
END_TEST

SUITE(hp)
{
  tcase_add_loop_test(tests, type_1_is_galerkin_with_lobattos_points, 1, 6);
  tcase_add_loop_test(tests, with_the_same_quadrature_types_1_to_3_are_the_same, 1, 4);
  tcase_add_loop_test(tests, type_4_with_gauss_points_is_gauss_collocation, 1, 4);
  tcase_add_loop_test(tests, lowest_degrees_are_the_explicit_formulae, 2, 5);
  tcase_add_loop_test(tests, lowest_degrees_are_the_generalised_formulae_with_any_lagrangian, 2, 5);
  tcase_add_loop_test(tests, orders_are_those_claimed, 0, CLAIMS);
  tcase_add_loop_test(tests, all_types_are_symplectic_and_types_1_and_4_symmetric, 1, 5);
  tcase_add_test(tests, what_does_not_go_is_refused);
}
