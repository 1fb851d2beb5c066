/* labels: order */
/* Time-transformed methods have their own order in q, p and physical time. */
#include <dvi/method.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/paced.h"
#include "support/suite.h"

enum { LEVELS = 5, MOST = 8 };

static dvi_integrator *create_transformed_integrator(const problem *model,
                                                     const dvi_monitor *monitor, const char *method)
{
  dvi_integrator *made = NULL;
  ck_assert_msg(create_transformed(model->system, monitor, method, &made) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_integrator_start(made, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

/* Each level has half as many steps again as the one before, because high orders would meet the
 * floor otherwise. */
static int steps_at(int first, int level)
{
  return (int)lround(first * pow(1.5, level));
}

/* The least-squares slope of log error over log steps. */
static double slope(int first, const double *error)
{
  double mean_x = 0, mean_y = 0, product = 0, square = 0;
  for (int k = 0; k < LEVELS; k++) {
    mean_x += log(steps_at(first, k)) / LEVELS;
    mean_y += log(error[k]) / LEVELS;
  }
  for (int k = 0; k < LEVELS; k++) {
    const double x = log(steps_at(first, k)) - mean_x;
    product -= x * (log(error[k]) - mean_y);
    square += x * x;
  }
  return product / square;
}

static void check_slope(const char *what, const char *method, int first, const double *error,
                        int order)
{
  const double found = slope(first, error);
  if (getenv("DVI_SHOW_ORDERS") != NULL)
    (void)printf("%s %s: %.3f of %d (%.1e to %.1e)\n", what, method, found, order, error[0],
                 error[LEVELS - 1]);
  ck_assert_msg(error[LEVELS - 1] > 3e-13, "%s of %s is at the floor", what, method);
  ck_assert_msg(fabs(found - order) <= 0.2, "%s of %s: order %.3f, not %d", what, method, found,
                order);
}

/* With g = r, tau is the eccentric anomaly, q = (cos tau - e, sqrt(1-e^2) sin tau), t = tau - e sin
 * tau. */
static void check_on_kepler(const char *method, int order, int first, double tau)
{
  const double e = 0.3, b = sqrt(0.91), r = 1 - e * cos(tau);
  const double q[2] = {cos(tau) - e, b * sin(tau)}, p[2] = {-sin(tau) / r, b * cos(tau) / r},
               t = tau - e * sin(tau);
  double error[3][LEVELS];
  problem *kepler = create_problem("kepler", "e=0.3");
  const dvi_monitor monitor = {.kind = DVI_MONITOR_DISTANCE, .power = 1};
  for (int k = 0; k < LEVELS; k++) {
    dvi_integrator *integrator = create_transformed_integrator(kepler, &monitor, method);
    ck_assert_int_eq(dvi_integrator_order(integrator), order);
    advance(integrator, tau / steps_at(first, k), steps_at(first, k));
    error[0][k] = distance(2, dvi_integrator_q(integrator), q);
    error[1][k] = distance(2, dvi_integrator_p(integrator), p);
    error[2][k] = fabs(dvi_integrator_time(integrator) - t);
    dvi_integrator_destroy(&integrator);
  }
  check_slope("q", method, first, error[0], order);
  check_slope("p", method, first, error[1], order);
  check_slope("t", method, first, error[2], order);
  problem_destroy(&kepler);
}

static const struct {
  const char *method;
  int order, first; /* `first` is the number of steps of the coarsest run */
} methods[] = {
    {"midpoint", 2, 100},
    {"trapezoidal", 2, 100},
    {"galerkin:degree=1,quadrature=lobatto", 2, 100},
    {"galerkin:degree=2", 4, 40},
    {"galerkin:degree=2,quadrature=lobatto", 4, 60},
    {"galerkin:degree=2,quadrature=lobatto,nodes=2", 2, 100},
    {"galerkin:degree=2,quadrature=radau-left,nodes=2", 3, 200},
    {"galerkin:degree=3", 6, 8},
    {"galerkin:degree=3,quadrature=lobatto", 6, 10},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 4, 25},
    {"galerkin:degree=4", 8, 4},
    {"composition:order=4,base=midpoint", 4, 20},
    {"composition:order=6,base=galerkin,degree=2", 6, 12},
    {"hp", 2, 100},
    {"hp:type=2", 1, 200},
    {"hp:type=3", 1, 200},
    {"hamiltonian", 4, 40},
    {"hamiltonian:type=3", 4, 40},
    {"multiscale:degree=1,amplitude=0,fast=0:1,omega=0.5", 6, 6},
    {"multiscale:degree=2,amplitude=0,fast=0,omega=0.5", 4, 40},
    {"shooting", 4, 60},
    {"shooting:onestep=heun,quadrature=trapezoid", 2, 100},
    {"shooting:onestep=gauss,type=2", 4, 60},
    {"shooting:onestep=gauss,type=3", 4, 60},
    {"shooting:onestep=gauss,stages=3,quadrature=lobatto", 6, 6},
    {"shooting:onestep=gauss,solve=stages", 4, 60},
};
enum { METHODS = sizeof methods / sizeof *methods };

START_TEST(coordinates_momenta_and_time_have_the_order_of_the_method)
{
  check_on_kepler(methods[_i].method, methods[_i].order, methods[_i].first, 4.0);
}
END_TEST

/* Returns 1 if the method is among those above. */
static int is_measured(const char *name)
{
  for (int i = 0; i < METHODS; i++)
    if (strncmp(methods[i].method, name, strlen(name)) == 0 &&
        strchr(":", methods[i].method[strlen(name)]) != NULL)
      return 1;
  return 0;
}

/* So that no method takes transformed systems and forgets their time. */
START_TEST(every_method_is_measured_or_refuses)
{
  const dvi_monitor monitor = {.kind = DVI_MONITOR_DISTANCE};
  problem *kepler = create_problem("kepler", NULL);
  for (int i = 0; i < dvi_method_count(); i++) {
    dvi_integrator *none = NULL;
    if (is_measured(dvi_method_name(i))) continue;
    const dvi_status status = create_transformed(kepler->system, &monitor, dvi_method_name(i),
                                                 &none);
    ck_assert_msg(status == DVI_UNSUPPORTED, "%s is not in the list above", dvi_method_name(i));
    ck_assert_ptr_null(none);
  }
  problem_destroy(&kepler);
}
END_TEST

START_TEST(a_method_of_higher_derivatives_says_why_not)
{
  const dvi_monitor monitor = {.kind = DVI_MONITOR_DISTANCE};
  const char *const of_derivatives[] = {"prolongation-collocation", "shooting:onestep=taylor"};
  problem *kepler = create_problem("kepler", NULL);
  for (int i = 0; i < 2; i++) {
    dvi_integrator *none = NULL;
    ck_assert_int_eq(create_transformed(kepler->system, &monitor, of_derivatives[i], &none),
                     DVI_UNSUPPORTED);
    check_words("a time-transformed system has no Taylor coefficients");
  }
  problem_destroy(&kepler);
}
END_TEST

/* A monitor without meaning for the motion. The order does not depend on the monitor. */
static int wave_monitor(double t, const double *q, double *g, void *user)
{
  (void)t, (void)user;
  *g = 1.5 + sin(q[0]) * cos(2 * q[1]);
  return 0;
}

static int wave_gradient(double t, const double *q, double *g_q, void *user)
{
  (void)t, (void)user;
  g_q[0] = cos(q[0]) * cos(2 * q[1]);
  g_q[1] = -2 * sin(q[0]) * sin(2 * q[1]);
  return 0;
}

/* A run to a physical time, whose last step is shorter. It ends at that time up to roundoff, with
 * the method's order. */
static void check_runs(const char *name, const dvi_monitor *monitor, const char *method, int order,
                       int first)
{
  double error[LEVELS], q[MOST], p[MOST];
  problem *model = create_problem(name, NULL);
  const double t_end = model->order_t_end;
  for (int i = 0; i < model->nq; i++) q[i] = model->q[i], p[i] = model->p[i];
  ck_assert_double_lt(quad_solve(name, 0, NULL, t_end, q, p), 1e-15);
  for (int k = 0; k < LEVELS; k++) {
    dvi_integrator *integrator = create_transformed_integrator(model, monitor, method);
    ck_assert_msg(dvi_run(integrator,
                          &(dvi_run_options){.h = t_end / steps_at(first, k), .t_end = t_end},
                          NULL) == DVI_OK,
                  "%s", dvi_last_error());
    /* 16 roundings */
    ck_assert_double_eq_tol(dvi_integrator_time(integrator), t_end, 4e-15 * t_end);
    error[k] = distance(model->nq, dvi_integrator_q(integrator), q);
    dvi_integrator_destroy(&integrator);
  }
  check_slope(name, method, first, error, order);
  problem_destroy(&model);
}

START_TEST(a_mass_that_depends_on_the_coordinates_may_be_transformed)
{
  const dvi_monitor monitor = {.function = {.value = wave_monitor, .gradient = wave_gradient}};
  check_runs("double-pendulum", &monitor, "midpoint", 2, 60);
  check_runs("double-pendulum", &monitor, "galerkin:degree=2", 4, 60);
  check_runs("double-pendulum", &monitor, "galerkin:degree=3", 6, 40);
}
END_TEST

/* g depends on E0 here, and its gradient on the potential's Hessian. */
START_TEST(arc_lengths_and_accelerations_keep_the_order)
{
  check_runs("henon-heiles", &(dvi_monitor){.kind = DVI_MONITOR_ARCLENGTH}, "galerkin:degree=2", 4,
             100);
  check_runs("kepler", &(dvi_monitor){.kind = DVI_MONITOR_ARCLENGTH}, "galerkin:degree=3", 6, 40);
  check_runs("kepler", &(dvi_monitor){.kind = DVI_MONITOR_ACCELERATION}, "galerkin:degree=3", 6,
             40);
}
END_TEST

SUITE(transform_order)
{
  tcase_add_loop_test(tests, coordinates_momenta_and_time_have_the_order_of_the_method, 0, METHODS);
  tcase_add_test(tests, every_method_is_measured_or_refuses);
  tcase_add_test(tests, a_method_of_higher_derivatives_says_why_not);
  tcase_add_test(tests, a_mass_that_depends_on_the_coordinates_may_be_transformed);
  tcase_add_test(tests, arc_lengths_and_accelerations_keep_the_order);
}
