#include "system/evaluate/dirac.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/pfaffian.h"
#include "system/evaluate/evaluator_struct.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "no memory for the constraints");
}

/* ---- the term ---- */

static dvi_status copy_weighted(const dvi_constraint *given, int n, dvi__lagrangian_term *term)
{
  term->name = "constraint";
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, n, "constraint: d2(phi.w)/dq2", &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->qp, n, "constraint: d2(phi.w)/dqdp", &term->qv));
  DVI_TRY(dvi__pattern_copy_symmetric(&given->pp, n, "constraint: d2(phi.w)/dp2", &term->vv));
  return given->hessian != NULL ? DVI_OK : dvi__general_group(term);
}

dvi_status dvi__constraint_copy(const dvi_constraint *given, int n, dvi__constraint_term **term)
{
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the constraint has no %s callback", given->value == NULL ? "value" : "gradient");
  if (given->count < 2 || given->count > 2 * n || given->count % 2 != 0)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: %d constraints; an even number from 2 to %d is needed, for others have a singular bracket matrix",
                     given->count, 2 * n);
  dvi__constraint_term *made = *term = DVI_NEW(dvi__constraint_term, 1);
  if (made == NULL) return no_memory();
  made->callbacks = *given;
  DVI_TRY(dvi__pattern_copy_rectangular(&given->gradients, 2 * n, given->count, "constraint: gradients", &made->gradients));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, given->count, "constraint: bracket matrix", &made->bracket));
  return copy_weighted(given, n, &made->weighted);
}

void dvi__constraint_clear(dvi__constraint_term **term)
{
  if (*term == NULL) return;
  dvi__pattern_clear(&(*term)->gradients);
  dvi__pattern_clear(&(*term)->bracket);
  dvi__general_clear(&(*term)->weighted);
  dvi__release(*term);
  *term = NULL;
}

/* ---- phi.w ---- */

static int weighted_value(double t, const double *q, const double *p, double *sum, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  (void)t;
  *sum = 0;
  const int returned = c->value(q, p, own->phi, c->user);
  for (int a = 0; a < c->count && returned == 0; a++) *sum += own->w[a] * own->phi[a];
  return returned;
}

static int weighted_gradient(double t, const double *q, const double *p, double *sum_q, double *sum_p, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  const dvi__pattern *gradients = &own->constraint->gradients;
  const int n = gradients->rows / 2, returned = c->gradient(q, p, own->phi_z, c->user);
  (void)t;
  for (int i = 0; i < n; i++) sum_q[i] = sum_p[i] = 0;
  for (int a = 0; a < c->count && returned == 0; a++)
    for (int k = gradients->start[a]; k < gradients->start[a + 1]; k++) {
      const int row = gradients->row[k];
      *(row < n ? sum_q + row : sum_p + row - n) += own->w[a] * own->phi_z[k];
    }
  return returned;
}

static int weighted_hessian(double t, const double *q, const double *p, double *qq, double *qp, double *pp, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  (void)t;
  return c->hessian(q, p, own->w, qq, qp, pp, c->user);
}

dvi_status dvi__weighted_open(const dvi_system *system, dvi__weighted *weighted)
{
  const dvi__constraint_term *c = system->constraint;
  *weighted = (dvi__weighted){.term = c->weighted,
                              .constraint = c,
                              .phi = DVI_NEW(double, c->callbacks.count),
                              .phi_z = DVI_NEW(double, dvi__pattern_entries(&c->gradients))};
  weighted->term.callbacks = (dvi_lagrangian){.value = weighted_value,
                                              .gradient = weighted_gradient,
                                              .hessian = c->callbacks.hessian != NULL ? weighted_hessian : NULL,
                                              .user = weighted};
  return weighted->phi != NULL && weighted->phi_z != NULL ? DVI_OK : no_memory();
}

void dvi__weighted_close(dvi__weighted *weighted)
{
  dvi__release(weighted->phi);
  dvi__release(weighted->phi_z);
  *weighted = (dvi__weighted){0};
}

/* ---- an evaluator's part ---- */

dvi_status dvi__dirac_create(const dvi_system *system, dvi__dirac **dirac)
{
  const size_t n = (size_t)system->n, m = (size_t)system->constraint->callbacks.count;
  dvi__dirac *d = *dirac = DVI_NEW(dvi__dirac, 1);
  if (d == NULL) return no_memory();
  d->bracket = DVI_NEW(double, m *m);
  d->multiplier = DVI_NEW(double, m);
  d->field = DVI_NEW(double, 2 * n);
  d->pushed = DVI_NEW(double, 2 * n);
  if (d->bracket == NULL || d->multiplier == NULL || d->field == NULL || d->pushed == NULL) return no_memory();
  return dvi__weighted_open(system, &d->weighted);
}

void dvi__dirac_destroy(dvi__dirac **dirac)
{
  dvi__dirac *d = *dirac;
  if (d == NULL) return;
  dvi__weighted_close(&d->weighted);
  dvi__release(d->bracket);
  dvi__release(d->multiplier);
  dvi__release(d->field);
  dvi__release(d->pushed);
  dvi__release(d);
  *dirac = NULL;
}

dvi_status dvi__constraint_value(dvi__evaluator *e, const double *q, const double *p, double *phi)
{
  const dvi_constraint *c = &e->system->constraint->callbacks;
  e->counters->values++;
  return dvi__verdict(c->value(q, p, phi, c->user), c->count, 1, phi, "constraint", "value", "");
}

dvi_status dvi__constraint_gradients(dvi__evaluator *e, const double *q, const double *p, double *phi_z)
{
  const dvi__constraint_term *c = e->system->constraint;
  e->counters->gradients++;
  return dvi__verdict(c->callbacks.gradient(q, p, phi_z, c->callbacks.user), dvi__pattern_entries(&c->gradients), 1, phi_z,
                      "constraint", "gradient", "");
}

dvi_status dvi__constraint_hessian(dvi__evaluator *e, const double *q, const double *p, const double *w, double *qq, double *qp,
                                   double *pp)
{
  const double any_time = 0;
  e->dirac->weighted.w = w;
  e->counters->hessians++;
  const dvi_status status = dvi__general_hessian(&e->dirac->weighted.term, &e->scratch, 1, &any_time, q, p, qq, qp, pp);
  dvi__count_differences(e);
  return status;
}

void dvi__constraint_push(const dvi__constraint_term *c, const double *phi_z, const double *w, double factor, double *z)
{
  const dvi__pattern *gradients = &c->gradients;
  const int n = gradients->rows / 2;
  for (int a = 0; a < gradients->columns; a++)
    for (int k = gradients->start[a]; k < gradients->start[a + 1]; k++) {
      const int row = gradients->row[k];
      if (row < n)
        z[n + row] -= factor * w[a] * phi_z[k];
      else
        z[row - n] += factor * w[a] * phi_z[k];
    }
}

/* ---- the motion ---- */

/* grad phi_a.x, x [2n]: the bracket {phi_a, F} for the field x of F. */
static double along(const dvi__pattern *gradients, const double *phi_z, int a, const double *x)
{
  double sum = 0;
  for (int k = gradients->start[a]; k < gradients->start[a + 1]; k++) sum += phi_z[k] * x[gradients->row[k]];
  return sum;
}

/* The bracket matrix into e->dirac->bracket, from the gradients that the weighted function holds. */
static dvi_status evaluate_bracket(dvi__evaluator *e, const double *q, const double *p)
{
  const dvi__constraint_term *c = e->system->constraint;
  const dvi__dirac *d = e->dirac;
  const int n = e->system->n, m = c->callbacks.count;
  double *unit = d->multiplier, *phi_z = d->weighted.phi_z;
  DVI_TRY(dvi__constraint_gradients(e, q, p, phi_z));
  for (int b = 0; b < m; b++) {
    memset(unit, 0, (size_t)m * sizeof *unit);
    memset(d->pushed, 0, 2 * (size_t)n * sizeof *d->pushed);
    unit[b] = 1;
    dvi__constraint_push(c, phi_z, unit, 1, d->pushed);
    for (int a = 0; a < m; a++) d->bracket[b * m + a] = along(&c->gradients, phi_z, a, d->pushed);
  }
  return DVI_OK;
}

static dvi_status factor_bracket(dvi__evaluator *e, const double *q, const double *p)
{
  DVI_TRY(evaluate_bracket(e, q, p));
  const dvi_status status = dvi__linear_factor(e->velocity, e->dirac->bracket);
  if (status != DVI_SINGULAR) return status;
  return dvi__fail(
      status,
      "the constraints' bracket matrix {phi_a, phi_b} is singular at this point: they are dependent, or not all of second class");
}

dvi_status dvi__dirac_side(dvi__evaluator *e, const double *q, const double *p, int *side)
{
  const int m = e->system->constraint->callbacks.count;
  *side = 1;
  if (m > DVI__SIDES_MOST) return DVI_OK;
  DVI_TRY(evaluate_bracket(e, q, p));
  *side = dvi__pfaffian_sign((size_t)m, e->dirac->bracket);
  return DVI_OK;
}

/* Hamilton's equations. */
static dvi_status field_of_H(dvi__evaluator *e, double t, const double *q, const double *p, double *qdot, double *pdot)
{
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, p, pdot, qdot));
  for (int i = 0; i < e->system->n; i++) pdot[i] = -pdot[i];
  return DVI_OK;
}

dvi_status dvi__dirac_motion(dvi__evaluator *e, double t, const double *q, const double *p, double *qdot, double *pdot,
                             double *multiplier)
{
  const dvi__constraint_term *c = e->system->constraint;
  const dvi__dirac *d = e->dirac;
  const size_t n = (size_t)e->system->n;
  if (c == NULL) return field_of_H(e, t, q, p, qdot, pdot);
  const int m = c->callbacks.count;
  DVI_TRY(field_of_H(e, t, q, p, d->field, d->field + n));
  DVI_TRY(factor_bracket(e, q, p));
  for (int a = 0; a < m; a++) d->multiplier[a] = -along(&c->gradients, d->weighted.phi_z, a, d->field);
  dvi__linear_solve(e->velocity, d->multiplier);
  dvi__constraint_push(c, d->weighted.phi_z, d->multiplier, 1, d->field);
  if (dvi__first_not_finite(2 * n, d->field) >= 0) return dvi__fail(DVI_NOT_FINITE, "the velocity at t = %.6g is not finite", t);
  memcpy(qdot, d->field, n * sizeof *qdot);
  memcpy(pdot, d->field + n, n * sizeof *pdot);
  if (multiplier != NULL) memcpy(multiplier, d->multiplier, (size_t)m * sizeof *multiplier);
  return DVI_OK;
}

/* ---- the constraint ---- */

dvi_status dvi__dirac_distance(dvi__evaluator *e, const double *q, const double *p, double *distance)
{
  double *phi = e->dirac->weighted.phi;
  DVI_TRY(dvi__constraint_value(e, q, p, phi));
  *distance = dvi__largest((size_t)e->system->constraint->callbacks.count, phi);
  return DVI_OK;
}

/* A start computed in another way differs by its roundings; one that is off the constraint, by more. */
static const double on_constraint = 1e-11;

/* What the roundings of a point do to phi_a is measured by its gradient. */
static double size_of(const dvi__constraint_term *c, const double *phi_z, int a, const double *q, const double *p)
{
  const int n = c->gradients.rows / 2;
  double size = 0;
  for (int k = c->gradients.start[a]; k < c->gradients.start[a + 1]; k++) {
    const int row = c->gradients.row[k];
    size = fmax(size, fabs(phi_z[k] * (row < n ? q[row] : p[row - n])));
  }
  return size;
}

dvi_status dvi__dirac_size(dvi__evaluator *e, const double *q, const double *p, double *size)
{
  const dvi__constraint_term *c = e->system->constraint;
  double *phi_z = e->dirac->weighted.phi_z;
  *size = 0;
  DVI_TRY(dvi__constraint_gradients(e, q, p, phi_z));
  for (int a = 0; a < c->callbacks.count; a++) *size = fmax(*size, size_of(c, phi_z, a, q, p));
  return DVI_OK;
}

dvi_status dvi__dirac_constraint(dvi__evaluator *e, const double *q, const double *p)
{
  const dvi__constraint_term *c = e->system->constraint;
  const dvi__weighted *at = &e->dirac->weighted;
  DVI_TRY(dvi__constraint_value(e, q, p, at->phi));
  DVI_TRY(dvi__constraint_gradients(e, q, p, at->phi_z));
  for (int a = 0; a < c->callbacks.count; a++) {
    if (!(fabs(at->phi[a]) <= on_constraint * size_of(c, at->phi_z, a, q, p)))
      return dvi__fail(
          DVI_BAD_ARGUMENT,
          "constraint %d is %.17g at this point, not 0; start with phi(q,p) = 0, or let it be projected (dvi_start_options)", a,
          at->phi[a]);
  }
  return DVI_OK;
}

/* Newton's method along the fields of the constraints: the change X_phi mu makes phi smaller by {phi, phi} mu. */
dvi_status dvi__dirac_project(dvi__evaluator *e, double *z)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi__constraint_term *c = e->system->constraint;
  const dvi__dirac *d = e->dirac;
  const size_t n = (size_t)e->system->n;
  double size = HUGE_VAL, next;
  DVI_TRY(dvi__dirac_distance(e, z, z + n, &next));
  for (int iteration = 0; iteration < MOST_ITERATIONS && next > 0 && next < size; iteration++) {
    size = next;
    DVI_TRY(factor_bracket(e, z, z + n));
    for (int a = 0; a < c->callbacks.count; a++) d->multiplier[a] = -d->weighted.phi[a];
    dvi__linear_solve(e->velocity, d->multiplier);
    memcpy(d->pushed, z, 2 * n * sizeof *z);
    dvi__constraint_push(c, d->weighted.phi_z, d->multiplier, 1, d->pushed);
    if (dvi__first_not_finite(2 * n, d->pushed) >= 0) return dvi__fail(DVI_NOT_CONVERGED, "no point of the constraint was found");
    DVI_TRY(dvi__dirac_distance(e, d->pushed, d->pushed + n, &next));
    if (next < size) memcpy(z, d->pushed, 2 * n * sizeof *z);
  }
  if (dvi__dirac_constraint(e, z, z + n) == DVI_OK) return DVI_OK;
  return dvi__fail_in(DVI_NOT_CONVERGED, "no point of the constraint was found by Newton's method");
}

/* ---- the public view ---- */

/* The largest sum of magnitudes in a column of the m x m matrix; of its inverse, by the factor. */
static double norm_of(int m, const double *matrix)
{
  double norm = 0;
  for (int b = 0; b < m; b++) {
    double sum = 0;
    for (int a = 0; a < m; a++) sum += fabs(matrix[b * m + a]);
    norm = fmax(norm, sum);
  }
  return norm;
}

static double inverse_norm(dvi__evaluator *e, int m)
{
  double norm = 0, *column = e->dirac->multiplier;
  for (int b = 0; b < m; b++) {
    double sum = 0;
    memset(column, 0, (size_t)m * sizeof *column);
    column[b] = 1;
    dvi__linear_solve(e->velocity, column);
    for (int a = 0; a < m; a++) sum += fabs(column[a]);
    norm = fmax(norm, sum);
  }
  return norm;
}

static dvi_status measure(dvi__evaluator *e, const double *q, const double *p, double *bracket, double *condition)
{
  const int m = e->system->constraint->callbacks.count;
  const dvi_status status = factor_bracket(e, q, p);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (condition != NULL) *condition = status == DVI_OK ? norm_of(m, e->dirac->bracket) * inverse_norm(e, m) : HUGE_VAL;
  if (bracket != NULL) memcpy(bracket, e->dirac->bracket, (size_t)m * (size_t)m * sizeof *bracket);
  return DVI_OK;
}

dvi_status dvi_system_bracket(const dvi_system *system, const double *q, const double *p, double *bracket, double *condition)
{
  dvi__evaluator *e;
  if (system == NULL || q == NULL || p == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "bracket: an argument is NULL");
  if (system->constraint == NULL) return dvi__fail(DVI_UNSUPPORTED, "bracket: the system declares no constraints phi(q,p)");
  const size_t n = (size_t)system->n;
  if (dvi__first_not_finite(n, q) >= 0 || dvi__first_not_finite(n, p) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "bracket: the point is not finite");
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e));
  const dvi_status status = measure(e, q, p, bracket, condition);
  dvi__evaluator_destroy(&e);
  return status;
}

int dvi_system_constraint_count(const dvi_system *system)
{
  return system != NULL && system->constraint != NULL ? system->constraint->callbacks.count : 0;
}
