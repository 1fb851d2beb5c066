/* labels: order reference */
/* Orders of flow-galerkin along each of its flows. */
#include <check.h>
#include <dvi/diagnostics.h>
#include <math.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

/* The flow is a drift, and a rotation. */
static const struct {
  const char *problem, *setting;
  double length;
  int first[3]; /* steps, by stages */
} spans[] = {
    {"pendulum", NULL, 8, {80, 40, 24}},
    {"henon-heiles", NULL, 12, {120, 40, 30}},
    {"fpu", NULL, 1, {100, 60, 40}},
};
enum { SPANS = sizeof spans / sizeof *spans };

START_TEST(up_to_three_stages_have_order_2s)
{
  const int span = _i / 3, s = 1 + _i % 3;
  check_order_over(spans[span].problem, spans[span].setting, spans[span].length,
                   spans[span].first[s - 1], method_spec("flow-galerkin:stages=%d", s), 2 * s);
}
END_TEST

START_TEST(ida_finds_the_lower_orders)
{
  const int s = 1 + _i % 2;
  check_order_by_ida_over(spans[_i / 2].problem, spans[_i / 2].setting, spans[_i / 2].length,
                          spans[_i / 2].first[s - 1] / s, method_spec("flow-galerkin:stages=%d", s),
                          2 * s);
}
END_TEST

/* Kepler motions beside a rest of a thousandth. */
START_TEST(planets_have_order_2_by_the_middle_of_the_step)
{
  check_order_over("outer-solar-jacobi", NULL, 10000, 112, "flow-galerkin:stages=1", 2);
}
END_TEST

/* ---- Kepler motions beside a large rest ---- */

/* V = 0.1 (x^2 - 2 y^2) beside the Kepler problem. */
static int tide_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.1 * (q[0] * q[0] - 2 * q[1] * q[1]);
  return 0;
}

static int tide_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 0.2 * q[0];
  V_q[1] = -0.4 * q[1];
  return 0;
}

/* Creates the system of Kepler's problem, whose potential is fast, with the tide. */
static dvi_system *create_tidal(const problem *model)
{
  dvi_potential potentials[] = {model->terms->potentials[0],
                                {.name = "tide", .value = tide_value, .gradient = tide_gradient}};
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  potentials[0].fast = 1;
  terms.potentials = potentials;
  terms.potential_count = 2;
  terms.symmetry_count = terms.invariant_count = 0;
  terms.symmetries = NULL;
  terms.invariants = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *run(const dvi_system *system, const problem *model, const char *method,
                           double length, int steps)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  advance(integrator, length / steps, steps);
  return integrator;
}

/* Require the order over steps that shrink by 1.4. The judge is galerkin, which knows no flow. */
static void check_order_by_galerkin(const dvi_system *system, const problem *model, double length,
                                    int first, int s)
{
  enum { LEVELS = 4 };
  dvi_integrator *judge = run(system, model, "galerkin:degree=10", length, 10 * first);
  double h[LEVELS], error[LEVELS];
  for (int level = 0; level < LEVELS; level++) {
    const int steps = (int)lround(first * pow(1.4, level));
    dvi_integrator *tried = run(system, model, method_spec("flow-galerkin:stages=%d", s), length,
                                steps);
    h[level] = length / steps;
    error[level] = distance(model->nq, dvi_integrator_q(tried), dvi_integrator_q(judge));
    ck_assert_double_gt(error[level], 2e-13);
    dvi_integrator_destroy(&tried);
  }
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(LEVELS, h, error, 0, 0, &fit), DVI_OK);
  ck_assert_msg(fabs(fit.slope - 2 * s) <= 0.2, "order %g, errors %g to %g", fit.slope, error[0],
                error[LEVELS - 1]);
  dvi_integrator_destroy(&judge);
}

START_TEST(tides_on_kepler_orbits_have_order_2s)
{
  static const int first[] = {200, 60, 40, 25};
  problem *model = create_problem("kepler", "e=0.2");
  dvi_system *system = create_tidal(model);
  check_order_by_galerkin(system, model, 6, first[_i], 1 + _i);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(four_stages_have_order_8)
{
  static const struct {
    const char *name;
    double length;
    int first;
  } cases[] = {{"pendulum", 8, 16}, {"henon-heiles", 12, 16}, {"fpu", 1, 24}};
  problem *model = create_problem(cases[_i].name, NULL);
  check_order_by_galerkin(model->system, model, cases[_i].length, cases[_i].first, 4);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_composition_has_its_own_order)
{
  check_order_over("fpu", NULL, 1, 30, "composition:order=6,base=flow-galerkin,stages=1", 6);
}
END_TEST

SUITE(order_flow)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, up_to_three_stages_have_order_2s, 0, 3 * SPANS);
  tcase_add_loop_test(tests, ida_finds_the_lower_orders, 0, 2 * SPANS);
  tcase_add_test(tests, planets_have_order_2_by_the_middle_of_the_step);
  tcase_add_loop_test(tests, tides_on_kepler_orbits_have_order_2s, 0, 4);
  tcase_add_loop_test(tests, four_stages_have_order_8, 0, 3);
  tcase_add_test(tests, a_composition_has_its_own_order);
}
