/* labels: jacobian */
/* The paths of one element, fitted, continued and straight, and the chord, the kinetic part of its
 * Jacobian. */
#include <math.h>

#include "step/element/action.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "element.h"

/* ---- paths ---- */

/* A polynomial of this degree that vanishes at 0, one for each coordinate, and its derivative. */
static double polynomial(int degree, int i, double tau, double *derivative)
{
  double value = 0, slope_of = 0;
  for (int m = degree; m >= 0; m--) {
    slope_of = slope_of * tau + value;
    value = value * tau + (m > 0 ? cos(3 * i + m) : 0);
  }
  if (derivative != NULL) *derivative = slope_of;
  return value;
}

/* Gives Y of that polynomial, by its values at the fitting points. */
static void fit_polynomial(const element *e, double *Y)
{
  const int s = e->space.degree;
  const double *tau = dvi__action_fit_points(e->action);
  for (int i = 0; i < SITES; i++)
    for (int m = 0; m < s; m++) {
      ck_assert(tau[m] > 0 && tau[m] <= 1);
      Y[i * s + m] = polynomial(s, i, tau[m], NULL);
    }
  dvi__action_fit(e->action, Y, Y);
}

/* Rounding of sums of up to 5 terms up to 25 (equispaced functions outside of the step). */
static const double exact = 1e-12;

static void check_fit(int kind, dvi__action_space space)
{
  element e;
  double Y[UNKNOWNS_MOST], offset[SITES], v[SITES], derivative;
  make_element(kind, space, &e);
  fit_polynomial(&e, Y);
  for (double tau = -0.5; tau < 1.6; tau += 0.15) {
    dvi__action_path(e.action, Y, h, tau, offset, v);
    for (int i = 0; i < SITES; i++) {
      ck_assert_double_eq_tol(offset[i], polynomial(e.space.degree, i, tau, &derivative), exact);
      ck_assert_double_eq_tol(v[i], derivative / h, exact / h);
    }
  }
  free_element(&e);
}

START_TEST(a_fitted_path_is_the_polynomial)
{
  for_every_basis(check_fit, _i);
}
END_TEST

static void check_continued(int kind, dvi__action_space space)
{
  static const double ratios[] = {1, 0.5, 1.25, -1, 1};
  element e;
  double last[UNKNOWNS_MOST], Y[UNKNOWNS_MOST], offset[SITES];
  make_element(kind, space, &e);
  const int s = e.space.degree;
  fit_polynomial(&e, last);
  for (size_t m = 0; m < sizeof ratios / sizeof *ratios; m++) {
    dvi__action_continue(e.action, ratios[m], last, Y);
    for (double tau = 0; tau < 1.1; tau += 0.25) {
      dvi__action_path(e.action, Y, h, tau, offset, NULL);
      for (int i = 0; i < SITES; i++)
        ck_assert_double_eq_tol(
            offset[i], polynomial(s, i, 1 + ratios[m] * tau, NULL) - polynomial(s, i, 1, NULL),
            100 * exact);
    }
  }
  free_element(&e);
}

START_TEST(a_continued_path_is_the_same_polynomial)
{
  for_every_basis(check_continued, _i);
}
END_TEST

static void check_straight(int kind, dvi__action_space space)
{
  element e;
  double Y[UNKNOWNS_MOST], offset[SITES], v[SITES];
  make_element(kind, space, &e);
  dvi__action_straight(e.action, generic_v, Y);
  for (double tau = 0; tau < 1.1; tau += 0.25) {
    dvi__action_path(e.action, Y, h, tau, offset, v);
    for (int i = 0; i < SITES; i++) {
      ck_assert_double_eq_tol(offset[i], tau * h * generic_v[i], 1e-14);
      ck_assert_double_eq_tol(v[i], generic_v[i], 1e-13);
    }
  }
  free_element(&e);
}

START_TEST(a_straight_path_is_straight)
{
  for_every_basis(check_straight, _i);
}
END_TEST

/* ---- the chord ---- */

/* Gives column j of L_vv in the middle of the path. L_v is linear in v for all these systems, so a
 * difference of two momenta is exact. */
static void velocity_hessian_column(const element *e, int j, double *column)
{
  double q[SITES], v[SITES], p[SITES];
  path(e, e->q0, e->Y, 0.5, q, v);
  require_ok(dvi_system_momentum(e->system, t0 + 0.5 * h, q, v, p));
  v[j] += 1;
  require_ok(dvi_system_momentum(e->system, t0 + 0.5 * h, q, v, column));
  for (int i = 0; i < SITES; i++) column[i] -= p[i];
}

static double stiffness(const dvi__action_space *space, int k, int l)
{
  double node[NODES_MOST], weight[NODES_MOST], psi[DEGREE_MOST], dpsi[DEGREE_MOST], sum = 0;
  require_ok(dvi_quadrature(space->rule, space->nodes, node, weight));
  for (int j = 0; j < space->nodes; j++) {
    evaluate_trial(space, node[j], psi, dpsi);
    sum += weight[j] * dpsi[k] * dpsi[l];
  }
  return sum;
}

static void check_chord(int kind, dvi__action_space space)
{
  element e;
  double R[UNKNOWNS_MOST] = {0}, column[SITES];
  make_element(kind, space, &e);
  const int s = e.space.degree;
  for (int j = 0; j < SITES; j++) {
    velocity_hessian_column(&e, j, column);
    for (int k = 0; k < s; k++)
      for (int l = 0; l < s; l++)
        for (int i = 0; i < SITES; i++)
          R[i * s + k] += stiffness(&e.space, k, l) * column[i] / h * e.Y[j * s + l];
  }
  ck_assert_msg(dvi__action_prepare_chord(e.action, e.Y) == DVI_OK, "%s", dvi_last_error());
  dvi__action_chord(e.action, R);
  /* The condition numbers of K and L_vv multiply to at most 1e4. Differenced L_vv (the dense
   * general kind) are right to 1e-8. */
  for (int x = 0; x < SITES * s; x++)
    ck_assert_double_eq_tol(R[x], e.Y[x], kind == DENSE_GENERAL ? 1e-6 : 1e-12);
  free_element(&e);
}

START_TEST(the_chord_inverts_the_kinetic_part)
{
  for_every_basis(check_chord, _i);
}
END_TEST

START_TEST(rows_are_scaled_by_the_velocity_hessian_over_the_step)
{
  element e;
  double scale[UNKNOWNS_MOST], column[SITES];
  make_element(_i, (dvi__action_space){DVI_LEGENDRE, 2, DVI_GAUSS, 2}, &e);
  /* backward, where scales stay positive, and L_vv depends on q alone */
  dvi__action_place(e.action, t0 + h, -h, e.q0, e.p0);
  require_ok(dvi__action_prepare_chord(e.action, e.Y));
  ck_assert_int_eq(dvi__action_row_scale(e.action, scale), 1);
  for (int i = 0; i < SITES; i++) {
    double largest = 0;
    velocity_hessian_column(&e, i, column);
    for (int j = 0; j < SITES; j++) largest = fmax(largest, fabs(column[j]));
    /* differenced L_vv */
    for (int k = 0; k < 2; k++) ck_assert_double_eq_tol(scale[2 * i + k] * h, largest, 1e-8);
  }
  free_element(&e);
}
END_TEST

SUITE(element_paths)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, a_fitted_path_is_the_polynomial, 0, RULES);
  tcase_add_loop_test(tests, a_continued_path_is_the_same_polynomial, 0, RULES);
  tcase_add_loop_test(tests, a_straight_path_is_straight, 0, RULES);
  tcase_add_loop_test(tests, the_chord_inverts_the_kinetic_part, 0, SYSTEMS * RULES);
  tcase_add_loop_test(tests, rows_are_scaled_by_the_velocity_hessian_over_the_step, 0, SYSTEMS);
}
