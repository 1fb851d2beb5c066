#include "system/check/check_struct.h"

#include "core/memory.h"
#include "core/status.h"
#include "system/term/holonomic.h"

static int longest_pattern(const dvi_system *system)
{
  const int vv = dvi__pattern_entries(&system->vv), qv = dvi__pattern_entries(&system->qv),
            qq = dvi__pattern_entries(&system->qq);
  const int has_rows = system->row_count > 0,
            rows = has_rows ? dvi__pattern_entries(&system->rows_q) : 0,
            curvature = has_rows ? dvi__pattern_entries(&system->rows_qq) : 0;
  const int longest = vv > qv ? vv : qv, terms = dvi__longest_hessian(system, 1),
            most = longest > terms ? longest : terms, of_rows = rows > curvature ? rows : curvature,
            all = most > of_rows ? most : of_rows;
  int longest_of_all = qq > all ? qq : all;
  for (int k = 0; k < system->nonholonomic_count; k++) {
    const int by_q = dvi__pattern_entries(&system->nonholonomics[k].by_q);
    if (by_q > longest_of_all) longest_of_all = by_q;
  }
  return longest_of_all;
}

dvi_status dvi__check_allocate(dvi__check *c, const dvi_system *system)
{
  DVI_TRY(dvi__system_complete_patterns(system));
  DVI_TRY(dvi__scratch_create(system, 1, 1, &c->scratch));
  int complete = dvi__differences_allocate((size_t)c->n, &c->differences);
  for (int i = 0; i < 2; i++) {
    c->gradient[i] = DVI_NEW(double, c->n);
    /* two more numbers show writes around a range */
    c->column[i] = DVI_NEW(double, (size_t)c->n + 2);
    complete = complete && c->gradient[i] != NULL && c->column[i] != NULL;
  }
  for (int i = 0; i < 3; i++) {
    c->hessian[i] = DVI_NEW(double, longest_pattern(system));
    complete = complete && c->hessian[i] != NULL;
  }
  return complete ? DVI_OK
                  : dvi__fail(DVI_NO_MEMORY, "system check: no memory for %d dimensions", c->n);
}

void dvi__check_clear(dvi__check *c)
{
  dvi__scratch_clear(&c->scratch);
  dvi__differences_clear(&c->differences);
  for (int i = 0; i < 2; i++) {
    dvi__release(c->gradient[i]);
    dvi__release(c->column[i]);
  }
  for (int i = 0; i < 3; i++) dvi__release(c->hessian[i]);
}
