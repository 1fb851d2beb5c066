/* labels: jacobian */
/* Tests one element against its definition. The discrete action is summed here from the public
 * quadrature, basis and Lagrangian, and the stationarity rows must be its derivatives. */
#include <float.h>
#include <math.h>

#include "step/element/action.h"
#include "step/element/action_struct.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "element.h"

/* S(q0,Y) = h sum_j b_j L(t0 + c_j h, q(c_j), q'(c_j)/h) */
static double discrete_action(const element *e, const double *q0, const double *Y)
{
  double node[NODES_MOST], weight[NODES_MOST], q[SITES], v[SITES], L, sum = 0;
  require_ok(dvi_quadrature(e->space.rule, e->space.nodes, node, weight));
  for (int j = 0; j < e->space.nodes; j++) {
    path(e, q0, Y, node[j], q, v);
    require_ok(dvi_system_lagrangian(e->system, t0 + node[j] * h, q, v, &L));
    sum += h * weight[j] * L;
  }
  return sum;
}

static const double moved[3] = {0.01, 0.02, 0.03}, share[3] = {1.5, -0.6, 0.1};

/* Gives dS/dx of one number of q0 or Y by the central difference of order 6 with d = 0.01. Its
 * error is d^6/140 of the 7th derivative, about 1e-11, and an epsilon of S over d, about 1e-13. */
static double slope(const element *e, double *x, const double *q0, const double *Y)
{
  const double at = *x;
  double sum = 0;
  for (int m = 0; m < 3; m++) {
    *x = at + moved[m];
    const double plus = discrete_action(e, q0, Y);
    *x = at - moved[m];
    sum += share[m] * (plus - discrete_action(e, q0, Y)) / (2 * moved[m]);
  }
  *x = at;
  return sum;
}

static void check_residual(int kind, dvi__action_space space)
{
  element e;
  double R[UNKNOWNS_MOST], psi[DEGREE_MOST], dpsi[DEGREE_MOST];
  make_element(kind, space, &e);
  ck_assert_msg(dvi__action_residual(e.action, e.Y, R) == DVI_OK, "%s", dvi_last_error());
  evaluate_trial(&e.space, 1, psi, dpsi);
  for (int i = 0; i < SITES; i++) {
    const double p1 = e.p0[i] + slope(&e, &e.q0[i], e.q0, e.Y);
    for (int k = 0; k < e.space.degree; k++) {
      const int x = i * e.space.degree + k;
      ck_assert_double_eq_tol(R[x], slope(&e, &e.Y[x], e.q0, e.Y) - psi[k] * p1, 1e-9);
    }
  }
  free_element(&e);
}

START_TEST(the_residual_is_the_gradient_of_the_discrete_action)
{
  for_every_basis(check_residual, _i);
}
END_TEST

static void check_ends(int kind, dvi__action_space space)
{
  element e;
  double R[UNKNOWNS_MOST], dq[SITES], low[SITES], dp[SITES], q1[SITES], v[SITES];
  make_element(kind, space, &e);
  require_ok(dvi__action_residual(e.action, e.Y, R));
  dvi__action_ends(e.action, e.Y, dq, low, dp);
  path(&e, e.q0, e.Y, 1, q1, v);
  for (int i = 0; i < SITES; i++) {
    /* a few roundings of numbers up to 2 */
    ck_assert_double_eq_tol(dq[i] + low[i], q1[i] - e.q0[i], 8 * DBL_EPSILON * 2);
    ck_assert_double_eq_tol(dp[i], slope(&e, &e.q0[i], e.q0, e.Y), 1e-9);
  }
  free_element(&e);
}

START_TEST(ends_are_the_path_s_end_and_the_discrete_momentum)
{
  for_every_basis(check_ends, _i);
}
END_TEST

/* Column x of dR/dY by the same differences, and the largest entry outside the pattern. */
static double check_column(element *e, int x, const double *values)
{
  const int count = SITES * e->space.degree;
  const dvi__pattern *pattern = dvi__action_pattern(e->action);
  double plus[UNKNOWNS_MOST], minus[UNKNOWNS_MOST], column[UNKNOWNS_MOST] = {0}, outside = 0;
  const double at = e->Y[x];
  for (int m = 0; m < 3; m++) {
    e->Y[x] = at + moved[m];
    require_ok(dvi__action_residual(e->action, e->Y, plus));
    e->Y[x] = at - moved[m];
    require_ok(dvi__action_residual(e->action, e->Y, minus));
    for (int i = 0; i < count; i++) column[i] += share[m] * (plus[i] - minus[i]) / (2 * moved[m]);
  }
  e->Y[x] = at;
  for (int i = 0; i < count; i++) {
    const int entry = dvi__pattern_find(pattern, i, x);
    if (entry < 0) outside = fmax(outside, fabs(column[i]));
    /* Entries are up to 1e3 (K M/h). The dense kinds' Hessians are differences with an error of
     * 1e-9 of that. */
    else
      ck_assert_double_eq_tol(values[entry], column[i], 1e-7 * fmax(1, fabs(column[i])));
  }
  return outside;
}

static void check_jacobian(int kind, dvi__action_space space)
{
  element e;
  double values[UNKNOWNS_MOST * UNKNOWNS_MOST];
  make_element(kind, space, &e);
  ck_assert_msg(dvi__action_prepare_jacobian(e.action) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi__action_jacobian(e.action, e.Y, values) == DVI_OK, "%s", dvi_last_error());
  for (int x = 0; x < SITES * e.space.degree; x++)
    ck_assert_double_le(check_column(&e, x, values), 1e-10);
  free_element(&e);
}

START_TEST(the_jacobian_is_the_derivative_of_the_residual)
{
  for_every_basis(check_jacobian, _i);
}
END_TEST

/* Products without the Jacobian use the same Hessians. They are sums of up to 35 terms of its size,
 * added in another order. */
static void check_product(int kind, dvi__action_space space)
{
  element e;
  double values[UNKNOWNS_MOST * UNKNOWNS_MOST], x[UNKNOWNS_MOST], y[UNKNOWNS_MOST],
      size[UNKNOWNS_MOST] = {0};
  make_element(kind, space, &e);
  require_ok(dvi__action_prepare_jacobian(e.action));
  require_ok(dvi__action_prepare_product(e.action));
  require_ok(dvi__action_jacobian(e.action, e.Y, values));
  const dvi__pattern *pattern = dvi__action_pattern(e.action);
  for (int i = 0; i < pattern->columns; i++) x[i] = cos(3 * i);
  dvi__action_times_jacobian(e.action, x, y);
  for (int j = 0; j < pattern->columns; j++)
    for (int entry = pattern->start[j]; entry < pattern->start[j + 1]; entry++) {
      y[pattern->row[entry]] -= values[entry] * x[j];
      size[pattern->row[entry]] += fabs(values[entry] * x[j]);
    }
  for (int i = 0; i < pattern->columns; i++)
    ck_assert_double_le(fabs(y[i]), 1e-14 * fmax(1, size[i]));
  free_element(&e);
}

START_TEST(products_are_those_of_the_jacobian)
{
  for_every_basis(check_product, _i);
}
END_TEST

START_TEST(the_jacobian_s_pattern_is_a_block_for_each_pair_that_interacts)
{
  static const int pairs[SYSTEMS] = {3 * SITES - 2, 3 * SITES - 2, 3 * SITES - 2, 3 * SITES - 2,
                                     3 * SITES - 2, SITES * SITES, SITES * SITES};
  element e;
  make_element(_i, (dvi__action_space){DVI_LEGENDRE, 3, DVI_GAUSS, 3}, &e);
  ck_assert_int_eq(dvi__action_prepare_jacobian(e.action), DVI_OK);
  ck_assert_int_eq(dvi__pattern_entries(dvi__action_pattern(e.action)), 9 * pairs[_i]);
  free_element(&e);
}
END_TEST

/* ---- tables ---- */

START_TEST(tables_are_consistent_to_the_last_bit)
{
  static const int sizes[][2] = {{1, 1}, {2, 2}, {3, 5}, {7, 8}, {16, 17}, {40, 40}};
  const int *size = sizes[_i / BASES];
  dvi_system *system = create_system(SCALAR_MASS);
  dvi__action *a;
  ck_assert_int_eq(
      dvi__action_create(system,
                         &(dvi__action_space){(dvi_basis)(_i % BASES), size[0], DVI_GAUSS, size[1]},
                         NULL, &a),
      DVI_OK);
  for (int k = 0; k < size[0]; k++)
    for (int j = 0; j < size[1]; j++) {
      const double psi = a->psi[k * a->lanes + j], bar = a->bar[k * a->lanes + j];
      ck_assert_double_eq(psi - a->end[k], bar);
      ck_assert_double_eq(bar + a->end[k], psi);
    }
  dvi__action_destroy(&a);
  dvi_system_destroy(&system);
}
END_TEST

static void check_tables(int kind, dvi__action_space space)
{
  element e;
  double node[NODES_MOST], weight[NODES_MOST], psi[DEGREE_MOST], dpsi[DEGREE_MOST];
  make_element(kind, space, &e);
  const dvi__action *a = e.action;
  const int r = e.space.nodes;
  ck_assert_int_eq(dvi_quadrature(e.space.rule, r, node, weight), DVI_OK);
  for (int j = 0; j < r; j++) {
    evaluate_trial(&e.space, node[j], psi, dpsi);
    ck_assert_double_eq(a->weight[j], weight[j]);
    for (int k = 0; k < e.space.degree; k++) {
      /* functions up to 2, and their slopes, at rounded nodes */
      ck_assert_double_eq_tol(a->psi[k * a->lanes + j], psi[k], 1e-14);
      ck_assert_double_eq_tol(a->dpsi[k * a->lanes + j], dpsi[k], 1e-14 * 200);
    }
  }
  evaluate_trial(&e.space, 1, psi, dpsi);
  for (int k = 0; k < e.space.degree; k++) ck_assert_double_eq_tol(a->end[k], psi[k], 1e-14);
  free_element(&e);
}

START_TEST(tables_hold_the_trial_functions)
{
  for_every_basis(check_tables, _i);
}
END_TEST

SUITE(element)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, the_residual_is_the_gradient_of_the_discrete_action, 0,
                      SYSTEMS * RULES);
  tcase_add_loop_test(tests, ends_are_the_path_s_end_and_the_discrete_momentum, 0, SYSTEMS * RULES);
  tcase_add_loop_test(tests, the_jacobian_is_the_derivative_of_the_residual, 0, SYSTEMS * RULES);
  tcase_add_loop_test(tests, products_are_those_of_the_jacobian, 0, SYSTEMS * RULES);
  tcase_add_loop_test(tests, the_jacobian_s_pattern_is_a_block_for_each_pair_that_interacts, 0,
                      SYSTEMS);
  tcase_add_loop_test(tests, tables_are_consistent_to_the_last_bit, 0, 6 * BASES);
  tcase_add_loop_test(tests, tables_hold_the_trial_functions, 0, RULES);
}
