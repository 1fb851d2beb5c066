#include "num/linear.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"
#include "num/finite.h"
#include "num/simd/wide.h"

/* Sizes at which the kinds are equally fast, measured with Debian's reference LAPACK and KLU 5.12
 * on one x86-64 core, medians, one factorisation with one or five solves.
 *
 * Chains of dense blocks of 1 to 8 unknowns are faster in KLU at every size (1.5 to 6 times below
 * 48 unknowns, 30 to 180 times at 400), full matrices up to 32 unknowns too (LAPACK's condition
 * estimate alone costs a microsecond). Full matrices are equal at 48 and are 1.25 to 1.65 times
 * faster in LAPACK from 64. Half full ones are equal between 64 and 96. Scattered entries would
 * gain up to 1.35 times at densities of 0.2 to 0.5 beyond 100 unknowns, but a band of that density,
 * which KLU exploits, would lose more.
 *
 * By the library's own loops (num/simd/small_lu.h) full matrices are 1.5 times faster than in KLU
 * from 8 unknowns, 2 to 5 times from 12 to 64. They do not tell which matrices are definite, as KLU
 * does, so the least size stays. */
enum { LEAST_DENSE = 64 };
#define LEAST_DENSITY 0.6

/* Largest size at which a dense factorisation costs about as much as a search for pivots by KLU. */
enum { MOST_EXCHANGED = 96 };

struct dvi__linear {
  const dvi__factor_kind *kind;
  dvi__factor_form form;
  dvi__operator A;   /* operator of form */
  dvi__linear *like; /* solver whose analysis serves this one, too */
  int parts;         /* numbers in an entry, 2 for complex ones */
  dvi_counters *counters;
  void *factor;                     /* NULL before the pattern is analysed */
  double *row_scale, *column_scale; /* [n] powers of two, NULL before the first factor */
  double *scaled;                   /* [entries*parts] scaled matrix, which is factored */
};

/* ---- create ---- */

dvi__linear_kind dvi__linear_for_exchanges(int columns)
{
  return columns <= MOST_EXCHANGED ? DVI__LINEAR_DENSE : DVI__LINEAR_AUTO;
}

static int dense_is_better(const dvi__pattern *pattern)
{
  const double n = pattern->columns;
  return pattern->columns >= LEAST_DENSE && dvi__pattern_entries(pattern) >= LEAST_DENSITY * n * n;
}

static const dvi__factor_kind *factor_kind_for(const dvi__pattern *pattern, dvi__linear_kind kind)
{
  if (kind == DVI__LINEAR_COMPLEX) return &dvi__complex_factor;
  if (kind == DVI__LINEAR_DEFINITE) return &dvi__definite_factor;
  const int dense = kind == DVI__LINEAR_DENSE ||
                    (kind == DVI__LINEAR_AUTO && dense_is_better(pattern));
  return dense ? &dvi__dense_factor : &dvi__sparse_factor;
}

static dvi_status linear_create(const dvi__linear *given, dvi__linear **linear)
{
  dvi__linear *made = *linear = DVI_NEW(dvi__linear, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "linear solver: no memory");
  *made = *given;
  if (made->form.A != NULL) made->form.A = &made->A;
  return DVI_OK;
}

static dvi_status linear_check_square(const dvi__pattern *pattern)
{
  if (pattern->columns >= 1 && pattern->rows == pattern->columns) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "linear solver: the matrix is %d x %d; a square one is needed",
                   pattern->rows, pattern->columns);
}

dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind,
                              dvi_counters *counters, dvi__linear **linear)
{
  *linear = NULL;
  DVI_TRY(linear_check_square(pattern));
  return linear_create(&(dvi__linear){.kind = factor_kind_for(pattern, kind),
                                      .form.pattern = pattern,
                                      .parts = kind == DVI__LINEAR_COMPLEX ? 2 : 1,
                                      .counters = counters},
                       linear);
}

dvi_status dvi__linear_create_bordered(const dvi__pattern *pattern, int border,
                                       dvi_counters *counters, dvi__linear **linear)
{
  *linear = NULL;
  DVI_TRY(linear_check_square(pattern));
  return linear_create(&(dvi__linear){.kind = &dvi__bordered_factor,
                                      .form = {.pattern = pattern, .border = border},
                                      .parts = 1,
                                      .counters = counters},
                       linear);
}

dvi_status dvi__linear_create_like(dvi__linear *like, dvi__linear_kind kind, dvi_counters *counters,
                                   dvi__linear **linear)
{
  DVI_TRY(dvi__linear_create(like->form.pattern, kind, counters, linear));
  (*linear)->like = like;
  return DVI_OK;
}

dvi_status dvi__linear_create_iterative(const dvi__operator *A, dvi_counters *counters,
                                        dvi__linear **linear)
{
  return linear_create(
      &(dvi__linear){
          .kind = &dvi__iterative_factor, .form.A = A, .A = *A, .parts = 1, .counters = counters},
      linear);
}

void dvi__linear_destroy(dvi__linear **linear)
{
  if (*linear == NULL) return;
  (*linear)->kind->destroy((*linear)->factor);
  dvi__release((*linear)->row_scale);
  dvi__release((*linear)->column_scale);
  dvi__release((*linear)->scaled);
  dvi__release(*linear);
  *linear = NULL;
}

/* ---- properties ---- */

dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear)
{
  if (linear->parts == 2) return DVI__LINEAR_COMPLEX;
  if (linear->kind == &dvi__iterative_factor) return DVI__LINEAR_ITERATIVE;
  if (linear->kind == &dvi__definite_factor) return DVI__LINEAR_DEFINITE;
  return linear->kind == &dvi__dense_factor ? DVI__LINEAR_DENSE : DVI__LINEAR_SPARSE;
}

const char *dvi__linear_name(const dvi__linear *linear)
{
  return linear->kind->name;
}

dvi__linear_cost dvi__linear_cost_of(const dvi__linear *linear)
{
  if (linear->factor == NULL || linear->kind->cost == NULL) return (dvi__linear_cost){0};
  return linear->kind->cost(linear->factor, linear->form.pattern);
}

/* ---- prepare for the first use ---- */

dvi_status dvi__linear_analyse(dvi__linear *linear)
{
  if (linear->factor != NULL) return DVI_OK;
  if (linear->like != NULL) {
    DVI_TRY(dvi__linear_analyse(linear->like));
    linear->form.like = linear->like->factor;
  }
  DVI_TRY(linear->kind->create(&linear->form, &linear->factor));
  const int is_sparse = linear->kind != &dvi__dense_factor && linear->form.pattern != NULL;
  if (linear->counters != NULL && is_sparse && linear->like == NULL) linear->counters->symbolic++;
  return DVI_OK;
}

static dvi_status linear_allocate_scales(dvi__linear *linear)
{
  const dvi__pattern *pattern = linear->form.pattern;
  const size_t entries = (size_t)linear->parts * (size_t)dvi__pattern_entries(pattern);
  if (linear->scaled != NULL) return DVI_OK;
  if (linear->row_scale == NULL) linear->row_scale = DVI_NEW(double, pattern->rows);
  if (linear->column_scale == NULL) linear->column_scale = DVI_NEW(double, pattern->columns);
  linear->scaled = DVI_NEW(double, entries);
  if (linear->row_scale != NULL && linear->column_scale != NULL && linear->scaled != NULL)
    return DVI_OK;
  dvi__release(linear->scaled);
  linear->scaled = NULL;
  return dvi__fail(DVI_NO_MEMORY, "linear solver: no memory for %zu entries", entries);
}

static int has_scales(const dvi__linear *linear)
{
  return linear->form.pattern != NULL && !linear->kind->scale_free;
}

/* Prepare, and count the preparation, because it allocates memory. The next call completes what a
 * failure has left. */
static dvi_status linear_prepare(dvi__linear *linear)
{
  const int is_scaled = has_scales(linear);
  if (linear->factor != NULL && (!is_scaled || linear->scaled != NULL)) return DVI_OK;
  DVI_TRY(dvi__linear_analyse(linear));
  if (is_scaled) DVI_TRY(linear_allocate_scales(linear));
  if (linear->counters != NULL) linear->counters->preparations++;
  return DVI_OK;
}

/* ---- factor ---- */

/* Give the power of two that brings the magnitude into [1,2), as far as there is one, 1 for 0. The
 * exponents of normal numbers and of their inverses add up to EXPONENTS in their bits. */
static double invert_scale(double magnitude)
{
  const uint64_t EXPONENTS = 2046, mantissa = 52;
  uint64_t bits;
  memcpy(&bits, &magnitude, sizeof bits);
  bits >>= mantissa;
  if (bits == 0 || bits >= EXPONENTS)
    return magnitude > 0 ? ldexp(1.0, ilogb(magnitude) < -1023 ? 1023 : -ilogb(magnitude)) : 1.0;
  bits = (EXPONENTS - bits) << mantissa;
  memcpy(&magnitude, &bits, sizeof bits);
  return magnitude;
}

static void invert_scales(int n, double *scale)
{
  for (int i = 0; i < n; i++) scale[i] = invert_scale(scale[i]);
}

static inline double larger_of_two(double a, double b)
{
  return a > b ? a : b;
}

static inline double entry_magnitude(int parts, const double *entry)
{
  return parts == 1 ? fabs(entry[0]) : larger_of_two(fabs(entry[0]), fabs(entry[1]));
}

static inline void scale_entry(int parts, double scale, double *entry)
{
  entry[0] *= scale;
  if (parts == 2) entry[1] *= scale;
}

/* Rows of a stage system differ by the ratio of the masses, columns by the units of coordinates and
 * momenta. Neither affects the condition of the problem. Powers of two round nothing. */
static inline void linear_equilibrate(const dvi__linear *linear, const int parts,
                                      const double *values)
{
  const dvi__pattern *pattern = linear->form.pattern;
  const int n = pattern->columns, *row = pattern->row;
  double *rows = linear->row_scale, *columns = linear->column_scale, *scaled = linear->scaled;
  memset(rows, 0, (size_t)n * sizeof(double));
  for (ptrdiff_t e = 0; e < pattern->start[n]; e++)
    rows[row[e]] = larger_of_two(rows[row[e]], entry_magnitude(parts, values + parts * e));
  invert_scales(n, rows);
  memcpy(scaled, values, (size_t)parts * (size_t)pattern->start[n] * sizeof(double));
  for (int j = 0; j < n; j++) {
    double largest = 0;
    for (ptrdiff_t e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      scale_entry(parts, rows[row[e]], scaled + parts * e);
      largest = larger_of_two(largest, entry_magnitude(parts, scaled + parts * e));
    }
    columns[j] = invert_scale(largest);
    for (ptrdiff_t e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      scale_entry(parts, columns[j], scaled + parts * e);
  }
}

/* The same for a full matrix of real numbers, whose rows are lanes. */
WIDE static void equilibrate_full(int n, const double *restrict values, double *restrict rows,
                                  double *restrict columns, double *restrict scaled)
{
  enum { LANES = 4 };
  for (int i = 0; i < n; i++) rows[i] = 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) rows[i] = larger_of_two(rows[i], fabs(values[j * n + i]));
  invert_scales(n, rows);
  for (int j = 0; j < n; j++, values += n, scaled += n) {
    double most[LANES] = {0};
    int i = 0;
    for (int k = 0; k < n; k++) scaled[k] = values[k] * rows[k];
    for (; i + LANES <= n; i += LANES)
      for (int k = 0; k < LANES; k++) most[k] = larger_of_two(most[k], fabs(scaled[i + k]));
    for (; i < n; i++) most[0] = larger_of_two(most[0], fabs(scaled[i]));
    columns[j] = invert_scale(
        larger_of_two(larger_of_two(most[0], most[1]), larger_of_two(most[2], most[3])));
    for (int k = 0; k < n; k++) scaled[k] *= columns[j];
  }
}

static int is_full(const dvi__pattern *pattern)
{
  return pattern->start[pattern->columns] == (int64_t)pattern->columns * pattern->columns;
}

static dvi_status linear_check_finite(const dvi__linear *linear, const double *values)
{
  const size_t entries = (size_t)dvi__pattern_entries(linear->form.pattern);
  const ptrdiff_t bad = dvi__first_not_finite((size_t)linear->parts * entries, values);
  if (bad < 0) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "linear solver: the matrix holds %g (entry %td)", values[bad],
                   bad);
}

dvi_status dvi__linear_factor(dvi__linear *linear, const double *values)
{
  const int is_matrix = linear->form.pattern != NULL;
  if (is_matrix) DVI_TRY(linear_check_finite(linear, values));
  DVI_TRY(linear_prepare(linear));
  if (linear->counters != NULL && is_matrix) linear->counters->factorizations++;
  const double *factored = values;
  if (has_scales(linear)) {
    if (linear->parts == 2)
      linear_equilibrate(linear, 2, values);
    else if (is_full(linear->form.pattern))
      equilibrate_full(linear->form.pattern->columns, values, linear->row_scale,
                       linear->column_scale, linear->scaled);
    else
      linear_equilibrate(linear, 1, values);
    factored = linear->scaled;
  }
  return linear->kind->refactor(linear->factor, linear->form.pattern, factored);
}

/* The scales are positive and keep the sign. */
int dvi__linear_sign(const dvi__linear *linear)
{
  if (linear->kind->sign == NULL) return 0;
  return linear->kind->sign(linear->factor, linear->form.pattern);
}

/* The factor is that of the equilibrated matrix. */
double dvi__linear_log_determinant(const dvi__linear *linear)
{
  double sum = linear->kind->log_determinant(linear->factor, linear->form.pattern);
  for (int i = 0; i < linear->form.pattern->columns && has_scales(linear); i++)
    sum -= log(linear->row_scale[i]) + log(linear->column_scale[i]);
  return sum;
}

double dvi__linear_condition(const dvi__linear *linear)
{
  return linear->kind->condition != NULL ? linear->kind->condition(linear->factor) : 1;
}

int dvi__linear_is_definite(const dvi__linear *linear, int sign)
{
  return linear->kind->is_definite != NULL &&
         linear->kind->is_definite(linear->factor, linear->form.pattern, sign);
}

int dvi__linear_tells_definite(const dvi__linear *linear)
{
  if (linear->form.A != NULL) return linear->form.A->is_definite != NULL;
  return linear->kind->is_definite != NULL;
}

static dvi_status create_and_factor(const dvi__pattern *pattern, dvi__linear_kind kind,
                                    const double *values, dvi_counters *counters,
                                    dvi__linear **linear)
{
  DVI_TRY(dvi__linear_create(pattern, kind, counters, linear));
  const dvi_status status = dvi__linear_factor(*linear, values);
  if (status != DVI_OK) dvi__linear_destroy(linear);
  return status;
}

static int has_positive_diagonal(const dvi__pattern *pattern, const double *values)
{
  for (int j = 0; j < pattern->columns; j++) {
    const int e = dvi__pattern_find(pattern, j, j);
    if (e < 0 || !(values[e] > 0)) return 0;
  }
  return 1;
}

dvi_status dvi__linear_create_symmetric(const dvi__pattern *pattern, const double *values,
                                        dvi_counters *counters, dvi__linear **linear)
{
  *linear = NULL;
  DVI_TRY(linear_check_square(pattern));
  if (!dense_is_better(pattern) && has_positive_diagonal(pattern, values)) {
    const dvi_status status = create_and_factor(pattern, DVI__LINEAR_DEFINITE, values, counters,
                                                linear);
    if (status != DVI_SINGULAR) return status;
  }
  return create_and_factor(pattern, DVI__LINEAR_AUTO, values, counters, linear);
}

dvi_status dvi__linear_share(const dvi__linear *factored, dvi_counters *counters,
                             dvi__linear **linear)
{
  const dvi__pattern *pattern = factored->form.pattern;
  DVI_TRY(dvi__linear_create(pattern, DVI__LINEAR_DEFINITE, counters, linear));
  const dvi_status status = dvi__definite_share(factored->factor, pattern, &(*linear)->factor);
  if (status != DVI_OK) dvi__linear_destroy(linear);
  return status;
}

/* ---- solve ---- */

static void scale_vector(int n, int parts, const double *by, double *b)
{
  for (int i = 0; i < n; i++) scale_entry(parts, by[i], b + (ptrdiff_t)parts * i);
}

dvi_status dvi__linear_solve(dvi__linear *linear, double *b)
{
  const dvi__pattern *pattern = linear->form.pattern;
  const int is_scaled = has_scales(linear);
  if (linear->counters != NULL) linear->counters->solves++;
  if (is_scaled) scale_vector(pattern->columns, linear->parts, linear->row_scale, b);
  const dvi_status status = linear->kind->solve(linear->factor, pattern, b);
  if (is_scaled) scale_vector(pattern->columns, linear->parts, linear->column_scale, b);
  return status;
}
