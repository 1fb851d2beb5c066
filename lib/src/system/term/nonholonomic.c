#include "system/term/nonholonomic.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/declare.h"
#include "system/term/difference.h"

/* ---- declaration ---- */

static dvi_status refuse_memory_of_velocity_rows(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its nonholonomic constraints");
}

static dvi_status copy_nonholonomic(dvi_system *s, const dvi_nonholonomic *given,
                                    dvi__nonholonomic_term *term)
{
  const char *name = given->name != NULL ? given->name : "nonholonomic";
  if (given->value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: nonholonomic constraint '%s' has no value callback",
                     name);
  if (given->count < 1 || given->count > s->n - s->row_count)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: nonholonomic constraint '%s' has %d rows; 1 to %d are possible "
                     "beside the others, because there are %d coordinates",
                     name, given->count, s->n - s->row_count, s->n);
  term->callbacks = *given;
  term->first = s->row_count;
  s->row_count += given->count;
  term->name = dvi__duplicate(name, strlen(name) + 1, 1);
  if (term->name == NULL) return refuse_memory_of_velocity_rows();
  term->callbacks.name = term->name;
  DVI_TRY(dvi__pattern_copy_rectangular(&given->transposed, s->n, given->count, name,
                                        &term->transposed));
  DVI_TRY(dvi__pattern_copy_rectangular(&given->by_q, given->count, s->n, name, &term->by_q));
  return given->derivative != NULL ? DVI_OK : dvi__group_columns(&term->by_q, &term->groups);
}

dvi_status dvi__nonholonomics_copy(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->nonholonomic_count == 0) return DVI_OK;
  s->terms |= DVI__NONHOLONOMIC;
  s->nonholonomics = DVI_NEW(dvi__nonholonomic_term, terms->nonholonomic_count);
  if (s->nonholonomics == NULL) return refuse_memory_of_velocity_rows();
  for (int k = 0; k < terms->nonholonomic_count; k++) {
    s->nonholonomic_count = k + 1;
    DVI_TRY(copy_nonholonomic(s, &terms->nonholonomics[k], &s->nonholonomics[k]));
  }
  return DVI_OK;
}

void dvi__nonholonomic_clear(dvi__nonholonomic_term *term)
{
  dvi__pattern_clear(&term->transposed);
  dvi__pattern_clear(&term->by_q);
  dvi__release(term->name);
  dvi__release(term->groups.of_column);
}

/* ---- evaluation ---- */

dvi_status dvi__nonholonomic_value(const dvi__nonholonomic_term *term, double t, const double *q,
                                   double *A)
{
  const dvi_nonholonomic *c = &term->callbacks;
  return dvi__verdict(c->value(t, q, A, c->user), dvi__pattern_entries(&term->transposed), 1, A,
                      term->name, "value", "");
}

dvi_status dvi__nonholonomic_affine(const dvi__nonholonomic_term *term, double t, const double *q,
                                    double *a)
{
  const dvi_nonholonomic *c = &term->callbacks;
  if (c->affine == NULL) {
    memset(a, 0, (size_t)c->count * sizeof *a);
    return DVI_OK;
  }
  return dvi__verdict(c->affine(t, q, a, c->user), c->count, 1, a, term->name, "affine", "");
}

dvi_status dvi__nonholonomic_of_q(const void *function, int count, const double *q, double *rows,
                                  double *none)
{
  const dvi__nonholonomic_at *at = function;
  const dvi__pattern *A = &at->term->transposed;
  (void)count, (void)none;
  memset(rows, 0, (size_t)A->rows * sizeof *rows);
  DVI_TRY(dvi__nonholonomic_value(at->term, at->t, q, at->A));
  DVI_TRY(dvi__nonholonomic_affine(at->term, at->t, q, rows));
  for (int a = 0; a < A->columns; a++)
    for (int e = A->start[a]; e < A->start[a + 1]; e++) rows[a] += at->A[e] * at->v[A->row[e]];
  return DVI_OK;
}

dvi_status dvi__nonholonomic_derivative(const dvi__nonholonomic_at *at, dvi__scratch *scratch,
                                        const double *q, double *Av_q)
{
  const dvi__nonholonomic_term *term = at->term;
  const dvi_nonholonomic *c = &term->callbacks;
  if (c->derivative == NULL)
    return dvi__difference_hessian(dvi__nonholonomic_of_q, at, &scratch->of_gradient, &term->groups,
                                   0, 1, q, &term->by_q, Av_q, NULL, NULL);
  return dvi__verdict(c->derivative(at->t, q, at->v, Av_q, c->user),
                      dvi__pattern_entries(&term->by_q), 1, Av_q, term->name, "derivative", "");
}
