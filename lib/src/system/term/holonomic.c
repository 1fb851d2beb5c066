#include "system/term/holonomic.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/declare.h"
#include "system/term/difference.h"

/* ---- declaration ---- */

static dvi_status refuse_memory_of_rows(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its holonomic constraints");
}

static dvi_status copy_row_names(const dvi_holonomic *given, dvi__holonomic_term *term)
{
  if (given->row_names == NULL) return DVI_OK;
  term->row_names = DVI_NEW(char *, given->count);
  if (term->row_names == NULL) return refuse_memory_of_rows();
  term->callbacks.row_names = (const char *const *)term->row_names;
  for (int a = 0; a < given->count; a++) {
    if (given->row_names[a] == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: constraint '%s' has no name of row %d",
                       term->name, a);
    term->row_names[a] = dvi__duplicate(given->row_names[a], strlen(given->row_names[a]) + 1, 1);
    if (term->row_names[a] == NULL) return refuse_memory_of_rows();
  }
  return DVI_OK;
}

static dvi_status copy_holonomic(dvi_system *s, const dvi_holonomic *given,
                                 dvi__holonomic_term *term)
{
  const char *name = given->name != NULL ? given->name : "constraint";
  const int has_value = given->value != NULL || given->value_batch != NULL;
  if (!has_value || (given->gradient == NULL && given->gradient_batch == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "system: constraint '%s' has no %s callback", name,
                     has_value ? "gradient" : "value");
  DVI_TRY(dvi__check_shapes(name, given->value && given->value_batch,
                            given->gradient && given->gradient_batch, 0, 0));
  const int most = 4 * s->nx - s->row_count;
  if (given->count < 1 || given->count > most)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: constraint '%s' has %d rows; 1 to %d are possible beside the others, "
                     "four for each of %d degrees of freedom, of which some follow from others",
                     name, given->count, most, s->nx);
  DVI_TRY(dvi__check_rate(s, name, given->rate != NULL));
  term->callbacks = *given;
  term->first = s->row_count;
  s->row_count += given->count;
  term->name = dvi__duplicate(name, strlen(name) + 1, 1);
  if (term->name == NULL) return refuse_memory_of_rows();
  term->callbacks.name = term->name;
  DVI_TRY(copy_row_names(given, term));
  DVI_TRY(
      dvi__pattern_copy_rectangular(&given->gradients, s->n, given->count, name, &term->gradients));
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, s->n, name, &term->qq));
  return given->hessian != NULL ? DVI_OK : dvi__group_columns(&term->qq, &term->groups);
}

/* Write the columns of a term from column `first` on, whose entries begin at start[first]. */
static void append_columns(const dvi__pattern *columns, int first, dvi__pattern *all)
{
  int at = all->start[first];
  for (int a = 0; a < columns->columns; a++) {
    for (int e = columns->start[a]; e < columns->start[a + 1]; e++)
      all->row[at++] = columns->row[e];
    all->start[first + a + 1] = at;
  }
}

/* Join the gradients of all terms, column after column, and the rows of A. */
static dvi_status join_gradients(dvi_system *s)
{
  size_t entries = 0;
  for (int k = 0; k < s->holonomic_count; k++)
    entries += (size_t)dvi__pattern_entries(&s->holonomics[k].gradients);
  for (int k = 0; k < s->nonholonomic_count; k++)
    entries += (size_t)dvi__pattern_entries(&s->nonholonomics[k].transposed);
  s->rows_q = (dvi__pattern){s->n, s->row_count, DVI_NEW(int, (size_t)s->row_count + 1),
                             DVI_NEW(int, entries)};
  if (s->rows_q.start == NULL || s->rows_q.row == NULL) return refuse_memory_of_rows();
  s->rows_q.start[0] = 0;
  for (int k = 0; k < s->holonomic_count; k++)
    append_columns(&s->holonomics[k].gradients, s->holonomics[k].first, &s->rows_q);
  for (int k = 0; k < s->nonholonomic_count; k++)
    append_columns(&s->nonholonomics[k].transposed, s->nonholonomics[k].first, &s->rows_q);
  return DVI_OK;
}

static dvi_status join_curvatures(dvi_system *s)
{
  DVI_TRY(dvi__pattern_empty(s->n, &s->rows_qq));
  for (int k = 0; k < s->holonomic_count; k++) {
    dvi__pattern sum;
    DVI_TRY(dvi__pattern_union(&s->rows_qq, &s->holonomics[k].qq, &sum));
    dvi__pattern_clear(&s->rows_qq);
    s->rows_qq = sum;
  }
  for (int k = 0; k < s->holonomic_count; k++) {
    dvi__holonomic_term *term = &s->holonomics[k];
    term->in_qq = DVI_NEW(int, dvi__pattern_entries(&term->qq));
    if (term->in_qq == NULL) return refuse_memory_of_rows();
    dvi__pattern_embed(&term->qq, &s->rows_qq, term->in_qq);
  }
  return DVI_OK;
}

dvi_status dvi__holonomics_copy(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->holonomic_count == 0) return DVI_OK;
  s->terms |= DVI__HOLONOMIC;
  s->holonomics = DVI_NEW(dvi__holonomic_term, terms->holonomic_count);
  if (s->holonomics == NULL) return refuse_memory_of_rows();
  for (int k = 0; k < terms->holonomic_count; k++) {
    s->holonomic_count = k + 1;
    DVI_TRY(copy_holonomic(s, &terms->holonomics[k], &s->holonomics[k]));
  }
  s->place_rows = s->row_count;
  return DVI_OK;
}

dvi_status dvi__rows_join(dvi_system *s)
{
  if (s->row_count == 0) return DVI_OK;
  DVI_TRY(join_gradients(s));
  return join_curvatures(s);
}

void dvi__holonomic_clear(dvi__holonomic_term *term)
{
  dvi__pattern_clear(&term->gradients);
  dvi__pattern_clear(&term->qq);
  for (int a = 0; term->row_names != NULL && a < term->callbacks.count; a++)
    dvi__release(term->row_names[a]);
  dvi__release(term->row_names);
  dvi__release(term->name);
  dvi__release(term->in_qq);
  dvi__release(term->groups.of_column);
}

/* ---- evaluation ---- */

dvi_status dvi__holonomic_value(const dvi__holonomic_term *term, double t, const double *q,
                                double *phi)
{
  const dvi_holonomic *c = &term->callbacks;
  const int returned = c->value_batch != NULL ? c->value_batch(1, &t, q, phi, c->user)
                                              : c->value(t, q, phi, c->user);
  return dvi__verdict(returned, c->count, 1, phi, term->name, "value", "");
}

dvi_status dvi__holonomic_gradient(const dvi__holonomic_term *term, double t, const double *q,
                                   double *phi_q)
{
  const dvi_holonomic *c = &term->callbacks;
  const int returned = c->gradient_batch != NULL ? c->gradient_batch(1, &t, q, phi_q, c->user)
                                                 : c->gradient(t, q, phi_q, c->user);
  return dvi__verdict(returned, dvi__pattern_entries(&term->gradients), 1, phi_q, term->name,
                      "gradient", "");
}

dvi_status dvi__holonomic_values(const dvi__holonomic_term *term, int points, const double *t,
                                 const double *q, double *work, double *phi)
{
  const dvi_holonomic *c = &term->callbacks;
  const int n = term->gradients.rows;
  if (c->value_batch != NULL)
    return dvi__verdict(c->value_batch(points, t, q, phi, c->user), c->count, points, phi,
                        term->name, "value", "");
  for (int k = 0; k < points; k++) {
    dvi__gather_point(n, points, k, q, work);
    DVI_TRY(dvi__holonomic_value(term, t[k], work, work + n));
    dvi__scatter_result(c->count, points, k, work + n, phi);
  }
  return DVI_OK;
}

dvi_status dvi__holonomic_gradients(const dvi__holonomic_term *term, int points, const double *t,
                                    const double *q, double *work, double *phi_q)
{
  const dvi_holonomic *c = &term->callbacks;
  const int n = term->gradients.rows, entries = dvi__pattern_entries(&term->gradients);
  if (c->gradient_batch != NULL)
    return dvi__verdict(c->gradient_batch(points, t, q, phi_q, c->user), entries, points, phi_q,
                        term->name, "gradient", "");
  for (int k = 0; k < points; k++) {
    dvi__gather_point(n, points, k, q, work);
    DVI_TRY(dvi__holonomic_gradient(term, t[k], work, work + n));
    dvi__scatter_result(entries, points, k, work + n, phi_q);
  }
  return DVI_OK;
}

dvi_status dvi__holonomic_rate(const dvi__holonomic_term *term, double t, const double *q,
                               double *phi_t)
{
  const dvi_holonomic *c = &term->callbacks;
  if (c->rate == NULL) {
    memset(phi_t, 0, (size_t)c->count * sizeof *phi_t);
    return DVI_OK;
  }
  return dvi__verdict(c->rate(t, q, phi_t, c->user), c->count, 1, phi_t, term->name, "rate", "");
}

dvi_status dvi__holonomic_gradient_of_q(const void *function, int count, const double *q,
                                        double *first, double *none)
{
  const dvi__holonomic_at *at = function;
  const dvi__pattern *G = &at->term->gradients;
  const int n = G->rows;
  (void)none;
  for (int k = 0; k < count; k++) {
    dvi__gather_point(n, count, k, q, at->point);
    DVI_TRY(dvi__holonomic_gradient(at->term, at->t, at->point, at->phi_q));
    memset(at->sum, 0, (size_t)n * sizeof(double));
    for (int a = 0; a < G->columns; a++)
      for (int e = G->start[a]; e < G->start[a + 1]; e++)
        at->sum[G->row[e]] += at->w[a] * at->phi_q[e];
    dvi__scatter_result(n, count, k, at->sum, first);
  }
  return DVI_OK;
}

dvi_status dvi__holonomic_hessian(const dvi__holonomic_at *at, dvi__scratch *scratch,
                                  const double *q, double *phi_w_qq)
{
  const dvi__holonomic_term *term = at->term;
  const dvi_holonomic *c = &term->callbacks;
  if (c->hessian == NULL)
    return dvi__difference_hessian(dvi__holonomic_gradient_of_q, at, &scratch->of_gradient,
                                   &term->groups, 0, 1, q, &term->qq, phi_w_qq, NULL, NULL);
  return dvi__verdict(c->hessian(at->t, q, at->w, phi_w_qq, c->user),
                      dvi__pattern_entries(&term->qq), 1, phi_w_qq, term->name, "Hessian", "");
}
