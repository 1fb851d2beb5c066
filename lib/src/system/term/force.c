#include "system/term/force.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/declare.h"
#include "system/term/difference.h"

/* ---- declaration ---- */

static dvi_status refuse_memory_of_forces(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its forces");
}

static int is_left_out(const dvi_pattern *pattern)
{
  return pattern->start == NULL && pattern->row == NULL;
}

static dvi_status check_force(const dvi_force *given, const char *name)
{
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: force '%s' has no value callback", name);
  if ((given->value != NULL && given->value_batch != NULL) ||
      (given->jacobian != NULL && given->jacobian_batch != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: force '%s' has its %s callback in two shapes, one-point and batch; "
                     "declare one",
                     name,
                     given->value != NULL && given->value_batch != NULL ? "value" : "Jacobian");
  if (given->without_velocity && !is_left_out(&given->by_v))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: force '%s' has a pattern of dF/dv, but is declared without velocity",
                     name);
  return DVI_OK;
}

/* Rows of the patterns are components of F, columns those of q, or of v. */
static dvi_status copy_force(dvi_system *s, const dvi_force *given, dvi__force_term *term)
{
  const char *name = given->name != NULL ? given->name : "force";
  DVI_TRY(check_force(given, name));
  if (s->slot_count > 0 && (given->jacobian != NULL || given->jacobian_batch != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: force '%s' has a Jacobian, but with factors forces are differenced "
                     "in the charts; leave it out",
                     name);
  term->callbacks = *given;
  s->terms |= dvi__force_kind(term);
  term->name = dvi__duplicate(name, strlen(name) + 1, 1);
  if (term->name == NULL) return refuse_memory_of_forces();
  term->callbacks.name = term->name;
  if (!is_left_out(&given->by_q))
    DVI_TRY(dvi__pattern_copy_rectangular(&given->by_q, s->nv, s->n, name, &term->by_q));
  if (given->without_velocity) return dvi__pattern_empty(s->nv, &term->by_v);
  return is_left_out(&given->by_v) ? DVI_OK
                                   : dvi__pattern_copy(&given->by_v, s->nv, name, &term->by_v);
}

dvi_status dvi__forces_copy(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->force_count == 0) return DVI_OK;
  s->forces = DVI_NEW(dvi__force_term, terms->force_count);
  if (s->forces == NULL) return refuse_memory_of_forces();
  for (int k = 0; k < terms->force_count; k++) {
    s->force_count = k + 1;
    DVI_TRY(copy_force(s, &terms->forces[k], &s->forces[k]));
  }
  return DVI_OK;
}

void dvi__force_clear(dvi__force_term *force)
{
  dvi__pattern_clear(&force->by_q);
  dvi__pattern_clear(&force->by_v);
  dvi__release(force->name);
  dvi__release(force->in_by_q);
  dvi__release(force->in_by_v);
  dvi__release(force->q_groups.of_column);
  dvi__release(force->v_groups.of_column);
}

static dvi_status complete_block(const dvi__force_term *force, int n, dvi__pattern *pattern,
                                 dvi__groups *groups)
{
  const dvi_status status = pattern->start == NULL
                                ? dvi__pattern_copy(&(dvi_pattern){0}, n, force->name, pattern)
                                : DVI_OK;
  if (status != DVI_OK) return dvi__fail_in(status, "the Jacobian of '%s'", force->name);
  if (dvi__force_has_jacobian(force) || groups->of_column != NULL) return DVI_OK;
  return dvi__group_columns(pattern, groups);
}

dvi_status dvi__force_complete(dvi__force_term *force, int n)
{
  DVI_TRY(complete_block(force, n, &force->by_q, &force->q_groups));
  return complete_block(force, n, &force->by_v, &force->v_groups);
}

/* ---- evaluation ---- */

unsigned dvi__force_kind(const dvi__force_term *force)
{
  return force->callbacks.without_velocity ? DVI__FORCE : DVI__FRICTION;
}

int dvi__force_has_jacobian(const dvi__force_term *force)
{
  return force->callbacks.jacobian != NULL || force->callbacks.jacobian_batch != NULL;
}

/* A batch of one point is the point itself. */
dvi_status dvi__force_value(const dvi__force_term *f, dvi__scratch *s, int count, const double *t,
                            const double *q, const double *v, double *F)
{
  const dvi_force *c = &f->callbacks;
  int returned = 0;
  if (c->without_velocity) v = NULL;
  if (c->value_batch != NULL)
    returned = c->value_batch(count, t, q, v, F, c->user);
  else if (count == 1)
    returned = c->value(*t, q, v, F, c->user);
  else
    for (int k = 0; k < count && returned == 0; k++) {
      dvi__gather_point(s->n, count, k, q, s->point_q);
      if (v != NULL) dvi__gather_point(s->nv, count, k, v, s->point_v);
      returned = c->value(t[k], s->point_q, v != NULL ? s->point_v : NULL, s->result[0], c->user);
      dvi__scatter_result(s->nv, count, k, s->result[0], F);
    }
  return dvi__verdict(returned, s->nv, count, F, f->name, "value", "");
}

dvi_status dvi__force_of_q(const void *function, int count, const double *q, double *F,
                           double *none)
{
  const dvi__force_at *at = function;
  (void)none;
  return dvi__force_value(at->term, at->scratch, count, at->t, q, at->v, F);
}

dvi_status dvi__force_of_v(const void *function, int count, const double *v, double *F,
                           double *none)
{
  const dvi__force_at *at = function;
  (void)none;
  return dvi__force_value(at->term, at->scratch, count, at->t, at->q, v, F);
}

static dvi_status difference_force(const dvi__force_at *at, int count, double *F_q, double *F_v)
{
  const dvi__force_term *f = at->term;
  dvi__differences *d = &at->scratch->of_gradient;
  DVI_TRY(dvi__difference_hessian(dvi__force_of_q, at, d, &f->q_groups, 0, count, at->q, &f->by_q,
                                  F_q, NULL, NULL));
  if (f->callbacks.without_velocity) return DVI_OK;
  return dvi__difference_hessian(dvi__force_of_v, at, d, &f->v_groups, 0, count, at->v, &f->by_v,
                                 F_v, NULL, NULL);
}

/* Evaluate the Jacobians by the one-point callback. A batch of one point is the point itself. */
static int ask_for_jacobians(const dvi__force_term *f, dvi__scratch *s, int count, const double *t,
                             const double *q, const double *v, double *F_q, double *F_v)
{
  const dvi_force *c = &f->callbacks;
  int returned = 0;
  if (count == 1) return c->jacobian(*t, q, v, F_q, F_v, c->user);
  for (int k = 0; k < count && returned == 0; k++) {
    dvi__gather_point(s->n, count, k, q, s->point_q);
    if (v != NULL) dvi__gather_point(s->nv, count, k, v, s->point_v);
    returned = c->jacobian(t[k], s->point_q, v != NULL ? s->point_v : NULL, s->result[0],
                           v != NULL ? s->result[1] : NULL, c->user);
    dvi__scatter_result(dvi__pattern_entries(&f->by_q), count, k, s->result[0], F_q);
    if (v != NULL) dvi__scatter_result(dvi__pattern_entries(&f->by_v), count, k, s->result[1], F_v);
  }
  return returned;
}

dvi_status dvi__force_jacobian(const dvi__force_term *f, dvi__scratch *s, int count,
                               const double *t, const double *q, const double *v, double *F_q,
                               double *F_v)
{
  const dvi_force *c = &f->callbacks;
  if (c->without_velocity) v = F_v = NULL;
  if (!dvi__force_has_jacobian(f))
    return difference_force(&(dvi__force_at){.term = f, .scratch = s, .t = t, .q = q, .v = v},
                            count, F_q, F_v);
  const int returned = c->jacobian_batch != NULL
                           ? c->jacobian_batch(count, t, q, v, F_q, F_v, c->user)
                           : ask_for_jacobians(f, s, count, t, q, v, F_q, F_v);
  DVI_TRY(dvi__verdict(returned, dvi__pattern_entries(&f->by_q), count, F_q, f->name, "Jacobian",
                       " in F_q"));
  if (F_v == NULL) return DVI_OK;
  return dvi__verdict(returned, dvi__pattern_entries(&f->by_v), count, F_v, f->name, "Jacobian",
                      " in F_v");
}
