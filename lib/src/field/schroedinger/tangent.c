#include "field/schroedinger/tangent.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/linear.h"

struct dvi__tangent {
  const dvi_schroedinger *s;
  dvi__pattern pattern; /* columns are rows of the symmetric T, with an entry of the border each */
  double *H, *values, *b;
  dvi__linear *linear;
};

static void fill_pattern(const dvi_schroedinger *s, dvi__pattern *p)
{
  const int n = (int)s->free;
  int at = 0;
  for (int j = 0; j < n; j++) {
    p->start[j] = at;
    for (int64_t e = s->T.start[j]; e < s->T.start[j + 1]; e++) p->row[at++] = s->T.column[e];
    p->row[at++] = n;
  }
  p->start[n] = at;
  for (int i = 0; i <= n; i++) p->row[at++] = i;
  p->start[n + 1] = at;
}

static dvi_status make(dvi__tangent *a)
{
  const dvi_schroedinger *s = a->s;
  const int64_t n = s->free, entries = s->T.start[n], all = entries + 2 * n + 1;
  a->pattern = (dvi__pattern){(int)n + 1, (int)n + 1, DVI_NEW(int, n + 2), DVI_NEW(int, all)};
  a->H = DVI_NEW(double, entries);
  a->values = DVI_NEW(double, all);
  a->b = DVI_NEW(double, n + 1);
  if (!a->pattern.start || !a->pattern.row || !a->H || !a->values || !a->b)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a matrix with %lld entries",
                     (long long)all);
  fill_pattern(s, &a->pattern);
  return dvi__linear_create_bordered(&a->pattern, 1, NULL, &a->linear);
}

dvi_status dvi__tangent_create(const dvi_schroedinger *s, dvi__tangent **made)
{
  dvi__tangent *a = DVI_NEW(dvi__tangent, 1);
  *made = NULL;
  if (a == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a solver");
  a->s = s;
  const dvi_status status = make(a);
  if (status == DVI_OK)
    *made = a;
  else
    dvi__tangent_destroy(&a);
  return status;
}

void dvi__tangent_destroy(dvi__tangent **tangent)
{
  if (tangent == NULL || *tangent == NULL) return;
  dvi__tangent *a = *tangent;
  dvi__linear_destroy(&a->linear);
  dvi__pattern_clear(&a->pattern);
  dvi__release(a->H);
  dvi__release(a->values);
  dvi__release(a->b);
  dvi__release(a);
  *tangent = NULL;
}

dvi_status dvi__tangent_solve(dvi__tangent *a, const double *V, const double *c, const double *b,
                              double *x)
{
  const dvi_schroedinger *s = a->s;
  const int64_t n = s->free;
  int64_t at = 0;
  dvi__schroedinger_assemble(s, V, a->H);
  for (int64_t j = 0; j < n; j++) {
    for (int64_t e = s->T.start[j]; e < s->T.start[j + 1]; e++) a->values[at++] = a->H[e];
    a->values[at++] = -c[j];
  }
  for (int64_t i = 0; i < n; i++) a->values[at++] = -c[i];
  a->values[at] = 0;
  DVI_TRY(dvi__linear_factor(a->linear, a->values));
  memcpy(a->b, b, (size_t)n * sizeof *b);
  a->b[n] = 0;
  DVI_TRY(dvi__linear_solve(a->linear, a->b));
  memcpy(x, a->b, (size_t)n * sizeof *x);
  return DVI_OK;
}
