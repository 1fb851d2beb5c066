#include "field/algebra/csr.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

dvi_status dvi__csr_allocate(int64_t rows, int64_t columns, int64_t entries, dvi__csr *matrix)
{
  *matrix = (dvi__csr){.rows = rows,
                       .columns = columns,
                       .start = DVI_NEW(int64_t, rows + 1),
                       .column = DVI_NEW(int, entries),
                       .value = DVI_NEW(double, entries)};
  if (matrix->start != NULL && matrix->column != NULL && matrix->value != NULL) return DVI_OK;
  dvi__csr_clear(matrix);
  return dvi__fail(DVI_NO_MEMORY, "matrix: no memory for %lld entries", (long long)entries);
}

void dvi__csr_clear(dvi__csr *matrix)
{
  dvi__release(matrix->start);
  dvi__release(matrix->column);
  dvi__release(matrix->value);
  *matrix = (dvi__csr){0};
}

dvi_matrix dvi__csr_view(const dvi__csr *matrix, int symmetric)
{
  return (dvi_matrix){.rows = matrix->rows,
                      .columns = matrix->columns,
                      .symmetric = symmetric,
                      .start = matrix->start,
                      .column = matrix->column,
                      .value = matrix->value};
}

dvi_status dvi__csr_give(dvi__csr *matrix, int symmetric, dvi_matrix **given)
{
  *given = DVI_NEW(dvi_matrix, 1);
  if (*given == NULL) {
    dvi__csr_clear(matrix);
    return dvi__fail(DVI_NO_MEMORY, "matrix: no memory");
  }
  **given = dvi__csr_view(matrix, symmetric);
  *matrix = (dvi__csr){0};
  return DVI_OK;
}

void dvi_matrix_destroy(dvi_matrix **matrix)
{
  if (matrix == NULL || *matrix == NULL) return;
  dvi__release((void *)(*matrix)->start);
  dvi__release((void *)(*matrix)->column);
  dvi__release((void *)(*matrix)->value);
  dvi__release(*matrix);
  *matrix = NULL;
}

/* ---- copies ---- */

static dvi_status transpose_of(const dvi_matrix *A, dvi__csr *transpose)
{
  DVI_TRY(dvi__csr_allocate(A->columns, A->rows, dvi_matrix_entries(A), transpose));
  int64_t *start = transpose->start;
  for (int64_t i = 0; i < A->rows; i++)
    for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++)
      start[dvi__entry_column(A, i, e) + 1]++;
  for (int64_t j = 0; j < A->columns; j++) start[j + 1] += start[j];
  for (int64_t i = 0; i < A->rows; i++)
    for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++) {
      const int64_t at = start[dvi__entry_column(A, i, e)]++;
      transpose->column[at] = (int)i;
      transpose->value[at] = dvi__entry_value(A, e);
    }
  for (int64_t j = A->columns; j > 0; j--) start[j] = start[j - 1];
  start[0] = 0;
  return DVI_OK;
}

/* Two transpositions sort the columns. */
dvi_status dvi__csr_copy(const dvi_matrix *A, dvi__csr *copy)
{
  dvi__csr transpose;
  DVI_TRY(transpose_of(A, &transpose));
  const dvi_matrix view = dvi__csr_view(&transpose, 0);
  const dvi_status status = transpose_of(&view, copy);
  dvi__csr_clear(&transpose);
  return status;
}

dvi_status dvi__csr_select(const dvi_matrix *A, const dvi__selection *selection, dvi__csr *part)
{
  int64_t entries = 0;
  for (int pass = 0; pass < 2; pass++) {
    if (pass == 1) DVI_TRY(dvi__csr_allocate(selection->rows, selection->columns, entries, part));
    entries = 0;
    for (int64_t i = 0; i < A->rows; i++) {
      if (selection->row[i] < 0) continue;
      for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++) {
        const int column = selection->column[dvi__entry_column(A, i, e)];
        if (column < 0) continue;
        if (pass == 1) part->column[entries] = column;
        if (pass == 1) part->value[entries] = dvi__entry_value(A, e);
        entries++;
      }
      if (pass == 1) part->start[selection->row[i] + 1] = entries;
    }
  }
  return DVI_OK;
}

double dvi__largest_entry(const dvi_matrix *matrix)
{
  double most = 0;
  const int64_t entries = dvi_matrix_entries(matrix);
  for (int64_t e = 0; e < entries; e++) most = fmax(most, fabs(dvi__entry_value(matrix, e)));
  return most;
}

void dvi__csr_drop_zeros(dvi__csr *matrix)
{
  int64_t kept = 0, first = 0;
  for (int64_t i = 0; i < matrix->rows; i++) {
    const int64_t end = matrix->start[i + 1];
    for (int64_t e = first; e < end; e++)
      if (matrix->value[e] != 0 || matrix->column[e] == i) {
        matrix->column[kept] = matrix->column[e];
        matrix->value[kept++] = matrix->value[e];
      }
    first = end;
    matrix->start[i + 1] = kept;
  }
}

int64_t dvi__csr_find(const dvi__csr *matrix, int64_t row, int column)
{
  int64_t low = matrix->start[row], high = matrix->start[row + 1];
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (matrix->column[middle] < column)
      low = middle + 1;
    else
      high = middle;
  }
  return low < matrix->start[row + 1] && matrix->column[low] == column ? low : -1;
}

/* ---- sums and products ---- */

/* Row i of a matrix that is being made, with columns in the order of their first appearance. */
typedef struct growing_row {
  int64_t *seen; /* [columns] the place of a column, if it is `first` or beyond */
  int64_t first, end;
  dvi__csr *matrix; /* NULL to count entries alone */
} growing_row;

static void add_entry(growing_row *row, int column, double value)
{
  const int is_new = row->seen[column] < row->first;
  if (is_new) row->seen[column] = row->end++;
  if (row->matrix == NULL) return;
  const int64_t at = row->seen[column];
  if (is_new) row->matrix->column[at] = column;
  row->matrix->value[at] = (is_new ? 0 : row->matrix->value[at]) + value;
}

/* Add row i of a matrix, `factor` times. */
static void add_row(growing_row *row, const dvi_matrix *A, int64_t i, double factor)
{
  for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++)
    add_entry(row, dvi__entry_column(A, i, e), factor * dvi__entry_value(A, e));
}

/* A rule that adds all of row i of a result. */
typedef void row_rule(growing_row *row, const dvi_matrix *A, const dvi_matrix *B, int64_t i);

static void sum_row(growing_row *row, const dvi_matrix *A, const dvi_matrix *B, int64_t i)
{
  add_row(row, A, i, 1);
  add_row(row, B, i, 1);
}

/* Source: Gustavson 1978. */
static void product_row(growing_row *row, const dvi_matrix *A, const dvi_matrix *B, int64_t i)
{
  for (int64_t e = dvi__first_entry(A, i); e < dvi__first_entry(A, i + 1); e++)
    add_row(row, B, dvi__entry_column(A, i, e), dvi__entry_value(A, e));
}

static int64_t run_rule(row_rule *rule, const dvi_matrix *A, const dvi_matrix *B, int64_t *seen,
                        dvi__csr *matrix)
{
  growing_row row = {.seen = seen, .matrix = matrix};
  for (int64_t j = 0; j < B->columns; j++) seen[j] = -1;
  for (int64_t i = 0; i < A->rows; i++) {
    rule(&row, A, B, i);
    if (matrix != NULL) matrix->start[i + 1] = row.end;
    row.first = row.end;
  }
  return row.end;
}

static dvi_status combine(row_rule *rule, const dvi_matrix *A, const dvi_matrix *B,
                          dvi__csr *result)
{
  dvi__csr unsorted;
  int64_t *seen = DVI_NEW(int64_t, B->columns);
  if (seen == NULL) return dvi__fail(DVI_NO_MEMORY, "matrix: no memory for a product");
  dvi_status status = dvi__csr_allocate(A->rows, B->columns, run_rule(rule, A, B, seen, NULL),
                                        &unsorted);
  if (status == DVI_OK) {
    (void)run_rule(rule, A, B, seen, &unsorted);
    const dvi_matrix view = dvi__csr_view(&unsorted, 0);
    status = dvi__csr_copy(&view, result);
    dvi__csr_clear(&unsorted);
  }
  dvi__release(seen);
  return status;
}

dvi_status dvi__csr_sum(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *sum)
{
  return combine(sum_row, A, B, sum);
}

dvi_status dvi__csr_product(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *product)
{
  return combine(product_row, A, B, product);
}

dvi_status dvi__csr_transposed_product(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *product)
{
  dvi__csr transpose = {0};
  DVI_TRY(transpose_of(A, &transpose));
  const dvi_matrix view = dvi__csr_view(&transpose, 0);
  const dvi_status status = dvi__csr_product(&view, B, product);
  dvi__csr_clear(&transpose);
  return status;
}

dvi_status dvi__csr_square(const dvi_matrix *A, const dvi_matrix *M, dvi__csr *square)
{
  dvi__csr product = {0};
  DVI_TRY(dvi__csr_product(M, A, &product));
  const dvi_matrix view = dvi__csr_view(&product, 0);
  const dvi_status status = dvi__csr_transposed_product(A, &view, square);
  dvi__csr_clear(&product);
  return status;
}
