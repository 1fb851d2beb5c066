#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "step/hamiltonian/phase_struct.h"
#include "step/joint.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "space/legendre.h"

enum { MOST = DVI__STAGES_MOST };

/* ---- making it ---- */

static double **owned(dvi__phase *f, int i)
{
  double **const all[] = {&f->kick,   &f->impulse, &f->t,     &f->Z,     &f->F,      &f->phi,
                          &f->H_qq,   &f->H_qp,    &f->H_pp,  &f->phi_z, &f->phi_qq, &f->phi_qp,
                          &f->phi_pp, &f->slope,   &f->point, &f->end,   &f->field,  &f->weight};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status allocate(dvi__phase *f)
{
  const dvi_system *s = f->system;
  const dvi__constraint_term *c = s->constraint;
  const size_t z = 2 * (size_t)f->n, m = (size_t)f->m, d = (size_t)f->d;
#define ENTRIES(pattern) (size_t) dvi__pattern_entries(&(pattern))
  const size_t size[] = {z,
                         m,
                         d,
                         z * d,
                         z * d,
                         m * d,
                         ENTRIES(s->qq) * d,
                         ENTRIES(s->qv) * d,
                         ENTRIES(s->vv) * d,
                         ENTRIES(c->gradients) * (d + 1),
                         ENTRIES(c->weighted.qq),
                         ENTRIES(c->weighted.qv),
                         ENTRIES(c->weighted.vv),
                         ENTRIES(f->joint) * (d + 1),
                         z,
                         z,
                         z,
                         m};
#undef ENTRIES
  for (int i = 0; owned(f, i) != NULL; i++) {
    *owned(f, i) = DVI_NEW(double, size[i]);
    if (*owned(f, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "phase space: no memory for %d stages in %d dimensions", f->d,
                       f->n);
  }
  return DVI_OK;
}

static dvi_status fill_tables(dvi__phase *f)
{
  DVI_TRY(dvi_quadrature(DVI_GAUSS, f->d, f->c, f->b));
  DVI_TRY(dvi__collocate(f->d, f->c, f->a));
  for (int i = 0; i < f->d; i++) {
    long double value[MOST + 1], difference[MOST + 1];
    dvi__legendre(f->d, 1 - (long double)f->c[i], value, difference);
    for (int l = 0; l <= f->d; l++) f->legendre[i][l] = (double)value[l];
  }
  return DVI_OK;
}

static dvi_status fill(dvi__phase *f, dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(f->system, f->d + 1, 2 * (f->d + 1)));
  DVI_TRY(fill_tables(f));
  DVI_TRY(dvi__evaluator_create(f->system, f->d, DVI__HESSIANS, counters, &f->evaluator));
  DVI_TRY(dvi__phase_lay_out(f));
  return allocate(f);
}

dvi_status dvi__phase_create(const dvi_system *system, int degree, int moments,
                             dvi_counters *counters, dvi__phase **phase)
{
  *phase = NULL;
  dvi__phase *f = DVI_NEW(dvi__phase, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  f->system = system;
  f->n = system->n;
  f->m = system->constraint->callbacks.count;
  f->d = degree;
  f->k = moments;
  const dvi_status status = fill(f, counters);
  if (status != DVI_OK) dvi__phase_destroy(&f);
  *phase = f;
  return status;
}

void dvi__phase_destroy(dvi__phase **phase)
{
  dvi__phase *f = *phase;
  if (f == NULL) return;
  for (int i = 0; owned(f, i) != NULL; i++) dvi__release(*owned(f, i));
  dvi__phase_clear_layout(f);
  dvi__evaluator_destroy(&f->evaluator);
  dvi__release(f);
  *phase = NULL;
}

const dvi__pattern *dvi__phase_pattern(const dvi__phase *f)
{
  return &f->pattern;
}

dvi__evaluator *dvi__phase_evaluator(const dvi__phase *f)
{
  return f->evaluator;
}

/* ---- the points of a step ---- */

static const double *row_of(const dvi__phase *f, const double *x, int component)
{
  return x + component * (f->d + 1);
}

/* h lambda' of a constraint, and behind it the coefficients of h Lambda. */
static const double *multipliers(const dvi__phase *f, const double *x, int constraint)
{
  return x + 2 * f->n * (f->d + 1) + constraint * (f->k + 1);
}

static double *gradients_at(const dvi__phase *f, int stage)
{
  return f->phi_z + (size_t)stage * (size_t)dvi__pattern_entries(&f->system->constraint->gradients);
}

dvi_status dvi__phase_place(dvi__phase *f, double t0, double h, const double *q, const double *p,
                            const double *multiplier)
{
  f->t0 = t0;
  f->h = h;
  f->q0 = q;
  f->p0 = p;
  for (int i = 0; i < f->d; i++) f->t[i] = t0 + f->c[i] * h;
  for (int a = 0; a < f->m; a++) f->impulse[a] = h * multiplier[a];
  memset(f->kick, 0, 2 * (size_t)f->n * sizeof *f->kick);
  DVI_TRY(dvi__constraint_gradients(f->evaluator, q, p, f->phi_z));
  dvi__constraint_push(f->system->constraint, f->phi_z, f->impulse, 0.5, f->kick);
  return DVI_OK;
}

static double start_of(const dvi__phase *f, int component)
{
  return component < f->n ? f->q0[component] : f->p0[component - f->n];
}

static void points(dvi__phase *f, const double *x)
{
  const int d = f->d;
  for (int c = 0; c < 2 * f->n; c++) {
    const double *W = row_of(f, x, c), from = start_of(f, c);
    for (int i = 0; i < d; i++) {
      double sum = f->kick[c];
      for (int j = 0; j < d; j++) sum += f->a[i][j] * W[j];
      f->Z[c * d + i] = from + sum;
    }
    f->end[c] = from + W[d];
  }
}

/* One stage into f->point, and h Lambda there into f->weight. */
static void take_stage(const dvi__phase *f, const double *x, int i)
{
  for (int c = 0; c < 2 * f->n; c++) f->point[c] = f->Z[c * f->d + i];
  for (int a = 0; a < f->m; a++) {
    f->weight[a] = 0;
    for (int l = 0; l < f->k; l++) f->weight[a] += f->legendre[i][l] * multipliers(f, x, a)[1 + l];
  }
}

static void take_end(const dvi__phase *f, const double *x)
{
  memcpy(f->point, f->end, 2 * (size_t)f->n * sizeof *f->point);
  for (int a = 0; a < f->m; a++) f->weight[a] = multipliers(f, x, a)[0];
}

/* At the point that was taken: the constraint's gradients, kept for `stage`, and f->field, X_phi
 * times the weights. */
static dvi_status push(dvi__phase *f, int stage)
{
  double *phi_z = gradients_at(f, stage);
  memset(f->field, 0, 2 * (size_t)f->n * sizeof *f->field);
  DVI_TRY(dvi__constraint_gradients(f->evaluator, f->point, f->point + f->n, phi_z));
  dvi__constraint_push(f->system->constraint, phi_z, f->weight, 1, f->field);
  return DVI_OK;
}

/* ---- residual ---- */

/* F = h X_H + h X_phi Lambda at the stages; without moments no constraint acts there. */
static dvi_status fields(dvi__phase *f, const double *x)
{
  const int half = f->n * f->d;
  DVI_TRY(dvi__lagrangian_gradient(f->evaluator, f->d, f->t, f->Z, f->Z + half, f->F + half, f->F));
  for (int c = 0; c < half; c++) {
    f->F[c] *= f->h;
    f->F[half + c] *= -f->h;
  }
  for (int i = 0; i < f->d && f->k > 0; i++) {
    take_stage(f, x, i);
    DVI_TRY(push(f, i));
    DVI_TRY(dvi__constraint_value(f->evaluator, f->point, f->point + f->n, f->phi + i * f->m));
    for (int c = 0; c < 2 * f->n; c++) f->F[c * f->d + i] += f->field[c];
  }
  return DVI_OK;
}

static double moment(const dvi__phase *f, int constraint, int l)
{
  double sum = 0;
  for (int i = 0; i < f->d; i++) sum += f->b[i] * f->legendre[i][l] * f->phi[i * f->m + constraint];
  return sum;
}

dvi_status dvi__phase_residual(dvi__phase *f, const double *x, double *R)
{
  const int d = f->d;
  points(f, x);
  DVI_TRY(fields(f, x));
  take_end(f, x);
  DVI_TRY(push(f, d));
  DVI_TRY(dvi__constraint_value(f->evaluator, f->point, f->point + f->n, f->weight));
  for (int c = 0; c < 2 * f->n; c++, R += d + 1) {
    const double *W = row_of(f, x, c);
    R[d] = W[d] - f->kick[c] - 0.5 * f->field[c];
    for (int i = 0; i < d; i++) {
      R[i] = W[i] - f->F[c * d + i];
      R[d] -= f->b[i] * W[i];
    }
  }
  for (int a = 0; a < f->m; a++) {
    *R++ = f->weight[a];
    for (int l = 0; l < f->k; l++) *R++ = moment(f, a, l);
  }
  return DVI_OK;
}

/* ---- Jacobian ---- */

/* slope += factor times the derivative of the field (F_p, -F_q); entry e of F_qq is qq[e *
 * stride]. */
static void add_slope(const dvi__vector_field_places *at, const dvi__lagrangian_term *of,
                      const double *qq, const double *qp, const double *pp, int stride,
                      double factor, double *slope)
{
  for (int e = 0; e < dvi__pattern_entries(&of->qq); e++)
    slope[at->qq[e]] -= factor * qq[e * stride];
  for (int e = 0; e < dvi__pattern_entries(&of->vv); e++)
    slope[at->pp[e]] += factor * pp[e * stride];
  for (int e = 0; e < dvi__pattern_entries(&of->qv); e++) {
    slope[at->qp_in_p[e]] -= factor * qp[e * stride];
    slope[at->qp_in_q[e]] += factor * qp[e * stride];
  }
}

/* What the constraints with the weights add at the point that was taken. */
static dvi_status add_constraints(dvi__phase *f, double *slope)
{
  DVI_TRY(dvi__constraint_hessian(f->evaluator, f->point, f->point + f->n, f->weight, f->phi_qq,
                                  f->phi_qp, f->phi_pp));
  add_slope(&f->of_phi, &f->system->constraint->weighted, f->phi_qq, f->phi_qp, f->phi_pp, 1, 1,
            slope);
  return DVI_OK;
}

static dvi_status slopes(dvi__phase *f, const double *x)
{
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  const int half = f->n * f->d;
  memset(f->slope, 0, entries * ((size_t)f->d + 1) * sizeof *f->slope);
  DVI_TRY(dvi__lagrangian_hessian(f->evaluator, f->d, f->t, f->Z, f->Z + half, f->H_qq, f->H_qp,
                                  f->H_pp));
  for (int i = 0; i < f->d; i++) {
    double *slope = f->slope + (size_t)i * entries;
    add_slope(&f->of_H, f->system->lagrangian, f->H_qq + i, f->H_qp + i, f->H_pp + i, f->d, f->h,
              slope);
    if (f->k == 0) continue;
    take_stage(f, x, i);
    DVI_TRY(push(f, i));
    DVI_TRY(add_constraints(f, slope));
  }
  take_end(f, x);
  DVI_TRY(push(f, f->d));
  return add_constraints(f, f->slope + (size_t)f->d * entries);
}

/* Rows of two components' block in column l: of W_l, or of {z'} - {z}. */
static void component_column(const dvi__phase *f, int e, int same, int l, double *column)
{
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  const int d = f->d;
  for (int i = 0; i < d; i++)
    column[i] = l == d ? 0
                       : (same && i == l) - f->a[i][l] * f->slope[(size_t)i * entries + (size_t)e];
  if (l == d)
    column[d] = same - 0.5 * f->slope[(size_t)d * entries + (size_t)e];
  else
    column[d] = same ? -f->b[l] : 0;
}

/* Rows of a constraint in the same column. */
static void constraint_rows(const dvi__phase *f, int gradient, int l, double *column)
{
  column[0] = l == f->d ? gradients_at(f, f->d)[gradient] : 0;
  for (int k = 0; k < f->k; k++) {
    column[1 + k] = 0;
    for (int i = 0; i < f->d && l < f->d; i++)
      column[1 + k] += f->b[i] * f->legendre[i][k] * gradients_at(f, i)[gradient] * f->a[i][l];
  }
}

/* Rows of a component in a constraint's column l: of h lambda', or of a coefficient of h Lambda. In
 * q stand phi_p, in p -phi_q. */
static void constraint_column(const dvi__phase *f, int gradient, double sign, int l, double *column)
{
  for (int i = 0; i < f->d; i++)
    column[i] = l == 0 ? 0 : -sign * f->legendre[i][l - 1] * gradients_at(f, i)[gradient];
  column[f->d] = l == 0 ? -0.5 * sign * gradients_at(f, f->d)[gradient] : 0;
}

dvi_status dvi__phase_jacobian(dvi__phase *f, const double *x, double *values)
{
  const int z = 2 * f->n;
  points(f, x);
  DVI_TRY(slopes(f, x));
  for (int j = 0; j < f->joint.columns; j++)
    for (int l = 0; l <= (j < z ? f->d : f->k); l++)
      for (int e = f->joint.start[j]; e < f->joint.start[j + 1]; e++) {
        const int i = f->joint.row[e];
        if (j >= z)
          constraint_column(f, f->gradient[e], i < f->n ? 1 : -1, l, values);
        else if (i < z)
          component_column(f, e, i == j, l, values);
        else
          constraint_rows(f, f->gradient[e], l, values);
        values += 1 + (i < z ? f->d : f->k);
      }
  return DVI_OK;
}

/* Rows of z are of the size of the unknowns, those of a constraint of its gradient's. */
dvi_status dvi__phase_scale(dvi__phase *f, double *scale)
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  DVI_TRY(dvi__constraint_gradients(f->evaluator, f->q0, f->p0, f->phi_z));
  for (int c = 0; c < 2 * f->n * (f->d + 1); c++) *scale++ = 1;
  for (int a = 0; a < f->m; a++) {
    double largest = 0;
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++)
      largest = fmax(largest, fabs(f->phi_z[e]));
    for (int l = 0; l <= f->k; l++) *scale++ = largest > 0 ? largest : 1;
  }
  return DVI_OK;
}

/* ---- the end ---- */

void dvi__phase_end(const dvi__phase *f, const double *x, double *dq, double *dp,
                    double *multiplier)
{
  for (int i = 0; i < f->n; i++) {
    dq[i] = row_of(f, x, i)[f->d];
    dp[i] = row_of(f, x, f->n + i)[f->d];
  }
  for (int a = 0; a < f->m; a++) multiplier[a] = multipliers(f, x, a)[0] / f->h;
}

dvi_status dvi__phase_jump(dvi__phase *f, const double *x, double *jump, double *change)
{
  const size_t bytes = 2 * (size_t)f->n * sizeof *jump;
  points(f, x);
  take_end(f, x);
  DVI_TRY(push(f, f->d));
  memcpy(jump, f->field, bytes);
  memcpy(change, f->field, bytes);
  dvi__constraint_push(f->system->constraint, gradients_at(f, f->d), f->impulse, -1, change);
  return DVI_OK;
}

/* The gradients are those of the end, where the multipliers of q's kicks are those of phi_p. */
static void add_kicks(const dvi__phase *f, const double *x, double size[2])
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  const double *phi_z = gradients_at(f, f->d);
  for (int a = 0; a < f->m; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      double *of = &size[gradients->row[e] < f->n];
      *of = fmax(*of, fabs(phi_z[e]) * dvi__largest((size_t)f->k + 1, multipliers(f, x, a)));
    }
}

static double largest_entry(const dvi__phase *f, const dvi__pattern *pattern, const double *values)
{
  return dvi__largest((size_t)dvi__pattern_entries(pattern) * (size_t)f->d, values);
}

void dvi__phase_sizes(const dvi__phase *f, const double *x, double size[2])
{
  const dvi_system *s = f->system;
  size[0] = dvi__largest((size_t)f->n, f->q0);
  size[1] = dvi__largest((size_t)f->n, f->p0);
  add_kicks(f, x, size);
  const double h = fabs(f->h), of_q = size[0];
  size[0] += h * largest_entry(f, &s->vv, f->H_pp) * size[1];
  size[1] += h * largest_entry(f, &s->qq, f->H_qq) * of_q;
}

/* ---- guesses ---- */

/* Nothing is known of p' and of Lambda yet; the multiplier of the node stays. */
void dvi__phase_straight(const dvi__phase *f, const double *v, double *x)
{
  for (int c = 0; c < 2 * f->n; c++)
    for (int i = 0; i <= f->d; i++) *x++ = c < f->n ? f->h * v[c] : 0;
  for (int a = 0; a < f->m; a++) {
    *x++ = f->impulse[a];
    for (int l = 0; l < f->k; l++) *x++ = 0;
  }
}

void dvi__phase_continue(const dvi__phase *f, double ratio, const double *last, double *x)
{
  const int d = f->d;
  for (int i = 0; i < d; i++) {
    double weight[MOST];
    dvi__lagrange_weights(d, f->c, 1 + ratio * f->c[i], weight);
    for (int c = 0; c < 2 * f->n; c++) {
      double sum = 0;
      for (int j = 0; j < d; j++) sum += weight[j] * row_of(f, last, c)[j];
      x[c * (d + 1) + i] = ratio * sum;
    }
  }
  for (int c = 0; c < 2 * f->n; c++) x[c * (d + 1) + d] = ratio * row_of(f, last, c)[d];
  for (int i = 2 * f->n * (d + 1); i < f->pattern.columns; i++) x[i] = ratio * last[i];
}
