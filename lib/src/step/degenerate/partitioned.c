#include "step/degenerate/partitioned.h"

#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "step/onestep/collocation.h"
#include "step/joint.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "system/dynamics/one_form.h"

/* The kicks are k0 = before lambda + carried times the last lambda, and k1 = after lambda. Their
 * directions are taken at the mean of q0 and q1, or at the ends. */
typedef struct kicks {
  double before, carried, after;
  int has_multiplier, at_mean;
} kicks;

struct dvi__partitioned {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, s, m; /* coordinates, stages, unknowns of a coordinate */
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST], abar[DVI__STAGES_MOST][DVI__STAGES_MOST],
      b[DVI__STAGES_MOST], c[DVI__STAGES_MOST];
  /* the same by columns, padded with zeros */
  double a_by_columns[DVI__STAGES_MOST][DVI__STAGES_MOST],
      abar_by_columns[DVI__STAGES_MOST][DVI__STAGES_MOST];
  double ratio; /* the lengths of steps for which `shift` continues the velocities, 0 if none */
  double shift[DVI__STAGES_MOST][DVI__STAGES_MOST];
  kicks kick;
  dvi__pattern joint, pattern; /* joint is the pattern of one block, pattern that of the Jacobian */
  dvi__joint_entry *block;     /* [entries of joint] */
  /* The current step. */
  double t0, h;
  const double *q0, *p0, *carried;
  /* Values at the stages, component by component [n*s]. */
  double *t, *Q, *V, *L_q, *L_v, *H_qq, *H_qv, *H_vv;
  /* Values at the ends, [n] each. These are the kicks, their effect on p, the increments of q
   * before k1 and in all, the points, and alpha at q1. */
  double *k0, *k1, *K0, *K1, *dq, *q1, *mean, *alpha1, *dp, *unwanted;
  double *qq0, *qv0, *qq1, *qv1, *qv_end, *qq_end; /* Hessians at the ends */
};

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
  for (int i = 0; i < p->s; i++) p->t[i] = t0 + p->c[i] * h;
}

/* ---- points ---- */

static double partitioned_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

/* Compute the points. The increments before the kicks are summed first, so that q0, the large
 * number, comes last. */
static void partitioned_points(dvi__partitioned *p, const double *x)
{
  const kicks *kick = &p->kick;
  const size_t s = (size_t)p->s;
  for (size_t i = 0; i < (size_t)p->n; i++, x += p->m) {
    const double lambda = kick->has_multiplier ? x[p->s] : 0;
    p->k0[i] = kick->before * lambda + kick->carried * p->carried[i];
    p->k1[i] = kick->after * lambda;
    for (size_t k = 0; k < s; k++) p->V[i * s + k] = x[k] / p->h;
    for (size_t k = 0; k < s; k++)
      p->Q[i * s + k] = p->q0[i] + (p->k0[i] + partitioned_dot(p->s, p->a[k], x));
    p->dq[i] = p->k0[i] + partitioned_dot(p->s, p->b, x) + p->k1[i];
    p->q1[i] = p->q0[i] + p->dq[i];
    p->mean[i] = p->q0[i] + 0.5 * p->dq[i];
  }
}

static const double *place_of_k0(const dvi__partitioned *p)
{
  return p->kick.at_mean ? p->mean : p->q0;
}

static const double *place_of_k1(const dvi__partitioned *p)
{
  return p->kick.at_mean ? p->mean : p->q1;
}

/* Compute K0 and K1 where there are kicks, and alpha(q1). */
static dvi_status partitioned_ends(dvi__partitioned *p)
{
  const kicks *kick = &p->kick;
  const size_t bytes = (size_t)p->n * sizeof(double);
  memset(p->K0, 0, bytes);
  memset(p->K1, 0, bytes);
  if (!kick->has_multiplier) return DVI_OK;
  if (kick->before != 0 || kick->carried != 0)
    DVI_TRY(dvi__form_gradient(p->evaluator, place_of_k0(p), p->k0, p->K0, p->unwanted));
  DVI_TRY(dvi__form_gradient(p->evaluator, p->q1, p->k1, p->K1, p->alpha1));
  return kick->at_mean ? dvi__form_gradient(p->evaluator, p->mean, p->k1, p->K1, p->unwanted)
                       : DVI_OK;
}

dvi_status dvi__partitioned_residual(dvi__partitioned *p, const double *x, double *R)
{
  const size_t s = (size_t)p->s, m = (size_t)p->m;
  partitioned_points(p, x);
  DVI_TRY(dvi__lagrangian_gradient(p->evaluator, p->s, p->t, p->Q, p->V, p->L_q, p->L_v));
  DVI_TRY(partitioned_ends(p));
  for (size_t i = 0; i < (size_t)p->n; i++) {
    const double *F = p->L_q + i * s, *alpha = p->L_v + i * s;
    for (size_t k = 0; k < s; k++)
      R[i * m + k] = (alpha[k] - p->p0[i]) - p->K0[i] - p->h * partitioned_dot(p->s, p->abar[k], F);
    p->dp[i] = p->K0[i] + p->h * partitioned_dot(p->s, p->b, F) + p->K1[i];
    if (p->kick.has_multiplier) R[i * m + s] = (p->p0[i] - p->alpha1[i]) + p->dp[i];
  }
  return DVI_OK;
}

void dvi__partitioned_ends(dvi__partitioned *p, const double *x, double *dq, double *dp)
{
  partitioned_points(p, x);
  memcpy(dq, p->dq, (size_t)p->n * sizeof *dq);
  memcpy(dp, p->dp, (size_t)p->n * sizeof *dp);
}

/* ---- Jacobian ---- */

static dvi_status hessians_at_ends(dvi__partitioned *p)
{
  if (!p->kick.has_multiplier) return DVI_OK;
  DVI_TRY(dvi__form_hessian(p->evaluator, place_of_k0(p), p->k0, p->qq0, p->qv0));
  DVI_TRY(dvi__form_hessian(p->evaluator, place_of_k1(p), p->k1, p->qq1, p->qv1));
  if (p->kick.at_mean) return dvi__form_hessian(p->evaluator, p->q1, p->k1, p->qq_end, p->qv_end);
  memcpy(p->qv_end, p->qv1, (size_t)dvi__pattern_entries(&p->system->qv) * sizeof(double));
  return DVI_OK;
}

static double partitioned_at(const double *values, int entry)
{
  return entry >= 0 ? values[entry] : 0;
}

/* An entry of the joint pattern has d2L/dv_i dq_j (A, for a one-form d alpha_i/dq_j), d2L/dq_i dv_j
 * (B), h d2L/dq2 (K) and d2L/dv2/h (M) at the stages, and the corresponding values at the ends. */
typedef struct entry {
  double A[DVI__STAGES_MOST], B[DVI__STAGES_MOST], K[DVI__STAGES_MOST], M[DVI__STAGES_MOST];
  double B0, H0, B1, H1, A_end;
} entry;

/* Copy the numbers of an entry at the stages, 0 where it is none. */
static inline void gather_stages(const dvi__partitioned *p, const double *values, int at,
                                 double *out)
{
  for (int k = 0; k < p->s; k++) out[k] = at >= 0 ? values[at * p->s + k] : 0;
}

static void partitioned_gather_entry(const dvi__partitioned *p, const dvi__joint_entry *where,
                                     entry *out)
{
  *out = (entry){.B0 = 0};
  gather_stages(p, p->H_qv, where->vq, out->A);
  gather_stages(p, p->H_qv, where->qv, out->B);
  gather_stages(p, p->H_qq, where->qq, out->K);
  gather_stages(p, p->H_vv, where->vv, out->M);
  for (int k = 0; k < p->s; k++) out->K[k] *= p->h;
  if (!p->kick.has_multiplier) return;
  out->B0 = partitioned_at(p->qv0, where->qv);
  out->H0 = p->kick.at_mean ? 0.5 * partitioned_at(p->qq0, where->qq) : 0;
  out->B1 = partitioned_at(p->qv1, where->qv);
  out->H1 = (p->kick.at_mean ? 0.5 : 1.0) * partitioned_at(p->qq1, where->qq);
  out->A_end = partitioned_at(p->qv_end, where->vq);
}

/* Fill the rows of a block in the column of the increment W_l. The stages are lanes. */
INLINE void increment_column(const dvi__partitioned *p, const entry *e, int l, const int lanes,
                             double *column)
{
  const double start = p->b[l] * e->H0, *a = p->a_by_columns[l];
  double rows[DVI__STAGES_MOST], end = 0;
  for (int k = 0; k < lanes; k++)
    rows[k] = a[k] * e->A[k] - start - p->abar_by_columns[l][k] * e->B[l];
  for (int j = 0; j < p->s; j++) {
    const double impulse = e->K[j] * a[j], *abar = p->abar_by_columns[j];
    for (int k = 0; k < lanes; k++) rows[k] -= impulse * abar[k];
    end += impulse * p->b[j];
  }
  memcpy(column, rows, (size_t)p->s * sizeof *rows);
  column[l] += e->M[l] / p->h;
  if (p->kick.has_multiplier)
    column[p->s] = start + p->b[l] * e->B[l] + end + p->b[l] * (e->H1 - e->A_end);
}

/* Fill the columns of all increments, which are `step` numbers apart. */
WIDE static void increment_columns(const dvi__partitioned *p, const entry *e, size_t step,
                                   double *columns)
{
  enum { HALF = DVI__STAGES_MOST / 2 };
  for (int l = 0; l < p->s; l++, columns += step)
    if (p->s <= HALF)
      increment_column(p, e, l, HALF, columns);
    else
      increment_column(p, e, l, DVI__STAGES_MOST, columns);
}

/* Fill the rows of a block in the column of the multiplier. */
static void multiplier_column(const dvi__partitioned *p, const entry *e, double *column)
{
  const double before = p->kick.before, both = before + p->kick.after,
               start = before * e->B0 + both * e->H0;
  for (int k = 0; k < p->s; k++)
    column[k] = before * (e->A[k] - partitioned_dot(p->s, p->abar[k], e->K)) - start;
  column[p->s] = start + before * partitioned_dot(p->s, p->b, e->K) + p->kick.after * e->B1 +
                 both * (e->H1 - e->A_end);
}

dvi_status dvi__partitioned_jacobian(dvi__partitioned *p, const double *x, double *values)
{
  const size_t m = (size_t)p->m;
  partitioned_points(p, x);
  DVI_TRY(dvi__lagrangian_hessian(p->evaluator, p->s, p->t, p->Q, p->V, p->H_qq, p->H_qv, p->H_vv));
  DVI_TRY(hessians_at_ends(p));
  for (int j = 0; j < p->n; j++) {
    const int first = p->joint.start[j], length = p->joint.start[j + 1] - first;
    const size_t step = (size_t)length * m;
    for (int e = 0; e < length; e++) {
      entry block;
      double *columns = values + m * m * (size_t)first + (size_t)e * m;
      partitioned_gather_entry(p, &p->block[first + e], &block);
      increment_columns(p, &block, step, columns);
      if (p->kick.has_multiplier) multiplier_column(p, &block, columns + (size_t)p->s * step);
    }
  }
  return DVI_OK;
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

void dvi__partitioned_continue(dvi__partitioned *p, double ratio, const double *last, double *x)
{
  for (int k = 0; k < p->s && ratio != p->ratio; k++)
    dvi__lagrange_weights(p->s, p->c, 1 + ratio * p->c[k], p->shift[k]);
  p->ratio = ratio;
  for (int i = 0; i < p->n; i++, last += p->m, x += p->m) {
    for (int k = 0; k < p->s; k++) x[k] = ratio * partitioned_dot(p->s, p->shift[k], last);
    if (p->kick.has_multiplier) x[p->s] = 0;
  }
}
