/* Patterns of second derivatives that are completed late. Those that were not declared are full,
 * with n^2 entries that only a method with Hessians should pay for. */
#include <pthread.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/system.h"
#include "system/term/declare.h"
#include "system/term/force.h"
#include "system/term/vector.h"

static dvi_status widen_pattern(dvi__pattern *whole, const dvi__pattern *part)
{
  dvi__pattern sum;
  DVI_TRY(dvi__pattern_union(whole, part, &sum));
  dvi__pattern_clear(whole);
  *whole = sum;
  return DVI_OK;
}

static dvi_status embed_pattern(const dvi__pattern *part, const dvi__pattern *whole, int **where)
{
  dvi__release(*where);
  *where = DVI_NEW(int, dvi__pattern_entries(part));
  if (*where == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its patterns");
  dvi__pattern_embed(part, whole, *where);
  return DVI_OK;
}

static dvi_status complete_potential(const dvi_system *s, dvi__potential_term *term)
{
  if (term->callbacks.without_hessian)
    return term->qq.start == NULL ? dvi__pattern_empty(s->n, &term->qq) : DVI_OK;
  const int differenced = term->callbacks.hessian == NULL && term->callbacks.hessian_batch == NULL;
  const dvi_status status = term->qq.start == NULL
                                ? dvi__pattern_copy(&(dvi_pattern){0}, s->n, term->name, &term->qq)
                                : DVI_OK;
  if (status != DVI_OK) return dvi__fail_in(status, "the Hessian of '%s'", term->name);
  return differenced ? dvi__group_columns(&term->qq, &term->groups) : DVI_OK;
}

static dvi_status join_hessians(dvi_system *s, dvi__pattern *qq)
{
  for (int k = 0; k < s->potential_count; k++) DVI_TRY(complete_potential(s, &s->potentials[k]));
  for (int k = 0; k < s->noise.function_count; k++)
    DVI_TRY(complete_potential(s, &s->noise_functions[k]));
  DVI_TRY(dvi__pattern_empty(s->n, qq));
  if (s->lagrangian != NULL) DVI_TRY(widen_pattern(qq, &s->lagrangian->qq));
  for (int k = 0; k < s->potential_count; k++) DVI_TRY(widen_pattern(qq, &s->potentials[k].qq));
  if (s->vector != NULL) {
    DVI_TRY(dvi__vector_complete(s->vector, s->n));
    DVI_TRY(widen_pattern(qq, &s->vector->qq));
    DVI_TRY(embed_pattern(&s->vector->qq, qq, &s->vector->in_qq));
  }
  if (s->lagrangian != NULL) DVI_TRY(embed_pattern(&s->lagrangian->qq, qq, &s->lagrangian->in_qq));
  for (int k = 0; k < s->potential_count; k++)
    DVI_TRY(embed_pattern(&s->potentials[k].qq, qq, &s->potentials[k].in_qq));
  return DVI_OK;
}

static dvi_status join_jacobians(dvi_system *s, dvi__pattern *by_q, dvi__pattern *by_v)
{
  DVI_TRY(dvi__pattern_empty(s->n, by_q));
  DVI_TRY(dvi__pattern_empty(s->n, by_v));
  if (s->slot_count > 0) return DVI_OK; /* forces are differenced in the charts */
  for (int k = 0; k < s->force_count; k++) {
    DVI_TRY(dvi__force_complete(&s->forces[k], s->n));
    DVI_TRY(widen_pattern(by_q, &s->forces[k].by_q));
    DVI_TRY(widen_pattern(by_v, &s->forces[k].by_v));
  }
  for (int k = 0; k < s->force_count; k++) {
    DVI_TRY(embed_pattern(&s->forces[k].by_q, by_q, &s->forces[k].in_by_q));
    DVI_TRY(embed_pattern(&s->forces[k].by_v, by_v, &s->forces[k].in_by_v));
  }
  return DVI_OK;
}

/* Join the patterns of all terms. On failure nothing is kept. */
static dvi_status join_terms(dvi_system *s)
{
  dvi__pattern qq = {0}, by_q = {0}, by_v = {0};
  dvi_status status = join_hessians(s, &qq);
  if (status == DVI_OK) status = join_jacobians(s, &by_q, &by_v);
  if (status == DVI_OK) {
    s->by_q = by_q;
    s->by_v = by_v;
    s->qq = qq;
    return DVI_OK;
  }
  dvi__pattern_clear(&qq);
  dvi__pattern_clear(&by_q);
  dvi__pattern_clear(&by_v);
  return status;
}

/* Patterns that were not declared are made late, when several threads may share the system. */
static pthread_mutex_t hessian_lock = PTHREAD_MUTEX_INITIALIZER;

/* Return the larger of a count and the entries of a pattern, full if it was not declared. */
static size_t more_entries(size_t least, size_t n, const dvi__pattern *pattern)
{
  const size_t entries = pattern->start != NULL ? (size_t)dvi__pattern_entries(pattern) : n * n;
  return entries > least ? entries : least;
}

static size_t count_least_entries(const dvi_system *system)
{
  const size_t n = (size_t)system->n;
  size_t least = (size_t)dvi__pattern_entries(&system->vv);
  if (system->lagrangian != NULL) least = more_entries(least, n, &system->lagrangian->qq);
  for (int k = 0; k < system->potential_count; k++)
    if (!system->potentials[k].callbacks.without_hessian)
      least = more_entries(least, n, &system->potentials[k].qq);
  if (system->vector != NULL) least = more_entries(least, n, &system->vector->qq);
  for (int k = 0; k < system->force_count; k++)
    least = more_entries(more_entries(least, n, &system->forces[k].by_q), n,
                         &system->forces[k].by_v);
  return least;
}

size_t dvi__system_least_entries(const dvi_system *system)
{
  (void)pthread_mutex_lock(&hessian_lock);
  const size_t least = count_least_entries(system);
  (void)pthread_mutex_unlock(&hessian_lock);
  return least;
}

/* The user sees no change of the system, so it is const. The lock serves users on other threads. On
 * failure the remains are replaced by the next call, or freed with the system. */
dvi_status dvi__system_complete_patterns(const dvi_system *system)
{
  dvi_system *s = (dvi_system *)(uintptr_t)system;
  dvi_status status = DVI_OK;
  (void)pthread_mutex_lock(&hessian_lock);
  if (s->qq.start == NULL) status = join_terms(s);
  (void)pthread_mutex_unlock(&hessian_lock);
  return status;
}

const char *dvi__system_without_hessian(const dvi_system *system)
{
  for (int k = 0; k < system->potential_count; k++)
    if (system->potentials[k].callbacks.without_hessian) return system->potentials[k].name;
  return NULL;
}

dvi_status dvi__system_has_hessians(const dvi_system *system)
{
  const char *without = dvi__system_without_hessian(system);
  if (without == NULL) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "potential '%s' is declared without a Hessian, and second derivatives are "
                   "needed; take a method that needs none, or give the Hessian",
                   without);
}

dvi_status dvi__system_prepare_hessian(const dvi_system *system)
{
  DVI_TRY(dvi__system_has_hessians(system));
  return dvi__system_complete_patterns(system);
}
