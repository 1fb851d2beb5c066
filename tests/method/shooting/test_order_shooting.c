/* labels: order slow long */
/* The order of shooting is that of its one-step method or of its quadrature, whichever is lower. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "step/onestep/flow_series.h"
#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/suite.h"

static const struct {
  const char *setting;
  int order;
} one_steps[] = {{"euler", 1},          {"backward-euler", 1},
                 {"heun", 2},           {"rk4", 4},
                 {"sdirk,stages=3", 4}, {"butcher6", 6},
                 {"gauss,stages=3", 6}, {"cooper-verner", 8}},
  rules[] = {{"trapezoid", 2},
             {"simpson", 4},
             {"lobatto,nodes=4", 6},
             {"clenshaw-curtis,nodes=5", 6},
             {"lobatto,nodes=5", 8}};
enum {
  ONE_STEPS = sizeof one_steps / sizeof *one_steps,
  RULES = sizeof rules / sizeof *rules,
  ORDER_MOST = 8
};

/* How many steps the coarsest run takes for each order. */
static const struct {
  const char *problem, *setting;
  double length;
  int first[ORDER_MOST + 1];
} places[] = {{"pendulum", NULL, 8, {0, 200, 80, 80, 40, 40, 40, 0, 32}},
              {"kepler", "e=0.3", 6, {0, 1500, 100, 100, 60, 60, 60, 0, 40}},
              {"double-pendulum", NULL, 1, {0, 300, 60, 50, 30, 30, 30, 0, 29}}};
enum { PLACES = sizeof places / sizeof *places };

/* Each run is finer than the one before by the same factor. The last ones must stay above
 * roundoff. */
static double ratio_of(int order)
{
  return order <= 4 ? 1.6 : order <= 6 ? 1.4 : 1.15;
}

/* A part of the coordinates' and momenta's largest, against quadruple precision. */
static double error_of(const problem *model, double length, long steps, const char *method,
                       const double *q, const double *p)
{
  dvi_integrator *integrator = start_integrator(model, method);
  advance(integrator, length / (double)steps, steps);
  const double error = fmax(
      distance(model->nq, q, dvi_integrator_q(integrator)) / magnitude(model->nq, q),
      distance(model->nq, p, dvi_integrator_p(integrator)) / magnitude(model->nq, p));
  dvi_integrator_destroy(&integrator);
  return error;
}

/* The steps of the coarsest run, and by how much the next ones are finer. */
typedef struct ladder {
  int first;
  double ratio;
} ladder;

static ladder usual_ladder(int place, int order)
{
  return (ladder){places[place].first[order], ratio_of(order)};
}

/* The slope of a straight line through log error over log steps, by least squares. */
static double slope_of(int place, const char *method, ladder on)
{
  enum { LEVELS = 4, N = QUAD_N_MAX };
  double q[N], p[N], x = 0, y = 0, xx = 0, xy = 0;
  problem *model = create_problem(places[place].problem, places[place].setting);
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nq * sizeof *p);
  ck_assert_double_le(quad_solve(model->name, places[place].setting != NULL, &places[place].setting,
                                 places[place].length, q, p),
                      1e-17);
  for (int level = 0; level < LEVELS; level++) {
    const long steps = lround(on.first * pow(on.ratio, level));
    const double error = error_of(model, places[place].length, steps, method, q, p),
                 a = -log((double)steps), b = log(error);
    if (getenv("DVI_SHOW_ORDERS") != NULL)
      printf("%s %s %ld %.2e\n", model->name, method, steps, error);
    ck_assert_double_ge(error, 1e-14);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  problem_destroy(&model);
  return (LEVELS * xy - x * y) / (LEVELS * xx - x * x);
}

static void check_claim(int place, const char *method, int order)
{
  problem *model = create_problem(places[place].problem, NULL);
  dvi_integrator *integrator = create_integrator(model->system, method);
  ck_assert_int_eq(dvi_integrator_order(integrator), order);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

static void check_slope_on(int place, const char *method, int order, double most, ladder on)
{
  check_claim(place, method, order);
  const double slope = slope_of(place, method, on);
  if (getenv("DVI_SHOW_ORDERS") != NULL)
    printf("%s %s: %.3f of %d\n", places[place].problem, method, slope, order);
  ck_assert_msg(slope >= order - 0.2 && slope <= most, "%s %s: %.3f, not %d", places[place].problem,
                method, slope, order);
}

static void check_slope(int place, const char *method, int order, double most)
{
  check_slope_on(place, method, order, most, usual_ladder(place, order));
}

START_TEST(the_order_is_the_lower_of_both)
{
  const int which = sampled_case(_i), one = which / RULES, rule = which % RULES;
  const int order = one_steps[one].order < rules[rule].order ? one_steps[one].order
                                                             : rules[rule].order;
  const char *method = method_spec("shooting:onestep=%s,quadrature=%s", one_steps[one].setting,
                                   rules[rule].setting);
  for (int place = 0; place < PLACES; place++) check_slope(place, method, order, order + 0.2);
}
END_TEST

/* A motion that can be run backwards makes the leading error of an odd order small. On pendulum and
 * kepler the next, even order shows first. On the double pendulum, which also has errors of its
 * mass, it does not. */
START_TEST(odd_orders_are_no_lower_than_claimed)
{
  static const char *const odd[] = {
      "kutta3,quadrature=lobatto,nodes=4", "radau-iia,quadrature=lobatto,nodes=4",
      "dormand-prince,quadrature=lobatto,nodes=4", "radau-iia,stages=3,quadrature=lobatto,nodes=5"};
  const int order = _i < 2 ? 3 : 5;
  check_slope(0, method_spec("shooting:onestep=%s", odd[_i]), order, order + 1.5);
  check_slope(1, method_spec("shooting:onestep=%s", odd[_i]), order, order + 1.5);
  if (_i != 2) check_slope(2, method_spec("shooting:onestep=%s", odd[_i]), order, order + 0.2);
}
END_TEST

/* Its errors of order 5 and 6 have opposite signs on the double pendulum. The slope approaches 5
 * from below, and is 4.6 with 60 steps. */
START_TEST(dormand_prince_comes_up_to_order_5)
{
  check_slope_on(2, "shooting:onestep=dormand-prince,quadrature=lobatto,nodes=5", 5, 5.2,
                 (ladder){104, 1.15});
}
END_TEST

START_TEST(compositions_have_the_order_of_the_scheme)
{
  static const char *const composed[] = {"implicit-midpoint,composition=4", "gauss,composition=6"};
  const int order = _i == 0 ? 4 : 6;
  for (int place = 0; place < PLACES; place++)
    check_slope(place, method_spec("shooting:onestep=%s,quadrature=lobatto,nodes=5", composed[_i]),
                order, order + 0.2);
}
END_TEST

/* A series and the values and derivatives of L at the ends, alone and with others. */
static const struct {
  const char *setting;
  int order;
} series[] = {{"taylor,stages=2,quadrature=trapezoid", 2},
              {"taylor", 4},
              {"butcher6,quadrature=euler-maclaurin,terms=1", 4},
              {"rk4,quadrature=euler-maclaurin,terms=2", 4},
              {"butcher6,quadrature=gauss-hermite", 6},
              {"cooper-verner,quadrature=gauss-hermite,terms=2", 4}};
enum { SERIES = sizeof series / sizeof *series };

START_TEST(series_have_the_order_of_their_degree)
{
  for (int place = 0; place < PLACES; place++)
    check_slope(place, method_spec("shooting:onestep=%s", series[_i].setting), series[_i].order,
                series[_i].order + 0.2);
}
END_TEST

/* One step from end to end has no nodes between, and the double pendulum's motion has poles at 0.18
 * from the real line up to t = 1. The remainder of the next orders dies out late, and the error
 * changes its sign on the way (taylor,stages=8 between 31 and 44 steps). */
static const struct {
  const char *setting;
  int order, first[PLACES];
} summed[] = {{"taylor,stages=8,quadrature=euler-maclaurin,terms=2", 6, {44, 61, 86}},
              {"butcher6,quadrature=euler-maclaurin,terms=2", 6, {44, 44, 31}},
              {"gauss,stages=3,quadrature=euler-maclaurin,terms=2", 6, {31, 44, 31}},
              {"taylor,stages=10,quadrature=euler-maclaurin,terms=3", 8, {28, 43, 74}},
              {"cooper-verner,quadrature=euler-maclaurin,terms=3", 8, {43, 98, 49}},
              {"gauss,stages=4,quadrature=euler-maclaurin,terms=3", 8, {28, 49, 49}}};
enum { SUMMED = sizeof summed / sizeof *summed };

START_TEST(euler_maclaurin_has_order_twice_its_terms_and_2)
{
  const int order = summed[_i].order;
  for (int place = 0; place < PLACES; place++)
    check_slope_on(place, method_spec("shooting:onestep=%s", summed[_i].setting), order,
                   order + 0.2, (ladder){summed[_i].first[place], ratio_of(order)});
}
END_TEST

/* The radius of convergence of the motion's Taylor series at a time, by the roots of its last
 * coefficients. */
static double radius_at(const problem *model, double t)
{
  enum { DEGREE = 20, FIRST = 16, N = QUAD_N_MAX };
  double q[N], p[N], v[N] = {0}, most = 0;
  dvi__flow_series *motion;
  dvi__evaluator *evaluator;
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nq * sizeof *p);
  ck_assert_double_le(quad_solve(model->name, 0, NULL, t, q, p), 1e-17);
  ck_assert_int_eq(dvi__flow_series_create(model->system, DEGREE, DVI__GRADIENTS, NULL, &motion),
                   DVI_OK);
  ck_assert_int_eq(dvi__evaluator_create(model->system, 1, DVI__HESSIANS, NULL, &evaluator),
                   DVI_OK);
  ck_assert_int_eq(dvi__legendre_inverse(evaluator, t, q, p, v), DVI_OK);
  ck_assert_int_eq(dvi__flow_series_expand(motion, t, q, v), DVI_OK);
  for (int k = FIRST; k <= DEGREE; k++)
    for (int i = 0; i < model->nq; i++)
      most = fmax(most, pow(fabs(dvi__flow_series_q(motion)[k * model->nq + i]), 1.0 / k));
  dvi__evaluator_destroy(&evaluator);
  dvi__flow_series_destroy(&motion);
  return 1 / most;
}

/* At t = 6.2 the double pendulum's rods whip round. Each residual reduces the error by a factor
 * like the step's own error, and by none for steps from half the radius on. */
START_TEST(newtons_method_is_as_fast_as_the_step_is_short)
{
  static const struct {
    double h, error;
    long residuals;
  } steps[] = {{0.028, 1e-2, 9}, {0.0166, 5e-4, 5}, {0.0098, 2e-5, 4}};
  problem *model = create_problem("double-pendulum", NULL);
  double q[2], p[2];
  ck_assert_double_eq_tol(radius_at(model, 0.95), 0.184, 0.005);
  ck_assert_double_eq_tol(radius_at(model, 6.2), 0.115, 0.005);
  memcpy(q, model->q, sizeof q);
  memcpy(p, model->p, sizeof p);
  ck_assert_double_le(quad_solve(model->name, 0, NULL, 6.2, q, p), 1e-17);
  for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
    dvi_integrator *integrator = create_integrator(
        model->system, "shooting:onestep=taylor,quadrature=euler-maclaurin");
    double end_q[2], end_p[2];
    dvi_counters counters;
    memcpy(end_q, q, sizeof q);
    memcpy(end_p, p, sizeof p);
    ck_assert_double_le(quad_solve(model->name, 0, NULL, steps[k].h, end_q, end_p), 1e-17);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    advance(integrator, steps[k].h, 1);
    dvi_integrator_counters(integrator, &counters);
    ck_assert_int_le(counters.residuals, steps[k].residuals);
    ck_assert_double_le(distance(2, end_p, dvi_integrator_p(integrator)), steps[k].error);
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
}
END_TEST

SUITE(order_shooting)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, the_order_is_the_lower_of_both, 0, sampled_count(ONE_STEPS * RULES));
  tcase_add_loop_test(tests, odd_orders_are_no_lower_than_claimed, 0, 4);
  tcase_add_test(tests, dormand_prince_comes_up_to_order_5);
  tcase_add_loop_test(tests, compositions_have_the_order_of_the_scheme, 0, 2);
  tcase_add_loop_test(tests, series_have_the_order_of_their_degree, 0, SERIES);
  tcase_add_loop_test(tests, euler_maclaurin_has_order_twice_its_terms_and_2, 0, SUMMED);
  tcase_add_test(tests, newtons_method_is_as_fast_as_the_step_is_short);
}
