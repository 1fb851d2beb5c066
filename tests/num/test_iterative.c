/* Systems that are solved by products, without a matrix. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/linear.h"
#include "support/suite.h"

enum { SIDE = 20, GRID = SIDE * SIDE };

/* Minus the Laplacian on a grid, with a term that varies, preconditioned by its diagonal if
 * `is_scaled`. */
typedef struct membrane {
  double stiffness;
  int is_scaled;
  long products, renewals;
} membrane;

static double diagonal_of(const membrane *grid, int k)
{
  return 4 * grid->stiffness + 1 + k % 7 * 1000;
}

static void membrane_times(void *user, const double *x, double *y)
{
  membrane *grid = user;
  grid->products++;
  for (int k = 0; k < GRID; k++) {
    y[k] = diagonal_of(grid, k) * x[k];
    if (k % SIDE > 0) y[k] -= grid->stiffness * x[k - 1];
    if (k % SIDE < SIDE - 1) y[k] -= grid->stiffness * x[k + 1];
    if (k >= SIDE) y[k] -= grid->stiffness * x[k - SIDE];
    if (k < GRID - SIDE) y[k] -= grid->stiffness * x[k + SIDE];
  }
}

static void membrane_scale(void *user, double *r)
{
  for (int k = 0; k < GRID; k++) r[k] /= diagonal_of(user, k);
}

static dvi_status membrane_renew(void *user)
{
  membrane *grid = user;
  grid->renewals++;
  return grid->stiffness > 0 ? DVI_OK : dvi__fail(DVI_SINGULAR, "the membrane is slack");
}

static dvi__linear *membrane_solver(membrane *grid, dvi_counters *counters)
{
  const dvi__operator A = {.size = GRID,
                           .of = grid,
                           .times = membrane_times,
                           .renew = membrane_renew,
                           .precondition = grid->is_scaled ? membrane_scale : NULL};
  dvi__linear *linear;
  ck_assert_int_eq(dvi__linear_create_iterative(&A, counters, &linear), DVI_OK);
  ck_assert_int_eq(dvi__linear_kind_of(linear), DVI__LINEAR_ITERATIVE);
  return linear;
}

/* Solves again for the remaining residual, as Newton's method does. Each solve leaves 1e-5 of it,
 * or a little more by the other norm. */
START_TEST(an_operator_is_solved_by_its_products)
{
  membrane grid = {.stiffness = 100, .is_scaled = _i};
  double x[GRID] = {0}, Ax[GRID], r[GRID], left = 1, before;
  dvi_counters counters = {0};
  dvi__linear *linear = membrane_solver(&grid, &counters);
  ck_assert_int_eq(grid.renewals + counters.preparations, 0);
  ck_assert_int_eq(dvi__linear_factor(linear, NULL), DVI_OK);
  ck_assert_int_eq(grid.renewals, 1);
  ck_assert_int_eq(counters.preparations, 1);
  for (int round = 0; round < 4; round++) {
    before = left, left = 0;
    membrane_times(&grid, x, Ax);
    for (int k = 0; k < GRID; k++) r[k] = cos(k) - Ax[k], left = fmax(left, fabs(r[k]));
    ck_assert_msg(round == 0 || left <= fmax(1e-3 * before, 1e-13), "%g after %g", left, before);
    dvi__linear_solve(linear, r);
    for (int k = 0; k < GRID; k++) x[k] += r[k];
  }
  ck_assert_int_lt(grid.products, _i ? 100 : 400);
  ck_assert_int_eq(counters.solves, 4);
  ck_assert_int_eq(counters.factorizations + counters.symbolic, 0);
  dvi__linear_destroy(&linear);
}
END_TEST

START_TEST(an_operator_says_what_is_not_known)
{
  membrane grid = {.stiffness = 1, .is_scaled = 1};
  double r[GRID] = {0};
  dvi__linear *linear = membrane_solver(&grid, NULL);
  const long before = dvi__allocation_count();
  for (int k = 0; k < 2; k++) ck_assert_int_eq(dvi__linear_factor(linear, NULL), DVI_OK);
  const long made = dvi__allocation_count();
  ck_assert_int_gt(made, before);
  dvi__linear_solve(linear, r);
  for (int k = 0; k < GRID; k++) ck_assert_double_eq(r[k], 0);
  ck_assert_int_eq(dvi__linear_sign(linear), 0);
  ck_assert_int_eq(dvi__linear_tells_definite(linear), 0);
  r[3] = (double)NAN;
  dvi__linear_solve(linear, r);
  ck_assert(isnan(r[3])); /* not taken for a solution */
  grid.stiffness = 0;
  ck_assert_int_eq(dvi__linear_factor(linear, NULL), DVI_SINGULAR);
  check_words("slack");
  ck_assert_int_eq(dvi__allocation_count(), made);
  dvi__linear_destroy(&linear);
}
END_TEST

/* 1, 2, 3, .. GRID times the unknowns. */
static void ramp_times(void *user, const double *x, double *y)
{
  ++*(long *)user;
  for (int k = 0; k < GRID; k++) y[k] = (k + 1) * x[k];
}

/* Eigenvalues that are spread evenly need more directions than are kept. */
START_TEST(a_solve_goes_on_from_the_best_solution)
{
  long products = 0;
  const dvi__operator A = {.size = GRID, .of = &products, .times = ramp_times};
  double x[GRID];
  dvi__linear *linear;
  ck_assert_int_eq(dvi__linear_create_iterative(&A, NULL, &linear), DVI_OK);
  ck_assert_int_eq(dvi__linear_factor(linear, NULL), DVI_OK);
  for (int k = 0; k < GRID; k++) x[k] = 1;
  dvi__linear_solve(linear, x);
  double square = 0;
  for (int k = 0; k < GRID; k++) square += ((k + 1) * x[k] - 1) * ((k + 1) * x[k] - 1);
  ck_assert_double_le(sqrt(square), 2e-5 * sqrt(GRID));
  ck_assert_int_gt(products, 41);
  dvi__linear_destroy(&linear);
}
END_TEST

/* Unknowns times 1, and the first ones times `first`. */
static void two_values_times(void *user, const double *x, double *y)
{
  const double *first = user;
  for (int k = 0; k < GRID; k++) y[k] = (k < 3 ? *first : 1) * x[k];
}

static int positive_sign(void *user)
{
  (void)user;
  return 1;
}

static int positive_definite(void *user, int sign)
{
  (void)user;
  return sign == 1;
}

/* The preconditioner is definite. What is known of the matrix comes from the solution. */
START_TEST(solutions_tell_negative_eigenvalues)
{
  static const struct {
    double first;
    dvi_status status;
    int sign, definite;
  } cases[] = {{2, DVI_OK, 1, 1}, {-2, DVI_OK, -1, 0}, {0, DVI_NOT_CONVERGED, 0, 0}};
  double first = cases[_i].first, x[GRID];
  const dvi__operator A = {.size = GRID,
                           .of = &first,
                           .times = two_values_times,
                           .sign = positive_sign,
                           .is_definite = positive_definite};
  dvi__linear *linear;
  ck_assert_int_eq(dvi__linear_create_iterative(&A, NULL, &linear), DVI_OK);
  ck_assert_int_eq(dvi__linear_factor(linear, NULL), DVI_OK);
  for (int k = 0; k < GRID; k++) x[k] = 1;
  ck_assert_int_eq(dvi__linear_solve(linear, x), cases[_i].status);
  if (cases[_i].status == DVI_OK) {
    ck_assert_int_eq(dvi__linear_sign(linear), cases[_i].sign);
    ck_assert_int_eq(dvi__linear_is_definite(linear, 1), cases[_i].definite);
  }
  dvi__linear_destroy(&linear);
}
END_TEST

SUITE(iterative)
{
  tcase_add_loop_test(tests, an_operator_is_solved_by_its_products, 0, 2);
  tcase_add_loop_test(tests, solutions_tell_negative_eigenvalues, 0, 3);
  tcase_add_test(tests, a_solve_goes_on_from_the_best_solution);
  tcase_add_test(tests, an_operator_says_what_is_not_known);
}
