#include "support/runs.h"

#include <check.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/quad.h"

const char *spec(const char *format, ...)
{
  static char texts[8][256];
  static int next;
  char *text = texts[next++ % 8];
  va_list arguments;
  va_start(arguments, format);
  (void)vsnprintf(text, sizeof texts[0], format, arguments);
  va_end(arguments);
  return text;
}

problem *made_problem(const char *name, const char *setting)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create(name, setting != NULL, &setting, &made, message, sizeof message) == DVI_OK, "%s", message);
  return made;
}

dvi_integrator *made_integrator(const dvi_system *system, const char *method)
{
  dvi_integrator *made = NULL;
  ck_assert_msg(dvi_integrator_create(system, method, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

dvi_integrator *started(const problem *of, const char *method)
{
  dvi_integrator *made = made_integrator(of->system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, of->q, of->p) == DVI_OK, "%s", dvi_last_error());
  return made;
}

void advance(dvi_integrator *integrator, double h, long steps)
{
  for (long i = 0; i < steps; i++)
    if (dvi_integrator_step(integrator, h) != DVI_OK) ck_abort_msg("%s", dvi_last_error());
}

double distance(int n, const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < n; i++) {
    const double apart = fabs(a[i] - b[i]);
    if (!(apart <= largest)) largest = apart; /* NaN stays */
  }
  return largest;
}

double magnitude(int n, const double *a)
{
  double largest = 0;
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i]));
  return largest;
}

/* ---- orders ---- */

void judge_by_quad(const problem *of, const char *setting, double t_end, judged *solution)
{
  const size_t bytes = (size_t)of->n * sizeof(double);
  ck_assert_int_le(of->n, COORDINATES_MOST);
  *solution = (judged){.of = of, .quarter = t_end / QUARTERS};
  for (int k = 0; k < QUARTERS; k++) {
    memcpy(solution->q[k], of->q, bytes);
    memcpy(solution->p[k], of->p, bytes);
    const double error = quad_solve(of->name, setting != NULL, &setting, (k + 1) * solution->quarter, solution->q[k], solution->p[k]);
    if (!(error <= solution->error)) solution->error = error;
  }
}

/* In q relative to the largest coordinate, in p to the largest momentum: the larger of both. */
static double error_at(const judged *solution, const char *method, long steps)
{
  const problem *of = solution->of;
  dvi_integrator *integrator = started(of, method);
  double error = 0;
  for (int k = 0; k < QUARTERS; k++) {
    advance(integrator, solution->quarter / (double)steps, steps);
    error = fmax(error, distance(of->n, dvi_integrator_q(integrator), solution->q[k]) / magnitude(of->n, solution->q[k]));
    error = fmax(error, distance(of->n, dvi_integrator_p(integrator), solution->p[k]) / magnitude(of->n, solution->p[k]));
  }
  dvi_integrator_destroy(&integrator);
  return error;
}

/* Least-squares slope of log error over log h. */
static double slope_of(int count, const double *h, const double *error)
{
  double x = 0, y = 0, xx = 0, xy = 0;
  for (int i = 0; i < count; i++) {
    const double a = log(h[i]), b = log(error[i]);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (count * xy - x * y) / (count * xx - x * x);
}

enum { LEVELS_MOST = 16, LEVELS_FITTED = 5, LEVELS_LEAST = 4 };

void check_order(const judged *solution, const order_study *study, double order)
{
  double h[LEVELS_MOST], error[LEVELS_MOST];
  int count = 0;
  ck_assert_double_lt(solution->error, 0.01 * study->floor);
  for (int level = 0; level < study->levels; level++) {
    const long steps = lround(study->first * pow(study->ratio, level));
    h[count] = solution->quarter / (double)steps;
    error[count] = error_at(solution, study->method, steps);
    if (getenv("DVI_SHOW_ORDERS") != NULL)
      printf("%s %s N=%ld error %.2e local %.2f\n", solution->of->name, study->method, steps, error[count],
             count > 0 ? slope_of(2, h + count - 1, error + count - 1) : 0);
    if (error[count] <= study->floor) break;
    count++;
  }
  ck_assert_msg(count >= LEVELS_LEAST, "%s, %s: %d errors above the floor", solution->of->name, study->method, count);
  const int fitted = count < LEVELS_FITTED ? count : LEVELS_FITTED;
  const double slope = slope_of(fitted, h + count - fitted, error + count - fitted);
  if (getenv("DVI_SHOW_ORDERS") != NULL) printf("%s %s slope %.3f claimed %g\n", solution->of->name, study->method, slope, order);
  ck_assert_msg(fabs(slope - order) <= 0.2, "%s, %s: order %.3f, not %g (last error %.1e)", solution->of->name, study->method, slope, order,
                error[count - 1]);
}
