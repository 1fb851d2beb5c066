#include "num/linear.h"

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"

/* Measured on the stage systems of chains (tests/num/bench in docs/theory.md): below this many unknowns LAPACK's dense LU is at least as fast as KLU
 * even for banded matrices, above it only nearly full ones are better off dense. */
enum { ALWAYS_DENSE = 24, NEVER_DENSE = 2000 };

struct dvi__linear {
  const dvi__factor_operations *operations;
  const dvi__pattern *pattern;
  dvi_counters *counters;
  void *factor;
};

static int dense_is_better(const dvi__pattern *pattern)
{
  const double n = pattern->columns, entries = dvi__pattern_entries(pattern);
  if (pattern->columns <= ALWAYS_DENSE) return 1;
  return pattern->columns <= NEVER_DENSE && entries > 0.3 * n * n;
}

dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind, dvi_counters *counters, dvi__linear **linear)
{
  *linear = NULL;
  dvi__linear *made = DVI_NEW(dvi__linear, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "linear solver: no memory");
  const int dense = kind == DVI__LINEAR_DENSE || (kind == DVI__LINEAR_AUTO && dense_is_better(pattern));
  *made = (dvi__linear){dense ? &dvi__dense_factor : &dvi__sparse_factor, pattern, counters, NULL};
  const dvi_status status = made->operations->create(pattern, &made->factor);
  if (status != DVI_OK) {
    dvi__release(made);
    return status;
  }
  if (counters != NULL && !dense) counters->symbolic++;
  *linear = made;
  return DVI_OK;
}

void dvi__linear_destroy(dvi__linear **linear)
{
  if (*linear == NULL) return;
  (*linear)->operations->destroy((*linear)->factor);
  dvi__release(*linear);
  *linear = NULL;
}

dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear)
{
  return linear->operations == &dvi__dense_factor ? DVI__LINEAR_DENSE : DVI__LINEAR_SPARSE;
}

dvi_status dvi__linear_factor(dvi__linear *linear, const double *values)
{
  if (linear->counters != NULL) linear->counters->factorizations++;
  return linear->operations->refactor(linear->factor, linear->pattern, values);
}

void dvi__linear_solve(dvi__linear *linear, double *b)
{
  if (linear->counters != NULL) linear->counters->solves++;
  linear->operations->solve(linear->factor, linear->pattern, b);
}
