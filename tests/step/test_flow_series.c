/* The Taylor coefficients of the motion and of its derivative in the start. */
#include <math.h>
#include <string.h>

#include "step/onestep/flow_series.h"
#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

enum { DEGREE = 16, MOST = 20 };

static dvi__flow_series *create_series(const problem *model, int degree)
{
  dvi__flow_series *series = NULL;
  ck_assert_msg(dvi__flow_series_create(model->system, degree, DVI__HESSIANS, NULL, &series) ==
                    DVI_OK,
                "%s", dvi_last_error());
  return series;
}

/* With a constant mass each evaluation gives two coefficients. */
START_TEST(forces_are_evaluated_for_two_coefficients_at_a_time)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_counters counters = {0};
  dvi__flow_series *series;
  for (int degree = 1; degree <= 6; degree++) {
    static const long expected[] = {0, 0, 1, 2, 2 + 3, 2 + 4, 2 + 4 + 5};
    counters.gradients = 0;
    ck_assert_int_eq(
        dvi__flow_series_create(model->system, degree, DVI__GRADIENTS, &counters, &series), DVI_OK);
    ck_assert_int_eq(dvi__flow_series_expand(series, 0, model->q, model->v), DVI_OK);
    ck_assert_int_eq(counters.gradients, expected[degree]);
    dvi__flow_series_destroy(&series);
  }
  problem_destroy(&model);
}
END_TEST

static double sum_of(int degree, size_t stride, const double *series, double s)
{
  double sum = 0;
  for (int k = degree; k >= 0; k--) sum = series[(size_t)k * stride] + s * sum;
  return sum;
}

START_TEST(an_oscillator_has_the_series_of_the_cosine)
{
  problem *model = create_problem("oscillator", "k=4");
  dvi__flow_series *series = create_series(model, DEGREE);
  const double q0 = 0.3, v0 = 0.5;
  ck_assert_int_eq(dvi__flow_series_expand(series, 0, &q0, &v0), DVI_OK);
  ck_assert_int_eq(dvi__flow_series_vary(series), DVI_OK);
  const double *q = dvi__flow_series_q(series), *dq = dvi__flow_series_dq(series);
  double factor = 1;
  for (int k = 0; k <= DEGREE; k++) {
    if (k > 0) factor *= 2.0 / k; /* 2^k/k! */
    const double cosine = k % 2 ? 0 : (k % 4 ? -factor : factor),
                 sine = k % 2 ? (k % 4 == 3 ? -factor : factor) : 0;
    ck_assert_double_eq_tol(q[k], q0 * cosine + 0.5 * v0 * sine, 1e-15);
    ck_assert_double_eq_tol(dq[2 * k], cosine, 1e-15);
    ck_assert_double_eq_tol(dq[2 * k + 1], 0.5 * sine, 1e-15);
  }
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

static const char *const places[] = {"pendulum",        "kepler", "henon-heiles", "driven-pendulum",
                                     "double-pendulum", "toda",   "oscillators"};
enum { PLACES = sizeof places / sizeof *places };

/* A start in general position. */
static void start_near(const problem *model, double *q, double *v)
{
  for (int i = 0; i < model->nq; i++) {
    q[i] = model->q[i] + 0.1 * cos(i + 1);
    v[i] = model->v[i] + 0.2 * sin(2 * i + 1);
  }
}

/* The step is short enough for 16 terms. The radius of convergence at kepler's start, the smallest
 * here, is some tenths. */
START_TEST(the_sum_is_where_an_integrator_arrives)
{
  problem *model = create_problem(places[_i], NULL);
  dvi__flow_series *series = create_series(model, DEGREE);
  const double h = 0.02;
  double q[MOST], v[MOST];
  start_near(model, q, v);
  dvi_integrator *judge = create_integrator(model->system, "galerkin:degree=8");
  double p[MOST];
  ck_assert_int_eq(dvi_system_momentum(model->system, 0.3, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(judge, 0.3, q, p), DVI_OK);
  advance(judge, h, 1);
  ck_assert_int_eq(dvi__flow_series_expand(series, 0.3, q, v), DVI_OK);
  for (int i = 0; i < model->nq; i++)
    ck_assert_double_eq_tol(sum_of(DEGREE, (size_t)model->nq, dvi__flow_series_q(series) + i, h),
                            dvi_integrator_q(judge)[i], 4e-15);
  dvi_integrator_destroy(&judge);
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

/* Gives a differenced column: q_k, v_k and L_k one after the other. */
enum { LOW = 5, COLUMN = (LOW + 1) * MOST + LOW };

static void column_at(dvi__flow_series *series, int n, const double *q, const double *v,
                      double *column)
{
  ck_assert_int_eq(dvi__flow_series_expand(series, 0.3, q, v), DVI_OK);
  memcpy(column, dvi__flow_series_q(series), (size_t)((LOW + 1) * n) * sizeof *column);
  ck_assert_int_eq(dvi__flow_series_lagrangian(series, column + (LOW + 1) * n, NULL, NULL), DVI_OK);
}

/* Takes central differences of 6th order over 1e-2 of numbers of size 1. Near kepler's centre
 * coefficients grow by 3 with each order, and their derivatives with them. */
static void difference(dvi__flow_series *series, int n, double *q, double *v, double *moved,
                       double *column)
{
  static const double weight[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double step = 2e-3, middle = *moved;
  double there[COLUMN];
  memset(column, 0, COLUMN * sizeof *column);
  for (int side = -3; side <= 3; side++) {
    if (side == 0) continue;
    *moved = middle + side * step;
    column_at(series, n, q, v, there);
    const double w = (side > 0 ? weight[side - 1] : -weight[-side - 1]) / step;
    for (int i = 0; i < (LOW + 1) * n + LOW; i++) column[i] += w * there[i];
  }
  *moved = middle;
}

static void check_near(double found, double expected)
{
  ck_assert_double_eq_tol(found, expected, 1e-8 * (1 + fabs(expected)));
}

START_TEST(derivatives_agree_with_differences)
{
  problem *model = create_problem(places[_i], strcmp(places[_i], "toda") == 0 ? "N=4" : NULL);
  const int n = model->nq;
  dvi__flow_series *series = create_series(model, LOW);
  double q[MOST], v[MOST], L[LOW], L_start[2][LOW * MOST], dq[(LOW + 1) * 2 * 16], column[COLUMN];
  start_near(model, q, v);
  ck_assert_int_eq(dvi__flow_series_expand(series, 0.3, q, v), DVI_OK);
  ck_assert_int_eq(dvi__flow_series_vary(series), DVI_OK);
  ck_assert_int_eq(dvi__flow_series_lagrangian(series, L, L_start[0], L_start[1]), DVI_OK);
  memcpy(dq, dvi__flow_series_dq(series), (size_t)((LOW + 1) * 2 * n * n) * sizeof *dq);
  for (int j = 0; j < 2 * n; j++) {
    difference(series, n, q, v, j < n ? q + j : v + j - n, column);
    for (int k = 0; k <= LOW; k++)
      for (int i = 0; i < n; i++) check_near(column[k * n + i], dq[(k * 2 * n + j) * n + i]);
    for (int k = 0; k < LOW; k++)
      check_near(column[(LOW + 1) * n + k], L_start[j >= n][k * n + j % n]);
  }
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

/* A motion's derivative is symplectic. For a unit mass dq_i.dv_j - dq_j.dv_i is the same at all s,
 * so each coefficient but the first is 0. */
START_TEST(the_derivative_is_symplectic_order_by_order)
{
  problem *model = create_problem("kepler", NULL);
  enum { D = 12 };
  dvi__flow_series *series = create_series(model, D);
  ck_assert_int_eq(dvi__flow_series_expand(series, 0, model->q, model->v), DVI_OK);
  ck_assert_int_eq(dvi__flow_series_vary(series), DVI_OK);
  const double *dq = dvi__flow_series_dq(series), *dv = dvi__flow_series_dv(series);
  for (int k = 1; k < D; k++)
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < 4; b++) {
        double sum = 0, size = 1;
        for (int j = 0; j <= k; j++)
          for (int i = 0; i < 2; i++) {
            const double here = dq[j * 8 + 2 * a + i] * dv[(k - j) * 8 + 2 * b + i];
            const double there = dq[j * 8 + 2 * b + i] * dv[(k - j) * 8 + 2 * a + i];
            sum += here - there;
            size += fabs(here) + fabs(there);
          }
        ck_assert_double_eq_tol(sum, 0, 1e-14 * size);
      }
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

/* But by the first factor. */
START_TEST(nothing_is_allocated_after_the_first_use)
{
  problem *model = create_problem("double-pendulum", NULL);
  dvi__flow_series *series = create_series(model, 8);
  double L[8], L_q0[16], L_v0[16];
  long before = 0;
  for (int i = 0; i < 3; i++) {
    if (i == 1) before = dvi__allocation_count();
    ck_assert_int_eq(dvi__flow_series_expand(series, 0, model->q, model->v), DVI_OK);
    ck_assert_int_eq(dvi__flow_series_vary(series), DVI_OK);
    ck_assert_int_eq(dvi__flow_series_lagrangian(series, L, L_q0, L_v0), DVI_OK);
  }
  ck_assert_int_eq(dvi__allocation_count(), before);
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

START_TEST(failures_are_said)
{
  problem *model = create_problem("kepler", NULL);
  dvi__flow_series *series = create_series(model, 4);
  const double centre[2] = {0, 0};
  ck_assert_int_eq(dvi__flow_series_expand(series, 0, centre, model->v), DVI_NOT_FINITE);
  check_words("gravity: the taylor callback gave");
  dvi__flow_series_destroy(&series);
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi__flow_series_create(model->system, 4, DVI__HESSIANS, NULL, &series);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || (status == DVI_NO_MEMORY && series == NULL));
  }
  dvi__flow_series_destroy(&series);
  problem_destroy(&model);
}
END_TEST

SUITE(flow_series)
{
  tcase_add_test(tests, forces_are_evaluated_for_two_coefficients_at_a_time);
  tcase_add_test(tests, an_oscillator_has_the_series_of_the_cosine);
  tcase_add_loop_test(tests, the_sum_is_where_an_integrator_arrives, 0, PLACES);
  tcase_add_loop_test(tests, derivatives_agree_with_differences, 0, PLACES);
  tcase_add_test(tests, the_derivative_is_symplectic_order_by_order);
  tcase_add_test(tests, nothing_is_allocated_after_the_first_use);
  tcase_add_test(tests, failures_are_said);
}
