/* Holonomic and nonholonomic constraints beside a constant mass or a general Lagrangian.
 *
 * Every state fulfils G v + g = 0, where the rows of G and g are d phi/dq and d phi/dt, followed by
 * A and a. The acceleration a and the multipliers solve the equations of motion of index 1,
 *
 *     [ L_vv  G^T ] [ a      ]   [ L_q + F - c ]
 *     [ G     0   ] [ lambda ] = [ -gamma      ],
 *
 * where c and gamma are the derivatives of L_v and of G v + g along (1, v, 0). Sources: Brenan,
 * Campbell and Petzold 1996, sec. 2.2 (reduction of the index); Bloch 2003, sec. 5.2 (nonholonomic
 * constraints). */
#include "system/dynamics/holonomic.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/mass.h"
#include "system/term/holonomic.h"
#include "system/term/nonholonomic.h"

/* ---- an evaluator's part ---- */

dvi__rows_memory *dvi__rows_memory_of(const dvi__evaluator *e)
{
  return e->rows;
}

/* Make the pattern of the matrix, with the places of its parts. */
static dvi_status lay_out_matrix(const dvi_system *s, dvi__rows_memory *r)
{
  const int n = s->n, m = s->row_count;
  const size_t mass = (size_t)dvi__pattern_entries(&s->vv),
               rows = (size_t)dvi__pattern_entries(&s->rows_q);
  dvi__pattern by_row = {0};
  int at = 0;
  r->matrix = (dvi__pattern){n + m, n + m, DVI_NEW(int, (size_t)n + (size_t)m + 1),
                             DVI_NEW(int, mass + 2 * rows + (size_t)m)};
  r->mass_place = DVI_NEW(int, mass);
  r->column_place = DVI_NEW(int, rows);
  r->row_place = DVI_NEW(int, rows);
  r->own_place = DVI_NEW(int, m);
  r->diagonal = DVI_NEW(int, n);
  if (!r->matrix.start || !r->matrix.row || !r->mass_place || !r->column_place || !r->row_place ||
      !r->own_place || !r->diagonal)
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
    r->own_place[a] = at;
    r->matrix.row[at++] = n + a;
  }
  r->matrix.start[n + m] = at;
  for (int i = 0; i < n; i++) r->diagonal[i] = dvi__pattern_find(&s->vv, i, i);
  dvi__pattern_clear(&by_row);
  return DVI_OK;
}

static dvi_status create_matrix(dvi__evaluator *e)
{
  dvi__rows_memory *r = e->rows;
  DVI_TRY(lay_out_matrix(e->system, r));
  r->values = DVI_NEW(double, dvi__pattern_entries(&r->matrix));
  if (r->values == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for %d rows", e->system->row_count);
  return dvi__linear_create(&r->matrix, dvi__linear_for_exchanges(r->matrix.columns), e->counters,
                            &r->linear);
}

dvi_status dvi__rows_prepare(dvi__evaluator *e)
{
  const dvi_system *s = e->system;
  const size_t n = (size_t)s->n, m = (size_t)s->row_count,
               rows = (size_t)dvi__pattern_entries(&s->rows_q);
  dvi__rows_memory *r = e->rows = DVI_NEW(dvi__rows_memory, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "constraints: no memory");
  r->row_count = s->row_count;
  r->hessian = DVI_NEW(double, dvi__pattern_entries(&s->rows_qq));
  r->dependent = DVI_NEW(char, m);
  double *at = r->numbers = DVI_NEW(double, (10 + DVI__NOISE_SAMPLES) * n +
                                                (10 + DVI__NOISE_SAMPLES) * m + 3 * rows);
  if (r->hessian == NULL || r->dependent == NULL || at == NULL)
    return dvi__fail(DVI_NO_MEMORY, "constraints: no memory for %zu rows", m);
  r->x = at;
  r->along[0] = r->x + n + m;
  r->along[1] = r->along[0] + n + m;
  r->point = r->along[1] + n + m;
  r->sum = r->point + n;
  r->derivative = r->sum + n;
  r->before = r->derivative + n + m;
  r->defect = r->before + n + m;
  r->samples = r->defect + n + m;
  r->phi = r->samples + DVI__NOISE_SAMPLES * m;
  r->phi_t = r->phi + m;
  r->phi_q = r->phi_t + m;
  r->unit = r->phi_q + rows;
  r->moved_A = r->unit + n;
  r->scale = r->moved_A + rows;
  r->work = r->scale + m;
  r->line = r->work + n + m + rows;
  for (int c = 0; c < s->slot_count; c++)
    for (int i = 0; s->slots[c].kind != DVI__LINE && i < dvi__chart_stored(s->slots[c].kind); i++)
      r->unit[s->slots[c].q + i] = 1;
  return s->dynamics->on_manifold ? DVI_OK : create_matrix(e);
}

void dvi__rows_release(dvi__evaluator *e)
{
  dvi__rows_memory *r = e->rows;
  if (r == NULL) return;
  dvi__linear_destroy(&r->linear);
  dvi__pattern_clear(&r->matrix);
  dvi__release(r->mass_place);
  dvi__release(r->column_place);
  dvi__release(r->row_place);
  dvi__release(r->own_place);
  dvi__release(r->diagonal);
  dvi__release(r->dependent);
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
  for (int a = s->place_rows; a < s->row_count; a++) phi[a] = 0;
  return DVI_OK;
}

dvi_status dvi__rows_gradients(dvi__evaluator *e, double t, const double *q, double *phi_q)
{
  const dvi_system *s = e->system;
  e->counters->gradients++;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_gradient(&s->holonomics[k], t, q,
                                    phi_q + s->rows_q.start[s->holonomics[k].first]));
  for (int k = 0; k < s->nonholonomic_count; k++)
    DVI_TRY(dvi__nonholonomic_value(&s->nonholonomics[k], t, q,
                                    phi_q + s->rows_q.start[s->nonholonomics[k].first]));
  return DVI_OK;
}

int dvi__rows_have_batches(const dvi_system *s)
{
  for (int k = 0; k < s->holonomic_count; k++)
    if (s->holonomics[k].callbacks.value_batch == NULL ||
        s->holonomics[k].callbacks.gradient_batch == NULL)
      return 0;
  return s->holonomic_count > 0 && s->nonholonomic_count == 0;
}

dvi_status dvi__rows_values(dvi__evaluator *e, int count, const double *t, const double *q,
                            double *phi)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  e->counters->values += count;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_values(&s->holonomics[k], count, t, q, r->work,
                                  phi + (ptrdiff_t)s->holonomics[k].first * count));
  return DVI_OK;
}

dvi_status dvi__rows_all_gradients(dvi__evaluator *e, int count, const double *t, const double *q,
                                   double *phi_q)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  e->counters->gradients += count;
  for (int k = 0; k < s->holonomic_count; k++) {
    const ptrdiff_t first = s->rows_q.start[s->holonomics[k].first];
    DVI_TRY(
        dvi__holonomic_gradients(&s->holonomics[k], count, t, q, r->work, phi_q + first * count));
  }
  return DVI_OK;
}

dvi_status dvi__rows_rate(dvi__evaluator *e, double t, const double *q, double *phi_t)
{
  const dvi_system *s = e->system;
  for (int k = 0; k < s->holonomic_count; k++)
    DVI_TRY(dvi__holonomic_rate(&s->holonomics[k], t, q, phi_t + s->holonomics[k].first));
  for (int k = 0; k < s->nonholonomic_count; k++)
    DVI_TRY(
        dvi__nonholonomic_affine(&s->nonholonomics[k], t, q, phi_t + s->nonholonomics[k].first));
  return DVI_OK;
}

dvi_status dvi__rows_derivatives(dvi__evaluator *e, double t, const double *q, const double *v,
                                 double *Av_q)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  e->counters->hessians++;
  for (int k = 0; k < s->nonholonomic_count; k++) {
    const dvi__nonholonomic_term *term = &s->nonholonomics[k];
    const dvi__nonholonomic_at at = {.term = term, .t = t, .v = v, .A = r->moved_A};
    DVI_TRY(dvi__nonholonomic_derivative(&at, &e->scratch, q, Av_q));
    Av_q += dvi__pattern_entries(&term->by_q);
  }
  dvi__count_differences(e);
  return DVI_OK;
}

dvi_status dvi__rows_hessian(dvi__evaluator *e, double t, const double *q, const double *w,
                             double *phi_w_qq)
{
  const dvi_system *s = e->system;
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
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

void dvi__rows_push(const dvi_system *s, const double *phi_q, const double *x, const double *phi_t,
                    double *sum)
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

/* Return the square of a row's size in the metric of the inverse mass, by its diagonal. */
static double row_square(const dvi_system *s, const dvi__rows_memory *r, int a, const double *L_vv)
{
  double sum = 0;
  for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++) {
    const int on_diagonal = r->diagonal[s->rows_q.row[k]];
    const double mass = on_diagonal >= 0 ? fabs(L_vv[on_diagonal]) : 0;
    sum += r->phi_q[k] * (r->phi_q[k] / (mass > 0 ? mass : 1));
  }
  return sum;
}

/* Fill in the rows, each scaled by a power of two, because their size means nothing. */
static void fill_rows(const dvi_system *s, dvi__rows_memory *r, const double *L_vv)
{
  for (int a = 0; a < s->row_count; a++) {
    const double square = row_square(s, r, a, L_vv);
    const int known = square > 0 && isfinite(square);
    r->scale[a] = known ? ldexp(1.0, -(ilogb(square) / 2)) : 1;
    for (int k = s->rows_q.start[a]; k < s->rows_q.start[a + 1]; k++)
      r->values[r->column_place[k]] = r->values[r->row_place[k]] = r->scale[a] * r->phi_q[k];
    r->values[r->own_place[a]] = -r->softness * (known ? square * r->scale[a] * r->scale[a] : 1);
  }
}

dvi_status dvi__rows_factor(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const double *L_vv;
  DVI_TRY(velocity_matrix(e, t, q, v, &L_vv));
  DVI_TRY(dvi__rows_gradients(e, t, q, r->phi_q));
  for (int k = 0; k < dvi__pattern_entries(&s->vv); k++) r->values[r->mass_place[k]] = L_vv[k];
  fill_rows(s, r, L_vv);
  const dvi_status status = dvi__linear_factor(r->linear, r->values);
  return status != DVI_SINGULAR
             ? status
             : dvi__fail(status,
                         "the %sconstraints are dependent at t = %.6g, or the mass is singular "
                         "along them",
                         s->nonholonomic_count == 0 ? "holonomic "
                         : s->place_rows == 0       ? "nonholonomic "
                                                    : "",
                         t);
}

dvi_status dvi__rows_solve(const dvi__rows_memory *r, int size, double t)
{
  const int n = size - r->row_count;
  for (int i = n; i < size; i++) r->x[i] *= r->scale[i - n];
  DVI_TRY(dvi__linear_solve(r->linear, r->x));
  for (int i = n; i < size; i++) r->x[i] *= r->scale[i - n];
  if (dvi__first_not_finite((size_t)size, r->x) < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the multipliers at t = %.6g are not finite", t);
}

/* ---- the motion ---- */

/* Evaluate (L_v, G v + g) at the point moved by tau along the motion, with the same v. */
static dvi_status moved_along(dvi__evaluator *e, double t, double tau, const double *q,
                              const double *v, double *sum)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const double moved = t + tau;
  for (int i = 0; i < s->n; i++) r->point[i] = q[i] + tau * v[i];
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &moved, r->point, v, NULL, sum));
  DVI_TRY(dvi__rows_gradients(e, moved, r->point, r->phi_q));
  DVI_TRY(dvi__rows_rate(e, moved, r->point, r->phi_t));
  dvi__rows_push(s, r->phi_q, v, r->phi_t, sum + s->n);
  return DVI_OK;
}

/* Choose the longest step of differences along the motion. */
static double step_along(const dvi_system *s, double t, const double *q, const double *v)
{
  const double size = fmax(dvi__largest((size_t)s->n, q), 1e-2),
               speed = dvi__largest((size_t)s->n, v), relative = pow(DBL_EPSILON, 1.0 / 7.0);
  const double by_time = s->autonomous ? HUGE_VAL : fmax(fabs(t), 1.0);
  const double span = fmin(speed > 0 ? size / speed : HUGE_VAL, by_time);
  return ldexp(1.0, ilogb(relative * (isfinite(span) ? span : 1.0)));
}

/* Write differences of order 6 of (L_v, G v + g) along the motion into r->derivative. */
static dvi_status difference_along(dvi__evaluator *e, double t, double step, const double *q,
                                   const double *v)
{
  static const double weight[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int size = e->system->n + e->system->row_count;
  memset(r->derivative, 0, (size_t)size * sizeof(double));
  for (int m = 1; m <= 3; m++) {
    DVI_TRY(moved_along(e, t, m * step, q, v, r->along[0]));
    DVI_TRY(moved_along(e, t, -m * step, q, v, r->along[1]));
    for (int i = 0; i < size; i++)
      r->derivative[i] += weight[m - 1] / step * (r->along[0][i] - r->along[1][i]);
  }
  return DVI_OK;
}

/* Keep the components of r->derivative that differ least from those of a longer step. Return
 * whether all agree to rounding. */
static int keep_best(dvi__rows_memory *r, int size)
{
  int settled = 1;
  for (int i = 0; i < size; i++) {
    const double change = fabs(r->derivative[i] - r->before[i]);
    if (change < r->defect[i]) {
      r->defect[i] = change;
      r->x[i] = r->derivative[i];
    }
    r->before[i] = r->derivative[i];
    settled &= r->defect[i] <= 0x1p-44 * fabs(r->x[i]);
  }
  return settled;
}

/* Write the derivatives into r->x. Neither t nor q tells how fast the constraint changes, so that
 * the step is shortened until the differences agree. A constraint may be undefined farther away. */
static dvi_status search_derivatives(dvi__evaluator *e, double t, const double *q, const double *v)
{
  enum { STEPS = 12 };
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int size = e->system->n + e->system->row_count;
  double step = step_along(e->system, t, q, v);
  int known = 0;
  dvi_status status = DVI_OK;
  for (int k = 0; k < STEPS; k++, step /= 4) {
    const dvi_status one = difference_along(e, t, step, q, v);
    if (one != DVI_OK) {
      status = one;
      continue;
    }
    if (known++ == 0)
      for (int i = 0; i < size; i++) {
        r->x[i] = r->before[i] = r->derivative[i];
        r->defect[i] = HUGE_VAL;
      }
    else if (keep_best(r, size))
      break;
  }
  return known > 0 ? DVI_OK : status;
}

dvi_status dvi__rows_slopes(dvi__evaluator *e, double t, const double *q, const double *v)
{
  return search_derivatives(e, t, q, v);
}

/* Write the derivatives of (L_v, G v + g) along the motion into r->x. */
static dvi_status differentiate_along(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int size = e->system->n + e->system->row_count;
  if (e->span == 0) return search_derivatives(e, t, q, v);
  DVI_TRY(difference_along(e, t, ldexp(1.0, ilogb(e->span) - 5), q, v));
  memcpy(r->x, r->derivative, (size_t)size * sizeof(double));
  return DVI_OK;
}

/* gamma is a difference, whose error is divided by the softness in multipliers without effect. */
static const double acceleration_softness = 1e-4;

/* Solve for x in place. If the matrix is soft, the solution leaves -softness D lambda in the rows,
 * which further solutions remove. */
static dvi_status solve_refined(dvi__rows_memory *r, int n, double t)
{
  enum { REFINEMENTS = 4 };
  const int m = r->row_count;
  double *sum = r->along[1];
  DVI_TRY(dvi__rows_solve(r, n + m, t));
  if (r->softness == 0) return DVI_OK;
  memcpy(sum, r->x, (size_t)(n + m) * sizeof *sum);
  for (int k = 0; k < REFINEMENTS; k++) {
    memset(r->x, 0, (size_t)n * sizeof(double));
    for (int a = 0; a < m; a++)
      r->x[n + a] *= r->values[r->own_place[a]] / (r->scale[a] * r->scale[a]);
    DVI_TRY(dvi__rows_solve(r, n + m, t));
    for (int i = 0; i < n + m; i++) sum[i] += r->x[i];
  }
  memcpy(r->x, sum, (size_t)(n + m) * sizeof *sum);
  return DVI_OK;
}

dvi_status dvi__rows_acceleration(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *a, double *lambda)
{
  const dvi_system *s = e->system;
  dvi__rows_memory *r = dvi__rows_memory_of(e);
  const int size = s->n + s->row_count;
  DVI_TRY(differentiate_along(e, t, q, v));
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, r->along[0], NULL));
  for (int i = 0; i < size; i++) r->x[i] = (i < s->n ? r->along[0][i] : 0) - r->x[i];
  const double softness = r->softness;
  r->softness = softness > 0 ? acceleration_softness : 0;
  dvi_status status = dvi__rows_factor(e, t, q, v);
  if (status == DVI_OK) status = solve_refined(r, s->n, t);
  r->softness = softness;
  DVI_TRY(status);
  if (a != NULL) memcpy(a, r->x, (size_t)s->n * sizeof(double));
  memcpy(lambda, r->x + s->n, (size_t)s->row_count * sizeof(double));
  return DVI_OK;
}

/* Compute L_q + F - G^T lambda. */
static dvi_status constrained_forces(dvi__evaluator *e, double t, const double *q, const double *v,
                                     double *forces)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  double *lambda = r->phi;
  DVI_TRY(dvi__rows_acceleration(e, t, q, v, NULL, lambda));
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, forces, NULL));
  dvi__rows_pull(e->system, r->phi_q, lambda, -1, forces);
  return DVI_OK;
}

static dvi_status constrained_motion(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier)
{
  const dvi__rows_memory *r = dvi__rows_memory_of(e);
  DVI_TRY(dvi__legendre_inverse(e, t, q, p, v));
  if (pdot == NULL) return DVI_OK;
  DVI_TRY(constrained_forces(e, t, q, v, pdot));
  if (multiplier != NULL)
    memcpy(multiplier, r->phi, (size_t)e->system->row_count * sizeof *multiplier);
  return DVI_OK;
}

/* ---- the kinds ---- */

static int has_rows(const dvi_system_terms *terms)
{
  return terms->holonomic_count > 0 || terms->nonholonomic_count > 0;
}

static int constrained_mass_is_declared(const dvi_system_terms *terms)
{
  return has_rows(terms) && terms->lagrangian == NULL && terms->one_form == NULL &&
         terms->hamiltonian == NULL && terms->factors == NULL;
}

static int constrained_lagrangian_is_declared(const dvi_system_terms *terms)
{
  return has_rows(terms) && terms->lagrangian != NULL;
}

static dvi_status declare_lagrangian(const dvi_system_terms *terms, dvi_system *system)
{
  return dvi__dynamics_general_lagrangian.declare(terms, system);
}

static dvi_status prepare_constrained_mass(dvi__evaluator *e, dvi__derivatives most)
{
  DVI_TRY(dvi__dynamics_constant_mass.prepare(e, most));
  return dvi__rows_prepare(e);
}

static dvi_status prepare_constrained_lagrangian(dvi__evaluator *e, dvi__derivatives most)
{
  DVI_TRY(dvi__prepare_velocity_hessian(e, most));
  return dvi__rows_prepare(e);
}

static dvi_status reactions_of_state(dvi__evaluator *e, double t, const double *q, const double *v,
                                     double *lambda)
{
  return dvi__rows_acceleration(e, t, q, v, NULL, lambda);
}

static dvi_status velocity_by_mass(dvi__evaluator *e, double t, const double *q, const double *p,
                                   double *v)
{
  return dvi__dynamics_constant_mass.velocity(e, t, q, p, v);
}

const dvi__dynamics dvi__dynamics_constrained_mass = {
    .name = "constant mass with constraints",
    .function = "Lagrangian",
    .equations = DVI__CONSTRAINED_LAGRANGE,
    .has_kinetic_energy = 1,
    .is_declared = constrained_mass_is_declared,
    .declare = dvi__mass_copy,
    .prepare = prepare_constrained_mass,
    .release = dvi__rows_release,
    .velocity = velocity_by_mass,
    .motion = constrained_motion,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = constrained_forces,
    .momentum = dvi__momentum_of_point,
    .constraint = &dvi__on_rows,
    .reactions = reactions_of_state,
};

const dvi__dynamics dvi__dynamics_constrained_lagrangian = {
    .name = "general Lagrangian with constraints",
    .function = "Lagrangian",
    .equations = DVI__CONSTRAINED_LAGRANGE,
    .searches_velocity = 1,
    .has_kinetic_energy = 1,
    .is_declared = constrained_lagrangian_is_declared,
    .declare = declare_lagrangian,
    .prepare = prepare_constrained_lagrangian,
    .release = dvi__rows_release,
    .velocity = dvi__search_velocity,
    .regular = dvi__velocity_hessian_is_regular,
    .motion = constrained_motion,
    .energy = dvi__energy_of_lagrangian,
    .value = dvi__value_of_point,
    .forces = constrained_forces,
    .momentum = dvi__momentum_of_point,
    .constraint = &dvi__on_rows,
    .reactions = reactions_of_state,
};
