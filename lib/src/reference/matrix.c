/* SUNDIALS matrices and direct solvers, written column by column. */

#include "reference/run.h"

/* Up to this size a dense factorisation costs less than KLU's bookkeeping. */
enum { DENSE_LIMIT = 48 };

int dvi__reference_is_dense(int size)
{
  return size <= DENSE_LIMIT;
}

SUNMatrix dvi__reference_matrix(const dvi__reference_run *run, int size, int entries)
{
  if (dvi__reference_is_dense(size)) return SUNDenseMatrix(size, size, run->context);
  return SUNSparseMatrix(size, size, entries, CSC_MAT, run->context);
}

SUNLinearSolver dvi__reference_linear(const dvi__reference_run *run, N_Vector y, SUNMatrix matrix)
{
  if (SUNMatGetID(matrix) == SUNMATRIX_DENSE) return SUNLinSol_Dense(y, matrix, run->context);
  return SUNLinSol_KLU(y, matrix, run->context);
}

void dvi__columns_start(dvi__columns *columns, SUNMatrix matrix)
{
  *columns = (dvi__columns){.matrix = matrix, .column = -1};
  if (SUNMatGetID(matrix) == SUNMATRIX_SPARSE) SM_INDEXPTRS_S(matrix)[0] = 0;
}

void dvi__columns_next(dvi__columns *columns)
{
  columns->column++;
  if (SUNMatGetID(columns->matrix) == SUNMATRIX_SPARSE)
    SM_INDEXPTRS_S(columns->matrix)[columns->column + 1] = columns->entry;
}

void dvi__columns_put(dvi__columns *columns, int row, double value)
{
  if (SUNMatGetID(columns->matrix) == SUNMATRIX_DENSE) {
    SM_ELEMENT_D(columns->matrix, row, columns->column) = value;
    return;
  }
  SM_INDEXVALS_S(columns->matrix)[columns->entry] = row;
  SM_DATA_S(columns->matrix)[columns->entry] = value;
  columns->entry++;
  SM_INDEXPTRS_S(columns->matrix)[columns->column + 1] = columns->entry;
}
