/* The linearised equations of a partitioned step: as a matrix, and by their inverse. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "step/degenerate/partitioned_struct.h"
#include "step/degenerate/stage_inverse.h"
#include "system/evaluate/form_batches.h"

static const double *place_of_k1(const dvi__partitioned *p)
{
  return p->kick.at_mean ? p->mean : p->q1;
}

static dvi_status hessians_at_ends(dvi__partitioned *p)
{
  if (!p->kick.has_multiplier) return DVI_OK;
  p->has_gradients = !p->kick.at_mean;
  DVI_TRY(p->kick.at_mean ? dvi__form_hessian(p->evaluator, p->mean, p->k0, p->qq0, p->qv0)
                          : dvi__form_mixed_hessian(p->evaluator, p->q0, p->qv0));
  DVI_TRY(dvi__form_hessian(p->evaluator, place_of_k1(p), p->k1, p->qq1, p->qv1));
  if (p->kick.at_mean) return dvi__form_hessian(p->evaluator, p->q1, p->k1, p->qq_end, p->qv_end);
  memcpy(p->qv_end, p->qv1, (size_t)dvi__pattern_entries(&p->system->qv) * sizeof(double));
  return DVI_OK;
}

/* Evaluate the second derivatives at x. */
static dvi_status evaluate_hessians(dvi__partitioned *p, const double *x)
{
  dvi__partitioned_points(p, x);
  DVI_TRY(dvi__lagrangian_hessian(p->evaluator, p->s, p->t, p->Q, p->V, p->H_qq, p->H_qv, p->H_vv));
  return hessians_at_ends(p);
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

void dvi__partitioned_fill(dvi__partitioned *p, double *values)
{
  const size_t m = (size_t)p->m;
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
}

dvi_status dvi__partitioned_jacobian(dvi__partitioned *p, const double *x, double *values)
{
  DVI_TRY(evaluate_hessians(p, x));
  dvi__partitioned_fill(p, values);
  return DVI_OK;
}

/* ---- inverse ---- */

/* The end is one more stage, whose row has the kicks at q1. All rows have those at q0. */
dvi_status dvi__partitioned_create_inverse(dvi__partitioned *p)
{
  const kicks *kick = &p->kick;
  dvi__stage_tableau of = {.stages = p->m, .has_end = kick->has_multiplier};
  if (p->m > DVI__STAGE_LANES) return DVI_OK;
  for (int k = 0; k < p->m; k++) {
    const int is_end = k == p->s;
    for (int l = 0; l < p->s; l++) of.moved[l][k] = is_end ? p->b[l] : p->a[k][l];
    if (kick->has_multiplier) of.moved[p->s][k] = kick->before + (is_end ? kick->after : 0);
  }
  return dvi__stage_inverse_create(p->n, &of, &p->inverse);
}

static void fill_stage_entry(const dvi__partitioned *p, const dvi__joint_entry *where,
                             dvi__stage_entry *out)
{
  const kicks *kick = &p->kick;
  gather_stages(p, p->H_qv, where->vq, out->A);
  gather_stages(p, p->H_qv, where->qv, out->B);
  gather_stages(p, p->H_qq, where->qq, out->K);
  for (int k = 0; k < p->s; k++) out->K[k] *= p->h;
  if (!kick->has_multiplier) return;
  out->A[p->s] = partitioned_at(p->qv_end, where->vq);
  out->B[p->s] = kick->after * partitioned_at(p->qv1, where->qv);
  out->K[p->s] = (kick->at_mean ? 0.5 : 1.0) * partitioned_at(p->qq1, where->qq);
  out->a = kick->before * partitioned_at(p->qv0, where->qv);
  out->c = kick->at_mean ? 0.5 * partitioned_at(p->qq0, where->qq) : 0;
}

dvi_status dvi__partitioned_invert(dvi__partitioned *p, const double *x, int *inverted)
{
  DVI_TRY(evaluate_hessians(p, x));
  *inverted = p->inverse != NULL;
  if (!*inverted) return DVI_OK;
  for (int j = 0; j < p->n; j++)
    for (int e = p->joint.start[j]; e < p->joint.start[j + 1]; e++)
      fill_stage_entry(p, &p->block[e], dvi__stage_inverse_entry(p->inverse, p->joint.row[e], j));
  *inverted = dvi__stage_inverse_begin(p->inverse, p->s, p->b);
  return DVI_OK;
}

void dvi__partitioned_correct(dvi__partitioned *p, double *r)
{
  dvi__stage_inverse_solve(p->inverse, r);
}
