/* labels: order invariant */
/* Discontinuous Galerkin variational integrators: orders, the parasite and its stiffness, loop
 * integrals, the alarm, refusals. */
#include <math.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/suite.h"

enum { LEVELS = 4 };

/* ---- orders ---- */

static double error_at_end(problem *model, const problem *standard, const char *method, double h)
{
  dvi_integrator *integrator = start_integrator(model, method);
  advance(integrator, h, lround(model->order_t_end / h));
  const double error = distance(model->nq, dvi_integrator_q(integrator), standard->digits_q);
  dvi_integrator_destroy(&integrator);
  return error;
}

static void check_slope(const char *what, double last, double error, int level, int expected)
{
  const double within = level == 1 ? 0.7 : 0.2; /* the first pair may not be asymptotic yet */
  const double slope = log2(last / error);
  ck_assert_msg(fabs(slope - expected) <= within, "%s: slope %.2f at level %d (error %g)", what,
                slope, level, error);
}

static const struct {
  const char *problem, *setting, *method;
  double h;
  int order;
} claims[] = {
    {"lotka-volterra", NULL, "dg:degree=2", 0.125, 6},
    {"lotka-volterra", "gauge=singular", "dg:degree=2", 0.125, 6},
    {"lotka-volterra", "gauge=symmetric", "dg:degree=2", 0.125, 6},
    {"lotka-volterra-4d", NULL, "dg:degree=2", 0.125, 6},
    {"massless-particle", NULL, "dg:degree=2", 0.5, 6},
    {"massless-particle", "gauge=singular", "dg:degree=2", 0.25, 6},
    {"vortices-linear", NULL, "dg:degree=2", 0.25, 6},
    {"vortices", NULL, "dg:degree=2", 0.0625, 6},
    {"guiding-centre", NULL, "dg:degree=2", 64.0 / 3, 6},
    {"tokamak", NULL, "dg:degree=2", 800, 6},
    {"massless-particle", NULL, "dg:degree=0", 0.125, 2},
    {"massless-particle", NULL, "dg:degree=1", 0.125, 2},
    {"guiding-centre", NULL, "dg:degree=1", 16, 2},
    {"vortices", NULL, "dg:degree=3", 0.0625, 6},
    {"vortices", NULL, "dg:degree=2,flux=path", 0.0625, 6},
    {"massless-particle", NULL, "dg:degree=1,flux=path,points=3", 0.125, 2},
    {"vortices", NULL, "dg:degree=2,nodes=5", 0.0625, 6},
    {"lotka-volterra", NULL, "dg:degree=1,stiffness=1", 0.0625, 3},
    {"lotka-volterra-4d", NULL, "dg:degree=1,stiffness=1", 0.03125, 3},
    {"massless-particle", NULL, "dg:degree=1,stiffness=1", 0.125, 3},
    {"vortices", NULL, "dg:degree=1,stiffness=1", 0.0125, 3},
    {"guiding-centre", NULL, "dg:degree=1,stiffness=1", 8, 3},
    {"tokamak", NULL, "dg:degree=1,stiffness=1:1:0.002:500", 100, 3},
    {"massless-particle", NULL, "dg:degree=2,stiffness=1", 0.125, 5},
    {"vortices", NULL, "dg:degree=2,stiffness=1", 0.00625, 5},
};
enum { CLAIMS = sizeof claims / sizeof *claims };

START_TEST(degrees_fluxes_and_stiffnesses_have_the_order_that_they_claim)
{
  check_degenerate_order(claims[_i].problem, claims[_i].setting, claims[_i].method, claims[_i].h,
                         claims[_i].order);
}
END_TEST

/* S = 5 and 6 have order 10. After a few halvings the error is at the floor, and the steps before
 * are so long that slopes still scatter. The slope over all of them does not. */
START_TEST(five_and_six_coefficients_have_order_10)
{
  problem *model = create_problem("lotka-volterra-4d", NULL);
  const char *method = method_spec("dg:degree=%d", _i);
  const double ratio = error_at_end(model, model, method, 0.5) /
                       error_at_end(model, model, method, 0.125);
  ck_assert_msg(fabs(log2(ratio) / 2 - 10) <= 1, "%s: slope %.2f", method, log2(ratio) / 2);
  problem_destroy(&model);
}
END_TEST

/* A stiffness in proportion to 1/h for even S, to h for odd S, keeps the parasite away from 1 and
 * all of the order 2S. */
START_TEST(a_stiffness_that_goes_with_the_step_has_order_2S)
{
  const int S = 1 + _i;
  problem *model = create_problem("vortices", NULL);
  double last = 0, h = 0.0625;
  int fitted = 0;
  for (int level = 0; level < LEVELS; level++, h /= 2) {
    const double c = S % 2 == 0 ? 0.5 / h : h;
    const double error = error_at_end(model, model,
                                      method_spec("dg:degree=%d,stiffness=%.10g", S - 1, c), h);
    if (level > 0 && error > 3e-13) check_slope(method_spec("S=%d", S), last, error, level, 2 * S);
    fitted += level > 0 && error > 3e-13;
    last = error;
  }
  ck_assert_int_ge(fitted, 1);
  problem_destroy(&model);
}
END_TEST

/* ---- the parasite ---- */

/* Measures the relative energy errors of the quarters of a run. 0 steps mean that it breaks
 * down. */
static long run_energies(const char *name, const char *method, double h, long steps,
                         double *quarter)
{
  problem *model = create_problem(name, NULL);
  dvi_integrator *integrator = start_integrator(model, method);
  double first[8], now[8];
  long k = 0;
  memset(quarter, 0, 4 * sizeof *quarter);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  for (; k < steps && dvi_integrator_step(integrator, h) == DVI_OK; k++) {
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    quarter[4 * k / steps] = fmax(quarter[4 * k / steps], fabs(now[0] / first[0] - 1));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return k;
}

static const struct {
  const char *problem, *method;
  double h, bound;
} runs[] = {
    {"lotka-volterra", "dg:degree=2", 0.1, 1e-8},
    {"lotka-volterra", "dg:degree=1,stiffness=1", 0.1, 5e-6},
    {"lotka-volterra", "dg:degree=3,stiffness=1", 0.1, 1e-11},
    {"massless-particle", "dg:degree=2", 0.2, 1e-8},
    {"massless-particle", "dg:degree=3,stiffness=1", 0.2, 2e-10},
    {"tokamak", "dg:degree=3,stiffness=1:1:0.002:500", 500, 3e-12},
};
enum { RUNS = sizeof runs / sizeof *runs };

START_TEST(energy_stays_bounded)
{
  const long steps = 16000;
  double quarter[4];
  ck_assert_int_eq(run_energies(runs[_i].problem, runs[_i].method, runs[_i].h, steps, quarter),
                   steps);
  ck_assert_msg(quarter[0] <= runs[_i].bound && quarter[3] <= 1.05 * quarter[0] + 1e-13,
                "%s: %g, then %g", runs[_i].method, quarter[0], quarter[3]);
}
END_TEST

/* These runs break down without a stiffness. */
START_TEST(runs_without_a_stiffness_break_down_and_the_alarm_stops_them_first)
{
  double quarter[4];
  const char *name = _i == 0 ? "lotka-volterra" : "tokamak",
             *method = _i == 0 ? "dg:degree=1" : "dg:degree=3";
  const double h = _i == 0 ? 0.1 : 500;
  const long steps = run_energies(name, method, h, 2000, quarter);
  check_words("the parasite has grown");
  ck_assert_int_lt(steps, 700);
  ck_assert_int_lt(steps,
                   run_energies(name, method_spec("%s,alarm=warn", method), h, 2000, quarter));
  ck_assert_int_lt(run_energies(name, method_spec("%s,alarm=warn", method), h, 2000, quarter),
                   2000);
}
END_TEST

START_TEST(an_alarm_leaves_the_state_or_is_counted)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *stops = start_integrator(model, "dg:degree=1"),
                 *warns = start_integrator(model, "dg:degree=1,alarm=warn");
  dvi_counters counters;
  double q[2], jump[2], after[2];
  dvi_status status = DVI_OK;
  while (status == DVI_OK) {
    memcpy(q, dvi_integrator_q(stops), sizeof q);
    (void)dvi_integrator_jump(stops, jump);
    status = dvi_integrator_step(stops, 0.1);
    advance(warns, 0.1, 1);
    dvi_integrator_counters(warns, &counters);
    ck_assert_int_eq(counters.jump_alarms, status != DVI_OK);
  }
  ck_assert_int_eq(status, DVI_JUMP);
  check_words("the state is unchanged");
  ck_assert_mem_eq(q, dvi_integrator_q(stops), sizeof q);
  ck_assert_double_eq(dvi_integrator_jump(stops, after), fmax(fabs(jump[0]), fabs(jump[1])));
  ck_assert_mem_eq(jump, after, sizeof jump);
  dvi_integrator_destroy(&stops);
  dvi_integrator_destroy(&warns);
  problem_destroy(&model);
}
END_TEST

/* Also the first step, which tries twice before it is taken, and keeps no jump of these trials. */
START_TEST(a_step_out_of_the_logarithms_domain_leaves_the_state)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *integrator = start_integrator(model, "dg"),
                 *untroubled = start_integrator(model, "dg");
  for (int steps = 0; steps < 3; steps++) {
    ck_assert_int_gt(dvi_integrator_step(integrator, 40), 0);
    check_words("the state is unchanged");
    ck_assert_double_eq(dvi_integrator_jump(integrator, NULL),
                        dvi_integrator_jump(untroubled, NULL));
    advance(integrator, 0.1, 1);
    advance(untroubled, 0.1, 1);
    ck_assert_mem_eq(dvi_integrator_q(integrator), dvi_integrator_q(untroubled),
                     2 * sizeof(double));
  }
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&untroubled);
  problem_destroy(&model);
}
END_TEST

/* A start chooses the jump that varies as little as the motion does. A start with the jump 0 would
 * change it by as much as its own size. */
START_TEST(a_run_starts_on_the_smooth_branch)
{
  static const char *const methods[] = {"dg:degree=0", "dg:degree=2", "dg:degree=2,stiffness=1",
                                        "dg:degree=3,stiffness=1"};
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  double last[2], jump[2];
  ck_assert_double_eq(dvi_integrator_jump(integrator, NULL), 0);
  advance(integrator, 0.02, 1);
  for (int step = 0; step < 5; step++) {
    const double size = dvi_integrator_jump(integrator, last);
    advance(integrator, 0.02, 1);
    (void)dvi_integrator_jump(integrator, jump);
    ck_assert_double_gt(size, 0);
    ck_assert_double_le(distance(2, jump, last), 0.15 * size);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- structure ---- */

/* gradient[i] of alpha(q).w, alpha = (1 + r^2)/2 (-y, x) of massless-particle. */
static void form_times(const double *q, const double *w, double *gradient)
{
  const double x = q[0], y = q[1], s = (1 + x * x + y * y) / 2, turn = -y * w[0] + x * w[1];
  gradient[0] = x * turn + s * w[1];
  gradient[1] = y * turn - s * w[0];
}

/* The one-form of the map (q-, q+): dN/dq+ = alpha({q}) + (Dalpha)^T [q]/2 + c [q] against dq+. {q}
 * = q* + Omega({q})^-1 c [q] by iteration. */
static void point_and_momentum(const dvi_integrator *integrator, double c, double *point,
                               double *momentum)
{
  double jump[2], mean[2], turned[2], alpha[2];
  (void)dvi_integrator_jump(integrator, jump);
  memcpy(mean, dvi_integrator_q(integrator), sizeof mean);
  for (int k = 0; k < 60; k++) {
    /* Omega = field (0 1; -1 0) */
    const double field = 1 + 2 * (mean[0] * mean[0] + mean[1] * mean[1]);
    mean[0] = dvi_integrator_q(integrator)[0] - c * jump[1] / field;
    mean[1] = dvi_integrator_q(integrator)[1] + c * jump[0] / field;
  }
  const double s = (1 + mean[0] * mean[0] + mean[1] * mean[1]) / 2;
  alpha[0] = -mean[1] * s;
  alpha[1] = mean[0] * s;
  form_times(mean, jump, turned);
  for (int i = 0; i < 2; i++) {
    point[i] = mean[i] + jump[i] / 2;
    momentum[i] = alpha[i] + turned[i] / 2 + c * jump[i];
  }
}

/* oint momentum . d point over a loop of starts, by the derivative of the trigonometric polynomial
 * through them. */
enum { POINTS = 128 };

static double loop_integral(dvi_integrator *const *at, double c)
{
  static double point[POINTS][2], momentum[POINTS][2];
  const double pi = 3.14159265358979323846;
  double integral = 0;
  for (int k = 0; k < POINTS; k++) point_and_momentum(at[k], c, point[k], momentum[k]);
  for (int k = 0; k < POINTS; k++)
    for (int i = 0; i < 2; i++) {
      double slope = 0;
      for (int l = 0; l < POINTS; l++)
        if (l != k) slope += ((k - l) % 2 ? -0.5 : 0.5) / tan(pi * (k - l) / POINTS) * point[l][i];
      integral += momentum[k][i] * slope * 2 * pi / POINTS;
    }
  return integral;
}

static const struct {
  const char *method;
  double c, h;
} symplectic[] = {{"dg:degree=0", 0, 0.1},
                  {"dg:degree=1,alarm=warn", 0, 0.1},
                  {"dg:degree=2", 0, 0.5},
                  {"dg:degree=1,stiffness=1", 1, 0.1},
                  {"dg:degree=3,stiffness=1", 1, 0.5}};

/* Compares from the first step on, because the start knows no jump. With another c than the
 * method's the form is not conserved, which shows that the test can tell. */
START_TEST(loop_integrals_of_the_map_of_both_sides_are_conserved)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *at[POINTS];
  for (int k = 0; k < POINTS; k++) {
    const double angle = 2 * 3.14159265358979323846 * k / POINTS,
                 q[2] = {1 + 0.05 * cos(angle), 1 + 0.05 * sin(angle)};
    double p[2];
    at[k] = create_integrator(model->system, symplectic[_i].method);
    ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(at[k], 0, q, p), DVI_OK);
    advance(at[k], symplectic[_i].h, 1);
  }
  const double c = symplectic[_i].c, before = loop_integral(at, c),
               other = loop_integral(at, c + 1);
  for (int k = 0; k < POINTS; k++) advance(at[k], symplectic[_i].h, lround(30 / symplectic[_i].h));
  ck_assert_double_le(fabs(loop_integral(at, c) / before - 1), 1e-11);
  ck_assert_double_ge(fabs(loop_integral(at, c + 1) / other - 1), 1e-10);
  for (int k = 0; k < POINTS; k++) dvi_integrator_destroy(&at[k]);
  problem_destroy(&model);
}
END_TEST

START_TEST(symmetric_fluxes_go_back_the_way_they_came)
{
  static const char *const methods[] = {"dg", "dg:degree=1,stiffness=1",
                                        "dg:degree=3,flux=path,stiffness=0.5"};
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  advance(integrator, 0.05, 20);
  advance(integrator, -0.05, 20);
  ck_assert_double_le(distance(model->nq, dvi_integrator_q(integrator), model->q), 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* alpha = (-y, x)/2 + g (x, y): a gauge in which the one-sided flux on the right has the stiffness
 * g, and the one on the left -g. */
static int turning(const double *q, double *alpha, void *user)
{
  const double g = *(const double *)user;
  alpha[0] = -q[1] / 2 + g * q[0];
  alpha[1] = q[0] / 2 + g * q[1];
  return 0;
}

static int turning_gradient(const double *q, double *alpha_q, void *user)
{
  const double g = *(const double *)user, entries[] = {g, -0.5, 0.5, g};
  (void)q;
  memcpy(alpha_q, entries, sizeof entries);
  return 0;
}

static int bowl(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = cosh(q[0]) + q[1] * q[1] / 2;
  return 0;
}

static dvi_integrator *turned(double *g, const char *method, dvi_system **system)
{
  const dvi_one_form one_form = {.value = turning, .gradient = turning_gradient, .user = g};
  const dvi_potential potential = {.name = "H", .value = bowl};
  const dvi_system_terms terms = {.dimension = 2,
                                  .one_form = &one_form,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .autonomous = 1};
  const double q[2] = {0.5, 0.2}, v[2] = {0};
  double p[2];
  ck_assert_int_eq(dvi_system_create(&terms, system), DVI_OK);
  dvi_integrator *integrator = create_integrator(*system, method);
  ck_assert_int_eq(dvi_system_momentum(*system, 0, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  return integrator;
}

/* Both integrators may start off the smooth branch in their own way. That needs S odd. */
START_TEST(a_flux_at_one_side_is_an_average_flux_with_the_gauges_stiffness)
{
  dvi_system *here = NULL, *there = NULL;
  double none = 0, gauge = _i == 0 ? -0.75 : 0.75;
  dvi_integrator *stiff = turned(&none, "dg:stiffness=0.75", &here);
  dvi_integrator *one_sided = turned(&gauge, _i == 0 ? "dg:flux=left" : "dg:flux=right", &there);
  advance(stiff, 0.2, 100);
  advance(one_sided, 0.2, 100);
  ck_assert_double_le(distance(2, dvi_integrator_q(stiff), dvi_integrator_q(one_sided)), 1e-9);
  ck_assert_double_gt(dvi_integrator_jump(stiff, NULL), 1e-6);
  dvi_integrator_destroy(&stiff);
  dvi_integrator_destroy(&one_sided);
  dvi_system_destroy(&here);
  dvi_system_destroy(&there);
}
END_TEST

/* The Jacobians are exact: Newton's method alone takes few iterations, also with a stiffness and
 * points off the middle of the path. */
START_TEST(newtons_method_suffices)
{
  static const char *const methods[] = {"dg", "dg:degree=3,stiffness=1",
                                        "dg:degree=2,flux=path,points=3", "dg:degree=0"};
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  dvi_counters counters;
  advance(integrator, 0.05, 20);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.kinsols, 0);
  /* Elements of degree 0 lead far from their rates, and most of their steps are followed. */
  ck_assert_int_le(counters.residuals, (_i == 3 ? 72 : 12) * 22);
  ck_assert_int_eq(counters.jump_alarms, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- refusals ---- */

static const struct {
  const char *method, *because;
} refused[] = {
    {"dg:degree=8", "degree=8; 0 to 7 are possible"},
    {"dg:degree=2,nodes=2", "take 3 or more"},
    {"dg:flux=left,points=2", "points=2 goes with flux=path"},
    {"dg:stiffness=0", "number 1 of stiffness is 0; positive ones are possible, or none at all"},
    {"dg:stiffness=1:0", "number 2 of stiffness is 0"},
    {"dg:stiffness=nan", "positive ones of at most 15 characters are possible"},
    {"dg:stiffness=inf", "positive ones of at most 15 characters are possible"},
    {"dg:stiffness=1:2:3", "one for each of the 2 coordinates"},
    {"dg:stiffness=1:1,stiffness=2", "stiffness is given twice"},
    {"dg:stiffness=", "is not a list of numbers"},
    {"dg:stiffness=1:", "is not a list of numbers"},
    {"dg:stiffness=:1", "is not a list of numbers"},
    {"dg:stiffness=1:-2", "is not a list of numbers"},
    {"dg:stiffness=.5", "is not a list of numbers"},
    {"dg:stiffness=0.50", "is not a list of numbers"},
    {"dg:stiffness=01", "is not a list of numbers"},
    {"dg:stiffness=1e3", "is not a list of numbers"},
    {"dg:stiffness=1234567890.1234567", "is not a list of numbers"},
    {"dg:stiffness=1:1:1:1:1:1:1:1:1:1:1:1:1:1:1:1:1",
     "more than 16 numbers; 1 to 16 are possible"},
    {"dg:stifness=1", "it takes degree, nodes, flux, points, alarm, stiffness"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(what_cannot_be_is_refused_with_its_reason)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, refused[_i].method, &none), DVI_BAD_OPTION);
  check_words(refused[_i].because);
  ck_assert_ptr_null(none);
  problem_destroy(&model);
}
END_TEST

START_TEST(specifications_are_spelled_out_and_read_again)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *first = create_integrator(model->system, "dg:stiffness=0.00002:3,degree=1");
  ck_assert_str_eq(dvi_integrator_method(first),
                   "dg:degree=1,nodes=2,flux=average,points=1,alarm=stop,stiffness=0.00002:3");
  dvi_integrator *again = create_integrator(model->system, dvi_integrator_method(first));
  ck_assert_str_eq(dvi_integrator_method(first), dvi_integrator_method(again));
  ck_assert(isnan(dvi_integrator_jump(first, NULL))); /* it has not started */
  dvi_integrator *continuous = start_integrator(model, "vprk");
  ck_assert(isnan(dvi_integrator_jump(continuous, NULL)));
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&again);
  dvi_integrator_destroy(&continuous);
  problem_destroy(&model);
}
END_TEST

SUITE(dg)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, degrees_fluxes_and_stiffnesses_have_the_order_that_they_claim, 0,
                      CLAIMS);
  tcase_add_loop_test(tests, five_and_six_coefficients_have_order_10, 4, 6);
  tcase_add_loop_test(tests, a_stiffness_that_goes_with_the_step_has_order_2S, 1, 4);
  tcase_add_loop_test(tests, energy_stays_bounded, 0, RUNS);
  tcase_add_loop_test(tests, runs_without_a_stiffness_break_down_and_the_alarm_stops_them_first, 0,
                      2);
  tcase_add_test(tests, an_alarm_leaves_the_state_or_is_counted);
  tcase_add_test(tests, a_step_out_of_the_logarithms_domain_leaves_the_state);
  tcase_add_loop_test(tests, a_run_starts_on_the_smooth_branch, 0, 4);
  tcase_add_loop_test(tests, loop_integrals_of_the_map_of_both_sides_are_conserved, 0, 5);
  tcase_add_loop_test(tests, symmetric_fluxes_go_back_the_way_they_came, 0, 3);
  tcase_add_loop_test(tests, a_flux_at_one_side_is_an_average_flux_with_the_gauges_stiffness, 0, 2);
  tcase_add_loop_test(tests, newtons_method_suffices, 0, 4);
  tcase_add_loop_test(tests, what_cannot_be_is_refused_with_its_reason, 0, REFUSED);
  tcase_add_test(tests, specifications_are_spelled_out_and_read_again);
}
