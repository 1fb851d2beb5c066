/* Sparse matrices by rows that own their arrays, and what can be computed of them. */
#ifndef DVI_FIELD_ALGEBRA_CSR_H
#define DVI_FIELD_ALGEBRA_CSR_H
#include <dvi/matrix.h>
#include <stddef.h>

/* Row i has the entries start[i] .. start[i+1]-1, with ascending columns. */
typedef struct dvi__csr {
  int64_t rows, columns;
  int64_t *start;
  int *column;
  double *value;
} dvi__csr;

/* Allocate `entries` places, and a start of zeros. On failure nothing is owned. */
dvi_status dvi__csr_allocate(int64_t rows, int64_t columns, int64_t entries, dvi__csr *matrix);

/* Free the arrays and zero the struct. */
void dvi__csr_clear(dvi__csr *matrix);

/* View the matrix. */
dvi_matrix dvi__csr_view(const dvi__csr *matrix, int symmetric);

/* Give the matrix to a user, who calls dvi_matrix_destroy. The struct is zero then. */
dvi_status dvi__csr_give(dvi__csr *matrix, int symmetric, dvi_matrix **given);

/* Make copies, A + B and A B. On failure nothing is owned. Entries that cancel stay. */
dvi_status dvi__csr_copy(const dvi_matrix *A, dvi__csr *copy);
dvi_status dvi__csr_sum(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *sum);
dvi_status dvi__csr_product(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *product);

/* Make A^T B and A^T M A. */
dvi_status dvi__csr_transposed_product(const dvi_matrix *A, const dvi_matrix *B, dvi__csr *product);
dvi_status dvi__csr_square(const dvi_matrix *A, const dvi_matrix *M, dvi__csr *square);

/* Make the matrix of some rows and columns. `row` and `column` have their new numbers, or -1 for
 * those that are left out, and `rows` and `columns` are the new counts. New numbers ascend. */
typedef struct dvi__selection {
  const int *row, *column;
  int64_t rows, columns;
} dvi__selection;
dvi_status dvi__csr_select(const dvi_matrix *A, const dvi__selection *selection, dvi__csr *part);

/* Give the size of the largest entry. */
double dvi__largest_entry(const dvi_matrix *matrix);

/* Leave out the entries that are zero, but not those of the diagonal. */
void dvi__csr_drop_zeros(dvi__csr *matrix);

/* Give the place of an entry, or -1. */
int64_t dvi__csr_find(const dvi__csr *matrix, int64_t row, int column);

/* Access the entries of a view. */
static inline int64_t dvi__first_entry(const dvi_matrix *A, int64_t row)
{
  return A->width > 0 ? row * A->width : A->start[row];
}

static inline int dvi__entry_column(const dvi_matrix *A, int64_t row, int64_t entry)
{
  return A->column != NULL ? A->column[entry] : (int)row;
}

static inline double dvi__entry_value(const dvi_matrix *A, int64_t entry)
{
  return A->sign != NULL ? A->sign[entry] : A->value[entry];
}

#endif
