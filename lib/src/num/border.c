/* Sparse LU of a matrix whose last rows and columns, its border, are full. KLU may take a full row
 * for an early pivot, and all later columns fill in. So the border is stretched (Grcar 1990). Row r
 * is cut into pieces that hand on a sum, r_p x + y_(p-1) - y_p = 0, and column c into copies of its
 * unknown, c_p = c_(p+1), each for LENGTH unknowns of the core. The stretched matrix is sparse all
 * over, and work and memory are in proportion to its size. */
#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"

enum { LENGTH = 64 };

typedef struct bordered {
  int core, border, pieces;
  /* pattern of the stretched matrix, in the order core, last pieces, and the sum and the copy of
   * each earlier piece of each row and column */
  dvi__pattern pattern;
  int *where; /* index of each entry of the matrix */
  double *values, *b;
  void *factor;
} bordered;

/* Give the row and unknown of the sum (0) or the copy (1) at piece p of border c. */
static int stretched_index(const bordered *s, int p, int c, int copy)
{
  return s->core + c + (p == s->pieces - 1 ? 0 : s->border + 2 * p * s->border + c + copy);
}

/* Find the place of entry (row, column) in the stretched matrix. */
static void stretched_place(const bordered *s, int *row, int *column)
{
  const int i = *row, j = *column;
  if (i >= s->core && j < s->core) *row = stretched_index(s, j / LENGTH, i - s->core, 0);
  if (j >= s->core && i < s->core) *column = stretched_index(s, i / LENGTH, j - s->core, 1);
}

/* Put an entry at the next free place of a column and move its end on. */
static int stretched_put(const bordered *s, int row, int column, double value)
{
  const int at = s->pattern.start[column]++;
  s->pattern.row[at] = row;
  s->values[at] = value;
  return at;
}

/* Call `entry` for the entries that bind the pieces together. */
typedef void bordered_link(bordered *s, int row, int column, double value);

static void each_link(bordered *s, bordered_link *entry)
{
  for (int p = 0; p + 1 < s->pieces; p++)
    for (int c = 0; c < s->border; c++) {
      const int sum = stretched_index(s, p, c, 0), copy = stretched_index(s, p, c, 1);
      entry(s, sum, sum, -1);
      entry(s, stretched_index(s, p + 1, c, 0), sum, 1);
      entry(s, copy, copy, 1);
      entry(s, copy, stretched_index(s, p + 1, c, 1), -1);
    }
}

static void count_link(bordered *s, int row, int column, double value)
{
  (void)row, (void)value;
  s->pattern.start[column + 1]++;
}

static void put_link(bordered *s, int row, int column, double value)
{
  (void)stretched_put(s, row, column, value);
}

static void bordered_stretch(bordered *s, const dvi__pattern *pattern)
{
  int *start = s->pattern.start;
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      int row = pattern->row[e], column = j;
      stretched_place(s, &row, &column);
      start[column + 1]++;
    }
  each_link(s, count_link);
  for (int j = 0; j < s->pattern.columns; j++) start[j + 1] += start[j];
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      int row = pattern->row[e], column = j;
      stretched_place(s, &row, &column);
      s->where[e] = stretched_put(s, row, column, 0);
    }
  each_link(s, put_link);
  memmove(start + 1, start, (size_t)s->pattern.columns * sizeof *start);
  start[0] = 0;
}

static void bordered_destroy(void *factor)
{
  bordered *s = factor;
  if (s == NULL) return;
  dvi__sparse_factor.destroy(s->factor);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->where);
  dvi__release(s->values);
  dvi__release(s->b);
  dvi__release(s);
}

static dvi_status bordered_fill(bordered *s, const dvi__pattern *pattern)
{
  const size_t extra = 2 * ((size_t)s->pieces - 1) * (size_t)s->border;
  const size_t all = (size_t)pattern->columns + extra;
  const size_t entries = (size_t)dvi__pattern_entries(pattern) + 2 * extra;
  if (entries > INT_MAX)
    return dvi__fail(
        DVI_BAD_SIZE,
        "linear solver: a border of %d leads to %zu entries, more than an int can count", s->border,
        entries);
  const int size = (int)all;
  s->pattern = (dvi__pattern){size, size, DVI_NEW(int, (size_t)size + 1), DVI_NEW(int, entries)};
  s->where = DVI_NEW(int, dvi__pattern_entries(pattern));
  s->values = DVI_NEW(double, entries);
  s->b = DVI_NEW(double, size);
  if (!s->pattern.start || !s->pattern.row || !s->where || !s->values || !s->b)
    return dvi__fail(DVI_NO_MEMORY, "KLU: no memory for %d columns with a border of %d",
                     pattern->columns, s->border);
  bordered_stretch(s, pattern);
  return dvi__sparse_factor.create(&(dvi__factor_form){.pattern = &s->pattern}, &s->factor);
}

static dvi_status bordered_create(const dvi__factor_form *form, void **factor)
{
  bordered *s = *factor = DVI_NEW(bordered, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "KLU: no memory");
  s->core = form->pattern->columns - form->border;
  s->border = form->border;
  s->pieces = (s->core + LENGTH - 1) / LENGTH;
  const dvi_status status = bordered_fill(s, form->pattern);
  if (status == DVI_OK) return DVI_OK;
  bordered_destroy(s);
  *factor = NULL;
  return status;
}

static dvi_status bordered_refactor(void *factor, const dvi__pattern *pattern, const double *values)
{
  bordered *s = factor;
  for (int e = 0; e < dvi__pattern_entries(pattern); e++) s->values[s->where[e]] = values[e];
  return dvi__sparse_factor.refactor(s->factor, &s->pattern, s->values);
}

static dvi_status bordered_solve(void *factor, const dvi__pattern *pattern, double *b)
{
  bordered *s = factor;
  const size_t size = (size_t)pattern->columns, all = (size_t)s->pattern.columns;
  memcpy(s->b, b, size * sizeof *b);
  memset(s->b + size, 0, (all - size) * sizeof *b);
  dvi__sparse_factor.solve(s->factor, &s->pattern, s->b);
  memcpy(b, s->b, size * sizeof *b);
  return DVI_OK;
}

static dvi__linear_cost bordered_cost(const void *factor, const dvi__pattern *pattern)
{
  const bordered *s = factor;
  (void)pattern;
  return dvi__sparse_factor.cost(s->factor, &s->pattern);
}

const dvi__factor_kind dvi__bordered_factor = {.name = "sparse LU with a border (KLU)",
                                               .create = bordered_create,
                                               .destroy = bordered_destroy,
                                               .refactor = bordered_refactor,
                                               .solve = bordered_solve,
                                               .cost = bordered_cost};
