/* labels: order reference */
/* Optimal control against exact solutions, and against Pontryagin's equations of the swing-up of a
 * pendulum, whose digits are those of a shooting method in quadruple precision. */
#include <dvi/dvi.h>
#include <math.h>

#include "support/suite.h"

/* ---- plants: x'' = -stiffness x, or the pendulum x'' = -sin x, with one control ---- */

typedef struct plant {
  double stiffness;
  int pendulum;
  double factor; /* of the cost u^2/2 */
  double price;  /* of time */
} plant;

static int plant_value(double t, const double *q, double *V, void *user)
{
  const plant *p = user;
  (void)t;
  *V = p->pendulum ? -cos(q[0]) : p->stiffness * q[0] * q[0] / 2;
  return 0;
}

static int plant_gradient(double t, const double *q, double *V_q, void *user)
{
  const plant *p = user;
  (void)t;
  V_q[0] = p->pendulum ? sin(q[0]) : p->stiffness * q[0];
  return 0;
}

static int plant_hessian(double t, const double *q, double *V_qq, void *user)
{
  const plant *p = user;
  (void)t;
  V_qq[0] = p->pendulum ? cos(q[0]) : p->stiffness;
  return 0;
}

static int plant_cost(double t, const double *q, const double *v, const double *u, double *C,
                      double *C_q, double *C_v, double *C_u, void *user)
{
  const plant *p = user;
  (void)t, (void)q, (void)v, (void)C_q, (void)C_v;
  *C = p->factor * u[0] * u[0] / 2 + p->price;
  C_u[0] = p->factor * u[0];
  return 0;
}

static int plant_force(double t, const double *q, const double *v, const double *u, double *F,
                       double *F_q, double *F_v, double *F_u, void *user)
{
  (void)t, (void)q, (void)v, (void)F_q, (void)F_v, (void)user;
  F[0] = u[0];
  F_u[0] = 1;
  return 0;
}

static dvi_system *make_plant(plant *p)
{
  dvi_system *system = NULL;
  const dvi_potential V = {
      .value = plant_value, .gradient = plant_gradient, .hessian = plant_hessian, .user = p};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass = {.scalar = 1},
                                  .potentials = &V,
                                  .potential_count = 1,
                                  .autonomous = p->price > 0};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

typedef struct task {
  plant plant;
  double q0, q1, span;
} task;

static const task carriage = {{0, 0, 1, 0}, 0, 1, 1}, oscillator = {{1, 0, 1, 0}, 1, 0, 3},
                  swing_up = {{0, 1, 1, 0}, 0, 3.14159265358979323846, 5};

/* Solves a task from rest to rest. u0 is the first control, and by_p0 the first costate. */
static dvi_control_report solve_task(task of, const char *method, int steps, const double *bounds,
                                     double *u0, double *by_p0)
{
  static const double rest[] = {0};
  dvi_system *system = make_plant(&of.plant);
  dvi_control *control = NULL;
  dvi_control_report report;
  const dvi_controls controls = {.count = 1,
                                 .cost = plant_cost,
                                 .force = plant_force,
                                 .least = bounds,
                                 .most = bounds != NULL ? bounds + 1 : NULL,
                                 .user = &of.plant};
  const dvi_control_options options = {.steps = steps,
                                       .span = of.span,
                                       .free_span = of.plant.price > 0,
                                       .dimension = 1,
                                       .q0 = &of.q0,
                                       .p0 = rest,
                                       .q1 = &of.q1,
                                       .p1 = rest};
  double by_q;
  ck_assert_msg(dvi_control_create(system, method, &controls, &options, &control) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_control_solve(control, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_control_u(control, 0, u0), DVI_OK);
  ck_assert_int_eq(dvi_control_costate(control, 0, &by_q, by_p0), DVI_OK);
  dvi_control_destroy(&control);
  dvi_system_destroy(&system);
  return report;
}

/* The midpoint rule with N steps costs 6/(1 - 1/N^2) for x'' = u. */
START_TEST(a_carriage_costs_six_over_one_less_the_square_of_the_step)
{
  for (int steps = 2; steps <= 512; steps *= 4) {
    double u0, by_p0;
    const dvi_control_report report = solve_task(carriage, "midpoint", steps, NULL, &u0, &by_p0);
    ck_assert_double_eq_tol(report.cost * (1 - 1 / ((double)steps * steps)), 6, 2e-14);
    ck_assert_int_eq(report.is_minimum, 1);
    ck_assert_int_eq(report.multipliers, steps + 1);
  }
}
END_TEST

/* ---- orders ---- */

static const double oscillator_cost = 0.318515048047909, swing_up_cost = 1.21259059572144,
                    swing_up_u0 = 0.574476113945;

static const struct {
  const char *method;
  int order, steps; /* steps of the coarsest of four levels */
} orders[] = {{"midpoint", 2, 20},
              {"trapezoidal", 2, 20},
              {"galerkin:degree=2", 4, 10},
              {"galerkin:degree=2,quadrature=lobatto,nodes=3", 4, 10},
              {"galerkin:degree=3", 6, 10}};
enum { ORDERS = sizeof orders / sizeof *orders };

/* Fits the order to the errors of four levels, each with twice the steps of the one before. */
static void check_order(const char *what, const char *method, const double *error, int order)
{
  for (int k = 0; k < 3; k++) {
    const double fitted = log2(fabs(error[k]) / fabs(error[k + 1]));
    ck_assert_msg(fabs(fitted - order) < 0.35,
                  "%s of %s: order %.2f at level %d, errors %.2e, %.2e", what, method, fitted, k,
                  error[k], error[k + 1]);
  }
}

START_TEST(cost_and_control_have_the_order_of_the_method)
{
  double of_oscillator[4], of_swing_up[4], of_u0[4];
  for (int k = 0; k < 4; k++) {
    double u0, by_p0;
    const int steps = orders[_i].steps << k;
    of_oscillator[k] = solve_task(oscillator, orders[_i].method, steps, NULL, &u0, &by_p0).cost -
                       oscillator_cost;
    of_swing_up[k] = solve_task(swing_up, orders[_i].method, steps, NULL, &u0, &by_p0).cost -
                     swing_up_cost;
    of_u0[k] = u0 - swing_up_u0;
    ck_assert_double_eq_tol(by_p0, -u0, 1e-12); /* Pontryagin: u = -w */
  }
  check_order("the oscillator's cost", orders[_i].method, of_oscillator, orders[_i].order);
  check_order("the swing-up's cost", orders[_i].method, of_swing_up, orders[_i].order);
  check_order("the swing-up's control", orders[_i].method, of_u0, orders[_i].order);
}
END_TEST

START_TEST(digits_are_those_of_pontryagins_equations)
{
  double u0, by_p0;
  dvi_control_report report = solve_task(oscillator, "galerkin:degree=4", 40, NULL, &u0, &by_p0);
  ck_assert_double_eq_tol(report.cost, oscillator_cost, 1e-14);
  report = solve_task(swing_up, "galerkin:degree=4", 80, NULL, &u0, &by_p0);
  ck_assert_double_eq_tol(report.cost, swing_up_cost, 1e-13);
  ck_assert_double_eq_tol(u0, swing_up_u0, 1e-12);
  ck_assert_int_eq(report.is_minimum, 1);
}
END_TEST

/* The unit of the cost changes nothing but the cost. */
START_TEST(a_cost_in_other_units_has_the_same_control)
{
  for (double factor = 1e-8; factor < 1e9; factor *= 1e4) {
    task of = swing_up;
    double u0, by_p0;
    of.plant.factor = factor;
    const dvi_control_report report = solve_task(of, "galerkin:degree=4", 40, NULL, &u0, &by_p0);
    ck_assert_double_eq_tol(report.cost / factor, swing_up_cost, 1e-12);
    ck_assert_double_eq_tol(u0, swing_up_u0, 1e-11);
    ck_assert_int_eq(report.is_minimum, 1);
  }
}
END_TEST

/* ---- free spans ---- */

/* With u^2/2 + price the carriage costs price T + 6/(T^3 (1 - 1/N^2)), least where T^4 is 18/(price
 * (1 - 1/N^2)). */
START_TEST(a_free_span_is_that_of_the_least_cost)
{
  static const double guesses[] = {0.3, 1, 2, 9};
  for (int k = 0; k < 4; k++) {
    task of = carriage;
    double u0, by_p0;
    const double N = 20, price = 0.5, six = 6 / (1 - 1 / (N * N)), T = pow(3 * six / price, 0.25);
    of.plant.price = price;
    of.span = guesses[k];
    const dvi_control_report report = solve_task(of, "midpoint", (int)N, NULL, &u0, &by_p0);
    ck_assert_double_eq_tol(report.span, T, 1e-13 * T);
    ck_assert_double_eq_tol(report.cost, price * T + six / pow(T, 3), 1e-13);
  }
}
END_TEST

/* ---- bounds ---- */

/* From rest to rest over 1 in time 1 with |u| < M the control is linear for |t - 1/2| < s and M
 * beyond, with s^2 = 3/4 - 3/M, and costs M^2 (1/2 - 2 s/3). */
START_TEST(bounds_hold_and_cost_what_they_must)
{
  for (double M = 4.25; M < 6; M += 0.5) {
    double u0, by_p0;
    const double bounds[] = {-M, M}, s = sqrt(0.75 - 3 / M);
    const dvi_control_report report = solve_task(carriage, "midpoint", 200, bounds, &u0, &by_p0);
    ck_assert_double_lt(u0, M);
    ck_assert_double_gt(u0, M - 1e-6);
    ck_assert_double_eq_tol(report.cost, M * M * (0.5 - 2 * s / 3), 2e-3);
    ck_assert_double_gt(report.barrier, 0);
    ck_assert_int_eq(report.is_minimum, 1);
  }
}
END_TEST

static dvi_status try_task(task of, const double *bounds, dvi_control_options options,
                           dvi_controls controls)
{
  static const double rest[] = {0};
  dvi_system *system = make_plant(&of.plant);
  dvi_control *control = NULL;
  controls.user = &of.plant;
  controls.least = bounds;
  controls.most = bounds != NULL ? bounds + 1 : NULL;
  options.q0 = options.q0 != NULL ? options.q0 : &of.q0;
  options.q1 = &of.q1;
  options.p0 = options.p1 = rest;
  dvi_status status = dvi_control_create(system, "midpoint", &controls, &options, &control);
  if (status == DVI_OK) {
    status = dvi_control_solve(control, NULL);
    ck_assert_ptr_null(dvi_control_q(control, 0));
  }
  dvi_control_destroy(&control);
  dvi_system_destroy(&system);
  return status;
}

static const dvi_control_options plain = {.steps = 50, .span = 1, .dimension = 1};
static const dvi_controls one_control = {.count = 1, .cost = plant_cost, .force = plant_force};

/* No control below 4 goes so far in time. */
START_TEST(ends_beyond_the_bounds_have_no_solution)
{
  const double bounds[] = {-3.5, 3.5};
  ck_assert_int_gt(try_task(carriage, bounds, plain, one_control), 0);
  check_words("control: path: no stationary path");
}
END_TEST

static int no_force(double t, const double *q, const double *v, const double *u, double *F,
                    double *F_q, double *F_v, double *F_u, void *user)
{
  (void)t, (void)q, (void)v, (void)u, (void)F, (void)F_q, (void)F_v, (void)F_u, (void)user;
  return 0;
}

static int concave_cost(double t, const double *q, const double *v, const double *u, double *C,
                        double *C_q, double *C_v, double *C_u, void *user)
{
  (void)t, (void)q, (void)v, (void)C_q, (void)C_v, (void)user;
  *C = -u[0] * u[0];
  C_u[0] = -2 * u[0];
  return 0;
}

START_TEST(problems_without_a_solution_are_refused)
{
  dvi_controls controls = one_control;
  controls.force = no_force;
  ck_assert_int_ne(try_task(carriage, NULL, plain, controls), DVI_OK);
  check_words("control: ");
  controls = one_control;
  controls.cost = concave_cost;
  ck_assert_int_ne(try_task(carriage, NULL, plain, controls), DVI_OK);
  check_words("the cost has no minimum in the controls");
}
END_TEST

START_TEST(options_that_make_no_sense_are_refused)
{
  const double crossed[] = {1, -1}, bad[] = {NAN};
  dvi_control_options options = plain;
  dvi_controls controls = one_control;
  ck_assert_int_eq(try_task(carriage, crossed, plain, one_control), DVI_BAD_ARGUMENT);
  check_words("control 0 is to lie between 1 and -1");
  options.dimension = 2;
  ck_assert_int_eq(try_task(carriage, NULL, options, one_control), DVI_BAD_SIZE);
  options = plain;
  options.q0 = bad;
  ck_assert_int_eq(try_task(carriage, NULL, options, one_control), DVI_BAD_ARGUMENT);
  check_words("number 0 of q0 is nan");
  options = plain;
  options.span = -1;
  ck_assert_int_eq(try_task(carriage, NULL, options, one_control), DVI_BAD_ARGUMENT);
  options = plain;
  options.free_span = 1;
  ck_assert_int_eq(try_task(carriage, NULL, options, one_control), DVI_UNSUPPORTED);
  check_words("declared autonomous");
  task slower = carriage;
  slower.plant.price = 1e-30; /* autonomous, and slower is cheaper */
  ck_assert_int_eq(try_task(slower, NULL, options, one_control), DVI_NOT_CONVERGED);
  check_words("the cost must count the time");
  controls.count = 0;
  ck_assert_int_eq(try_task(carriage, NULL, plain, controls), DVI_BAD_SIZE);
  controls = one_control;
  controls.cost = NULL;
  ck_assert_int_eq(try_task(carriage, NULL, plain, controls), DVI_BAD_ARGUMENT);
  check_words("no cost");
  ck_assert_int_eq(dvi_control_create(NULL, "midpoint", &one_control, &plain, NULL),
                   DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(control)
{
  tcase_add_test(tests, a_carriage_costs_six_over_one_less_the_square_of_the_step);
  tcase_add_loop_test(tests, cost_and_control_have_the_order_of_the_method, 0, ORDERS);
  tcase_add_test(tests, digits_are_those_of_pontryagins_equations);
  tcase_add_test(tests, a_cost_in_other_units_has_the_same_control);
  tcase_add_test(tests, a_free_span_is_that_of_the_least_cost);
  tcase_add_test(tests, bounds_hold_and_cost_what_they_must);
  tcase_add_test(tests, ends_beyond_the_bounds_have_no_solution);
  tcase_add_test(tests, problems_without_a_solution_are_refused);
  tcase_add_test(tests, options_that_make_no_sense_are_refused);
}
