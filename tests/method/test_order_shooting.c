/* labels: order slow */
/* The order of shooting is that of its one-step method or of its quadrature, whichever is lower. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad.h"
#include "support/runs.h"
#include "support/suite.h"

static const struct {
  const char *setting;
  int order;
} one_steps[] = {{"euler", 1},          {"backward-euler", 1}, {"heun", 2},           {"rk4", 4},
                 {"sdirk,stages=3", 4}, {"butcher6", 6},       {"gauss,stages=3", 6}, {"cooper-verner", 8}},
  rules[] = {{"trapezoid", 2}, {"simpson", 4}, {"lobatto,nodes=4", 6}, {"clenshaw-curtis,nodes=5", 6}, {"lobatto,nodes=5", 8}};
enum { ONE_STEPS = sizeof one_steps / sizeof *one_steps, RULES = sizeof rules / sizeof *rules, ORDER_MOST = 8 };

/* How many steps the coarsest run takes for each order. */
static const struct {
  const char *problem, *setting;
  double length;
  int first[ORDER_MOST + 1];
} places[] = {{"pendulum", NULL, 8, {0, 200, 80, 80, 40, 40, 40, 0, 32}},
              {"kepler", "e=0.3", 6, {0, 1500, 100, 100, 60, 60, 60, 0, 40}},
              {"double-pendulum", NULL, 1, {0, 300, 60, 50, 30, 30, 30, 0, 29}}};
enum { PLACES = sizeof places / sizeof *places };

/* Runs are by as much finer from one to the next; the last ones must stay above roundoff. */
static double ratio_of(int order)
{
  return order <= 4 ? 1.6 : order <= 6 ? 1.4 : 1.15;
}

/* A part of the coordinates' and momenta's largest, against quadruple precision. */
static double error_of(const problem *of, double length, long steps, const char *method, const double *q, const double *p)
{
  dvi_integrator *integrator = started(of, method);
  advance(integrator, length / (double)steps, steps);
  const double error = fmax(distance(of->nq, q, dvi_integrator_q(integrator)) / magnitude(of->nq, q),
                            distance(of->nq, p, dvi_integrator_p(integrator)) / magnitude(of->nq, p));
  dvi_integrator_destroy(&integrator);
  return error;
}

/* The slope of a straight line through log error over log steps, by least squares. */
static double slope_of(int place, const char *method, int order)
{
  enum { LEVELS = 4, N = QUAD_N_MAX };
  double q[N], p[N], x = 0, y = 0, xx = 0, xy = 0;
  problem *of = made_problem(places[place].problem, places[place].setting);
  memcpy(q, of->q, (size_t)of->nq * sizeof *q);
  memcpy(p, of->p, (size_t)of->nq * sizeof *p);
  ck_assert_double_le(quad_solve(of->name, places[place].setting != NULL, &places[place].setting, places[place].length, q, p),
                      1e-17);
  for (int level = 0; level < LEVELS; level++) {
    const long steps = lround(places[place].first[order] * pow(ratio_of(order), level));
    const double error = error_of(of, places[place].length, steps, method, q, p), a = -log((double)steps), b = log(error);
    if (getenv("DVI_SHOW_ORDERS") != NULL) printf("%s %s %ld %.2e\n", of->name, method, steps, error);
    ck_assert_double_ge(error, 1e-14);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  problem_destroy(&of);
  return (LEVELS * xy - x * y) / (LEVELS * xx - x * x);
}

static void check_claim(int place, const char *method, int order)
{
  problem *of = made_problem(places[place].problem, NULL);
  dvi_integrator *integrator = made_integrator(of->system, method);
  ck_assert_int_eq(dvi_integrator_order(integrator), order);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}

static void check_slope(int place, const char *method, int order, double most)
{
  check_claim(place, method, order);
  const double slope = slope_of(place, method, order);
  if (getenv("DVI_SHOW_ORDERS") != NULL) printf("%s %s: %.3f of %d\n", places[place].problem, method, slope, order);
  ck_assert_msg(slope >= order - 0.2 && slope <= most, "%s %s: %.3f, not %d", places[place].problem, method, slope, order);
}

START_TEST(the_order_is_the_lower_of_both)
{
  const int one = _i / RULES, rule = _i % RULES;
  const int order = one_steps[one].order < rules[rule].order ? one_steps[one].order : rules[rule].order;
  const char *method = spec("shooting:onestep=%s,quadrature=%s", one_steps[one].setting, rules[rule].setting);
  for (int place = 0; place < PLACES; place++) check_slope(place, method, order, order + 0.2);
}
END_TEST

/* A motion that can be run backwards makes the leading error of an odd order small: on pendulum and kepler the next, even order is seen first. On the double
 * pendulum, which has the errors of its mass, too, it is not. */
START_TEST(odd_orders_are_no_lower_than_claimed)
{
  static const char *const odd[] = {"kutta3,quadrature=lobatto,nodes=4", "radau-iia,quadrature=lobatto,nodes=4",
                                    "dormand-prince,quadrature=lobatto,nodes=4", "radau-iia,stages=3,quadrature=lobatto,nodes=5"};
  const int order = _i < 2 ? 3 : 5;
  check_slope(0, spec("shooting:onestep=%s", odd[_i]), order, order + 1.5);
  check_slope(1, spec("shooting:onestep=%s", odd[_i]), order, order + 1.5);
  if (_i != 2) check_slope(2, spec("shooting:onestep=%s", odd[_i]), order, order + 0.2);
}
END_TEST

START_TEST(compositions_have_the_order_of_the_scheme)
{
  static const char *const composed[] = {"implicit-midpoint,composition=4", "gauss,composition=6"};
  const int order = _i == 0 ? 4 : 6;
  for (int place = 0; place < PLACES; place++)
    check_slope(place, spec("shooting:onestep=%s,quadrature=lobatto,nodes=5", composed[_i]), order, order + 0.2);
}
END_TEST

/* A series and the values and derivatives of L at the ends, alone and with others. */
static const struct {
  const char *setting;
  int order;
} series[] = {{"taylor,stages=2,quadrature=trapezoid", 2},        {"taylor", 4},
              {"butcher6,quadrature=euler-maclaurin,terms=1", 4}, {"rk4,quadrature=euler-maclaurin,terms=2", 4},
              {"butcher6,quadrature=gauss-hermite", 6},           {"cooper-verner,quadrature=gauss-hermite,terms=2", 4}};
enum { SERIES = sizeof series / sizeof *series };

START_TEST(series_have_the_order_of_their_degree)
{
  for (int place = 0; place < PLACES; place++)
    check_slope(place, spec("shooting:onestep=%s", series[_i].setting), series[_i].order, series[_i].order + 0.2);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, the_order_is_the_lower_of_both, 0, ONE_STEPS * RULES);
  tcase_add_loop_test(tests, odd_orders_are_no_lower_than_claimed, 0, 4);
  tcase_add_loop_test(tests, compositions_have_the_order_of_the_scheme, 0, 2);
  tcase_add_loop_test(tests, series_have_the_order_of_their_degree, 0, SERIES);
  return run_tests("method/order_shooting", tests);
}
