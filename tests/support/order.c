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

/* Where a problem's orders show: the span, its steps in the coarsest run of a global study, and the
 * longest step that a local one tries, a little more than the distance of the nearest singularity
 * in complex time. */
typedef struct place {
  span over;
  int first;
  double h;
} place;

static const place places[] = {
    {{"kepler", "e=0.3", 6.0}, 40, 0.8},     {{"pendulum", NULL, 8.0}, 10, 1.6},
    {{"henon-heiles", NULL, 12.0}, 20, 2.4}, {{"double-pendulum", NULL, 1.0}, 10, 0.2},
    {{"toda", "N=5", 5.0}, 10, 1.8},
};

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
  ck_assert_int_le(of->nq, N);
  memcpy(z.q, of->q, (size_t)of->nq * sizeof(double));
  memcpy(z.p, of->p, (size_t)of->nq * sizeof(double));
  return z;
}

/* To choose spans and steps. */
static int show(void)
{
  return getenv("DVI_SHOW_ORDERS") != NULL;
}

static void check_slope(const char *problem_name, const char *method, double slope, int order)
{
  if (show()) printf("%s %s: %.3f of %d\n", problem_name, method, slope, order);
  ck_assert_msg(fabs(slope - order) <= 0.2, "%s, %s: order %.3f, not %d", problem_name, method,
                slope, order);
}

/* Solve the small normal equations a x = b in place by elimination; they are scaled well enough. */
enum { TERMS_MOST = 4 };

static void solve(int count, double a[TERMS_MOST][TERMS_MOST], double *b)
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

/* Least squares of log error = x0 + x1 log h + x2 h^2 + x3 h^4, cut after `terms`: gives x1. h is
 * taken in units of the largest one. Each error counts by how well it is known: to a hundredth, and
 * to the roundoff of one step. */
static double slope_of(int count, const double *h, const double *error, int terms)
{
  /* by up to 8e-16 the errors at the floor differ between two solvers */
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
  solve(terms, a, b);
  return b[1];
}

/* ---- at the end of a span ---- */

static double relative(int n, const double *q, const double *p, const state *exact)
{
  return fmax(distance(n, q, exact->q) / magnitude(n, exact->q),
              distance(n, p, exact->p) / magnitude(n, exact->p));
}

static double global_error(const problem *of, const span *over, const char *method, long steps,
                           const state *exact)
{
  dvi_integrator *integrator = started(of, method);
  advance(integrator, over->length / (double)steps, steps);
  const double error = relative(of->nq, dvi_integrator_q(integrator), dvi_integrator_p(integrator),
                                exact);
  dvi_integrator_destroy(&integrator);
  return error;
}

/* The slope over the finest four steps whose errors are above the floor; each is `ratio` times
 * shorter than the one before. */
static void check_global_order(const place *at, const char *method, int order, problem *of,
                               const state *exact, double ratio, double floor)
{
  enum { LEVELS = 10, FITTED = 4 };
  double h[LEVELS], error[LEVELS];
  int count = 0;
  for (; count < LEVELS; count++) {
    const long steps = lround(at->first * pow(ratio, count));
    h[count] = at->over.length / (double)steps;
    error[count] = global_error(of, &at->over, method, steps, exact);
    if (show()) printf("%s %s h = %.4g error %.2e\n", of->name, method, h[count], error[count]);
    if (error[count] <= floor) break;
  }
  ck_assert_msg(count >= FITTED, "%s, %s: %d errors above the floor", of->name, method, count);
  check_slope(of->name, method, slope_of(FITTED, h + count - FITTED, error + count - FITTED, 2),
              order);
}

static void check_global_order_by_quad(const place *at, const char *method, int order)
{
  const double floor = 1e-13; /* ten times the roundoff of a thousand steps */
  problem *of = made_problem(at->over.problem, at->over.setting);
  state exact = start_of(of);
  judge(of, at->over.setting, at->over.length, floor, &exact);
  check_global_order(at, method, order, of, &exact, 2, floor);
  problem_destroy(&of);
}

static void check_global_order_by_ida(const place *at, const char *method, int order)
{
  problem *of = made_problem(at->over.problem, at->over.setting);
  state exact = start_of(of);
  dvi_reference_report report;
  const dvi_status status = dvi_reference_judge(of->system, 0, at->over.length, exact.q, exact.p,
                                                NULL, &report);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  /* its stated error is the distance of two runs: ten times that, for the momenta and for luck,
   * must not show */
  const double floor = 100 * report.error / magnitude(of->nq, exact.q);
  check_global_order(at, method, order, of, &exact, 1.4, floor);
  problem_destroy(&of);
}

void check_order_by_ida(int index, const char *method, int order)
{
  check_global_order_by_ida(&places[index], method, order);
}

void check_order_over(const char *problem_name, const char *setting, double length, int first,
                      const char *method, int order)
{
  check_global_order_by_quad(&(place){.over = {problem_name, setting, length}, .first = first},
                             method, order);
}

void check_order_by_ida_over(const char *problem_name, const char *setting, double length,
                             int first, const char *method, int order)
{
  check_global_order_by_ida(&(place){.over = {problem_name, setting, length}, .first = first},
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

/* A method on a problem, and what its errors are measured at. */
typedef struct local_study {
  problem *of;
  const char *setting;
  dvi_integrator *integrator;
  state centre[CENTRES];
} local_study;

static double carry(const local_study *study, double t, state *z)
{
  return quad_solve(study->of->name, study->setting != NULL, &study->setting, t, z->q, z->p);
}

/* Sum of squares over the components; infinite if the step is too long to be solved or to be
 * judged. The start is rounded: the exact centre belongs to the rounded one. */
static double centred_error(const local_study *study, const state *centre, double h)
{
  const problem *of = study->of;
  const size_t bytes = (size_t)of->nq * sizeof(double);
  state exact = *centre, end;
  (void)carry(study, -h / 2, &exact);
  if (dvi_integrator_start(study->integrator, 0, exact.q, exact.p) != DVI_OK ||
      dvi_integrator_step(study->integrator, h) != DVI_OK)
    return HUGE_VAL;
  memcpy(end.q, dvi_integrator_q(study->integrator), bytes);
  memcpy(end.p, dvi_integrator_p(study->integrator), bytes);
  const double judged = carry(study, h / 2, &exact) + carry(study, -h / 2, &end);
  const double q = magnitude(of->nq, exact.q), p = magnitude(of->nq, exact.p);
  double sum = 0;
  for (int i = 0; i < of->nq; i++)
    sum += pow((end.q[i] - exact.q[i]) / q, 2) + pow((end.p[i] - exact.p[i]) / p, 2);
  return judged * judged < 1e-4 * sum + 1e-36 ? sum : HUGE_VAL;
}

/* Steps that are far too long show at the first points. */
static double mean_error(const local_study *study, double h)
{
  double sum = 0;
  for (int k = 0; k < CENTRES && sum < 100 * error_ceiling * error_ceiling; k++)
    sum += centred_error(study, &study->centre[k], h);
  return sqrt(sum / (double)CENTRES);
}

/* Errors below the ceiling and above the floor, from coarse to fine; returns how many there are.
 * The claimed order is used to choose steps only: to go down to the ceiling fast, then to let
 * errors fall by 4. */
static int follow(const local_study *study, double largest_h, int order, double *h, double *error)
{
  double now = largest_h;
  int count = 0;
  for (int level = 0; level < LEVELS_MOST; level++) {
    const double found = mean_error(study, now);
    if (show())
      printf("%s %s h = %.8g error %.4e\n", study->of->name,
             dvi_integrator_method(study->integrator), now, found);
    if (found <= error_floor) break;
    if (found <= error_ceiling) {
      h[count] = now;
      error[count++] = found;
    }
    now *= found <= error_ceiling ? pow(0.25, 1.0 / (order + 1))
                                  : fmax(0.5, pow(error_ceiling / found, 1.0 / (order + 1)));
  }
  return count;
}

static void check_local_order(const span *of, const char *method, double largest_h, int order)
{
  enum { LEAST = 6 };
  double h[LEVELS_MOST], error[LEVELS_MOST];
  local_study study = {.of = made_problem(of->problem, of->setting), .setting = of->setting};
  study.integrator = made_integrator(study.of->system, method);
  for (int k = 0; k < CENTRES; k++) {
    study.centre[k] = start_of(study.of);
    judge(study.of, of->setting, (k + 0.5) * of->length / (double)CENTRES, 1e-10,
          &study.centre[k]); /* any point near the solution will do */
  }
  const int count = follow(&study, largest_h, order, h, error);
  dvi_integrator_destroy(&study.integrator);
  problem_destroy(&study.of);
  ck_assert_msg(count >= LEAST, "%s, %s: %d errors above the floor", of->problem, method, count);
  check_slope(of->problem, method, slope_of(count, h, error, TERMS_MOST) - 1, order);
}

void check_order(int index, const char *method, int order)
{
  const place *at = &places[index];
  if (order <= MOST_GLOBAL_ORDER)
    check_global_order_by_quad(at, method, order);
  else
    check_local_order(&at->over, method, at->h, order);
}
