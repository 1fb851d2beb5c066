/* Sparse LU by KLU: one symbolic analysis, then numeric refactorisations with the pivots of the last full one. */
#include <float.h>
#include <klu.h>
#include <stdint.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"

typedef struct sparse {
  klu_common common;
  klu_symbolic *symbolic;
  klu_numeric *numeric;
} sparse;

static void destroy(void *factor)
{
  sparse *s = factor;
  if (s == NULL) return;
  klu_free_numeric(&s->numeric, &s->common);
  klu_free_symbolic(&s->symbolic, &s->common);
  dvi__release(s);
}

static dvi_status create(const dvi__pattern *pattern, void **factor)
{
  sparse *s = *factor = DVI_NEW(sparse, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "KLU: no memory");
  klu_defaults(&s->common);
  s->symbolic = klu_analyze(pattern->columns, pattern->start, pattern->row, &s->common);
  if (s->symbolic != NULL) return DVI_OK;
  const int memory = s->common.status == KLU_OUT_OF_MEMORY;
  destroy(s);
  *factor = NULL;
  if (memory) return dvi__fail(DVI_NO_MEMORY, "KLU: no memory to analyse %d columns", pattern->columns);
  return dvi__fail(DVI_SINGULAR, "KLU: the pattern of the %d x %d matrix is structurally singular", pattern->rows, pattern->columns);
}

static int well_conditioned(sparse *s)
{
  return klu_rcond(s->symbolic, s->numeric, &s->common) && s->common.rcond >= DBL_EPSILON;
}

/* klu_refactor keeps the pivots and allocates nothing; pivots grown bad show in the cheap condition estimate (the smallest over the
 * largest pivot), and then a full factorisation chooses new ones. */
static dvi_status refactor(void *factor, const dvi__pattern *pattern, const double *values)
{
  sparse *s = factor;
  int *start = pattern->start, *row = pattern->row;
  double *entries = (double *)(uintptr_t)values; /* KLU's interface lacks const; it only reads */
  if (s->numeric != NULL && klu_refactor(start, row, entries, s->symbolic, s->numeric, &s->common) && well_conditioned(s)) return DVI_OK;
  klu_free_numeric(&s->numeric, &s->common);
  s->numeric = klu_factor(start, row, entries, s->symbolic, &s->common);
  if (s->numeric != NULL && well_conditioned(s)) return DVI_OK;
  if (s->common.status == KLU_OUT_OF_MEMORY) return dvi__fail(DVI_NO_MEMORY, "KLU: no memory to factor %d columns", pattern->columns);
  klu_free_numeric(&s->numeric, &s->common);
  return dvi__fail(DVI_SINGULAR, "KLU: the %d x %d matrix is singular to working precision (column %d)", pattern->rows, pattern->columns,
                   (int)s->common.singular_col);
}

static void solve(void *factor, const dvi__pattern *pattern, double *b)
{
  sparse *s = factor;
  klu_solve(s->symbolic, s->numeric, pattern->rows, 1, b, &s->common);
}

const dvi__factor_operations dvi__sparse_factor = {create, refactor, solve, destroy};
