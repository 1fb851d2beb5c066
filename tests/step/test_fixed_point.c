/* labels: unit */
/* Iterations on the positions at the nodes solve the rows of the discrete action, and their
 * coefficients make symplectic steps to the last bit. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "support/suite.h"
#include "support/systems/systems.h"

static behaviour quiet;

enum { SPACES_MOST = 20 };

static dvi_system *made_system(void)
{
  static const double masses[SITES] = {1, 2, 0.5, 3, 1.5, 0.7};
  const dvi_potential p = springs(&quiet, BATCH);
  return make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.diagonal = masses, .potentials = &p, .potential_count = 1});
}

static dvi__action *made_action(const dvi_system *system, dvi_basis basis, int degree,
                                dvi_rule rule, int nodes)
{
  static dvi_counters counters;
  dvi__action *action = NULL;
  const dvi__action_space space = {basis, degree, rule, nodes};
  ck_assert_msg(dvi__action_create(system, &space, &counters, &action) == DVI_OK, "%s",
                dvi_last_error());
  return action;
}

/* For b_i (1 - c_i - (c_j - P_ji)) b_j to be symmetric, whatever is rounded later, P must be:
 * matrix_ij = c_i - P_ij, all on one grid. */
START_TEST(the_coefficients_are_symplectic_to_the_last_bit)
{
  static const dvi_rule rules[] = {DVI_GAUSS, DVI_LOBATTO, DVI_RADAU_RIGHT, DVI_CLENSHAW_CURTIS};
  const int degree = 1 + _i % DVI_DEGREE_MAX, rule = _i / DVI_DEGREE_MAX,
            nodes = degree + 1 + rule % 2;
  dvi_system *system = made_system();
  dvi__action *a = made_action(system, DVI_LAGRANGE_LOBATTO, degree, rules[rule], nodes);
  for (int i = 0; i < nodes; i++) {
    ck_assert_double_eq(a->fixed_point.slant[i], 0.5 - a->fixed_point.node[i]);
    for (int j = 0; j < i; j++)
      ck_assert_double_eq(a->fixed_point.node[i] - a->fixed_point.matrix[j * a->lanes + i],
                          a->fixed_point.node[j] - a->fixed_point.matrix[i * a->lanes + j]);
  }
  dvi__action_destroy(&a);
  dvi_system_destroy(&system);
}
END_TEST

/* Those of a time-transformed element are a_ij and 1 - a_ji: the difference must be exact. Its path
 * passes through the places that the same numbers make, to the roundings of tables of doubles. */
START_TEST(the_coefficients_of_transformed_steps_are_symplectic_to_the_last_bit)
{
  enum { MOST = SPACES_MOST + 1, LANES_MOST = MOST + 8 };
  static const dvi_rule rules[] = {DVI_GAUSS, DVI_LOBATTO, DVI_RADAU_LEFT, DVI_CLENSHAW_CURTIS};
  const int degree = 2 + _i % SPACES_MOST, rule = _i / SPACES_MOST;
  static double place[MOST * LANES_MOST], momentum[MOST * LANES_MOST], path[MOST * LANES_MOST];
  dvi_system *system = made_system();
  dvi__action *a = made_action(system, DVI_LEGENDRE, degree, rules[rule], degree);
  ck_assert_int_eq(dvi__action_fill_transformed(a, place, momentum, path), DVI_OK);
  for (int i = 0; i < degree; i++)
    for (int j = 0; j < degree; j++) {
      double through = 0;
      for (int k = 0; k < degree; k++)
        through += a->psi[k * a->lanes + i] * path[j * a->path_lanes + k];
      ck_assert(1 - (long double)place[j * a->lanes + i] ==
                (long double)momentum[i * a->lanes + j]);
      ck_assert_double_eq_tol(through, place[j * a->lanes + i], 1e-12);
    }
  dvi__action_destroy(&a);
  dvi_system_destroy(&system);
}
END_TEST

/* The fixed point solves R(Y) = 0 in every basis: to the roundoff of the rows: p0 and psi of size 1
 * to 3, summed over up to 25 nodes, more where the basis itself is ill-conditioned. Where long
 * double is no longer than double, as under valgrind, the tables of the two differ by some
 * roundings too: 8e-14. */
START_TEST(the_fixed_point_solves_the_rows)
{
  static const struct {
    dvi_basis basis;
    int degree;
    dvi_rule rule;
    int nodes;
  } spaces[] = {
      {DVI_LAGRANGE_LOBATTO, 1, DVI_MIDPOINT, 1}, {DVI_LAGRANGE_LOBATTO, 1, DVI_TRAPEZOID, 2},
      {DVI_LAGRANGE_GAUSS, 2, DVI_GAUSS, 2},      {DVI_LEGENDRE, 3, DVI_GAUSS, 3},
      {DVI_LAGRANGE_LOBATTO, 4, DVI_LOBATTO, 4},  {DVI_CHEBYSHEV, 5, DVI_GAUSS, 8},
      {DVI_LAGRANGE_CHEBYSHEV, 8, DVI_GAUSS, 8},  {DVI_LEGENDRE, 12, DVI_CLENSHAW_CURTIS, 25}};
  enum { UNKNOWNS_MOST = SITES * 12 };
  const double h = 0.05;
  double Y[UNKNOWNS_MOST] = {0}, R[UNKNOWNS_MOST], change = 0, largest, dq[SITES], low[SITES],
         dp[SITES], by_rows_q[SITES], by_rows_p[SITES];
  dvi_system *system = made_system();
  dvi__action *a = made_action(system, spaces[_i].basis, spaces[_i].degree, spaces[_i].rule,
                               spaces[_i].nodes);
  dvi__action_place(a, 0.3, h, generic_q, generic_v);
  dvi__action_fixed_point_begin(a, Y);
  for (int k = 0; k < 30; k++) ck_assert_int_eq(dvi__action_iterate(a, &change, &largest), DVI_OK);
  ck_assert_double_le(change, 4 * DBL_EPSILON * largest);
  dvi__action_fixed_point_path(a, Y);
  dvi__action_ends(a, Y, dq, low, dp);
  ck_assert_int_eq(dvi__action_residual(a, Y, R), DVI_OK);
  for (int k = 0; k < SITES * spaces[_i].degree; k++) ck_assert_double_eq_tol(R[k], 0, 2e-13);
  for (int i = 0; i < SITES; i++) dq[i] += low[i];
  dvi__action_ends(a, Y, by_rows_q, low, by_rows_p);
  for (int i = 0; i < SITES; i++) {
    ck_assert_double_eq_tol(dq[i], by_rows_q[i], 1e-15);
    ck_assert_double_eq_tol(dp[i], by_rows_p[i], 1e-15);
  }
  dvi__action_destroy(&a);
  dvi_system_destroy(&system);
}
END_TEST

/* Tables and memory are for those who can use them. */
START_TEST(a_mass_that_couples_is_left_to_the_rows)
{
  const dvi_lagrangian l = rotors(&quiet, BATCH);
  dvi_system *system = make_system(&(dvi_system_terms){.dimension = SITES, .lagrangian = &l});
  dvi__action *a = made_action(system, DVI_LEGENDRE, 2, DVI_GAUSS, 2);
  ck_assert_int_eq(dvi__action_has_fixed_point(a), 0);
  ck_assert_ptr_null(a->fixed_point.matrix);
  dvi__action_destroy(&a);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(fixed_point)
{
  tcase_add_loop_test(tests, the_coefficients_are_symplectic_to_the_last_bit, 0,
                      4 * DVI_DEGREE_MAX);
  tcase_add_loop_test(tests, the_coefficients_of_transformed_steps_are_symplectic_to_the_last_bit,
                      0, 4 * SPACES_MOST);
  tcase_add_loop_test(tests, the_fixed_point_solves_the_rows, 0, 8);
  tcase_add_test(tests, a_mass_that_couples_is_left_to_the_rows);
}
