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

/* ---- create ---- */

static double **phase_owned_array(dvi__phase_element *f, int i)
{
  double **const all[] = {&f->kick,   &f->impulse, &f->t,     &f->Z,     &f->F,      &f->phi,
                          &f->H_qq,   &f->H_qp,    &f->H_pp,  &f->phi_z, &f->phi_qq, &f->phi_qp,
                          &f->phi_pp, &f->slope,   &f->point, &f->end,   &f->field,  &f->weight};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status phase_allocate(dvi__phase_element *f)
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
  for (int i = 0; phase_owned_array(f, i) != NULL; i++) {
    *phase_owned_array(f, i) = DVI_NEW(double, size[i]);
    if (*phase_owned_array(f, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "phase space: no memory for %d stages in %d dimensions", f->d,
                       f->n);
  }
  return DVI_OK;
}

static dvi_status phase_fill_tables(dvi__phase_element *f)
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

static dvi_status phase_initialise(dvi__phase_element *f, dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(f->system, f->d + 1, 2 * (f->d + 1)));
  DVI_TRY(phase_fill_tables(f));
  DVI_TRY(dvi__evaluator_create(f->system, f->d, DVI__HESSIANS, counters, &f->evaluator));
  DVI_TRY(dvi__phase_element_lay_out(f));
  DVI_TRY(phase_allocate(f));
  return dvi__phase_iteration_create(f);
}

dvi_status dvi__phase_element_create(const dvi_system *system, int degree, int moments,
                                     dvi_counters *counters, dvi__phase_element **phase)
{
  *phase = NULL;
  dvi__phase_element *f = DVI_NEW(dvi__phase_element, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  f->system = system;
  f->n = system->n;
  f->m = system->constraint->callbacks.count;
  f->d = degree;
  f->k = moments;
  const dvi_status status = phase_initialise(f, counters);
  if (status != DVI_OK) dvi__phase_element_destroy(&f);
  *phase = f;
  return status;
}

void dvi__phase_element_destroy(dvi__phase_element **phase)
{
  dvi__phase_element *f = *phase;
  if (f == NULL) return;
  for (int i = 0; phase_owned_array(f, i) != NULL; i++) dvi__release(*phase_owned_array(f, i));
  dvi__phase_element_clear_layout(f);
  dvi__phase_iteration_clear(&f->iteration);
  dvi__evaluator_destroy(&f->evaluator);
  dvi__release(f);
  *phase = NULL;
}

const dvi__pattern *dvi__phase_element_pattern(const dvi__phase_element *f)
{
  return &f->pattern;
}

dvi__evaluator *dvi__phase_element_evaluator(const dvi__phase_element *f)
{
  return f->evaluator;
}

/* ---- points ---- */

dvi_status dvi__phase_element_place(dvi__phase_element *f, double t0, double h, const double *q,
                                    const double *p, const double *multiplier)
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

static double phase_start_of(const dvi__phase_element *f, int component)
{
  return component < f->n ? f->q0[component] : f->p0[component - f->n];
}

void dvi__phase_points(dvi__phase_element *f, const double *x)
{
  const int d = f->d;
  for (int c = 0; c < 2 * f->n; c++) {
    const double *W = dvi__phase_row(f, x, c), from = phase_start_of(f, c);
    for (int i = 0; i < d; i++) {
      double sum = f->kick[c];
      for (int j = 0; j < d; j++) sum += f->a[i][j] * W[j];
      f->Z[c * d + i] = from + sum;
    }
    f->end[c] = from + W[d];
  }
}

void dvi__phase_take(const dvi__phase_element *f, const double *multipliers, int i)
{
  const int d = f->d, z = 2 * f->n;
  if (i == d) memcpy(f->point, f->end, (size_t)z * sizeof *f->point);
  for (int c = 0; i < d && c < z; c++) f->point[c] = f->Z[c * d + i];
  for (int a = 0; a < f->m; a++, multipliers += f->k + 1) {
    f->weight[a] = i == d ? multipliers[0] : 0;
    for (int l = 0; i < d && l < f->k; l++) f->weight[a] += f->legendre[i][l] * multipliers[1 + l];
  }
}

/* Evaluate the gradients of the constraint at f->point, keep them for `stage`, and add X_phi times
 * the weights to the numbers of `field`, which are `stride` apart. */
static dvi_status phase_push_constraints(dvi__phase_element *f, int stage, int stride,
                                         double *field)
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  const int n = f->n;
  double *phi_z = dvi__phase_gradients(f, stage);
  DVI_TRY(dvi__constraint_gradients(f->evaluator, f->point, f->point + n, phi_z));
  for (int a = 0, e = 0; a < f->m; a++)
    for (; e < gradients->start[a + 1]; e++) {
      const int row = gradients->row[e];
      field[(row < n ? n + row : row - n) * stride] += (row < n ? -f->weight[a] : f->weight[a]) *
                                                       phi_z[e];
    }
  return DVI_OK;
}

/* Set f->field to X_phi times the weights at the end. */
static dvi_status phase_push_end(dvi__phase_element *f, const double *multipliers)
{
  memset(f->field, 0, 2 * (size_t)f->n * sizeof *f->field);
  dvi__phase_take(f, multipliers, f->d);
  return phase_push_constraints(f, f->d, 1, f->field);
}

/* ---- residual ---- */

/* Set F = h X_H + h X_phi Lambda at the stages. Without moments no constraint acts there. */
static dvi_status phase_stage_fields(dvi__phase_element *f, const double *multipliers)
{
  const int half = f->n * f->d;
  DVI_TRY(dvi__lagrangian_gradient(f->evaluator, f->d, f->t, f->Z, f->Z + half, f->F + half, f->F));
  for (int c = 0; c < half; c++) {
    f->F[c] *= f->h;
    f->F[half + c] *= -f->h;
  }
  for (int i = 0; i < f->d && f->k > 0; i++) {
    dvi__phase_take(f, multipliers, i);
    DVI_TRY(phase_push_constraints(f, i, f->d, f->F + i));
    DVI_TRY(dvi__constraint_value(f->evaluator, f->point, f->point + f->n, f->phi + i * f->m));
  }
  return DVI_OK;
}

dvi_status dvi__phase_fields(dvi__phase_element *f, const double *multipliers)
{
  DVI_TRY(phase_stage_fields(f, multipliers));
  DVI_TRY(phase_push_end(f, multipliers));
  return dvi__constraint_value(f->evaluator, f->point, f->point + f->n, f->weight);
}

static double phase_moment(const dvi__phase_element *f, int constraint, int l)
{
  double sum = 0;
  for (int i = 0; i < f->d; i++) sum += f->b[i] * f->legendre[i][l] * f->phi[i * f->m + constraint];
  return sum;
}

dvi_status dvi__phase_element_residual(dvi__phase_element *f, const double *x, double *R)
{
  const int d = f->d;
  dvi__phase_points(f, x);
  DVI_TRY(dvi__phase_fields(f, dvi__phase_multipliers(f, x, 0)));
  for (int c = 0; c < 2 * f->n; c++, R += d + 1) {
    const double *W = dvi__phase_row(f, x, c);
    R[d] = W[d] - f->kick[c] - 0.5 * f->field[c];
    for (int i = 0; i < d; i++) {
      R[i] = W[i] - f->F[c * d + i];
      R[d] -= f->b[i] * W[i];
    }
  }
  for (int a = 0; a < f->m; a++) {
    *R++ = f->weight[a];
    for (int l = 0; l < f->k; l++) *R++ = phase_moment(f, a, l);
  }
  return DVI_OK;
}

/* ---- scale ---- */

/* Write the scale of the rows. Rows of z have the size of the unknowns, and rows of a constraint
 * that of its gradient. */
dvi_status dvi__phase_element_scale(dvi__phase_element *f, double *scale)
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

void dvi__phase_element_end(const dvi__phase_element *f, const double *x, double *dq, double *dp,
                            double *multiplier)
{
  for (int i = 0; i < f->n; i++) {
    dq[i] = dvi__phase_row(f, x, i)[f->d];
    dp[i] = dvi__phase_row(f, x, f->n + i)[f->d];
  }
  for (int a = 0; a < f->m; a++) multiplier[a] = dvi__phase_multipliers(f, x, a)[0] / f->h;
}

dvi_status dvi__phase_element_jump(dvi__phase_element *f, const double *x, double *jump,
                                   double *change)
{
  const size_t bytes = 2 * (size_t)f->n * sizeof *jump;
  for (int c = 0; c < 2 * f->n; c++)
    f->end[c] = phase_start_of(f, c) + dvi__phase_row(f, x, c)[f->d];
  DVI_TRY(phase_push_end(f, dvi__phase_multipliers(f, x, 0)));
  memcpy(jump, f->field, bytes);
  memcpy(change, f->field, bytes);
  dvi__constraint_push(f->system->constraint, dvi__phase_gradients(f, f->d), f->impulse, -1,
                       change);
  return DVI_OK;
}

/* Add the kicks to the sizes. The gradients are those of the end, where the multipliers of q's
 * kicks are those of phi_p. */
static void add_kicks(const dvi__phase_element *f, const double *x, double size[2])
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  const double *phi_z = dvi__phase_gradients(f, f->d);
  for (int a = 0; a < f->m; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      double *of = &size[gradients->row[e] < f->n];
      *of = fmax(*of,
                 fabs(phi_z[e]) * dvi__largest((size_t)f->k + 1, dvi__phase_multipliers(f, x, a)));
    }
}

static double phase_largest_entry(const dvi__phase_element *f, const dvi__pattern *pattern,
                                  const double *values)
{
  return dvi__largest((size_t)dvi__pattern_entries(pattern) * (size_t)f->d, values);
}

void dvi__phase_element_sizes(const dvi__phase_element *f, const double *x, double size[2])
{
  const dvi_system *s = f->system;
  size[0] = dvi__largest((size_t)f->n, f->q0);
  size[1] = dvi__largest((size_t)f->n, f->p0);
  add_kicks(f, x, size);
  const double h = fabs(f->h), of_q = size[0];
  size[0] += h * phase_largest_entry(f, &s->vv, f->H_pp) * size[1];
  size[1] += h * phase_largest_entry(f, &s->qq, f->H_qq) * of_q;
}

/* ---- guesses ---- */

/* Start with a straight line. p' and Lambda are not known yet, and the multiplier of the node is
 * kept. */
void dvi__phase_element_straight(const dvi__phase_element *f, const double *v, double *x)
{
  for (int c = 0; c < 2 * f->n; c++)
    for (int i = 0; i <= f->d; i++) *x++ = c < f->n ? f->h * v[c] : 0;
  for (int a = 0; a < f->m; a++) {
    *x++ = f->impulse[a];
    for (int l = 0; l < f->k; l++) *x++ = 0;
  }
}

/* Fill the weights that continue a polynomial through the stages. */
static void fill_continuation(dvi__phase_element *f, double ratio)
{
  f->ratio = ratio;
  for (int i = 0; i < f->d; i++)
    dvi__lagrange_weights(f->d, f->c, 1 + ratio * f->c[i], f->continuation[i]);
}

void dvi__phase_element_continue(dvi__phase_element *f, double ratio, const double *last, double *x)
{
  const int d = f->d;
  if (!(ratio == f->ratio)) fill_continuation(f, ratio);
  for (int c = 0; c < 2 * f->n; c++, last += d + 1, x += d + 1) {
    for (int i = 0; i < d; i++) {
      double sum = 0;
      for (int j = 0; j < d; j++) sum += f->continuation[i][j] * last[j];
      x[i] = ratio * sum;
    }
    x[d] = ratio * last[d];
  }
  for (int i = 0; i < f->m * (f->k + 1); i++) x[i] = ratio * last[i];
}
