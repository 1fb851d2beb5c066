#include "support/equations.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "support/suite.h"

const dvi__rung rungs[3] = {DVI__FIXED_POINT, DVI__NEWTON, DVI__KINSOL};

static double neighbours(const double *x, int i)
{
  return (i > 0 ? sin(x[i - 1]) : 0) + (i + 1 < SIZE ? sin(x[i + 1]) : 0);
}

static dvi_status answer_of(const fault *f, long calls, double *number)
{
  if (f->at == 0 || calls < f->at) return DVI_OK;
  if (f->nan) *number = NAN;
  return f->answer;
}

static dvi_status chain_residual(void *of, const double *x, double *r)
{
  chain *c = of;
  c->residuals++;
  for (int i = 0; i < SIZE; i++)
    r[i] = (2 + i) * (x[i] - c->solution[i]) +
           c->strength * (neighbours(x, i) - neighbours(c->solution, i));
  return answer_of(&c->residual_fault, c->residuals, &r[2]);
}

static dvi_status chain_jacobian(void *of, const double *x, double *values)
{
  chain *c = of;
  c->jacobians++;
  for (int j = 0; j < SIZE; j++)
    for (int e = c->pattern.start[j]; e < c->pattern.start[j + 1]; e++)
      values[e] = c->pattern.row[e] == j ? 2 + j : c->strength * cos(x[j]);
  return answer_of(&c->jacobian_fault, c->jacobians, &values[3]);
}

static dvi_status chain_prepare(void *of, const double *x)
{
  (void)of, (void)x;
  return DVI_OK;
}

static void chain_chord(void *of, double *r)
{
  chain *c = of;
  c->chords++;
  for (int i = 0; i < SIZE; i++) r[i] /= 2 + i;
}

static dvi_status chain_scale(void *of, double *scale, int *unchanged)
{
  (void)of, (void)unchanged;
  for (int i = 0; i < SIZE; i++) scale[i] = 2 + i;
  return DVI_OK;
}

void make_chain(double strength, chain *c)
{
  static const int start[SIZE + 1] = {0, 2, 5, 8, 11, 13},
                                row[3 * SIZE - 2] = {0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4};
  *c = (chain){.strength = strength, .solution = {0.3, -1.2, 0.8, 2.1, -0.4}};
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, row}, SIZE, "chain", &c->pattern),
                   DVI_OK);
}

static dvi_status single_residual(void *of, const double *x, double *r)
{
  single *s = of;
  s->residuals++;
  if (x[0] < s->least) return DVI_CALLBACK_RETRY;
  r[0] = s->f(x[0]);
  return DVI_OK;
}

static dvi_status single_jacobian(void *of, const double *x, double *values)
{
  values[0] = ((const single *)of)->slope(x[0]);
  return DVI_OK;
}

static void single_chord(void *of, double *r)
{
  r[0] /= ((const single *)of)->chord;
}

static dvi_status single_scale(void *of, double *scale, int *unchanged)
{
  (void)of, (void)unchanged;
  scale[0] = 1;
  return DVI_OK;
}

static void make_solver(const dvi__equations *equations, bench *b)
{
  *b = (bench){0};
  ck_assert_msg(dvi__solver_create(equations, &b->counters, &b->solver) == DVI_OK, "%s",
                dvi_last_error());
}

void for_chain(chain *c, bench *b)
{
  make_solver(&(dvi__equations){.unknowns = SIZE,
                                .pattern = &c->pattern,
                                .of = c,
                                .residual = chain_residual,
                                .jacobian = chain_jacobian,
                                .prepare_chord = chain_prepare,
                                .chord = chain_chord,
                                .row_scale = chain_scale},
              b);
}

static void of_size_1(void *of, double *magnitude)
{
  (void)of;
  magnitude[0] = 1;
}

static dvi__equations equations_of(single *s)
{
  static int start[2] = {0, 1}, row[1] = {0};
  static const dvi__pattern one = {1, 1, start, row};
  return (dvi__equations){.unknowns = 1,
                          .pattern = &one,
                          .of = s,
                          .residual = single_residual,
                          .jacobian = single_jacobian,
                          .prepare_chord = chain_prepare,
                          .chord = single_chord,
                          .row_scale = single_scale};
}

void for_single(single *s, bench *b)
{
  const dvi__equations equations = equations_of(s);
  make_solver(&equations, b);
}

void for_sum(single *s, bench *b)
{
  dvi__equations equations = equations_of(s);
  equations.magnitudes = of_size_1;
  make_solver(&equations, b);
}

dvi_status run_rung(bench *b, dvi__rung rung, double *x)
{
  return dvi__solve(b->solver, rung, 1.0, 0, 0, x, &b->report);
}

void free_bench(bench *b, chain *c)
{
  dvi__solver_destroy(&b->solver);
  if (c != NULL) dvi__pattern_clear(&c->pattern);
}

void failed_with(dvi_status status, dvi_status expected)
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
