/* The stationarity rows of the element, and the path that its unknowns describe. */
#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "num/simd/members_chord.h"
#include "space/trial.h"
#include "system/dynamics/one_form.h"

void dvi__action_stages(const dvi__action *a, const double *Y)
{
  const double inverse_h = 1.0 / a->h;
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->psi, Y, a->Q);
  dvi__lanes_product(a->n, a->s, a->lanes, a->r, a->dpsi, Y, a->V);
  for (size_t i = 0, r = (size_t)a->r; i < (size_t)a->n; i++)
    for (size_t j = i * r; j < (i + 1) * r; j++) {
      a->Q[j] = a->q0[i] + a->Q[j];
      a->V[j] = inverse_h * a->V[j];
    }
}

static double rows_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

/* Evaluate the path where psi and psi' are these numbers [2 s]. */
static void path_by(const dvi__action *a, const double *basis, const double *Y, double h,
                    double *offset, double *v)
{
  for (size_t i = 0, s = (size_t)a->s; i < (size_t)a->n; i++) {
    if (offset != NULL) offset[i] = rows_dot(a->s, basis, Y + i * s);
    if (v != NULL) v[i] = rows_dot(a->s, basis + s, Y + i * s) / h;
  }
}

dvi_status dvi__action_residual(dvi__action *a, const double *Y, double *R)
{
  a->iterated = 0;
  dvi__action_stages(a, Y);
  dvi__action_place_terms(a, Y);
  DVI_TRY(dvi__lagrangian_gradient(a->evaluator, a->r, a->t, a->Q, a->V, a->L_q, a->L_v));
  /* The forces enter every row, and p1, with the same rounded product b_j L_q. That keeps the rows
   * consistent to the last bit. */
  dvi__lanes_weigh(a->n, a->r, a->weight, a->L_q);
  dvi__lanes_weigh(a->n, a->r, a->weight, a->L_v);
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, a->bar_row, a->L_q, R);
  dvi__lanes_product(a->n, a->r, a->path_lanes, a->s, a->slope_row, a->L_v, a->rows);
  for (size_t i = 0, s = (size_t)a->s; i < (size_t)a->n; i++)
    for (size_t k = 0; k < s; k++)
      R[i * s + k] = a->h * R[i * s + k] + (a->rows[i * s + k] - a->end[k] * a->p0[i]);
  return dvi__action_add_term_rows(a, Y, R);
}

/* L_q and L_v hold the weights. */
void dvi__action_magnitudes(const dvi__action *a, double *magnitude)
{
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->s; k++) {
      const double *bar = a->bar + k * a->lanes, *slope = a->dpsi + k * a->lanes;
      double total = fabs(a->end[k] * a->p0[i]);
      for (int j = 0; j < a->r; j++)
        total += fabs(a->h * bar[j] * a->L_q[i * a->r + j]) + fabs(slope[j] * a->L_v[i * a->r + j]);
      magnitude[i * a->s + k] = total;
    }
  dvi__action_add_term_magnitudes(a, magnitude);
}

static double sum_of_line(int count, const double *x)
{
  double total = 0;
  for (int j = 0; j < count; j++) total += x[j];
  return total;
}

static void ends_by_rows(const dvi__action *a, const double *Y, double *dq, double *dq_low,
                         double *dp)
{
  for (size_t i = 0; i < (size_t)a->n; i++) {
    dq[i] = rows_dot(a->s, a->end, Y + i * (size_t)a->s);
    dq_low[i] = 0;
    dp[i] = a->h * sum_of_line(a->r, a->L_q + i * (size_t)a->r) +
            (a->terms.count > 0 ? a->terms.dp[i] : 0);
  }
}

void dvi__action_ends(const dvi__action *a, const double *Y, double *dq, double *dq_low, double *dp)
{
  if (a->iterated)
    dvi__action_fixed_point_ends(a, dq, dq_low, dp);
  else
    ends_by_rows(a, Y, dq, dq_low, dp);
}

/* ---- chord, the kinetic part of the Jacobian ---- */

/* Invert L_vv by elimination without exchanges, which serves positive matrices. */
static int invert_positive(dvi__action *a)
{
  const dvi__pattern *vv = &a->system->vv;
  char sound;
  memset(a->chord_inverse, 0, (size_t)a->n * (size_t)a->n * sizeof(double));
  for (int j = 0; j < a->n; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      a->chord_inverse[j * a->n + vv->row[e]] = a->middle_vv[e];
  dvi__members_inverse(a->n, 1, a->chord_inverse, a->middle[0], &sound);
  return sound;
}

static void invert_chord(dvi__action *a)
{
  const size_t n = (size_t)a->n;
  memset(a->chord_inverse, 0, n * n * sizeof(double));
  for (size_t j = 0; j < n; j++) {
    a->chord_inverse[j * n + j] = 1;
    dvi__linear_solve(a->chord, a->chord_inverse + j * n);
  }
}

dvi_status dvi__action_prepare_chord(dvi__action *a, const double *Y)
{
  if (a->system->lagrangian == NULL) return DVI_OK;
  const double middle = a->t0 + 0.5 * a->h, *L_vv;
  path_by(a, a->middle_basis, Y, a->h, a->middle[0], a->middle[1]);
  for (int i = 0; i < a->n; i++) a->middle[0][i] += a->q0[i];
  DVI_TRY(dvi__velocity_hessian(a->evaluator, middle, a->middle[0], a->middle[1], &L_vv));
  memcpy(a->middle_vv, L_vv, (size_t)dvi__pattern_entries(&a->system->vv) * sizeof(double));
  if (a->chord_inverse != NULL && invert_positive(a)) return DVI_OK;
  DVI_TRY(dvi__linear_factor(a->chord, a->middle_vv));
  if (a->chord_inverse != NULL) invert_chord(a);
  return DVI_OK;
}

/* Replace R by L_vv^{-1} R by the inverse, row by row. */
static void multiply_by_inverse(dvi__action *a, double *R)
{
  const size_t s = (size_t)a->s, n = (size_t)a->n;
  memset(a->rows, 0, n * s * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < s; k++)
        a->rows[i * s + k] += a->chord_inverse[j * n + i] * R[j * s + k];
  memcpy(R, a->rows, n * s * sizeof(double));
}

static void solve_velocity_hessian(dvi__action *a, double *R)
{
  const size_t s = (size_t)a->s;
  if (a->chord_inverse != NULL) {
    multiply_by_inverse(a, R);
    return;
  }
  for (size_t k = 0; k < s; k++) {
    for (size_t i = 0; i < (size_t)a->n; i++) a->middle[0][i] = R[i * s + k];
    dvi__linear_solve(a->chord, a->middle[0]);
    for (size_t i = 0; i < (size_t)a->n; i++) R[i * s + k] = a->middle[0][i];
  }
}

void dvi__action_chord(dvi__action *a, double *R)
{
  const int s = a->s;
  if (a->chord != NULL)
    solve_velocity_hessian(a, R);
  else
    dvi__mass_solve(a->evaluator, s, R, R);
  dvi__lanes_product(a->n, s, a->path_lanes, s, a->stiffness_row, R, a->rows);
  for (size_t i = 0; i < (size_t)a->n * (size_t)s; i++) R[i] = a->h * a->rows[i];
}

int dvi__action_row_scale(dvi__action *a, double *scale)
{
  if (a->chord == NULL && a->scaled_h == a->h) return 0;
  a->scaled_h = a->h;
  dvi__action_scale_by(a, a->middle_vv, scale);
  return 1;
}

void dvi__action_scale_by(const dvi__action *a, const double *L_vv, double *scale)
{
  const dvi__pattern *vv = &a->system->vv;
  const double *values = L_vv != NULL                       ? L_vv
                         : a->system->mass_diagonal != NULL ? a->system->mass_diagonal
                                                            : a->system->mass_values;
  for (int i = 0; i < a->n; i++) {
    double size = 0;
    for (int e = vv->start[i]; e < vv->start[i + 1]; e++) size = fmax(size, fabs(values[e]));
    const double row = (size > 0 ? size : 1.0) / fabs(a->h);
    for (int k = 0; k < a->s; k++) scale[i * a->s + k] = row;
  }
  dvi__action_scale_terms(a, scale);
}

dvi_status dvi__action_scale(dvi__action *a, double *scale)
{
  DVI_TRY(dvi__form_scale(a->evaluator, a->q0, a->rows));
  for (int i = 0; i < a->n * a->s; i++) scale[i] = a->rows[i / a->s];
  return DVI_OK;
}

/* ---- paths ---- */

void dvi__action_path(const dvi__action *a, const double *Y, double h, double tau, double *offset,
                      double *v)
{
  dvi__trial_in(&a->trial, tau, a->line, NULL, a->line + a->s);
  path_by(a, a->line, Y, h, offset, v);
}

void dvi__action_straight(const dvi__action *a, const double *v, double *Y)
{
  for (size_t i = 0, s = (size_t)a->s; i < (size_t)a->n; i++)
    for (size_t k = 0; k < s; k++) Y[i * s + k] = a->straight[k] * (a->h * v[i]);
  for (int k = 0; k < a->terms.unknowns; k++) Y[a->n * a->s + k] = 0;
}

const double *dvi__action_fit_points(const dvi__action *a)
{
  return a->fit_point;
}

void dvi__action_fit(const dvi__action *a, const double *offset, double *Y)
{
  const size_t s = (size_t)a->s;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    memcpy(a->line, offset + i * s, s * sizeof(double));
    for (size_t k = 0; k < s; k++) Y[i * s + k] = rows_dot(a->s, a->fit + k * s, a->line);
  }
}
