#include "support/order.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad/quad.h"
#include "support/runs.h"
#include "support/suite.h"

enum { N = QUAD_N_MAX, MOST_GLOBAL_ORDER = 6 };

/* A problem of the catalogue with at most one setting, and a span. */
typedef struct span {
  const char *problem, *setting;
  double length;
} span;

/* A problem whose orders show: its span, the steps of the coarsest run of a global study, and the
 * longest step of a local study. That step is a little more than the distance of the nearest
 * singularity in complex time. */
typedef struct order_place {
  span over;
  int first;
  double h;
} order_place;

static const order_place places[] = {
    {{"kepler", "e=0.3", 6.0}, 40, 0.8},     {{"pendulum", NULL, 8.0}, 10, 1.6},
    {{"henon-heiles", NULL, 12.0}, 20, 2.4}, {{"double-pendulum", NULL, 1.0}, 10, 0.2},
    {{"toda", "N=5", 5.0}, 10, 1.8},
};

typedef struct state {
  double q[N], p[N];
} state;

/* Gives the judge's state at time t, and requires that its own error does not show in the measured
 * errors. */
static void advance_by_judge(const problem *model, const char *setting, double t,
                             double least_error, state *z)
{
  const double error = quad_solve(model->name, setting != NULL, &setting, t, z->q, z->p);
  ck_assert_msg(error < 0.01 * least_error, "%s: the judge's error is %g", model->name, error);
}

static state copy_start(const problem *model)
{
  state z;
  ck_assert_int_le(model->nq, N);
  memcpy(z.q, model->q, (size_t)model->nq * sizeof(double));
  memcpy(z.p, model->p, (size_t)model->nq * sizeof(double));
  return z;
}

/* Returns 1 if errors are printed, which helps to choose spans and steps. */
static int errors_are_printed(void)
{
  return getenv("DVI_SHOW_ORDERS") != NULL;
}

static void check_slope(const char *problem_name, const char *method, double slope, int order)
{
  if (errors_are_printed()) printf("%s %s: %.3f of %d\n", problem_name, method, slope, order);
  ck_assert_msg(fabs(slope - order) <= 0.2, "%s, %s: order %.3f, not %d", problem_name, method,
                slope, order);
}

/* Solves the small normal equations a x = b in place by elimination. Their scales need no
 * pivots. */
enum { TERMS_MOST = 4 };

static void solve_normal_equations(int count, double a[TERMS_MOST][TERMS_MOST], double *b)
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

/* Fits log error = x0 + x1 log h + x2 h^2 + x3 h^4, cut after `terms`, by least squares, and
 * returns x1. h is in units of the largest one. The weights assume that an error is known to a
 * hundredth, and to the roundoff of one step. */
static double fit_slope(int count, const double *h, const double *error, int terms)
{
  /* two solvers give errors at the floor that differ by up to 8e-16 */
  const double roundoff = 1e-15;
  double a[TERMS_MOST][TERMS_MOST] = {{0}}, b[TERMS_MOST] = {0};
  for (int i = 0; i < count; i++) {
    const double x = h[i] / h[0], f[TERMS_MOST] = {1, log(x), x * x, x * x * x * x},
                 weight = pow(0.01 + roundoff / error[i], -2);
    for (int j = 0; j < terms; j++) {
      b[j] += weight * f[j] * log(error[i]);
      for (int k = 0; k < terms; k++) a[j][k] += weight * f[j] * f[k];
    }
  }
  solve_normal_equations(terms, a, b);
  return b[1];
}

/* ---- at the end of a span ---- */

static double relative_error(int n, const double *q, const double *p, const state *exact)
{
  return fmax(distance(n, q, exact->q) / magnitude(n, exact->q),
              distance(n, p, exact->p) / magnitude(n, exact->p));
}

static double global_error(const problem *model, const span *over, const char *method, long steps,
                           const state *exact)
{
  dvi_integrator *integrator = start_integrator(model, method);
  advance(integrator, over->length / (double)steps, steps);
  const double error = relative_error(model->nq, dvi_integrator_q(integrator),
                                      dvi_integrator_p(integrator), exact);
  dvi_integrator_destroy(&integrator);
  return error;
}

/* Requires the order as the slope over the finest four steps whose errors are above the floor. Each
 * step is `ratio` times shorter than the one before. */
static void check_global_order(const order_place *at, const char *method, int order, problem *model,
                               const state *exact, double ratio, double floor)
{
  enum { LEVELS = 10, FITTED = 4 };
  double h[LEVELS], error[LEVELS];
  int count = 0;
  for (; count < LEVELS; count++) {
    const long steps = lround(at->first * pow(ratio, count));
    h[count] = at->over.length / (double)steps;
    error[count] = global_error(model, &at->over, method, steps, exact);
    if (errors_are_printed())
      printf("%s %s h = %.4g error %.2e\n", model->name, method, h[count], error[count]);
    if (error[count] <= floor) break;
  }
  ck_assert_msg(count >= FITTED, "%s, %s: %d errors above the floor", model->name, method, count);
  check_slope(model->name, method, fit_slope(FITTED, h + count - FITTED, error + count - FITTED, 2),
              order);
}

static void check_global_order_by_quad(const order_place *at, const char *method, int order)
{
  const double floor = 1e-13; /* ten times the roundoff of a thousand steps */
  problem *model = create_problem(at->over.problem, at->over.setting);
  state exact = copy_start(model);
  advance_by_judge(model, at->over.setting, at->over.length, floor, &exact);
  check_global_order(at, method, order, model, &exact, 2, floor);
  problem_destroy(&model);
}

static void check_global_order_by_ida(const order_place *at, const char *method, int order)
{
  problem *model = create_problem(at->over.problem, at->over.setting);
  state exact = copy_start(model);
  dvi_reference_report report;
  const dvi_status status = dvi_reference_judge(model->system, 0, at->over.length, exact.q, exact.p,
                                                NULL, &report);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  /* Its stated error is the distance of two runs. Ten times that error, for the momenta and for
   * luck, must not show. */
  const double floor = 100 * report.error / magnitude(model->nq, exact.q);
  check_global_order(at, method, order, model, &exact, 1.4, floor);
  problem_destroy(&model);
}

void check_order_by_ida(int index, const char *method, int order)
{
  check_global_order_by_ida(&places[index], method, order);
}

void check_order_over(const char *problem_name, const char *setting, double length, int first,
                      const char *method, int order)
{
  check_global_order_by_quad(
      &(order_place){.over = {problem_name, setting, length}, .first = first}, method, order);
}

void check_order_by_ida_over(const char *problem_name, const char *setting, double length,
                             int first, const char *method, int order)
{
  check_global_order_by_ida(&(order_place){.over = {problem_name, setting, length}, .first = first},
                            method, order);
}

/* ---- of one step ----
 *
 * Global errors of high orders are of little use in double precision: with the superconvergence
 * constants of degree 8 the error is at roundoff while h is still half the distance of the nearest
 * singularity, where the slope is not yet the order. The error of one step is smooth enough to be
 * followed there. It is made even smoother:
 *   - the step is centred: it starts from the judge's point at t - h/2, and its end is carried back
 *     to t by the judge. For a symmetric method this error is C h^(order+1) (1 + c h^2 + ...),
 *     without odd terms;
 *   - it is averaged over points t along the solution, so that a zero of C does no harm;
 *   - c and the next coefficient are fitted together with the slope. */

enum { CENTRES = 6, LEVELS_MOST = 64 };

static const double error_floor = 1e-14; /* twenty times the roundoff of one step */
/* errors above belong to steps too long for two correction terms */
static const double error_ceiling = 1e-9;

/* A method on a problem, and the states at which its errors are measured. */
typedef struct local_study {
  problem *model;
  const char *setting;
  dvi_integrator *integrator;
  state centre[CENTRES];
} local_study;

static double advance_exactly(const local_study *study, double t, state *z)
{
  return quad_solve(study->model->name, study->setting != NULL, &study->setting, t, z->q, z->p);
}

/* Returns the sum of squares of the components' errors, infinite if the step is too long to be
 * solved or judged. The start is rounded, and the exact centre belongs to the rounded start. */
static double centred_error(const local_study *study, const state *centre, double h)
{
  const problem *model = study->model;
  const size_t bytes = (size_t)model->nq * sizeof(double);
  state exact = *centre, end;
  (void)advance_exactly(study, -h / 2, &exact);
  if (dvi_integrator_start(study->integrator, 0, exact.q, exact.p) != DVI_OK ||
      dvi_integrator_step(study->integrator, h) != DVI_OK)
    return HUGE_VAL;
  memcpy(end.q, dvi_integrator_q(study->integrator), bytes);
  memcpy(end.p, dvi_integrator_p(study->integrator), bytes);
  const double judged = advance_exactly(study, h / 2, &exact) +
                        advance_exactly(study, -h / 2, &end);
  const double q = magnitude(model->nq, exact.q), p = magnitude(model->nq, exact.p);
  double sum = 0;
  for (int i = 0; i < model->nq; i++)
    sum += pow((end.q[i] - exact.q[i]) / q, 2) + pow((end.p[i] - exact.p[i]) / p, 2);
  return judged * judged < 1e-4 * sum + 1e-36 ? sum : HUGE_VAL;
}

/* Returns the root mean square over the centres. Steps that are far too long show at the first
 * centres. */
static double mean_error(const local_study *study, double h)
{
  double sum = 0;
  for (int k = 0; k < CENTRES && sum < 100 * error_ceiling * error_ceiling; k++)
    sum += centred_error(study, &study->centre[k], h);
  return sqrt(sum / (double)CENTRES);
}

/* Measures errors below the ceiling and above the floor, from coarse to fine, and returns their
 * number. The claimed order only chooses the steps, which first go down to the ceiling fast, and
 * then let errors fall by 4. */
static int measure_levels(const local_study *study, double largest_h, int order, double *h,
                          double *error)
{
  double h_now = largest_h;
  int count = 0;
  for (int level = 0; level < LEVELS_MOST; level++) {
    const double found = mean_error(study, h_now);
    if (errors_are_printed())
      printf("%s %s h = %.8g error %.4e\n", study->model->name,
             dvi_integrator_method(study->integrator), h_now, found);
    if (found <= error_floor) break;
    if (found <= error_ceiling) {
      h[count] = h_now;
      error[count++] = found;
    }
    h_now *= found <= error_ceiling ? pow(0.25, 1.0 / (order + 1))
                                    : fmax(0.5, pow(error_ceiling / found, 1.0 / (order + 1)));
  }
  return count;
}

static void check_local_order(const span *over, const char *method, double largest_h, int order)
{
  enum { LEAST = 6 };
  double h[LEVELS_MOST], error[LEVELS_MOST];
  local_study study = {.model = create_problem(over->problem, over->setting),
                       .setting = over->setting};
  study.integrator = create_integrator(study.model->system, method);
  for (int k = 0; k < CENTRES; k++) {
    study.centre[k] = copy_start(study.model);
    advance_by_judge(study.model, over->setting, (k + 0.5) * over->length / (double)CENTRES, 1e-10,
                     &study.centre[k]); /* any state near the solution serves */
  }
  const int count = measure_levels(&study, largest_h, order, h, error);
  dvi_integrator_destroy(&study.integrator);
  problem_destroy(&study.model);
  ck_assert_msg(count >= LEAST, "%s, %s: %d errors above the floor", over->problem, method, count);
  check_slope(over->problem, method, fit_slope(count, h, error, TERMS_MOST) - 1, order);
}

void check_order(int index, const char *method, int order)
{
  const order_place *at = &places[index];
  if (order <= MOST_GLOBAL_ORDER)
    check_global_order_by_quad(at, method, order);
  else
    check_local_order(&at->over, method, at->h, order);
}
