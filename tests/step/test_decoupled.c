/* labels: unit jacobian */
/* For a quadratic Lagrangian the frozen Jacobian is the Jacobian, and the decoupled systems invert
 * it. */
#include <math.h>
#include <string.h>

#include "step/element/action.h"
#include "step/element/decoupled.h"
#include "core/memory.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum {
  N = 3,
  DEGREE_MOST = 9,
  UNKNOWNS_MOST = N * DEGREE_MOST,
  ENTRIES_MOST = UNKNOWNS_MOST * UNKNOWNS_MOST
};

/* L = v.Mv/2 + q.Gv - q.Kq/2 with symmetric M, K. */
static const double M[N][N] = {{2, 0.3, 0}, {0.3, 1, 0.1}, {0, 0.1, 3}},
                    K[N][N] = {{5, -1, 0}, {-1, 90, 2}, {0, 2, -4}};
static const double G[N][N] = {{0, 4, 0}, {-1, 0, 2}, {0, 0.5, 0}};

static int value(double t, const double *q, const double *v, double *L, void *user)
{
  const double mixed = *(const double *)user;
  (void)t;
  *L = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      *L += v[i] * M[i][j] * v[j] / 2 + mixed * q[i] * G[i][j] * v[j] - q[i] * K[i][j] * q[j] / 2;
  return 0;
}

static int gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                    void *user)
{
  const double mixed = *(const double *)user;
  (void)t;
  for (int i = 0; i < N; i++) {
    L_q[i] = L_v[i] = 0;
    for (int j = 0; j < N; j++) {
      L_q[i] += mixed * G[i][j] * v[j] - K[i][j] * q[j];
      L_v[i] += M[i][j] * v[j] + mixed * G[j][i] * q[j];
    }
  }
  return 0;
}

static int hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                   double *L_vv, void *user)
{
  const double mixed = *(const double *)user;
  (void)t, (void)q, (void)v;
  for (int j = 0, e = 0; j < N; j++)
    for (int i = 0; i < N; i++, e++) {
      L_qq[e] = -K[i][j];
      L_vv[e] = M[i][j];
      if (mixed != 0) L_qv[e] = mixed * G[i][j];
    }
  return 0;
}

static dvi_system *system_with(double *mixed)
{
  static const int none[N + 1] = {0};
  dvi_lagrangian l = {.value = value, .gradient = gradient, .hessian = hessian, .user = mixed};
  if (*mixed == 0) l.qv = (dvi_pattern){none, none};
  return make_system(&(dvi_system_terms){.dimension = N, .lagrangian = &l});
}

typedef struct element {
  dvi_system *system;
  dvi__action *action;
  dvi__decoupled *decoupled;
  dvi_counters counters;
} element;

static const double q0[N] = {0.3, -0.2, 0.5}, p0[N] = {1, 0.4, -0.7};

static void make_element(double *mixed, dvi__action_space space, double h, element *e)
{
  *e = (element){.system = system_with(mixed)};
  ck_assert_int_eq(dvi__action_create(e->system, &space, &e->counters, &e->action), DVI_OK);
  ck_assert_int_eq(dvi__action_prepare_jacobian(e->action), DVI_OK);
  ck_assert_msg(dvi__decoupled_create(e->action, &e->counters, &e->decoupled) == DVI_OK, "%s",
                dvi_last_error());
  dvi__action_place(e->action, 0, h, q0, p0);
}

static void free_element(element *e)
{
  dvi__decoupled_destroy(&e->decoupled);
  dvi__action_destroy(&e->action);
  dvi_system_destroy(&e->system);
}

/* R = J x, then J^{-1} R = x. Without a mixed part in any space; with one where quadratures are
 * exact enough. Steps from short to stiff: K_11 makes a frequency of 9.5. The systems have
 * conditions of up to 1e3, equispaced functions of degree 9 one of 1e4: an iteration's matrix needs
 * a few digits alone. */
static void check_inverse(double mixed, dvi__action_space space, double h)
{
  static double values[ENTRIES_MOST];
  const double Y[UNKNOWNS_MOST] = {0};
  double x[UNKNOWNS_MOST], R[UNKNOWNS_MOST] = {0};
  element e;
  make_element(&mixed, space, h, &e);
  const dvi__pattern *pattern = dvi__action_pattern(e.action);
  ck_assert_int_eq(dvi__action_jacobian(e.action, Y, values), DVI_OK);
  for (int j = 0; j < pattern->columns; j++) {
    x[j] = sin(1 + 2.3 * j);
    for (int k = pattern->start[j]; k < pattern->start[j + 1]; k++)
      R[pattern->row[k]] += values[k] * x[j];
  }
  ck_assert_msg(dvi__decoupled_freeze(e.decoupled, Y) == DVI_OK, "%s", dvi_last_error());
  dvi__decoupled_solve(e.decoupled, R);
  for (int j = 0; j < pattern->columns; j++) ck_assert_double_eq_tol(R[j], x[j], 1e-7);
  free_element(&e);
}

static const double steps[] = {0.01, 1, 30};

START_TEST(a_separable_jacobian_is_inverted_in_any_space)
{
  static const dvi__action_space spaces[] = {{DVI_LAGRANGE_LOBATTO, 1, DVI_MIDPOINT, 1},
                                             {DVI_LAGRANGE_LOBATTO, 1, DVI_TRAPEZOID, 2},
                                             {DVI_LEGENDRE, 2, DVI_GAUSS, 2},
                                             {DVI_LAGRANGE_GAUSS, 3, DVI_LOBATTO, 4},
                                             {DVI_CHEBYSHEV, 5, DVI_GAUSS, 7},
                                             {DVI_LAGRANGE_LOBATTO, 8, DVI_GAUSS, 8},
                                             {DVI_LEGENDRE, 9, DVI_RADAU_RIGHT, 9}};
  check_inverse(0, spaces[_i / 3], steps[_i % 3]);
}
END_TEST

START_TEST(a_mixed_jacobian_is_inverted_with_gauss_quadrature)
{
  check_inverse(1,
                (dvi__action_space){(dvi_basis)(_i % 6), 1 + _i / 6 % DEGREE_MOST, DVI_GAUSS,
                                    1 + _i / 6 % DEGREE_MOST},
                steps[_i / 6 / DEGREE_MOST]);
}
END_TEST

/* An odd degree has one real eigenvalue beside its pairs. */
START_TEST(one_factorisation_is_made_for_each_pair)
{
  double none = 0;
  const double Y[UNKNOWNS_MOST] = {0};
  const int degree = 1 + _i;
  element e;
  make_element(&none, (dvi__action_space){DVI_LEGENDRE, degree, DVI_GAUSS, degree}, 0.1, &e);
  ck_assert_int_eq(dvi__decoupled_freeze(e.decoupled, Y), DVI_OK);
  ck_assert_int_eq(e.counters.factorizations, (degree + 1) / 2);
  ck_assert_int_eq(e.counters.symbolic, 1); /* for all eigenvalues */
  ck_assert_int_eq(e.counters.preparations, (degree + 1) / 2);
  ck_assert_int_eq(e.counters.hessians, 1);
  free_element(&e);
}
END_TEST

START_TEST(creating_survives_every_failure)
{
  double mixed = 1;
  element e;
  make_element(&mixed, (dvi__action_space){DVI_LEGENDRE, 3, DVI_GAUSS, 3}, 0.1, &e);
  int failures = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; failures += status != DVI_OK) {
    dvi__decoupled_destroy(&e.decoupled);
    dvi__fail_allocations_after(failures);
    status = dvi__decoupled_create(e.action, &e.counters, &e.decoupled);
    dvi__fail_allocations_after(-1);
    if (status != DVI_OK) {
      ck_assert_int_eq(status, DVI_NO_MEMORY);
      ck_assert_ptr_null(e.decoupled);
    }
  }
  ck_assert_int_gt(failures, 3);
  free_element(&e);
}
END_TEST

/* The first freezing takes memory, and once it is there no other one. */
START_TEST(freezing_survives_every_failure)
{
  const double Y[UNKNOWNS_MOST] = {0};
  double mixed = 1;
  element e;
  make_element(&mixed, (dvi__action_space){DVI_LEGENDRE, 3, DVI_GAUSS, 3}, 0.1, &e);
  int failures = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK; failures += status != DVI_OK) {
    dvi__fail_allocations_after(failures);
    status = dvi__decoupled_freeze(e.decoupled, Y);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "%s", dvi_last_error());
  }
  ck_assert_int_gt(failures, 3);
  dvi__fail_allocations_after(0);
  ck_assert_int_eq(dvi__decoupled_freeze(e.decoupled, (const double[UNKNOWNS_MOST]){1}), DVI_OK);
  dvi__fail_allocations_after(-1);
  free_element(&e);
}
END_TEST

SUITE(decoupled)
{
  tcase_add_loop_test(tests, a_separable_jacobian_is_inverted_in_any_space, 0, 7 * 3);
  tcase_add_loop_test(tests, a_mixed_jacobian_is_inverted_with_gauss_quadrature, 0,
                      6 * DEGREE_MOST * 3);
  tcase_add_loop_test(tests, one_factorisation_is_made_for_each_pair, 0, DEGREE_MOST);
  tcase_add_test(tests, creating_survives_every_failure);
  tcase_add_test(tests, freezing_survives_every_failure);
}
