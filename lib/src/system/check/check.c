/* The derivative check: every gradient against differences of the values, every Hessian and pattern
 * against differences of the gradients, one column at a time; every gradient by ranges against the
 * whole one; then what is said about time. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/check/check_quadratic.h"
#include "system/check/check_taylor.h"
#include "system/check/check_time.h"
#include "system/term/difference.h"
#include "system/evaluate/dynamics.h"
#include "system/term/constraint.h"

/* One entry at which callback and difference disagree. */
typedef struct disagreement {
  /* beyond the differences' own noise; while a block is compared absolute, then relative to its
   * largest entry */
  double error;
  double given, differenced;
  int row, column;
} disagreement;

/* The worst of one kind over all blocks, and whose it is. */
typedef struct finding {
  disagreement worst;
  const char *term, *owner, *block;
  int constraint;
} finding;

/* One block of one term while it is compared. */
typedef struct block {
  /* whose: that potential, or else that part of the kinetic one, or else the whole of it */
  const char *term, *owner, *name;
  const dvi__pattern *pattern; /* NULL: a gradient */
  const double *given;         /* NULL: no callback, only the pattern is checked */
  double largest;              /* magnitude of its entries, given or differenced */
  disagreement on_pattern, outside;
} block;

/* The first gradient_range that breaks its promise: coordinate `row` (-1: none) of the range from
 * first to last-1. */
typedef struct broken_range {
  const dvi__potential_term *term;
  /* outside: 0, or -1 and 1 if it writes before its first and behind its last coordinate */
  int row, outside, first, last;
  double whole, part;
} broken_range;

typedef struct check {
  const char *kinetic; /* what holds the velocities or momenta */
  int constraint;      /* 1 more than the number of the one that is compared; 0: none is */
  dvi__scratch scratch;
  dvi__differences differences;
  int n;
  double t;
  const double *q, *v;
  double *gradient[2], *column[2]; /* [n] */
  double *hessian[3];              /* as long as the longest pattern */
  double gradient_noise;           /* of the term at hand */
  finding of_gradient, of_hessian, of_pattern;
  broken_range range;
} check;

static void compare(block *b, int row, int column, double given, double differenced, double noise,
                    disagreement *worst)
{
  const double error = fabs(given - differenced) - noise;
  b->largest = fmax(b->largest, fmax(fabs(given), fabs(differenced)));
  if (error > worst->error) *worst = (disagreement){error, given, differenced, row, column};
}

static void keep_worst(const check *c, const block *b, const disagreement *found, finding *kept)
{
  const double error = found->error > 0 ? found->error / b->largest : 0;
  if (error <= kept->worst.error) return;
  *kept = (finding){.worst = *found,
                    .term = b->term,
                    .owner = b->owner,
                    .block = b->name,
                    .constraint = c->constraint};
  kept->worst.error = error;
}

/* What roundoff in values as large as `magnitude` does to a difference over the step. */
static double noise_of(double magnitude, double step)
{
  return 64 * DBL_EPSILON * magnitude / step;
}

/* Terms of the values may cancel in a gradient, and leave their rounding over the size of x, which
 * is some hundred steps. */
static double cancellation_of(double magnitude, double step)
{
  return noise_of(magnitude, 128 * step);
}

static double max_norm(int n, const double *x)
{
  double norm = 0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(x[i]));
  return norm;
}

/* ---- gradients ---- */

static dvi_status check_gradient(check *c, dvi__batch_value value, const void *function,
                                 const double *x, const double *given, const char *term,
                                 const char *name)
{
  block b = {.term = term, .name = name};
  const dvi__differences *d = &c->differences;
  DVI_TRY(dvi__difference_gradient(value, function, &c->differences, c->n, 1, x, c->column[0]));
  const double magnitude = fmax(fabs(d->plus[0]), fabs(d->minus[0]));
  for (int i = 0; i < c->n; i++) {
    compare(&b, i, -1, given[i], c->column[0][i], noise_of(magnitude, d->step[i]), &b.on_pattern);
    c->gradient_noise = fmax(c->gradient_noise, cancellation_of(magnitude, d->step[i]));
  }
  keep_worst(c, &b, &b.on_pattern, &c->of_gradient);
  return DVI_OK;
}

/* For a term without a gradient callback. */
static dvi_status measure_noise(check *c, dvi__batch_value value, const void *function,
                                const double *x)
{
  const dvi__differences *d = &c->differences;
  DVI_TRY(dvi__difference_gradient(value, function, &c->differences, c->n, 1, x, c->column[0]));
  const double magnitude = fmax(fabs(d->plus[0]), fabs(d->minus[0]));
  for (int i = 0; i < c->n; i++)
    c->gradient_noise = fmax(c->gradient_noise, noise_of(magnitude, d->step[i]));
  return DVI_OK;
}

/* ---- gradients by ranges ---- */

/* Copy the coordinates that the range may look at from `from` (NULL: NaN for all of them) to
 * `to`. */
static void expose(const check *c, int reach, int first, int last, const double *from, double *to)
{
  const int begin = first > reach ? first - reach : 0,
            end = last < c->n - reach ? last + reach : c->n;
  for (int i = begin; i < end; i++) to[i] = from != NULL ? from[i] : (double)NAN;
}

/* Zeros of two signs differ here, too. */
static int same_bits(double a, double b)
{
  uint64_t bits_of_a, bits_of_b;
  memcpy(&bits_of_a, &a, sizeof a);
  memcpy(&bits_of_b, &b, sizeof b);
  return bits_of_a == bits_of_b;
}

/* One range, asked for with NaN beyond its reach and on both sides of it, against the whole
 * gradient. `hidden` holds NaN before and after. */
static dvi_status compare_range(check *c, const dvi__potential_term *p, int first, int last,
                                const double *whole, double *hidden)
{
  const dvi_potential *asked = &p->callbacks;
  double *part = c->column[1] + 1;
  const int count = last - first;
  for (int i = -1; i <= count; i++) part[i] = (double)NAN;
  expose(c, asked->reach, first, last, c->q, hidden);
  const int returned = asked->gradient_range(c->t, hidden, first, last, part, asked->user);
  expose(c, asked->reach, first, last, NULL, hidden);
  if (returned != 0)
    return dvi__fail(
        returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
        "system check: %s: the gradient_range callback returned %d for coordinates %d to %d",
        p->name, returned, first, last - 1);
  for (int i = 0; i < count && c->range.row < 0; i++)
    if (!same_bits(whole[first + i], part[i]))
      c->range = (broken_range){p, first + i, 0, first, last, whole[first + i], part[i]};
  if (c->range.row < 0 && !isnan(part[count]))
    c->range = (broken_range){.term = p, .row = last, .outside = 1, .first = first, .last = last};
  if (c->range.row < 0 && !isnan(part[-1]))
    c->range = (broken_range){.term = p, .row = first, .outside = -1, .first = first, .last = last};
  return DVI_OK;
}

/* Ranges of one coordinate, of three, of half of them and one more, and of all. */
static dvi_status check_ranges(check *c, const dvi__potential_term *p, const double *whole)
{
  const int lengths[] = {1, 3, c->n / 2 + 1, c->n};
  double *hidden = c->column[0];
  for (int i = 0; i < c->n; i++) hidden[i] = (double)NAN;
  for (int k = 0; k < 4 && c->range.row < 0; k++)
    for (int first = 0; first < c->n; first += lengths[k])
      DVI_TRY(compare_range(c, p, first, lengths[k] < c->n - first ? first + lengths[k] : c->n,
                            whole, hidden));
  return DVI_OK;
}

/* ---- Hessians and patterns ---- */

static void compare_column(block *b, int n, int j, const double *differenced, double noise)
{
  int e = b->pattern->start[j];
  for (int i = 0; i < n; i++) {
    const int declared = e < b->pattern->start[j + 1] && b->pattern->row[e] == i;
    if (!declared)
      compare(b, i, j, 0, differenced[i], noise, &b->outside);
    else if (b->given != NULL)
      compare(b, i, j, b->given[e], differenced[i], noise, &b->on_pattern);
    else
      b->largest = fmax(b->largest, fabs(differenced[i]));
    e += declared;
  }
}

/* One or two blocks whose columns belong to the same variable x; the second may be NULL. */
static dvi_status check_blocks(check *c, dvi__batch_gradient gradient, const void *function,
                               const double *x, block *first, block *second)
{
  const dvi__differences *d = &c->differences;
  for (int j = 0; j < c->n; j++) {
    DVI_TRY(dvi__difference_column(gradient, function, &c->differences, c->n, j, x, c->column[0],
                                   c->column[1]));
    compare_column(first, c->n, j, c->column[0],
                   (noise_of(max_norm(c->n, d->plus), 1) + c->gradient_noise) / d->step[j]);
    if (second == NULL) continue;
    compare_column(second, c->n, j, c->column[1],
                   (noise_of(max_norm(c->n, d->plus_v), 1) + c->gradient_noise) / d->step[j]);
  }
  for (block *b = first; b != NULL; b = b == first ? second : NULL) {
    keep_worst(c, b, &b->on_pattern, &c->of_hessian);
    keep_worst(c, b, &b->outside, &c->of_pattern);
  }
  return DVI_OK;
}

/* ---- terms ---- */

static dvi_status check_potential(check *c, const dvi__potential_term *p)
{
  const dvi__potential_at at = {p, &c->scratch, &c->t};
  const int has_gradient = dvi__potential_has_gradient(p),
            has_hessian = dvi__potential_has_hessian(p);
  block qq = {.term = p->name,
              .name = "d2V/dq2",
              .pattern = &p->qq,
              .given = has_hessian ? c->hessian[0] : NULL};
  c->gradient_noise = 0;
  if (has_gradient) {
    DVI_TRY(dvi__potential_gradient(p, &c->scratch, 1, &c->t, c->q, c->gradient[0]));
    DVI_TRY(
        check_gradient(c, dvi__potential_value_of_q, &at, c->q, c->gradient[0], p->name, "dV/dq"));
    if (p->callbacks.gradient_range != NULL) DVI_TRY(check_ranges(c, p, c->gradient[0]));
  } else {
    DVI_TRY(measure_noise(c, dvi__potential_value_of_q, &at, c->q));
  }
  if (has_hessian) DVI_TRY(dvi__potential_hessian(p, &c->scratch, 1, &c->t, c->q, c->hessian[0]));
  return check_blocks(c, dvi__potential_gradient_of_q, &at, c->q, &qq, NULL);
}

/* Of L, of H, of a constraint: the derivatives in q and v, or q and p. */
typedef struct names {
  const char *q, *v, *qq, *qv, *vv;
} names;

static const names of_lagrangian = {"dL/dq", "dL/dv", "d2L/dq2", "d2L/dqdv", "d2L/dv2"},
                   of_hamiltonian = {"dH/dq", "dH/dp", "d2H/dq2", "d2H/dqdp", "d2H/dp2"},
                   of_constraint = {"dphi/dq", "dphi/dp", "d2phi/dq2", "d2phi/dqdp", "d2phi/dp2"};

static dvi_status check_general(check *c, const dvi__lagrangian_term *l, const names *name)
{
  const dvi__general_at at = {l, &c->scratch, &c->t, c->q, c->v};
  const int has_hessian = dvi__general_has_hessian(l);
  block qq = {.name = name->qq, .pattern = &l->qq, .given = has_hessian ? c->hessian[0] : NULL};
  block qv = {.name = name->qv, .pattern = &l->qv, .given = has_hessian ? c->hessian[1] : NULL};
  block vv = {.name = name->vv, .pattern = &l->vv, .given = has_hessian ? c->hessian[2] : NULL};
  c->gradient_noise = 0;
  if (dvi__general_has_gradient(l)) {
    DVI_TRY(dvi__general_gradient(l, &c->scratch, 1, &c->t, c->q, c->v, c->gradient[0],
                                  c->gradient[1]));
    DVI_TRY(check_gradient(c, dvi__general_value_of_q, &at, c->q, c->gradient[0], NULL, name->q));
    DVI_TRY(check_gradient(c, dvi__general_value_of_v, &at, c->v, c->gradient[1], NULL, name->v));
  } else {
    DVI_TRY(measure_noise(c, dvi__general_value_of_q, &at, c->q));
    DVI_TRY(measure_noise(c, dvi__general_value_of_v, &at, c->v));
  }
  if (has_hessian)
    DVI_TRY(dvi__general_hessian(l, &c->scratch, 1, &c->t, c->q, c->v, c->hessian[0], c->hessian[1],
                                 c->hessian[2]));
  DVI_TRY(check_blocks(c, dvi__general_gradient_of_q, &at, c->q, &qq, NULL));
  return check_blocks(c, dvi__general_gradient_of_v, &at, c->v, &qv, &vv);
}

/* The derivatives of all components in q_i, against row i of the gradients. */
static void compare_row(block *b, int n, int i, const double *differenced, double noise)
{
  for (int j = 0; j < n; j++) {
    const int e = dvi__pattern_find(b->pattern, i, j);
    compare(b, i, j, e >= 0 ? b->given[e] : 0, differenced[j], noise,
            e >= 0 ? &b->on_pattern : &b->outside);
  }
}

/* Of one one-form, which has no gauge: its gradients against differences of its components, its
 * Hessian against those of the gradients. */
static dvi_status check_form(check *c, const dvi__lagrangian_term *l, const char *owner,
                             const char *first, const char *second)
{
  const dvi__general_at at = {l, &c->scratch, &c->t, c->q, c->v};
  const dvi__differences *d = &c->differences;
  const int has_hessian = dvi__general_has_hessian(l);
  block qv = {.owner = owner, .name = first, .pattern = &l->qv, .given = c->hessian[1]};
  block qq = {.owner = owner,
              .name = second,
              .pattern = &l->qq,
              .given = has_hessian ? c->hessian[0] : NULL};
  DVI_TRY(dvi__form_gradients(l, c->q, c->hessian[1], c->scratch.result[2]));
  if (has_hessian)
    DVI_TRY(dvi__general_hessian(l, &c->scratch, 1, &c->t, c->q, c->v, c->hessian[0], c->hessian[1],
                                 c->hessian[2]));
  for (int i = 0; i < c->n; i++) {
    DVI_TRY(dvi__difference_column(dvi__general_gradient_of_q, &at, &c->differences, c->n, i, c->q,
                                   c->column[0], c->column[1]));
    compare_column(&qq, c->n, i, c->column[0], noise_of(max_norm(c->n, d->plus), d->step[i]));
    compare_row(&qv, c->n, i, c->column[1], noise_of(max_norm(c->n, d->plus_v), d->step[i]));
  }
  keep_worst(c, &qv, &qv.on_pattern, &c->of_gradient);
  keep_worst(c, &qv, &qv.outside, &c->of_pattern);
  keep_worst(c, &qq, &qq.on_pattern, &c->of_hessian);
  keep_worst(c, &qq, &qq.outside, &c->of_pattern);
  return DVI_OK;
}

/* A gauge adds grad f, which is a one-form, too: each is checked on its own. The whole comes first:
 * if a callback fails it says whose. */
static dvi_status check_one_form(check *c, const dvi__lagrangian_term *l)
{
  const dvi__gauge_term *g = &l->gauge;
  const dvi_gauge *f = &g->callbacks;
  const char *const gradients = "d alpha_j/dq_i at (i,j) =", *const hessian = "d2(alpha.v)/dq2";
  dvi__lagrangian_term part = *l;
  c->gradient_noise = 0;
  if (f->gradient == NULL) return check_form(c, l, "one-form", gradients, hessian);
  DVI_TRY(
      dvi__general_gradient(l, &c->scratch, 1, &c->t, c->q, c->v, c->gradient[0], c->gradient[1]));
  part.gauge = (dvi__gauge_term){0};
  part.qv = g->form_qv;
  part.qq = g->form_qq;
  DVI_TRY(check_form(c, &part, "one-form", gradients, hessian));
  part.one_form = (dvi_one_form){
      .value = f->gradient, .gradient = f->hessian, .hessian = f->third, .user = f->user};
  part.qv = g->qq;
  part.qq = g->qq;
  return check_form(c, &part, "gauge", "d2f/dq2", "d2(grad f.v)/dq2");
}

/* An entry outside of the gradients' pattern is a wrong 0 of the gradient. */
static dvi_status check_weighted(check *c, dvi__weighted *weighted, double *w, int count)
{
  weighted->w = w;
  for (int a = 0; a < count; a++) {
    w[a] = 1;
    c->constraint = a + 1;
    DVI_TRY(check_general(c, &weighted->term, &of_constraint));
    w[a] = 0;
  }
  c->constraint = 0;
  return DVI_OK;
}

static dvi_status check_constraint(check *c, const dvi_system *system)
{
  const int count = system->constraint->callbacks.count;
  dvi__weighted weighted;
  double *w = DVI_NEW(double, count);
  dvi_status status = dvi__weighted_open(system, &weighted);
  if (w == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "system check: no memory for %d constraints", count);
  if (status == DVI_OK) status = check_weighted(c, &weighted, w, count);
  dvi__weighted_close(&weighted);
  dvi__release(w);
  return status;
}

static dvi_status check_terms(check *c, const dvi_system *system)
{
  const names *name = system->dynamics->by_momentum ? &of_hamiltonian : &of_lagrangian;
  if (system->lagrangian != NULL)
    DVI_TRY(system->terms & DVI__ONE_FORM ? check_one_form(c, system->lagrangian)
                                          : check_general(c, system->lagrangian, name));
  if (system->constraint != NULL) DVI_TRY(check_constraint(c, system));
  for (int k = 0; k < system->potential_count; k++)
    DVI_TRY(check_potential(c, &system->potentials[k]));
  return DVI_OK;
}

/* Second derivatives that look wrong are looked at again over shorter steps: a high power, or a
 * singularity near by, bends within the others, but what is wrong is so over any, unless their
 * noise hides it: that of differenced gradients does soon. */
static dvi_status check_terms_closely(check *c, const dvi_system *system, double tolerance)
{
  DVI_TRY(check_terms(c, system));
  const finding hessian = c->of_hessian, pattern = c->of_pattern;
  const int shortest = dvi__lacks_gradient(system) ? 4 : 12;
  if (hessian.worst.error <= tolerance && pattern.worst.error <= tolerance) return DVI_OK;
  for (c->differences.shorter = 4; c->differences.shorter <= shortest;
       c->differences.shorter += 4) {
    c->of_hessian = c->of_pattern = (finding){.term = NULL};
    DVI_TRY(check_terms(c, system));
    if (c->of_hessian.worst.error <= tolerance && c->of_pattern.worst.error <= tolerance)
      return DVI_OK;
  }
  c->of_hessian = hessian;
  c->of_pattern = pattern;
  return DVI_OK;
}

/* ---- the report ---- */

static void name_entry(const finding *f, const char *kinetic, size_t size, char *text)
{
  char place[32], owner[48];
  (void)snprintf(owner, sizeof owner, "%s", f->owner != NULL ? f->owner : kinetic);
  if (f->term != NULL) (void)snprintf(owner, sizeof owner, "potential '%.24s'", f->term);
  if (f->constraint > 0) (void)snprintf(owner, sizeof owner, "constraint %d", f->constraint - 1);
  if (f->worst.column < 0)
    (void)snprintf(place, sizeof place, "(%d)", f->worst.row);
  else
    (void)snprintf(place, sizeof place, "(%d,%d)", f->worst.row, f->worst.column);
  (void)snprintf(text, size, "%s: %s %s", owner, f->block, place);
}

static dvi_status report_range(const broken_range *r, dvi_derivative_check *result)
{
  result->range_row = r->row;
  (void)snprintf(result->where, sizeof result->where,
                 "potential '%.24s': gradient_range (%d) is %s", r->term->name, r->row,
                 r->outside > 0   ? "written behind its range"
                 : r->outside < 0 ? "written before its range"
                                  : "not that of the whole");
  if (r->outside != 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "system check: potential '%.24s': gradient_range of coordinates %d to %d writes one %s",
        r->term->name, r->first, r->last - 1, r->outside > 0 ? "more" : "before them");
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: potential '%.24s': dV/dq (%d) is %.17g from gradient_range of "
                   "coordinates %d to %d, %.17g from the "
                   "whole gradient; is the reach %d too small?",
                   r->term->name, r->row, r->part, r->first, r->last - 1, r->whole,
                   r->term->callbacks.reach);
}

/* A wrong gradient makes its ranges and its Hessian look wrong too, so it is named first; then what
 * a pattern misses. */
static dvi_status report(const check *c, double tolerance, dvi_derivative_check *result)
{
  const finding *const hessian = c->of_pattern.worst.error > tolerance ? &c->of_pattern
                                                                       : &c->of_hessian;
  const finding *const worst = c->of_gradient.worst.error > tolerance ? &c->of_gradient : hessian;
  const int missing = worst == &c->of_pattern;
  char entry[128] = "";
  if (worst->block != NULL) name_entry(worst, c->kinetic, sizeof entry, entry);
  *result = (dvi_derivative_check){.gradient_error = c->of_gradient.worst.error,
                                   .hessian_error = c->of_hessian.worst.error,
                                   .outside = c->of_pattern.worst.error,
                                   .row = hessian->block != NULL ? hessian->worst.row : -1,
                                   .column = hessian->block != NULL ? hessian->worst.column : -1,
                                   .range_row = -1};
  if (c->range.row >= 0 && worst != &c->of_gradient) return report_range(&c->range, result);
  if (worst->worst.error <= tolerance) return DVI_OK;
  (void)snprintf(result->where, sizeof result->where, "%.70s %s", entry,
                 missing ? "is not in the pattern" : "is wrong");
  if (missing)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: %s is not in the pattern, but differences give %.15g", entry,
                     worst->worst.differenced);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: %s is %.15g from the callback, %.15g from differences", entry,
                   worst->worst.given, worst->worst.differenced);
}

/* ---- memory ---- */

static int longest_pattern(const dvi_system *system)
{
  const int vv = dvi__pattern_entries(&system->vv), qv = dvi__pattern_entries(&system->qv),
            qq = dvi__pattern_entries(&system->qq);
  const int longest = vv > qv ? vv : qv, terms = dvi__longest_hessian(system, 1),
            most = longest > terms ? longest : terms;
  return qq > most ? qq : most;
}

static dvi_status allocate(check *c, const dvi_system *system)
{
  DVI_TRY(dvi__system_prepare_hessian(system));
  DVI_TRY(dvi__scratch_create(system, 1, 1, &c->scratch));
  int complete = dvi__differences_allocate((size_t)c->n, &c->differences);
  for (int i = 0; i < 2; i++) {
    c->gradient[i] = DVI_NEW(double, c->n);
    /* two more show what is written around a range */
    c->column[i] = DVI_NEW(double, (size_t)c->n + 2);
    complete = complete && c->gradient[i] != NULL && c->column[i] != NULL;
  }
  for (int i = 0; i < 3; i++) {
    c->hessian[i] = DVI_NEW(double, longest_pattern(system));
    complete = complete && c->hessian[i] != NULL;
  }
  return complete ? DVI_OK
                  : dvi__fail(DVI_NO_MEMORY, "system check: no memory for %d dimensions", c->n);
}

static void clear(check *c)
{
  dvi__scratch_clear(&c->scratch);
  dvi__differences_clear(&c->differences);
  for (int i = 0; i < 2; i++) {
    dvi__release(c->gradient[i]);
    dvi__release(c->column[i]);
  }
  for (int i = 0; i < 3; i++) dvi__release(c->hessian[i]);
}

dvi_status dvi_system_check(const dvi_system *system, double t, const double *q, const double *v,
                            double tolerance, dvi_derivative_check *result)
{
  dvi_derivative_check unwanted, *const kept = result != NULL ? result : &unwanted;
  *kept = (dvi_derivative_check){.row = -1, .column = -1, .range_row = -1};
  if (system == NULL || q == NULL || v == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system check: an argument is NULL");
  if (!(tolerance >= 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "system check: tolerance %g; 0 or more is possible",
                     tolerance);
  if (!isfinite(t) || dvi__first_not_finite((size_t)system->n, q) >= 0 ||
      dvi__first_not_finite((size_t)system->nv, v) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "system check: the point (t = %g) is not finite", t);
  const double accepted = tolerance > 0 ? tolerance : 1e-6;
  check c = {.kinetic = system->lagrangian != NULL ? system->lagrangian->name : "Lagrangian",
             .n = system->n,
             .t = t,
             .q = q,
             .v = v,
             .range.row = -1};
  dvi_status status = allocate(&c, system);
  if (status == DVI_OK) status = check_terms_closely(&c, system, accepted);
  if (status == DVI_OK) status = report(&c, accepted, kept);
  if (status == DVI_OK) status = dvi__check_quadratic(system, &c.scratch, t, q, accepted, kept);
  if (status == DVI_OK)
    status = dvi__check_time(system, &c.scratch, &c.differences, t, q, v, accepted, kept);
  if (status == DVI_OK) status = dvi__check_taylor(system, &c.scratch, t, q, v, accepted, kept);
  clear(&c);
  return status;
}
