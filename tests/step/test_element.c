/* labels: jacobian */
/* Tests one element against its definition. The discrete action is summed here from the public
 * quadrature, basis and Lagrangian, and the stationarity rows must be its derivatives. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/action.h"
#include "step/element/action_struct.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { DEGREE_MOST = 8, NODES_MOST = 12, UNKNOWNS_MOST = SITES * DEGREE_MOST };

static const double t0 = 0.4, h = 0.3;
static behaviour quiet;

/* ---- systems ---- */

enum {
  SCALAR_MASS,
  DIAGONAL_MASS,
  SPARSE_MASS,
  GENERAL,
  MIXED,
  DENSE_POTENTIAL,
  DENSE_GENERAL,
  SYSTEMS
};

/* The dense kinds leave Hessian and pattern out, so every entry may be nonzero, and the library
 * takes differences. */
static dvi_system *create_system(int kind)
{
  static const double diagonal[SITES] = {1, 2, 0.5, 3, 1.5, 0.7};
  dvi_lagrangian lagrangian = rotors(&quiet, BATCH);
  dvi_potential potentials[2] = {springs(&quiet, ONE_POINT), wells(&quiet, BATCH)};
  dvi_system_terms terms = {.dimension = SITES, .potentials = potentials, .potential_count = 2};
  if (kind == DENSE_POTENTIAL) potentials[0].hessian = NULL, potentials[0].qq = (dvi_pattern){0};
  if (kind == DENSE_GENERAL)
    lagrangian.hessian_batch = NULL,
    lagrangian.qq = lagrangian.qv = lagrangian.vv = (dvi_pattern){0};
  if (kind == GENERAL || kind == DENSE_GENERAL) terms.potentials = NULL, terms.potential_count = 0;
  if (kind == GENERAL || kind == MIXED || kind == DENSE_GENERAL)
    terms.lagrangian = &lagrangian;
  else if (kind == DIAGONAL_MASS)
    terms.mass.diagonal = diagonal;
  else if (kind == SPARSE_MASS)
    terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
  else
    terms.mass.scalar = 1.3;
  return make_system(&terms);
}

/* ---- spaces ---- */

enum { BASES = DVI_CHEBYSHEV + 1 };

/* Degrees, rules and nodes. The rules are short, just enough, or long. */
static const dvi__action_space rules[] = {
    {0, 1, DVI_MIDPOINT, 1}, {0, 1, DVI_TRAPEZOID, 2},   {0, 2, DVI_GAUSS, 2},
    {0, 2, DVI_SIMPSON, 3},  {0, 3, DVI_LOBATTO, 3},     {0, 3, DVI_RADAU_LEFT, 4},
    {0, 4, DVI_GAUSS, 6},    {0, 4, DVI_RADAU_RIGHT, 4}, {0, 5, DVI_CLENSHAW_CURTIS, 7},
};
enum { RULES = sizeof rules / sizeof *rules };

/* The kind of system and the rule of a looped test, which also loops over the bases. */
static void for_every_basis(void (*check)(int kind, dvi__action_space space), int index)
{
  dvi__action_space space = rules[index % RULES];
  for (int basis = 0; basis < BASES; basis++) {
    space.basis = (dvi_basis)basis;
    check(index / RULES, space);
  }
}

/* ---- the element and its definition ---- */

typedef struct element {
  dvi_system *system;
  dvi__action *action;
  dvi_counters counters;
  dvi__action_space space;
  double q0[SITES], p0[SITES], Y[UNKNOWNS_MOST];
} element;

static void make_element(int kind, dvi__action_space space, element *e)
{
  *e = (element){.system = create_system(kind), .space = space};
  ck_assert_msg(dvi__action_create(e->system, &space, &e->counters, &e->action) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi__action_unknowns(e->action), SITES * space.degree);
  memcpy(e->q0, generic_q, sizeof e->q0);
  memcpy(e->p0, generic_v, sizeof e->p0);
  for (int i = 0; i < SITES; i++)
    for (int k = 0; k < space.degree; k++)
      e->Y[i * space.degree + k] = h * (generic_v[i] + 0.3 * cos(2 * i + 5 * k)) / (1 + k);
  dvi__action_place(e->action, t0, h, e->q0, e->p0);
}

static void free_element(element *e)
{
  dvi__action_destroy(&e->action);
  dvi_system_destroy(&e->system);
}

/* Requires DVI_OK. Check's assertions write a record each, and these calls come by the million. */
static void require_ok(dvi_status status)
{
  if (status != DVI_OK) ck_abort_msg("%s", dvi_last_error());
}

/* psi_k = phi_k - phi_k(0) and its derivative, k = 1..degree. */
static void evaluate_trial(const dvi__action_space *space, double tau, double *psi, double *dpsi)
{
  double start[DEGREE_MOST + 1], value[DEGREE_MOST + 1], derivative[DEGREE_MOST + 1];
  require_ok(dvi_basis_evaluate(space->basis, space->degree, 0, start, NULL));
  require_ok(dvi_basis_evaluate(space->basis, space->degree, tau, value, derivative));
  for (int k = 0; k < space->degree; k++) {
    psi[k] = value[k + 1] - start[k + 1];
    dpsi[k] = derivative[k + 1];
  }
}

static void path(const element *e, const double *q0, const double *Y, double tau, double *q,
                 double *v)
{
  double psi[DEGREE_MOST], dpsi[DEGREE_MOST];
  evaluate_trial(&e->space, tau, psi, dpsi);
  for (int i = 0; i < SITES; i++) {
    q[i] = q0[i];
    v[i] = 0;
    for (int k = 0; k < e->space.degree; k++) {
      q[i] += psi[k] * Y[i * e->space.degree + k];
      v[i] += dpsi[k] * Y[i * e->space.degree + k] / h;
    }
  }
}

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
  tcase_add_loop_test(tests, a_fitted_path_is_the_polynomial, 0, RULES);
  tcase_add_loop_test(tests, a_continued_path_is_the_same_polynomial, 0, RULES);
  tcase_add_loop_test(tests, a_straight_path_is_straight, 0, RULES);
  tcase_add_loop_test(tests, the_chord_inverts_the_kinetic_part, 0, SYSTEMS * RULES);
  tcase_add_loop_test(tests, rows_are_scaled_by_the_velocity_hessian_over_the_step, 0, SYSTEMS);
}
