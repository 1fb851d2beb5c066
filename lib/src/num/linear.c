#include "num/linear.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"
#include "num/finite.h"

/* Measured with Debian's reference LAPACK and KLU 5.12 on one x86-64 core, medians, one factorisation with one or five solves:
 * chains of dense blocks of 1 to 8 unknowns are faster in KLU at every size (1.5 to 6 times below 48 unknowns, 30 to 180 times
 * at 400), full matrices up to 32 unknowns too (LAPACK's condition estimate alone costs a microsecond). Full matrices meet at 48
 * and are 1.25 to 1.65 times faster in LAPACK from 64; half full ones meet between 64 and 96. Scattered entries would gain up to
 * 1.35 times at densities of 0.2 to 0.5 beyond 100 unknowns, but a band of that density, which KLU exploits, would lose more. */
enum { LEAST_DENSE = 64 };
#define LEAST_DENSITY 0.6

struct dvi__linear {
  const dvi__factor_operations *operations;
  int parts; /* numbers in an entry: 2 for complex ones */
  const dvi__pattern *pattern;
  dvi_counters *counters;
  void *factor;
  double *row_scale, *column_scale; /* [n], powers of two */
  double *scaled;                   /* [entries*parts], what is factored */
};

/* Up to here a dense factorisation costs at most about as much as a search for pivots by KLU. */
enum { MOST_EXCHANGED = 96 };

dvi__linear_kind dvi__linear_for_exchanges(const dvi__pattern *pattern)
{
  return pattern->columns <= MOST_EXCHANGED ? DVI__LINEAR_DENSE : DVI__LINEAR_AUTO;
}

static int dense_is_better(const dvi__pattern *pattern)
{
  const double n = pattern->columns;
  return pattern->columns >= LEAST_DENSE && dvi__pattern_entries(pattern) >= LEAST_DENSITY * n * n;
}

static dvi_status create_factor(dvi__linear *linear, const dvi__linear *like, int border)
{
  if (border > 0) return dvi__bordered_factor_create(linear->pattern, border, &linear->factor);
  return linear->operations->create(linear->pattern, like != NULL ? like->factor : NULL, &linear->factor);
}

static const dvi__factor_operations *operations_for(dvi__linear_kind kind, int border)
{
  if (border > 0) return &dvi__bordered_factor;
  return kind == DVI__LINEAR_COMPLEX ? &dvi__complex_factor : &dvi__sparse_factor;
}

static dvi_status fill(dvi__linear *linear, dvi__linear_kind kind, const dvi__linear *like, int border)
{
  const dvi__pattern *pattern = linear->pattern;
  const int dense = kind == DVI__LINEAR_DENSE || (kind == DVI__LINEAR_AUTO && dense_is_better(pattern));
  linear->operations = dense ? &dvi__dense_factor : operations_for(kind, border);
  linear->parts = kind == DVI__LINEAR_COMPLEX ? 2 : 1;
  linear->row_scale = DVI_NEW(double, pattern->rows);
  linear->column_scale = DVI_NEW(double, pattern->columns);
  linear->scaled = DVI_NEW(double, (size_t)linear->parts *(size_t)dvi__pattern_entries(pattern));
  if (linear->row_scale == NULL || linear->column_scale == NULL || linear->scaled == NULL)
    return dvi__fail(DVI_NO_MEMORY, "linear solver: no memory for %d entries", dvi__pattern_entries(pattern));
  DVI_TRY(create_factor(linear, like, border));
  if (linear->counters != NULL && !dense && like == NULL) linear->counters->symbolic++;
  return DVI_OK;
}

static dvi_status create(const dvi__pattern *pattern, dvi__linear_kind kind, const dvi__linear *like, int border,
                         dvi_counters *counters, dvi__linear **linear)
{
  *linear = NULL;
  if (pattern->columns < 1 || pattern->rows != pattern->columns)
    return dvi__fail(DVI_BAD_SIZE, "linear solver: the matrix is %d x %d; a square one is needed", pattern->rows, pattern->columns);
  dvi__linear *made = DVI_NEW(dvi__linear, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "linear solver: no memory");
  made->pattern = pattern;
  made->counters = counters;
  const dvi_status status = fill(made, kind, like, border);
  if (status != DVI_OK) dvi__linear_destroy(&made);
  *linear = made;
  return status;
}

dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind, dvi_counters *counters, dvi__linear **linear)
{
  return create(pattern, kind, NULL, 0, counters, linear);
}

dvi_status dvi__linear_create_bordered(const dvi__pattern *pattern, int border, dvi_counters *counters, dvi__linear **linear)
{
  return create(pattern, DVI__LINEAR_SPARSE, NULL, border, counters, linear);
}

dvi_status dvi__linear_create_like(const dvi__linear *like, dvi__linear_kind kind, dvi_counters *counters, dvi__linear **linear)
{
  return create(like->pattern, kind, like, 0, counters, linear);
}

void dvi__linear_destroy(dvi__linear **linear)
{
  if (*linear == NULL) return;
  (*linear)->operations->destroy((*linear)->factor);
  dvi__release((*linear)->row_scale);
  dvi__release((*linear)->column_scale);
  dvi__release((*linear)->scaled);
  dvi__release(*linear);
  *linear = NULL;
}

dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear)
{
  if (linear->parts == 2) return DVI__LINEAR_COMPLEX;
  return linear->operations == &dvi__dense_factor ? DVI__LINEAR_DENSE : DVI__LINEAR_SPARSE;
}

/* The power of two that brings each largest magnitude into [1,2); 1 where there is none. */
static void invert_scales(int n, double *scale)
{
  for (int i = 0; i < n; i++) scale[i] = scale[i] > 0 ? ldexp(1.0, ilogb(scale[i]) < -1023 ? 1023 : -ilogb(scale[i])) : 1.0;
}

static double larger(double a, double b)
{
  return a > b ? a : b;
}

static double magnitude(int parts, const double *entry)
{
  return parts == 1 ? fabs(entry[0]) : larger(fabs(entry[0]), fabs(entry[1]));
}

static void scale_entry(int parts, double scale, double *entry)
{
  entry[0] *= scale;
  if (parts == 2) entry[1] *= scale;
}

/* Rows of a stage system differ by the ratio of the masses, columns by the units of coordinates and momenta; neither says anything
 * about its condition. Powers of two round nothing. */
static void equilibrate(dvi__linear *linear, const double *values)
{
  const dvi__pattern *pattern = linear->pattern;
  const int n = pattern->columns, parts = linear->parts, *row = pattern->row;
  double *rows = linear->row_scale, *columns = linear->column_scale, *scaled = linear->scaled;
  memset(rows, 0, (size_t)n * sizeof(double));
  for (ptrdiff_t e = 0; e < pattern->start[n]; e++) rows[row[e]] = larger(rows[row[e]], magnitude(parts, values + parts * e));
  invert_scales(n, rows);
  memcpy(scaled, values, (size_t)parts * (size_t)pattern->start[n] * sizeof(double));
  for (int j = 0; j < n; j++) {
    columns[j] = 0;
    for (ptrdiff_t e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      scale_entry(parts, rows[row[e]], scaled + parts * e);
      columns[j] = larger(columns[j], magnitude(parts, scaled + parts * e));
    }
  }
  invert_scales(n, columns);
  for (int j = 0; j < n; j++)
    for (ptrdiff_t e = pattern->start[j]; e < pattern->start[j + 1]; e++) scale_entry(parts, columns[j], scaled + parts * e);
}

dvi_status dvi__linear_factor(dvi__linear *linear, const double *values)
{
  const ptrdiff_t bad = dvi__first_not_finite((size_t)linear->parts * (size_t)dvi__pattern_entries(linear->pattern), values);
  if (bad >= 0) return dvi__fail(DVI_NOT_FINITE, "linear solver: the matrix holds %g (entry %td)", values[bad], bad);
  if (linear->counters != NULL) linear->counters->factorizations++;
  equilibrate(linear, values);
  return linear->operations->refactor(linear->factor, linear->pattern, linear->scaled);
}

/* The scales are positive. */
int dvi__linear_sign(const dvi__linear *linear)
{
  return linear->operations->sign(linear->factor, linear->pattern);
}

int dvi__linear_is_definite(const dvi__linear *linear, int sign)
{
  return linear->operations->is_definite != NULL && linear->operations->is_definite(linear->factor, linear->pattern, sign);
}

static void scale(int n, int parts, const double *by, double *b)
{
  for (int i = 0; i < n; i++) scale_entry(parts, by[i], b + (ptrdiff_t)parts * i);
}

void dvi__linear_solve(dvi__linear *linear, double *b)
{
  const int n = linear->pattern->columns;
  if (linear->counters != NULL) linear->counters->solves++;
  scale(n, linear->parts, linear->row_scale, b);
  linear->operations->solve(linear->factor, linear->pattern, b);
  scale(n, linear->parts, linear->column_scale, b);
}
