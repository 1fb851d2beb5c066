/* A Hamiltonian with constraints phi(q,p) = 0 of second class has
 *
 *     q' = H_p + phi_p^T lambda,   p' = -H_q - phi_q^T lambda,
 *     sum_b {phi_a, phi_b} lambda_b = -{phi_a, H}.
 *
 * Source: Dirac 1964; Kraus, Yoshimura and Peng (talk). */
#include "system/dynamics/constrained_hamiltonian.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "num/pfaffian.h"
#include "system/dynamics/hamiltonian.h"
#include "system/evaluate/evaluator_struct.h"

static dvi_status refuse_memory_of_constraints(void)
{
  return dvi__fail(DVI_NO_MEMORY, "no memory for the constraints");
}

/* ---- an evaluator's part ---- */

typedef struct constraint_memory {
  dvi__weighted weighted;
  double *bracket, *multiplier; /* bracket [m*m], multipliers [m] */
  double *field, *pushed;       /* vector fields [2n] of H and of one constraint */
} constraint_memory;

static constraint_memory *memory_of(const dvi__evaluator *e)
{
  return e->own;
}

static dvi_status prepare_constraints(dvi__evaluator *e, dvi__derivatives most)
{
  const dvi_system *system = e->system;
  const dvi__pattern *bracket = &system->constraint->bracket;
  const size_t n = (size_t)system->n, m = (size_t)system->constraint->callbacks.count;
  constraint_memory *d = e->own = DVI_NEW(constraint_memory, 1);
  (void)most;
  if (d == NULL) return refuse_memory_of_constraints();
  d->bracket = DVI_NEW(double, m *m);
  d->multiplier = DVI_NEW(double, m);
  d->field = DVI_NEW(double, 2 * n);
  d->pushed = DVI_NEW(double, 2 * n);
  if (d->bracket == NULL || d->multiplier == NULL || d->field == NULL || d->pushed == NULL)
    return refuse_memory_of_constraints();
  DVI_TRY(dvi__weighted_open(system, &d->weighted));
  return dvi__linear_create(bracket, dvi__linear_for_exchanges(bracket->columns), e->counters,
                            &e->velocity);
}

static void release_constraints(dvi__evaluator *e)
{
  constraint_memory *d = e->own;
  if (d == NULL) return;
  dvi__weighted_close(&d->weighted);
  dvi__release(d->bracket);
  dvi__release(d->multiplier);
  dvi__release(d->field);
  dvi__release(d->pushed);
  dvi__release(d);
}

dvi_status dvi__constraint_value(dvi__evaluator *e, const double *q, const double *p, double *phi)
{
  const dvi_constraint *c = &e->system->constraint->callbacks;
  e->counters->values++;
  return dvi__verdict(c->value(q, p, phi, c->user), c->count, 1, phi, "constraint", "value", "");
}

dvi_status dvi__constraint_gradients(dvi__evaluator *e, const double *q, const double *p,
                                     double *phi_z)
{
  const dvi__constraint_term *c = e->system->constraint;
  e->counters->gradients++;
  return dvi__verdict(c->callbacks.gradient(q, p, phi_z, c->callbacks.user),
                      dvi__pattern_entries(&c->gradients), 1, phi_z, "constraint", "gradient", "");
}

dvi_status dvi__constraint_hessian(dvi__evaluator *e, const double *q, const double *p,
                                   const double *w, double *qq, double *qp, double *pp)
{
  const double any_time = 0;
  memory_of(e)->weighted.w = w;
  e->counters->hessians++;
  const dvi_status status = dvi__general_hessian(&memory_of(e)->weighted.term, &e->scratch, 1,
                                                 &any_time, q, p, qq, qp, pp);
  dvi__count_differences(e);
  return status;
}

void dvi__constraint_push(const dvi__constraint_term *c, const double *phi_z, const double *w,
                          double factor, double *z)
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

/* Compute grad phi_a.x, x [2n]. This is the bracket {phi_a, F} for the vector field x of F. */
static double derivative_along(const dvi__pattern *gradients, const double *phi_z, int a,
                               const double *x)
{
  double sum = 0;
  for (int k = gradients->start[a]; k < gradients->start[a + 1]; k++)
    sum += phi_z[k] * x[gradients->row[k]];
  return sum;
}

/* Compute the bracket matrix in memory_of(e)->bracket, from the gradients that the weighted
 * function holds. */
static dvi_status evaluate_bracket(dvi__evaluator *e, const double *q, const double *p)
{
  const dvi__constraint_term *c = e->system->constraint;
  const constraint_memory *d = memory_of(e);
  const int n = e->system->n, m = c->callbacks.count;
  double *unit = d->multiplier, *phi_z = d->weighted.phi_z;
  DVI_TRY(dvi__constraint_gradients(e, q, p, phi_z));
  for (int b = 0; b < m; b++) {
    memset(unit, 0, (size_t)m * sizeof *unit);
    memset(d->pushed, 0, 2 * (size_t)n * sizeof *d->pushed);
    unit[b] = 1;
    dvi__constraint_push(c, phi_z, unit, 1, d->pushed);
    for (int a = 0; a < m; a++)
      d->bracket[b * m + a] = derivative_along(&c->gradients, phi_z, a, d->pushed);
  }
  return DVI_OK;
}

static dvi_status factor_bracket(dvi__evaluator *e, const double *q, const double *p)
{
  DVI_TRY(evaluate_bracket(e, q, p));
  const dvi_status status = dvi__linear_factor(e->velocity, memory_of(e)->bracket);
  if (status != DVI_SINGULAR) return status;
  return dvi__fail(status, "the constraints' bracket matrix {phi_a, phi_b} is singular at this "
                           "point: they are dependent, or not all of second class");
}

static dvi_status bracket_side(dvi__evaluator *e, double t, const double *q, const double *p,
                               int before, int *side)
{
  (void)t, (void)before;
  const int m = e->system->constraint->callbacks.count;
  *side = 1;
  if (m > DVI__SIDES_MOST) return DVI_OK;
  DVI_TRY(evaluate_bracket(e, q, p));
  *side = dvi__pfaffian_sign((size_t)m, memory_of(e)->bracket);
  return DVI_OK;
}

static dvi_status constrained_motion(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier)
{
  const dvi__constraint_term *c = e->system->constraint;
  const constraint_memory *d = memory_of(e);
  const size_t n = (size_t)e->system->n;
  const int m = c->callbacks.count;
  DVI_TRY(dvi__hamiltonian_vector_field(e, t, q, p, d->field, d->field + n));
  DVI_TRY(factor_bracket(e, q, p));
  for (int a = 0; a < m; a++)
    d->multiplier[a] = -derivative_along(&c->gradients, d->weighted.phi_z, a, d->field);
  dvi__linear_solve(e->velocity, d->multiplier);
  dvi__constraint_push(c, d->weighted.phi_z, d->multiplier, 1, d->field);
  if (dvi__first_not_finite(2 * n, d->field) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the velocity at t = %.6g is not finite", t);
  memcpy(v, d->field, n * sizeof *v);
  memcpy(pdot, d->field + n, n * sizeof *pdot);
  if (multiplier != NULL) memcpy(multiplier, d->multiplier, (size_t)m * sizeof *multiplier);
  return DVI_OK;
}

/* ---- the constraint ---- */

static dvi_status constraint_distance(dvi__evaluator *e, double t, const double *q, const double *p,
                                      double *distance)
{
  (void)t;
  double *phi = memory_of(e)->weighted.phi;
  DVI_TRY(dvi__constraint_value(e, q, p, phi));
  *distance = dvi__largest((size_t)e->system->constraint->callbacks.count, phi);
  return DVI_OK;
}

/* A start computed in another way differs by its roundings. A larger violation is refused. */
static const double on_constraint = 1e-11;

/* Measure the effect of roundings of a point on phi_a by the gradient of phi_a. */
static double size_of_gradient(const dvi__constraint_term *c, const double *phi_z, int a,
                               const double *q, const double *p)
{
  const int n = c->gradients.rows / 2;
  double size = 0;
  for (int k = c->gradients.start[a]; k < c->gradients.start[a + 1]; k++) {
    const int row = c->gradients.row[k];
    size = fmax(size, fabs(phi_z[k] * (row < n ? q[row] : p[row - n])));
  }
  return size;
}

static dvi_status constraint_size(dvi__evaluator *e, double t, const double *q, const double *p,
                                  double *size)
{
  (void)t;
  const dvi__constraint_term *c = e->system->constraint;
  double *phi_z = memory_of(e)->weighted.phi_z;
  *size = 0;
  DVI_TRY(dvi__constraint_gradients(e, q, p, phi_z));
  for (int a = 0; a < c->callbacks.count; a++)
    *size = fmax(*size, size_of_gradient(c, phi_z, a, q, p));
  return DVI_OK;
}

static dvi_status check_on_constraint(dvi__evaluator *e, double t, const double *q, const double *p)
{
  (void)t;
  const dvi__constraint_term *c = e->system->constraint;
  const dvi__weighted *at = &memory_of(e)->weighted;
  DVI_TRY(dvi__constraint_value(e, q, p, at->phi));
  DVI_TRY(dvi__constraint_gradients(e, q, p, at->phi_z));
  for (int a = 0; a < c->callbacks.count; a++) {
    if (!(fabs(at->phi[a]) <= on_constraint * size_of_gradient(c, at->phi_z, a, q, p)))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "constraint %d is %.17g at this point, not 0; start with phi(q,p) = 0, or "
                       "let it be projected (dvi_start_options)",
                       a, at->phi[a]);
  }
  return DVI_OK;
}

/* Apply Newton's method along the vector fields (phi_p, -phi_q) of the constraints. The change
 * X_phi mu makes phi smaller by {phi, phi} mu. */
static dvi_status project_on_constraint(dvi__evaluator *e, double t, double *q, double *p)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi__constraint_term *c = e->system->constraint;
  const constraint_memory *d = memory_of(e);
  const size_t n = (size_t)e->system->n;
  double size = HUGE_VAL, next;
  DVI_TRY(constraint_distance(e, t, q, p, &next));
  for (int iteration = 0; iteration < MOST_ITERATIONS && next > 0 && next < size; iteration++) {
    size = next;
    DVI_TRY(factor_bracket(e, q, p));
    for (int a = 0; a < c->callbacks.count; a++) d->multiplier[a] = -d->weighted.phi[a];
    dvi__linear_solve(e->velocity, d->multiplier);
    memcpy(d->pushed, q, n * sizeof *q);
    memcpy(d->pushed + n, p, n * sizeof *p);
    dvi__constraint_push(c, d->weighted.phi_z, d->multiplier, 1, d->pushed);
    if (dvi__first_not_finite(2 * n, d->pushed) >= 0)
      return dvi__fail(DVI_NOT_CONVERGED, "no point of the constraint was found");
    DVI_TRY(constraint_distance(e, t, d->pushed, d->pushed + n, &next));
    if (next >= size) continue;
    memcpy(q, d->pushed, n * sizeof *q);
    memcpy(p, d->pushed + n, n * sizeof *p);
  }
  if (check_on_constraint(e, t, q, p) == DVI_OK) return DVI_OK;
  return dvi__fail_in(DVI_NOT_CONVERGED, "no point of the constraint was found by Newton's method");
}

/* ---- the public view ---- */

/* Compute the largest sum of magnitudes in a column of the m x m matrix. The second function does
 * so for its inverse, by the factor. */
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

static double inverse_bracket_norm(dvi__evaluator *e, int m)
{
  double norm = 0, *column = memory_of(e)->multiplier;
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

static dvi_status measure_violation(dvi__evaluator *e, const double *q, const double *p,
                                    double *bracket, double *condition)
{
  const int m = e->system->constraint->callbacks.count;
  const dvi_status status = factor_bracket(e, q, p);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (condition != NULL)
    *condition = status == DVI_OK ? norm_of(m, memory_of(e)->bracket) * inverse_bracket_norm(e, m)
                                  : HUGE_VAL;
  if (bracket != NULL)
    memcpy(bracket, memory_of(e)->bracket, (size_t)m * (size_t)m * sizeof *bracket);
  return DVI_OK;
}

dvi_status dvi_system_bracket(const dvi_system *system, const double *q, const double *p,
                              double *bracket, double *condition)
{
  dvi__evaluator *e;
  if (system == NULL || q == NULL || p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "bracket: an argument is NULL");
  if (system->constraint == NULL)
    return dvi__fail(DVI_UNSUPPORTED, "bracket: the system declares no constraints phi(q,p)");
  const size_t n = (size_t)system->n;
  if (dvi__first_not_finite(n, q) >= 0 || dvi__first_not_finite(n, p) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "bracket: the point is not finite");
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e));
  const dvi_status status = measure_violation(e, q, p, bracket, condition);
  dvi__evaluator_destroy(&e);
  return status;
}

int dvi_system_constraint_count(const dvi_system *system)
{
  if (system == NULL) return 0;
  return system->constraint != NULL ? system->constraint->callbacks.count : system->row_count;
}

/* ---- the kind ---- */

static int constraint_is_declared(const dvi_system_terms *terms)
{
  return terms->hamiltonian != NULL && terms->constraint != NULL;
}

static dvi_status declare_constrained(const dvi_system_terms *terms, dvi_system *system)
{
  DVI_TRY(dvi__declare_hamiltonian(terms, system, DVI__CONSTRAINED_HAMILTONIAN));
  return dvi__constraint_copy(terms->constraint, system->n, &system->constraint);
}

static dvi_status constrained_velocity(dvi__evaluator *e, double t, const double *q,
                                       const double *p, double *v)
{
  double *found = e->velocity_search;
  const size_t n = (size_t)e->system->n;
  DVI_TRY(constrained_motion(e, t, q, p, found, found + n, NULL));
  memcpy(v, found, n * sizeof *v);
  return DVI_OK;
}

static const dvi__state_constraint on_phase_space = {
    .matrix = "constraints' bracket matrix",
    .check = check_on_constraint,
    .project = project_on_constraint,
    .distance = constraint_distance,
    .size = constraint_size,
    .side = bracket_side,
};

const dvi__dynamics dvi__dynamics_constrained_hamiltonian = {
    .name = "Hamiltonian with constraints",
    .function = "Hamiltonian",
    .equations = DVI__HAMILTON,
    .by_momentum = 1,
    .no_taylor = dvi__no_taylor_of_hamiltonian,
    .is_declared = constraint_is_declared,
    .declare = declare_constrained,
    .prepare = prepare_constraints,
    .release = release_constraints,
    .velocity = constrained_velocity,
    .motion = constrained_motion,
    .energy = dvi__energy_of_hamiltonian,
    .value = dvi__value_of_point,
    .forces = dvi__forces_of_point,
    .momentum = dvi__momentum_of_point,
    .constraint = &on_phase_space,
};
