#include "system/evaluate/form_batches.h"

#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "num/simd/abreast.h"
#include "system/evaluate/evaluator_struct.h"

/* Copy point k of a batch, and the results at it, as the functions of term.h. Calls of these would
 * cost a fifth of an evaluation. */
INLINE void gather(int n, int count, int k, const double *batch, double *point)
{
  for (int i = 0; i < n; i++) point[i] = batch[i * count + k];
}

INLINE void scatter(int entries, int count, int k, const double *point, double *batch)
{
  for (int e = 0; e < entries; e++) batch[e * count + k] = point[e];
}

/* Evaluate the one-form at one point. Numbers are tested by the caller. */
static dvi_status value_at(const dvi__lagrangian_term *l, dvi__scratch *s)
{
  if (l->gauge.callbacks.gradient != NULL)
    return dvi__form_value(l, s->point_q, s->result[0], s->result[2]);
  return l->one_form.value(s->point_q, s->result[0], l->one_form.user) == 0 ? DVI_OK
                                                                            : DVI_NOT_FINITE;
}

static dvi_status gradients_at(const dvi__lagrangian_term *l, dvi__scratch *s)
{
  if (l->gauge.callbacks.gradient != NULL)
    return dvi__form_gradients(l, s->point_q, s->result[1], s->result[2]);
  return l->one_form.gradient(s->point_q, s->result[1], l->one_form.user) == 0 ? DVI_OK
                                                                               : DVI_NOT_FINITE;
}

/* Test a batch. Numbers of lanes that do not go on are finite after this, too. */
static dvi_status batch_is_finite(size_t numbers, double *x)
{
  if (dvi__first_not_finite(numbers, x) < 0) return DVI_OK;
  memset(x, 0, numbers * sizeof *x);
  return DVI_NOT_FINITE;
}

dvi_status dvi__form_batch(dvi__evaluator *e, int count, const int *going, const double *q,
                           double *alpha, double *alpha_q)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  dvi__scratch *s = &e->scratch;
  const int n = e->system->n, entries = dvi__pattern_entries(&l->qv);
  for (int k = 0; k < count; k++) {
    if (!going[k % DVI__ABREAST]) continue;
    gather(n, count, k, q, s->point_q);
    if (alpha != NULL) DVI_TRY(value_at(l, s));
    if (alpha != NULL) scatter(n, count, k, s->result[0], alpha);
    if (alpha_q != NULL) DVI_TRY(gradients_at(l, s));
    if (alpha_q != NULL) scatter(entries, count, k, s->result[1], alpha_q);
  }
  if (alpha != NULL) DVI_TRY(batch_is_finite((size_t)n * (size_t)count, alpha));
  return alpha_q != NULL ? batch_is_finite((size_t)entries * (size_t)count, alpha_q) : DVI_OK;
}

dvi_status dvi__form_mixed_hessian(dvi__evaluator *e, const double *q, double *alpha_q)
{
  e->counters->hessians++;
  return dvi__form_gradients(e->system->lagrangian, q, alpha_q, e->scratch.result[0]);
}

/* Evaluate the Hessians at all points, packed in the order of the one-form's own qq. */
static dvi_status packed_hessians(dvi__evaluator *e, int count, const double *q, const double *w,
                                  double *alpha_w_qq, double *alpha_q)
{
  const dvi__lagrangian_term *l = e->system->lagrangian;
  dvi__scratch *s = &e->scratch;
  const int n = e->system->n, qq = dvi__pattern_entries(&l->qq), qv = dvi__pattern_entries(&l->qv);
  if (l->gauge.callbacks.gradient != NULL)
    return dvi__general_hessian(l, s, count, NULL, q, w, alpha_w_qq, alpha_q, e->hessian[2]);
  for (int k = 0; k < count; k++) {
    gather(n, count, k, q, s->point_q);
    gather(n, count, k, w, s->point_v);
    if (l->one_form.hessian(s->point_q, s->point_v, s->result[0], l->one_form.user) != 0)
      return DVI_NOT_FINITE;
    scatter(qq, count, k, s->result[0], alpha_w_qq);
    DVI_TRY(gradients_at(l, s));
    scatter(qv, count, k, s->result[1], alpha_q);
  }
  DVI_TRY(batch_is_finite((size_t)qq * (size_t)count, alpha_w_qq));
  return batch_is_finite((size_t)qv * (size_t)count, alpha_q);
}

dvi_status dvi__form_hessian_batch(dvi__evaluator *e, int count, const double *q, const double *w,
                                   double *alpha_w_qq, double *alpha_q)
{
  DVI_TRY(packed_hessians(e, count, q, w, alpha_w_qq, alpha_q));
  dvi__spread_entries(e->system, (size_t)count, alpha_w_qq);
  return DVI_OK;
}

dvi_status dvi__subtract_potentials(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *L_q)
{
  const dvi_system *s = e->system;
  for (int p = 0; p < s->potential_count; p++) {
    DVI_TRY(dvi__potential_gradient(&s->potentials[p], &e->scratch, count, t, q, e->term));
    for (size_t i = 0; i < (size_t)s->n * (size_t)count; i++) L_q[i] -= e->term[i];
  }
  return DVI_OK;
}
