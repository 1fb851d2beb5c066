/* Sparse matrices by rows. */
#include <dvi/matrix.h>
#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/csr.h"

int64_t dvi_matrix_entries(const dvi_matrix *matrix)
{
  return matrix != NULL ? dvi__first_entry(matrix, matrix->rows) : 0;
}

static void multiply_diagonal(const dvi_matrix *m, const double *x, double *y)
{
  for (int64_t i = 0; i < m->rows; i++) y[i] = dvi__entry_value(m, i) * x[i];
}

static void multiply(const dvi_matrix *m, const double *x, double *y)
{
  for (int64_t i = 0; i < m->rows; i++) {
    const int64_t end = dvi__first_entry(m, i + 1);
    double sum = 0;
    for (int64_t e = dvi__first_entry(m, i); e < end; e++)
      sum += dvi__entry_value(m, e) * x[m->column[e]];
    y[i] = sum;
  }
}

static void multiply_transposed(const dvi_matrix *m, const double *x, double *y)
{
  memset(y, 0, (size_t)m->columns * sizeof *y);
  for (int64_t i = 0; i < m->rows; i++) {
    const int64_t end = dvi__first_entry(m, i + 1);
    for (int64_t e = dvi__first_entry(m, i); e < end; e++)
      y[m->column[e]] += dvi__entry_value(m, e) * x[i];
  }
}

void dvi_matrix_multiply(const dvi_matrix *matrix, int transposed, const double *x, double *y)
{
  if (matrix->column == NULL)
    multiply_diagonal(matrix, x, y);
  else if (transposed && !matrix->symmetric)
    multiply_transposed(matrix, x, y);
  else
    multiply(matrix, x, y);
}

/* ---- copies ---- */

/* Write a number to an array of int or of int64_t. */
static void put(void *array, int wide, int64_t at, int64_t number)
{
  if (wide)
    ((int64_t *)array)[at] = number;
  else
    ((int *)array)[at] = (int)number;
}

/* Enter the rows in their order into the columns, whose next places are `next`. */
static void fill_columns(const dvi_matrix *m, const dvi_matrix_arrays *a, int64_t *next)
{
  for (int64_t i = 0; i < m->rows; i++)
    for (int64_t e = dvi__first_entry(m, i); e < dvi__first_entry(m, i + 1); e++) {
      const int64_t at = next[dvi__entry_column(m, i, e)]++;
      put(a->index, a->wide, at, i);
      a->value[at] = dvi__entry_value(m, e);
    }
}

static void count_columns(const dvi_matrix *m, int64_t *next)
{
  const int64_t entries = dvi_matrix_entries(m);
  for (int64_t e = 0; e < entries; e++) next[m->column != NULL ? m->column[e] + 1 : e + 1]++;
  for (int64_t j = 0; j < m->columns; j++) next[j + 1] += next[j];
}

static dvi_status copy_by_columns(const dvi_matrix *m, const dvi_matrix_arrays *a)
{
  int64_t *next = DVI_NEW(int64_t, m->columns + 1);
  if (next == NULL) return dvi__fail(DVI_NO_MEMORY, "matrix: no memory for a transposition");
  count_columns(m, next);
  for (int64_t j = 0; j <= m->columns; j++) put(a->start, a->wide, j, next[j]);
  fill_columns(m, a, next);
  dvi__release(next);
  return DVI_OK;
}

/* Enter one entry of a row, whose entries before it are in ascending order. */
static void insert(const dvi_matrix_arrays *a, int64_t first, int64_t at, int column, double value)
{
  for (; at > first; at--) {
    const int64_t before = a->wide ? ((int64_t *)a->index)[at - 1] : ((int *)a->index)[at - 1];
    if (before <= column) break;
    put(a->index, a->wide, at, before);
    a->value[at] = a->value[at - 1];
  }
  put(a->index, a->wide, at, column);
  a->value[at] = value;
}

static void copy_by_rows(const dvi_matrix *m, const dvi_matrix_arrays *a)
{
  for (int64_t i = 0; i <= m->rows; i++) put(a->start, a->wide, i, dvi__first_entry(m, i));
  for (int64_t i = 0; i < m->rows; i++)
    for (int64_t e = dvi__first_entry(m, i); e < dvi__first_entry(m, i + 1); e++)
      insert(a, dvi__first_entry(m, i), e, dvi__entry_column(m, i, e), dvi__entry_value(m, e));
}

dvi_status dvi_matrix_copy(const dvi_matrix *matrix, const dvi_matrix_arrays *arrays)
{
  if (matrix == NULL || arrays == NULL || arrays->start == NULL || arrays->index == NULL ||
      arrays->value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "matrix: the matrix and three arrays are needed");
  if (!arrays->wide && (dvi_matrix_entries(matrix) > INT_MAX || matrix->rows > INT_MAX))
    return dvi__fail(DVI_BAD_SIZE, "matrix: an int cannot count %lld entries: ask for wide arrays",
                     (long long)dvi_matrix_entries(matrix));
  if (arrays->by_columns) return copy_by_columns(matrix, arrays);
  copy_by_rows(matrix, arrays);
  return DVI_OK;
}
