#include "system/term/term.h"

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/term/difference.h"

/* Refuse what a callback returned, with its own reason if it left one. */
static dvi_status refuse(int returned, const char *name, const char *what)
{
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  const char *colon = reason[0] != '\0' ? ": " : "";
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "%s: the %s callback failed with %d%s%s", name, what,
                     returned, colon, reason);
  return dvi__fail(DVI_CALLBACK_RETRY, "%s: the %s callback asked for a smaller step (%d)%s%s",
                   name, what, returned, colon, reason);
}

dvi_status dvi__verdict(int returned, int entries, int count, const double *result,
                        const char *name, const char *what, const char *in)
{
  if (returned != 0) return refuse(returned, name, what);
  const ptrdiff_t bad = dvi__first_not_finite((size_t)entries * (size_t)count, result);
  if (bad < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "%s: the %s callback gave %g%s (entry %td, point %td of %d)",
                   name, what, result[bad], in, bad / count, bad % count, count);
}

void dvi__gather_point(int n, int count, int k, const double *batch, double *point)
{
  for (size_t i = 0; i < (size_t)n; i++) point[i] = batch[i * (size_t)count + (size_t)k];
}

void dvi__scatter_result(int entries, int count, int k, const double *point, double *batch)
{
  for (size_t e = 0; e < (size_t)entries; e++) batch[e * (size_t)count + (size_t)k] = point[e];
}

/* ---- potentials ---- */

/* A batch of one point is the point itself. */
static const double *point_of_batch(dvi__scratch *s, int count, int k, const double *q)
{
  if (count == 1) return q;
  dvi__gather_point(s->n, count, k, q, s->point_q);
  return s->point_q;
}

int dvi__potential_has_gradient(const dvi__potential_term *p)
{
  return p->callbacks.gradient != NULL || p->callbacks.gradient_batch != NULL ||
         p->callbacks.gradient_range != NULL;
}

int dvi__potential_has_hessian(const dvi__potential_term *p)
{
  return p->callbacks.hessian != NULL || p->callbacks.hessian_batch != NULL;
}

dvi_status dvi__potential_value(const dvi__potential_term *p, dvi__scratch *s, int count,
                                const double *t, const double *q, double *V)
{
  const dvi_potential *c = &p->callbacks;
  int returned = 0;
  if (c->value_batch != NULL) returned = c->value_batch(count, t, q, V, c->user);
  for (int k = 0; c->value_batch == NULL && k < count && returned == 0; k++)
    returned = c->value(t[k], point_of_batch(s, count, k, q), V + k, c->user);
  return dvi__verdict(returned, 1, count, V, p->name, "value", "");
}

dvi_status dvi__potential_value_of_q(const void *function, int count, const double *q, double *V)
{
  const dvi__potential_at *f = function;
  return dvi__potential_value(f->term, f->scratch, count, f->t, q, V);
}

dvi_status dvi__potential_gradient_of_q(const void *function, int count, const double *q,
                                        double *V_q, double *none)
{
  const dvi__potential_at *f = function;
  (void)none;
  return dvi__potential_gradient(f->term, f->scratch, count, f->t, q, V_q);
}

/* Evaluate the gradient at one point, in the shape that is declared. */
static int ask_potential_gradient(const dvi_potential *c, int n, double t, const double *q,
                                  double *V_q)
{
  return c->gradient != NULL ? c->gradient(t, q, V_q, c->user)
                             : c->gradient_range(t, q, 0, n, V_q, c->user);
}

dvi_status dvi__potential_gradient(const dvi__potential_term *p, dvi__scratch *s, int count,
                                   const double *t, const double *q, double *V_q)
{
  const dvi_potential *c = &p->callbacks;
  int returned = 0;
  if (!dvi__potential_has_gradient(p))
    return dvi__difference_gradient(dvi__potential_value_of_q,
                                    &(dvi__potential_at){.term = p, .scratch = s, .t = t},
                                    &s->of_value, s->n, count, q, V_q);
  if (c->gradient_batch != NULL)
    returned = c->gradient_batch(count, t, q, V_q, c->user);
  else if (count == 1) /* one point needs no copy */
    returned = ask_potential_gradient(c, s->n, t[0], q, V_q);
  else
    for (int k = 0; k < count && returned == 0; k++) {
      dvi__gather_point(s->n, count, k, q, s->point_q);
      returned = ask_potential_gradient(c, s->n, t[k], s->point_q, s->result[0]);
      dvi__scatter_result(s->n, count, k, s->result[0], V_q);
    }
  return dvi__verdict(returned, s->n, count, V_q, p->name, "gradient", "");
}

dvi_status dvi__potential_hessian(const dvi__potential_term *p, dvi__scratch *s, int count,
                                  const double *t, const double *q, double *V_qq)
{
  const dvi_potential *c = &p->callbacks;
  const int entries = dvi__pattern_entries(&p->qq);
  int returned = 0;
  if (!dvi__potential_has_hessian(p))
    return dvi__difference_hessian(dvi__potential_gradient_of_q,
                                   &(dvi__potential_at){.term = p, .scratch = s, .t = t},
                                   &s->of_gradient, &p->groups, !dvi__potential_has_gradient(p),
                                   count, q, &p->qq, V_qq, NULL, NULL);
  if (c->hessian_batch != NULL) returned = c->hessian_batch(count, t, q, V_qq, c->user);
  for (int k = 0; c->hessian_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    returned = c->hessian(t[k], s->point_q, s->result[0], c->user);
    dvi__scatter_result(entries, count, k, s->result[0], V_qq);
  }
  return dvi__verdict(returned, entries, count, V_qq, p->name, "Hessian", "");
}

int dvi__potential_has_rate(const dvi__potential_term *p)
{
  return p->callbacks.rate != NULL || p->callbacks.rate_batch != NULL;
}

dvi_status dvi__potential_rate(const dvi__potential_term *p, dvi__scratch *s, int count,
                               const double *t, const double *q, double *V_t)
{
  const dvi_potential *c = &p->callbacks;
  int returned = 0;
  if (c->rate_batch != NULL) returned = c->rate_batch(count, t, q, V_t, c->user);
  for (int k = 0; c->rate_batch == NULL && k < count && returned == 0; k++)
    returned = c->rate(t[k], point_of_batch(s, count, k, q), V_t + k, c->user);
  return dvi__verdict(returned, 1, count, V_t, p->name, "rate", "");
}

/* ---- one-form: L = alpha(q).v ---- */

static const char *const form = "one-form", *const gauge = "gauge";

static int has_gauge(const dvi__lagrangian_term *l)
{
  return l->gauge.callbacks.gradient != NULL;
}

dvi_status dvi__form_value(const dvi__lagrangian_term *l, const double *q, double *alpha,
                           double *work)
{
  const int n = l->qv.columns;
  DVI_TRY(
      dvi__verdict(l->one_form.value(q, alpha, l->one_form.user), n, 1, alpha, form, "value", ""));
  if (!has_gauge(l)) return DVI_OK;
  DVI_TRY(dvi__verdict(l->gauge.callbacks.gradient(q, work, l->gauge.callbacks.user), n, 1, work,
                       gauge, "gradient", ""));
  for (int i = 0; i < n; i++) alpha[i] += work[i];
  return DVI_OK;
}

/* Add entries of a part at their places in the whole. */
static void add_part(const dvi__pattern *part, const int *where, const double *values,
                     double *whole)
{
  for (int e = 0; e < dvi__pattern_entries(part); e++) whole[where[e]] += values[e];
}

static void clear_entries(const dvi__pattern *pattern, double *values)
{
  for (int e = 0; e < dvi__pattern_entries(pattern); e++) values[e] = 0;
}

static dvi_status own_gradients(const dvi__lagrangian_term *l, const dvi__pattern *qv,
                                const double *q, double *alpha_q)
{
  const int returned = l->one_form.gradient(q, alpha_q, l->one_form.user);
  return dvi__verdict(returned, dvi__pattern_entries(qv), 1, alpha_q, form, "gradient", "");
}

dvi_status dvi__form_gradients(const dvi__lagrangian_term *l, const double *q, double *alpha_q,
                               double *work)
{
  const dvi__gauge_term *g = &l->gauge;
  if (!has_gauge(l)) return own_gradients(l, &l->qv, q, alpha_q);
  clear_entries(&l->qv, alpha_q);
  DVI_TRY(own_gradients(l, &g->form_qv, q, work));
  add_part(&g->form_qv, g->form_in_qv, work, alpha_q);
  const int returned = g->callbacks.hessian(q, work, g->callbacks.user);
  DVI_TRY(dvi__verdict(returned, dvi__pattern_entries(&g->qq), 1, work, gauge, "Hessian", ""));
  add_part(&g->qq, g->in_qv, work, alpha_q);
  return DVI_OK;
}

static dvi_status own_hessian(const dvi__lagrangian_term *l, const dvi__pattern *qq,
                              const double *q, const double *w, double *alpha_w_qq)
{
  const int returned = l->one_form.hessian(q, w, alpha_w_qq, l->one_form.user);
  return dvi__verdict(returned, dvi__pattern_entries(qq), 1, alpha_w_qq, form, "Hessian", "");
}

/* Compute the Hessian of (alpha + grad f).w at one point. */
static dvi_status whole_hessian(const dvi__lagrangian_term *l, const double *q, const double *w,
                                double *qq, double *work)
{
  const dvi__gauge_term *g = &l->gauge;
  if (!has_gauge(l)) return own_hessian(l, &l->qq, q, w, qq);
  clear_entries(&l->qq, qq);
  DVI_TRY(own_hessian(l, &g->form_qq, q, w, work));
  add_part(&g->form_qq, g->form_in_qq, work, qq);
  const int returned = g->callbacks.third(q, w, work, g->callbacks.user);
  DVI_TRY(dvi__verdict(returned, dvi__pattern_entries(&g->qq), 1, work, gauge, "third derivatives'",
                       ""));
  add_part(&g->qq, g->in_qq, work, qq);
  return DVI_OK;
}

/* Compute s->result[0] = alpha at point k of the batch, with s->point_q and s->point_v. */
static dvi_status form_value(const dvi__lagrangian_term *l, dvi__scratch *s, int count, int k,
                             const double *q, const double *v)
{
  dvi__gather_point(s->n, count, k, q, s->point_q);
  dvi__gather_point(s->n, count, k, v, s->point_v);
  return dvi__form_value(l, s->point_q, s->result[0], s->result[2]);
}

static dvi_status form_lagrangian(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                  const double *q, const double *v, double *L)
{
  for (int k = 0; k < count; k++) {
    DVI_TRY(form_value(l, s, count, k, q, v));
    L[k] = 0;
    for (int i = 0; i < s->n; i++) L[k] += s->result[0][i] * s->point_v[i];
  }
  return DVI_OK;
}

/* Compute L_q = sum_j v_j d alpha_j/dq,  L_v = alpha. */
static dvi_status one_form_gradient(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                    const double *q, const double *v, double *L_q, double *L_v)
{
  for (int k = 0; k < count; k++) {
    DVI_TRY(form_value(l, s, count, k, q, v));
    dvi__scatter_result(s->n, count, k, s->result[0], L_v);
    DVI_TRY(dvi__form_gradients(l, s->point_q, s->result[1], s->result[2]));
    for (int i = 0; i < s->n; i++) s->result[0][i] = 0;
    for (int j = 0; j < s->n; j++)
      for (int e = l->qv.start[j]; e < l->qv.start[j + 1]; e++)
        s->result[0][l->qv.row[e]] += s->point_v[j] * s->result[1][e];
    dvi__scatter_result(s->n, count, k, s->result[0], L_q);
  }
  return DVI_OK;
}

/* Compute the Hessian of alpha.v, by differences of the gradients if there is no callback. */
static dvi_status form_curvature(const dvi__general_at *at, int count, double *L_qq)
{
  const dvi__lagrangian_term *l = at->term;
  dvi__scratch *s = at->scratch;
  if (!dvi__general_has_hessian(l))
    return dvi__difference_hessian(dvi__general_gradient_of_q, at, &s->of_gradient, &l->q_groups, 0,
                                   count, at->q, &l->qq, L_qq, NULL, NULL);
  for (int k = 0; k < count; k++) {
    dvi__gather_point(s->n, count, k, at->q, s->point_q);
    dvi__gather_point(s->n, count, k, at->v, s->point_v);
    DVI_TRY(whole_hessian(l, s->point_q, s->point_v, s->result[0], s->result[2]));
    dvi__scatter_result(dvi__pattern_entries(&l->qq), count, k, s->result[0], L_qq);
  }
  return DVI_OK;
}

/* Compute L_qq, the Hessian of alpha.v, and L_qv, the gradients of alpha. L_vv is empty. */
static dvi_status one_form_hessian(const dvi__general_at *at, int count, double *L_qq, double *L_qv)
{
  const dvi__lagrangian_term *l = at->term;
  dvi__scratch *s = at->scratch;
  DVI_TRY(form_curvature(at, count, L_qq));
  for (int k = 0; k < count; k++) {
    dvi__gather_point(s->n, count, k, at->q, s->point_q);
    DVI_TRY(dvi__form_gradients(l, s->point_q, s->result[0], s->result[2]));
    dvi__scatter_result(dvi__pattern_entries(&l->qv), count, k, s->result[0], L_qv);
  }
  return DVI_OK;
}

/* ---- general Lagrangian ---- */

static int is_form(const dvi__lagrangian_term *l)
{
  return l->one_form.value != NULL;
}

int dvi__general_has_gradient(const dvi__lagrangian_term *l)
{
  return is_form(l) || l->computed != NULL || l->callbacks.gradient != NULL ||
         l->callbacks.gradient_batch != NULL;
}

int dvi__general_has_hessian(const dvi__lagrangian_term *l)
{
  if (is_form(l))
    return l->one_form.hessian != NULL && (!has_gauge(l) || l->gauge.callbacks.third != NULL);
  return l->computed != NULL || l->callbacks.hessian != NULL || l->callbacks.hessian_batch != NULL;
}

dvi_status dvi__general_value(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                              const double *t, const double *q, const double *v, double *L)
{
  const dvi_lagrangian *c = &l->callbacks;
  int returned = 0;
  if (l->computed != NULL) return l->computed->value(l->of, count, t, q, v, L);
  if (is_form(l)) return form_lagrangian(l, s, count, q, v, L);
  if (c->value_batch != NULL) returned = c->value_batch(count, t, q, v, L, c->user);
  for (int k = 0; c->value_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    dvi__gather_point(s->n, count, k, v, s->point_v);
    returned = c->value(t[k], s->point_q, s->point_v, L + k, c->user);
  }
  return dvi__verdict(returned, 1, count, L, l->name, "value", "");
}

dvi_status dvi__general_value_of_q(const void *function, int count, const double *q, double *L)
{
  const dvi__general_at *f = function;
  return dvi__general_value(f->term, f->scratch, count, f->t, q, f->v, L);
}

dvi_status dvi__general_value_of_v(const void *function, int count, const double *v, double *L)
{
  const dvi__general_at *f = function;
  return dvi__general_value(f->term, f->scratch, count, f->t, f->q, v, L);
}

dvi_status dvi__general_gradient_of_q(const void *function, int count, const double *q, double *L_q,
                                      double *L_v)
{
  const dvi__general_at *f = function;
  return dvi__general_gradient(f->term, f->scratch, count, f->t, q, f->v, L_q, L_v);
}

dvi_status dvi__general_gradient_of_v(const void *function, int count, const double *v, double *L_q,
                                      double *L_v)
{
  const dvi__general_at *f = function;
  return dvi__general_gradient(f->term, f->scratch, count, f->t, f->q, v, L_q, L_v);
}

dvi_status dvi__general_gradient(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                 const double *t, const double *q, const double *v, double *L_q,
                                 double *L_v)
{
  const dvi_lagrangian *c = &l->callbacks;
  int returned = 0;
  if (l->computed != NULL) return l->computed->gradient(l->of, count, t, q, v, L_q, L_v);
  if (is_form(l)) return one_form_gradient(l, s, count, q, v, L_q, L_v);
  if (!dvi__general_has_gradient(l)) {
    const dvi__general_at at = {.term = l, .scratch = s, .t = t, .q = q, .v = v};
    DVI_TRY(
        dvi__difference_gradient(dvi__general_value_of_q, &at, &s->of_value, s->n, count, q, L_q));
    return dvi__difference_gradient(dvi__general_value_of_v, &at, &s->of_value, s->n, count, v,
                                    L_v);
  }
  if (c->gradient_batch != NULL) returned = c->gradient_batch(count, t, q, v, L_q, L_v, c->user);
  for (int k = 0; c->gradient_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    dvi__gather_point(s->n, count, k, v, s->point_v);
    returned = c->gradient(t[k], s->point_q, s->point_v, s->result[0], s->result[1], c->user);
    dvi__scatter_result(s->n, count, k, s->result[0], L_q);
    dvi__scatter_result(s->n, count, k, s->result[1], L_v);
  }
  DVI_TRY(dvi__verdict(returned, s->n, count, L_q, l->name, "gradient", " in L_q"));
  return dvi__verdict(returned, s->n, count, L_v, l->name, "gradient", " in L_v");
}

static dvi_status difference_general_hessian(const dvi__general_at *at, int count, double *L_qq,
                                             double *L_qv, double *L_vv)
{
  const dvi__lagrangian_term *l = at->term;
  dvi__differences *d = &at->scratch->of_gradient;
  const int noisy = !dvi__general_has_gradient(l);
  DVI_TRY(dvi__difference_hessian(dvi__general_gradient_of_q, at, d, &l->q_groups, noisy, count,
                                  at->q, &l->qq, L_qq, NULL, NULL));
  return dvi__difference_hessian(dvi__general_gradient_of_v, at, d, &l->v_groups, noisy, count,
                                 at->v, &l->qv, L_qv, &l->vv, L_vv);
}

dvi_status dvi__general_hessian(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                const double *t, const double *q, const double *v, double *L_qq,
                                double *L_qv, double *L_vv)
{
  const dvi_lagrangian *c = &l->callbacks;
  const int qq = dvi__pattern_entries(&l->qq), qv = dvi__pattern_entries(&l->qv),
            vv = dvi__pattern_entries(&l->vv);
  int returned = 0;
  if (l->computed != NULL) return l->computed->hessian(l->of, count, t, q, v, L_qq, L_qv, L_vv);
  if (is_form(l))
    return one_form_hessian(&(dvi__general_at){.term = l, .scratch = s, .t = t, .q = q, .v = v},
                            count, L_qq, L_qv);
  if (!dvi__general_has_hessian(l))
    return difference_general_hessian(
        &(dvi__general_at){.term = l, .scratch = s, .t = t, .q = q, .v = v}, count, L_qq, L_qv,
        L_vv);
  if (c->hessian_batch != NULL)
    returned = c->hessian_batch(count, t, q, v, L_qq, L_qv, L_vv, c->user);
  for (int k = 0; c->hessian_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    dvi__gather_point(s->n, count, k, v, s->point_v);
    returned = c->hessian(t[k], s->point_q, s->point_v, s->result[0], s->result[1], s->result[2],
                          c->user);
    dvi__scatter_result(qq, count, k, s->result[0], L_qq);
    dvi__scatter_result(qv, count, k, s->result[1], L_qv);
    dvi__scatter_result(vv, count, k, s->result[2], L_vv);
  }
  DVI_TRY(dvi__verdict(returned, qq, count, L_qq, l->name, "Hessian", " in L_qq"));
  DVI_TRY(dvi__verdict(returned, qv, count, L_qv, l->name, "Hessian", " in L_qv"));
  return dvi__verdict(returned, vv, count, L_vv, l->name, "Hessian", " in L_vv");
}

int dvi__general_has_rate(const dvi__lagrangian_term *l)
{
  return is_form(l) || l->callbacks.rate != NULL || l->callbacks.rate_batch != NULL;
}

dvi_status dvi__general_rate(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                             const double *t, const double *q, const double *v, double *L_t)
{
  const dvi_lagrangian *c = &l->callbacks;
  int returned = 0;
  for (int k = 0; is_form(l) && k < count; k++) L_t[k] = 0;
  if (is_form(l)) return DVI_OK;
  if (c->rate_batch != NULL) returned = c->rate_batch(count, t, q, v, L_t, c->user);
  for (int k = 0; c->rate_batch == NULL && k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    dvi__gather_point(s->n, count, k, v, s->point_v);
    returned = c->rate(t[k], s->point_q, s->point_v, L_t + k, c->user);
  }
  return dvi__verdict(returned, 1, count, L_t, l->name, "rate", "");
}

dvi_status dvi__general_admit(const dvi__lagrangian_term *l, double t, const double *q)
{
  const dvi_lagrangian *c = &l->callbacks;
  if (l->computed != NULL || c->admit == NULL) return DVI_OK;
  return dvi__verdict(c->admit(t, q, c->user), 1, 1, &t, l->name, "admit", "");
}
