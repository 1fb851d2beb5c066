/* labels: jacobian */
/* The Jacobian of a step by a discrete Hamiltonian, and the functions that generate the step. */
#include "step/hamiltonian/canonical.h"

#include <math.h>
#include <string.h>

#include "num/linear.h"
#include "space/trial.h"

#include "support/runs.h"
#include "support/suite.h"

enum {
  N = 3,
  MOST = N * (DVI__CANONICAL_DEGREE + DVI__CANONICAL_POINTS),
  ENTRIES_MOST = MOST * MOST
};

static const double q0[N] = {0.2, -0.4, 0.7}, p0[N] = {-0.8, 0.3, 1.1}, unit[N] = {0.5, 2, 1.5},
                    h = 0.3;

static const dvi__action_space spaces[] = {{DVI_LAGRANGE_LOBATTO, 1, DVI_GAUSS, 1},
                                           {DVI_LAGRANGE_LOBATTO, 2, DVI_GAUSS, 2},
                                           {DVI_LAGRANGE_LOBATTO, 3, DVI_RADAU_LEFT, 3},
                                           {DVI_LAGRANGE_LOBATTO, 4, DVI_RADAU_RIGHT, 4},
                                           {DVI_LEGENDRE, 3, DVI_LOBATTO, 4},
                                           {DVI_CHEBYSHEV, 8, DVI_LOBATTO, 9}};
/* the first ones serve a degenerate H */
enum { SPACES = sizeof spaces / sizeof *spaces, SERVE = 4 };

static dvi__canonical *create_step(const problem *model, const dvi__action_space *space)
{
  dvi__canonical *step;
  ck_assert_int_eq(dvi__canonical_create(model->system, space, NULL, &step), DVI_OK);
  dvi__canonical_place(step, 0, h, q0, p0, unit);
  return step;
}

/* Takes central differences of the rows over 1e-4, with an error of 1e-8, and roundings of
 * 1e-12. */
START_TEST(the_jacobian_is_the_derivative_of_the_rows)
{
  problem *model = create_problem("elastica", NULL);
  dvi__canonical *step = create_step(model, &spaces[_i]);
  const dvi__pattern *pattern = dvi__canonical_pattern(step);
  double x[MOST], plus[MOST], minus[MOST], values[ENTRIES_MOST];
  ck_assert_int_le(dvi__pattern_entries(pattern), ENTRIES_MOST);
  for (int k = 0; k < pattern->columns; k++) x[k] = 0.1 * sin(1 + 3 * k);
  ck_assert_int_eq(dvi__canonical_jacobian(step, x, values), DVI_OK);
  for (int j = 0; j < pattern->columns; j++) {
    const double at = x[j], moved = 1e-4;
    x[j] = at + moved;
    ck_assert_int_eq(dvi__canonical_residual(step, x, plus), DVI_OK);
    x[j] = at - moved;
    ck_assert_int_eq(dvi__canonical_residual(step, x, minus), DVI_OK);
    x[j] = at;
    for (int i = 0; i < pattern->rows; i++) {
      const int entry = dvi__pattern_find(pattern, i, j);
      ck_assert_double_eq_tol(entry >= 0 ? values[entry] : 0, (plus[i] - minus[i]) / (2 * moved),
                              2e-8);
    }
  }
  dvi__canonical_destroy(&step);
  problem_destroy(&model);
}
END_TEST

/* ---- what generates it ---- */

/* The ends of a step, and S = sum_j b_j (P_j.q'(c_j) - h H_j). */
typedef struct taken {
  double q0[N], p0[N], q1[N], p1[N], S;
} taken;

static void solve(dvi__canonical *step, double *x)
{
  const dvi__pattern *pattern = dvi__canonical_pattern(step);
  double R[MOST], values[ENTRIES_MOST];
  dvi__linear *linear;
  ck_assert_int_eq(
      dvi__linear_create(pattern, dvi__linear_for_exchanges(pattern->columns), NULL, &linear),
      DVI_OK);
  for (int k = 0; k < 12; k++) {
    ck_assert_int_eq(dvi__canonical_residual(step, x, R), DVI_OK);
    ck_assert_int_eq(dvi__canonical_jacobian(step, x, values), DVI_OK);
    ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_OK);
    dvi__linear_solve(linear, R);
    for (int i = 0; i < pattern->columns; i++) x[i] -= R[i];
  }
  ck_assert_int_eq(dvi__canonical_residual(step, x, R), DVI_OK);
  dvi__linear_destroy(&linear);
}

static double action_of(const problem *model, const dvi__action_space *space, const taken *step,
                        const double *x)
{
  double c[DVI__CANONICAL_POINTS], b[DVI__CANONICAL_POINTS], S = 0;
  ck_assert_int_eq(dvi_quadrature(space->rule, space->nodes, c, b), DVI_OK);
  for (int j = 0; j < space->nodes; j++) {
    double psi[DVI__CANONICAL_DEGREE], slope[DVI__CANONICAL_DEGREE], Q[N], P[N], H;
    dvi__trial_at(space->basis, space->degree, c[j], psi, NULL, slope);
    for (int i = 0; i < N; i++) {
      const double *Y = x + i * (space->degree + space->nodes);
      Q[i] = step->q0[i];
      P[i] = step->p0[i] + unit[i] * Y[space->degree + j];
      for (int k = 0; k < space->degree; k++) Q[i] += psi[k] * Y[k];
      for (int k = 0; k < space->degree; k++) S += b[j] * P[i] * slope[k] * Y[k];
    }
    ck_assert_int_eq(model->terms->hamiltonian->value(0, Q, P, &H, NULL), 0);
    S -= h * b[j] * H;
  }
  return S;
}

/* From the start moved by e in component `along` of (q0,p0). */
static taken take_step(const problem *model, const dvi__action_space *space, int along, double e)
{
  taken step;
  double x[MOST] = {0}, dq[N], dp[N];
  memcpy(step.q0, q0, sizeof q0);
  memcpy(step.p0, p0, sizeof p0);
  *(along < N ? &step.q0[along] : &step.p0[along - N]) += e;
  dvi__canonical *made = create_step(model, space);
  dvi__canonical_place(made, 0, h, step.q0, step.p0, unit);
  solve(made, x);
  dvi__canonical_ends(made, x, dq, dp);
  for (int i = 0; i < N; i++) {
    step.q1[i] = step.q0[i] + dq[i];
    step.p1[i] = step.p0[i] + dp[i];
  }
  step.S = action_of(model, space, &step, x);
  dvi__canonical_destroy(&made);
  return step;
}

static double product(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* a.db over 2 e. */
static double rise(const double *a, const double *plus, const double *minus, double e)
{
  const double difference[N] = {(plus[0] - minus[0]) / (2 * e), (plus[1] - minus[1]) / (2 * e),
                                (plus[2] - minus[2]) / (2 * e)};
  return product(a, difference);
}

/* dH+ = q1.dp1 + p0.dq0 and dH- = -q0.dp0 - p1.dq1 along every direction of the start are the
 * discrete Hamilton's equations. They are tested by central differences. */
START_TEST(the_right_and_the_left_discrete_hamiltonian_generate_the_step)
{
  problem *model = create_problem("elastica", NULL);
  const double e = 1e-4;
  for (int along = 0; along < 2 * N; along++) {
    const taken at = take_step(model, &spaces[_i], along, 0),
                plus = take_step(model, &spaces[_i], along, e),
                minus = take_step(model, &spaces[_i], along, -e);
    const double right =
        (product(plus.p1, plus.q1) - plus.S - product(minus.p1, minus.q1) + minus.S) / (2 * e);
    const double left =
        (-product(plus.p0, plus.q0) - plus.S + product(minus.p0, minus.q0) + minus.S) / (2 * e);
    ck_assert_double_eq_tol(
        right, rise(at.q1, plus.p1, minus.p1, e) + rise(at.p0, plus.q0, minus.q0, e), 2e-8);
    ck_assert_double_eq_tol(
        left, -rise(at.q0, plus.p0, minus.p0, e) - rise(at.p1, plus.q1, minus.q1, e), 2e-8);
  }
  problem_destroy(&model);
}
END_TEST

SUITE(canonical)
{
  tcase_add_loop_test(tests, the_right_and_the_left_discrete_hamiltonian_generate_the_step, 0,
                      SERVE);
  tcase_add_loop_test(tests, the_jacobian_is_the_derivative_of_the_rows, 0, SPACES);
}
