#include "support/order.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad.h"
#include "support/runs.h"

enum { N = QUAD_N_MAX };

typedef struct state {
  double q[N], p[N];
} state;

/* The judge's own error must not show in what is measured. */
static void judge(const problem *of, const char *setting, double t, double least_error, state *z)
{
  const double error = quad_solve(of->name, setting != NULL, &setting, t, z->q, z->p);
  ck_assert_msg(error < 0.01 * least_error, "%s: the judge's error is %g", of->name, error);
}

static state start_of(const problem *of)
{
  state z;
  ck_assert_int_le(of->n, N);
  memcpy(z.q, of->q, (size_t)of->n * sizeof(double));
  memcpy(z.p, of->p, (size_t)of->n * sizeof(double));
  return z;
}

/* The whole table is shown if this is set: to choose spans and steps. */
static int show(void)
{
  return getenv("DVI_SHOW_ORDERS") != NULL;
}

static void check_slope(const char *problem_name, const char *method, double slope, int order)
{
  if (show()) printf("%s %s: %.3f of %d\n", problem_name, method, slope, order);
  ck_assert_msg(fabs(slope - order) <= 0.2, "%s, %s: order %.3f, not %d", problem_name, method, slope, order);
}

/* Solve the small normal equations a x = b in place by elimination; they are scaled well enough. */
static void solve(int count, double a[3][3], double *b)
{
  for (int c = 0; c < count; c++)
    for (int i = c + 1; i < count; i++) {
      const double factor = a[i][c] / a[c][c];
      for (int j = c; j < count; j++) a[i][j] -= factor * a[c][j];
      b[i] -= factor * b[c];
    }
  for (int c = count - 1; c >= 0; c--) {
    for (int j = c + 1; j < count; j++) b[c] -= a[c][j] * b[j];
    b[c] /= a[c][c];
  }
}

/* Least squares of log error = x0 + x1 log h, and with three terms + x2 h^2: x1. h is taken in units of the largest one. */
static double slope_of(int count, const double *h, const double *error, int terms)
{
  double a[3][3] = {{0}}, b[3] = {0};
  for (int i = 0; i < count; i++) {
    const double x = h[i] / h[0], f[3] = {1, log(x), x * x};
    for (int j = 0; j < terms; j++) {
      b[j] += f[j] * log(error[i]);
      for (int k = 0; k < terms; k++) a[j][k] += f[j] * f[k];
    }
  }
  solve(terms, a, b);
  return b[1];
}

/* ---- at the end of a span ---- */

static double relative(int n, const double *q, const double *p, const state *exact)
{
  return fmax(distance(n, q, exact->q) / magnitude(n, exact->q), distance(n, p, exact->p) / magnitude(n, exact->p));
}

static double global_error(const problem *of, const span *over, const char *method, long steps, const state *exact)
{
  dvi_integrator *integrator = started(of, method);
  advance(integrator, over->length / (double)steps, steps);
  const double error = relative(of->n, dvi_integrator_q(integrator), dvi_integrator_p(integrator), exact);
  dvi_integrator_destroy(&integrator);
  return error;
}

void check_global_order(const span *of, const char *method, int first, int order)
{
  enum { LEVELS = 10, FITTED = 5, LEAST = 4 };
  const double floor = 1e-12; /* a hundred times the roundoff of a thousand steps */
  double h[LEVELS], error[LEVELS];
  int count = 0;
  problem *made = made_problem(of->problem, of->setting);
  state exact = start_of(made);
  judge(made, of->setting, of->length, floor, &exact);
  for (; count < LEVELS; count++) {
    const long steps = (long)first << count;
    h[count] = of->length / (double)steps;
    error[count] = global_error(made, of, method, steps, &exact);
    if (show()) printf("%s %s h = %.4g error %.2e\n", of->problem, method, h[count], error[count]);
    if (error[count] <= floor) break;
  }
  problem_destroy(&made);
  ck_assert_msg(count >= LEAST, "%s, %s: %d errors above the floor", of->problem, method, count);
  const int fitted = count < FITTED ? count : FITTED;
  check_slope(of->problem, method, slope_of(fitted, h + count - fitted, error + count - fitted, 2), order);
}

/* ---- of one step ----
 *
 * Global errors of high orders are of little use in double precision: with the superconvergence constants of degree 8 the error is at
 * roundoff while h is still half the distance of the nearest singularity, where the slope is not yet the order. The error of one step is
 * smooth enough to be followed there. It is made even smoother:
 *   - the step is centred: it starts from the judge's point at t - h/2, and its end is carried back to t by the judge. For a symmetric
 *     method this error is C h^(order+1) (1 + c h^2 + ...), without odd terms;
 *   - it is averaged over points t along the solution, so that a zero of C does no harm;
 *   - c is fitted together with the slope. */

enum { CENTRES = 6, LEVELS_MOST = 64 };

/* A method on a problem, and what its errors are measured at. */
typedef struct local_study {
  problem *of;
  const char *setting;
  dvi_integrator *integrator;
  state centre[CENTRES];
} local_study;

/* Sum of squares over the components; infinite if the step is too long to be solved or to be judged. */
static double centred_error(const local_study *study, const state *centre, double h)
{
  const int n = study->of->n;
  const double size_q = magnitude(n, centre->q), size_p = magnitude(n, centre->p);
  state z = *centre;
  double sum = 0, error = 0;
  error = quad_solve(study->of->name, study->setting != NULL, &study->setting, -h / 2, z.q, z.p);
  if (dvi_integrator_start(study->integrator, 0, z.q, z.p) != DVI_OK || dvi_integrator_step(study->integrator, h) != DVI_OK)
    return HUGE_VAL;
  memcpy(z.q, dvi_integrator_q(study->integrator), (size_t)n * sizeof(double));
  memcpy(z.p, dvi_integrator_p(study->integrator), (size_t)n * sizeof(double));
  error += quad_solve(study->of->name, study->setting != NULL, &study->setting, -h / 2, z.q, z.p);
  for (int i = 0; i < n; i++) sum += pow((z.q[i] - centre->q[i]) / size_q, 2) + pow((z.p[i] - centre->p[i]) / size_p, 2);
  return error * error < 1e-4 * sum + 1e-36 ? sum : HUGE_VAL;
}

static double mean_error(const local_study *study, double h)
{
  double sum = 0;
  for (int k = 0; k < CENTRES && sum < HUGE_VAL; k++) sum += centred_error(study, &study->centre[k], h);
  return sqrt(sum / CENTRES);
}

/* Errors below the ceiling and above the floor, from coarse to fine; returns how many there are. */
static int follow(const local_study *study, double largest_h, double ratio, double *h, double *error)
{
  const double floor = 1e-14;  /* thirty times the roundoff of one step: 3 % there, 0.05 in the slope */
  const double ceiling = 1e-9; /* errors above belong to steps too long for one correction term */
  int count = 0;
  for (int level = 0; level < LEVELS_MOST; level++, largest_h /= ratio) {
    h[count] = largest_h;
    error[count] = mean_error(study, largest_h);
    if (show()) printf("%s %s h = %.4g error %.2e\n", study->of->name, dvi_integrator_method(study->integrator), h[count], error[count]);
    if (error[count] <= floor) break;
    if (error[count] > 1e4 * ceiling) largest_h /= ratio;
    if (error[count] <= ceiling) count++;
  }
  return count;
}

void check_local_order(const span *of, const char *method, double largest_h, int order)
{
  enum { FITTED = 7, LEAST = 6 };
  double h[LEVELS_MOST], error[LEVELS_MOST];
  local_study study = {.of = made_problem(of->problem, of->setting), .setting = of->setting};
  study.integrator = made_integrator(study.of->system, method);
  for (int k = 0; k < CENTRES; k++) {
    study.centre[k] = start_of(study.of);
    judge(study.of, of->setting, (k + 0.5) * of->length / CENTRES, 1e-10, &study.centre[k]); /* any point near the solution will do */
  }
  const int count = follow(&study, largest_h, pow(5, 1.0 / (order + 1)), h, error); /* errors fall by 5 */
  dvi_integrator_destroy(&study.integrator);
  problem_destroy(&study.of);
  ck_assert_msg(count >= LEAST, "%s, %s: %d errors above the floor", of->problem, method, count);
  const int fitted = count < FITTED ? count : FITTED;
  check_slope(of->problem, method, slope_of(fitted, h + count - fitted, error + count - fitted, 3) - 1, order);
}
