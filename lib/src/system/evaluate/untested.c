#include "system/evaluate/untested.h"

#include "num/simd/wide.h"
#include "system/evaluate/evaluator_struct.h"

WIDE static void add_gradient(size_t length, const double *restrict term, double *restrict sum)
{
  for (size_t i = 0; i < length; i++) sum[i] += term[i];
}

/* Evaluate one potential. Only a batch callback costs no more than its own work. */
static inline dvi_status evaluate_term(dvi__evaluator *e, const dvi__potential_term *term,
                                       int count, const double *t, const double *q,
                                       double *gradient)
{
  const dvi_potential *c = &term->callbacks;
  if (c->gradient_batch == NULL)
    return dvi__potential_gradient(term, &e->scratch, count, t, q, gradient);
  const int returned = c->gradient_batch(count, t, q, gradient, c->user);
  return returned == 0 ? DVI_OK
                       : dvi__verdict(returned, 0, count, gradient, term->name, "gradient", "");
}

dvi_status dvi__potentials_gradient_untested(dvi__evaluator *e, int count, const double *t,
                                             const double *q, double *V_q)
{
  const dvi_system *s = e->system;
  if (s->potential_count == 0 || s->force_count > 0)
    return dvi__potentials_gradient(e, count, t, q, V_q);
  e->counters->gradients += count;
  dvi_status status = evaluate_term(e, &s->potentials[0], count, t, q, V_q);
  for (int p = 1; p < s->potential_count && status == DVI_OK; p++) {
    status = evaluate_term(e, &s->potentials[p], count, t, q, e->term);
    add_gradient((size_t)s->n * (size_t)count, e->term, V_q);
  }
  if (e->scratch.of_value.points > 0) dvi__count_differences(e);
  return status;
}
