#include "system/evaluate/untested.h"

#include "core/status.h"
#include "num/simd/wide.h"
#include "system/evaluate/evaluator_struct.h"

WIDE static void add_gradient(size_t length, const double *restrict term, double *restrict sum)
{
  for (size_t i = 0; i < length; i++) sum[i] += term[i];
}

/* What is not the gradient of one potential by one call is compiled apart, so that this costs
 * hardly more than the callback's own work. */

__attribute__((noinline)) static dvi_status refuse(const dvi__potential_term *term, int returned)
{
  return dvi__verdict(returned, 0, 0, NULL, term->name, "gradient", "");
}

/* Evaluate a potential of another shape, or by differences. */
__attribute__((noinline)) static dvi_status by_point(dvi__evaluator *e,
                                                     const dvi__potential_term *term, int count,
                                                     const double *t, const double *q,
                                                     double *gradient)
{
  const dvi_status status = dvi__potential_gradient(term, &e->scratch, count, t, q, gradient);
  dvi__count_differences(e);
  return status;
}

/* A batch of one point is the point itself. */
static inline dvi_status evaluate_term(dvi__evaluator *e, const dvi__potential_term *term,
                                       int count, const double *t, const double *q,
                                       double *gradient)
{
  const dvi_potential *c = &term->callbacks;
  int returned;
  if (c->gradient_batch != NULL)
    returned = c->gradient_batch(count, t, q, gradient, c->user);
  else if (c->gradient != NULL && count == 1)
    returned = c->gradient(*t, q, gradient, c->user);
  else
    return by_point(e, term, count, t, q, gradient);
  return returned == 0 ? DVI_OK : refuse(term, returned);
}

__attribute__((noinline)) static dvi_status sum_terms(dvi__evaluator *e, int count, const double *t,
                                                      const double *q, double *V_q)
{
  const dvi_system *s = e->system;
  dvi_status status = evaluate_term(e, &s->potentials[0], count, t, q, V_q);
  for (int p = 1; p < s->potential_count && status == DVI_OK; p++) {
    status = evaluate_term(e, &s->potentials[p], count, t, q, e->term);
    add_gradient((size_t)s->n * (size_t)count, e->term, V_q);
  }
  return status;
}

dvi_status dvi__potentials_gradient_untested(dvi__evaluator *e, int count, const double *t,
                                             const double *q, double *V_q)
{
  const dvi_system *s = e->system;
  if (s->potential_count == 0 || s->force_count > 0)
    return dvi__potentials_gradient(e, count, t, q, V_q);
  e->counters->gradients += count;
  if (s->potential_count > 1) return sum_terms(e, count, t, q, V_q);
  return evaluate_term(e, s->potentials, count, t, q, V_q);
}

dvi__gradient_callback *dvi__lone_gradient(const dvi__evaluator *e, void **user)
{
  const dvi_system *s = e->system;
  if (s->potential_count != 1 || s->force_count > 0) return NULL;
  *user = s->potentials[0].callbacks.user;
  return s->potentials[0].callbacks.gradient_batch;
}

dvi_status dvi__some_gradients_untested(dvi__evaluator *e, int fast, int count, const double *t,
                                        const double *q, double *V_q)
{
  const dvi_system *s = e->system;
  int found = 0;
  if (fast) e->counters->gradients += count;
  for (int p = 0; p < s->potential_count; p++) {
    const dvi__potential_term *term = &s->potentials[p];
    if ((term->callbacks.fast != 0) != fast) continue;
    DVI_TRY(evaluate_term(e, term, count, t, q, found ? e->term : V_q));
    if (found) add_gradient((size_t)s->n * (size_t)count, e->term, V_q);
    found = 1;
  }
  return DVI_OK;
}
