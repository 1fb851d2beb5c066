/* The two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j of a degenerate Lagrangian
 * alpha(q).v - H, and the velocity of its Euler-Lagrange equations d/dt
 * alpha - d(alpha.v)/dq + dH/dq = 0,
 *
 *     Omega(q) v = dH/dq.
 *
 * Source: Kraus 2017, arXiv:1708.07356; Marsden and Ratiu 1999. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/pfaffian.h"
#include "system/dynamics/one_form.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/gauge.h"
#include "system/term/declare.h"
#include "system/term/term.h"

/* Return the entries of Omega, in the order of the term's omega. */
static double *two_form_entries(const dvi__evaluator *e)
{
  return e->own;
}

/* Return an entry of the gradients, which is 0 outside of their pattern. */
static double gradient_entry(const dvi__pattern *pattern, const double *values, int row, int column)
{
  const int e = dvi__pattern_find(pattern, row, column);
  return e >= 0 ? values[e] : 0;
}

/* Evaluate Omega at q. */
static dvi_status two_form_evaluate(dvi__evaluator *e, const double *q)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(l, q, alpha_q, e->scratch.result[0]));
  for (int j = 0; j < e->system->n; j++)
    for (int k = l->omega.start[j]; k < l->omega.start[j + 1]; k++) {
      const int i = l->omega.row[k];
      const double ij = gradient_entry(&l->qv, alpha_q, i, j),
                   ji = gradient_entry(&l->qv, alpha_q, j, i);
      two_form_entries(e)[k] = ij - ji;
    }
  return DVI_OK;
}

dvi_status dvi__two_form_factor(dvi__evaluator *e, const double *q)
{
  DVI_TRY(two_form_evaluate(e, q));
  const dvi_status status = dvi__linear_factor(e->velocity, two_form_entries(e));
  return status == DVI_SINGULAR
             ? dvi__fail(status, "the two-form of the one-form is singular at this point")
             : status;
}

void dvi__two_form_solve(dvi__evaluator *e, double *x)
{
  dvi__linear_solve(e->velocity, x);
}

/* Write Omega [n*n] by columns. */
static void fill_dense(const dvi__evaluator *e, double *Omega)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  const size_t n = (size_t)e->system->n;
  memset(Omega, 0, n * n * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++)
      Omega[j * n + (size_t)omega->row[k]] = two_form_entries(e)[k];
}

static dvi_status two_form_side(dvi__evaluator *e, double t, const double *q, const double *p,
                                int before, int *side)
{
  double Omega[DVI__SIDES_MOST * DVI__SIDES_MOST];
  (void)t, (void)p, (void)before;
  *side = 1;
  if (e->system->n > DVI__SIDES_MOST) return DVI_OK;
  DVI_TRY(two_form_evaluate(e, q));
  fill_dense(e, Omega);
  *side = dvi__pfaffian_sign((size_t)e->system->n, Omega);
  return DVI_OK;
}

static dvi_status two_form_velocity(dvi__evaluator *e, double t, const double *q, double *v)
{
  const size_t n = (size_t)e->system->n;
  DVI_TRY(dvi__two_form_factor(e, q));
  DVI_TRY(dvi__potentials_gradient(e, 1, &t, q, v));
  dvi__linear_solve(e->velocity, v);
  return dvi__first_not_finite(n, v) < 0
             ? DVI_OK
             : dvi__fail(DVI_NOT_FINITE, "the velocity at t = %.6g is not finite", t);
}

dvi_status dvi__two_form_residual(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *F)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  DVI_TRY(two_form_evaluate(e, q));
  DVI_TRY(dvi__potentials_gradient(e, 1, &t, q, F));
  for (int i = 0; i < e->system->n; i++) F[i] = -F[i];
  for (int j = 0; j < e->system->n; j++)
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++)
      F[omega->row[k]] += two_form_entries(e)[k] * v[j];
  return DVI_OK;
}

dvi_status dvi__form_scale(dvi__evaluator *e, const double *q, double *scale)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(l, q, alpha_q, e->scratch.result[0]));
  memset(scale, 0, (size_t)e->system->n * sizeof *scale);
  for (int j = 0; j < e->system->n; j++)
    for (int k = l->qv.start[j]; k < l->qv.start[j + 1]; k++) {
      scale[j] = fmax(scale[j], fabs(alpha_q[k]));
      scale[l->qv.row[k]] = fmax(scale[l->qv.row[k]], fabs(alpha_q[k]));
    }
  for (int i = 0; i < e->system->n; i++)
    if (scale[i] == 0) scale[i] = 1;
  return DVI_OK;
}

/* The multipliers sign*lambda, D x = lambda D^T x for D = Dalpha = S + W, must be on the unit
 * circle and away from 1. They are if S is definite. Then nu from W x = i nu S x is real, and
 * lambda = (1 + i nu)/(1 - i nu), so that |lambda + 1| = 2/sqrt(1 + nu^2) and |lambda - 1| is
 * |nu| times that. Errors of N steps add up to |sum mu^k| <= min(N, 2/|1 - mu|) of one error.
 * With |1 - mu| = 0.02 this is at most 100. With mu = 1 all errors add up, and the order is less
 * by 1. */
static const double nearest = 0.01; /* bound of |nu| for lambda, of 1/|nu| for -lambda */

/* Write [ S W; W^T m S ] by columns, [2n*2n], and return the largest gradient. By S = L L^T its
 * inertia is that of S and of m - K^T K, K = L^-1 W L^-T. */
static double split_gradients(const dvi__pattern *qv, const double *alpha_q, size_t n, double m,
                              double *A)
{
  double largest = 0;
  memset(A, 0, 4 * n * n * sizeof *A);
  for (size_t j = 0; j < n; j++)
    for (int k = qv->start[j]; k < qv->start[j + 1]; k++) {
      const size_t i = (size_t)qv->row[k], N = 2 * n;
      const double half = 0.5 * alpha_q[k];
      A[j * N + i] += half;
      A[i * N + j] += half;
      A[(n + j) * N + n + i] += m * half;
      A[(n + i) * N + n + j] += m * half;
      A[j * N + n + i] -= half;
      A[(n + i) * N + j] -= half;
      A[i * N + n + j] += half;
      A[(n + j) * N + i] += half;
      largest = fmax(largest, fabs(alpha_q[k]));
    }
  return largest;
}

/* Return the largest entry of S, and a c for which S + c is definite (Gershgorin). */
static double size_and_lift(size_t n, const double *A, double *c)
{
  double largest = 0;
  *c = 0;
  for (size_t i = 0; i < n; i++) {
    double row = -A[i * 2 * n + i];
    for (size_t j = 0; j < n; j++) {
      const double S_ij = A[j * 2 * n + i];
      row += j != i ? fabs(S_ij) : 0;
      largest = fmax(largest, fabs(S_ij));
    }
    *c = fmax(*c, row);
  }
  return largest;
}

/* Count the leading ones of the 2n pivots that have the sign of the first, and from number n on
 * that sign times `then`. Pivots must exceed the floor. A is overwritten. */
static size_t good_pivots(size_t n, double *A, double floor, double then)
{
  const size_t N = 2 * n;
  const double sign = A[0] < 0 ? -1 : 1;
  for (size_t k = 0; k < N; k++) {
    const double pivot = A[k * N + k];
    if (!((k < n ? sign : then * sign) * pivot > floor)) return k;
    for (size_t j = k + 1; j < N; j++)
      for (size_t i = j; i < N; i++) A[j * N + i] -= A[k * N + j] * A[k * N + i] / pivot;
  }
  return N;
}

static dvi_status refuse_indefinite(double c)
{
  return dvi__fail(DVI_SINGULAR,
                   "the symmetric part of the one-form's derivatives is not definite here, and "
                   "what is off p = alpha(q) grows from step "
                   "to step; use the gauge alpha + grad f, f = c |q|^2/2 with c well above %.2g, "
                   "or a quadrature of higher order, "
                   "such as gauss",
                   c);
}

static dvi_status refuse_near_one(int sign, double size)
{
  return sign < 0 ? dvi__fail(DVI_SINGULAR,
                              "the symmetric part of the one-form's derivatives is 0 or nearly so "
                              "here, and with even degree what is "
                              "off p = alpha(q) adds up from step to step and costs an order; use "
                              "the gauge alpha + grad f, f = c "
                              "|q|^2/2 with c about %.2g, an odd degree, or a quadrature of higher "
                              "order, such as gauss",
                              size)
                  : dvi__fail(DVI_SINGULAR,
                              "the symmetric part of the one-form's derivatives is more than %g "
                              "times the two-form here, and with odd "
                              "degree what is off p = alpha(q) adds up from step to step and costs "
                              "an order; use a weaker gauge, an "
                              "even degree, or a quadrature of higher order, such as gauss",
                              0.5 / nearest);
}

dvi_status dvi__form_definite(dvi__evaluator *e, const double *q, int sign, double *A)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  const size_t n = (size_t)e->system->n;
  const double m = nearest * nearest;
  double *alpha_q = e->hessian[1], c;
  DVI_TRY(dvi__form_gradients(l, q, alpha_q, e->scratch.result[0]));
  const double size = split_gradients(&l->qv, alpha_q, n, sign < 0 ? 1 / m : m, A),
               floor = 1e-12 * size;
  if (size_and_lift(n, A, &c) <= floor) return sign < 0 ? refuse_near_one(sign, size) : DVI_OK;
  const size_t good = good_pivots(n, A, floor, -sign);
  if (good < n) return refuse_indefinite(c);
  return good < 2 * n ? refuse_near_one(sign, size) : DVI_OK;
}

static dvi_status form_distance(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *distance)
{
  double *alpha = e->point[2], largest = 0;
  (void)t;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  for (int i = 0; i < e->system->n; i++) largest = fmax(largest, fabs(p[i] - alpha[i]));
  *distance = largest;
  return DVI_OK;
}

/* A start computed in another way than by the callback differs by its roundings. A larger violation
 * is refused. */
static const double on_constraint = 1e-11;

/* Compute the size of alpha, and the product of its gradients with q. Where alpha happens to
 * vanish, a rounding of q is not a violation. */
static dvi_status size_of_form(dvi__evaluator *e, const double *q, const double *alpha,
                               double *size)
{
  const dvi__pattern *qv = &e->system->lagrangian->qv;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(e->system->lagrangian, q, alpha_q, e->scratch.result[0]));
  for (int j = 0; j < e->system->n; j++) {
    *size = fmax(*size, fabs(alpha[j]));
    for (int k = qv->start[j]; k < qv->start[j + 1]; k++)
      *size = fmax(*size, fabs(alpha_q[k] * q[qv->row[k]]));
  }
  return DVI_OK;
}

static dvi_status form_size(dvi__evaluator *e, double t, const double *q, const double *p,
                            double *size)
{
  double *alpha = e->point[2];
  (void)t, (void)p;
  *size = 0;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  return size_of_form(e, q, alpha, size);
}

static dvi_status check_on_form(dvi__evaluator *e, double t, const double *q, const double *p)
{
  double *alpha = e->point[2], size = 0;
  (void)t;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  DVI_TRY(size_of_form(e, q, alpha, &size));
  for (int i = 0; i < e->system->n; i++)
    if (!(fabs(p[i] - alpha[i]) <= on_constraint * size))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "p[%d] is %.17g, but the one-form has alpha = %.17g there, %.2g away; start "
                       "with p = alpha(q) "
                       "(dvi_system_momentum), or let it be projected (dvi_start_options)",
                       i, p[i], alpha[i], fabs(p[i] - alpha[i]));
  return DVI_OK;
}

/* Return the largest sum of magnitudes in a column of the inverse. */
static double inverse_form_norm(dvi__evaluator *e)
{
  const size_t n = (size_t)e->system->n;
  double norm = 0;
  for (size_t j = 0; j < n; j++) {
    double sum = 0, *column = e->point[2];
    memset(column, 0, n * sizeof(double));
    column[j] = 1;
    dvi__linear_solve(e->velocity, column);
    for (size_t i = 0; i < n; i++) sum += fabs(column[i]);
    norm = fmax(norm, sum);
  }
  return norm;
}

static double form_norm(const dvi__pattern *omega, const double *values)
{
  double largest = 0;
  for (int j = 0; j < omega->columns; j++) {
    double sum = 0;
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++) sum += fabs(values[k]);
    largest = fmax(largest, sum);
  }
  return largest;
}

static dvi_status measure_form_violation(dvi__evaluator *e, const double *q, double *Omega,
                                         double *condition)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  const dvi_status status = dvi__two_form_factor(e, q);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (condition != NULL)
    *condition = status == DVI_OK ? form_norm(omega, two_form_entries(e)) * inverse_form_norm(e)
                                  : HUGE_VAL;
  if (Omega != NULL) fill_dense(e, Omega);
  return DVI_OK;
}

/* Towards a singular point distances fall as the root of the time left, so a straight path meets
 * the point after twice that time. The condition number is a second criterion. In two dimensions it
 * is always 1. */
static const double straight = 2, large_condition = 1e6;

static int two_form_ends(dvi__evaluator *e, double t, const double *q, double h, double *v,
                         double *ahead)
{
  int here, there;
  double condition;
  if (measure_form_violation(e, q, NULL, &condition) != DVI_OK ||
      two_form_side(e, 0, q, NULL, 0, &here) != DVI_OK)
    return 0;
  if (condition > large_condition) return 1;
  if (two_form_velocity(e, t, q, v) != DVI_OK) return 0;
  for (int i = 0; i < e->system->n; i++) ahead[i] = q[i] + straight * h * v[i];
  return two_form_side(e, 0, ahead, NULL, 0, &there) == DVI_OK && there != here;
}

dvi_status dvi_system_two_form(const dvi_system *system, const double *q, double *Omega,
                               double *condition)
{
  dvi__evaluator *e;
  if (system == NULL || q == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "two-form: an argument is NULL");
  if (!(system->terms & DVI__ONE_FORM))
    return dvi__fail(DVI_UNSUPPORTED, "two-form: the system declares no one-form");
  if (dvi__first_not_finite((size_t)system->n, q) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "two-form: the point is not finite");
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e));
  const dvi_status status = measure_form_violation(e, q, Omega, condition);
  dvi__evaluator_destroy(&e);
  return status;
}

/* ---- the kind ---- */

static int one_form_is_declared(const dvi_system_terms *terms)
{
  return terms->one_form != NULL;
}

static dvi_status join_two_form(dvi__lagrangian_term *term)
{
  dvi__pattern vq;
  DVI_TRY(dvi__pattern_transpose(&term->qv, &vq));
  const dvi_status status = dvi__pattern_union(&term->qv, &vq, &term->omega);
  dvi__pattern_clear(&vq);
  return status;
}

/* Declare alpha(q).v as a Lagrangian whose L_qv holds the gradients of alpha, and whose L_vv has no
 * entries. */
static dvi_status declare_one_form(const dvi_system_terms *terms, dvi_system *s)
{
  const dvi_one_form *given = terms->one_form;
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the one-form has no %s callback",
                     given->value == NULL ? "value" : "gradient");
  if (s->n % 2 != 0)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: dimension %d with a one-form; its two-form is singular unless the "
                     "dimension is even",
                     s->n);
  s->terms |= DVI__ONE_FORM;
  dvi__lagrangian_term *term = s->lagrangian = DVI_NEW(dvi__lagrangian_term, 1);
  if (term == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its terms");
  term->name = "one-form";
  term->one_form = *given;
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, s->n, "one-form: d2(alpha.v)/dq2", &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->gradients, s->n, "one-form: gradients", &term->qv));
  DVI_TRY(dvi__pattern_empty(s->n, &term->vv));
  if (terms->gauge != NULL) DVI_TRY(dvi__gauge_join(terms->gauge, term));
  DVI_TRY(join_two_form(term));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->qv, &s->qv));
  DVI_TRY(dvi__pattern_empty(s->n, &s->vv));
  return dvi__general_has_hessian(term) ? DVI_OK : dvi__general_group(term);
}

static dvi_status prepare_two_form(dvi__evaluator *e, dvi__derivatives most)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  (void)most;
  e->own = DVI_NEW(double, dvi__pattern_entries(omega));
  if (e->own == NULL) return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory for the two-form");
  return dvi__linear_create(omega, dvi__linear_for_exchanges(omega->columns), e->counters,
                            &e->velocity);
}

static void release_two_form(dvi__evaluator *e)
{
  dvi__release(e->own);
}

static dvi_status velocity_by_two_form(dvi__evaluator *e, double t, const double *q,
                                       const double *p, double *v)
{
  double *found = e->velocity_search;
  (void)p;
  DVI_TRY(two_form_velocity(e, t, q, found));
  memcpy(v, found, (size_t)e->system->n * sizeof *v);
  return DVI_OK;
}

static dvi_status two_form_is_regular(dvi__evaluator *e, double t, const double *q, const double *v)
{
  (void)t, (void)v;
  return dvi__two_form_factor(e, q);
}

/* Compute H = -L(t,q,0), which needs no velocity. */
static dvi_status energy_at_rest(dvi__evaluator *e, double t, const double *q, const double *v,
                                 const double *p, double *E)
{
  double L, *rest = e->point[2];
  (void)v, (void)p;
  memset(rest, 0, (size_t)e->system->n * sizeof *rest);
  DVI_TRY(dvi__value_of_point(e, t, q, rest, &L));
  *E = 0 - L;
  return DVI_OK;
}

static dvi_status project_on_form(dvi__evaluator *e, double t, double *q, double *p)
{
  double *rest = e->point[2];
  memset(rest, 0, (size_t)e->system->n * sizeof *rest);
  return dvi__momentum_of_point(e, t, q, rest, p);
}

static const dvi__state_constraint by_form = {
    .matrix = "two-form of the one-form",
    .check = check_on_form,
    .project = project_on_form,
    .distance = form_distance,
    .size = form_size,
    .side = two_form_side,
    .ends = two_form_ends,
};

const dvi__dynamics dvi__dynamics_one_form = {
    .name = "one-form",
    .function = "Lagrangian",
    .equations = DVI__FIRST_ORDER,
    .symmetric = "dg, dg-phase, dvrk, or vprk with its symmetric projection",
    .is_declared = one_form_is_declared,
    .declare = declare_one_form,
    .prepare = prepare_two_form,
    .release = release_two_form,
    .velocity = velocity_by_two_form,
    .regular = two_form_is_regular,
    .motion = dvi__motion_of_lagrangian,
    .energy = energy_at_rest,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
    .constraint = &by_form,
};
