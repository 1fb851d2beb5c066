#include "system/term/vector.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/declare.h"
#include "system/term/difference.h"

static const char *const name = "vector potential";

/* ---- declaration ---- */

static dvi_status check_vector(const dvi_system *s, const dvi_vector_potential *given)
{
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the %s has no value callback", name);
  if (given->gradient == NULL && given->gradient_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the %s has no gradient callback", name);
  DVI_TRY(dvi__check_shapes("the vector potential", given->value && given->value_batch,
                            given->gradient && given->gradient_batch,
                            given->hessian && given->hessian_batch,
                            given->rate && given->rate_batch));
  return dvi__check_rate(s, "the vector potential", given->rate || given->rate_batch);
}

dvi_status dvi__vector_copy(dvi_system *s, const dvi_system_terms *terms)
{
  const dvi_vector_potential *given = terms->vector_potential;
  if (given == NULL) return DVI_OK;
  DVI_TRY(check_vector(s, given));
  dvi__vector_term *term = s->vector = DVI_NEW(dvi__vector_term, 1);
  if (term == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its %s", name);
  s->terms |= DVI__VECTOR_POTENTIAL;
  term->callbacks = *given;
  DVI_TRY(dvi__pattern_copy(&given->gradients, s->n, "gradients of the vector potential",
                            &term->gradients));
  dvi__pattern_clear(&s->qv);
  DVI_TRY(dvi__pattern_union(&term->gradients, &term->gradients, &s->qv));
  if (given->qq.start == NULL && given->qq.row == NULL) return DVI_OK;
  return dvi__pattern_copy_symmetric(&given->qq, s->n, "Hessian of the vector potential",
                                     &term->qq);
}

void dvi__vector_clear(dvi__vector_term **vector)
{
  dvi__vector_term *term = *vector;
  if (term == NULL) return;
  dvi__pattern_clear(&term->gradients);
  dvi__pattern_clear(&term->qq);
  dvi__release(term->in_qq);
  dvi__release(term->groups.of_column);
  dvi__release(term);
  *vector = NULL;
}

dvi_status dvi__vector_complete(dvi__vector_term *term, int n)
{
  if (term->qq.start == NULL)
    DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, n, "Hessian of the vector potential", &term->qq));
  if (dvi__vector_has_hessian(term) || term->groups.of_column != NULL) return DVI_OK;
  return dvi__group_columns(&term->qq, &term->groups);
}

int dvi__vector_has_hessian(const dvi__vector_term *term)
{
  return term->callbacks.hessian != NULL || term->callbacks.hessian_batch != NULL;
}

int dvi__vector_has_rate(const dvi__vector_term *term)
{
  return term->callbacks.rate != NULL || term->callbacks.rate_batch != NULL;
}

/* ---- evaluation ---- */

/* Evaluate a callback of t and q in the shape that is declared. */
static int ask(int (*one)(double, const double *, double *, void *),
               int (*batch)(int, const double *, const double *, double *, void *), void *user,
               dvi__scratch *s, int entries, int count, const double *t, const double *q,
               double *result)
{
  int returned = 0;
  if (batch != NULL) return batch(count, t, q, result, user);
  if (count == 1) return one(t[0], q, result, user);
  for (int k = 0; k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    returned = one(t[k], s->point_q, s->result[0], user);
    dvi__scatter_result(entries, count, k, s->result[0], result);
  }
  return returned;
}

dvi_status dvi__vector_value(const dvi__vector_term *term, dvi__scratch *s, int count,
                             const double *t, const double *q, double *A)
{
  const dvi_vector_potential *c = &term->callbacks;
  const int returned = ask(c->value, c->value_batch, c->user, s, s->n, count, t, q, A);
  return dvi__verdict(returned, s->n, count, A, name, "value", "");
}

dvi_status dvi__vector_gradients(const dvi__vector_term *term, dvi__scratch *s, int count,
                                 const double *t, const double *q, double *A_q)
{
  const dvi_vector_potential *c = &term->callbacks;
  const int entries = dvi__pattern_entries(&term->gradients),
            returned = ask(c->gradient, c->gradient_batch, c->user, s, entries, count, t, q, A_q);
  return dvi__verdict(returned, entries, count, A_q, name, "gradient", "");
}

dvi_status dvi__vector_rate(const dvi__vector_term *term, dvi__scratch *s, int count,
                            const double *t, const double *q, double *A_t)
{
  const dvi_vector_potential *c = &term->callbacks;
  const int returned = ask(c->rate, c->rate_batch, c->user, s, s->n, count, t, q, A_t);
  return dvi__verdict(returned, s->n, count, A_t, name, "rate", "");
}

dvi_status dvi__vector_forces(const dvi__vector_term *term, dvi__scratch *s, int count,
                              const double *t, const double *q, const double *w, double *A_w_q)
{
  const size_t points = (size_t)count;
  const dvi__pattern *pattern = &term->gradients;
  DVI_TRY(dvi__vector_gradients(term, s, count, t, q, s->vector_q));
  memset(A_w_q, 0, (size_t)s->n * points * sizeof(double));
  for (size_t j = 0; j < (size_t)s->n; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      double *sum = A_w_q + (size_t)pattern->row[e] * points;
      const double *A_q = s->vector_q + (size_t)e * points;
      for (size_t k = 0; k < points; k++) sum[k] += A_q[k] * w[j * points + k];
    }
  return DVI_OK;
}

dvi_status dvi__vector_of_q(const void *function, int count, const double *q, double *A_w_q,
                            double *A)
{
  const dvi__vector_at *at = function;
  if (A != NULL) DVI_TRY(dvi__vector_value(at->term, at->scratch, count, at->t, q, A));
  return dvi__vector_forces(at->term, at->scratch, count, at->t, q, at->w, A_w_q);
}

/* The gradient of A.w as a function of q alone. */
static dvi_status forces_of_q(const void *function, int count, const double *q, double *A_w_q,
                              double *none)
{
  (void)none;
  return dvi__vector_of_q(function, count, q, A_w_q, NULL);
}

dvi_status dvi__vector_hessian(const dvi__vector_term *term, dvi__scratch *s, int count,
                               const double *t, const double *q, const double *w, double *A_w_qq)
{
  const dvi_vector_potential *c = &term->callbacks;
  const int entries = dvi__pattern_entries(&term->qq);
  int returned = 0;
  if (!dvi__vector_has_hessian(term))
    return dvi__difference_hessian(
        forces_of_q, &(dvi__vector_at){.term = term, .scratch = s, .t = t, .w = w}, &s->of_gradient,
        &term->groups, 0, count, q, &term->qq, A_w_qq, NULL, NULL);
  if (c->hessian_batch != NULL) returned = c->hessian_batch(count, t, q, w, A_w_qq, c->user);
  for (int k = 0; c->hessian_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    dvi__gather_point(s->n, count, k, w, s->point_v);
    returned = c->hessian(t[k], s->point_q, s->point_v, s->result[0], c->user);
    dvi__scatter_result(entries, count, k, s->result[0], A_w_qq);
  }
  return dvi__verdict(returned, entries, count, A_w_qq, name, "Hessian", "");
}
