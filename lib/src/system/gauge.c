#include "system/gauge.h"

#include "core/memory.h"
#include "core/status.h"

/* Replace `sum` by its union with f's Hessian. The old pattern is kept in `form`, and the places of
 * both in the union are stored. */
static dvi_status join_gauge_pattern(const dvi__pattern *qq, dvi__pattern *sum, dvi__pattern *form,
                                     int **form_in, int **in)
{
  *form = *sum;
  *sum = (dvi__pattern){0};
  DVI_TRY(dvi__pattern_union(form, qq, sum));
  *form_in = DVI_NEW(int, (size_t)dvi__pattern_entries(form) + 1);
  *in = DVI_NEW(int, (size_t)dvi__pattern_entries(qq) + 1);
  if (*form_in == NULL || *in == NULL)
    return dvi__fail(DVI_NO_MEMORY, "system: no memory for the gauge");
  dvi__pattern_embed(form, sum, *form_in);
  dvi__pattern_embed(qq, sum, *in);
  return DVI_OK;
}

dvi_status dvi__gauge_join(const dvi_gauge *given, dvi__lagrangian_term *term)
{
  dvi__gauge_term *gauge = &term->gauge;
  if (given->gradient == NULL || given->hessian == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the gauge has no %s callback",
                     given->gradient == NULL ? "gradient" : "Hessian");
  gauge->callbacks = *given;
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, term->qv.columns, "gauge: d2f/dq2", &gauge->qq));
  DVI_TRY(join_gauge_pattern(&gauge->qq, &term->qv, &gauge->form_qv, &gauge->form_in_qv,
                             &gauge->in_qv));
  return join_gauge_pattern(&gauge->qq, &term->qq, &gauge->form_qq, &gauge->form_in_qq,
                            &gauge->in_qq);
}

void dvi__gauge_clear(dvi__gauge_term *gauge)
{
  dvi__pattern_clear(&gauge->qq);
  dvi__pattern_clear(&gauge->form_qq);
  dvi__pattern_clear(&gauge->form_qv);
  dvi__release(gauge->in_qq);
  dvi__release(gauge->in_qv);
  dvi__release(gauge->form_in_qq);
  dvi__release(gauge->form_in_qv);
}
