/* Stationary lengths, where the gradient g(l) of the action vanishes for the lengths that are not
 * held.
 *
 * Newton's method with the sparse Hessian H, which is indefinite, and singular near flat solutions,
 * because the moves of an inner vertex change nothing. The step of least norm
 *
 *     d = -H (H^2 + delta^2)^{-1} g = -Re (H + i delta)^{-1} g
 *
 * (Tikhonov's, from one complex factor) has no part in the null directions, and is Newton's step in
 * those whose eigenvalues are large beside delta. |g|^2 falls along it, so that it is halved until
 * |g| falls and all simplices exist. The null directions are counted by
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

enum { ITERATIONS = 60, HALVINGS = 30 };

/* The least delta beside the largest entry of H. Roundings of solutions are 1e-16/1e-7 of a
 * step. */
static const double shift_part = 1e-7;

/* |g| that is no larger beside the sizes of its terms is roundoff: an angle has an error of a
 * rounding, and some ten of them meet at a hinge. */
static const double roundoff = 16 * DBL_EPSILON;

static const double pi = 3.14159265358979323846;

/* If |g| falls no more, it may be as large as this beside its terms, as in thin simplices. */
static const double floor_part = 1e-11;

/* If a whole step leaves more than this part of |g|, directions are soft that are not null, and the
 * next steps are damped less. */
static const double slow = 0.5, relief = 0.01;

/* A step must let |g| fall by this part of what Newton's method promises. */
static const double least_fall = 1e-4;

typedef struct search {
  const dvi_regge *regge;
  int64_t unknowns;
  int *unknown; /* [edges] the number of the unknown, or -1 for lengths that are held */
  int *edge;    /* [unknowns] */
  dvi__pattern pattern;
  int64_t *place; /* [entries of pattern] in the complex's pattern */
  dvi__linear *linear;
  double *value;          /* [2*entries of pattern] H + i delta */
  double *rhs;            /* [2*unknowns] */
  double *length, *trial; /* [edges] */
  dvi__regge_sums sums;
  double delta, damping;
  int is_least;   /* delta is the least one */
  int scale_sign; /* 1, but without held lengths and with Lambda that of the square of the scale */
  double size, terms; /* |g|, and that of the sizes of its terms */
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
  const int64_t entries = s->pattern.start[s->unknowns];
  s->value = DVI_NEW(double, 2 * entries);
  s->rhs = DVI_NEW(double, 2 * s->unknowns);
  s->length = DVI_NEW(double, r->edges);
  s->trial = DVI_NEW(double, r->edges);
  s->sums.deficit = DVI_NEW(double, r->hinges);
  s->sums.size = DVI_NEW(double, r->hinges);
  s->sums.gradient = DVI_NEW(double, r->edges);
  s->sums.terms = DVI_NEW(double, r->edges);
  s->sums.hessian = DVI_NEW(double, r->pattern.start[r->edges]);
  if (s->value == NULL || s->rhs == NULL || s->length == NULL || s->trial == NULL ||
      s->sums.deficit == NULL || s->sums.size == NULL || s->sums.gradient == NULL ||
      s->sums.terms == NULL || s->sums.hessian == NULL)
    return no_memory();
  return dvi__linear_create(&s->pattern, DVI__LINEAR_COMPLEX, NULL, &s->linear);
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
  dvi__linear_destroy(&s->linear);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->unknown);
  dvi__release(s->edge);
  dvi__release(s->place);
  dvi__release(s->value);
  dvi__release(s->rhs);
  dvi__release(s->length);
  dvi__release(s->trial);
  dvi__release(s->sums.deficit);
  dvi__release(s->sums.size);
  dvi__release(s->sums.gradient);
  dvi__release(s->sums.terms);
  dvi__release(s->sums.hessian);
}

/* ---- the iteration ---- */

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
static dvi_status evaluate(search *s, const double *length, int all)
{
  dvi__regge_sums sums = s->sums;
  if (!all) sums.hessian = NULL;
  DVI_TRY(dvi__regge_evaluate(s->regge, length, &sums));
  s->sums.action = sums.action;
  s->sums.volume = sums.volume;
  s->size = norm(s, sums.gradient);
  s->terms = norm(s, sums.terms);
  return DVI_OK;
}

/* Give the root of the mean square of the unknown lengths. */
static double typical_length(const search *s)
{
  return norm(s, s->length) / sqrt((double)s->unknowns);
}

/* Factor H + i delta, with delta^2 = damping |H| |g|/l, where l is a typical length, or a multiple
 * of the least delta. */
static dvi_status factor(search *s, double gradient, double multiple)
{
  const int entries = s->pattern.start[s->unknowns];
  double most = 0;
  for (int i = 0; i < entries; i++) most = fmax(most, fabs(s->sums.hessian[s->place[i]]));
  if (most == 0) return dvi__fail(DVI_SINGULAR, "regge: the Hessian of the action vanishes");
  const double least = multiple * shift_part * most,
               delta = most * sqrt(s->damping * (gradient / typical_length(s) / most));
  s->is_least = delta <= least;
  s->delta = fmax(delta, least);
  for (int64_t u = 0; u < s->unknowns; u++)
    for (int i = s->pattern.start[u]; i < s->pattern.start[u + 1]; i++) {
      s->value[2 * i] = s->sums.hessian[s->place[i]];
      s->value[2 * i + 1] = s->pattern.row[i] == u ? s->delta : 0;
    }
  return dvi__linear_factor(s->linear, s->value);
}

/* Set rhs to (H + i delta)^{-1} g, whose real parts are minus the step. */
static dvi_status find_step(search *s)
{
  for (int64_t u = 0; u < s->unknowns; u++) {
    s->rhs[2 * u] = s->sums.gradient[s->edge[u]];
    s->rhs[2 * u + 1] = 0;
  }
  return dvi__linear_solve(s->linear, s->rhs);
}

/* Halve the step until |g| falls. Tells whether it does, and keeps the last refusal of lengths in
 * *refused. Of a whole step, which most are, the Hessian is computed beside the gradient. */
static dvi_status search_line(search *s, int *falls, dvi_status *refused)
{
  const double before = s->size;
  double part = 1;
  *refused = DVI_OK;
  for (int i = 0; i < HALVINGS; i++, part /= 2) {
    memcpy(s->trial, s->length, (size_t)s->regge->edges * sizeof *s->trial);
    for (int64_t u = 0; u < s->unknowns; u++) s->trial[s->edge[u]] -= part * s->rhs[2 * u];
    const dvi_status status = evaluate(s, s->trial, i == 0);
    if (status == DVI_BAD_ARGUMENT) *refused = status;
    if (status != DVI_OK && status != DVI_BAD_ARGUMENT) return status;
    *falls = status == DVI_OK && s->size < (1 - least_fall * part) * before;
    if (!*falls) continue;
    if (i == 0 && s->size > slow * before) s->damping *= relief;
    memcpy(s->length, s->trial, (size_t)s->regge->edges * sizeof *s->trial);
    return i == 0 ? DVI_OK : evaluate(s, s->length, 1);
  }
  s->damping *= relief;
  return evaluate(s, s->length, 1);
}

/* Without held lengths the sum of l_e dS/dl_e is (n-2) sum |h| eps - n Lambda V. */
static const char *remedy(const search *s)
{
  const double lambda = s->regge->lambda;
  if (s->unknowns == s->regge->edges && lambda == 0)
    return "without Lambda and without held lengths only S = 0 is stationary";
  if (s->unknowns == s->regge->edges && s->scale_sign <= 0)
    return "without held lengths (n-2) sum |h| eps = n Lambda V, and the guess has no size for "
           "which both are equal";
  if (lambda != 0 && s->unknowns < s->regge->edges)
    return "start from lengths nearer to a solution, such as that of another Lambda, because with "
           "Lambda moves of inner vertices are only nearly free";
  return "start from lengths nearer to a solution";
}

static dvi_status refuse(const search *s, int iterations, dvi_status refused)
{
  if (refused == DVI_OK || s->scale_sign <= 0)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "regge: Newton's method left a gradient of %.2g (iterations: %d): %s", s->size,
                     iterations, remedy(s));
  return dvi__fail_in(DVI_NOT_CONVERGED,
                      "regge: Newton's method left a gradient of %.2g (iterations: %d): %s; its "
                      "next step leads to lengths that do not exist",
                      s->size, iterations, remedy(s));
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

static dvi_status iterate(search *s, int most, int *iterations)
{
  dvi_status refused = DVI_OK;
  int falls = 1;
  DVI_TRY(choose_scale(s));
  DVI_TRY(evaluate(s, s->length, 1));
  for (*iterations = 0;
       s->size > roundoff * s->terms && (falls || !s->is_least) && *iterations < most;
       ++*iterations) {
    DVI_TRY(factor(s, s->size, 1));
    DVI_TRY(find_step(s));
    DVI_TRY(search_line(s, &falls, &refused));
  }
  if (s->size <= floor_part * s->terms && !is_collapsed(s)) return DVI_OK;
  return refuse(s, *iterations, refused);
}

/* ---- the report ---- */

/* Compare the determinants at delta and at 2 delta. */
static dvi_status count_null(search *s, double *sum)
{
  DVI_TRY(factor(s, 0, 1));
  const double before = dvi__linear_log_determinant(s->linear);
  DVI_TRY(factor(s, 0, 2));
  *sum = (dvi__linear_log_determinant(s->linear) - before) / log(2);
  return DVI_OK;
}

static dvi_status solve(search *s, const dvi_regge_options *options, dvi_regge_report *report)
{
  const int most = options->iterations > 0 ? options->iterations : ITERATIONS;
  const dvi_status status = iterate(s, most, &report->iterations);
  report->action = s->sums.action;
  report->unknowns = s->unknowns;
  for (int64_t u = 0; u < s->unknowns; u++)
    report->residual = fmax(report->residual, fabs(s->sums.gradient[s->edge[u]]));
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
  search s = {.regge = regge, .damping = 1, .scale_sign = 1};
  dvi_status status = prepare(&s, options->held);
  if (status == DVI_OK) {
    memcpy(s.length, length, (size_t)regge->edges * sizeof *length);
    status = solve(&s, options, &found);
  }
  if (status == DVI_OK) memcpy(length, s.length, (size_t)regge->edges * sizeof *length);
  if (report != NULL) *report = found;
  clear(&s);
  return status;
}
