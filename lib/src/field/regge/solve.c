/* Stationary lengths, where the gradient g(l) of the action vanishes for the lengths that are not
 * held.
 *
 * KINSOL's Newton method with line search takes the sparse Hessian H, which is indefinite, and
 * singular near flat solutions, because the moves of an inner vertex change nothing. The step of
 * least norm
 *
 *     d = -H (H^2 + delta^2)^{-1} g = -Re (H + i delta)^{-1} g
 *
 * (Tikhonov's, from one complex factor) has no part in the null directions, and is Newton's step in
 * those whose eigenvalues are large beside delta. |g|^2 falls along it. The null directions are
 * counted by
 *
 *     log2 |det(H + 2 i delta)/det(H + i delta)| = sum log2((lambda^2 + 4 delta^2)
 *                                                           /(lambda^2 + delta^2))/2,
 *
 * to which those with lambda = 0 add 1, and those with large lambda 0. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/regge/regge.h"
#include "num/linear.h"
#include "solve/nonlinear.h"

enum { ITERATIONS = 100 };

/* The least delta beside the largest entry of H. Roundings of solutions are 1e-16/1e-7 of a
 * step. */
static const double shift_part = 1e-7;

static const double pi = 3.14159265358979323846;

/* |g| may be as large as this beside the sizes of its terms, as in thin simplices. */
static const double floor_part = 1e-11;

/* If a step leaves more than this part of |g|, directions are soft that are not null, and the next
 * steps are damped less. */
static const double slow = 0.5, relief = 0.01;

typedef struct search {
  const dvi_regge *regge;
  int64_t unknowns;
  int *unknown; /* [edges] the number of the unknown, or -1 for lengths that are held */
  int *edge;    /* [unknowns] */
  dvi__pattern pattern;
  int64_t *place; /* [entries of pattern] in the complex's pattern */
  dvi__solver *solver;
  dvi_counters counters;    /* of the solver */
  double *x;                /* [unknowns] */
  double *length, *refused; /* [edges] of the last point, and those that do not exist */
  dvi__regge_sums sums;     /* of the last point */
  int iterations, most;
  int is_refused;     /* since the last Jacobian a simplex did not exist */
  int scale_sign;     /* 1, but without held lengths and with Lambda that of the scale's square */
  double size, terms; /* |g| of the last point, and that of the sizes of its terms */
  double before;      /* |g| of the last Jacobian's point */
  double residual;    /* the largest |g_e| there */
  double damping;
} search;

static dvi_status no_memory(void)
{
  (void)dvi__fail(DVI_NO_MEMORY, "regge: no memory for Newton's method");
  return DVI_NO_MEMORY;
}

/* ---- the system ---- */

static dvi_status choose_unknowns(search *s, const int8_t *held)
{
  const dvi_regge *r = s->regge;
  for (int64_t e = 0; e < r->edges; e++) {
    const int is_held = held != NULL ? held[e] != 0 : r->rim[e];
    s->unknown[e] = is_held ? -1 : (int)s->unknowns;
    if (!is_held) s->edge[s->unknowns++] = (int)e;
  }
  if (s->unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "regge: all %lld lengths are held: take a complex with inner edges, or hold "
                   "fewer",
                   (long long)r->edges);
}

/* Choose the entries of unknowns. The matrix is symmetric, so that columns are rows. */
static dvi_status choose_entries(search *s)
{
  const dvi__csr *all = &s->regge->pattern;
  dvi__pattern *p = &s->pattern;
  p->rows = p->columns = (int)s->unknowns;
  p->start = DVI_NEW(int, s->unknowns + 1);
  p->row = DVI_NEW(int, all->start[all->rows]);
  s->place = DVI_NEW(int64_t, all->start[all->rows]);
  if (p->start == NULL || p->row == NULL || s->place == NULL) return no_memory();
  int count = 0;
  for (int64_t u = 0; u < s->unknowns; u++) {
    for (int64_t i = all->start[s->edge[u]]; i < all->start[s->edge[u] + 1]; i++) {
      const int other = s->unknown[all->column[i]];
      if (other < 0) continue;
      p->row[count] = other;
      s->place[count++] = i;
    }
    p->start[u + 1] = count;
  }
  return DVI_OK;
}

static dvi_status allocate(search *s)
{
  const dvi_regge *r = s->regge;
  s->x = DVI_NEW(double, s->unknowns);
  s->length = DVI_NEW(double, r->edges);
  s->refused = DVI_NEW(double, r->edges);
  s->sums.deficit = DVI_NEW(double, r->hinges);
  s->sums.size = DVI_NEW(double, r->hinges);
  s->sums.gradient = DVI_NEW(double, r->edges);
  s->sums.terms = DVI_NEW(double, r->edges);
  s->sums.hessian = DVI_NEW(double, r->pattern.start[r->edges]);
  return s->x != NULL && s->length != NULL && s->refused != NULL && s->sums.deficit != NULL &&
                 s->sums.size != NULL && s->sums.gradient != NULL && s->sums.terms != NULL &&
                 s->sums.hessian != NULL
             ? DVI_OK
             : no_memory();
}

static dvi_status prepare(search *s, const int8_t *held)
{
  s->unknown = DVI_NEW(int, s->regge->edges);
  s->edge = DVI_NEW(int, s->regge->edges);
  if (s->unknown == NULL || s->edge == NULL) return no_memory();
  DVI_TRY(choose_unknowns(s, held));
  DVI_TRY(choose_entries(s));
  return allocate(s);
}

static void clear(search *s)
{
  dvi__solver_destroy(&s->solver);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->unknown);
  dvi__release(s->edge);
  dvi__release(s->place);
  dvi__release(s->x);
  dvi__release(s->length);
  dvi__release(s->refused);
  dvi__release(s->sums.deficit);
  dvi__release(s->sums.size);
  dvi__release(s->sums.gradient);
  dvi__release(s->sums.terms);
  dvi__release(s->sums.hessian);
}

/* ---- one point ---- */

/* Squares of gradients with a large Lambda would overflow. */
static double norm(const search *s, const double *of_edges)
{
  double most = 0, sum = 0;
  for (int64_t u = 0; u < s->unknowns; u++) most = fmax(most, fabs(of_edges[s->edge[u]]));
  for (int64_t u = 0; u < s->unknowns && most > 0; u++)
    sum += of_edges[s->edge[u]] / most * (of_edges[s->edge[u]] / most);
  return most * sqrt(sum);
}

/* Evaluate the gradient, and with `all` the Hessian. */
static dvi_status evaluate(search *s, int all)
{
  dvi__regge_sums sums = s->sums;
  if (!all) sums.hessian = NULL;
  DVI_TRY(dvi__regge_evaluate(s->regge, s->length, &sums));
  s->sums.action = sums.action;
  s->sums.volume = sums.volume;
  s->size = norm(s, sums.gradient);
  s->terms = norm(s, sums.terms);
  return DVI_OK;
}

/* Points where simplices do not exist are no failure, but let KINSOL shorten its step. */
static dvi_status evaluate_at(search *s, const double *x, int all)
{
  for (int64_t u = 0; u < s->unknowns; u++) s->length[s->edge[u]] = x[u];
  const dvi_status status = evaluate(s, all);
  if (status != DVI_BAD_ARGUMENT) return status;
  memcpy(s->refused, s->length, (size_t)s->regge->edges * sizeof *s->refused);
  s->is_refused = 1;
  return DVI_NOT_CONVERGED;
}

/* Give the root of the mean square of the unknown lengths. */
static double typical_length(const search *s)
{
  return norm(s, s->length) / sqrt((double)s->unknowns);
}

static double largest_entry(const search *s)
{
  double most = 0;
  for (int i = 0; i < s->pattern.start[s->unknowns]; i++)
    most = fmax(most, fabs(s->sums.hessian[s->place[i]]));
  return most;
}

static void set_matrix(const search *s, double delta, double *value)
{
  for (int64_t u = 0; u < s->unknowns; u++)
    for (int i = s->pattern.start[u]; i < s->pattern.start[u + 1]; i++) {
      value[2 * i] = s->sums.hessian[s->place[i]];
      value[2 * i + 1] = s->pattern.row[i] == u ? delta : 0;
    }
}

/* ---- the equations ---- */

static dvi_status residual(void *of, const double *x, double *g)
{
  search *s = of;
  DVI_TRY(evaluate_at(s, x, 0));
  for (int64_t u = 0; u < s->unknowns; u++) g[u] = s->sums.gradient[s->edge[u]];
  return DVI_OK;
}

/* Note how far the iteration came. */
static void note(search *s)
{
  s->before = s->size;
  s->residual = 0;
  for (int64_t u = 0; u < s->unknowns; u++)
    s->residual = fmax(s->residual, fabs(s->sums.gradient[s->edge[u]]));
}

/* Set H + i delta, with delta^2 = damping |H| |g|/l, where l is a typical length, or the least
 * delta. */
static dvi_status jacobian(void *of, const double *x, double *values)
{
  search *s = of;
  DVI_TRY(evaluate_at(s, x, 1));
  if (s->iterations > 0 && s->size > slow * s->before) s->damping *= relief;
  note(s);
  if (s->iterations == s->most)
    return dvi__fail(DVI_NOT_CONVERGED, "regge: %d iterations were not enough", s->most);
  s->iterations++;
  s->is_refused = 0;
  const double most = largest_entry(s);
  if (most == 0) return dvi__fail(DVI_SINGULAR, "regge: the Hessian of the action vanishes");
  const double part = sqrt(s->damping * (s->size / typical_length(s) / most));
  set_matrix(s, most * fmax(shift_part, part), values);
  return DVI_OK;
}

static void magnitudes(void *of, double *magnitude)
{
  const search *s = of;
  for (int64_t u = 0; u < s->unknowns; u++) magnitude[u] = s->sums.terms[s->edge[u]];
}

static dvi_status row_scale(void *of, double *scale, int *unchanged)
{
  const search *s = of;
  const double most = largest_entry(s);
  for (int64_t u = 0; u < s->unknowns; u++) scale[u] = most;
  *unchanged = 0;
  return DVI_OK;
}

/* ---- the solution ---- */

/* Without held lengths the sum of l_e dS/dl_e is (n-2) sum |h| eps - n Lambda V. */
static const char *remedy(const search *s)
{
  const double lambda = s->regge->lambda;
  if (s->unknowns == s->regge->edges && lambda == 0)
    return "without Lambda and without held lengths only S = 0 is stationary";
  if (s->unknowns == s->regge->edges && s->scale_sign <= 0)
    return "without held lengths (n-2) sum |h| eps = n Lambda V, and the guess has no size for "
           "which both are equal";
  if (lambda != 0 || s->regge->n == 4)
    return "start from lengths nearer to a solution, such as that of another Lambda, because in "
           "curved space the moves of inner vertices are only nearly free";
  return "start from lengths nearer to a solution";
}

/* Name the simplex that stopped the iteration, if one did. */
static dvi_status refuse(const search *s)
{
  dvi__regge_sums sums = s->sums;
  sums.gradient = sums.terms = sums.hessian = NULL;
  if (!s->is_refused || s->scale_sign <= 0 ||
      dvi__regge_evaluate(s->regge, s->refused, &sums) == DVI_OK)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "regge: Newton's method left a gradient of %.2g (iterations: %d): %s",
                     s->before, s->iterations, remedy(s));
  return dvi__fail_in(DVI_NOT_CONVERGED,
                      "regge: Newton's method left a gradient of %.2g (iterations: %d): %s; its "
                      "next step leads to lengths that do not exist",
                      s->before, s->iterations, remedy(s));
}

static int has_free_scale(const search *s)
{
  return s->unknowns == s->regge->edges && s->regge->lambda != 0;
}

/* Give 2 pi sum |h|, beside which sum |h| eps has its roundings. */
static double turns_of(const dvi_regge *r, const double *size)
{
  double sum = 0;
  for (int64_t h = 0; h < r->hinges; h++) sum += 2 * pi * size[h];
  return sum;
}

/* Without held lengths a flat complex shrinks, until Lambda is a rounding beside its curvature. */
static int is_collapsed(const search *s)
{
  const dvi_regge *r = s->regge;
  return has_free_scale(s) &&
         r->n * fabs(r->lambda) * s->sums.volume <= floor_part * turns_of(r, s->sums.size);
}

/* Without held lengths, make the action (c^(n-2) S_0 - c^n Lambda V) stationary in their scale c
 * first, because the gradient also vanishes as all lengths shrink to 0. S_0 may be a rounding, as
 * of flat complexes. */
static dvi_status choose_scale(search *s)
{
  const dvi_regge *r = s->regge;
  dvi__regge_sums sums = s->sums;
  double curvature = 0;
  sums.gradient = sums.terms = sums.hessian = NULL;
  if (!has_free_scale(s)) return DVI_OK;
  DVI_TRY(dvi__regge_evaluate(r, s->length, &sums));
  for (int64_t h = 0; h < r->hinges; h++) curvature += sums.size[h] * sums.deficit[h];
  const double square = (r->n - 2) * curvature / (r->n * r->lambda * sums.volume);
  const int is_flat = fabs(curvature) <= floor_part * turns_of(r, sums.size);
  s->scale_sign = is_flat ? 0 : square > 0 ? 1 : -1;
  for (int64_t e = 0; e < r->edges && s->scale_sign > 0; e++) s->length[e] *= sqrt(square);
  return DVI_OK;
}

static dvi_status start(search *s)
{
  DVI_TRY(choose_scale(s));
  DVI_TRY(evaluate(s, 1));
  note(s);
  for (int64_t u = 0; u < s->unknowns; u++) s->x[u] = s->length[s->edge[u]];
  const dvi__equations equations = {.unknowns = (int)s->unknowns,
                                    .of = s,
                                    .pattern = &s->pattern,
                                    .linear = DVI__LINEAR_COMPLEX,
                                    .residual = residual,
                                    .jacobian = jacobian,
                                    .row_scale = row_scale,
                                    .magnitudes = magnitudes,
                                    .renewed = 1};
  return dvi__solver_create(&equations, &s->counters, &s->solver);
}

static dvi_status iterate(search *s)
{
  dvi__solve_report report;
  DVI_TRY(start(s));
  dvi_status status = dvi__solve(s->solver, DVI__KINSOL, 0, 0, 0, s->x, &report);
  if (status < 0) return status;
  status = evaluate_at(s, s->x, 1);
  if (status != DVI_OK || s->size > floor_part * s->terms || is_collapsed(s)) return refuse(s);
  note(s);
  return DVI_OK;
}

/* ---- the report ---- */

static dvi_status log_determinant(const search *s, double *value, double delta, double *logarithm)
{
  dvi__linear *linear = dvi__solver_linear(s->solver);
  set_matrix(s, delta, value);
  DVI_TRY(dvi__linear_factor(linear, value));
  *logarithm = dvi__linear_log_determinant(linear);
  return DVI_OK;
}

/* Compare the determinants at delta and at 2 delta. */
static dvi_status count_null(const search *s, double *softness)
{
  const double delta = shift_part * largest_entry(s);
  double single = 0, twice = 0,
         *value = DVI_NEW(double, 2 * (int64_t)s->pattern.start[s->unknowns]);
  if (value == NULL) return no_memory();
  dvi_status status = log_determinant(s, value, delta, &single);
  if (status == DVI_OK) status = log_determinant(s, value, 2 * delta, &twice);
  dvi__release(value);
  *softness = (twice - single) / log(2);
  return status;
}

static dvi_status solve(search *s, dvi_regge_report *report)
{
  const dvi_status status = iterate(s);
  *report = (dvi_regge_report){.iterations = s->iterations,
                               .residual = s->residual,
                               .action = s->sums.action,
                               .unknowns = s->unknowns};
  if (status != DVI_OK) return status;
  DVI_TRY(count_null(s, &report->softness));
  report->null_directions = llround(report->softness);
  return DVI_OK;
}

dvi_status dvi_regge_solve(const dvi_regge *regge, const dvi_regge_options *options, double *length,
                           dvi_regge_report *report)
{
  const dvi_regge_options defaults = {.size = sizeof defaults};
  dvi_regge_report found = {0};
  DVI_TRY(dvi__regge_check(regge, length));
  if (options == NULL) options = &defaults;
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: set options.size to sizeof(dvi_regge_options)");
  if (options->iterations < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: %d iterations are asked, 1 or more are possible",
                     options->iterations);
  search s = {.regge = regge,
              .most = options->iterations > 0 ? options->iterations : ITERATIONS,
              .damping = 1,
              .scale_sign = 1};
  dvi_status status = prepare(&s, options->held);
  if (status == DVI_OK) {
    memcpy(s.length, length, (size_t)regge->edges * sizeof *length);
    status = solve(&s, &found);
  }
  if (status == DVI_OK) memcpy(length, s.length, (size_t)regge->edges * sizeof *length);
  if (report != NULL) *report = found;
  clear(&s);
  return status;
}
