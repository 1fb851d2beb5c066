/* labels: jacobian */
/* The energies of an element are derivatives of its action in its times, and their gradients are
 * derivatives of both. All are tested against differences. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/energy.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { DEGREE_MOST = 4, UNKNOWNS_MOST = SITES * DEGREE_MOST };

static behaviour quiet;
static const double t0 = 0.4, h0 = 0.3;

enum { AUTONOMOUS, DRIVEN_MASS, DRIVEN_LAGRANGIAN, SYSTEMS };

/* V = sin(3 t + q_0) q_1 has all of V_tq and V_tt, which differences of the element must get
 * right. */
static int wave_value(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = sin(3 * t + q[0]) * q[1];
  return 0;
}

static int wave_rate(double t, const double *q, double *V_t, void *user)
{
  (void)user;
  *V_t = 3 * cos(3 * t + q[0]) * q[1];
  return 0;
}

static int wave_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  memset(V_q, 0, SITES * sizeof *V_q);
  V_q[0] = cos(3 * t + q[0]) * q[1];
  V_q[1] = sin(3 * t + q[0]);
  return 0;
}

static dvi_system *create_system(int kind)
{
  const dvi_lagrangian lagrangian = rotors(&quiet, BATCH);
  dvi_potential potentials[3] = {
      springs(&quiet, BATCH),
      wells(&quiet, BATCH),
      {.name = "wave", .value = wave_value, .rate = wave_rate, .gradient = wave_gradient}};
  dvi_system_terms terms = {.dimension = SITES, .potentials = potentials, .potential_count = 3};
  if (kind == DRIVEN_LAGRANGIAN)
    terms.lagrangian = &lagrangian;
  else
    terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
  if (kind == AUTONOMOUS) {
    potentials[0].rate_batch = NULL;
    terms.potential_count = 1;
    terms.autonomous = 1;
  }
  return make_system(&terms);
}

static const dvi__action_space spaces[] = {{DVI_LAGRANGE_LOBATTO, 1, DVI_GAUSS, 1},
                                           {DVI_LAGRANGE_LOBATTO, 1, DVI_LOBATTO, 2},
                                           {DVI_LEGENDRE, 3, DVI_GAUSS, 3},
                                           {DVI_LAGRANGE_LOBATTO, 4, DVI_LOBATTO, 5}};
enum { SPACES = sizeof spaces / sizeof *spaces };

typedef struct element {
  dvi_system *system;
  dvi__action *action;
  dvi_counters counters;
  int unknowns;
  double q0[SITES], p0[SITES], Y[UNKNOWNS_MOST];
} element;

static void require_ok(dvi_status status)
{
  if (status != DVI_OK) ck_abort_msg("%s", dvi_last_error());
}

static void make_element(int index, element *e)
{
  const dvi__action_space *space = &spaces[index % SPACES];
  *e = (element){.system = create_system(index / SPACES), .unknowns = SITES * space->degree};
  require_ok(dvi__action_create(e->system, space, &e->counters, &e->action));
  require_ok(dvi__action_prepare_jacobian(e->action));
  require_ok(dvi__action_prepare_energy(e->action));
  memcpy(e->q0, generic_q, sizeof e->q0);
  memcpy(e->p0, generic_v, sizeof e->p0);
  for (int i = 0; i < e->unknowns; i++) e->Y[i] = 0.3 * cos(1 + 2 * i);
}

static void free_element(element *e)
{
  dvi__action_destroy(&e->action);
  dvi_system_destroy(&e->system);
}

/* S(t0, h), from public functions alone. */
static double action_at(const element *e, const dvi__action_space *space, double start, double h)
{
  double node[8], weight[8], q[SITES], v[SITES], L, sum = 0;
  require_ok(dvi_quadrature(space->rule, space->nodes, node, weight));
  for (int j = 0; j < space->nodes; j++) {
    dvi__action_place(e->action, start, h, e->q0, e->p0);
    dvi__action_path(e->action, e->Y, h, node[j], q, v);
    for (int i = 0; i < SITES; i++) q[i] += e->q0[i];
    require_ok(dvi_system_lagrangian(e->system, start + node[j] * h, q, v, &L));
    sum += h * weight[j] * L;
  }
  return sum;
}

/* Central differences of order 6 over parts of 1/100 of h err by about 1e-11 of the numbers, by
 * roundoff as by truncation. */
static const double weight_of[3] = {1.5, -0.6, 0.1}, apart = 0.003;

START_TEST(the_energies_are_the_derivatives_of_the_action_in_the_times_of_the_ends)
{
  element e;
  double by_start = 0, by_length = 0, R[UNKNOWNS_MOST];
  dvi__energies E;
  make_element(_i, &e);
  const dvi__action_space *space = &spaces[_i % SPACES];
  for (int m = 1; m <= 3; m++) {
    const double d = m * apart, factor = weight_of[m - 1] / (2 * m * apart);
    by_length += factor * (action_at(&e, space, t0, h0 + d) - action_at(&e, space, t0, h0 - d));
    by_start += factor * (action_at(&e, space, t0 + d, h0) - action_at(&e, space, t0 - d, h0));
  }
  dvi__action_place(e.action, t0, h0, e.q0, e.p0);
  require_ok(dvi__action_residual(e.action, e.Y, R));
  require_ok(dvi__action_energies(e.action, &E));
  ck_assert_double_eq_tol(E.end, -by_length, 1e-9 * (1 + fabs(by_length)));
  ck_assert_double_eq_tol(E.start, by_start - by_length, 1e-9 * (1 + fabs(by_length)));
  if (_i / SPACES == AUTONOMOUS) ck_assert(E.start == E.end);
  free_element(&e);
}
END_TEST

/* Gives the rows and both energies at a point moved in Y by `direction`, in q0 by `start` and in h
 * by `length`. */
static void rows_at(const element *e, double d, const double *direction, const double *start,
                    double length, double *R, dvi__energies *E)
{
  double Y[UNKNOWNS_MOST], q0[SITES];
  for (int i = 0; i < e->unknowns; i++) Y[i] = e->Y[i] + d * direction[i];
  for (int i = 0; i < SITES; i++) q0[i] = e->q0[i] + d * start[i];
  dvi__action_place(e->action, t0, h0 + d * length, q0, e->p0);
  require_ok(dvi__action_residual(e->action, Y, R));
  require_ok(dvi__action_energies(e->action, E));
}

/* Derivatives along a direction. */
static void derivatives(const element *e, const double *direction, const double *start,
                        double length, double *R, dvi__energies *E)
{
  double plus[UNKNOWNS_MOST], minus[UNKNOWNS_MOST];
  *E = (dvi__energies){0};
  for (int i = 0; i < e->unknowns; i++) R[i] = 0;
  for (int m = 1; m <= 3; m++) {
    dvi__energies here, there;
    const double factor = weight_of[m - 1] / (2 * m * apart);
    rows_at(e, m * apart, direction, start, length, plus, &here);
    rows_at(e, -m * apart, direction, start, length, minus, &there);
    E->start += factor * (here.start - there.start);
    E->end += factor * (here.end - there.end);
    for (int i = 0; i < e->unknowns; i++) R[i] += factor * (plus[i] - minus[i]);
  }
}

static void gradients_of(element *e, dvi__energy_gradient *start, dvi__energy_gradient *end)
{
  static double values[UNKNOWNS_MOST * UNKNOWNS_MOST];
  dvi__action_place(e->action, t0, h0, e->q0, e->p0);
  require_ok(dvi__action_jacobian(e->action, e->Y, values));
  require_ok(dvi__action_energy_gradients(e->action, start, end));
}

static const double still[UNKNOWNS_MOST];

/* L_tq, L_tv and L_tt are differenced, with an error of 1e-8 of a rate of some units. */
START_TEST(the_h_column_is_the_derivative_of_the_rows)
{
  element e;
  double start_Y[UNKNOWNS_MOST], end_Y[UNKNOWNS_MOST], start_q0[SITES], end_q0[SITES],
      column[UNKNOWNS_MOST], expected[UNKNOWNS_MOST];
  dvi__energy_gradient start = {start_Y, start_q0, 0}, end = {end_Y, end_q0, 0};
  dvi__energies E;
  make_element(_i, &e);
  const double tolerance = _i / SPACES == AUTONOMOUS ? 1e-9 : 1e-8;
  gradients_of(&e, &start, &end);
  dvi__action_h_column(e.action, &end, column);
  derivatives(&e, still, still, 1, expected, &E);
  for (int i = 0; i < e.unknowns; i++)
    ck_assert_double_eq_tol(column[i], expected[i], tolerance * (1 + fabs(expected[i])));
  ck_assert_double_eq_tol(start.h, E.start, tolerance * (1 + fabs(E.start)));
  ck_assert_double_eq_tol(end.h, E.end, tolerance * (1 + fabs(E.end)));
  free_element(&e);
}
END_TEST

START_TEST(the_gradients_are_the_derivatives_of_the_energies)
{
  element e;
  double start_Y[UNKNOWNS_MOST], end_Y[UNKNOWNS_MOST], start_q0[SITES], end_q0[SITES],
      direction[UNKNOWNS_MOST], R[UNKNOWNS_MOST];
  dvi__energy_gradient start = {start_Y, start_q0, 0}, end = {end_Y, end_q0, 0};
  dvi__energies E;
  make_element(_i, &e);
  gradients_of(&e, &start, &end);
  for (int i = 0; i < e.unknowns; i++) {
    memcpy(direction, still, sizeof direction);
    direction[i] = 1;
    derivatives(&e, direction, still, 0, R, &E);
    ck_assert_double_eq_tol(start.Y[i], E.start, 1e-9 * (1 + fabs(E.start)));
    ck_assert_double_eq_tol(end.Y[i], E.end, 1e-9 * (1 + fabs(E.end)));
  }
  for (int i = 0; i < SITES; i++) {
    memcpy(direction, still, sizeof direction);
    direction[i] = 1;
    derivatives(&e, still, direction, 0, R, &E);
    ck_assert_double_eq_tol(start.q0[i], E.start, 1e-9 * (1 + fabs(E.start)));
    ck_assert_double_eq_tol(end.q0[i], E.end, 1e-9 * (1 + fabs(E.end)));
  }
  free_element(&e);
}
END_TEST

START_TEST(a_system_without_rates_has_no_energies)
{
  dvi_potential p = wells(&quiet, BATCH);
  p.rate_batch = NULL;
  dvi_counters counters = {0};
  dvi__action *action = NULL;
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  require_ok(dvi__action_create(system, &spaces[0], &counters, &action));
  require_ok(dvi__action_prepare_jacobian(action));
  ck_assert_int_eq(dvi__action_prepare_energy(action), DVI_UNSUPPORTED);
  check_words("wells has no rate callback");
  dvi__action_destroy(&action);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(energy)
{
  tcase_add_loop_test(tests,
                      the_energies_are_the_derivatives_of_the_action_in_the_times_of_the_ends, 0,
                      SYSTEMS * SPACES);
  tcase_add_loop_test(tests, the_h_column_is_the_derivative_of_the_rows, 0, SYSTEMS * SPACES);
  tcase_add_loop_test(tests, the_gradients_are_the_derivatives_of_the_energies, 0,
                      SYSTEMS * SPACES);
  tcase_add_test(tests, a_system_without_rates_has_no_energies);
}
