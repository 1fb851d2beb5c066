/* The derivative check. Every gradient is compared with differences of the values. Every Hessian
 * and pattern is compared with differences of the gradients, one column at a time. Every gradient
 * by ranges is compared with the whole gradient. Declarations about time follow. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/check/check_quadratic.h"
#include "system/check/check_rows.h"
#include "system/check/check_struct.h"
#include "system/check/check_taylor.h"
#include "system/check/check_time.h"
#include "system/evaluate/dynamics.h"
#include "system/term/constraint.h"
#include "system/term/force.h"
#include "system/term/holonomic.h"
#include "system/term/nonholonomic.h"
#include "system/term/vector.h"

/* One block of one term while it is compared. */
typedef struct block {
  /* term is the name of a potential, or of a force, or NULL, owner a part of the kinetic term or
   * NULL for all. */
  const char *term, *owner, *name;
  const char *kind;            /* of a named term */
  const dvi__pattern *pattern; /* NULL for a gradient */
  const double *given;         /* NULL without a callback, where only the pattern is checked */
  double largest;              /* largest magnitude of its entries, given or differenced */
  dvi__disagreement on_pattern, outside;
} block;

static void compare_entry(block *b, int row, int column, double given, double differenced,
                          double noise, dvi__disagreement *worst)
{
  const double error = fabs(given - differenced) - noise;
  b->largest = fmax(b->largest, fmax(fabs(given), fabs(differenced)));
  if (error > worst->error)
    *worst = (dvi__disagreement){
        .error = error, .given = given, .differenced = differenced, .row = row, .column = column};
}

static void keep_worst(const dvi__check *c, const block *b, const dvi__disagreement *found,
                       dvi__finding *kept)
{
  const double error = found->error > 0 ? found->error / b->largest : 0;
  if (error <= kept->worst.error) return;
  *kept = (dvi__finding){.worst = *found,
                         .term = b->term,
                         .owner = b->owner,
                         .block = b->name,
                         .kind = b->kind,
                         .constraint = c->constraint};
  kept->worst.error = error;
}

/* Estimate the effect on a difference over the step of roundoff in values as large as
 * `magnitude`. */
static double noise_of(double magnitude, double step)
{
  return 64 * DBL_EPSILON * magnitude / step;
}

/* Estimate the roundoff of terms that cancel in a gradient. Terms of the values leave their
 * rounding over the size of x, which is some hundred steps. */
static double cancellation_of(double magnitude, double step)
{
  return noise_of(magnitude, 128 * step);
}

static double largest_component(int n, const double *x)
{
  double norm = 0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(x[i]));
  return norm;
}

/* ---- gradients ---- */

/* Measure the roundoff of values near x, which is above that of their size where terms cancel
 * within a callback. Fourth differences over small parts of the steps have nothing else in them. */
static dvi_status measure_roundoff(dvi__check *c, dvi__batch_value value, const void *function,
                                   const double *x, double *roundoff)
{
  enum { TRIES = 4, PARTS = 64 };
  static const double weight[5] = {1, -4, 6, -4, 1}; /* the sum of their squares is near 8^2 */
  const dvi__differences *d = &c->differences;
  *roundoff = 0;
  for (int k = 0; k < TRIES; k++) {
    double difference = 0, V;
    for (int m = 0; m < 5; m++) {
      for (int i = 0; i < c->n; i++)
        d->moved[i] = x[i] + (m - 2) * ((i + k) % 3 - 1) * d->step[i] / (PARTS + k);
      DVI_TRY(value(function, 1, d->moved, &V));
      difference += weight[m] * V;
    }
    *roundoff = fmax(*roundoff, fabs(difference) / 8);
  }
  return DVI_OK;
}

/* Give the magnitude of values whose rounding explains that of the values near x. */
static dvi_status find_magnitude(dvi__check *c, dvi__batch_value value, const void *function,
                                 const double *x, double *magnitude)
{
  const dvi__differences *d = &c->differences;
  double roundoff;
  *magnitude = fmax(fabs(d->plus[0]), fabs(d->minus[0]));
  DVI_TRY(measure_roundoff(c, value, function, x, &roundoff));
  *magnitude = fmax(*magnitude, roundoff / (8 * DBL_EPSILON));
  return DVI_OK;
}

static dvi_status check_gradient(dvi__check *c, dvi__batch_value value, const void *function,
                                 const double *x, const double *given, const char *term,
                                 const char *name)
{
  block b = {.term = term, .kind = "potential", .name = name};
  const dvi__differences *d = &c->differences;
  DVI_TRY(dvi__difference_gradient(value, function, &c->differences, c->n, 1, x, c->column[0]));
  double magnitude;
  DVI_TRY(find_magnitude(c, value, function, x, &magnitude));
  for (int i = 0; i < c->n; i++) {
    compare_entry(&b, i, -1, given[i], c->column[0][i], noise_of(magnitude, d->step[i]),
                  &b.on_pattern);
    c->gradient_noise = fmax(c->gradient_noise, cancellation_of(magnitude, d->step[i]));
  }
  keep_worst(c, &b, &b.on_pattern, &c->of_gradient);
  return DVI_OK;
}

/* Measure the noise of a term without a gradient callback. */
static dvi_status measure_gradient_noise(dvi__check *c, dvi__batch_value value,
                                         const void *function, const double *x)
{
  const dvi__differences *d = &c->differences;
  DVI_TRY(dvi__difference_gradient(value, function, &c->differences, c->n, 1, x, c->column[0]));
  double magnitude;
  DVI_TRY(find_magnitude(c, value, function, x, &magnitude));
  for (int i = 0; i < c->n; i++)
    c->gradient_noise = fmax(c->gradient_noise, noise_of(magnitude, d->step[i]));
  return DVI_OK;
}

/* ---- Hessians and patterns ---- */

static void compare_column(block *b, int n, int j, const double *differenced, double noise)
{
  int e = b->pattern->start[j];
  for (int i = 0; i < n; i++) {
    const int declared = e < b->pattern->start[j + 1] && b->pattern->row[e] == i;
    if (!declared)
      compare_entry(b, i, j, 0, differenced[i], noise, &b->outside);
    else if (b->given != NULL)
      compare_entry(b, i, j, b->given[e], differenced[i], noise, &b->on_pattern);
    else
      b->largest = fmax(b->largest, fabs(differenced[i]));
    e += declared;
  }
}

/* Check one or two blocks whose columns belong to the same variable x. The second may be NULL. */
static dvi_status check_blocks(dvi__check *c, dvi__batch_gradient gradient, const void *function,
                               const double *x, block *first, block *second)
{
  const dvi__differences *d = &c->differences;
  for (int j = 0; j < c->n; j++) {
    DVI_TRY(dvi__difference_column(gradient, function, &c->differences, c->n, j, x, c->column[0],
                                   c->column[1]));
    compare_column(first, c->n, j, c->column[0],
                   (noise_of(largest_component(c->n, d->plus), 1) + c->gradient_noise) /
                       d->step[j]);
    if (second == NULL) continue;
    compare_column(second, c->n, j, c->column[1],
                   (noise_of(largest_component(c->n, d->plus_v), 1) + c->gradient_noise) /
                       d->step[j]);
  }
  for (block *b = first; b != NULL; b = b == first ? second : NULL) {
    keep_worst(c, b, &b->on_pattern, &c->of_hessian);
    keep_worst(c, b, &b->outside, &c->of_pattern);
  }
  return DVI_OK;
}

/* ---- terms ---- */

static dvi_status check_potential(dvi__check *c, const dvi__potential_term *p)
{
  const dvi__potential_at at = {.term = p, .scratch = &c->scratch, .t = &c->t};
  const int has_gradient = dvi__potential_has_gradient(p),
            has_hessian = dvi__potential_has_hessian(p);
  block qq = {.term = p->name,
              .kind = "potential",
              .name = "d2V/dq2",
              .pattern = &p->qq,
              .given = has_hessian ? c->hessian[0] : NULL};
  c->gradient_noise = 0;
  if (has_gradient) {
    DVI_TRY(dvi__potential_gradient(p, &c->scratch, 1, &c->t, c->q, c->gradient[0]));
    DVI_TRY(
        check_gradient(c, dvi__potential_value_of_q, &at, c->q, c->gradient[0], p->name, "dV/dq"));
    if (p->callbacks.gradient_range != NULL) DVI_TRY(dvi__check_ranges(c, p, c->gradient[0]));
  } else {
    DVI_TRY(measure_gradient_noise(c, dvi__potential_value_of_q, &at, c->q));
  }
  if (p->callbacks.without_hessian) return DVI_OK;
  if (has_hessian) DVI_TRY(dvi__potential_hessian(p, &c->scratch, 1, &c->t, c->q, c->hessian[0]));
  return check_blocks(c, dvi__potential_gradient_of_q, &at, c->q, &qq, NULL);
}

/* Names of the derivatives in q and v, or q and p, of L, of H, or of a constraint. */
typedef struct names {
  const char *q, *v, *qq, *qv, *vv;
} names;

static const names of_lagrangian = {"dL/dq", "dL/dv", "d2L/dq2", "d2L/dqdv", "d2L/dv2"},
                   of_hamiltonian = {"dH/dq", "dH/dp", "d2H/dq2", "d2H/dqdp", "d2H/dp2"},
                   of_constraint = {"dphi/dq", "dphi/dp", "d2phi/dq2", "d2phi/dqdp", "d2phi/dp2"};

static dvi_status check_general(dvi__check *c, const dvi__lagrangian_term *l, const names *name)
{
  const dvi__general_at at = {.term = l, .scratch = &c->scratch, .t = &c->t, .q = c->q, .v = c->v};
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
    DVI_TRY(measure_gradient_noise(c, dvi__general_value_of_q, &at, c->q));
    DVI_TRY(measure_gradient_noise(c, dvi__general_value_of_v, &at, c->v));
  }
  if (has_hessian)
    DVI_TRY(dvi__general_hessian(l, &c->scratch, 1, &c->t, c->q, c->v, c->hessian[0], c->hessian[1],
                                 c->hessian[2]));
  DVI_TRY(check_blocks(c, dvi__general_gradient_of_q, &at, c->q, &qq, NULL));
  return check_blocks(c, dvi__general_gradient_of_v, &at, c->v, &qv, &vv);
}

/* Compare the derivatives of all components in q_i with row i of the gradients. */
static void compare_row(block *b, int n, int i, const double *differenced, double noise)
{
  for (int j = 0; j < n; j++) {
    const int e = dvi__pattern_find(b->pattern, i, j);
    compare_entry(b, i, j, e >= 0 ? b->given[e] : 0, differenced[j], noise,
                  e >= 0 ? &b->on_pattern : &b->outside);
  }
}

/* Check one one-form without a gauge. Its gradients are compared with differences of its
 * components, its Hessian with those of the gradients. */
static dvi_status check_form_derivatives(dvi__check *c, const dvi__lagrangian_term *l,
                                         const char *owner, const char *first, const char *second)
{
  const dvi__general_at at = {.term = l, .scratch = &c->scratch, .t = &c->t, .q = c->q, .v = c->v};
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
    compare_column(&qq, c->n, i, c->column[0],
                   noise_of(largest_component(c->n, d->plus), d->step[i]));
    compare_row(&qv, c->n, i, c->column[1],
                noise_of(largest_component(c->n, d->plus_v), d->step[i]));
  }
  keep_worst(c, &qv, &qv.on_pattern, &c->of_gradient);
  keep_worst(c, &qv, &qv.outside, &c->of_pattern);
  keep_worst(c, &qq, &qq.on_pattern, &c->of_hessian);
  keep_worst(c, &qq, &qq.outside, &c->of_pattern);
  return DVI_OK;
}

/* Check a one-form and its gauge. A gauge adds grad f, which is a one-form, too, so each is checked
 * on its own. The whole comes first, because its failure names the callback. */
static dvi_status check_one_form(dvi__check *c, const dvi__lagrangian_term *l)
{
  const dvi__gauge_term *g = &l->gauge;
  const dvi_gauge *f = &g->callbacks;
  const char *const gradients = "d alpha_j/dq_i at (i,j) =", *const hessian = "d2(alpha.v)/dq2";
  dvi__lagrangian_term part = *l;
  c->gradient_noise = 0;
  if (f->gradient == NULL) return check_form_derivatives(c, l, "one-form", gradients, hessian);
  DVI_TRY(
      dvi__general_gradient(l, &c->scratch, 1, &c->t, c->q, c->v, c->gradient[0], c->gradient[1]));
  part.gauge = (dvi__gauge_term){0};
  part.qv = g->form_qv;
  part.qq = g->form_qq;
  DVI_TRY(check_form_derivatives(c, &part, "one-form", gradients, hessian));
  part.one_form = (dvi_one_form){
      .value = f->gradient, .gradient = f->hessian, .hessian = f->third, .user = f->user};
  part.qv = g->qq;
  part.qq = g->qq;
  return check_form_derivatives(c, &part, "gauge", "d2f/dq2", "d2(grad f.v)/dq2");
}

/* Compare the gradients of the components of A with differences of A, and the Hessian of A.v with
 * differences of its gradient. */
static dvi_status check_vector(dvi__check *c, const dvi__vector_term *term)
{
  const dvi__vector_at at = {.term = term, .scratch = &c->scratch, .t = &c->t, .w = c->v};
  const dvi__differences *d = &c->differences;
  const int has_hessian = dvi__vector_has_hessian(term);
  const char *const owner = "vector potential";
  block qv = {.owner = owner,
              .name = "dA_j/dq_i at (i,j) =",
              .pattern = &term->gradients,
              .given = c->hessian[1]};
  block qq = {.owner = owner,
              .name = "d2(A.v)/dq2",
              .pattern = &term->qq,
              .given = has_hessian ? c->hessian[0] : NULL};
  DVI_TRY(dvi__vector_gradients(term, &c->scratch, 1, &c->t, c->q, c->hessian[1]));
  if (has_hessian)
    DVI_TRY(dvi__vector_hessian(term, &c->scratch, 1, &c->t, c->q, c->v, c->hessian[0]));
  for (int i = 0; i < c->n; i++) {
    DVI_TRY(dvi__difference_column(dvi__vector_of_q, &at, &c->differences, c->n, i, c->q,
                                   c->column[0], c->column[1]));
    compare_column(&qq, c->n, i, c->column[0],
                   noise_of(largest_component(c->n, d->plus), d->step[i]));
    compare_row(&qv, c->n, i, c->column[1],
                noise_of(largest_component(c->n, d->plus_v), d->step[i]));
  }
  keep_worst(c, &qv, &qv.on_pattern, &c->of_hessian);
  keep_worst(c, &qv, &qv.outside, &c->of_pattern);
  keep_worst(c, &qq, &qq.on_pattern, &c->of_hessian);
  keep_worst(c, &qq, &qq.outside, &c->of_pattern);
  return DVI_OK;
}

/* An entry outside of the gradients' pattern is a wrong 0 of the gradient. */
static dvi_status check_weighted(dvi__check *c, dvi__weighted *weighted, double *w, int count)
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

static dvi_status check_constraint_functions(dvi__check *c, const dvi_system *system)
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

/* A force as a function of q with n results, of which with factors only nv are its own. */
static dvi_status padded_force_of_q(const void *function, int count, const double *q, double *F,
                                    double *none)
{
  const dvi__force_at *at = function;
  memset(F, 0, (size_t)at->scratch->n * sizeof *F);
  return dvi__force_of_q(function, count, q, F, none);
}

/* Check one Jacobian of a force, by q [n] or by v [nv], against differences of the force [nv]. */
static dvi_status check_force_block(dvi__check *c, dvi__batch_gradient force,
                                    const dvi__force_at *at, int size, const double *x,
                                    block *jacobian)
{
  const dvi__differences *d = &c->differences;
  for (int j = 0; j < size; j++) {
    DVI_TRY(
        dvi__difference_column(force, at, &c->differences, size, j, x, c->column[0], c->column[1]));
    compare_column(jacobian, c->nv, j, c->column[0],
                   noise_of(largest_component(c->nv, d->plus), 1) / d->step[j]);
  }
  keep_worst(c, jacobian, &jacobian->on_pattern, &c->of_hessian);
  keep_worst(c, jacobian, &jacobian->outside, &c->of_pattern);
  return DVI_OK;
}

static dvi_status check_force(dvi__check *c, const dvi__force_term *f)
{
  const dvi__force_at at = {.term = f, .scratch = &c->scratch, .t = &c->t, .q = c->q, .v = c->v};
  const double *given[2] = {NULL, NULL};
  c->gradient_noise = 0;
  if (dvi__force_has_jacobian(f)) {
    DVI_TRY(
        dvi__force_jacobian(f, &c->scratch, 1, &c->t, c->q, c->v, c->hessian[0], c->hessian[1]));
    given[0] = c->hessian[0];
    given[1] = c->hessian[1];
  }
  block by_q = {
      .term = f->name, .name = "dF/dq", .kind = "force", .pattern = &f->by_q, .given = given[0]};
  block by_v = {
      .term = f->name, .name = "dF/dv", .kind = "force", .pattern = &f->by_v, .given = given[1]};
  DVI_TRY(check_force_block(c, padded_force_of_q, &at, c->n, c->q, &by_q));
  if (f->callbacks.without_velocity) return DVI_OK;
  return check_force_block(c, dvi__force_of_v, &at, c->nv, c->v, &by_v);
}

/* A constraint's values as a function with n results, for differences of all of them at once. */
static dvi_status padded_rows(const void *function, int count, const double *q, double *phi,
                              double *none)
{
  const dvi__holonomic_at *at = function;
  (void)count, (void)none;
  memset(phi, 0, (size_t)at->term->gradients.rows * sizeof *phi);
  return dvi__holonomic_value(at->term, at->t, q, phi);
}

/* Compare the derivatives of all rows in q_i with row i of the gradients. */
static dvi_status check_row_gradients(dvi__check *c, const dvi__holonomic_at *at, const char *kind)
{
  const dvi__holonomic_term *term = at->term;
  const dvi__differences *d = &c->differences;
  block b = {.term = term->name,
             .kind = kind,
             .name = "d phi_j/dq_i at (i,j) =",
             .pattern = &term->gradients,
             .given = c->hessian[1]};
  DVI_TRY(dvi__holonomic_gradient(term, c->t, c->q, c->hessian[1]));
  for (int i = 0; i < c->n; i++) {
    DVI_TRY(dvi__difference_column(padded_rows, at, &c->differences, c->n, i, c->q, c->column[0],
                                   c->column[1]));
    compare_row(&b, term->callbacks.count, i, c->column[0],
                noise_of(largest_component(c->n, d->plus), d->step[i]));
  }
  keep_worst(c, &b, &b.on_pattern, &c->of_gradient);
  keep_worst(c, &b, &b.outside, &c->of_pattern);
  return DVI_OK;
}

/* Compare the Hessian of each row alone with differences of its gradient. */
static dvi_status check_row_hessians(dvi__check *c, const dvi__holonomic_at *at, double *w)
{
  const dvi__holonomic_term *term = at->term;
  const int given = term->callbacks.hessian != NULL;
  for (int a = 0; a < term->callbacks.count; a++) {
    block b = {.term = term->name,
               .kind = "constraint",
               .name = "d2(phi.w)/dq2",
               .pattern = &term->qq,
               .given = given ? c->hessian[0] : NULL};
    w[a] = 1;
    if (given) DVI_TRY(dvi__holonomic_hessian(at, &c->scratch, c->q, c->hessian[0]));
    DVI_TRY(check_blocks(c, dvi__holonomic_gradient_of_q, at, c->q, &b, NULL));
    w[a] = 0;
  }
  return DVI_OK;
}

static dvi_status check_holonomic(dvi__check *c, const dvi__holonomic_term *term)
{
  const size_t n = (size_t)c->n, entries = (size_t)dvi__pattern_entries(&term->gradients);
  double *room = DVI_NEW(double, 3 * n + entries);
  if (room == NULL) return dvi__fail(DVI_NO_MEMORY, "system check: no memory for constraints");
  const dvi__holonomic_at at = {.term = term,
                                .t = c->t,
                                .w = room,
                                .point = room + n,
                                .sum = room + 2 * n,
                                .phi_q = room + 3 * n};
  c->gradient_noise = 0;
  dvi_status status = check_row_gradients(c, &at, "constraint");
  if (status == DVI_OK) status = check_row_hessians(c, &at, room);
  dvi__release(room);
  return status;
}

/* Without a callback the pattern is compared. */
static dvi_status check_nonholonomic(dvi__check *c, const dvi__nonholonomic_term *term)
{
  block b = {.term = term->name,
             .kind = "constraint",
             .name = "d(A v + a)_i/dq_j at (i,j) =",
             .pattern = &term->by_q,
             .given = c->hessian[0]};
  const dvi__nonholonomic_at at = {.term = term, .t = c->t, .v = c->v, .A = c->hessian[1]};
  c->gradient_noise = 0;
  DVI_TRY(dvi__nonholonomic_derivative(&at, &c->scratch, c->q, c->hessian[0]));
  return check_blocks(c, dvi__nonholonomic_of_q, &at, c->q, &b, NULL);
}

static dvi_status check_all_terms(dvi__check *c, const dvi_system *system)
{
  const names *name = system->dynamics->by_momentum ? &of_hamiltonian : &of_lagrangian;
  if (system->lagrangian != NULL)
    DVI_TRY(system->terms & DVI__ONE_FORM ? check_one_form(c, system->lagrangian)
                                          : check_general(c, system->lagrangian, name));
  if (system->constraint != NULL) DVI_TRY(check_constraint_functions(c, system));
  for (int k = 0; k < system->potential_count; k++)
    DVI_TRY(check_potential(c, &system->potentials[k]));
  for (int k = 0; k < system->noise.function_count; k++)
    DVI_TRY(check_potential(c, &system->noise_functions[k]));
  for (int k = 0; k < system->force_count; k++) DVI_TRY(check_force(c, &system->forces[k]));
  if (system->vector != NULL) DVI_TRY(check_vector(c, system->vector));
  for (int k = 0; k < system->holonomic_count; k++)
    DVI_TRY(check_holonomic(c, &system->holonomics[k]));
  for (int k = 0; k < system->nonholonomic_count; k++)
    DVI_TRY(check_nonholonomic(c, &system->nonholonomics[k]));
  for (int k = 0; k < system->contact_count; k++) {
    const dvi__holonomic_at at = {.term = &system->contacts[k].gap, .t = c->t};
    DVI_TRY(check_row_gradients(c, &at, "contact"));
  }
  return DVI_OK;
}

/* Check second derivatives that look wrong again over shorter steps. A high power, or a singularity
 * near by, bends within the longer steps. A wrong derivative stays wrong over all steps, unless
 * noise hides it. The noise of differenced gradients soon does. */
static dvi_status check_terms_closely(dvi__check *c, const dvi_system *system, double tolerance)
{
  DVI_TRY(check_all_terms(c, system));
  const dvi__finding hessian = c->of_hessian, pattern = c->of_pattern;
  const int shortest = dvi__lacks_gradient(system) ? 4 : 12;
  if (hessian.worst.error <= tolerance && pattern.worst.error <= tolerance) return DVI_OK;
  for (c->differences.shorter = 4; c->differences.shorter <= shortest;
       c->differences.shorter += 4) {
    c->of_hessian = c->of_pattern = (dvi__finding){.term = NULL};
    DVI_TRY(check_all_terms(c, system));
    if (c->of_hessian.worst.error <= tolerance && c->of_pattern.worst.error <= tolerance)
      return DVI_OK;
  }
  c->of_hessian = hessian;
  c->of_pattern = pattern;
  return DVI_OK;
}

/* Refuse what the kind of dynamics does not admit, as nonholonomic constraints that are not. */
static dvi_status check_kind(const dvi_system *system, double t, const double *q)
{
  const dvi__state_constraint *constraint = system->dynamics->constraint;
  dvi__evaluator *e = NULL;
  if (constraint == NULL || constraint->admit == NULL) return DVI_OK;
  dvi_status status = dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e);
  if (status == DVI_OK) status = constraint->admit(e, t, q);
  dvi__evaluator_destroy(&e);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "system check");
}

static dvi_status check_system(dvi__check *c, const dvi_system *system, double tolerance,
                               dvi_derivative_check *result)
{
  DVI_TRY(dvi__check_allocate(c, system));
  DVI_TRY(check_terms_closely(c, system, tolerance));
  DVI_TRY(dvi__check_report(c, tolerance, result));
  DVI_TRY(dvi__check_quadratic(system, &c->scratch, c->t, c->q, tolerance, result));
  DVI_TRY(
      dvi__check_time(system, &c->scratch, &c->differences, c->t, c->q, c->v, tolerance, result));
  DVI_TRY(dvi__check_rows_in_time(system, c->t, c->q, tolerance, result));
  DVI_TRY(check_kind(system, c->t, c->q));
  return dvi__check_taylor(system, &c->scratch, c->t, c->q, c->v, tolerance, result);
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
  dvi__check c = {.kinetic = system->lagrangian != NULL ? system->lagrangian->name : "Lagrangian",
                  .n = system->n,
                  .nv = system->nv,
                  .t = t,
                  .q = q,
                  .v = v,
                  .range.row = -1};
  const dvi_status status = check_system(&c, system, accepted, kept);
  dvi__check_clear(&c);
  return status;
}
