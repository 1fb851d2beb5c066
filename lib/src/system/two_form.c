/* The two-form Omega_ij = d alpha_j/dq_i - d alpha_i/dq_j of a degenerate Lagrangian alpha(q).v - H, and the velocity that it gives:
 *
 *     Omega(q) v = dH/dq,    the Euler-Lagrange equations d/dt alpha - d(alpha.v)/dq + dH/dq = 0.
 *
 * Source: Kraus 2017, arXiv:1708.07356; Marsden and Ratiu 1999. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/pfaffian.h"
#include "system/evaluator_struct.h"

/* An entry of the gradients; 0 outside of their pattern. */
static double entry(const dvi__pattern *pattern, const double *values, int row, int column)
{
  const int e = dvi__pattern_find(pattern, row, column);
  return e >= 0 ? values[e] : 0;
}

/* Omega at q into e->two_form, in the order of the term's omega. */
static dvi_status evaluate(dvi__evaluator *e, const double *q)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(l, q, alpha_q, e->scratch.result[0]));
  for (int j = 0; j < e->system->n; j++)
    for (int k = l->omega.start[j]; k < l->omega.start[j + 1]; k++)
      e->two_form[k] = entry(&l->qv, alpha_q, l->omega.row[k], j) - entry(&l->qv, alpha_q, j, l->omega.row[k]);
  return DVI_OK;
}

dvi_status dvi__two_form_factor(dvi__evaluator *e, const double *q)
{
  DVI_TRY(evaluate(e, q));
  const dvi_status status = dvi__linear_factor(e->velocity, e->two_form);
  return status == DVI_SINGULAR ? dvi__fail(status, "the two-form of the one-form is singular at this point") : status;
}

void dvi__two_form_solve(dvi__evaluator *e, double *x)
{
  dvi__linear_solve(e->velocity, x);
}

/* Columns one after the other, [n*n]. */
static void fill_dense(const dvi__evaluator *e, double *Omega)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  const size_t n = (size_t)e->system->n;
  memset(Omega, 0, n * n * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++) Omega[j * n + (size_t)omega->row[k]] = e->two_form[k];
}

dvi_status dvi__two_form_side(dvi__evaluator *e, const double *q, int *side)
{
  double Omega[DVI__SIDES_MOST * DVI__SIDES_MOST];
  *side = 1;
  if (e->system->n > DVI__SIDES_MOST) return DVI_OK;
  DVI_TRY(evaluate(e, q));
  fill_dense(e, Omega);
  *side = dvi__pfaffian_sign((size_t)e->system->n, Omega);
  return DVI_OK;
}

dvi_status dvi__two_form_velocity(dvi__evaluator *e, double t, const double *q, double *v)
{
  const size_t n = (size_t)e->system->n;
  DVI_TRY(dvi__two_form_factor(e, q));
  DVI_TRY(dvi__potentials_gradient(e, 1, &t, q, v));
  dvi__linear_solve(e->velocity, v);
  return dvi__first_not_finite(n, v) < 0 ? DVI_OK : dvi__fail(DVI_NOT_FINITE, "the velocity at t = %.6g is not finite", t);
}

dvi_status dvi__two_form_residual(dvi__evaluator *e, double t, const double *q, const double *v, double *F)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  DVI_TRY(evaluate(e, q));
  DVI_TRY(dvi__potentials_gradient(e, 1, &t, q, F));
  for (int i = 0; i < e->system->n; i++) F[i] = -F[i];
  for (int j = 0; j < e->system->n; j++)
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++) F[omega->row[k]] += e->two_form[k] * v[j];
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

/* S by columns; returns the largest gradient. */
static double symmetric_part(const dvi__pattern *qv, const double *alpha_q, size_t n, double *S)
{
  double largest = 0;
  memset(S, 0, n * n * sizeof *S);
  for (size_t j = 0; j < n; j++)
    for (int k = qv->start[j]; k < qv->start[j + 1]; k++) {
      const size_t i = (size_t)qv->row[k];
      S[j * n + i] += 0.5 * alpha_q[k];
      S[i * n + j] += 0.5 * alpha_q[k];
      largest = fmax(largest, fabs(alpha_q[k]));
    }
  return largest;
}

/* A c for which S + c is definite (Gershgorin). */
static double lift(size_t n, const double *S)
{
  double least = 0;
  for (size_t i = 0; i < n; i++) {
    double row = -S[i * n + i];
    for (size_t j = 0; j < n; j++) row += j != i ? fabs(S[j * n + i]) : 0;
    least = fmax(least, row);
  }
  return least;
}

/* By Cholesky's factors of S or -S, whose pivots exceed the floor; S is spoilt. */
static int is_definite(size_t n, double *S, double floor)
{
  const double sign = S[0] < 0 ? -1 : 1;
  for (size_t k = 0; k < n; k++) {
    const double pivot = sign * S[k * n + k];
    if (!(pivot > floor)) return 0;
    for (size_t j = k + 1; j < n; j++)
      for (size_t i = j; i < n; i++) S[j * n + i] -= sign * S[k * n + j] * S[k * n + i] / pivot;
  }
  return 1;
}

dvi_status dvi__form_definite(dvi__evaluator *e, const double *q, double *S)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  const size_t n = (size_t)e->system->n;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(l, q, alpha_q, e->scratch.result[0]));
  const double floor = 1e-12 * symmetric_part(&l->qv, alpha_q, n, S), c = lift(n, S);
  double largest = 0;
  for (size_t k = 0; k < n * n; k++) largest = fmax(largest, fabs(S[k]));
  if (largest <= floor || is_definite(n, S, floor)) return DVI_OK;
  return dvi__fail(
      DVI_SINGULAR,
      "the symmetric part of the one-form's derivatives is not definite here, and what is off p = alpha(q) grows from step "
      "to step; use the gauge alpha + grad f, f = c |q|^2/2 with c well above %.2g, or a quadrature of higher order, "
      "such as gauss",
      c);
}

dvi_status dvi__form_distance(dvi__evaluator *e, const double *q, const double *p, double *distance)
{
  double *alpha = e->point[2], largest = 0;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  for (int i = 0; i < e->system->n; i++) largest = fmax(largest, fabs(p[i] - alpha[i]));
  *distance = largest;
  return DVI_OK;
}

/* A start computed in another way than by the callback differs by its roundings; one that is off the constraint, by more. */
static const double on_constraint = 1e-11;

/* The size of alpha, and what its gradients make of q: where alpha happens to vanish, a rounding of q is not a violation. */
static dvi_status size_of_form(dvi__evaluator *e, const double *q, const double *alpha, double *size)
{
  const dvi__pattern *qv = &e->system->lagrangian->qv;
  double *alpha_q = e->hessian[1];
  DVI_TRY(dvi__form_gradients(e->system->lagrangian, q, alpha_q, e->scratch.result[0]));
  for (int j = 0; j < e->system->n; j++) {
    *size = fmax(*size, fabs(alpha[j]));
    for (int k = qv->start[j]; k < qv->start[j + 1]; k++) *size = fmax(*size, fabs(alpha_q[k] * q[qv->row[k]]));
  }
  return DVI_OK;
}

dvi_status dvi__form_size(dvi__evaluator *e, const double *q, double *size)
{
  double *alpha = e->point[2];
  *size = 0;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  return size_of_form(e, q, alpha, size);
}

dvi_status dvi__form_constraint(dvi__evaluator *e, const double *q, const double *p)
{
  double *alpha = e->point[2], size = 0;
  DVI_TRY(dvi__form_value(e->system->lagrangian, q, alpha, e->scratch.result[0]));
  DVI_TRY(size_of_form(e, q, alpha, &size));
  for (int i = 0; i < e->system->n; i++)
    if (!(fabs(p[i] - alpha[i]) <= on_constraint * size))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "p[%d] is %.17g, but the one-form has alpha = %.17g there, %.2g away; start with p = alpha(q) "
                       "(dvi_system_momentum), or let it be projected (dvi_start_options)",
                       i, p[i], alpha[i], fabs(p[i] - alpha[i]));
  return DVI_OK;
}

/* The largest sum of magnitudes in a column of the inverse. */
static double inverse_norm(dvi__evaluator *e)
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

static double norm(const dvi__pattern *omega, const double *values)
{
  double largest = 0;
  for (int j = 0; j < omega->columns; j++) {
    double sum = 0;
    for (int k = omega->start[j]; k < omega->start[j + 1]; k++) sum += fabs(values[k]);
    largest = fmax(largest, sum);
  }
  return largest;
}

static dvi_status measure(dvi__evaluator *e, const double *q, double *Omega, double *condition)
{
  const dvi__pattern *omega = &e->system->lagrangian->omega;
  const dvi_status status = dvi__two_form_factor(e, q);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (condition != NULL) *condition = status == DVI_OK ? norm(omega, e->two_form) * inverse_norm(e) : HUGE_VAL;
  if (Omega != NULL) fill_dense(e, Omega);
  return DVI_OK;
}

dvi_status dvi_system_two_form(const dvi_system *system, const double *q, double *Omega, double *condition)
{
  dvi__evaluator *e;
  if (system == NULL || q == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "two-form: an argument is NULL");
  if (!(system->terms & DVI__ONE_FORM)) return dvi__fail(DVI_UNSUPPORTED, "two-form: the system declares no one-form");
  if (dvi__first_not_finite((size_t)system->n, q) >= 0) return dvi__fail(DVI_NOT_FINITE, "two-form: the point is not finite");
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e));
  const dvi_status status = measure(e, q, Omega, condition);
  dvi__evaluator_destroy(&e);
  return status;
}
