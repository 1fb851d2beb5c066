/* labels: jacobian */
/* Tests the path of an element between two ends, and its first and second derivatives against
 * differences. */
#include <math.h>
#include <string.h>

#include "step/element/two_point.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { DEGREE_MOST = 5, COUNT_MOST = SITES * (DEGREE_MOST + 1) };

static const double t0 = 0.4, h = 0.3;
static behaviour quiet;

static const dvi__action_space spaces[] = {
    {DVI_LAGRANGE_LOBATTO, 1, DVI_MIDPOINT, 1},
    {DVI_LEGENDRE, 1, DVI_TRAPEZOID, 2},
    {DVI_LAGRANGE_LOBATTO, 2, DVI_GAUSS, 2},
    {DVI_CHEBYSHEV, 3, DVI_RADAU_LEFT, 4},
    {DVI_LAGRANGE_GAUSS, 4, DVI_LOBATTO, 5},
    {DVI_LAGRANGE_EQUISPACED, 5, DVI_CLENSHAW_CURTIS, 7},
};
enum { SPACES = sizeof spaces / sizeof *spaces };

/* Both ends and the bubbles of one element: X[0..n-1] is q0, then q1, then Z. */
typedef struct element {
  dvi_system *system;
  dvi__action *action;
  int s;
  double X[COUNT_MOST], rest[SITES], Y[COUNT_MOST];
} element;

/* A general Lagrangian that depends on time, or a potential with a mass that couples neighbours. */
static dvi_system *create_system(int general)
{
  const dvi_lagrangian lagrangian = rotors(&quiet, BATCH);
  const dvi_potential potentials[2] = {springs(&quiet, ONE_POINT), wells(&quiet, BATCH)};
  dvi_system_terms terms = {.dimension = SITES, .potentials = potentials, .potential_count = 2};
  if (general)
    terms.lagrangian = &lagrangian;
  else
    terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
  return make_system(&terms);
}

static void make_element(int index, element *e)
{
  const dvi__action_space *space = &spaces[index % SPACES];
  *e = (element){.system = create_system(index / SPACES), .s = space->degree};
  ck_assert_int_eq(dvi__action_create(e->system, space, NULL, &e->action), DVI_OK);
  ck_assert_int_eq(dvi__action_prepare_jacobian(e->action), DVI_OK);
  ck_assert_int_eq(dvi__action_prepare_two_point(e->action), DVI_OK);
  for (int i = 0; i < SITES; i++) {
    e->X[i] = generic_q[i];
    e->X[SITES + i] = generic_q[i] + h * generic_v[i];
  }
  for (int k = 0; k < SITES * (e->s - 1); k++) e->X[2 * SITES + k] = 0.2 * cos(3 * k);
}

static void free_element(element *e)
{
  dvi__action_destroy(&e->action);
  dvi_system_destroy(&e->system);
}

static void place_ends(element *e)
{
  dvi__action_place(e->action, t0, h, e->X, e->rest);
  dvi__action_two_point(e->action, e->X + SITES, e->X + 2 * SITES, e->Y);
}

static double value(element *e)
{
  double S, seen;
  place_ends(e);
  ck_assert_int_eq(dvi__action_value(e->action, e->Y, &S, &seen), DVI_OK);
  return S;
}

static void gradient(element *e, double *G)
{
  place_ends(e);
  ck_assert_int_eq(dvi__action_two_point_gradient(e->action, e->Y, G, G + SITES, G + 2 * SITES),
                   DVI_OK);
}

static const double moved[3] = {0.01, 0.02, 0.03}, share[3] = {1.5, -0.6, 0.1};

START_TEST(the_path_leads_from_one_end_to_the_other)
{
  element e;
  double offset[SITES];
  make_element(_i, &e);
  place_ends(&e);
  dvi__action_path(e.action, e.Y, h, 0, offset, NULL);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(offset[i], 0, 1e-15);
  dvi__action_path(e.action, e.Y, h, 1, offset, NULL);
  for (int i = 0; i < SITES; i++)
    ck_assert_double_eq_tol(e.X[i] + offset[i], e.X[SITES + i], 1e-14);
  free_element(&e);
}
END_TEST

/* Differences of order 6 with d = 0.01 err by 1e-11 of the derivative, and by an epsilon of S over
 * d. */
START_TEST(the_gradient_is_that_of_the_action)
{
  element e;
  double G[COUNT_MOST];
  make_element(_i, &e);
  gradient(&e, G);
  for (int x = 0; x < SITES * (e.s + 1); x++) {
    const double at = e.X[x];
    double slope = 0;
    for (int m = 0; m < 3; m++) {
      e.X[x] = at + moved[m];
      const double plus = value(&e);
      e.X[x] = at - moved[m];
      slope += share[m] * (plus - value(&e)) / (2 * moved[m]);
    }
    e.X[x] = at;
    ck_assert_double_eq_tol(G[x], slope, 1e-9);
  }
  free_element(&e);
}
END_TEST

/* Which X_a of which coordinate number x of X is. */
static void name(const element *e, int x, int *a, int *i)
{
  *a = x < 2 * SITES ? x / SITES : 2 + (x - 2 * SITES) % (e->s - 1);
  *i = x < 2 * SITES ? x % SITES : (x - 2 * SITES) / (e->s - 1);
}

START_TEST(the_hessian_is_that_of_the_action)
{
  element e;
  static double values[SITES * SITES * (DEGREE_MOST + 1) * (DEGREE_MOST + 1)];
  make_element(_i, &e);
  const int size = e.s + 1;
  place_ends(&e);
  ck_assert_int_eq(dvi__action_two_point_hessian(e.action, e.Y, values), DVI_OK);
  for (int y = 0; y < SITES * size; y++) {
    const double at = e.X[y];
    double plus[COUNT_MOST], minus[COUNT_MOST], column[COUNT_MOST] = {0};
    int b, j;
    name(&e, y, &b, &j);
    for (int m = 0; m < 3; m++) {
      e.X[y] = at + moved[m];
      gradient(&e, plus);
      e.X[y] = at - moved[m];
      gradient(&e, minus);
      for (int x = 0; x < SITES * size; x++)
        column[x] += share[m] * (plus[x] - minus[x]) / (2 * moved[m]);
    }
    e.X[y] = at;
    for (int x = 0; x < SITES * size; x++) {
      int a, i;
      name(&e, x, &a, &i);
      const int entry = dvi__pattern_find(dvi__action_coupling(e.action), i, j);
      const double given = entry >= 0 ? values[(entry * size + b) * size + a] : 0;
      ck_assert_double_eq_tol(given, column[x], 1e-8 * fmax(1, fabs(column[x])));
    }
  }
  free_element(&e);
}
END_TEST

SUITE(two_point)
{
  tcase_add_loop_test(tests, the_path_leads_from_one_end_to_the_other, 0, 2 * SPACES);
  tcase_add_loop_test(tests, the_gradient_is_that_of_the_action, 0, 2 * SPACES);
  tcase_add_loop_test(tests, the_hessian_is_that_of_the_action, 0, 2 * SPACES);
}
