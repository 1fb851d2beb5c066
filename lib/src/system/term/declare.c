#include "system/term/declare.h"

#include "core/memory.h"
#include "core/status.h"
#include "system/term/term.h"

static dvi_status refuse_memory_of_term(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its terms");
}

dvi_status dvi__group_columns(const dvi__pattern *pattern, dvi__groups *groups)
{
  dvi__release(groups->of_column);
  groups->of_column = DVI_NEW(int, pattern->columns);
  if (groups->of_column == NULL) return refuse_memory_of_term();
  return dvi__pattern_groups(pattern, groups->of_column, &groups->count);
}

dvi_status dvi__general_group(dvi__lagrangian_term *term)
{
  dvi__pattern v_columns;
  DVI_TRY(dvi__group_columns(&term->qq, &term->q_groups));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->vv, &v_columns));
  const dvi_status status = dvi__group_columns(&v_columns, &term->v_groups);
  dvi__pattern_clear(&v_columns);
  return status;
}

dvi_status dvi__check_shapes(const char *owner, int values, int gradients, int hessians, int rates)
{
  if (!values && !gradients && !hessians && !rates) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system: %s has its %s callback in two shapes, one-point and batch; declare one",
                   owner,
                   values      ? "value"
                   : gradients ? "gradient"
                   : hessians  ? "Hessian"
                               : "rate");
}

dvi_status dvi__check_rate(const dvi_system *s, const char *owner, int given)
{
  if (!given || !s->autonomous) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "system: %s has a rate, but the system is declared autonomous; leave out one of them", owner);
}

dvi_status dvi__declare_function(dvi_system *s, const dvi_lagrangian *given, const char *name,
                                 const char *const part[3])
{
  dvi__lagrangian_term *term = s->lagrangian = DVI_NEW(dvi__lagrangian_term, 1);
  if (term == NULL) return refuse_memory_of_term();
  term->name = name;
  term->callbacks = *given;
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, s->n, part[0], &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->qv, s->n, part[1], &term->qv));
  DVI_TRY(dvi__pattern_copy_symmetric(&given->vv, s->n, part[2], &term->vv));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->qv, &s->qv));
  DVI_TRY(dvi__pattern_union(&term->vv, &term->vv, &s->vv));
  const int differenced = given->hessian == NULL && given->hessian_batch == NULL;
  return differenced ? dvi__general_group(term) : DVI_OK;
}
