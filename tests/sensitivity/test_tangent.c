/* labels: jacobian */
/* Tangents of a run against complex steps of the discrete map, and adjoints against tangents. */
#include <dvi/dvi.h>
#include <math.h>

#include "support/systems/machine.h"
#include "support/suite.h"

enum { N = MACHINE_N, P = MACHINE_PARAMETERS, ROWS = 2 * N, COLUMNS = ROWS + P };

static const struct {
  const char *method;
  dvi_rule rule;
  int s, r, bent;
} maps[] = {
    {"midpoint", DVI_GAUSS, 1, 1, 1},
    {"trapezoidal", DVI_LOBATTO, 1, 2, 1},
    {"galerkin:degree=2", DVI_GAUSS, 2, 2, 1},
    {"galerkin:degree=3,quadrature=lobatto,nodes=4", DVI_LOBATTO, 3, 4, 1},
    {"galerkin:degree=3,basis=legendre", DVI_GAUSS, 3, 3, 0},
    {"verlet", DVI_LOBATTO, 1, 2, 0},
};
enum { MAPS = sizeof maps / sizeof *maps };

static const double start[ROWS] = {0.7, -0.3, 0.4, 0.9};

/* Computes column `moved` of the exact tangent by a complex step. */
static void exact_column(int index, int moved, double h, int steps, double *column)
{
  const double tiny = 1e-100;
  const machine *m = maps[index].bent ? &bent_machine : &straight_machine;
  double complex z[ROWS], theta[P];
  for (int i = 0; i < ROWS; i++) z[i] = start[i] + (i == moved ? tiny * (double complex)I : 0);
  for (int k = 0; k < P; k++)
    theta[k] = m->theta[k] + (ROWS + k == moved ? tiny * (double complex)I : 0);
  machine_run(theta, m->bend, maps[index].rule, maps[index].s, maps[index].r, h, steps, z);
  for (int i = 0; i < ROWS; i++) column[i] = cimag(z[i]) / tiny;
}

static dvi_sensitivity *create(int index, machine *m, dvi_system **system)
{
  dvi_sensitivity *s = NULL;
  *m = maps[index].bent ? bent_machine : straight_machine;
  *system = machine_system(m);
  const dvi_dependence dependence = machine_dependence(m);
  ck_assert_msg(dvi_sensitivity_create(*system, maps[index].method, &dependence, &s) == DVI_OK,
                "%s", dvi_last_error());
  return s;
}

START_TEST(tangents_are_those_of_the_discrete_map)
{
  const int steps = 20;
  const double h = 0.1;
  machine m;
  dvi_system *system;
  dvi_sensitivity *s = create(_i, &m, &system);
  ck_assert_int_eq(dvi_sensitivity_start(s, 0, start, start + N), DVI_OK);
  for (int k = 0; k < steps; k++)
    ck_assert_msg(dvi_sensitivity_step(s, h) == DVI_OK, "%s", dvi_last_error());
  const double *tangent = dvi_sensitivity_tangent(s);
  for (int c = 0; c < COLUMNS; c++) {
    double column[ROWS], size = 0;
    exact_column(_i, c, h, steps, column);
    for (int i = 0; i < ROWS; i++) size = fmax(size, fabs(column[i]));
    for (int i = 0; i < ROWS; i++)
      ck_assert_msg(fabs(tangent[c * ROWS + i] - column[i]) <= 1e-13 * fmax(size, 1),
                    "%s: entry %d of column %d is %.16g, not %.16g", maps[_i].method, i, c,
                    tangent[c * ROWS + i], column[i]);
  }
  dvi_sensitivity_destroy(&s);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- adjoints ---- */

/* end = q0 p1 + q1^2, rate = q0 v1 + theta_2 v0^2. */
static int end_of(double t, const double *q, const double *p, double *value, double *by_q,
                  double *by_p, double *by_theta, void *user)
{
  (void)t, (void)by_theta, (void)user;
  *value = q[0] * p[1] + q[1] * q[1];
  by_q[0] = p[1], by_q[1] = 2 * q[1], by_p[1] = q[0];
  return 0;
}

static int rate_of(double t, const double *q, const double *v, double *value, double *by_q,
                   double *by_v, double *by_theta, void *user)
{
  const machine *m = user;
  (void)t;
  *value = q[0] * v[1] + m->theta[2] * v[0] * v[0];
  by_q[0] = v[1], by_v[1] = q[0], by_v[0] = 2 * m->theta[2] * v[0];
  by_theta[2] = v[0] * v[0];
  return 0;
}

/* Steps whose number is, and is not, a square, and few of them. */
static const int lengths[] = {1, 2, 17, 25};

START_TEST(adjoints_of_end_functions_are_tangents_transposed)
{
  machine m;
  dvi_system *system;
  dvi_sensitivity *s = create(_i, &m, &system);
  const dvi_objective objective = {.end = end_of};
  for (int l = 0; l < 4; l++) {
    double by_q[N], by_p[N], by_theta[P], in_q[N] = {0}, in_p[N] = {0}, value;
    dvi_gradient gradient = {.by_q = by_q, .by_p = by_p, .by_theta = by_theta};
    const dvi_run_plan plan = {0, 0.1, lengths[l], start, start + N};
    ck_assert_msg(dvi_sensitivity_gradient(s, &plan, &objective, &gradient) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_ptr_null(dvi_sensitivity_tangent(s));
    ck_assert_int_eq(dvi_sensitivity_start(s, 0, start, start + N), DVI_OK);
    for (int k = 0; k < lengths[l]; k++) ck_assert_int_eq(dvi_sensitivity_step(s, 0.1), DVI_OK);
    end_of(0, dvi_sensitivity_q(s), dvi_sensitivity_p(s), &value, in_q, in_p, NULL, NULL);
    ck_assert_double_eq_tol(gradient.value, value, 1e-15);
    for (int c = 0; c < COLUMNS; c++) {
      const double *column = dvi_sensitivity_tangent(s) + c * ROWS;
      const double by_tangent = in_q[0] * column[0] + in_q[1] * column[1] + in_p[0] * column[2] +
                                in_p[1] * column[3];
      const double by_adjoint = c < N ? by_q[c] : c < ROWS ? by_p[c - N] : by_theta[c - ROWS];
      ck_assert_double_eq_tol(by_adjoint, by_tangent, 2e-14 * fmax(1, fabs(by_tangent)));
    }
  }
  dvi_sensitivity_destroy(&s);
  dvi_system_destroy(&system);
}
END_TEST

/* Returns the objective of a run whose start and parameters are moved by d along `moved`. */
static double objective_at(int index, int moved, double d)
{
  machine m;
  dvi_system *system;
  double z[ROWS], value;
  m = maps[index].bent ? bent_machine : straight_machine;
  for (int i = 0; i < ROWS; i++) z[i] = start[i] + (i == moved ? d : 0);
  if (moved >= ROWS) m.theta[moved - ROWS] += d;
  system = machine_system(&m);
  const dvi_objective objective = {end_of, rate_of, &m};
  const dvi_run_plan plan = {0, 0.1, 12, z, z + N};
  dvi_sensitivity *s = NULL;
  dvi_gradient gradient = {0};
  const dvi_dependence dependence = machine_dependence(&m);
  ck_assert_int_eq(dvi_sensitivity_create(system, maps[index].method, &dependence, &s), DVI_OK);
  ck_assert_int_eq(dvi_sensitivity_gradient(s, &plan, &objective, &gradient), DVI_OK);
  value = gradient.value;
  dvi_sensitivity_destroy(&s);
  dvi_system_destroy(&system);
  return value;
}

START_TEST(adjoints_of_integrals_are_those_of_differences)
{
  machine m;
  dvi_system *system;
  dvi_sensitivity *s = create(_i, &m, &system);
  double by_q[N], by_p[N], by_theta[P];
  dvi_gradient gradient = {.by_q = by_q, .by_p = by_p, .by_theta = by_theta};
  const dvi_objective objective = {end_of, rate_of, &m};
  const dvi_run_plan plan = {0, 0.1, 12, start, start + N};
  ck_assert_msg(dvi_sensitivity_gradient(s, &plan, &objective, &gradient) == DVI_OK, "%s",
                dvi_last_error());
  for (int c = 0; c < COLUMNS; c++) {
    const double d = 1e-3;
    const double by_differences = (8 * (objective_at(_i, c, d) - objective_at(_i, c, -d)) -
                                   (objective_at(_i, c, 2 * d) - objective_at(_i, c, -2 * d))) /
                                  (12 * d);
    const double by_adjoint = c < N ? by_q[c] : c < ROWS ? by_p[c - N] : by_theta[c - ROWS];
    ck_assert_double_eq_tol(by_adjoint, by_differences, 1e-8);
  }
  dvi_sensitivity_destroy(&s);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(tangent)
{
  tcase_add_loop_test(tests, tangents_are_those_of_the_discrete_map, 0, MAPS);
  tcase_add_loop_test(tests, adjoints_of_end_functions_are_tangents_transposed, 0, MAPS);
  tcase_add_loop_test(tests, adjoints_of_integrals_are_those_of_differences, 0, MAPS);
}
