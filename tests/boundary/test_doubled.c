/* labels: jacobian order */
/* The Lagrangian of optimal control against differences, with a mass that depends on q, forces and
 * two controls; and its solutions against runs under the controls that were found. */
#include <dvi/dvi.h>
#include <math.h>

#include "boundary/doubled.h"
#include "support/suite.h"
#include "support/systems/machine.h"

enum { N = MACHINE_N, M = 2 };

static int any_cost(double t, const double *q, const double *v, const double *u, double *C,
                    double *C_q, double *C_v, double *C_u, void *user)
{
  (void)user;
  *C = cosh(u[0]) + u[1] * u[1] * (1 + q[0] * q[0]) + u[0] * u[1] / 2 + q[1] * v[0] + t;
  C_q[0] = 2 * u[1] * u[1] * q[0], C_q[1] = v[0];
  C_v[0] = q[1];
  C_u[0] = sinh(u[0]) + u[1] / 2, C_u[1] = 2 * u[1] * (1 + q[0] * q[0]) + u[0] / 2;
  return 0;
}

static int any_force(double t, const double *q, const double *v, const double *u, double *F,
                     double *F_q, double *F_v, double *F_u, void *user)
{
  (void)t, (void)user;
  F[0] = u[0] * (1 + v[1] * v[1]), F[1] = u[1] * sin(q[0]) + u[0] * q[1];
  F_q[1] = u[1] * cos(q[0]), F_q[N + 1] = u[0];
  F_v[N] = 2 * u[0] * v[1];
  F_u[0] = 1 + v[1] * v[1], F_u[1] = q[1], F_u[N + 1] = sin(q[0]);
  return 0;
}

static const double least[] = {-1, -INFINITY}, most[] = {INFINITY, 0.5};
static const dvi_controls free_controls = {.count = M, .cost = any_cost, .force = any_force},
                          bounded_controls = {.count = M,
                                              .cost = any_cost,
                                              .force = any_force,
                                              .least = least,
                                              .most = most};

static void check_gradient(const dvi_controls *controls, double mu)
{
  machine m = bent_machine;
  dvi_system *system = machine_system(&m);
  dvi__doubled *doubled = NULL;
  dvi__evaluator *e = NULL;
  const double t = 0.3, d = 1e-4;
  double z[8 * N] = {0.7, -0.4, 0.3, -0.2, 0.5, 1.1, -0.6, 0.9}, *q = z, *v = z + 2 * N;
  double G_q[2 * N], G_v[2 * N];
  ck_assert_msg(dvi__doubled_create(system, controls, &doubled) == DVI_OK, "%s", dvi_last_error());
  doubled->unit = 1.7;
  doubled->mu = mu;
  ck_assert_int_eq(dvi__evaluator_create(doubled->system, 1, DVI__GRADIENTS, NULL, &e), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, 1, &t, q, v, G_q, G_v), DVI_OK);
  for (int j = 0; j < 4 * N; j++) {
    const double from = z[j];
    double at[4];
    for (int k = 0; k < 4; k++) {
      z[j] = from + (k < 2 ? k - 2 : k - 1) * d;
      ck_assert_int_eq(dvi__lagrangian_value(e, 1, &t, q, v, &at[k]), DVI_OK);
    }
    z[j] = from;
    const double by_differences = (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * d);
    ck_assert_double_eq_tol(j < 2 * N ? G_q[j] : G_v[j - 2 * N], by_differences, 1e-9);
  }
  dvi__evaluator_destroy(&e);
  dvi__doubled_destroy(&doubled);
  dvi_system_destroy(&system);
}

START_TEST(the_gradient_is_that_of_differences)
{
  check_gradient(&free_controls, 0);
  check_gradient(&bounded_controls, 0.1);
}
END_TEST

/* ---- solutions ---- */

/* Forces of a run: the controls of the problem, at the quadrature points at which the run asks. */
typedef struct replay {
  dvi_control *control;
  int steps, points;
  double h;
} replay;

static int replayed_force(double t, const double *q, const double *v, double *F, void *user)
{
  const replay *r = user;
  double F_q[N * N] = {0}, F_v[N * N] = {0}, F_u[N * M] = {0}, u[M] = {0};
  const int k = (int)fmin(r->steps - 1, floor(t / r->h));
  for (int j = 0; j < r->points; j++) {
    double at;
    ck_assert_int_eq(dvi_control_point(r->control, k, j, &at, u), DVI_OK);
    if (fabs(at - t) < 1e-9) return any_force(t, q, v, u, F, F_q, F_v, F_u, NULL);
  }
  return any_force(t, q, v, u, F, F_q, F_v, F_u, NULL);
}

/* Under the controls that were found a run by the same method goes to the end. Its cost is not
 * larger than that of other controls, since all derivatives of the cost vanish (costates). */
START_TEST(a_run_under_the_controls_reaches_the_end)
{
  machine m = bent_machine;
  dvi_system *system = machine_system(&m), *driven = NULL;
  dvi_control *control = NULL;
  dvi_control_report report;
  dvi_integrator *integrator = NULL;
  const double q0[] = {0.7, -0.3}, p0[] = {0.4, 0.9}, q1[] = {0.2, 0.5}, p1[] = {0, 0.3};
  const dvi_control_options options = {.steps = 20,
                                       .span = 1,
                                       .dimension = N,
                                       .q0 = q0,
                                       .p0 = p0,
                                       .q1 = q1,
                                       .p1 = p1,
                                       .free_p1 = (const char[]){1, 0}};
  ck_assert_msg(
      dvi_control_create(system, "galerkin:degree=2", &free_controls, &options, &control) == DVI_OK,
      "%s", dvi_last_error());
  ck_assert_msg(dvi_control_solve(control, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(report.is_minimum, 1);
  replay r = {control, 20, dvi_control_points(control), 0.05};
  driven = machine_system_with(
      &m, &(dvi_force){.name = "controls", .value = replayed_force, .user = &r});
  ck_assert_int_eq(dvi_integrator_create(driven, "galerkin:degree=2,solver=newton", &integrator),
                   DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q0, p0), DVI_OK);
  for (int k = 0; k < 20; k++)
    ck_assert_msg(dvi_integrator_step(integrator, 0.05) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < N; i++) ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], q1[i], 1e-9);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[1], p1[1], 1e-9);
  double by_q[N], by_p[N];
  ck_assert_int_eq(dvi_control_costate(control, 20, by_q, by_p), DVI_OK);
  ck_assert_double_eq_tol(by_p[0], 0, 1e-12); /* of the momentum that is free */
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&driven);
  dvi_control_destroy(&control);
  dvi_system_destroy(&system);
}
END_TEST

/* Costates are the derivatives of the least cost by the start. */
static double cost_from(const double *q0, const double *p0, double *by_q, double *by_p)
{
  machine m = bent_machine;
  dvi_system *system = machine_system(&m);
  dvi_control *control = NULL;
  dvi_control_report report;
  const double q1[] = {0.2, 0.5}, p1[] = {0, 0.3};
  const dvi_control_options options = {
      .steps = 8, .span = 1, .dimension = N, .q0 = q0, .p0 = p0, .q1 = q1, .p1 = p1};
  ck_assert_int_eq(
      dvi_control_create(system, "galerkin:degree=3", &free_controls, &options, &control), DVI_OK);
  ck_assert_msg(dvi_control_solve(control, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_control_costate(control, 0, by_q, by_p), DVI_OK);
  dvi_control_destroy(&control);
  dvi_system_destroy(&system);
  return report.cost;
}

START_TEST(costates_are_derivatives_of_the_cost)
{
  double z[2 * N] = {0.7, -0.3, 0.4, 0.9}, costate[2 * N], unused[2 * N];
  (void)cost_from(z, z + N, costate, costate + N);
  for (int j = 0; j < 2 * N; j++) {
    const double from = z[j], d = 1e-3;
    double at[4];
    for (int k = 0; k < 4; k++) {
      z[j] = from + (k < 2 ? k - 2 : k - 1) * d;
      at[k] = cost_from(z, z + N, unused, unused + N);
    }
    z[j] = from;
    const double by_differences = (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * d);
    ck_assert_double_eq_tol(costate[j], by_differences, 1e-8 * fmax(1, fabs(by_differences)));
  }
}
END_TEST

SUITE(doubled)
{
  tcase_add_test(tests, the_gradient_is_that_of_differences);
  tcase_add_test(tests, a_run_under_the_controls_reaches_the_end);
  tcase_add_test(tests, costates_are_derivatives_of_the_cost);
}
