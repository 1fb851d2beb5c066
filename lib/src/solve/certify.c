#include "solve/certify.h"

#include "core/status.h"
#include "solve/solver_struct.h"

int dvi__certify_is_prepared(const dvi__solver *s, int most)
{
  return s->keeps_point && (most <= 1 || s->many != NULL);
}

dvi_status dvi__certify_prepare(dvi__solver *s, int most)
{
  if (dvi__certify_is_prepared(s, most)) return DVI_OK;
  if (s->tester == NULL) DVI_TRY(dvi__kinsol_create(s, 1, &s->tester));
  s->keeps_point = 1;
  if (s->many == NULL && most > 1) DVI_TRY(dvi__kinsol_create(s, most, &s->many));
  s->counters->preparations++;
  return DVI_OK;
}

double *dvi__certify_point(dvi__solver *s, int i)
{
  return dvi__kinsol_point(s->many, i);
}

dvi_status dvi__certify_note(dvi__solver *s, int i, const double *next, double whole, double size)
{
  if (whole == 0) whole = size > 0 ? size : 1;
  return dvi__kinsol_note(s->many, i, next, whole);
}

int dvi__certify_noted(dvi__solver *s, int count)
{
  if (!dvi__kinsol_certify_known(s->many, count)) return 0;
  s->counters->certified += count;
  return 1;
}
