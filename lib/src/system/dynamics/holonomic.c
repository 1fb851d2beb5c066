/* Holonomic constraints beside a constant mass or a general Lagrangian.
 *
 * The acceleration a and the multipliers solve the equations of motion of index 1,
 *
 *     [ L_vv  G^T ] [ a      ]   [ L_q + F - c ]
 *     [ G     0   ] [ lambda ] = [ -gamma      ],
 *
 * where c and gamma are the derivatives of L_v and of G v + phi_t along (1, v, 0). A momentum is
 * moved onto the constraint by the same matrix. Source: Brenan, Campbell and Petzold 1996, sec. 2.2
 * (reduction of the index). */
#include "system/dynamics/holonomic.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/mass.h"
#include "system/term/holonomic.h"

/* ---- an evaluator's part ---- */

typedef struct rows_memory {
  dvi__pattern matrix;                        /* of [L_vv G^T; G 0] */
  int *mass_place, *column_place, *row_place; /* places of L_vv, of G^T and of G */
  dvi__linear *linear;
  double *values, *x;          /* [entries], [n + m] */
  double *phi, *phi_t, *phi_q; /* [m], [m], [entries of rows_q] */
  double *point, *along[2];    /* [n] a moved point, [n + m] derivatives along the motion */
  double *hessian, *sum;       /* [entries of rows_qq], [n] */
  double *numbers;
} rows_memory;

static rows_memory *rows_of(const dvi__evaluator *e)
{
  return e->own;
}

/* Make the pattern of the matrix, with the places of its parts. */
static dvi_status lay_out_matrix(const dvi_system *s, rows_memory *r)
{
  const int n = s->n, m = s->row_count;
  const size_t mass = (size_t)dvi__pattern_entries(&s->vv),
               rows = (size_t)dvi__pattern_entries(&s->rows_q);
  dvi__pattern by_row = {0};
  int at = 0;
  r->matrix = (dvi__pattern){n + m, n + m, DVI_NEW(int, (size_t)n + (size_t)m + 1),
                             DVI_NEW(int, mass + 2 * rows)};
  r->mass_place = DVI_NEW(int, mass);
  r->column_place = DVI_NEW(int, rows);
  r->row_place = DVI_NEW(int, rows);
  if (!r->matrix.start || !r->matrix.row || !r->mass_place || !r->column_place || !r->row_place)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for %d rows", m);
  DVI_TRY(dvi__pattern_transpose(&s->rows_q, &by_row));
  for (int j = 0; j < n; j++) {
    r->matrix.start[j] = at;
    for (int k = s->vv.start[j]; k < s->vv.start[j + 1]; k++) {
      r->mass_place[k] = at;
      r->matrix.row[at++] = s->vv.row[k];
    }
    for (int k = by_row.start[j]; k < by_row.start[j + 1]; k++) {
      r->row_place[dvi__pattern_find(&s->rows_q, j, by_row.row[k])] = at;
      r->matrix.row[at++] = n + by_row.row[k];
    }
  }
  for (int a = 0; a < m; a++) {
    r->matrix.start[n + a] = at;
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++) {
      r->column_place[k] = at;
      r->matrix.row[at++] = s->rows_q.row[k];
    }
  }
  r->matrix.start[n + m] = at;
  dvi__pattern_clear(&by_row);
  return DVI_OK;
}

static dvi_status prepare_rows(dvi__evaluator *e)
{
  const dvi_system *s = e->system;
  const size_t n = (size_t)s->n, m = (size_t)s->row_count,
               rows = (size_t)dvi__pattern_entries(&s->rows_q);
  rows_memory *r = e->own = DVI_NEW(rows_memory, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "constraints: no memory");
  DVI_TRY(lay_out_matrix(s, r));
  r->values = DVI_NEW(double, dvi__pattern_entries(&r->matrix));
  r->hessian = DVI_NEW(double, dvi__pattern_entries(&s->rows_qq));
  double *at = r->numbers = DVI_NEW(double, 5 * n + 5 * m + rows);
  if (r->values == NULL || r->hessian == NULL || at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for %zu rows", m);
  r->x = at;
  r->along[0] = r->x + n + m;
  r->along[1] = r->along[0] + n + m;
  r->point = r->along[1] + n + m;
  r->sum = r->point + n;
  r->phi = r->sum + n;
  r->phi_t = r->phi + m;
  r->phi_q = r->phi_t + m;
  return dvi__linear_create(&r->matrix, dvi__linear_for_exchanges(&r->matrix), e->counters,
                            &r->linear);
}

static void release_rows(dvi__evaluator *e)
{
  rows_memory *r = e->own;
  if (r == NULL) return;
  dvi__linear_destroy(&r->linear);
  dvi__pattern_clear(&r->matrix);
  dvi__release(r->mass_place);
  dvi__release(r->column_place);
  dvi__release(r->row_place);
  dvi__release(r->values);
  dvi__release(r->hessian);
  dvi__release(r->numbers);
  dvi__release(r);
}

/* ---- all rows at one point ---- */

dvi_status dvi__rows_value(dvi__evaluator *e, double t, const double *q, double *phi)
{
  const dvi_system *s = e->system;
  e->counters->values++;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_value(&s->holonomics[k], t, q, phi + s->holonomics[k].first));
  return DVI_OK;
}

dvi_status dvi__rows_gradients(dvi__evaluator *e, double t, const double *q, double *phi_q)
{
  const dvi_system *s = e->system;
  e->counters->gradients++;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_gradient(&s->holonomics[k], t, q,
                                    phi_q + s->rows_q.start[s->holonomics[k].first]));
  return DVI_OK;
}

dvi_status dvi__rows_rate(dvi__evaluator *e, double t, const double *q, double *phi_t)
{
  const dvi_system *s = e->system;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_rate(&s->holonomics[k], t, q, phi_t + s->holonomics[k].first));
  return DVI_OK;
}

dvi_status dvi__rows_hessian(dvi__evaluator *e, double t, const double *q, const double *w,
                             double *phi_w_qq)
{
  const dvi_system *s = e->system;
  const rows_memory *r = rows_of(e);
  e->counters->hessians++;
  memset(phi_w_qq, 0, (size_t)dvi__pattern_entries(&s->rows_qq) * sizeof(double));
  for (int k = 0; k < s->holonomic_count; k++) {
    const dvi__holonomic_term *term = &s->holonomics[k];
    const dvi__holonomic_at at = {.term = term,
                                  .t = t,
                                  .w = w + term->first,
                                  .point = r->point,
                                  .phi_q = r->phi_q,
                                  .sum = r->sum};
    DVI_TRY(dvi__holonomic_hessian(&at, &e->scratch, q, r->hessian));
    for (int entry = 0; entry < dvi__pattern_entries(&term->qq); entry++)
      phi_w_qq[term->in_qq[entry]] += r->hessian[entry];
  }
  dvi__count_differences(e);
  return DVI_OK;
}

void dvi__rows_pull(const dvi_system *s, const double *phi_q, const double *w, double factor,
                    double *x)
{
  for (int a = 0; a < s->row_count; a++)
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      x[s->rows_q.row[k]] += factor * w[a] * phi_q[k];
}

/* Compute G x + phi_t. */
static void push_rows(const dvi_system *s, const double *phi_q, const double *x,
                      const double *phi_t, double *sum)
{
  for (int a = 0; a < s->row_count; a++) {
    sum[a] = phi_t[a];
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      sum[a] += phi_q[k] * x[s->rows_q.row[k]];
  }
}

/* ---- the matrix ---- */

/* Return L_vv, which is the constant mass, or a general Lagrangian's at this velocity. */
static dvi_status velocity_matrix(dvi__evaluator *e, double t, const double *q, const double *v,
                                  const double **L_vv)
{
  const dvi_system *s = e->system;
  *L_vv = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  return s->lagrangian != NULL ? dvi__velocity_hessian(e, t, q, v, L_vv) : DVI_OK;
}

/* Factor the matrix at a point, whose gradients stay in phi_q. */
static dvi_status factor_matrix(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi_system *s = e->system;
  rows_memory *r = rows_of(e);
  const double *L_vv;
  DVI_TRY(velocity_matrix(e, t, q, v, &L_vv));
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int k = 0; k < dvi__pattern_entries(&s->vv); k++) r->values[r->mass_place[k]] = L_vv[k];
  for (int k = 0; k < dvi__pattern_entries(&s->rows_q); k++)
    r->values[r->column_place[k]] = r->values[r->row_place[k]] = r->phi_q[k];
  const dvi_status status = dvi__linear_factor(r->linear, r->values);
  return status != DVI_SINGULAR
             ? status
             : dvi__fail(status,
                         "the holonomic constraints are dependent at t = %.6g, or the mass is "
                         "singular along them",
                         t);
}

/* Solve for r->x in place. */
static dvi_status solve_matrix(const rows_memory *r, int size, double t)
{
  DVI_TRY(dvi__linear_solve(r->linear, r->x));
  if (dvi__first_not_finite((size_t)size, r->x) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the multipliers at t = %.6g are not finite", t);
}

/* ---- the motion ---- */

/* Evaluate (L_v, G v + phi_t) at the point moved by tau along the motion, with the same v. */
static dvi_status moved_along(dvi__evaluator *e, double t, double tau, const double *q,
                              const double *v, double *sum)
{
  const dvi_system *s = e->system;
  rows_memory *r = rows_of(e);
  const double moved = t + tau;
  for (int i = 0; i < s->n; i++) r->point[i] = q[i] + tau * v[i];
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &moved, r->point, v, NULL, sum));
  DVI_TRY(dvi__rows_gradients(e, moved, r->point, r->phi_q));
  DVI_TRY(dvi__rows_rate(e, moved, r->point, r->phi_t));
  push_rows(s, r->phi_q, v, r->phi_t, sum + s->n);
  return DVI_OK;
}

/* Choose the step of differences along the motion, as system/term/difference.c does for
 * coordinates. */
static double step_along(const dvi_system *s, double t, const double *q, const double *v)
{
  const double size = fmax(dvi__largest((size_t)s->n, q), 1e-2),
               speed = dvi__largest((size_t)s->n, v), relative = pow(DBL_EPSILON, 1.0 / 7.0);
  const double by_time = s->autonomous ? HUGE_VAL : fmax(fabs(t), 1.0);
  const double span = fmin(speed > 0 ? size / speed : HUGE_VAL, by_time);
  return ldexp(1.0, ilogb(relative * (isfinite(span) ? span : 1.0)));
}

/* Write the derivatives of (L_v, G v + phi_t) along the motion, by differences of order 6, into
 * r->x. */
static dvi_status differentiate_along(dvi__evaluator *e, double t, const double *q, const double *v)
{
  static const double weight[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
  rows_memory *r = rows_of(e);
  const int size = e->system->n + e->system->row_count;
  const double step = step_along(e->system, t, q, v);
  memset(r->x, 0, (size_t)size * sizeof(double));
  for (int m = 1; m <= 3; m++) {
    DVI_TRY(moved_along(e, t, m * step, q, v, r->along[0]));
    DVI_TRY(moved_along(e, t, -m * step, q, v, r->along[1]));
    for (int i = 0; i < size; i++)
      r->x[i] += weight[m - 1] / step * (r->along[0][i] - r->along[1][i]);
  }
  return DVI_OK;
}

dvi_status dvi__rows_acceleration(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *a, double *lambda)
{
  const dvi_system *s = e->system;
  rows_memory *r = rows_of(e);
  const int size = s->n + s->row_count;
  DVI_TRY(differentiate_along(e, t, q, v));
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, r->along[0], NULL));
  for (int i = 0; i < size; i++) r->x[i] = (i < s->n ? r->along[0][i] : 0) - r->x[i];
  DVI_TRY(factor_matrix(e, t, q, v));
  DVI_TRY(solve_matrix(r, size, t));
  if (a != NULL) memcpy(a, r->x, (size_t)s->n * sizeof(double));
  memcpy(lambda, r->x + s->n, (size_t)s->row_count * sizeof(double));
  return DVI_OK;
}

/* Compute L_q + F - G^T lambda. */
static dvi_status constrained_forces(dvi__evaluator *e, double t, const double *q, const double *v,
                                     double *forces)
{
  const rows_memory *r = rows_of(e);
  double *lambda = r->phi;
  DVI_TRY(dvi__rows_acceleration(e, t, q, v, NULL, lambda));
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, forces, NULL));
  dvi__rows_pull(e->system, r->phi_q, lambda, -1, forces);
  return DVI_OK;
}

static dvi_status constrained_motion(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier)
{
  const rows_memory *r = rows_of(e);
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  if (pdot == NULL) return DVI_OK;
  DVI_TRY(constrained_forces(e, t, q, v, pdot));
  if (multiplier != NULL)
    memcpy(multiplier, r->phi, (size_t)e->system->row_count * sizeof *multiplier);
  return DVI_OK;
}

/* ---- the constraint of states ---- */

/* A start computed in another way differs by its roundings. A larger violation is refused. */
static const double on_constraint = 1e-11;

/* Find the term of a row. */
static const dvi__holonomic_term *term_of_row(const dvi_system *s, int a)
{
  int k = s->holonomic_count - 1;
  while (s->holonomics[k].first > a) k--;
  return &s->holonomics[k];
}

/* Sum the magnitudes of a row of G x. */
static double row_size(const dvi_system *s, const double *phi_q, int a, const double *x)
{
  double size = 0;
  for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
    size += fabs(phi_q[k] * x[s->rows_q.row[k]]);
  return size;
}

static dvi_status rows_distance(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *distance)
{
  const rows_memory *r = rows_of(e);
  (void)p;
  DVI_TRY(dvi__rows_value(e, t, q, r->phi));
  *distance = dvi__largest((size_t)e->system->row_count, r->phi);
  return DVI_OK;
}

static dvi_status rows_size(dvi__evaluator *e, double t, const double *q, const double *p,
                            double *size)
{
  const rows_memory *r = rows_of(e);
  (void)p;
  *size = 0;
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int a = 0; a < e->system->row_count; a++)
    *size = fmax(*size, row_size(e->system, r->phi_q, a, q));
  return DVI_OK;
}

static dvi_status refuse_row(const dvi_system *s, int a, double t, const char *what, double value)
{
  const dvi__holonomic_term *term = term_of_row(s, a);
  char row[32] = "";
  if (term->callbacks.count > 1) (void)snprintf(row, sizeof row, " (row %d)", a - term->first);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "constraint '%s'%s%s is %.17g at t = %.6g, not 0; start on the constraint, or "
                   "let the start be projected (dvi_start_options)",
                   term->name, row, what, value, t);
}

static dvi_status check_rows(dvi__evaluator *e, double t, const double *q, const double *p)
{
  const dvi_system *s = e->system;
  const rows_memory *r = rows_of(e);
  double *v = r->along[0], *rate = r->along[1];
  DVI_TRY(dvi__rows_value(e, t, q, r->phi));
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int a = 0; a < s->row_count; a++)
    if (!(fabs(r->phi[a]) <= on_constraint * row_size(s, r->phi_q, a, q)))
      return refuse_row(s, a, t, "", r->phi[a]);
  memset(v, 0, (size_t)s->n * sizeof(double));
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  DVI_TRY(dvi__rows_rate(e, t, q, r->phi_t));
  push_rows(s, r->phi_q, v, r->phi_t, rate);
  for (int a = 0; a < s->row_count; a++)
    if (!(fabs(rate[a]) <= on_constraint * (row_size(s, r->phi_q, a, v) + fabs(r->phi_t[a]))))
      return refuse_row(s, a, t, ", its rate along the velocity,", rate[a]);
  return DVI_OK;
}

/* Solve L_v(v) + G^T mu = p, G v + phi_t = 0 by Newton's method. One iteration is exact for a
 * constant mass, and a second one rounds its residual off. */
dvi_status dvi__rows_project_momentum(dvi__evaluator *e, double t, const double *q, double *p,
                                      double *v)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi_system *s = e->system;
  rows_memory *r = rows_of(e);
  const int n = s->n, m = s->row_count, linear = s->lagrangian == NULL;
  double *mu = r->along[1], size = HUGE_VAL;
  memset(mu, 0, (size_t)m * sizeof(double));
  if (linear) memset(v, 0, (size_t)n * sizeof(double));
  DVI_TRY(dvi__rows_rate(e, t, q, r->phi_t));
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, NULL, r->along[0]));
    if (iteration == 0 || !linear) DVI_TRY(factor_matrix(e, t, q, v));
    dvi__rows_pull(s, r->phi_q, mu, 1, r->along[0]);
    for (int i = 0; i < n; i++) r->x[i] = p[i] - r->along[0][i];
    push_rows(s, r->phi_q, v, r->phi_t, r->x + n);
    for (int a = 0; a < m; a++) r->x[n + a] = -r->x[n + a];
    DVI_TRY(solve_matrix(r, n + m, t));
    for (int i = 0; i < n; i++) v[i] += r->x[i];
    for (int a = 0; a < m; a++) mu[a] += r->x[n + a];
    const double change = dvi__largest((size_t)n, r->x), speed = dvi__largest((size_t)n, v);
    if (change <= 4 * DBL_EPSILON * speed || (change <= 1e-10 * speed && change >= 0.5 * size)) {
      dvi__rows_pull(s, r->phi_q, mu, -1, p);
      return DVI_OK;
    }
    size = change;
  }
  return dvi__fail(DVI_NOT_CONVERGED, "no velocity on the constraints was found at t = %.6g", t);
}

/* Move q along M^-1 G^T onto the constraint, then the momentum. */
static dvi_status project_on_rows(dvi__evaluator *e, double t, double *q, double *p)
{
  enum { MOST_ITERATIONS = 50 };
  const dvi_system *s = e->system;
  rows_memory *r = rows_of(e);
  const size_t n = (size_t)s->n;
  double *v = e->point[0], size = HUGE_VAL, next;
  memset(v, 0, n * sizeof(double));
  if (s->lagrangian != NULL) DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  DVI_TRY(rows_distance(e, t, q, p, &next));
  for (int iteration = 0; iteration < MOST_ITERATIONS && next > 0 && next < size; iteration++) {
    size = next;
    DVI_TRY(factor_matrix(e, t, q, v));
    memset(r->x, 0, n * sizeof(double));
    for (int a = 0; a < s->row_count; a++) r->x[s->n + a] = -r->phi[a];
    DVI_TRY(solve_matrix(r, s->n + s->row_count, t));
    for (size_t i = 0; i < n; i++) r->point[i] = q[i] + r->x[i];
    DVI_TRY(rows_distance(e, t, r->point, p, &next));
    if (next < size) memcpy(q, r->point, n * sizeof *q);
  }
  DVI_TRY(dvi__rows_project_momentum(e, t, q, p, v));
  if (check_rows(e, t, q, p) == DVI_OK) return DVI_OK;
  return dvi__fail_in(DVI_NOT_CONVERGED, "no point of the constraints was found");
}

static dvi_status rows_side(dvi__evaluator *e, const double *q, const double *p, int *side)
{
  (void)e, (void)q, (void)p;
  *side = 1;
  return DVI_OK;
}

static const dvi__state_constraint on_rows = {
    .matrix = "matrix of the constraints",
    .check = check_rows,
    .project = project_on_rows,
    .distance = rows_distance,
    .size = rows_size,
    .side = rows_side,
};

/* ---- the kinds ---- */

static int constrained_mass_is_declared(const dvi_system_terms *terms)
{
  return terms->holonomic_count > 0 && terms->lagrangian == NULL && terms->one_form == NULL &&
         terms->hamiltonian == NULL && terms->factors == NULL;
}

static int constrained_lagrangian_is_declared(const dvi_system_terms *terms)
{
  return terms->holonomic_count > 0 && terms->lagrangian != NULL;
}

static dvi_status declare_lagrangian(const dvi_system_terms *terms, dvi_system *system)
{
  return dvi__dynamics_general_lagrangian.declare(terms, system);
}

static dvi_status prepare_constrained_mass(dvi__evaluator *e, dvi__derivatives most)
{
  DVI_TRY(dvi__dynamics_constant_mass.prepare(e, most));
  return prepare_rows(e);
}

static dvi_status prepare_constrained_lagrangian(dvi__evaluator *e, dvi__derivatives most)
{
  DVI_TRY(dvi__prepare_velocity_hessian(e, most));
  return prepare_rows(e);
}

static dvi_status velocity_by_mass(dvi__evaluator *e, double t, const double *q, const double *p,
                                   double *v)
{
  return dvi__dynamics_constant_mass.velocity(e, t, q, p, v);
}

const dvi__dynamics dvi__dynamics_constrained_mass = {
    .name = "constant mass with holonomic constraints",
    .function = "Lagrangian",
    .equations = DVI__CONSTRAINED_LAGRANGE,
    .has_kinetic_energy = 1,
    .is_declared = constrained_mass_is_declared,
    .declare = dvi__mass_copy,
    .prepare = prepare_constrained_mass,
    .release = release_rows,
    .velocity = velocity_by_mass,
    .motion = constrained_motion,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = constrained_forces,
    .momentum = dvi__momentum_of_point,
    .constraint = &on_rows,
};

const dvi__dynamics dvi__dynamics_constrained_lagrangian = {
    .name = "general Lagrangian with holonomic constraints",
    .function = "Lagrangian",
    .equations = DVI__CONSTRAINED_LAGRANGE,
    .searches_velocity = 1,
    .has_kinetic_energy = 1,
    .is_declared = constrained_lagrangian_is_declared,
    .declare = declare_lagrangian,
    .prepare = prepare_constrained_lagrangian,
    .release = release_rows,
    .velocity = dvi__search_velocity,
    .regular = dvi__velocity_hessian_is_regular,
    .motion = constrained_motion,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = constrained_forces,
    .momentum = dvi__momentum_of_point,
    .constraint = &on_rows,
};
