#include "support/equations.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "support/suite.h"

const dvi__rung rungs[3] = {DVI__FIXED_POINT, DVI__NEWTON, DVI__KINSOL};

static double neighbours(const double *x, int i)
{
  return (i > 0 ? sin(x[i - 1]) : 0) + (i + 1 < CHAIN_SIZE ? sin(x[i + 1]) : 0);
}

static dvi_status answer_of(const callback_fault *fault, long calls, double *number)
{
  if (fault->at == 0 || calls < fault->at) return DVI_OK;
  if (fault->nan) *number = NAN;
  return fault->answer;
}

static dvi_status chain_residual(void *user, const double *x, double *r)
{
  equation_chain *chain = user;
  chain->residuals++;
  for (int i = 0; i < CHAIN_SIZE; i++)
    r[i] = (2 + i) * (x[i] - chain->solution[i]) +
           chain->strength * (neighbours(x, i) - neighbours(chain->solution, i));
  return answer_of(&chain->residual_fault, chain->residuals, &r[2]);
}

static dvi_status chain_jacobian(void *user, const double *x, double *values)
{
  equation_chain *chain = user;
  chain->jacobians++;
  for (int j = 0; j < CHAIN_SIZE; j++)
    for (int e = chain->pattern.start[j]; e < chain->pattern.start[j + 1]; e++)
      values[e] = chain->pattern.row[e] == j ? 2 + j : chain->strength * cos(x[j]);
  return answer_of(&chain->jacobian_fault, chain->jacobians, &values[3]);
}

static void chain_chord(void *user, double *r)
{
  equation_chain *chain = user;
  chain->chords++;
  for (int i = 0; i < CHAIN_SIZE; i++) r[i] /= 2 + i;
}

static dvi_status chain_scale(void *user, double *scale, int *unchanged)
{
  (void)user, (void)unchanged;
  for (int i = 0; i < CHAIN_SIZE; i++) scale[i] = 2 + i;
  return DVI_OK;
}

void make_chain(double strength, equation_chain *chain)
{
  static const int start[CHAIN_SIZE + 1] = {0, 2, 5, 8, 11, 13},
                                      row[3 * CHAIN_SIZE - 2] = {0, 1, 0, 1, 2, 1, 2,
                                                                 3, 2, 3, 4, 3, 4};
  *chain = (equation_chain){.strength = strength, .solution = {0.3, -1.2, 0.8, 2.1, -0.4}};
  ck_assert_int_eq(
      dvi__pattern_copy(&(dvi_pattern){start, row}, CHAIN_SIZE, "chain", &chain->pattern), DVI_OK);
}

static dvi_status single_residual(void *user, const double *x, double *r)
{
  single_equation *equation = user;
  equation->residuals++;
  if (x[0] < equation->least) return DVI_CALLBACK_RETRY;
  r[0] = equation->f(x[0]);
  return DVI_OK;
}

static dvi_status single_jacobian(void *user, const double *x, double *values)
{
  values[0] = ((const single_equation *)user)->slope(x[0]);
  return DVI_OK;
}

static void single_chord(void *user, double *r)
{
  r[0] /= ((const single_equation *)user)->chord;
}

static dvi_status single_scale(void *user, double *scale, int *unchanged)
{
  (void)user, (void)unchanged;
  scale[0] = 1;
  return DVI_OK;
}

static void make_solver(const dvi__equations *equations, solver_bench *bench)
{
  *bench = (solver_bench){0};
  ck_assert_msg(dvi__solver_create(equations, &bench->counters, &bench->solver) == DVI_OK, "%s",
                dvi_last_error());
}

void create_chain_solver(equation_chain *chain, solver_bench *bench)
{
  make_solver(&(dvi__equations){.unknowns = CHAIN_SIZE,
                                .pattern = &chain->pattern,
                                .of = chain,
                                .residual = chain_residual,
                                .jacobian = chain_jacobian,
                                .chord = chain_chord,
                                .row_scale = chain_scale},
              bench);
}

static void of_size_1(void *user, double *magnitude)
{
  (void)user;
  magnitude[0] = 1;
}

static dvi__equations equations_of(single_equation *equation)
{
  static int start[2] = {0, 1}, row[1] = {0};
  static const dvi__pattern one = {1, 1, start, row};
  return (dvi__equations){.unknowns = 1,
                          .pattern = &one,
                          .of = equation,
                          .residual = single_residual,
                          .jacobian = single_jacobian,
                          .chord = single_chord,
                          .row_scale = single_scale};
}

void create_single_solver(single_equation *equation, solver_bench *bench)
{
  const dvi__equations equations = equations_of(equation);
  make_solver(&equations, bench);
}

void create_sum_solver(single_equation *equation, solver_bench *bench)
{
  dvi__equations equations = equations_of(equation);
  equations.magnitudes = of_size_1;
  make_solver(&equations, bench);
}

dvi_status solve_by_rung(solver_bench *bench, dvi__rung rung, double *x)
{
  return dvi__solve(bench->solver, rung, 1.0, 0, 0, x, &bench->report);
}

void destroy_solver_bench(solver_bench *bench, equation_chain *chain)
{
  dvi__solver_destroy(&bench->solver);
  if (chain != NULL) dvi__pattern_clear(&chain->pattern);
}

void check_failure(dvi_status status, dvi_status expected)
{
  ck_assert_msg(status == expected, "%s, not %s: %s", dvi_status_name(status),
                dvi_status_name(expected), dvi_last_error());
  ck_assert_msg(strlen(dvi_last_error()) > 20, "%s", dvi_last_error());
}

double faint(double x)
{
  return 1e-6 * (x - 1) * (x + 1) + DBL_EPSILON * sin(1e14 * x);
}

double faint_slope(double x)
{
  return 2e-6 * x;
}

double arctangent(double x)
{
  return atan(x);
}

double arctangent_slope(double x)
{
  return 1 / (1 + x * x);
}

double parabola(double x)
{
  return x * x - 1;
}

double parabola_slope(double x)
{
  return 2 * x;
}

double never_zero(double x)
{
  return x * x + 1;
}

double flat_slope(double x)
{
  (void)x;
  return 0;
}
