#include "step/degenerate/partitioned_struct.h"

#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "step/degenerate/stage_inverse.h"
#include "system/dynamics/one_form.h"

/* ---- tableaux ---- */

static void partitioned_conjugate(const dvi__partitioned *p, int i, int j, double *abar)
{
  *abar = p->b[j] - p->b[j] * p->a[j][i] / p->b[i];
}

/* Rearrange Lobatto's tableaux. Collocation at Lobatto's nodes gives a = IIIA with the conjugate
 * IIIB. IIIE is the mean of both, and its own conjugate (Jay 2015). */
static void rearrange_lobatto(dvi__partitioned *p, dvi__tableau tableau)
{
  for (int i = 0; i < p->s; i++)
    for (int j = 0; j < p->s; j++) {
      const double A = p->a[i][j], B = p->abar[i][j], mean = 0.5 * (A + B);
      p->a[i][j] = tableau == DVI__LOBATTO_IIIE ? mean : B;
      p->abar[i][j] = tableau == DVI__LOBATTO_IIIE ? mean : A;
    }
}

static dvi_status partitioned_fill_tableau(dvi__partitioned *p, dvi__tableau tableau)
{
  DVI_TRY(dvi_quadrature(tableau == DVI__GAUSS ? DVI_GAUSS : DVI_LOBATTO, p->s, p->c, p->b));
  DVI_TRY(dvi__collocate(p->s, p->c, p->a));
  for (int i = 0; i < p->s; i++)
    for (int j = 0; j < p->s; j++) partitioned_conjugate(p, i, j, &p->abar[i][j]);
  if (tableau != DVI__GAUSS) rearrange_lobatto(p, tableau);
  for (int i = 0; i < p->s; i++)
    for (int j = 0; j < p->s; j++) {
      p->a_by_columns[j][i] = p->a[i][j];
      p->abar_by_columns[j][i] = p->abar[i][j];
    }
  return DVI_OK;
}

/* Choose the kicks of a projection. A violation of the constraint at the start returns at the end
 * multiplied by R(infinity), which is (-1)^s for both tableaux. The same multiplier at both ends
 * can only remove a violation that does not cancel. */
static kicks kicks_of(int s, dvi__projection projection)
{
  const double R = s % 2 == 0 ? 1 : -1;
  switch (projection) {
  case DVI__SYMMETRIC: return (kicks){1, 0, R, 1, 0};
  case DVI__MIDPOINT_PROJECTION: return (kicks){1, 0, R, 1, 1};
  case DVI__SYMPLECTIC_PROJECTION: return (kicks){0, R, 1, 1, 0};
  case DVI__POST_PROJECTION: return (kicks){0, 0, 1, 1, 0};
  case DVI__NO_PROJECTION: break;
  }
  return (kicks){0};
}

/* ---- create ---- */

static double **partitioned_owned_array(dvi__partitioned *p, int i)
{
  double **const all[] = {&p->t,    &p->Q,    &p->V,    &p->L_q,    &p->L_v,    &p->H_qq,
                          &p->H_qv, &p->H_vv, &p->k0,   &p->k1,     &p->K0,     &p->K1,
                          &p->dq,   &p->q1,   &p->mean, &p->alpha1, &p->dp,     &p->unwanted,
                          &p->qq0,  &p->qv0,  &p->qq1,  &p->qv1,    &p->qv_end, &p->qq_end};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status partitioned_allocate(dvi__partitioned *p)
{
  const size_t n = (size_t)p->n, s = (size_t)p->s,
               qq = (size_t)dvi__pattern_entries(&p->system->qq),
               qv = (size_t)dvi__pattern_entries(&p->system->qv),
               vv = (size_t)dvi__pattern_entries(&p->system->vv);
  const size_t size[] = {s, n * s, n * s, n * s, n * s, qq * s, qv * s, vv * s, n,  n,  n,  n,
                         n, n,     n,     n,     n,     n,      qq,     qv,     qq, qv, qv, qq};
  for (int i = 0; partitioned_owned_array(p, i) != NULL; i++) {
    *partitioned_owned_array(p, i) = DVI_NEW(double, size[i] > 0 ? size[i] : 1);
    if (*partitioned_owned_array(p, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d stages in %d dimensions", p->s, p->n);
  }
  return DVI_OK;
}

static dvi_status partitioned_initialise(dvi__partitioned *p, dvi__tableau tableau,
                                         dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(p->system, p->m, p->s));
  DVI_TRY(partitioned_fill_tableau(p, tableau));
  DVI_TRY(dvi__evaluator_create(p->system, p->s, DVI__HESSIANS, counters, &p->evaluator));
  DVI_TRY(dvi__joint_create(p->system, NULL, &p->joint, &p->block));
  DVI_TRY(dvi__pattern_blocks(&p->joint, p->m, &p->pattern));
  const int is_conjugate = tableau != DVI__LOBATTO_IIIB_A;
  if (is_conjugate && (p->system->terms & DVI__ONE_FORM))
    DVI_TRY(dvi__partitioned_create_inverse(p));
  return partitioned_allocate(p);
}

dvi_status dvi__partitioned_create(const dvi_system *system, dvi__tableau tableau, int stages,
                                   dvi__projection projection, dvi_counters *counters,
                                   dvi__partitioned **partitioned)
{
  *partitioned = NULL;
  dvi__partitioned *p = DVI_NEW(dvi__partitioned, 1);
  if (p == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  p->system = system;
  p->n = system->n;
  p->s = stages;
  p->kick = kicks_of(stages, projection);
  p->m = stages + p->kick.has_multiplier;
  const dvi_status status = partitioned_initialise(p, tableau, counters);
  if (status != DVI_OK) dvi__partitioned_destroy(&p);
  *partitioned = p;
  return status;
}

void dvi__partitioned_destroy(dvi__partitioned **partitioned)
{
  dvi__partitioned *p = *partitioned;
  if (p == NULL) return;
  for (int i = 0; partitioned_owned_array(p, i) != NULL; i++)
    dvi__release(*partitioned_owned_array(p, i));
  dvi__evaluator_destroy(&p->evaluator);
  dvi__stage_inverse_destroy(&p->inverse);
  dvi__pattern_clear(&p->joint);
  dvi__pattern_clear(&p->pattern);
  dvi__release(p->block);
  dvi__release(p);
  *partitioned = NULL;
}

const dvi__pattern *dvi__partitioned_pattern(const dvi__partitioned *p)
{
  return &p->pattern;
}

dvi__evaluator *dvi__partitioned_evaluator(const dvi__partitioned *p)
{
  return p->evaluator;
}

void dvi__partitioned_place(dvi__partitioned *p, double t0, double h, const double *q0,
                            const double *p0, const double *carried)
{
  p->t0 = t0;
  p->h = h;
  p->q0 = q0;
  p->p0 = p0;
  p->carried = carried;
  p->has_gradients = 0;
  for (int i = 0; i < p->s; i++) p->t[i] = t0 + p->c[i] * h;
}

/* ---- points ---- */

/* Compute the product of a matrix, by columns, and x [s]. The stages are lanes. */
INLINE void product_in_lanes(int s, const int lanes,
                             double matrix[DVI__STAGES_MOST][DVI__STAGES_MOST], const double *x,
                             double *y)
{
  double sum[DVI__STAGES_MOST] = {0};
  for (int l = 0; l < s; l++)
    for (int k = 0; k < lanes; k++) sum[k] += matrix[l][k] * x[l];
  for (int k = 0; k < lanes; k++) y[k] = sum[k];
}

WIDE static void stage_product(int s, double matrix[DVI__STAGES_MOST][DVI__STAGES_MOST],
                               const double *x, double *y)
{
  if (s <= DVI__STAGES_MOST / 2)
    product_in_lanes(s, DVI__STAGES_MOST / 2, matrix, x, y);
  else
    product_in_lanes(s, DVI__STAGES_MOST, matrix, x, y);
}

/* Compute the points. The increments before the kicks are summed first, so that q0, the large
 * number, comes last. */
void dvi__partitioned_points(dvi__partitioned *p, const double *x)
{
  const kicks *kick = &p->kick;
  const int s = p->s;
  for (int i = 0; i < p->n; i++, x += p->m) {
    const double lambda = kick->has_multiplier ? x[s] : 0;
    double moved[DVI__STAGES_MOST], *Q = p->Q + i * s, *V = p->V + i * s;
    stage_product(s, p->a_by_columns, x, moved);
    p->k0[i] = kick->before * lambda + kick->carried * p->carried[i];
    p->k1[i] = kick->after * lambda;
    for (int k = 0; k < s; k++) {
      V[k] = x[k] / p->h;
      Q[k] = p->q0[i] + (p->k0[i] + moved[k]);
    }
    p->dq[i] = p->k0[i] + partitioned_dot(s, p->b, x) + p->k1[i];
    p->q1[i] = p->q0[i] + p->dq[i];
    p->mean[i] = p->q0[i] + 0.5 * p->dq[i];
  }
}

/* Compute the effect on p of the kick k0, whose derivatives the Jacobian of this step may have
 * left. */
static dvi_status kick_at_start(dvi__partitioned *p)
{
  const dvi__pattern *qv = &p->system->qv;
  if (!p->has_gradients)
    return dvi__form_gradient(p->evaluator, p->kick.at_mean ? p->mean : p->q0, p->k0, p->K0,
                              p->unwanted);
  for (int j = 0; j < p->n; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++) p->K0[qv->row[e]] += p->k0[j] * p->qv0[e];
  return DVI_OK;
}

/* Compute K0 and K1 where there are kicks, and alpha(q1). */
static dvi_status partitioned_ends(dvi__partitioned *p)
{
  const kicks *kick = &p->kick;
  const size_t bytes = (size_t)p->n * sizeof(double);
  memset(p->K0, 0, bytes);
  memset(p->K1, 0, bytes);
  if (!kick->has_multiplier) return DVI_OK;
  if (kick->before != 0 || kick->carried != 0) DVI_TRY(kick_at_start(p));
  DVI_TRY(dvi__form_gradient(p->evaluator, p->q1, p->k1, p->K1, p->alpha1));
  return kick->at_mean ? dvi__form_gradient(p->evaluator, p->mean, p->k1, p->K1, p->unwanted)
                       : DVI_OK;
}

dvi_status dvi__partitioned_residual(dvi__partitioned *p, const double *x, double *R)
{
  const int s = p->s, m = p->m;
  dvi__partitioned_points(p, x);
  DVI_TRY(dvi__lagrangian_gradient(p->evaluator, s, p->t, p->Q, p->V, p->L_q, p->L_v));
  DVI_TRY(partitioned_ends(p));
  for (int i = 0; i < p->n; i++) {
    const double *F = p->L_q + i * s, *alpha = p->L_v + i * s;
    double pushed[DVI__STAGES_MOST];
    stage_product(s, p->abar_by_columns, F, pushed);
    for (int k = 0; k < s; k++) R[i * m + k] = (alpha[k] - p->p0[i]) - p->K0[i] - p->h * pushed[k];
    p->dp[i] = p->K0[i] + p->h * partitioned_dot(s, p->b, F) + p->K1[i];
    if (p->kick.has_multiplier) R[i * m + s] = (p->p0[i] - p->alpha1[i]) + p->dp[i];
  }
  return DVI_OK;
}

void dvi__partitioned_ends(dvi__partitioned *p, const double *x, double *dq, double *dp)
{
  dvi__partitioned_points(p, x);
  memcpy(dq, p->dq, (size_t)p->n * sizeof *dq);
  memcpy(dp, p->dp, (size_t)p->n * sizeof *dp);
}

/* Scale the rows by L_vv of the last Jacobian at the first stage. */
static void scale_by_masses(const dvi__partitioned *p, double *scale)
{
  const dvi__pattern *vv = &p->system->vv;
  for (int i = 0; i < p->n; i++) {
    double size = 0;
    for (int e = vv->start[i]; e < vv->start[i + 1]; e++)
      size = fmax(size, fabs(p->H_vv[e * p->s]));
    for (int k = 0; k < p->m; k++) scale[i * p->m + k] = (size > 0 ? size : 1) / fabs(p->h);
  }
}

dvi_status dvi__partitioned_scale(dvi__partitioned *p, double *scale)
{
  if (!(p->system->terms & DVI__ONE_FORM)) {
    scale_by_masses(p, scale);
    return DVI_OK;
  }
  DVI_TRY(dvi__form_scale(p->evaluator, p->q0, p->k0));
  for (int i = 0; i < p->n * p->m; i++) scale[i] = p->k0[i / p->m];
  return DVI_OK;
}

/* ---- guesses ---- */

void dvi__partitioned_straight(const dvi__partitioned *p, const double *v, double *x)
{
  for (int i = 0; i < p->n; i++, x += p->m) {
    for (int k = 0; k < p->s; k++) x[k] = p->h * v[i];
    if (p->kick.has_multiplier) x[p->s] = 0;
  }
}

void dvi__partitioned_shift(dvi__partitioned *p, double ratio)
{
  for (int k = 0; k < p->s && ratio != p->ratio; k++)
    dvi__lagrange_weights(p->s, p->c, 1 + ratio * p->c[k], p->shift[k]);
  p->ratio = ratio;
}

void dvi__partitioned_continue(dvi__partitioned *p, double ratio, const double *last, double *x)
{
  dvi__partitioned_shift(p, ratio);
  for (int i = 0; i < p->n; i++, last += p->m, x += p->m) {
    for (int k = 0; k < p->s; k++) x[k] = ratio * partitioned_dot(p->s, p->shift[k], last);
    if (p->kick.has_multiplier) x[p->s] = 0;
  }
}
